//! The outline of a solid's shadow, straight from its function: no mesh, and none of the product's code.
//!
//! Along the ray of a pixel the solid's function has a least value `g(pixel)`, and the shadow is where `g < 0`. As the
//! function changes by at most the distance moved, `g` of one pixel bounds it around: cells of the picture that the outline
//! cannot pass are left out, the others divided down to one pixel. The outline is traced through those ("marching squares")
//! and divided evenly, and each of its points is then brought onto `g = 0` by Newton's method. Its derivative is cheap: as
//! the pixel moves, the foot of the least value moves along the ray, which changes nothing, so the derivative of `g` is the
//! gradient of the solid's function there, projected. That gradient is also the outline's normal.
//!
//! **Guaranteed:** every point's ray touches the solid within [`TOUCH_MM`]; closed curves with the shadow on one side: the
//! outer ones and the rims of holes; the same on every run. **Not guaranteed:** pieces, holes and necks narrower than a
//! pixel; a point in a corner that points into the shadow (the nearest stand up to a step away).

use std::collections::BTreeMap;

use biplane_geometry::{Curve, EdgePoint, Point2, Point3, Pose, Vector2, Vector3};

use crate::{Solid, TrueFluoroscope, gradient};

/// Largest distance by which an outline point's ray misses or enters the solid, mm.
pub const TOUCH_MM: f64 = 1e-8;
/// Standard deviation that is written to the points, px: small against that of any picture, and not zero, since weights are
/// made from it.
pub const SIGMA_PX: f64 = 0.01;
/// Most cells on a side of the square that is divided, px: a body so near the source that it needs more has no outline.
const LARGEST_SQUARE: i64 = 1 << 14;
/// Shortest step along a ray past the surface, mm.
const SHORTEST_STEP_MM: f64 = 0.4;

/// The boundaries of a solid's shadow in one view, outer ones and holes, in ideal pixels.
///
/// Points are about `step_px` apart, clockwise around the shadow as the picture is seen and the other way around holes;
/// `direction` is the unit normal out of the shadow, from dark to bright; `strength` is 1.
/// The picture's size does not cut the outline. No curves where a part of the solid's box is not in front of the source, or
/// its shadow is wider than 16,384 px, or the step is not a positive number.
pub fn ideal_outline(solid: &dyn Solid, pose: &Pose, view: &TrueFluoroscope, step_px: f64) -> Vec<Curve> {
    let Some(shadow) = Shadow::new(solid, pose, view).filter(|_| step_px > 0.0) else { return Vec::new() };
    let mut curves = Vec::new();
    for chain in shadow.chains() {
        let points: Vec<EdgePoint> =
            evenly(&chain, step_px).iter().filter_map(|guess| shadow.refine(guess)).collect();
        if points.len() > 2 {
            curves.push(Curve { points, closed: true });
        }
    }
    curves
}

/// A solid seen from a source, all in the solid's own frame.
struct Shadow<'a> {
    solid: &'a dyn Solid,
    source: Point3,
    /// The detector's point at pixel (0, 0), and by how much it moves for a pixel along x and y.
    corner: Point3,
    across: [Vector3; 2],
    /// Middle of the solid's box and the radius around it that holds the box.
    middle: Point3,
    radius: f64,
    /// A movement of one pixel moves a ray by at most this at the solid, mm.
    mm_per_px: f64,
    /// Pixels that hold the shadow with a margin, as a square of a power of two.
    first: [i64; 2],
    side: i64,
}

impl<'a> Shadow<'a> {
    fn new(solid: &'a dyn Solid, pose: &Pose, view: &TrueFluoroscope) -> Option<Self> {
        let model_from_world = pose.inverse();
        let pixel = |x: f64, y: f64| model_from_world.transform(&view.detector_point(&Point2::new(x, y)));
        let corner = pixel(0.0, 0.0);
        let (low, high) = solid.bounds();
        let (mut least, mut most) = (Vector2::repeat(f64::INFINITY), Vector2::repeat(f64::NEG_INFINITY));
        let mut deepest = 0.0_f64;
        for number in 0..8 {
            let pick = |axis: usize| if number >> axis & 1 == 0 { low[axis] } else { high[axis] };
            let (seen, depth) = view.project(&pose.transform(&Point3::new(pick(0), pick(1), pick(2))))?;
            least = least.inf(&seen.coords);
            most = most.sup(&seen.coords);
            deepest = deepest.max(depth);
        }
        let size = (most - least).max() + 4.0;
        let sensible = size < LARGEST_SQUARE as f64 && least.amax() < 1e9;
        sensible.then(|| Self {
            solid,
            source: model_from_world.transform(&view.source),
            corner,
            across: [pixel(1.0, 0.0) - corner, pixel(0.0, 1.0) - corner],
            middle: nalgebra::center(&low, &high),
            radius: (high - low).norm() / 2.0,
            mm_per_px: view.pixel_mm * deepest / view.source_to_detector_mm(),
            first: [least.x.floor() as i64 - 2, least.y.floor() as i64 - 2],
            side: (size.ceil().max(1.0) as u32 + 1).next_power_of_two().into(),
        })
    }

