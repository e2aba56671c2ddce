//! The round border of an intensifier's picture: a steep step from dark outside to bright inside, along one circle.
//!
//! Along rays from the picture's middle the outermost step is placed at half its height, and a circle is put through most of
//! these places: by consensus first (M. A. Fischler and R. C. Bolles, Random sample consensus, 1981; here of fixed triples), then
//! by least squares of their distances. Holes and beads at the border move single places, which then do not count.
//! **Not guaranteed:** borders of another shape; those are none.

use biplane_artifact::Circle;
use nalgebra::{Matrix3, Vector3};

use biplane_grey::Grey;

/// Rays from the middle.
const RAYS: usize = 720;
/// How far a place may be from the circle, px.
const NEAR: f64 = 1.5;
/// Least share of the rays that must show the border; those alone count that leave it within the picture.
const LEAST_SHARE: f64 = 0.04;
/// Least difference of inside and outside, grey levels.
const LEAST_STEP: f64 = 10.0;

/// The border, if the picture shows one.
pub(crate) fn border(grey: &Grey) -> Option<Circle> {
    let [w, h] = [grey.width, grey.height].map(|n| n as f64);
    let shorter = w.min(h);
    if shorter < 32.0 {
        return None;
    }
    let middle = [(w - 1.0) / 2.0, (h - 1.0) / 2.0];
    let inside = median_around(grey, middle, shorter / 4.0);
    // The darkest corner is outside, where anything is.
    let corner = shorter * 0.015;
    let corners = [
        [corner, corner],
        [w - 1.0 - corner, corner],
        [corner, h - 1.0 - corner],
        [w - 1.0 - corner, h - 1.0 - corner],
    ];
    let outside = corners.iter().map(|c| median_around(grey, *c, corner)).fold(f64::INFINITY, f64::min);
    if inside - outside < LEAST_STEP {
        return None;
    }
    let level = outside + 0.35 * (inside - outside);
    let steps: Vec<[f64; 2]> = (0..RAYS)
        .filter_map(|i| {
            let (sin, cos) = (std::f64::consts::TAU * i as f64 / RAYS as f64).sin_cos();
            outermost_step(grey, middle, [cos, sin], level)
        })
        .collect();
    let circle = refined(&steps, consensus(&steps)?)?;
    let near = steps.iter().filter(|p| distance(&circle, p).abs() < NEAR).count();
    let plausible = circle.radius_px > shorter / 4.0
        && near as f64 >= 0.5 * steps.len() as f64
        && near as f64 >= LEAST_SHARE * RAYS as f64;
    plausible.then_some(circle)
}

/// Distance of a place from a circle, px; positive outside.
fn distance(circle: &Circle, p: &[f64; 2]) -> f64 {
    (p[0] - circle.centre_px[0]).hypot(p[1] - circle.centre_px[1]) - circle.radius_px
}

