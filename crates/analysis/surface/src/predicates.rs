//! On which side of a plane or line a point lies: exact signs (Shewchuk, "Adaptive precision floating-point arithmetic and fast
//! robust geometric predicates", 1997).
//!
//! The determinant is computed in floating point, and its sign taken where it is larger than the bound of its rounding error.
//! Otherwise it is computed as an expansion: a sum of doubles that do not overlap, whose value is exact.

use biplane_geometry::Point3;

/// Half an ulp of 1: the relative rounding error.
const EPSILON: f64 = f64::EPSILON / 2.0;
const SPACE_BOUND: f64 = (7.0 + 56.0 * EPSILON) * EPSILON;
const PLANE_BOUND: f64 = (3.0 + 16.0 * EPSILON) * EPSILON;

/// The sign of `(d - a) . ((b - a) x (c - a))`: 1 where `d` is on the side from which `a, b, c` are counter-clockwise, -1 on the
/// other, 0 in their plane.
pub(crate) fn side_of_plane(a: &Point3, b: &Point3, c: &Point3, d: &Point3) -> i32 {
    let (u, v, w) = (b - a, c - a, d - a);
    let (xy, yx) = (u.x * v.y, u.y * v.x);
    let (yz, zy) = (u.y * v.z, u.z * v.y);
    let (zx, xz) = (u.z * v.x, u.x * v.z);
    let value = w.x * (yz - zy) + w.y * (zx - xz) + w.z * (xy - yx);
    let size = w.x.abs() * (yz.abs() + zy.abs())
        + w.y.abs() * (zx.abs() + xz.abs())
        + w.z.abs() * (xy.abs() + yx.abs());
    // Half a per cent above Shewchuk's bound, since the terms are added in another order.
    let bound = 1.005 * SPACE_BOUND * size;
    if value > bound {
        1
    } else if value < -bound {
        -1
    } else {
        exact_side_of_plane(a, b, c, d)
    }
}

#[cold]
fn exact_side_of_plane(a: &Point3, b: &Point3, c: &Point3, d: &Point3) -> i32 {
    let from_a = |p: &Point3| [0, 1, 2].map(|i| Expansion::difference(p[i], a[i]));
    let (u, v, w) = (from_a(b), from_a(c), from_a(d));
    let mut value = Expansion::ZERO;
    for (i, height) in w.iter().enumerate() {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let minor = u[j].times(&v[k]).plus(&u[k].times(&v[j]).negative());
        value = value.plus(&minor.times(height));
    }
    value.sign()
}

/// The sign of twice the area of `a, b, c`, coordinates `x` and `y` alone: 1 where they are counter-clockwise.
pub(crate) fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> i32 {
    let (left, right) = ((a[0] - c[0]) * (b[1] - c[1]), (a[1] - c[1]) * (b[0] - c[0]));
    let value = left - right;
    let bound = 1.005 * PLANE_BOUND * (left.abs() + right.abs());
    if value > bound {
        return 1;
    } else if value < -bound {
        return -1;
    }
    let d = Expansion::difference;
    let left = d(a[0], c[0]).times(&d(b[1], c[1]));
    let right = d(a[1], c[1]).times(&d(b[0], c[0]));
    left.plus(&right.negative()).sign()
}

/// Terms of the longest sum here: three products of sixteen terms and two.
const TERMS: usize = 192;

/// A sum of doubles, smallest first, that do not overlap; without zeros.
#[derive(Clone, Copy)]
struct Expansion {
    terms: [f64; TERMS],
    count: usize,
}

impl Expansion {
    const ZERO: Self = Self { terms: [0.0; TERMS], count: 0 };

    fn push(&mut self, term: f64) {
        if term != 0.0 {
            self.terms[self.count] = term;
            self.count += 1;
        }
    }

    fn as_slice(&self) -> &[f64] {
        &self.terms[..self.count]
    }

    /// `a - b`, exactly.
    fn difference(a: f64, b: f64) -> Self {
        let (value, error) = two_sum(a, -b);
        let mut this = Self::ZERO;
        this.push(error);
        this.push(value);
        this
    }

    fn negative(mut self) -> Self {
        for term in &mut self.terms[..self.count] {
            *term = -*term;
        }
        self
    }

