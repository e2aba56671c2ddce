//! Symmetric positive definite systems with two diagonals on either side, open or cyclic, solved in a time proportional to their size.
//!
//! A cyclic matrix is cut before its last two rows: `[T U; U' C]` with `T` a plain band. `T = L D L'`, and the last two unknowns follow
//! from the Schur complement `S = C - U' T^-1 U`. The entries of the inverse within the band come from the recursion of M. F. Hutchinson
//! and F. R. de Hoog (Smoothing noisy data with spline functions, Numerische Mathematik 47, 1985).

use nalgebra::{Matrix2, Vector2};

/// A symmetric matrix with two diagonals on either side.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Band {
    /// Rows of the plain band: the entry on the diagonal and the two to the right of it.
    rows: Vec<[f64; 3]>,
    /// The columns of the last two unknowns of a cyclic matrix, a row for each of the plain band; empty in an open one.
    border: Vec<[f64; 2]>,
    /// The block of these two unknowns.
    last: Matrix2<f64>,
}

/// A factorised matrix. It can be filled again and again without new memory.
#[derive(Debug)]
pub(crate) struct Factors {
    /// `L[i + 1, i]`, `L[i + 2, i]`, `1 / D[i]`.
    rows: Vec<[f64; 3]>,
    /// `T^-1 U`; empty for an open matrix.
    border: Vec<[f64; 2]>,
    /// `S^-1`.
    last: Matrix2<f64>,
}

impl Band {
    /// Zeros. A cyclic matrix needs at least 3 rows.
    pub fn zeros(size: usize, cyclic: bool) -> Self {
        let plain = if cyclic { size.saturating_sub(2) } else { size };
        let border = if cyclic { vec![[0.0; 2]; plain] } else { Vec::new() };
        Self { rows: vec![[0.0; 3]; plain], border, last: Matrix2::zeros() }
    }

    /// Adds to the entries `(i, j)` and `(j, i)`, or once to `(i, i)`; they must lie within the (cyclic) band.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        let plain = self.rows.len();
        let (i, j) = (i.min(j), i.max(j));
        if j < plain {
            self.rows[i][j - i] += value;
        } else if i < plain {
            self.border[i][j - plain] += value;
        } else {
            self.last[(i - plain, j - plain)] += value;
            if i != j {
                self.last[(j - plain, i - plain)] += value;
            }
        }
    }
}

impl Factors {
    /// Nothing yet.
    pub fn new() -> Self {
        Self { rows: Vec::new(), border: Vec::new(), last: Matrix2::zeros() }
    }

