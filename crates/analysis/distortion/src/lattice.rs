//! Endless lattices: squares, and equilateral triangles.

use biplane_geometry::{Point2, Vector2};

/// Points `pitch (i, 0) + j pitch up`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lattice {
    pitch_mm: f64,
    up: Vector2,
}

impl Lattice {
    /// Squares of this side, mm.
    pub(crate) fn square(pitch_mm: f64) -> Self {
        Self { pitch_mm, up: Vector2::y() }
    }

    /// Equilateral triangles of this side, mm.
    pub(crate) fn hexagonal(pitch_mm: f64) -> Self {
        Self { pitch_mm, up: Vector2::new(0.5, 0.75_f64.sqrt()) }
    }

    /// Distance of neighbours, mm.
    pub(crate) fn pitch_mm(&self) -> f64 {
        self.pitch_mm
    }

    /// Where a point is, mm.
    pub(crate) fn at(&self, [i, j]: [i64; 2]) -> Point2 {
        Point2::from((Vector2::x() * i as f64 + self.up * j as f64) * self.pitch_mm)
    }

    /// The number of the nearest point.
    pub(crate) fn nearest(&self, place: &Point2) -> [i64; 2] {
        let row = place.y / (self.pitch_mm * self.up.y);
        let candidates = [row.floor(), row.ceil()].map(|j| {
            let i = (place.x / self.pitch_mm - j * self.up.x).round();
            // A number out of the range of integers becomes the nearest one in it.
            [i as i64, j as i64]
        });
        let distance = |n: &[i64; 2]| (self.at(*n) - place).norm_squared();
        if distance(&candidates[1]) < distance(&candidates[0]) { candidates[1] } else { candidates[0] }
    }

    /// How many points there are to an area of the plane, 1/mm^2.
    pub(crate) fn density(&self) -> f64 {
        1.0 / (self.pitch_mm * self.pitch_mm * self.up.y)
    }

    /// The numbers of all points within `reach` mm of a place; at most `most`, else `None`.
    pub(crate) fn within(&self, place: &Point2, reach: f64, most: usize) -> Option<Vec<[i64; 2]>> {
        let expected = std::f64::consts::PI * (reach + self.pitch_mm).powi(2) * self.density();
        let countable = expected <= 2.0 * most as f64;
        countable.then_some(())?;
        let rows = |y: f64| y / (self.pitch_mm * self.up.y);
        let mut found = Vec::new();
        for j in (rows(place.y - reach).ceil() as i64)..=(rows(place.y + reach).floor() as i64) {
            let shift = j as f64 * self.up.x;
            let first = ((place.x - reach) / self.pitch_mm - shift).ceil() as i64;
            let last = ((place.x + reach) / self.pitch_mm - shift).floor() as i64;
            found.extend((first..=last).map(|i| [i, j]).filter(|n| (self.at(*n) - place).norm() <= reach));
        }
        (found.len() <= most).then_some(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_point_is_the_nearest() {
        for lattice in [Lattice::square(3.0), Lattice::hexagonal(3.0)] {
            for k in 0..400 {
                let place = Point2::new(f64::from(k % 20) * 0.83 - 5.0, f64::from(k / 20) * 0.71 - 8.0);
                let best = (lattice.at(lattice.nearest(&place)) - place).norm();
                for i in -10..10 {
                    for j in -10..10 {
                        assert!((lattice.at([i, j]) - place).norm() >= best - 1e-9, "{place} {i} {j}");
                    }
                }
            }
        }
    }

    #[test]
    fn points_within_a_circle_are_counted_by_gauss() {
        // Gauss's circle problem: 81 integer points within 5 of the origin; 37 of the triangles within 3.
        assert_eq!(Lattice::square(2.0).within(&Point2::origin(), 10.0, 1000).unwrap().len(), 81);
        assert_eq!(Lattice::hexagonal(2.0).within(&Point2::origin(), 6.0 + 1e-9, 1000).unwrap().len(), 37);
        assert_eq!(Lattice::square(2.0).within(&Point2::origin(), 1e9, 1000), None);
        assert_eq!(Lattice::square(2.0).within(&Point2::origin(), f64::NAN, 1000), None);
        assert_eq!(Lattice::square(1.0).nearest(&Point2::new(1e300, -1e300)), [i64::MAX, i64::MIN]);
    }
}
