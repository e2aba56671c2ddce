//! A few points of curves, to find which of them is nearest in place and direction to any other point, however far.
//!
//! All are compared with: for some hundred points that is faster than a tree, and costs the same wherever one looks.

use biplane_geometry::{EdgePoint, Point2, Vector2};

/// Points compared at once.
const LANES: usize = 8;
/// Bits of a cost that give way to a number: it keeps 16 of its 24, a hundred-thousandth of itself.
const ROW_MASK: u32 = 0xff;

/// A point with a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sparse {
    /// Ideal pixel.
    pub position: Point2,
    /// Unit direction, dark to bright.
    pub direction: Vector2,
}

/// Points with directions, a list for each number.
#[derive(Debug, Clone, Default)]
pub struct SparseEdges {
    points: Vec<Sparse>,
    columns: [Vec<f32>; 4],
}

impl SparseEdges {
    /// One of every `spacing` px of `points`, which come along their curves.
    pub fn of(points: &[EdgePoint], spacing: f64) -> Self {
        let mut kept = Self::default();
        let mut passed = f64::INFINITY;
        let mut last: Option<&EdgePoint> = None;
        for p in points {
            passed += last.map_or(0.0, |l| (p.position - l.position).norm());
            if passed >= spacing {
                passed = 0.0;
                kept.push(Sparse { position: p.position, direction: p.direction });
            }
            last = Some(p);
        }
        kept
    }

    /// Forgets all points.
    pub fn clear(&mut self) {
        self.points.clear();
        self.columns.iter_mut().for_each(Vec::clear);
    }

    /// Adds a point.
    pub fn push(&mut self, p: Sparse) {
        // Numbers that are no places would never be the nearest; a list filled up to whole lanes has them.
        self.columns.iter_mut().for_each(|c| c.truncate(self.points.len()));
        let row = [p.position.x, p.position.y, p.direction.x, p.direction.y];
        for (column, v) in self.columns.iter_mut().zip(row) {
            column.push(v as f32);
            while column.len() % LANES != 0 {
                column.push(f32::MAX.sqrt() / 4.0);
            }
        }
        self.points.push(p);
    }

    /// The points.
    pub fn points(&self) -> &[Sparse] {
        &self.points
    }

    /// The point for which `distance^2 + turn_px^2 (1 - cos)` is least, px^2, and that; `turn_px` says how far a right angle is.
    pub fn nearest(&self, at: &Sparse, turn_px: f64) -> Option<(&Sparse, f64)> {
        let (number, cost) = self.least(at, turn_px)?;
        Some((self.points.get(number)?, cost))
    }

    /// The number of that point.
    pub fn nearest_number(&self, at: &Sparse, turn_px: f64) -> Option<usize> {
        self.least(at, turn_px).map(|found| found.0)
    }

    fn least(&self, at: &Sparse, turn_px: f64) -> Option<(usize, f64)> {
        let [x, y, u, v] = [at.position.x, at.position.y, at.direction.x, at.direction.y].map(|v| v as f32);
        let turn = (turn_px * turn_px) as f32;
        let mut best: Option<(usize, f32)> = None;
        let mut first = 0;
        // The number of a lane's row stands in the last bits of its cost, which are then compared as one: costs are not negative, and
        // the larger of two such numbers is the one with the larger bits.
        while first < self.columns[0].len() {
            let span = first..self.columns[0].len().min(first + LANES * (ROW_MASK as usize + 1));
            let [xs, ys, us, vs] = self.columns.each_ref().map(|c| c[span.clone()].as_chunks::<LANES>().0);
            let mut least = [f32::INFINITY; LANES];
            for (k, (((xs, ys), us), vs)) in xs.iter().zip(ys).zip(us).zip(vs).enumerate() {
                for i in 0..LANES {
                    let (dx, dy) = (xs[i] - x, ys[i] - y);
                    let cost = dx * dx + dy * dy + turn * (1.0 - us[i] * u - vs[i] * v).abs();
                    let cost = f32::from_bits(cost.to_bits() & !ROW_MASK | k as u32);
                    least[i] = if cost < least[i] { cost } else { least[i] };
                }
            }
            for (lane, cost) in least.into_iter().enumerate() {
                if best.is_none_or(|b| cost < b.1) {
                    best = Some((first + (cost.to_bits() & ROW_MASK) as usize * LANES + lane, cost));
                }
            }
            first = span.end;
        }
        best.filter(|b| b.1.is_finite()).map(|(number, cost)| (number, f64::from(cost)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};

    #[test]
    fn the_nearest_is_that_of_a_plain_search() {
        let mut random = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(4);
        let mut drawn = |span: f64| {
            let a: f64 = random.random_range(0.0..std::f64::consts::TAU);
            Sparse {
                position: Point2::new(random.random_range(-span..span), random.random_range(0.0..span)),
                direction: Vector2::new(a.cos(), a.sin()),
            }
        };
        let mut edges = SparseEdges::default();
        assert!(edges.nearest(&drawn(9.0), 50.0).is_none());
        for count in 1..60 {
            edges.push(drawn(500.0));
            assert_eq!(edges.points().len(), count);
            for _ in 0..30 {
                let at = drawn(700.0);
                let cost = |p: &Sparse| {
                    (p.position - at.position).norm_squared()
                        + 2500.0 * (1.0 - p.direction.dot(&at.direction))
                };
                let (found, value) = edges.nearest(&at, 50.0).unwrap();
                let expected = edges.points().iter().map(cost).fold(f64::INFINITY, f64::min);
                assert!((cost(found) - expected).abs() < 1e-3 * expected + 0.1, "{} {expected}", cost(found));
                assert!((value - expected).abs() < 1e-3 * expected + 0.1);
            }
        }
    }
}
