//! One cubic of the plane: its value, its bound, and its point nearest to a place.

use biplane_geometry::{Point2, Vector2};

/// `P(s) = a0 + a1 s + a2 s^2 + a3 s^3`, `s` from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cubic(pub [Vector2; 4]);

/// Halvings of the interval, after which roots that are still together count as one.
const DEEPEST: u32 = 50;

impl Cubic {
    /// Value at `s`.
    pub fn at(&self, s: f64) -> Vector2 {
        let [a, b, c, d] = self.0;
        ((d * s + c) * s + b) * s + a
    }

    /// First derivative by `s`.
    pub fn slope(&self, s: f64) -> Vector2 {
        let [_, b, c, d] = self.0;
        (d * (3.0 * s) + c * 2.0) * s + b
    }

    /// Second derivative by `s`.
    pub fn bend(&self, s: f64) -> Vector2 {
        let [_, _, c, d] = self.0;
        d * (6.0 * s) + c * 2.0
    }

    /// The stretch from `from` to `to`, its `s` from 0 to 1 again.
    pub fn between(&self, from: f64, to: f64) -> Self {
        let width = to - from;
        let [.., d] = self.0;
        Self([
            self.at(from),
            self.slope(from) * width,
            self.bend(from) * (width * width / 2.0),
            d * width.powi(3),
        ])
    }

    /// Control points as a Bezier curve.
    pub fn controls(&self) -> [Point2; 4] {
        let [a, b, c, d] = self.0;
        [a, a + b / 3.0, a + (b * 2.0 + c) / 3.0, a + b + c + d].map(Point2::from)
    }

    /// From the control points of a Bezier curve.
    pub fn from_controls([p, q, r, s]: &[Point2; 4]) -> Self {
        Self([p.coords, (q - p) * 3.0, ((r - q) - (q - p)) * 3.0, (s - p) - (r - q) * 3.0])
    }

    /// No point lies farther from the straight line between its ends, px: an eighth of the largest second derivative, which is at an end.
    pub fn bulge(&self) -> f64 {
        self.bend(0.0).norm().max(self.bend(1.0).norm()) / 8.0
    }

    /// Its point nearest to a place: `s` from 0 to 1, and the square of the distance.
    ///
    /// All of them are considered: the derivative of the square of the distance is a polynomial of degree 5; in Bernstein form its sign
    /// changes bound its roots (Descartes), and halving parts those that are together.
    pub fn nearest(&self, place: &Point2) -> (f64, f64) {
        let [a, b, c, d] = self.0;
        let off = Self([a - place.coords, b, c, d]);
        let mut best = (0.0, off.0[0].norm_squared());
        off.take(1.0, &mut best);
        let derivative = off.derivative_of_square();
        match sign_changes(&derivative) {
            0 => {}
            1 => off.take_root(&derivative, 0.0, 1.0, &mut best),
            _ => off.isolate(&derivative, 0.0, 1.0, DEEPEST, &mut best),
        }
        best
    }

    /// Keeps the nearer one.
    fn take(&self, s: f64, best: &mut (f64, f64)) {
        let square = self.at(s).norm_squared();
        if square < best.1 {
            *best = (s, square);
        }
    }

    /// `P . P'` in Bernstein form, up to a factor.
    fn derivative_of_square(&self) -> [f64; 6] {
        let [a, b, c, d] = self.0;
        let p = [a, a + b / 3.0, a + (b * 2.0 + c) / 3.0, a + b + c + d];
        let q = [p[1] - p[0], p[2] - p[1], p[3] - p[2]];
        // Sum over i + j = k of C(3, i) C(2, j) / C(5, k) p_i . q_j.
        [
            p[0].dot(&q[0]),
            (2.0 * p[0].dot(&q[1]) + 3.0 * p[1].dot(&q[0])) / 5.0,
            (p[0].dot(&q[2]) + 6.0 * p[1].dot(&q[1]) + 3.0 * p[2].dot(&q[0])) / 10.0,
            (3.0 * p[1].dot(&q[2]) + 6.0 * p[2].dot(&q[1]) + p[3].dot(&q[0])) / 10.0,
            (3.0 * p[2].dot(&q[2]) + 2.0 * p[3].dot(&q[1])) / 5.0,
            p[3].dot(&q[2]),
        ]
    }

    /// Takes every minimum between `from` and `to`, whose derivative in Bernstein form is given.
    #[cold]
    fn isolate(&self, derivative: &[f64; 6], from: f64, to: f64, depth: u32, best: &mut (f64, f64)) {
        match sign_changes(derivative) {
            0 => {}
            1 => self.take_root(derivative, from, to, best),
            _ if depth == 0 => self.take(0.5 * (from + to), best),
            _ => {
                let middle = 0.5 * (from + to);
                self.take(middle, best);
                let (left, right) = halves(derivative);
                self.isolate(&left, from, middle, depth - 1, best);
                self.isolate(&right, middle, to, depth - 1, best);
            }
        }
    }