/// Median of some 400 samples within `reach` of a place along both axes.
fn median_around(grey: &Grey, at: [f64; 2], reach: f64) -> f64 {
    let mut values: Vec<f64> = (0..400_u32)
        .map(|i| {
            let along = |k: u32| (f64::from(k) - 9.5) / 9.5 * reach;
            grey.at((at[0] + along(i % 20)).round(), (at[1] + along(i / 20)).round())
        })
        .collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Where a ray from the middle leaves the bright picture; none where it is bright up to the picture's edge, or the step
/// is not steep.
fn outermost_step(grey: &Grey, middle: [f64; 2], along: [f64; 2], level: f64) -> Option<[f64; 2]> {
    let reach = (0..2).filter(|a| along[*a].abs() > 1e-9).map(|a| middle[a] / along[a].abs());
    let reach = reach.fold(f64::INFINITY, f64::min).floor();
    let at = |r: f64| [middle[0] + along[0] * r, middle[1] + along[1] * r];
    let value = |r: f64| {
        let p = at(r);
        grey.at(p[0], p[1])
    };
    // Inwards to the first of three bright samples in a row.
    let mut r = reach;
    let mut bright = 0;
    while r > 8.0 && bright < 3 {
        bright = if value(r) > level { bright + 1 } else { 0 };
        r -= 1.0;
    }
    let edge = r + 3.0;
    if bright < 3 || edge > reach - 2.0 {
        return None;
    }
    let mean = |from: f64| (0..5).map(|i| value((from + f64::from(i)).min(reach))).sum::<f64>() / 5.0;
    let (outside, inside) = (mean(edge + 4.0), mean(edge - 8.0));
    let half = (outside + inside) / 2.0;
    let steep = value(edge - 3.0) - value((edge + 3.0).min(reach)) > 0.7 * (inside - outside);
    if !steep || inside - outside < LEAST_STEP {
        return None;
    }
    // The outermost crossing of half the height.
    let mut r = (edge + 4.0).min(reach);
    while r > edge - 4.0 {
        let (here, inner) = (value(r), value(r - 0.5));
        if here <= half && inner > half {
            return Some(at(r - 0.5 * (half - here) / (inner - here)));
        }
        r -= 0.5;
    }
    None
}

/// The circle through three of the places that most others are near to.
fn consensus(steps: &[[f64; 2]]) -> Option<Circle> {
    let n = steps.len();
    if n < 8 {
        return None;
    }
    let circles = (0..n).step_by(n.div_ceil(120)).filter_map(|i| {
        let corner = |k: usize| steps[(i + k * n / 3) % n];
        through([corner(0), corner(1), corner(2)])
    });
    let near = |c: &Circle| steps.iter().filter(|p| distance(c, p).abs() < NEAR).count();
    circles.map(|c| (near(&c), c)).max_by_key(|(near, _)| *near).map(|(_, c)| c)
}

/// The circle through three places.
fn through([a, b, c]: [[f64; 2]; 3]) -> Option<Circle> {
    let (b, c) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
    let twice_area = 2.0 * (b[0] * c[1] - b[1] * c[0]);
    let (b2, c2) = (b[0] * b[0] + b[1] * b[1], c[0] * c[0] + c[1] * c[1]);
    let to = [(c[1] * b2 - b[1] * c2) / twice_area, (b[0] * c2 - c[0] * b2) / twice_area];
    let circle = Circle { centre_px: [a[0] + to[0], a[1] + to[1]], radius_px: to[0].hypot(to[1]) };
    (circle.radius_px.is_finite() && circle.radius_px < 1e5).then_some(circle)
}

/// Least squares of the distances of the places near a circle.
fn refined(steps: &[[f64; 2]], mut circle: Circle) -> Option<Circle> {
    for _ in 0..8 {
        let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for p in steps {
            let d = distance(&circle, p);
            if d.abs() < NEAR {
                let r = d + circle.radius_px;
                let row =
                    Vector3::new((p[0] - circle.centre_px[0]) / r, (p[1] - circle.centre_px[1]) / r, 1.0);
                normal += row * row.transpose();
                right += row * d;
            }
        }
        let step = normal.cholesky()?.solve(&right);
        circle.centre_px[0] += step[0];
        circle.centre_px[1] += step[1];
        circle.radius_px += step[2];
    }
    circle.radius_px.is_finite().then_some(circle)
}

/// Puts the light of the inside in place of what lies outside a circle, mirrored at it, so that the step is gone.
pub(crate) fn mirrored_beyond(grey: &Grey, circle: &Circle) -> Grey {
    let [cx, cy] = circle.centre_px;
    // Within the step the picture is neither.
    let rim = circle.radius_px - 2.0;
    let mut samples = grey.samples.clone();
    for (y, row) in samples.chunks_exact_mut(grey.width).enumerate() {
        let dy = y as f64 - cy;
        let half = (rim * rim - dy * dy).max(0.0).sqrt();
        for (x, value) in row.iter_mut().enumerate() {
            let dx = x as f64 - cx;
            if dx.abs() > half {
                let r = (dx * dx + dy * dy).sqrt().max(1e-9);
                let back = (2.0 * rim - r).max(0.0) / r;
                *value = grey.at(cx + dx * back, cy + dy * back) as f32;
            }
        }
    }
    Grey { width: grey.width, height: grey.height, samples }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn round(centre: [f64; 2], radius: f64, [width, height]: [usize; 2]) -> Grey {
        let sample = |i: usize| {
            let (x, y) = ((i % width) as f64, (i / width) as f64);
            let r = (x - centre[0]).hypot(y - centre[1]);
            let inside = (radius + 0.5 - r).clamp(0.0, 1.0);
            // Holes on the border, and vignetting.
            let hole = if (x / 14.0).sin() * (y / 14.0).sin() > 0.9 { 2.0 } else { 1.0 };
            (5.0 + inside * hole * (70.0 - 30.0 * (r / radius).powi(2))) as f32
        };
        Grey { width, height, samples: (0..width * height).map(sample).collect() }
    }

    #[test]
    fn a_border_is_found_where_it_is_also_beyond_the_picture() {
        // Within the picture; off its middle; seen in its corners alone.
        for (centre, radius) in [([149.5, 124.5], 120.0), ([140.3, 131.8], 115.4), ([149.5, 124.5], 170.0)] {
            let circle = border(&round(centre, radius, [300, 250])).unwrap();
            let off = (circle.centre_px[0] - centre[0]).hypot(circle.centre_px[1] - centre[1]);
            assert!(off < 0.3, "{circle:?}");
            assert!((circle.radius_px - radius).abs() < 0.3, "{circle:?}");
        }
    }

    #[test]
    fn a_picture_that_fills_its_rectangle_has_none() {
        assert_eq!(border(&round([149.5, 124.5], 400.0, [300, 250])), None);
        // Dark corners by a slope of light are none either.
        let slope = |i: usize| (200.0 - ((i % 300) as f32 - 150.0).hypot((i / 300) as f32 - 125.0)).max(0.0);
        let grey = Grey { width: 300, height: 250, samples: (0..300 * 250).map(slope).collect() };
        assert_eq!(border(&grey), None);
    }

    #[test]
    fn beyond_the_border_the_inside_is_mirrored() {
        let grey = round([100.0, 100.0], 80.0, [200, 200]);
        let circle = Circle { centre_px: [100.0, 100.0], radius_px: 80.0 };
        let filled = mirrored_beyond(&grey, &circle);
        assert_eq!(filled.samples[100 * 200 + 150], grey.samples[100 * 200 + 150]);
        assert!((filled.at(185.0, 100.0) - grey.at(171.0, 100.0)).abs() < 1e-3);
    }
}
