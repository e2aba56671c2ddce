//! All optimisers on functions whose minimum is known, and what each promises of bounds and calls.

use super::*;

fn search(calls: usize) -> Search {
    Search {
        low: Vector6::repeat(-8.0),
        high: Vector6::repeat(8.0),
        tolerance: 0.0005,
        calls,
        first_difference: 0.1,
        last_difference: 0.001,
        reach: 6.0,
        seed: 3,
    }
}

fn bottom() -> Vector6<f64> {
    Vector6::new(1.0, -2.0, 0.5, 3.0, -1.0, 2.0)
}

/// A valley that lies across the axes.
fn valley(at: &Vector6<f64>) -> f64 {
    let d = at - bottom();
    let across = d[0] + d[1] - d[2] + d[3] - d[4] + d[5];
    (d.norm_squared() + 2.0 * across * across) / 10.0
}

/// The same as a sum of squares.
struct Squares;

impl Function for Squares {
    fn value(&mut self, at: &Vector6<f64>) -> f64 {
        valley(at)
    }

    fn linearise(&mut self, at: &Vector6<f64>, rows: &mut Vec<Row>) -> Option<f64> {
        let d = at - bottom();
        let mut add = |derivative: Vector6<f64>, weight: f64| {
            rows.push(Row { residual: derivative.dot(&d), weight, derivative });
        };
        (0..6).for_each(|i| add(Vector6::from_fn(|k, _| if k == i { 1.0 } else { 0.0 }), 0.2));
        add(Vector6::new(1.0, 1.0, -1.0, 1.0, -1.0, 1.0), 0.4);
        Some(valley(at))
    }
}

/// Mean of distances: a kink at the minimum, with rows of weights that are renewed.
struct Kink;

impl Function for Kink {
    fn value(&mut self, at: &Vector6<f64>) -> f64 {
        (at - bottom()).iter().map(|d| d.abs()).sum::<f64>() / 6.0
    }

    fn linearise(&mut self, at: &Vector6<f64>, rows: &mut Vec<Row>) -> Option<f64> {
        for (i, d) in (at - bottom()).iter().enumerate() {
            let derivative = Vector6::from_fn(|k, _| if k == i { 1.0 } else { 0.0 });
            rows.push(Row { residual: *d, weight: 1.0 / (6.0 * d.abs().max(1e-6)), derivative });
        }
        Some(self.value(at))
    }
}

/// Calls that an optimiser needs on a smooth valley, and how near it comes.
fn needs(optimiser: Optimiser) -> (usize, f64) {
    match optimiser {
        Optimiser::LevenbergMarquardt => (40, 1e-3),
        Optimiser::Sqp => (100, 1e-3),
        Optimiser::Bfgs | Optimiser::Powell => (800, 0.01),
        Optimiser::Sequential | Optimiser::NelderMead => (2000, 0.02),
        Optimiser::ParticleSwarm | Optimiser::Genetic => (8000, 0.02),
        // Not sure to come to rest.
        Optimiser::SimulatedAnnealing => (8000, 0.1),
    }
}

#[test]
fn all_find_the_bottom_of_a_valley_across_the_axes() {
    for optimiser in Optimiser::ALL {
        let (calls, near) = needs(optimiser);
        let found = optimiser.minimise(&mut Squares, &Vector6::repeat(5.0), &search(calls)).unwrap();
        let off = (found.at - bottom()).amax();
        assert!(off < near, "{}: {off} {found:?}", optimiser.name());
        assert!(
            found.converged || optimiser == Optimiser::SimulatedAnnealing,
            "{}: {found:?}",
            optimiser.name()
        );
        assert!((found.value - valley(&found.at)).abs() < 1e-12);
        // The same on every run.
        let again = optimiser.minimise(&mut Squares, &Vector6::repeat(5.0), &search(calls)).unwrap();
        assert_eq!(found, again);
    }
}

#[test]
fn a_kink_at_the_minimum_does_not_hold_them_up() {
    for optimiser in Optimiser::ALL {
        let (calls, _) = needs(optimiser);
        let start = bottom() + Vector6::new(3.0, -2.0, 1.0, -1.0, 2.0, -3.0);
        let found = optimiser.minimise(&mut Kink, &start, &search(2 * calls)).unwrap();
        let off = (found.at - bottom()).amax();
        assert!(off < 0.15, "{}: {off} {found:?}", optimiser.name());
    }
}

