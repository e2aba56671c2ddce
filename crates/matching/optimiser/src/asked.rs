//! A function under a search: its calls are counted and the best point of them is kept.

use nalgebra::Vector6;

use crate::{Function, Minimum, NoResiduals, Row, Search};

/// A swarm or the like has settled when so many calls in a row were near its best point.
const SETTLED: usize = 40;

/// A function with what is left of its calls. Methods that call it give `None` once they are used up.
pub(crate) struct Asked<'a> {
    function: &'a mut dyn Function,
    pub search: &'a Search,
    calls: usize,
    best: Option<(Vector6<f64>, f64)>,
    /// Calls in a row within the tolerance of the best point.
    near: usize,
}

impl<'a> Asked<'a> {
    pub fn new(function: &'a mut dyn Function, search: &'a Search) -> Self {
        Self { function, search, calls: 0, best: None, near: 0 }
    }

    fn count(&mut self) -> Option<()> {
        self.calls = (self.calls < self.search.calls).then_some(self.calls + 1)?;
        Some(())
    }

    fn keep(&mut self, at: &Vector6<f64>, value: f64) -> f64 {
        let value = if value.is_nan() { f64::INFINITY } else { value };
        let near = self.best.is_some_and(|(best, _)| (at - best).amax() < self.search.tolerance);
        self.near = if near { self.near + 1 } else { 0 };
        if self.best.is_none_or(|(_, best)| value < best) {
            self.best = Some((*at, value));
        }
        value
    }

    /// The value at a point.
    pub fn value(&mut self, at: &Vector6<f64>) -> Option<f64> {
        self.count()?;
        let value = self.function.value(at);
        Some(self.keep(at, value))
    }

    /// The value at a point for a difference: not kept as a point that may be the answer, since it may lie beyond a bound.
    pub fn differ(&mut self, at: &Vector6<f64>) -> Option<f64> {
        self.count()?;
        Some(self.function.value(at))
    }

    /// The value at a point within the bounds, if `at` is one; else that of the nearest one and more, the farther off it is.
    pub fn value_within(&mut self, at: &Vector6<f64>) -> Option<f64> {
        let within = self.search.within(at);
        let value = self.value(&within)?;
        Some(value + (at - within).norm())
    }

    /// The value at a point, and its rows.
    pub fn linearise(&mut self, at: &Vector6<f64>, rows: &mut Vec<Row>) -> Option<Result<f64, NoResiduals>> {
        self.count()?;
        rows.clear();
        match self.function.linearise(at, rows) {
            Some(value) => Some(Ok(self.keep(at, value))),
            None => {
                self.calls -= 1;
                Some(Err(NoResiduals))
            }
        }
    }

    /// Whether many calls in a row were within the tolerance of the best point.
    pub fn settled(&self) -> bool {
        self.near >= SETTLED
    }

    /// Calls that are left.
    pub fn left(&self) -> usize {
        self.search.calls - self.calls
    }

    pub fn minimum(&self, start: &Vector6<f64>, converged: bool) -> Minimum {
        let (at, value) = self.best.unwrap_or((*start, f64::INFINITY));
        Minimum { at, value, calls: self.calls, converged }
    }
}

/// The gradient by central differences, within the bounds: one-sided beside them.
pub(crate) fn gradient(asked: &mut Asked<'_>, at: &Vector6<f64>, difference: f64) -> Option<Vector6<f64>> {
    let mut gradient = Vector6::zeros();
    for i in 0..6 {
        let beside = [-1.0, 1.0].map(|sign| {
            let mut beside = *at;
            beside[i] = (at[i] + sign * difference).clamp(asked.search.low[i], asked.search.high[i]);
            beside
        });
        let apart = beside[1][i] - beside[0][i];
        if apart > 0.0 {
            gradient[i] = (asked.value(&beside[1])? - asked.value(&beside[0])?) / apart;
        }
    }
    Some(gradient)
}
