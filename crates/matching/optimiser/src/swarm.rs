//! Particle swarm, of `argmin` (M. Zambrano-Bigiarini and others, "Standard particle swarm optimisation 2011 at CEC-2013", 2013): the first
//! particles are Gaussian about the start, not anywhere within the bounds.

use argmin::core::{CostFunction, Error, Executor, PopulationState};
use argmin::solver::particleswarm::{Particle, ParticleSwarm};
use nalgebra::Vector6;
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::Search;
use crate::asked::Asked;
use crate::simplex::{Ended, Shared};

/// Particles.
const PARTICLES: usize = 24;

/// Points about `start`: itself first, then Gaussian ones with the reach for a standard deviation, within the bounds.
pub(crate) fn spread(
    search: &Search,
    start: &Vector6<f64>,
    count: usize,
    random: &mut Xoshiro256PlusPlus,
) -> Vec<Vector6<f64>> {
    // Twelve uniform numbers make a normal one, cut at six.
    let mut normal = || (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
    let others: Vec<Vector6<f64>> = (1..count)
        .map(|_| search.within(&(start + Vector6::from_fn(|_, _| normal()) * (search.reach / 2.0))))
        .collect();
    std::iter::once(*start).chain(others).collect()
}

pub(crate) fn minimise(asked: &mut Asked<'_>, start: &Vector6<f64>) -> Option<()> {
    let (low, high) = (asked.search.low, asked.search.high);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(asked.search.seed);
    let mut particles = Vec::with_capacity(PARTICLES);
    let places = spread(asked.search, start, PARTICLES, &mut random);
    let velocities = spread(asked.search, &Vector6::zeros(), PARTICLES, &mut random);
    for (at, velocity) in places.iter().zip(velocities) {
        let value = asked.value(at)?;
        particles.push(Particle::new(at.as_slice().to_vec(), value, (velocity * 0.5).as_slice().to_vec()));
    }
    let bounds = (low.as_slice().to_vec(), high.as_slice().to_vec());
    let solver = ParticleSwarm::new(bounds, PARTICLES).with_rng_generator(random);
    let shared = Shared::new(asked);
    let run = Executor::new(shared, solver)
        .configure(|state: PopulationState<Particle<Vec<f64>, f64>, f64>| {
            state.population(particles).max_iters(u64::MAX)
        })
        .run();
    match run {
        Ok(_) => Some(()),
        Err(error) => Ended::of(&error),
    }
}

impl CostFunction for Shared<'_, '_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, at: &Vec<f64>) -> Result<f64, Error> {
        self.value(at)
    }
}