    /// Unit direction of a pixel's ray.
    fn ray(&self, pixel: &Point2) -> Vector3 {
        (self.corner + self.across[0] * pixel.x + self.across[1] * pixel.y - self.source).normalize()
    }

    /// Where a ray enters and leaves a ball that holds the solid and `margin` mm around it, from the source, mm.
    fn range(&self, ray: &Vector3, margin: f64) -> Option<(f64, f64)> {
        let to_middle = self.middle - self.source;
        let nearest = to_middle.dot(ray);
        let half = (self.radius + margin).powi(2) - (to_middle.norm_squared() - nearest * nearest);
        (half > 0.0).then(|| ((nearest - half.sqrt()).max(0.0), nearest + half.sqrt()))
    }

    /// Whether the solid's function gets below `level` along a ray. It steps by what the function allows, but not by less
    /// than `shortest`.
    fn reaches(&self, pixel: &Point2, level: f64, shortest: f64) -> bool {
        let ray = self.ray(pixel);
        let Some((mut at, end)) = self.range(&ray, level.max(0.0)) else { return false };
        while at < end {
            let above = self.solid.value(&(self.source + ray * at)) - level;
            if above <= 0.0 {
                return true;
            }
            at += above.max(shortest);
        }
        false
    }

    /// The cells of a pixel's width that the outline may pass, by their first corner: found in squares of two by two.
    fn cells(&self, first: [i64; 2], side: i64, cells: &mut Vec<[i64; 2]>) {
        let half = side as f64 / 2.0;
        let reach = half * 2.0_f64.sqrt() * self.mm_per_px;
        let middle = Point2::new(first[0] as f64 + half, first[1] as f64 + half);
        // Both answers may only be wrong by keeping a cell: the first by a margin, the second by a step too long.
        if !self.reaches(&middle, reach * 1.1, reach * 0.1) || self.reaches(&middle, -reach, reach * 0.1) {
            return;
        }
        let s = side / 2;
        for [x, y] in [[0, 0], [s, 0], [0, s], [s, s]] {
            let quarter = [first[0] + x, first[1] + y];
            if s == 1 {
                cells.push(quarter);
            } else {
                self.cells(quarter, s, cells);
            }
        }
    }

