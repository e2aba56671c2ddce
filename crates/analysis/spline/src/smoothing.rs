//! A spline near points: as smooth as their noise asks for.
//!
//! The smoothing spline minimises `sum |y_i - g(t_i)|^2 / sigma_i^2 + lambda * integral |g''|^2` (C. H. Reinsch, Smoothing by spline
//! functions, Numerische Mathematik 10, 1967; periodic too), solved for the second derivatives at the knots in a time proportional to
//! their number. It pulls round outlines inwards. So what it left is smoothed as well and put back ("twicing", J. W. Tukey 1977; W. Stuetzle
//! and Y. Mittal 1979): a wave of which the smoother loses a share `e` loses `e^2` then, for the same noise with a larger `lambda`.
//!
//! `lambda` is chosen from the points by a [`Choice`]. What decides are the residuals **across** the curve alone: along it a point of an edge
//! has no error that means anything. The degrees of freedom come from the trace of the smoother, which is exact (M. F. Hutchinson and F. R. de
//! Hoog, 1985); that of the smoother used twice is taken for what it is with even spacing. The minimum is looked for downhill from a width of
//! four points, so among several the one next to that is taken.
//!
//! It is least squares: a point that is far off pulls the curve. One that is known to be wrong is best left out: a large standard deviation
//! takes away its pull, but not the length of its chords from the parameter.

use biplane_geometry::{Point2, Vector2};

use crate::Spline;
use crate::band::{Band, Factors};
use crate::knots::{Knots, PointsError};
use crate::minimum::least;
use crate::scatter::noise_factor;
use crate::spline::Roughness;

/// Points nearer to each other than this share of the mean distance are merged: noise along the curve can bring them together.
const SAME: f64 = 1e-3;
/// Powers of two in which the smallest and the first width lie to the mean distance of points. At the smallest the curve goes through them.
const WIDTHS: [f64; 2] = [-4.0, 2.0];
/// Trace of the smoother used twice, `2 A - A^2`, by that of `A`: for points evenly spaced `A` keeps `1 / (1 + x^4)` of a wave, whose
/// square has three quarters of its integral.
const TWICE: f64 = 1.25;
/// A variance that is as good as none, px^2.
const NO_NOISE: f64 = 1e-100;
/// A variance that says as good as nothing, in those of most points: larger ones count as this one, so that the equations keep their
/// precision.
const NOTHING: f64 = 1e4;

/// How the smoothing weight is chosen.
///
/// Root mean square distance from the truth, px, of 20 smoothed ellipses of 100 x 60 px with noise of 0.2 px (measured by
/// `cargo test -p biplane-spline --test noise -- --nocapture`):
///
/// | | risk | discrepancy | cross-validation |
/// |---|---|---|---|
/// | independent, standard deviations as stated | 0.045 | 0.055 | 0.045 |
/// | stated half as large | 0.045 | 0.158 | 0.045 |
/// | stated twice as large | 0.044 | 0.187 | 0.045 |
/// | shared by 5.3 neighbours | 0.157 | 0.094 | 0.198 |
/// | shared, and said so | 0.096 | 0.124 | 0.096 |
/// | shared, said so, stated half as large | 0.097 | 0.109 | 0.096 |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Choice {
    /// Least expected error, by the stated standard deviations (C. L. Mallows, 1973), or where the differences of neighbouring points say
    /// that they are too small, by those (see [`Smoothed::sigma_factor`]).
    #[default]
    Risk,
    /// The weighted sum of squared residuals is what the stated standard deviations let expect, given the degrees of freedom: follows
    /// the noise where these are too small, and flattens the curve where they are too large.
    Discrepancy,
    /// Generalised cross-validation (P. Craven and G. Wahba, 1979): the standard deviations need to be right up to a common factor alone.
    /// Follows noise that neighbours share, unless [`Smoothing::correlated_points`] tells of it.
    CrossValidation,
}

/// How points are smoothed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Smoothing {
    /// How the smoothing weight is chosen.
    pub choice: Choice,
    /// Number of neighbouring points that share one error, at least 1: the sum of the autocorrelation of the noise over all lags. For edge
    /// points of a picture that was smoothed by a Gaussian of `s` px it is about `3.5 s` points a pixel apart.
    pub correlated_points: f64,
}

impl Default for Smoothing {
    /// By the risk, for points whose errors are independent.
    fn default() -> Self {
        Self { choice: Choice::Risk, correlated_points: 1.0 }
    }
}

