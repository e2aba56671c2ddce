//! Minimises a function of six variables within bounds, by any of nine optimisers with one interface.
//!
//! The six are a pose in all uses here: millimetres, rotations scaled by a body's radius of gyration, so that a unit means about the same in
//! each ([`Search`] takes one tolerance for all). A [`Function`] gives its value; where it is a sum over residuals it gives those too, with
//! their exact derivatives ([`Row`]).
//!
//! | [`Optimiser`] | method | derivatives |
//! |---|---|---|
//! | `bfgs` | quasi-Newton with bounds, as the thesis's `fmincon` (Eqs. 3.7 to 3.11) | central differences that are shortened |
//! | `sqp` | a quadratic programme within the bounds at each step, damped BFGS update (Powell 1978) | exact where there are rows, else differences |
//! | `levenberg_marquardt` | damped least squares, weights renewed at each step | rows, needed |
//! | `powell` | conjugate directions, a line search along each (Powell 1964) | none |
//! | `sequential` | one variable after the other, steps grown and halved | none |
//! | `nelder_mead` | simplex, of `argmin` | none |
//! | `particle_swarm` | of `argmin`, from a seed | none |
//! | `simulated_annealing` | of `argmin`, from a seed | none |
//! | `genetic` | differential evolution (Storn and Price 1997), from a seed | none |
//!
//! **Guaranteed:** no call outside the bounds (but for `bfgs`, whose differences look beyond them by one difference step), never more calls
//! than allowed, the best point that was called is what comes back, the same on every run. A value that is no number counts as infinite.
//! **Not guaranteed:** that the lowest minimum was found, by any of them.

mod annealing;
mod asked;
mod bfgs;
mod genetic;
mod levenberg_marquardt;
mod line;
mod powell;
mod sequential;
mod simplex;
mod sqp;
mod swarm;

use nalgebra::Vector6;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use asked::Asked;

/// A function of six variables.
pub trait Function {
    /// Its value; lower is better.
    fn value(&mut self, at: &Vector6<f64>) -> f64;

    /// Its value, and the rows whose sum of `weight * residual * derivative` is its gradient (`rows` is emptied first); `None` for a function
    /// that has no residuals.
    fn linearise(&mut self, _at: &Vector6<f64>, _rows: &mut Vec<Row>) -> Option<f64> {
        None
    }
}

impl<F: FnMut(&Vector6<f64>) -> f64> Function for F {
    fn value(&mut self, at: &Vector6<f64>) -> f64 {
        self(at)
    }
}

/// One residual of a sum. The gradient of the function is the sum over rows of `weight * residual * derivative`, and near its minimum its
/// matrix of second derivatives about that of `weight * derivative * derivative'`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// How far off, zero for a perfect fit.
    pub residual: f64,
    /// How much its square counts: for a robust function of the residual, its derivative over the residual.
    pub weight: f64,
    /// Of the residual by the six variables.
    pub derivative: Vector6<f64>,
}

/// Where, how finely and how long to search.
#[derive(Debug, Clone, PartialEq)]
pub struct Search {
    /// Least values of the variables.
    pub low: Vector6<f64>,
    /// Largest values of the variables.
    pub high: Vector6<f64>,
    /// A search has converged when every variable changes by less.
    pub tolerance: f64,
    /// Calls of the function at most; a linearisation counts as one.
    pub calls: usize,
    /// Step of finite differences at first.
    pub first_difference: f64,
    /// And at the end.
    pub last_difference: f64,
    /// How far methods without a derivative step at first, and the spread of first populations; a quarter of it is the first simplex's side.
    pub reach: f64,
    /// Of methods that draw.
    pub seed: u64,
}

/// Where a search ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Minimum {
    /// The best point called.
    pub at: Vector6<f64>,
    /// The value there.
    pub value: f64,
    /// Calls used.
    pub calls: usize,
    /// Whether the search came to rest before its calls were used up.
    pub converged: bool,
}

/// The optimisers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Optimiser {
    /// Bounded quasi-Newton with finite differences.
    Bfgs,
    /// Sequential quadratic programming.
    Sqp,
    /// Damped least squares.
    LevenbergMarquardt,
    /// Conjugate directions.
    Powell,
    /// One variable after the other.
    Sequential,
    /// Simplex.
    NelderMead,
    /// Particle swarm.
    ParticleSwarm,
    /// Simulated annealing.
    SimulatedAnnealing,
    /// Differential evolution.
    Genetic,
}

/// The function has no residuals, and the optimiser needs them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NoResiduals;

impl Search {
    /// The nearest point within the bounds.
    pub fn within(&self, at: &Vector6<f64>) -> Vector6<f64> {
        at.sup(&self.low).inf(&self.high)
    }
}

impl Optimiser {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::LevenbergMarquardt,
        Self::Sqp,
        Self::Bfgs,
        Self::Powell,
        Self::Sequential,
        Self::NelderMead,
        Self::ParticleSwarm,
        Self::SimulatedAnnealing,
        Self::Genetic,
    ];

    /// Its name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bfgs => "bfgs",
            Self::Sqp => "sqp",
            Self::LevenbergMarquardt => "levenberg_marquardt",
            Self::Powell => "powell",
            Self::Sequential => "sequential",
            Self::NelderMead => "nelder_mead",
            Self::ParticleSwarm => "particle_swarm",
            Self::SimulatedAnnealing => "simulated_annealing",
            Self::Genetic => "genetic",
        }
    }

    /// Minimises `function` from `start`, which is put within the bounds.
    ///
    /// # Errors
    /// [`NoResiduals`], of [`Self::LevenbergMarquardt`] alone.
    pub fn minimise(
        self,
        function: &mut dyn Function,
        start: &Vector6<f64>,
        search: &Search,
    ) -> Result<Minimum, NoResiduals> {
        let mut asked = Asked::new(function, search);
        let start = search.within(start);
        // The start is called by every method, and first by all of them.
        let ended = match self {
            Self::Bfgs => bfgs::minimise(&mut asked, &start),
            Self::Sqp => sqp::minimise(&mut asked, &start),
            Self::LevenbergMarquardt => levenberg_marquardt::minimise(&mut asked, &start)?,
            Self::Powell => powell::minimise(&mut asked, &start),
            Self::Sequential => sequential::minimise(&mut asked, &start),
            Self::NelderMead => simplex::minimise(&mut asked, &start),
            Self::ParticleSwarm => swarm::minimise(&mut asked, &start),
            Self::SimulatedAnnealing => annealing::minimise(&mut asked, &start),
            Self::Genetic => genetic::minimise(&mut asked, &start),
        };
        Ok(asked.minimum(&start, ended.is_some()))
    }
}

#[cfg(test)]
mod tests;