    /// The outline as closed chains of points to within a sixteenth of a pixel, clockwise around the shadow as the picture
    /// is seen, and the other way around holes.
    fn chains(&self) -> Vec<Vec<Point2>> {
        let mut cells = Vec::new();
        self.cells(self.first, self.side, &mut cells);
        // No value at a corner of a square of two pixels that the outline passes is larger in size than this.
        let ceiling = 3.0 * self.mm_per_px;
        let value = |x: f64, y: f64| self.least(&Point2::new(x, y), ceiling).map_or(ceiling, |found| found.0);
        let mut corners: BTreeMap<[i64; 2], f64> = BTreeMap::new();
        // From the side of a cell that a chain enters by to the one that it leaves by.
        let mut next: BTreeMap<Side, Side> = BTreeMap::new();
        for [x, y] in cells {
            let inside = [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]]
                .map(|c| *corners.entry(c).or_insert_with(|| value(c[0] as f64, c[1] as f64)) < 0.0);
            // Sides between neighbouring corners, in the order of the corners.
            let sides = [(x, y, 0), (x + 1, y, 1), (x, y + 1, 0), (x, y, 1)];
            let leaves = |k: usize| inside[k] && !inside[(k + 1) % 4];
            let enters = |k: usize| !inside[k] && inside[(k + 1) % 4];
            let crossings = (0..4).filter(|k| leaves(*k)).count();
            // Of four crossings the middle decides whether the two dark corners hang together.
            let joined = crossings == 2 && value(x as f64 + 0.5, y as f64 + 0.5) < 0.0;
            for k in (0..4).filter(|k| leaves(*k)) {
                let turn = if joined { [1, 2, 3] } else { [3, 2, 1] };
                if let Some(to) = turn.into_iter().map(|t| (k + t) % 4).find(|to| enters(*to)) {
                    next.insert(sides[k], sides[to]);
                }
            }
        }
        let mut chains = Vec::new();
        while let Some((&start, _)) = next.iter().next() {
            let mut chain = Vec::new();
            let mut at = start;
            while let Some(to) = next.remove(&at) {
                chain.extend(crossing(&corners, at));
                at = to;
            }
            if at == start {
                chains.push(chain);
            }
        }
        chains
    }

    /// The least value along a pixel's ray, and the point where it is; none where all are above `ceiling`.
    fn least(&self, pixel: &Point2, ceiling: f64) -> Option<(f64, Point3)> {
        let ray = self.ray(pixel);
        let (begin, end) = self.range(&ray, ceiling)?;
        let value = |s: f64| self.solid.value(&(self.source + ray * s));
        let mut best = (ceiling, end);
        // Three samples in a row, the one in the middle lowest, hold a least value; most cannot hold a new lowest one.
        let mut before = (begin, value(begin));
        let mut at = before;
        while at.0 < end {
            let after = at.0 + (at.1 - best.0).max(SHORTEST_STEP_MM);
            let after = (after, value(after));
            if at.1 <= before.1 && at.1 <= after.1 {
                let bound = |a: (f64, f64), b: (f64, f64)| (a.1 + b.1 - (b.0 - a.0)) / 2.0;
                if bound(before, at).min(bound(at, after)) < best.0 {
                    let found = lowest(&value, before.0, at, after.0);
                    if found.0 < best.0 {
                        best = found;
                    }
                }
            }
            (before, at) = (at, after);
        }
        (best.1 < end).then(|| (best.0, self.source + ray * best.1))
    }

    /// From a guess to the outline: the point, with the outline's normal. None where it leads away by pixels.
    fn refine(&self, guess: &Point2) -> Option<EdgePoint> {
        let mut pixel = *guess;
        for _ in 0..40 {
            let (value, foot) = self.least(&pixel, 4.0 * self.mm_per_px)?;
            let normal = gradient(self.solid, &foot);
            // The ray at this pixel moves at the foot by the detector's movement times the foot's share of the way.
            let on_detector = self.corner + self.across[0] * pixel.x + self.across[1] * pixel.y;
            let share = (foot - self.source).norm() / (on_detector - self.source).norm();
            let slope = Vector2::new(normal.dot(&self.across[0]), normal.dot(&self.across[1])) * share;
            let length = slope.norm();
            if value.abs() < TOUCH_MM && length > 0.0 {
                return Some(EdgePoint {
                    position: pixel,
                    direction: slope / length,
                    strength: 1.0,
                    sigma_px: SIGMA_PX,
                });
            }
            pixel -= slope * (value / length).clamp(-1.0, 1.0) / length;
            let near = (pixel - guess).norm() <= 3.0;
            if !near {
                return None;
            }
        }
        None
    }
}

/// A side of a cell: its first corner, and 0 where it runs along x, 1 along y.
type Side = (i64, i64, u8);

/// Where the outline crosses a side of a cell, taking the values at its ends for those of a straight line.
fn crossing(corners: &BTreeMap<[i64; 2], f64>, (x, y, along): Side) -> Option<Point2> {
    let step = if along == 0 { [1, 0] } else { [0, 1] };
    let (from, to) = (corners.get(&[x, y])?, corners.get(&[x + step[0], y + step[1]])?);
    let share = from / (from - to);
    Some(Point2::new(x as f64 + share * step[0] as f64, y as f64 + share * step[1] as f64))
}

