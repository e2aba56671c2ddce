//! Bounded quasi-Newton minimisation by the formula of Broyden, Fletcher, Goldfarb and Shanno (Eqs. 3.7 to 3.11).
//!
//! The thesis calls Matlab's `fmincon`, medium scale. Like that one this searches along the quasi-Newton step within the
//! bounds and halves it until the function falls; it keeps the Hessian positive by drawing `q` towards `H s` (Powell 1978),
//! and takes derivatives by finite differences whose step lies between a largest and a smallest one (`DiffMaxChange` and
//! `DiffMinChange` in the listing).
//!
//! The function has noise (points of the outline change cells) and a kink at its minimum (a mean of distances, not of
//! squares). So differences are central, and their step is long at first: where no step along the search direction helps,
//! it is shortened, and only with the shortest one is the search at its end. What that is worth stands in the parent
//! module's table. `argmin` was not taken: its quasi-Newton methods know no bounds and its line searches expect a function
//! without noise.

use nalgebra::{Matrix6, Vector6};

/// Factor of the difference step where it is shortened.
const SHORTEN: f64 = 0.3;

/// When and how it searches.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Search {
    /// Bounds of the variables.
    pub low: Vector6<f64>,
    pub high: Vector6<f64>,
    /// Step of the finite differences at first.
    pub first_difference: f64,
    /// And at the end.
    pub last_difference: f64,
    /// It ends when every variable changes by less.
    pub tolerance: f64,
    /// Calls of the function at most.
    pub calls: usize,
}

/// Where it ended.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Minimum {
    pub at: Vector6<f64>,
    pub value: f64,
    pub calls: usize,
    /// Whether every variable changed by less than the tolerance before the calls were used up.
    pub converged: bool,
}

/// Minimises `function` from `start`, which is put within the bounds.
pub(super) fn minimise(
    function: impl FnMut(&Vector6<f64>) -> f64,
    start: &Vector6<f64>,
    search: &Search,
) -> Minimum {
    let mut run = Run {
        function,
        search,
        calls: 0,
        difference: search.first_difference.max(search.last_difference),
        at: search.within(start),
        value: f64::INFINITY,
    };
    let converged = run.descend().is_some();
    Minimum { at: run.at, value: run.value, calls: run.calls, converged }
}

impl Search {
    fn within(&self, at: &Vector6<f64>) -> Vector6<f64> {
        at.sup(&self.low).inf(&self.high)
    }

    /// The step that Eq. 3.8 asks for; variables at a bound that the gradient would push beyond stay there.
    fn step(&self, hessian: &Matrix6<f64>, gradient: &Vector6<f64>, at: &Vector6<f64>) -> Vector6<f64> {
        let (mut matrix, mut downhill) = (*hessian, -gradient);
        for i in 0..6 {
            if (at[i] <= self.low[i] && downhill[i] < 0.0) || (at[i] >= self.high[i] && downhill[i] > 0.0) {
                matrix.row_mut(i).fill(0.0);
                matrix.column_mut(i).fill(0.0);
                matrix[(i, i)] = 1.0;
                downhill[i] = 0.0;
            }
        }
        matrix.cholesky().map_or(downhill, |c| c.solve(&downhill))
    }
}

/// A search on its way. Its methods give nothing once the calls are used up.
struct Run<'a, F> {
    function: F,
    search: &'a Search,
    calls: usize,
    difference: f64,
    at: Vector6<f64>,
    value: f64,
}

impl<F: FnMut(&Vector6<f64>) -> f64> Run<'_, F> {
    fn call(&mut self, at: &Vector6<f64>) -> Option<f64> {
        if self.calls >= self.search.calls {
            return None;
        }
        self.calls += 1;
        Some((self.function)(at))
    }

    fn gradient(&mut self) -> Option<Vector6<f64>> {
        let mut gradient = Vector6::zeros();
        for i in 0..6 {
            let mut beside = [self.at; 2];
            beside[0][i] -= self.difference;
            beside[1][i] += self.difference;
            gradient[i] = (self.call(&beside[1])? - self.call(&beside[0])?) / (2.0 * self.difference);
        }
        Some(gradient)
    }

    fn descend(&mut self) -> Option<()> {
        self.value = self.call(&self.at.clone())?;
        let mut gradient = self.gradient()?;
        let mut hessian = None;
        loop {
            let direction = self.search.step(&hessian.unwrap_or_else(Matrix6::identity), &gradient, &self.at);
            let before = self.at;
            if self.line_search(&direction)? {
                let next = self.gradient()?;
                hessian = Some(updated(hessian, &(self.at - before), &(next - gradient)));
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
            let value = self.call(&next)?;
            if value < self.value {
                (self.at, self.value) = (next, value);
                return Some(true);
            }
            share /= 2.0;
        }
    }
}