/// A spline near points, and how near.
#[derive(Debug, Clone, PartialEq)]
pub struct Smoothed {
    /// The spline.
    pub spline: Spline,
    /// Effective degrees of freedom of each coordinate: 2 of a straight line, the number of points where the curve goes through them.
    pub freedom: f64,
    /// Mean square of the residuals across the curve in units of the stated standard deviations, corrected for the degrees of freedom: 1
    /// where these are right. 0 where nothing is left to tell.
    pub mean_square: f64,
    /// By what the stated standard deviations were multiplied: at least 1, by [`Choice::Risk`] more where the differences of
    /// neighbouring points are larger than stated; by [`Choice::CrossValidation`] the root of `mean_square`.
    pub sigma_factor: f64,
    /// Standard deviation of the curve across itself at each given point, px. The bias of smoothing is not in it, but where the weight is
    /// chosen well the two together are about as large as it says.
    pub sigmas: Vec<f64>,
}

impl Spline {
    /// Near the points, whose standard deviations across the curve are given (px; 0 for a point that the curve goes through).
    ///
    /// Neighbours nearer than a thousandth of the mean distance are merged. A standard deviation over 100 times the median counts as that.
    ///
    /// # Errors
    /// If a number is not finite or a standard deviation negative, or fewer than 2 points (3 of a closed curve) differ.
    pub fn near(
        points: &[Point2],
        sigmas: &[f64],
        closed: bool,
        how: Smoothing,
    ) -> Result<Smoothed, PointsError> {
        let knots = Knots::new(points, Some(sigmas), closed, SAME)?;
        let mut positive: Vec<f64> = knots.variances.iter().copied().filter(|v| *v > 0.0).collect();
        let middle = positive.len() / 2;
        let unit = if positive.is_empty() {
            0.0
        } else {
            *positive.select_nth_unstable_by(middle, f64::total_cmp).1
        };
        if unit <= NO_NOISE || knots.points.len() < 3 {
            return through(&knots);
        }
        Smoother::new(&knots, unit, how).smooth()
    }
}

/// Where nothing is to be smoothed.
fn through(knots: &Knots) -> Result<Smoothed, PointsError> {
    Ok(Smoothed {
        spline: Spline::through_knots(knots)?,
        freedom: knots.points.len() as f64,
        mean_square: 0.0,
        sigma_factor: 1.0,
        sigmas: knots.knot_of.iter().map(|k| knots.variances[*k].sqrt()).collect(),
    })
}

/// The equations of one curve, for any smoothing weight.
struct Smoother<'a> {
    knots: &'a Knots,
    choice: Choice,
    /// Points that share one error.
    shared: f64,
    /// A variance that is common among the points, px^2.
    unit: f64,
    /// Variances in that unit.
    variances: Vec<f64>,
    roughness: Roughness<'a>,
    /// `Q' V Q`.
    spread: Band,
    differences: Vec<[f64; 2]>,
    /// Square of the factor on the stated standard deviations.
    factor: f64,
    factors: Factors,
    /// Second derivatives, and the band of the inverse.
    bends: Vec<[f64; 2]>,
    inverse: Vec<[f64; 3]>,
    fitted: Vec<Vector2>,
    /// Residuals by their variances in their unit.
    pulls: Vec<Vector2>,
    /// What the smoother left, and second derivatives of that smoothed.
    residuals: Vec<Vector2>,
    more: Vec<[f64; 2]>,
    /// `A_ii`.
    leverage: Vec<f64>,
}

/// How well one smoothing weight does.
#[derive(Debug, Clone, Copy)]
struct Score {
    /// Weighted squares of the residuals across the curve, in units of the stated variances.
    squares: f64,
    /// Trace of the smoother.
    freedom: f64,
}

impl<'a> Smoother<'a> {
    fn new(knots: &'a Knots, unit: f64, how: Smoothing) -> Self {
        let roughness = Roughness::of(knots);
        let count = knots.points.len();
        let variances: Vec<f64> = knots.variances.iter().map(|v| (v / unit).min(NOTHING)).collect();
        let unknowns = if knots.closed { count } else { count - 2 };
        let mut spread = Band::zeros(unknowns, knots.closed);
        for (knot, v) in variances.iter().enumerate() {
            let row = roughness.row(knot);
            for (a, (i, q)) in row.iter().enumerate() {
                for (j, r) in &row[a..] {
                    if let (Some(i), Some(j)) = (i, j) {
                        spread.add(*i, *j, v * q * r);
                    }
                }
            }
        }
        let mut differences = Vec::with_capacity(unknowns);
        roughness.differences(&knots.points, &mut differences);
        let shared = how.correlated_points.max(1.0).min(count as f64);
        let factor = if how.choice == Choice::Risk {
            noise_factor(knots, shared.round() as usize).max(1.0)
        } else {
            1.0
        };
        Self {
            knots,
            choice: how.choice,
            shared,
            unit,
            variances,
            roughness,
            spread,
            differences,
            factor,
            factors: Factors::new(),
            bends: Vec::with_capacity(unknowns),
            inverse: Vec::with_capacity(unknowns),
            fitted: Vec::with_capacity(count),
            pulls: Vec::with_capacity(count),
            residuals: Vec::with_capacity(count),
            more: Vec::with_capacity(unknowns),
            leverage: Vec::with_capacity(count),
        }
    }