/// The least value of a function between two places around a lower one `(place, value)`: Brent's method with parabolas.
fn lowest(f: &impl Fn(f64) -> f64, low: f64, middle: (f64, f64), high: f64) -> (f64, f64) {
    const GOLDEN: f64 = 0.381_966_011_250_105;
    const NEAR_MM: f64 = 2e-6;
    let (mut a, mut b) = (low, high);
    let (mut x, mut w, mut v) = (middle, middle, middle);
    let (mut step, mut previous) = (0.0_f64, 0.0_f64);
    for _ in 0..60 {
        let centre = (a + b) / 2.0;
        if (x.0 - centre).abs() <= 2.0 * NEAR_MM - (b - a) / 2.0 {
            break;
        }
        let (r, q) = ((x.0 - w.0) * (x.1 - v.1), (x.0 - v.0) * (x.1 - w.1));
        let denominator = 2.0 * (q - r);
        let parabola = ((x.0 - w.0) * r - (x.0 - v.0) * q) / denominator;
        let usable = parabola.is_finite()
            && previous.abs() > NEAR_MM
            && parabola.abs() < previous.abs() / 2.0
            && x.0 + parabola > a
            && x.0 + parabola < b;
        previous = step;
        if usable {
            step = parabola;
        } else {
            previous = if x.0 < centre { b - x.0 } else { a - x.0 };
            step = GOLDEN * previous;
        }
        if step.abs() < NEAR_MM {
            step = if x.0 < centre { NEAR_MM } else { -NEAR_MM };
        }
        let u = (x.0 + step, f(x.0 + step));
        if u.1 <= x.1 {
            if u.0 < x.0 {
                b = x.0
            } else {
                a = x.0
            }
            (v, w, x) = (w, x, u);
        } else {
            if u.0 < x.0 {
                a = u.0
            } else {
                b = u.0
            }
            if u.1 <= w.1 || w.0 == x.0 {
                (v, w) = (w, u);
            } else if u.1 <= v.1 || v.0 == x.0 || v.0 == w.0 {
                v = u;
            }
        }
    }
    (x.1, x.0)
}

/// Points evenly spaced along a closed chain, at most `step` apart.
fn evenly(chain: &[Point2], step: f64) -> Vec<Point2> {
    let sides: Vec<(Point2, Vector2, f64)> = (0..chain.len())
        .map(|i| {
            let along = chain[(i + 1) % chain.len()] - chain[i];
            (chain[i], along, along.norm())
        })
        .collect();
    let length: f64 = sides.iter().map(|s| s.2).sum();
    let count = (length / step).ceil().max(3.0);
    let mut points = Vec::new();
    let (mut passed, mut number) = (0.0, 0.0);
    for (from, along, size) in sides {
        while number < count && number * length / count < passed + size {
            points.push(from + along * ((number * length / count - passed) / size));
            number += 1.0;
        }
        passed += size;
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Ball, biplane};

    /// Twice the area enclosed is the sum over the sides; positive clockwise with y downwards.
    fn area(curve: &Curve) -> f64 {
        let p = &curve.points;
        (0..p.len()).map(|i| p[i].position.coords.perp(&p[(i + 1) % p.len()].position.coords) / 2.0).sum()
    }

    #[test]
    fn a_balls_outline_is_where_the_tangent_cone_meets_the_detector() {
        let ball = Ball { centre: Point3::new(10.0, 20.0, -5.0), radius: 12.0 };
        let pose = Pose::new(
            nalgebra::UnitQuaternion::from_euler_angles(0.3, -0.2, 1.1),
            Vector3::new(21.0, -14.0, 18.0),
        );
        for view in biplane(70.0) {
            let curves = ideal_outline(&ball, &pose, &view, 0.5);
            assert_eq!(curves.len(), 1);
            assert!(curves[0].closed && area(&curves[0]) > 0.0);
            // A ray is tangent where its angle with the direction to the centre has the sine radius / distance.
            let to_centre = pose.transform(&ball.centre) - view.source;
            let tangent = (ball.radius / to_centre.norm()).asin();
            let mm_per_px = to_centre.norm() * view.pixel_mm / view.source_to_detector_mm();
            for p in &curves[0].points {
                let ray = view.ray(&p.position);
                let angle = ray.cross(&to_centre).norm().atan2(ray.dot(&to_centre));
                let off_px = (angle - tangent) * to_centre.norm() / mm_per_px;
                assert!(off_px.abs() < 1e-6, "{off_px} px at {:?}", p.position);
                // The cone's angle grows fastest along the normal of its trace.
                let grows = |d: Vector2| view.ray(&(p.position + d * 1e-3)).angle(&to_centre) - angle;
                let along = Vector2::new(-p.direction.y, p.direction.x);
                assert!(grows(p.direction) > 0.0 && (p.direction.norm() - 1.0).abs() < 1e-12);
                assert!((grows(along) - grows(-along)).abs() < 1e-4 * grows(p.direction));
            }
        }
    }

    #[test]
    fn behind_the_source_there_is_no_outline() {
        let ball = Ball { centre: Point3::new(0.0, -495.0, 0.0), radius: 12.0 };
        let [view, _] = biplane(90.0);
        assert!(ideal_outline(&ball, &Pose::identity(), &view, 0.5).is_empty());
        let ball = Ball { centre: Point3::origin(), radius: 12.0 };
        assert!(ideal_outline(&ball, &Pose::identity(), &view, 0.0).is_empty());
        assert!(ideal_outline(&ball, &Pose::identity(), &view, f64::NAN).is_empty());
    }
}
