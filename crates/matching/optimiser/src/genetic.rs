//! A genetic search: differential evolution (R. Storn and K. Price, "Differential evolution - a simple and efficient heuristic for global
//! optimization over continuous spaces", 1997), each child between its parent, the best and a difference of two others.

use nalgebra::Vector6;
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::asked::Asked;
use crate::swarm::spread;

/// How many live at a time.
const POPULATION: usize = 24;
/// Share of differences that is added, drawn anew for each child.
const FACTOR: (f64, f64) = (0.4, 0.9);
/// Chance that a variable is the child's own.
const CROSSING: f64 = 0.9;

pub(crate) fn minimise(asked: &mut Asked<'_>, start: &Vector6<f64>) -> Option<()> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(asked.search.seed);
    let mut living: Vec<(Vector6<f64>, f64)> = Vec::with_capacity(POPULATION);
    for at in spread(asked.search, start, POPULATION, &mut random) {
        living.push((at, asked.value(&at)?));
    }
    loop {
        for parent in 0..POPULATION {
            let best = living.iter().min_by(|a, b| a.1.total_cmp(&b.1))?.0;
            let [a, b] = [(); 2].map(|()| living[random.random_range(0..POPULATION)].0);
            let factor = random.random_range(FACTOR.0..FACTOR.1);
            let (at, value) = living[parent];
            let mixed = at + (best - at) * factor + (a - b) * factor;
            let kept = random.random_range(0..6);
            let child =
                Vector6::from_fn(
                    |i, _| if i == kept || random.random_bool(CROSSING) { mixed[i] } else { at[i] },
                );
            let child = asked.search.within(&child);
            let found = asked.value(&child)?;
            if found <= value {
                living[parent] = (child, found);
            }
        }
        let first = living[0].0;
        if living.iter().all(|(at, _)| (at - first).amax() < asked.search.tolerance) {
            return Some(());
        }
    }
}
