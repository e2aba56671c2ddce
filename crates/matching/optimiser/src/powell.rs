//! Powell's method of conjugate directions (M. J. D. Powell, "An efficient method for finding the minimum of a function of several variables
//! without calculating derivatives", 1964), with his test of whether the round's whole way is worth to be a direction.

use nalgebra::Vector6;

use crate::asked::Asked;
use crate::line;

pub(crate) fn minimise(asked: &mut Asked<'_>, start: &Vector6<f64>) -> Option<()> {
    let mut directions: [Vector6<f64>; 6] =
        std::array::from_fn(|i| Vector6::from_fn(|k, _| if k == i { 1.0 } else { 0.0 }));
    let mut at = *start;
    let mut value = asked.value(&at)?;
    // Steps become as long as the last round was.
    let mut first = asked.search.reach / 4.0;
    loop {
        let (begun, value_begun) = (at, value);
        let (mut most, mut fallen) = (0, 0.0);
        for (k, along) in directions.iter().enumerate() {
            let (s, found) = line::minimum(asked, &at, value, along, first)?;
            if value - found > fallen {
                (most, fallen) = (k, value - found);
            }
            at = asked.search.within(&(at + along * s));
            value = found;
        }
        let way = at - begun;
        if way.amax() < asked.search.tolerance {
            return Some(());
        }
        first = way.norm().clamp(2.0 * asked.search.tolerance, asked.search.reach / 4.0);
        let beyond = asked.search.within(&(at + way));
        let value_beyond = asked.value(&beyond)?;
        let whole = value_begun - value;
        let curved = 2.0 * (value_begun - 2.0 * value + value_beyond) * (whole - fallen).powi(2);
        if value_beyond < value_begun && curved < fallen * (value_begun - value_beyond).powi(2) {
            let along = way.normalize();
            let (s, found) = line::minimum(asked, &at, value, &along, first)?;
            at = asked.search.within(&(at + along * s));
            value = found;
            directions[most] = directions[5];
            directions[5] = along;
        }
    }
}
