//! The distance of a point from the contour of a view (Eq. 3.4).
//!
//! The thesis lays a spline through the contour's points and finds its nearest point by the secant method within the
//! recorded ends `t0` to `t1`. Here the contour is the polyline through the same points and its nearest point is exact: for
//! points one pixel apart on a curve of 20 px radius the two differ by `1 / (8 * 20)`, 0.006 px. An open curve ends where
//! its points end; a closed one is closed by a last side.

use biplane_artifact::Curves;
use biplane_fluoroscope::Distortion;
use biplane_geometry::Point2;

/// Sides of a piece.
const PIECE: usize = 16;

/// The curves of one view, cut into pieces with a box around each.
#[derive(Debug, Clone, Default)]
pub struct Contour {
    sides: Vec<[Point2; 2]>,
    pieces: Vec<Piece>,
}

#[derive(Debug, Clone, Copy)]
struct Piece {
    low: Point2,
    high: Point2,
    /// Its sides, from and to.
    sides: (usize, usize),
}

impl Piece {
    /// Square of the distance of a point from the box, 0 inside.
    fn distance_squared(&self, at: &Point2) -> f64 {
        let beside = |axis: usize| (self.low[axis] - at[axis]).max(at[axis] - self.high[axis]).max(0.0);
        beside(0).powi(2) + beside(1).powi(2)
    }
}

fn to_side_squared([from, to]: &[Point2; 2], at: &Point2) -> f64 {
    let (along, off) = (to - from, at - from);
    let length = along.norm_squared();
    let t = if length > 0.0 { (off.dot(&along) / length).clamp(0.0, 1.0) } else { 0.0 };
    (off - along * t).norm_squared()
}

impl Contour {
    /// From curves in recorded pixels, corrected for distortion if there is any. Points that are not finite are left out.
    pub fn new(curves: &Curves, distortion: Option<&Distortion>) -> Self {
        let mut contour = Self::default();
        for curve in &curves.0 {
            let points: Vec<Point2> = curve
                .points
                .iter()
                .map(|p| distortion.map_or(p.position, |d| d.ideal(&p.position)))
                .filter(|p| p.coords.iter().all(|v| v.is_finite()))
                .collect();
            contour.add(&points, curve.closed);
        }
        contour
    }

    fn add(&mut self, points: &[Point2], closed: bool) {
        let (Some(first), Some(last)) = (points.first(), points.last()) else { return };
        let from = self.sides.len();
        self.sides.extend(points.windows(2).map(|w| [w[0], w[1]]));
        if closed || points.len() == 1 {
            self.sides.push([*last, *first]);
        }
        let end = self.sides.len();
        for start in (from..end).step_by(PIECE) {
            let sides = (start, end.min(start + PIECE));
            let (mut low, mut high) = (self.sides[start][0], self.sides[start][0]);
            for p in self.sides[sides.0..sides.1].iter().flatten() {
                low = low.inf(p);
                high = high.sup(p);
            }
            self.pieces.push(Piece { low, high, sides });
        }
    }

    /// Whether there is nothing to be near to.
    pub fn is_empty(&self) -> bool {
        self.sides.is_empty()
    }

    /// Distance of an ideal pixel from the contour, px; infinite if it is empty. `near` is the place of the piece found
    /// last: the search is quicker if it holds the one of a neighbour, and the same whatever it holds.
    pub fn distance_px(&self, at: &Point2, near: &mut usize) -> f64 {
        let within = |piece: &Piece| {
            let sides = &self.sides[piece.sides.0..piece.sides.1];
            sides.iter().map(|s| to_side_squared(s, at)).fold(f64::INFINITY, f64::min)
        };
        let mut best = self.pieces.get(*near).map_or(f64::INFINITY, within);
        for (index, piece) in self.pieces.iter().enumerate() {
            if piece.distance_squared(at) < best {
                let distance = within(piece);
                if distance < best {
                    (best, *near) = (distance, index);
                }
            }
        }
        best.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_geometry::{Curve, EdgePoint, Vector2};
    use rand::{Rng, SeedableRng};

    fn curve(points: &[(f64, f64)], closed: bool) -> Curve {
        let point = |p: &(f64, f64)| EdgePoint {
            position: Point2::new(p.0, p.1),
            direction: Vector2::x(),
            strength: 1.0,
            sigma_px: 0.1,
        };
        Curve { points: points.iter().map(point).collect(), closed }
    }

    #[test]
    fn an_open_curve_ends_where_its_points_end_and_a_closed_one_does_not() {
        let corners = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)];
        let distance = |closed: bool, x: f64, y: f64| {
            let contour = Contour::new(&Curves(vec![curve(&corners, closed)]), None);
            contour.distance_px(&Point2::new(x, y), &mut 0)
        };
        assert_eq!(distance(true, -1.0, 5.0), 1.0);
        assert_eq!(distance(false, -1.0, 5.0), 26.0_f64.sqrt());
        assert_eq!(distance(false, 13.0, 14.0), 5.0);
        let one = Contour::new(&Curves(vec![curve(&[(3.0, 4.0)], false), curve(&[], true)]), None);
        assert_eq!(one.distance_px(&Point2::origin(), &mut 7), 5.0);
        assert_eq!(Contour::default().distance_px(&Point2::origin(), &mut 0), f64::INFINITY);
    }

    #[test]
    fn finds_what_a_search_through_all_sides_finds_whatever_it_begins_with() {
        let mut random = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(5);
        let curves: Vec<Curve> = (0..7)
            .map(|k| {
                let (mut x, mut y) = (random.random_range(0.0..500.0), random.random_range(0.0..500.0));
                let points: Vec<_> = (0..random.random_range(1..90))
                    .map(|_| {
                        x += random.random_range(-2.0..3.0);
                        y += random.random_range(-2.0..2.0);
                        (x, y)
                    })
                    .collect();
                curve(&points, k % 2 == 0)
            })
            .collect();
        let contour = Contour::new(&Curves(curves), None);
        for _ in 0..2000 {
            let at = Point2::new(random.random_range(-200.0..900.0), random.random_range(-200.0..900.0));
            let all = contour.sides.iter().map(|s| to_side_squared(s, &at)).fold(f64::INFINITY, f64::min);
            let mut near = random.random_range(0..contour.pieces.len() + 2);
            assert_eq!(contour.distance_px(&at, &mut near), all.sqrt());
        }
    }
}
