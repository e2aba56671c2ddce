//! What is made wrong on purpose: noise of outlines, missing parts, calibrations that do not fit. Each is drawn from a seed.

use biplane_artifact::Curves;
use biplane_geometry::{Curve, EdgePoint, Vector2, Vector3};
use biplane_phantom::TrueFluoroscope;
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// A source of random numbers for one purpose: `seed`, then what tells the purposes and draws apart.
pub fn random(seed: u64, purpose: u64, draw: usize) -> Xoshiro256PlusPlus {
    let mixed = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ purpose.wrapping_mul(0xd1b5_4a32_d192_ed03);
    Xoshiro256PlusPlus::seed_from_u64(mixed.wrapping_add(draw as u64))
}

/// A standard normal number (Box and Muller 1958).
pub fn normal(random: &mut Xoshiro256PlusPlus) -> f64 {
    let (u, v): (f64, f64) = (1.0 - random.random::<f64>(), random.random());
    (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}

/// A vector of independent normal numbers of standard deviation `sigma`.
pub fn normal_vector(sigma: f64, random: &mut Xoshiro256PlusPlus) -> Vector3 {
    Vector3::from_fn(|_, _| sigma * normal(random))
}

/// Moves the points of curves across their edge by noise of standard deviation `sigma_px` whose correlation along the curve
/// falls to 1/e in `correlation_px` (none for 0): a first-order autoregression, closed curves run through twice.
pub fn noisy(curves: &Curves, sigma_px: f64, correlation_px: f64, random: &mut Xoshiro256PlusPlus) -> Curves {
    let moved = |curve: &Curve| {
        let (ideal, mut curve) = (&curve.points, curve.clone());
        let mut noise = normal(random);
        // The first time round only lets the end of a closed curve know of its start.
        let warm_up = if curve.closed { curve.points.len() } else { 0 };
        for index in 0..warm_up + curve.points.len() {
            let at = index % curve.points.len();
            let before = (at + curve.points.len() - 1) % curve.points.len();
            let step = if index == 0 { 0.0 } else { (ideal[at].position - ideal[before].position).norm() };
            let kept = if correlation_px > 0.0 { (-step / correlation_px).exp() } else { 0.0 };
            noise = kept * noise + (1.0 - kept * kept).sqrt() * normal(random);
            if index >= warm_up {
                let direction = curve.points[at].direction;
                curve.points[at].position += direction * (sigma_px * noise);
                curve.points[at].sigma_px = sigma_px.max(0.01);
            }
        }
        curve
    };
    Curves(curves.0.iter().map(moved).collect())
}

/// Takes a share of the whole length of curves away, in one piece beginning at a random place.
pub fn cut(curves: &Curves, share: f64, random: &mut Xoshiro256PlusPlus) -> Curves {
    let total: usize = curves.0.iter().map(|c| c.points.len()).sum();
    let (first, count) = (random.random_range(0..total.max(1)), (share * total as f64).round() as usize);
    let missing = |index: usize| (index + total - first) % total < count;
    let mut left = Vec::new();
    let mut index = 0;
    for curve in &curves.0 {
        let mut piece = Vec::new();
        for point in &curve.points {
            if missing(index) {
                if !piece.is_empty() {
                    left.push(Curve { points: std::mem::take(&mut piece), closed: false });
                }
            } else {
                piece.push(*point);
            }
            index += 1;
        }
        if !piece.is_empty() {
            let closed = curve.closed && piece.len() == curve.points.len();
            left.push(Curve { points: piece, closed });
        }
    }
    Curves(left)
}

/// Lengths of wrong edges, px, and how far beside the outline their middles lie (standard deviation).
const WRONG_EDGE_PX: (std::ops::Range<f64>, f64) = (15.0..60.0, 12.0);
/// Distance of their points, px.
const WRONG_STEP_PX: f64 = 0.5;
/// How far they turn from end to end at most, rad.
const WRONG_TURN: f64 = 1.5;

/// Adds edges that are not the body's, until they are `share` of all edge points: straight stretches and arcs near the outline, in
/// any direction, brighter on either side.
pub fn cluttered(curves: &Curves, share: f64, random: &mut Xoshiro256PlusPlus) -> Curves {
    let outline: Vec<EdgePoint> = curves.0.iter().flat_map(|c| &c.points).copied().collect();
    let mut missing = (share / (1.0 - share) * outline.len() as f64).round() as usize;
    let mut all = curves.clone();
    while missing > 1 && !outline.is_empty() {
        let beside = &outline[random.random_range(0..outline.len())];
        let length = random.random_range(WRONG_EDGE_PX.0.clone());
        let count = ((length / WRONG_STEP_PX) as usize).min(missing);
        let mut heading: f64 = random.random_range(0.0..std::f64::consts::TAU);
        // Every other one is straight.
        let turn = if random.random() { 0.0 } else { random.random_range(-WRONG_TURN..WRONG_TURN) };
        let side = if random.random() { 1.0 } else { -1.0 };
        let along = |heading: f64| Vector2::new(heading.cos(), heading.sin());
        let mut position = beside.position + beside.direction * (WRONG_EDGE_PX.1 * normal(random))
            - along(heading) * (length / 2.0);
        let points = (0..count)
            .map(|_| {
                heading += turn / count as f64;
                position += along(heading) * WRONG_STEP_PX;
                let across = Vector2::new(-heading.sin(), heading.cos()) * side;
                EdgePoint { position, direction: across, ..*beside }
            })
            .collect();
        all.0.push(Curve { points, closed: false });
        missing -= count;
    }
    all
}

/// A fluoroscope as a calibration that is wrong has it: source and detector each displaced by independent normal numbers.
pub fn miscalibrated(
    view: &TrueFluoroscope,
    source_mm: f64,
    detector_mm: f64,
    random: &mut Xoshiro256PlusPlus,
) -> TrueFluoroscope {
    TrueFluoroscope {
        source: view.source + normal_vector(source_mm, random),
        centre: view.centre + normal_vector(detector_mm, random),
        ..view.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_geometry::Point2;

    fn circle(points: usize) -> Curves {
        let point = |k: usize| {
            let a = std::f64::consts::TAU * k as f64 / points as f64;
            let direction = Vector2::new(a.cos(), a.sin());
            EdgePoint { position: Point2::from(direction * 300.0), direction, strength: 1.0, sigma_px: 0.0 }
        };
        Curves(vec![Curve { points: (0..points).map(point).collect(), closed: true }])
    }

    #[test]
    fn noise_has_its_size_and_its_correlation() {
        let mut random = random(1, 2, 3);
        let (mut squares, mut products, mut count) = (0.0, 0.0, 0.0);
        // 1885 px round, points 0.5 px apart.
        for _ in 0..40 {
            let moved = noisy(&circle(3770), 0.4, 20.0, &mut random);
            let off: Vec<f64> = moved.0[0].points.iter().map(|p| p.position.coords.norm() - 300.0).collect();
            for k in 0..off.len() {
                squares += off[k] * off[k];
                // 40 points are one correlation length.
                products += off[k] * off[(k + 40) % off.len()];
                count += 1.0;
            }
        }
        assert!(((squares / count).sqrt() - 0.4).abs() < 0.02, "{}", (squares / count).sqrt());
        assert!((products / squares - (-1.0_f64).exp()).abs() < 0.06, "{}", products / squares);
    }

    #[test]
    fn wrong_edges_are_their_share_and_lie_about_the_outline() {
        let (mut count, mut near, mut outward) = (0, 0, 0);
        for draw in 0..50 {
            let all = cluttered(&circle(3600), 0.1, &mut random(1, 4, draw));
            assert_eq!(all.0[0], circle(3600).0[0]);
            let wrong: Vec<&EdgePoint> = all.0[1..].iter().flat_map(|c| &c.points).collect();
            assert!(wrong.len().abs_diff(400) <= 1, "{}", wrong.len());
            count += wrong.len();
            near += wrong.iter().filter(|p| (p.position.coords.norm() - 300.0).abs() < 40.0).count();
            outward += wrong.iter().filter(|p| p.direction.dot(&p.position.coords) > 0.0).count();
        }
        let share = |part: usize| part as f64 / count as f64;
        assert!(share(near) > 0.9 && (0.4..0.6).contains(&share(outward)), "{near}, {outward} of {count}");
    }

    #[test]
    fn a_cut_takes_its_share_in_one_piece() {
        for draw in 0..20 {
            let left = cut(&circle(1000), 0.3, &mut random(1, 1, draw));
            assert_eq!(left.0.iter().map(|c| c.points.len()).sum::<usize>(), 700);
            assert!(left.0.len() <= 2 && left.0.iter().all(|c| !c.closed));
        }
        assert_eq!(cut(&circle(10), 0.0, &mut random(1, 1, 0)), circle(10));
    }
}