    /// Fits with a weight; `None` where that cannot be solved.
    fn fit(&mut self, weight: f64) -> Option<Score> {
        self.factors.factorise(&self.roughness.energy, weight, &self.spread)?;
        self.factors.inverse_band(&mut self.inverse);
        self.bends.clone_from(&self.differences);
        self.factors.solve(&mut self.bends);
        self.residuals.clear();
        self.leverage.clear();
        for (knot, v) in self.variances.iter().enumerate() {
            let row = self.roughness.row(knot);
            self.residuals.push(combined(&row, &self.bends) * (weight * v));
            self.leverage.push((1.0 - weight * v * form(&row, &self.inverse)).clamp(0.0, 1.0));
        }
        // Once more, what was left.
        self.roughness.differences(&self.residuals, &mut self.more);
        self.factors.solve(&mut self.more);
        self.fitted.clear();
        self.pulls.clear();
        for (knot, (y, v)) in self.knots.points.iter().zip(&self.variances).enumerate() {
            let pull = combined(&self.roughness.row(knot), &self.more) * weight;
            self.fitted.push(y - pull * *v);
            self.pulls.push(pull);
        }
        for (bend, more) in self.bends.iter_mut().zip(&self.more) {
            *bend = [bend[0] + more[0], bend[1] + more[1]];
        }
        // Of the constants, or of the straight lines, nothing is smoothed away.
        let kept = if self.knots.closed { 1.0 } else { 2.0 };
        let trace = self.leverage.iter().sum::<f64>();
        let freedom = (kept + TWICE * (trace - kept).max(0.0)).min(self.knots.points.len() as f64);
        let score = Score { squares: self.squares_across() / self.unit, freedom };
        (score.squares.is_finite() && score.freedom.is_finite()).then_some(score)
    }

    /// Sum of the squares of the residuals across the curve by the variances in their unit, px^2.
    fn squares_across(&self) -> f64 {
        let (fitted, last) = (&self.fitted, self.fitted.len() - 1);
        // Before the first, and after the last.
        let around = if self.knots.closed { [last, 0] } else { [0, last] };
        let one = |k: usize| {
            let before = if k > 0 { k - 1 } else { around[0] };
            let after = if k < last { k + 1 } else { around[1] };
            let along = fitted[after] - fitted[before];
            let (square, across) = (along.norm_squared(), along.perp(&self.pulls[k]));
            if square > 0.0 { across * across / square * self.variances[k] } else { 0.0 }
        };
        (0..=last).map(one).sum()
    }

    /// What is to be least.
    fn criterion(&self, score: Score) -> f64 {
        let count = self.knots.points.len() as f64;
        let left = (count - self.shared * score.freedom).max(0.0);
        match self.choice {
            Choice::Risk => score.squares + 2.0 * self.shared * self.factor * score.freedom,
            Choice::Discrepancy => (score.squares / left).ln().powi(2),
            Choice::CrossValidation => score.squares / (left * left),
        }
    }

    fn smooth(mut self) -> Result<Smoothed, PointsError> {
        let count = self.knots.points.len() as f64;
        let length: f64 = self.knots.chords.iter().sum();
        let spacing = length / self.knots.chords.len() as f64;
        // Points a distance h apart and a weight w are smoothed over a width of (w h)^(1/4).
        let weight = |x: f64| (spacing * x.exp2()).powi(4) / spacing;
        let limits = [WIDTHS[0], (2.0 * count).log2().max(WIDTHS[1] + 1.0)];
        let x = least(limits, WIDTHS[1], |x| {
            let score = self.fit(weight(x));
            score.map_or(f64::INFINITY, |s| self.criterion(s))
        });
        let score = self.fit(weight(x)).ok_or(PointsError::Unsolvable)?;
        let left = count - score.freedom;
        let mean_square = if left > 1e-6 * count { score.squares / left } else { 0.0 };
        let variance = if self.choice == Choice::CrossValidation { mean_square } else { self.factor };
        let sigma = |k: &usize| {
            let share = (TWICE * self.shared * self.leverage[*k]).min(1.0);
            (self.knots.variances[*k] * share * variance).sqrt()
        };
        Ok(Smoothed {
            spline: Spline::assemble(self.knots, &self.fitted, &self.roughness.all(&self.bends)),
            freedom: score.freedom,
            mean_square,
            sigma_factor: variance.sqrt(),
            sigmas: self.knots.knot_of.iter().map(sigma).collect(),
        })
    }
}

