//! Sequential parameter search: one variable after the other, a step up or down where the function falls. A step that helps grows, one that
//! does not is halved; the search ends when all are shorter than the tolerance.

use nalgebra::Vector6;

use crate::asked::Asked;

/// Factor of a step that helped.
const GROW: f64 = 1.6;

pub(crate) fn minimise(asked: &mut Asked<'_>, start: &Vector6<f64>) -> Option<()> {
    let mut at = *start;
    let mut value = asked.value(&at)?;
    let mut steps = Vector6::repeat(asked.search.reach / 4.0);
    while steps.amax() >= asked.search.tolerance {
        for i in 0..6 {
            let mut helped = false;
            // The way that helped last is tried first.
            for sign in [1.0, -1.0] {
                let mut next = at;
                next[i] += sign * steps[i];
                let next = asked.search.within(&next);
                if next[i] == at[i] {
                    continue;
                }
                let found = asked.value(&next)?;
                if found < value {
                    (at, value, helped) = (next, found, true);
                    steps[i] *= sign * GROW;
                    break;
                }
            }
            if !helped {
                steps[i] /= 2.0;
            }
        }
    }
    Some(())
}
