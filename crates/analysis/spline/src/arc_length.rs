//! Lengths along a spline, by Gauss-Legendre quadrature of its speed.

use biplane_geometry::Point2;

use crate::Spline;
use crate::cubic::Cubic;

/// Nodes and weights of the Gauss-Legendre rule of 8 points on (-1, 1), the positive half of it.
const RULE: [[f64; 2]; 4] = [
    [0.183_434_642_495_649_8, 0.362_683_783_378_362],
    [0.525_532_409_916_329, 0.313_706_645_877_887_3],
    [0.796_666_477_413_626_7, 0.222_381_034_453_374_5],
    [0.960_289_856_497_536_3, 0.101_228_536_290_376_3],
];
/// Halvings of an interval: near a cusp, where the speed has a kink, the rule converges slowly.
const DEEPEST: u32 = 40;
/// Difference of a rule from its two halves that ends the halving, of the length of the cubic. What is left after it is far less.
const SMALL: f64 = 1e-11;

/// The length along a spline from its start, as a table of its cubics. Relative error below 1e-9.
#[derive(Debug, Clone)]
pub struct ArcLength<'a> {
    spline: &'a Spline,
    /// Length up to each knot, px.
    lengths: Vec<f64>,
}

impl Cubic {
    /// Length of its stretch from `from` to `to`.
    pub(crate) fn length(&self, from: f64, to: f64) -> f64 {
        let whole = self.rule(from, to);
        let scale = self.slope(0.0).norm() + self.slope(0.5).norm() + self.slope(1.0).norm();
        self.refined(from, to, whole, SMALL * scale, DEEPEST)
    }

    fn rule(&self, from: f64, to: f64) -> f64 {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let pair = |[x, w]: &[f64; 2]| {
            w * (self.slope(middle - half * x).norm() + self.slope(middle + half * x).norm())
        };
        half * RULE.iter().map(pair).sum::<f64>()
    }

    fn refined(&self, from: f64, to: f64, whole: f64, small: f64, depth: u32) -> f64 {
        let middle = 0.5 * (from + to);
        let (left, right) = (self.rule(from, middle), self.rule(middle, to));
        if depth == 0 || (left + right - whole).abs() <= small {
            return left + right;
        }
        self.refined(from, middle, left, small, depth - 1) + self.refined(middle, to, right, small, depth - 1)
    }
}

impl<'a> ArcLength<'a> {
    /// Measures a spline.
    pub fn new(spline: &'a Spline) -> Self {
        let mut lengths = vec![0.0];
        let mut sum = 0.0;
        for index in 0..spline.cubic_count() {
            sum += spline.cubic(index).0.length(0.0, 1.0);
            lengths.push(sum);
        }
        Self { spline, lengths }
    }

    /// Length of all of it, px.
    pub fn total(&self) -> f64 {
        self.lengths[self.lengths.len() - 1]
    }

    /// Length from the start to parameter `t`, px; `t` goes round or is held as of the spline, but the end of a closed one has its whole
    /// length.
    pub fn at(&self, t: f64) -> f64 {
        if t == self.spline.end() {
            return self.total();
        }
        let t = if t.is_finite() { self.spline.wrapped(t) } else { 0.0 };
        let index = self.spline.cubic_at(t);
        let (cubic, from, length) = self.spline.cubic(index);
        self.lengths[index] + cubic.length(0.0, (t - from) / length)
    }

    /// Parameter at a length from the start, px, which is held between 0 and the whole.
    pub fn parameter(&self, length: f64) -> f64 {
        let wanted = if length.is_nan() { 0.0 } else { length.clamp(0.0, self.total()) };
        let index = self.lengths.partition_point(|l| *l <= wanted).clamp(1, self.lengths.len() - 1) - 1;
        let (cubic, from, chord) = self.spline.cubic(index);
        let (begin, all) = (self.lengths[index], self.lengths[index + 1] - self.lengths[index]);
        let (mut low, mut high) = (0.0, 1.0);
        let mut s = if all > 0.0 { ((wanted - begin) / all).clamp(0.0, 1.0) } else { 0.0 };
        for _ in 0..100 {
            let off = cubic.length(0.0, s) - (wanted - begin);
            if off > 0.0 {
                high = s
            } else {
                low = s
            }
            let next = s - off / cubic.slope(s).norm();
            let inside = next >= low && next <= high;
            let next = if inside { next } else { 0.5 * (low + high) };
            let step = (next - s).abs();
            s = next;
            if (inside && step < 1e-9) || high - low < 1e-15 {
                break;
            }
        }
        from + s * chord
    }

    /// The point at a length from the start, px.
    pub fn point(&self, length: f64) -> Point2 {
        // Not by the parameter of the whole of a closed spline alone, which is its start: that is the same point.
        self.spline.point(self.parameter(length))
    }
}
