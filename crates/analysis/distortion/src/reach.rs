//! How far a map that was fitted to spots is trusted, and how it goes on from there.
//!
//! A map holds within the convex hull of its spots, widened by the usual distance of neighbours. Beyond, it goes on as a plane from
//! the nearest point of that border: value and derivative there, times the way (its Taylor series of first order). So it is
//! continuous with its derivative at the border, stays as steep as it is there, and never runs away as a polynomial of
//! degree 7 does. **Not guaranteed:** that it is right out there: no spot says what the distortion is.

use biplane_geometry::{Point2, Vector2};
use nalgebra::Matrix2;

use crate::nearby::Nearby;

/// The convex hull of spots, widened.
#[derive(Debug, Clone)]
pub(crate) struct Reach {
    /// Corners in order of their angle, the inside on the left from one to the next.
    hull: Vec<Point2>,
    margin_px: f64,
}

impl Reach {
    /// The reach of a map that was fitted to these spots. The hull is found by Andrew's monotone chain.
    pub(crate) fn new(spots: &[Point2]) -> Self {
        let mut points = spots.to_vec();
        points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        let margin_px = usual_distance(spots);
        let mut hull: Vec<Point2> = Vec::new();
        for backwards in [false, true] {
            let start = hull.len();
            let mut add = |p: &Point2| {
                while hull.len() >= start + 2 {
                    let (a, b) = (hull[hull.len() - 2], hull[hull.len() - 1]);
                    if (b - a).perp(&(p - b)) > 0.0 {
                        break;
                    }
                    hull.pop();
                }
                hull.push(*p);
            };
            if backwards {
                points.iter().rev().for_each(&mut add)
            } else {
                points.iter().for_each(&mut add)
            }
            // The last one is the first of the way back.
            hull.pop();
        }
        Self { hull, margin_px }
    }

    /// The point of the hull itself that is nearest to an outside one; `None` inside.
    fn nearest(&self, p: &Point2) -> Option<Point2> {
        let sides = || self.hull.iter().zip(self.hull.iter().cycle().skip(1));
        if sides().all(|(a, b)| (b - a).perp(&(p - a)) >= 0.0) {
            return None;
        }
        let on_side = |(a, b): (&Point2, &Point2)| {
            let along = b - a;
            a + along * ((p - a).dot(&along) / along.norm_squared().max(1e-300)).clamp(0.0, 1.0)
        };
        sides().map(on_side).min_by(|a, b| (p - a).norm_squared().total_cmp(&(p - b).norm_squared()))
    }

    /// Whether a point lies within the hull itself, without the margin.
    pub(crate) fn holds(&self, p: &Point2) -> bool {
        self.nearest(p).is_none()
    }

    /// What a map says within its reach, and what follows beyond.
    pub(crate) fn continued(&self, p: &Point2, map: impl Fn(&Point2) -> (Point2, Matrix2<f64>)) -> Point2 {
        let within = match self.nearest(p) {
            Some(nearest) => {
                let out: Vector2 = p - nearest;
                nearest + out * (self.margin_px / out.norm()).min(1.0)
            }
            None => *p,
        };
        let (value, derivative) = map(&within);
        value + derivative * (p - within)
    }
}

/// The median distance of the nearest neighbour, px.
fn usual_distance(points: &[Point2]) -> f64 {
    let nearby = Nearby::new(points.to_vec());
    let mut distances: Vec<f64> =
        points.iter().filter_map(|p| nearby.closest(p, 2).get(1).map(|n| n.1)).collect();
    distances.sort_by(f64::total_cmp);
    distances.get(distances.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_reaches_its_margin_and_goes_on_as_a_plane() {
        // A grid of 2 px: so far the map is trusted.
        let grid: Vec<Point2> =
            (0..36).map(|k| Point2::new(f64::from(k % 6) * 2.0, f64::from(k / 6) * 2.0)).collect();
        let reach = Reach::new(&grid);
        assert_eq!(reach.hull.len(), 4);
        assert!(reach.holds(&Point2::new(5.0, 10.0)) && !reach.holds(&Point2::new(5.0, 10.1)));
        let squares = |p: &Point2| (Point2::new(p.x * p.x, p.y), Matrix2::new(2.0 * p.x, 0.0, 0.0, 1.0));
        let at = |x: f64| reach.continued(&Point2::new(x, 5.0), squares).x;
        assert_eq!((at(3.0), at(11.0), at(12.0)), (9.0, 121.0, 144.0));
        // 12^2 and 24 for every px beyond.
        assert!((at(15.0) - 216.0).abs() < 1e-9 && (at(-4.0) - 12.0).abs() < 1e-9);
        // Off a corner the nearest point is the corner's circle.
        let off = reach.continued(&Point2::new(13.0, 14.0), |p| (*p, Matrix2::zeros()));
        assert!((off - Point2::new(11.2, 11.6)).norm() < 1e-12);
    }
}