/// A row of `Q` times unknowns.
fn combined(row: &[(Option<usize>, f64); 3], unknowns: &[[f64; 2]]) -> Vector2 {
    let mut sum = [0.0; 2];
    for (at, q) in row {
        let [x, y] = at.map_or([0.0; 2], |at| unknowns[at]);
        sum = [sum[0] + q * x, sum[1] + q * y];
    }
    Vector2::from(sum)
}

/// A row `q` of `Q` about the inverse of the equations: `q B^-1 q'`.
fn form(row: &[(Option<usize>, f64); 3], inverse: &[[f64; 3]]) -> f64 {
    let mut sum = 0.0;
    for (first, (i, a)) in row.iter().enumerate() {
        for (step, (j, b)) in row[first..].iter().enumerate() {
            if let (Some(i), Some(_)) = (i, j) {
                let twice = if step == 0 { 1.0 } else { 2.0 };
                sum += twice * a * b * inverse[*i][step];
            }
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use rand::{Rng, SeedableRng};

    /// Knots at uneven distances with uneven variances.
    fn knots(count: usize, closed: bool) -> Knots {
        let mut random = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(6);
        let points: Vec<Point2> = (0..count)
            .map(|k| {
                let a = std::f64::consts::TAU * (k as f64 + random.random_range(-0.3..0.3)) / count as f64;
                Point2::new(count as f64 * 0.16 * a.cos(), count as f64 * 0.2 * a.sin())
            })
            .collect();
        let sigmas: Vec<f64> = (0..count).map(|_| random.random_range(0.5..2.0)).collect();
        Knots::new(&points, Some(&sigmas), closed, SAME).unwrap()
    }

    /// The smoother as a full matrix, `(1 + w V Q R^-1 Q')^-1` (P. J. Green and B. W. Silverman, Nonparametric Regression and Generalized
    /// Linear Models, 1994, section 2.1), `Q` and `R` written down here anew.
    fn full(knots: &Knots, weight: f64) -> DMatrix<f64> {
        let (n, h) = (knots.points.len(), &knots.chords);
        let (mut q, mut r) = (DMatrix::<f64>::zeros(n, n), DMatrix::<f64>::zeros(n, n));
        let inner: Vec<usize> = if knots.closed { (0..n).collect() } else { (1..n - 1).collect() };
        for k in inner.iter().copied() {
            let (before, after) = ((k + n - 1) % n, (k + 1) % n);
            q[(before, k)] += 1.0 / h[before];
            q[(k, k)] -= 1.0 / h[before] + 1.0 / h[k];
            q[(after, k)] += 1.0 / h[k];
            r[(k, k)] += (h[before] + h[k]) / 3.0;
            r[(before, k)] += h[before] / 6.0;
            r[(after, k)] += h[k] / 6.0;
        }
        let (q, r) = (q.select_columns(&inner), r.select_columns(&inner).select_rows(&inner));
        let bending: DMatrix<f64> = &q * r.try_inverse().unwrap() * q.transpose();
        let variances = DMatrix::from_diagonal(&DVector::from_vec(knots.variances.clone()));
        let more: DMatrix<f64> = variances * bending * weight;
        (DMatrix::identity(n, n) + more).try_inverse().unwrap()
    }

    #[test]
    fn the_fit_is_that_of_full_matrices() {
        for (count, closed) in
            [(3, true), (4, true), (5, true), (20, true), (3, false), (4, false), (20, false)]
        {
            let knots = knots(count, closed);
            let mut smoother = Smoother::new(&knots, 1.0, Smoothing::default());
            for weight in [0.01, 1.0, 300.0] {
                smoother.fit(weight).unwrap();
                let once = full(&knots, weight);
                let twice = &once * 2.0 - &once * &once;
                for k in 0..count {
                    let fitted: Vector2 = (0..count).map(|j| knots.points[j] * twice[(k, j)]).sum();
                    assert!((smoother.fitted[k] - fitted).norm() < 1e-9, "{count} {closed} {weight}");
                    assert!((smoother.leverage[k] - once[(k, k)]).abs() < 1e-9, "{count} {closed} {weight}");
                }
            }
        }
    }

    #[test]
    fn degrees_of_freedom_of_smoothing_twice_are_near_the_exact_ones() {
        for closed in [true, false] {
            let knots = knots(200, closed);
            let mut smoother = Smoother::new(&knots, 1.0, Smoothing::default());
            for width in [2.0_f64, 4.0, 8.0, 16.0] {
                let score = smoother.fit(width.powi(4)).unwrap();
                let once = full(&knots, width.powi(4));
                let exact = (&once * 2.0 - &once * &once).trace();
                println!("width {width}: {:.1} for {exact:.1}", score.freedom);
                assert!((score.freedom / exact - 1.0).abs() < 0.05);
            }
        }
    }
}
