//! Bounded quasi-Newton minimisation by the formula of Broyden, Fletcher, Goldfarb and Shanno (Eqs. 3.7 to 3.11).
//!
//! The thesis calls Matlab's `fmincon`, medium scale. Like that one this searches along the quasi-Newton step within the
//! bounds and halves it until the function falls; it keeps the Hessian positive by drawing `q` towards `H s` (Powell 1978),
//! and takes derivatives by finite differences whose step lies between a largest and a smallest one (`DiffMaxChange` and
//! `DiffMinChange` in the listing).
//!
//! Functions searched here have noise (points of an outline change places) and a kink at their minimum (a mean of distances, not of
//! squares). So differences are central, and their step is long at first: where no step along the search direction helps,
//! it is shortened, and only with the shortest one is the search at its end. `argmin` was not taken: its quasi-Newton methods know no
//! bounds and its line searches expect a function without noise.

use nalgebra::{Matrix6, Vector6};

use crate::Search;
use crate::asked::Asked;

/// Factor of the difference step where it is shortened.
const SHORTEN: f64 = 0.3;

pub(crate) fn minimise(asked: &mut Asked<'_>, start: &Vector6<f64>) -> Option<()> {
    let search = asked.search;
    let difference = search.first_difference.max(search.last_difference);
    Run { asked, search, difference, at: *start, value: f64::INFINITY }.descend()
}

/// The step that Eq. 3.8 asks for; variables at a bound that the gradient would push beyond stay there.
fn step(search: &Search, hessian: &Matrix6<f64>, gradient: &Vector6<f64>, at: &Vector6<f64>) -> Vector6<f64> {
    let (mut matrix, mut downhill) = (*hessian, -gradient);
    for i in 0..6 {
        if (at[i] <= search.low[i] && downhill[i] < 0.0) || (at[i] >= search.high[i] && downhill[i] > 0.0) {
            matrix.row_mut(i).fill(0.0);
            matrix.column_mut(i).fill(0.0);
            matrix[(i, i)] = 1.0;
            downhill[i] = 0.0;
        }
    }
    matrix.cholesky().map_or(downhill, |c| c.solve(&downhill))
}

/// A search on its way. Its methods give nothing once the calls are used up.
struct Run<'a, 'f> {
    asked: &'a mut Asked<'f>,
    search: &'f Search,
    difference: f64,
    at: Vector6<f64>,
    value: f64,
}

impl Run<'_, '_> {
    fn gradient(&mut self) -> Option<Vector6<f64>> {
        let mut gradient = Vector6::zeros();
        for i in 0..6 {
            let mut beside = [self.at; 2];
            beside[0][i] -= self.difference;
            beside[1][i] += self.difference;
            let rise = self.asked.differ(&beside[1])? - self.asked.differ(&beside[0])?;
            gradient[i] = rise / (2.0 * self.difference);
        }
        Some(gradient)
    }

    fn descend(&mut self) -> Option<()> {
        self.value = self.asked.value(&self.at)?;
        let mut gradient = self.gradient()?;
        let mut hessian = None;
        loop {
            let direction =
                step(self.search, &hessian.unwrap_or_else(Matrix6::identity), &gradient, &self.at);
            let before = self.at;
            if self.line_search(&direction)? {
                let next = self.gradient()?;
                let (s, q) = (self.at - before, next - gradient);
                hessian = Some(updated(&hessian.unwrap_or_else(|| first(&s, &q)), &s, &q));
                gradient = next;
            } else if self.difference > self.search.last_difference {
                self.difference = (self.difference * SHORTEN).max(self.search.last_difference);
                gradient = self.gradient()?;
                hessian = None;
            } else {
                return Some(());
            }
        }
    }

    /// Halves the step until the function falls, and goes there; false where the step is below the tolerance before.
    fn line_search(&mut self, direction: &Vector6<f64>) -> Option<bool> {
        if direction.iter().any(|d| !d.is_finite()) {
            return Some(false);
        }
        let mut share = 1.0;
        loop {
            let next = self.search.within(&(self.at + direction * share));
            if (next - self.at).amax() < self.search.tolerance {
                return Some(false);
            }
            let value = self.asked.value(&next)?;
            if value < self.value {
                (self.at, self.value) = (next, value);
                return Some(true);
            }
            share /= 2.0;
        }
    }
}

/// The multiple of the identity that has the curvature just found.
fn first(s: &Vector6<f64>, q: &Vector6<f64>) -> Matrix6<f64> {
    let curvature = q.dot(s);
    Matrix6::identity() * if curvature > 0.0 { q.norm_squared() / curvature } else { 1.0 }
}

/// Eq. 3.9 as it ought to be printed: `H + q q' / (q' s) - H s s' H / (s' H s)`, with `s` how the variables changed and `q`
/// how the gradient did.
pub(crate) fn updated(hessian: &Matrix6<f64>, s: &Vector6<f64>, q: &Vector6<f64>) -> Matrix6<f64> {
    let curvature = q.dot(s);
    let bent = hessian * s;
    let expected = s.dot(&bent);
    let share = if curvature >= 0.2 * expected { 1.0 } else { 0.8 * expected / (expected - curvature) };
    let q = q * share + bent * (1.0 - share);
    let updated = hessian + q * q.transpose() / q.dot(s) - bent * bent.transpose() / expected;
    if updated.iter().all(|v| v.is_finite()) { updated } else { *hessian }
}