#[test]
fn a_minimum_outside_the_bounds_is_sought_at_the_bound_and_nothing_is_called_beyond() {
    let high = Vector6::new(8.0, 8.0, 8.0, 2.5, 8.0, 8.0);
    let expected = Vector6::new(1.0, -2.0, 0.5, 2.5, -1.0, 2.0);
    struct Watched(Vector6<f64>);
    impl Function for Watched {
        fn value(&mut self, at: &Vector6<f64>) -> f64 {
            self.0 = self.0.sup(at);
            (at - bottom()).norm_squared()
        }
        fn linearise(&mut self, at: &Vector6<f64>, rows: &mut Vec<Row>) -> Option<f64> {
            for (i, d) in (at - bottom()).iter().enumerate() {
                let derivative = Vector6::from_fn(|k, _| if k == i { 1.0 } else { 0.0 });
                rows.push(Row { residual: *d, weight: 2.0, derivative });
            }
            Some(self.value(at))
        }
    }
    for optimiser in Optimiser::ALL {
        let (calls, near) = needs(optimiser);
        let mut watched = Watched(Vector6::repeat(f64::NEG_INFINITY));
        let bounded = Search { high, ..search(calls) };
        let found = optimiser.minimise(&mut watched, &Vector6::repeat(4.0), &bounded).unwrap();
        assert!((found.at - expected).amax() < 2.0 * near, "{}: {found:?}", optimiser.name());
        assert!(found.at[3] <= 2.5);
        let beyond = (watched.0 - high).max();
        let allowed = if optimiser == Optimiser::Bfgs { 0.1 + 1e-12 } else { 0.0 };
        assert!(beyond <= allowed, "{}: {beyond}", optimiser.name());
    }
}

#[test]
fn calls_are_counted_and_a_search_that_uses_them_up_has_not_converged() {
    for optimiser in Optimiser::ALL {
        for calls in [0, 1, 3, 7, 30] {
            let mut counted = 0;
            struct Counted<'a>(&'a mut usize);
            impl Function for Counted<'_> {
                fn value(&mut self, at: &Vector6<f64>) -> f64 {
                    *self.0 += 1;
                    valley(at)
                }
                fn linearise(&mut self, at: &Vector6<f64>, rows: &mut Vec<Row>) -> Option<f64> {
                    Squares.linearise(at, rows);
                    Some(self.value(at))
                }
            }
            let found = optimiser
                .minimise(&mut Counted(&mut counted), &Vector6::repeat(4.0), &search(calls))
                .unwrap();
            assert!(counted <= calls && found.calls == counted, "{} {calls}: {found:?}", optimiser.name());
            // Those with rows are done in three.
            let done = [Optimiser::LevenbergMarquardt, Optimiser::Sqp].contains(&optimiser) && calls >= 3;
            assert_eq!(found.converged, done, "{} {calls}: {found:?}", optimiser.name());
        }
    }
}

#[test]
fn functions_without_numbers_and_flat_ones_end() {
    struct Nowhere(f64);
    impl Function for Nowhere {
        fn value(&mut self, _: &Vector6<f64>) -> f64 {
            self.0
        }
        fn linearise(&mut self, _: &Vector6<f64>, rows: &mut Vec<Row>) -> Option<f64> {
            rows.push(Row { residual: self.0, weight: self.0, derivative: Vector6::repeat(self.0) });
            Some(self.0)
        }
    }
    for optimiser in Optimiser::ALL {
        for value in [f64::NAN, f64::INFINITY, 200.0] {
            let found = optimiser.minimise(&mut Nowhere(value), &Vector6::zeros(), &search(500)).unwrap();
            assert!(found.calls <= 500, "{} {value}: {found:?}", optimiser.name());
        }
    }
}

#[test]
fn one_that_needs_residuals_says_so() {
    let mut plain = |at: &Vector6<f64>| valley(at);
    let none = Optimiser::LevenbergMarquardt.minimise(&mut plain, &Vector6::zeros(), &search(800));
    assert_eq!(none, Err(NoResiduals));
    // Others take differences instead.
    let found = Optimiser::Sqp.minimise(&mut plain, &Vector6::repeat(5.0), &search(800)).unwrap();
    assert!(found.converged && (found.at - bottom()).amax() < 0.01, "{found:?}");
}