    /// Shewchuk's fast expansion sum.
    fn plus(&self, other: &Self) -> Self {
        let (e, f) = (self.as_slice(), other.as_slice());
        let mut this = Self::ZERO;
        let (mut i, mut j) = (0, 0);
        let mut take = || {
            let first = j >= f.len() || (i < e.len() && e[i].abs() <= f[j].abs());
            let term = if first { e.get(i) } else { f.get(j) };
            *(if first { &mut i } else { &mut j }) += 1;
            term.copied()
        };
        let Some(mut value) = take() else { return this };
        while let Some(term) = take() {
            let (sum, error) = two_sum(value, term);
            this.push(error);
            value = sum;
        }
        this.push(value);
        this
    }

    /// The sum of this scaled by each term of the other.
    fn times(&self, other: &Self) -> Self {
        other.as_slice().iter().fold(Self::ZERO, |sum, &factor| sum.plus(&self.scaled(factor)))
    }

    /// Shewchuk's scaling of an expansion.
    fn scaled(&self, factor: f64) -> Self {
        let mut this = Self::ZERO;
        let Some((&first, rest)) = self.as_slice().split_first() else { return this };
        let (mut value, error) = two_product(first, factor);
        this.push(error);
        for &term in rest {
            let (high, low) = two_product(term, factor);
            let (sum, error) = two_sum(value, low);
            this.push(error);
            let (sum, error) = fast_two_sum(high, sum);
            this.push(error);
            value = sum;
        }
        this.push(value);
        this
    }

    fn sign(&self) -> i32 {
        match self.as_slice().last() {
            Some(&largest) if largest > 0.0 => 1,
            Some(_) => -1,
            None => 0,
        }
    }
}

fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let from_b = sum - a;
    (sum, (a - (sum - from_b)) + (b - from_b))
}

fn fast_two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    (sum, b - (sum - a))
}

fn two_product(a: f64, b: f64) -> (f64, f64) {
    let split = |x: f64| {
        let big = 134_217_729.0 * x;
        let high = big - (big - x);
        (high, x - high)
    };
    let product = a * b;
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    (product, al * bl - (((product - ah * bh) - al * bh) - ah * bl))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    /// Whole numbers of up to 40 bits: the determinant fits into 128 bits.
    #[test]
    fn signs_are_those_of_whole_numbers() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
        let mut zeros = 0;
        for round in 0..20_000 {
            let size: i64 = if round % 2 == 0 { 3 } else { 1 << 39 };
            let mut p: Vec<[i64; 3]> =
                (0..4).map(|_| [0; 3].map(|_: i64| random.random_range(-size..=size))).collect();
            if round % 4 == 3 {
                // In the plane of the others but for a step of one: far below what doubles tell apart.
                let (i, j) = (random.random_range(-3..=3), random.random_range(-3..=3));
                let step = random.random_range(-1..=1);
                p[3] = [0, 1, 2].map(|k| p[0][k] + i * (p[1][k] - p[0][k]) + j * (p[2][k] - p[0][k]));
                p[3][0] += step;
            }
            let from = |q: usize| [0, 1, 2].map(|k| i128::from(p[q][k] - p[0][k]));
            let (u, v, w) = (from(1), from(2), from(3));
            let minor = |i: usize, j: usize| u[i] * v[j] - u[j] * v[i];
            let truth = w[0] * minor(1, 2) + w[1] * minor(2, 0) + w[2] * minor(0, 1);
            let at = |q: usize| Point3::from(p[q].map(|c| c as f64));
            assert_eq!(side_of_plane(&at(0), &at(1), &at(2), &at(3)), truth.signum() as i32, "{p:?}");
            zeros += u32::from(truth == 0);
            let flat = |q: usize| [p[q][0] as f64, p[q][1] as f64];
            assert_eq!(turn(flat(0), flat(1), flat(2)), minor(0, 1).signum() as i32);
        }
        assert!(zeros > 500);
    }

    /// Coordinates with all their bits: exchanging two points turns the sign, and the middle of a side is in the plane or beside
    /// it by rounding alone, seen the same from all.
    #[test]
    fn signs_agree_among_themselves() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
        for _ in 0..5_000 {
            let mut any = || Point3::new(random.random(), random.random(), random.random::<f64>() * 1e-3);
            let (a, b, c) = (any(), any(), any());
            let (s, t) = (random.random::<f64>(), random.random::<f64>());
            let d = a + (b - a) * s + (c - a) * t;
            let sign = side_of_plane(&a, &b, &c, &d);
            assert_eq!(sign, side_of_plane(&b, &c, &a, &d));
            assert_eq!(sign, -side_of_plane(&b, &a, &c, &d));
            assert_eq!(sign, -side_of_plane(&d, &b, &c, &a));
            assert_eq!(sign, side_of_plane(&c, &d, &a, &b));
        }
    }
}
