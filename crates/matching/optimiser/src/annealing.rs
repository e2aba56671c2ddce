//! Simulated annealing, of `argmin` (Kirkpatrick, Gelatt and Vecchi 1983). Steps are Gaussian and as long as the temperature says: the reach at
//! first, the tolerance when nine tenths of the calls are used, falling by the same factor at each call. The temperature starts at a twentieth
//! of the start's value.

use std::cell::RefCell;

use argmin::core::{CostFunction, Error, Executor, IterState};
use argmin::solver::simulatedannealing::{Anneal, SATempFunc, SimulatedAnnealing};
use nalgebra::Vector6;
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::asked::Asked;
use crate::simplex::{Ended, Shared};

/// Share of the start's value that the temperature begins with.
const HOT: f64 = 0.05;
/// Share of the calls after which steps are as short as the tolerance.
const COOLED: f64 = 0.9;
/// Standard deviation of a step's variable, as a share of its length.
const OF_EACH: f64 = 0.35;

struct Annealed<'a, 'f> {
    shared: Shared<'a, 'f>,
    random: RefCell<Xoshiro256PlusPlus>,
    /// Length of a step by temperature.
    per_degree: f64,
}

impl CostFunction for Annealed<'_, '_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, at: &Vec<f64>) -> Result<f64, Error> {
        self.shared.value(at)
    }
}

impl Anneal for Annealed<'_, '_> {
    type Param = Vec<f64>;
    type Output = Vec<f64>;
    type Float = f64;

    fn anneal(&self, at: &Vec<f64>, temperature: f64) -> Result<Vec<f64>, Error> {
        let mut random = self.random.try_borrow_mut()?;
        let sigma = OF_EACH * self.per_degree * temperature;
        let mut normal = || (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
        let next: Vec<f64> = at.iter().map(|v| v + sigma * normal()).collect();
        self.shared.within(&next)
    }
}

pub(crate) fn minimise(asked: &mut Asked<'_>, start: &Vector6<f64>) -> Option<()> {
    let search = asked.search;
    let value = asked.value(start)?;
    let hot = if value.is_finite() && value > 0.0 { HOT * value } else { 1.0 };
    let calls = (COOLED * search.calls as f64).max(1.0);
    let factor = (search.tolerance / search.reach.max(search.tolerance)).powf(1.0 / calls);
    let random = Xoshiro256PlusPlus::seed_from_u64(search.seed);
    let mut others = random.clone();
    others.jump();
    let solver =
        SimulatedAnnealing::new_with_rng(hot, others).ok()?.with_temp_func(SATempFunc::Exponential(factor));
    let problem =
        Annealed { shared: Shared::new(asked), random: RefCell::new(random), per_degree: search.reach / hot };
    let first = start.as_slice().to_vec();
    let run = Executor::new(problem, solver)
        .configure(|state: IterState<Vec<f64>, (), (), (), (), f64>| {
            state.param(first).cost(value).max_iters(u64::MAX)
        })
        .run();
    match run {
        Ok(_) => Some(()),
        Err(error) => Ended::of(&error),
    }
}