    /// Factorises `first + weight * second`, two matrices of one shape; `None` where that is not positive definite.
    pub fn factorise(&mut self, first: &Band, weight: f64, second: &Band) -> Option<()> {
        self.rows.clear();
        // Of the two rows before: L[i + 1, i], L[i + 2, i], and both times D[i].
        let (mut before, mut earlier) = ([0.0; 4], [0.0; 4]);
        for (a, b) in first.rows.iter().zip(&second.rows) {
            let d = a[0] + weight * b[0] - before[0] * before[2] - earlier[1] * earlier[3];
            if !(d > 0.0 && d.is_finite()) {
                return None;
            }
            let one = a[1] + weight * b[1] - before[0] * before[3];
            let two = a[2] + weight * b[2];
            let inverse = 1.0 / d;
            earlier = before;
            before = [one * inverse, two * inverse, one, two];
            self.rows.push([before[0], before[1], inverse]);
        }
        self.border.clear();
        if first.border.is_empty() {
            return Some(());
        }
        let border = |(a, b): (&[f64; 2], &[f64; 2])| [a[0] + weight * b[0], a[1] + weight * b[1]];
        self.border.extend(first.border.iter().zip(&second.border).map(border));
        let mut last = first.last + second.last * weight;
        let mut solved = std::mem::take(&mut self.border);
        self.substitute(&mut solved);
        for (a, b) in first.border.iter().zip(&second.border).map(border).zip(&solved) {
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                last[(i, j)] -= a[i] * b[j];
            }
        }
        self.border = solved;
        let determinant = last.determinant();
        if !(last[(0, 0)] > 0.0 && determinant > 0.0 && determinant.is_finite()) {
            return None;
        }
        self.last = last.try_inverse()?;
        Some(())
    }

    /// `T^-1` times two columns, in place.
    fn substitute(&self, right: &mut [[f64; 2]]) {
        let (mut before, mut earlier) = ([0.0; 2], [0.0; 2]);
        // L of the row before, and L[i, i - 2].
        let (mut l, mut l2) = ([0.0; 2], 0.0);
        for (row, x) in self.rows.iter().zip(right.iter_mut()) {
            for k in 0..2 {
                x[k] -= l[0] * before[k] + l2 * earlier[k];
            }
            (l2, l) = (l[1], [row[0], row[1]]);
            (earlier, before) = (before, *x);
        }
        let (mut next, mut later) = ([0.0; 2], [0.0; 2]);
        for (row, x) in self.rows.iter().zip(right).rev() {
            for k in 0..2 {
                x[k] = x[k] * row[2] - (row[0] * next[k] + row[1] * later[k]);
            }
            (later, next) = (next, *x);
        }
    }

    /// Solves for two columns, in place.
    pub fn solve(&self, right: &mut [[f64; 2]]) {
        let (head, tail) = right.split_at_mut(self.rows.len().min(right.len()));
        // U' T^-1 b = (T^-1 U)' b, of the right side as it came.
        let mut reduced = [[0.0; 2]; 2];
        for (z, b) in self.border.iter().zip(head.iter()) {
            for (row, z) in reduced.iter_mut().zip(z) {
                row[0] += z * b[0];
                row[1] += z * b[1];
            }
        }
        self.substitute(head);
        let [x, y] = tail else { return };
        for k in 0..2 {
            let last = self.last * Vector2::new(x[k] - reduced[0][k], y[k] - reduced[1][k]);
            (x[k], y[k]) = (last[0], last[1]);
            for (z, b) in self.border.iter().zip(head.iter_mut()) {
                b[k] -= z[0] * last[0] + z[1] * last[1];
            }
        }
    }

    /// Entries of the inverse on the diagonal and one and two places to the right of it, row by row; those of a cyclic matrix go round.
    pub fn inverse_band(&self, band: &mut Vec<[f64; 3]>) {
        let plain = self.rows.len();
        band.clear();
        band.resize(plain, [0.0; 3]);
        let (mut next, mut later) = ([0.0; 3], [0.0; 3]);
        for (row, out) in self.rows.iter().zip(band.iter_mut()).rev() {
            let two = -row[0] * next[1] - row[1] * later[0];
            let one = -row[0] * next[0] - row[1] * next[1];
            let here = row[2] - row[0] * one - row[1] * two;
            *out = [here, one, two];
            (later, next) = (next, *out);
        }
        if self.border.is_empty() {
            return;
        }
        // [T^-1 + Z S^-1 Z', -Z S^-1; ., S^-1] with Z = T^-1 U.
        let weighed: Vec<Vector2<f64>> = self.border.iter().map(|z| self.last * Vector2::from(*z)).collect();
        for (i, out) in band.iter_mut().enumerate() {
            for (k, entry) in out.iter_mut().enumerate() {
                match weighed.get(i + k) {
                    Some(w) => *entry += self.border[i][0] * w[0] + self.border[i][1] * w[1],
                    None => *entry = -weighed[i][i + k - plain],
                }
            }
        }
        // The row after the last one is the first.
        band.push([self.last[(0, 0)], self.last[(0, 1)], -weighed[0][0]]);
        // In a matrix of 3 rows the second one after the last is before the last.
        let second = weighed.get(1).map_or(self.last[(0, 1)], |w| -w[1]);
        band.push([self.last[(1, 1)], -weighed[0][1], second]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;
    use rand::{Rng, SeedableRng};

    /// A random positive definite matrix of the kind, as a band and in full.
    fn random(size: usize, cyclic: bool, seed: u64) -> (Band, DMatrix<f64>) {
        let mut random = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(seed);
        let (mut band, mut full) = (Band::zeros(size, cyclic), DMatrix::zeros(size, size));
        // A sum of squares of three neighbouring unknowns each.
        for k in 0..size {
            let near = [(k + size - 1) % size, k, (k + 1) % size];
            let mut q: Vec<(usize, f64)> =
                near.into_iter().map(|j| (j, random.random_range(-1.0..1.0))).collect();
            if !cyclic {
                q.retain(|(j, _)| j.abs_diff(k) <= 1);
                q.dedup_by_key(|(j, _)| *j);
            }
            for (a, (i, u)) in q.iter().enumerate() {
                for (j, v) in &q[a..] {
                    band.add(*i, *j, u * v);
                    full[(*i, *j)] += u * v;
                    if i != j {
                        full[(*j, *i)] += u * v;
                    }
                }
            }
            band.add(k, k, 0.1);
            full[(k, k)] += 0.1;
        }
        (band, full)
    }

    #[test]
    fn solution_and_inverse_are_those_of_the_full_matrix() {
        for (size, cyclic) in [
            (1, false),
            (2, false),
            (3, false),
            (9, false),
            (3, true),
            (4, true),
            (5, true),
            (6, true),
            (12, true),
        ] {
            let (first, full_first) = random(size, cyclic, 7);
            let (second, full_second) = random(size, cyclic, 8);
            let full = full_first + full_second * 3.0;
            let mut factors = Factors::new();
            factors.factorise(&first, 3.0, &second).unwrap();
            let mut right: Vec<[f64; 2]> = (0..size).map(|i| [i as f64, (i * i) as f64 - 3.0]).collect();
            let expected = full.clone().try_inverse().unwrap();
            let columns = DMatrix::from_fn(size, 2, |i, k| right[i][k]);
            factors.solve(&mut right);
            let solution = &expected * columns;
            let mut band = Vec::new();
            factors.inverse_band(&mut band);
            assert_eq!(band.len(), size);
            for i in 0..size {
                for k in 0..2 {
                    assert!((right[i][k] - solution[(i, k)]).abs() < 1e-10, "{size} {cyclic} row {i}");
                }
                for k in 0..3 {
                    if cyclic || i + k < size {
                        let want = expected[(i, (i + k) % size)];
                        assert!((band[i][k] - want).abs() < 1e-10, "{size} {cyclic}: ({i}, {k})");
                    }
                }
            }
        }
    }

    #[test]
    fn what_is_not_positive_definite_is_refused() {
        let mut band = Band::zeros(3, false);
        band.add(0, 0, 1.0);
        assert!(Factors::new().factorise(&band, 0.0, &Band::zeros(3, false)).is_none());
    }
}
