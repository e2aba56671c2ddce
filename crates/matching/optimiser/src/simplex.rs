//! The simplex of Nelder and Mead, of `argmin`, and how a function is lent to that crate.
//!
//! `argmin` has no bounds here and no count of calls that would stop a round: so points beyond a bound get the value of the nearest one within
//! and more, and a function whose calls are used up ends the run by an error, which is no failure.

use std::cell::RefCell;

use argmin::core::{Error, Executor, IterState};
use argmin::solver::neldermead::NelderMead;
use nalgebra::Vector6;

use crate::asked::Asked;

/// Corners of a simplex.
const CORNERS: usize = 7;

/// Why a run of `argmin` was ended by its function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ended {
    /// The calls are used up.
    Spent,
    /// Many calls in a row were near the best point.
    Settled,
}

impl std::fmt::Display for Ended {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Spent => "the calls are used up",
            Self::Settled => "settled",
        })
    }
}

impl std::error::Error for Ended {}

impl Ended {
    /// Whether a run that this error ended had come to rest.
    pub fn of(error: &Error) -> Option<()> {
        (error.downcast_ref() == Some(&Self::Settled)).then_some(())
    }
}

/// A function lent to `argmin`, which calls it without changing it.
pub(crate) struct Shared<'a, 'f> {
    asked: RefCell<&'a mut Asked<'f>>,
}

impl<'a, 'f> Shared<'a, 'f> {
    /// Ends when its calls are used up, or many in a row were near the best point.
    pub fn new(asked: &'a mut Asked<'f>) -> Self {
        Self { asked: RefCell::new(asked) }
    }

    /// The nearest point within the bounds.
    pub fn within(&self, at: &[f64]) -> Result<Vec<f64>, Error> {
        let asked = self.asked.try_borrow()?;
        Ok(asked.search.within(&Vector6::from_column_slice(at)).as_slice().to_vec())
    }

    pub fn value(&self, at: &[f64]) -> Result<f64, Error> {
        let mut asked = self.asked.try_borrow_mut()?;
        if asked.settled() {
            return Err(Ended::Settled.into());
        }
        asked.value_within(&Vector6::from_column_slice(at)).ok_or_else(|| Ended::Spent.into())
    }
}

pub(crate) fn minimise(asked: &mut Asked<'_>, start: &Vector6<f64>) -> Option<()> {
    // That crate panics where a first corner has no value.
    if asked.left() < CORNERS {
        asked.value(start)?;
        return None;
    }
    let side = asked.search.reach / 4.0;
    let corner = |k: usize| {
        let mut at = *start;
        if k > 0 {
            // Away from a bound that is near.
            let i = k - 1;
            at[i] += if at[i] + side <= asked.search.high[i] { side } else { -side };
        }
        at.as_slice().to_vec()
    };
    let corners: Vec<Vec<f64>> = (0..CORNERS).map(corner).collect();
    // The corners' values differ by less than a distance of the tolerance makes.
    let solver = NelderMead::new(corners).with_sd_tolerance(0.01 * asked.search.tolerance).ok()?;
    let run = Executor::new(Shared::new(asked), solver)
        .configure(|state: IterState<Vec<f64>, (), (), (), (), f64>| state.max_iters(u64::MAX))
        .run();
    match run {
        Ok(_) => Some(()),
        Err(error) => Ended::of(&error),
    }
}