/// Eq. 3.9 as it ought to be printed: `H + q q' / (q' s) - H s s' H / (s' H s)`, with `s` how the variables changed and `q`
/// how the gradient did. The first `H` is the multiple of the identity that has the curvature just found.
fn updated(hessian: Option<Matrix6<f64>>, s: &Vector6<f64>, q: &Vector6<f64>) -> Matrix6<f64> {
    let curvature = q.dot(s);
    let first = || {
        let scale = if curvature > 0.0 { q.norm_squared() / curvature } else { 1.0 };
        Matrix6::identity() * scale
    };
    let hessian = hessian.unwrap_or_else(first);
    let bent = hessian * s;
    let expected = s.dot(&bent);
    let share = if curvature >= 0.2 * expected { 1.0 } else { 0.8 * expected / (expected - curvature) };
    let q = q * share + bent * (1.0 - share);
    hessian + q * q.transpose() / q.dot(s) - bent * bent.transpose() / expected
}

#[cfg(test)]
mod tests {
    use super::*;

    fn search(calls: usize) -> Search {
        Search {
            low: Vector6::repeat(-5.0),
            high: Vector6::repeat(5.0),
            first_difference: 0.1,
            last_difference: 0.001,
            tolerance: 0.0005,
            calls,
        }
    }

    /// A long valley that lies across the axes.
    fn valley(at: &Vector6<f64>) -> f64 {
        let d = at - Vector6::new(1.0, -2.0, 0.5, 3.0, -1.0, 2.0);
        let across = d[0] + d[1] - d[2] + d[3] - d[4] + d[5];
        d.norm_squared() + 30.0 * across * across
    }

    #[test]
    fn finds_the_bottom_of_a_valley_across_the_axes() {
        let found = minimise(valley, &Vector6::repeat(4.0), &search(800));
        assert!(found.converged && found.value < 1e-5, "{found:?}");
    }

    #[test]
    fn a_minimum_outside_the_bounds_is_sought_at_the_bound() {
        let bounded = Search { high: Vector6::new(5.0, 5.0, 5.0, 2.5, 5.0, 5.0), ..search(800) };
        let mut farthest = f64::NEG_INFINITY;
        let found = minimise(
            |at| {
                farthest = farthest.max(at[3]);
                // Without the valley's cross terms: the other variables keep their own minimum.
                (at - Vector6::new(1.0, -2.0, 0.5, 3.0, -1.0, 2.0)).norm_squared()
            },
            &Vector6::repeat(4.0),
            &bounded,
        );
        let expected = Vector6::new(1.0, -2.0, 0.5, 2.5, -1.0, 2.0);
        assert!(found.converged && (found.at - expected).amax() < 0.01, "{found:?}");
        assert_eq!(found.at[3], 2.5);
        // Differences alone look beyond a bound.
        assert!(farthest <= 2.5 + 0.1 + 1e-12, "{farthest}");
    }

    /// The mean of distances that the objective is: a kink at the minimum.
    #[test]
    fn a_kink_at_the_minimum_does_not_hold_it_up() {
        let kink = |at: &Vector6<f64>| (at.component_mul(&Vector6::new(1.0, 2.0, 3.0, 1.0, 2.0, 3.0))).norm();
        let found = minimise(kink, &Vector6::new(3.0, -4.0, 2.0, 1.0, -2.0, 2.0), &search(800));
        assert!(found.converged && found.at.amax() < 0.01, "{found:?}");
    }

    #[test]
    fn calls_are_counted_and_a_run_that_uses_them_up_has_not_converged() {
        for calls in [0, 1, 7, 40] {
            let mut counted = 0;
            let found = minimise(
                |at| {
                    counted += 1;
                    valley(at)
                },
                &Vector6::repeat(4.0),
                &search(calls),
            );
            assert!(!found.converged && found.calls == calls && counted == calls, "{found:?}");
        }
    }

    #[test]
    fn a_function_without_numbers_ends() {
        let found = minimise(|_| f64::NAN, &Vector6::zeros(), &search(800));
        assert!(found.calls < 800, "{found:?}");
        let flat = minimise(|_| 200.0, &Vector6::zeros(), &search(800));
        assert!(flat.converged && flat.at == Vector6::zeros());
    }
}