    /// Takes the one root of `P . P'` between `low` and `high` if it is a minimum: Newton, halving where that leaves the bracket.
    fn take_root(&self, derivative: &[f64; 6], low: f64, high: f64, best: &mut (f64, f64)) {
        // An end may be another root, of a maximum: the sign next to it decides.
        if derivative.iter().find(|v| **v != 0.0).is_some_and(|v| *v < 0.0) {
            let share = derivative[0] / (derivative[0] - derivative[5]);
            // Not from an end itself, for the same reason.
            let share = if (0.01..=0.99).contains(&share) { share } else { 0.5 };
            self.take(self.root(low, high, low + (high - low) * share), best);
        }
    }

    /// Where `P . P'` goes from negative to positive between `low` and `high`.
    fn root(&self, mut low: f64, mut high: f64, mut s: f64) -> f64 {
        for _ in 0..100 {
            let (p, v) = (self.at(s), self.slope(s));
            let f = p.dot(&v);
            if f < 0.0 {
                low = s;
            } else if f > 0.0 {
                high = s;
            } else {
                return s;
            }
            let step = f / (v.norm_squared() + p.dot(&self.bend(s)));
            let next = s - step;
            let inside = next >= low && next <= high;
            let next = if inside { next } else { 0.5 * (low + high) };
            // The error after a step of Newton is of the order of the step's square.
            if (inside && step.abs() < 1e-9) || high - low < 1e-15 {
                return next;
            }
            s = next;
        }
        s
    }
}

/// Sign changes of the coefficients, zeros left out.
fn sign_changes(of: &[f64; 6]) -> usize {
    let (mut changes, mut last) = (0, 0.0);
    for v in of {
        if v * last < 0.0 {
            changes += 1;
        }
        if *v != 0.0 {
            last = v.signum();
        }
    }
    changes
}

/// Both halves of a polynomial in Bernstein form (de Casteljau).
fn halves(of: &[f64; 6]) -> ([f64; 6], [f64; 6]) {
    let (mut left, mut right) = (*of, *of);
    for k in 1..6 {
        for i in (k..6).rev() {
            left[i] = 0.5 * (left[i] + left[i - 1]);
        }
        right[5 - k] = left[5];
    }
    (left, right)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};

    #[test]
    fn the_nearest_point_of_any_cubic_is_nearer_than_all_samples() {
        let mut random = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(3);
        for round in 0..4000 {
            let size = if round % 2 == 0 { 1.0 } else { 30.0 };
            let mut vector = |r: f64| Vector2::new(random.random_range(-r..r), random.random_range(-r..r));
            // Cusps and loops too.
            let cubic = Cubic([vector(5.0), vector(3.0), vector(size), vector(size)]);
            let place = Point2::from(vector(8.0));
            let (s, square) = cubic.nearest(&place);
            assert!((0.0..=1.0).contains(&s));
            assert!(((cubic.at(s) - place.coords).norm_squared() - square).abs() <= 1e-12 * square.max(1.0));
            let samples = (0..=2000).map(|k| (cubic.at(f64::from(k) / 2000.0) - place.coords).norm_squared());
            let least = samples.fold(f64::INFINITY, f64::min);
            assert!(square <= least + 1e-12, "{cubic:?} {place}: {square} {least}");
            // At a minimum within, the curve runs across the way to the place.
            if s > 0.0 && s < 1.0 {
                let slope = cubic.slope(s);
                let along = (cubic.at(s) - place.coords).dot(&slope);
                assert!(along.abs() < 1e-8 * (1.0 + slope.norm_squared()), "{along}");
            }
        }
    }

    #[test]
    fn a_line_run_through_twice_and_a_place_on_it_are_no_trouble() {
        let there_and_back =
            Cubic([Vector2::zeros(), Vector2::new(4.0, 0.0), Vector2::new(-4.0, 0.0), Vector2::zeros()]);
        let (_, square) = there_and_back.nearest(&Point2::new(0.5, 2.0));
        assert!((square - 4.0).abs() < 1e-14);
        let (s, square) = there_and_back.nearest(&Point2::new(3.0, 0.0));
        assert!((s - 0.5).abs() < 1e-9 && (square - 4.0).abs() < 1e-14);
        let still = Cubic([Vector2::new(1.0, 1.0), Vector2::zeros(), Vector2::zeros(), Vector2::zeros()]);
        assert_eq!(still.nearest(&Point2::origin()), (0.0, 2.0));
    }

    #[test]
    fn stretches_and_controls_are_the_same_curve() {
        let cubic = Cubic([
            Vector2::new(1.0, 2.0),
            Vector2::new(3.0, -1.0),
            Vector2::new(-0.5, 4.0),
            Vector2::new(2.0, 0.3),
        ]);
        let part = cubic.between(0.2, 0.7);
        let again = Cubic::from_controls(&cubic.controls());
        for k in 0..=10 {
            let s = f64::from(k) / 10.0;
            assert!((part.at(s) - cubic.at(0.2 + 0.5 * s)).norm() < 1e-14);
            assert!((again.at(s) - cubic.at(s)).norm() < 1e-14);
            let line = cubic.at(0.0).lerp(&cubic.at(1.0), s);
            assert!((cubic.at(s) - line).norm() <= cubic.bulge() + 1e-14);
        }
    }
}
