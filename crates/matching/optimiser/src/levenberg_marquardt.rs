//! Levenberg and Marquardt's damped least squares within bounds, weights renewed at each step (iteratively reweighted, so that a robust
//! function of the residuals is minimised too).
//!
//! A step is taken where the function falls, whatever the residuals' model promised; damping then falls by a factor, else it grows. A variable
//! at a bound that the gradient pushes beyond stays there.

use nalgebra::{Matrix6, Vector6};

use crate::asked::Asked;
use crate::{NoResiduals, Row};

/// Damping at first, as a share of the mean curvature; by what it falls and grows; and where no step is short enough.
const DAMPING: (f64, f64, f64, f64) = (1e-3, 0.2, 5.0, 1e9);

pub(crate) fn minimise(asked: &mut Asked<'_>, start: &Vector6<f64>) -> Result<Option<()>, NoResiduals> {
    let (mut rows, mut beside): (Vec<Row>, Vec<Row>) = (Vec::new(), Vec::new());
    let (mut at, mut damping) = (*start, DAMPING.0);
    let Some(value) = asked.linearise(&at, &mut rows) else { return Ok(None) };
    let mut value = value?;
    loop {
        let (matrix, downhill) = normal_equations(&rows);
        let moved = loop {
            let step = step(asked, &matrix, &downhill, &at, damping);
            let next = asked.search.within(&(at + step));
            if !next.iter().all(|v| v.is_finite()) || (next - at).amax() < asked.search.tolerance {
                return Ok(Some(()));
            }
            let Some(found) = asked.linearise(&next, &mut beside) else { return Ok(None) };
            let found = found?;
            if found < value {
                let moved = next - at;
                (at, value) = (next, found);
                std::mem::swap(&mut rows, &mut beside);
                damping *= DAMPING.1;
                break moved;
            }
            damping = (damping * DAMPING.2).max(1e-6);
            if damping > DAMPING.3 {
                return Ok(Some(()));
            }
        };
        if moved.amax() < asked.search.tolerance {
            return Ok(Some(()));
        }
    }
}

fn normal_equations(rows: &[Row]) -> (Matrix6<f64>, Vector6<f64>) {
    let (mut matrix, mut downhill) = (Matrix6::zeros(), Vector6::zeros());
    for row in rows {
        matrix.syger(row.weight, &row.derivative, &row.derivative, 1.0);
        downhill -= row.derivative * (row.weight * row.residual);
    }
    matrix.fill_upper_triangle_with_lower_triangle();
    (matrix, downhill)
}

fn step(
    asked: &Asked<'_>,
    matrix: &Matrix6<f64>,
    downhill: &Vector6<f64>,
    at: &Vector6<f64>,
    damping: f64,
) -> Vector6<f64> {
    let (mut matrix, mut downhill) = (*matrix, *downhill);
    let added = damping * (matrix.trace() / 6.0).max(f64::MIN_POSITIVE);
    for i in 0..6 {
        matrix[(i, i)] += added;
    }
    let search = asked.search;
    for i in 0..6 {
        if (at[i] <= search.low[i] && downhill[i] < 0.0) || (at[i] >= search.high[i] && downhill[i] > 0.0) {
            matrix.row_mut(i).fill(0.0);
            matrix.column_mut(i).fill(0.0);
            matrix[(i, i)] = 1.0;
            downhill[i] = 0.0;
        }
    }
    matrix.cholesky().map_or_else(Vector6::zeros, |c| c.solve(&downhill))
}
