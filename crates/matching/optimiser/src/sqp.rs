//! Sequential quadratic programming: at each step the quadratic model of the function is minimised within the bounds (not only cut off at them),
//! and the step halved until the function falls (Armijo 1966). The model's matrix follows the formula of BFGS, kept positive by drawing the
//! change of the gradient towards the model's (Powell, "Algorithms for nonlinear constraints that use Lagrangian functions", 1978).
//!
//! Derivatives are exact where the function has rows, and the first matrix then is theirs. Else they are central differences, shortened where no
//! step helps any more.

use nalgebra::{Matrix6, Vector6};

use crate::Row;
use crate::asked::{Asked, gradient};
use crate::bfgs::updated;

/// Share of the promised fall that a step must bring.
const ARMIJO: f64 = 1e-4;
/// Factor of the difference step where it is shortened.
const SHORTEN: f64 = 0.2;
/// Rounds of the quadratic programme at most; six variables need far fewer.
const ROUNDS: usize = 200;

/// Value, gradient, and the rows' matrix where there are rows.
struct Local {
    value: f64,
    gradient: Vector6<f64>,
    matrix: Option<Matrix6<f64>>,
}

pub(crate) fn minimise(asked: &mut Asked<'_>, start: &Vector6<f64>) -> Option<()> {
    let mut rows = Vec::new();
    let mut difference = asked.search.first_difference.max(asked.search.last_difference);
    let mut at = *start;
    let mut local = look(asked, &at, difference, &mut rows)?;
    let mut matrix = first(&local, asked.search.reach);
    let mut fresh = true;
    loop {
        let step = programme(asked, &matrix, &local.gradient, &at);
        if let Some((next, value)) = line_search(asked, &at, &local, &step)? {
            let found = look_again(asked, &next, value, difference, &mut rows)?;
            matrix = updated(&matrix, &(next - at), &(found.gradient - local.gradient));
            (at, local, fresh) = (next, found, false);
        } else if !fresh {
            // What the matrix has learnt misleads, or the bottom is reached: once more without it.
            (matrix, fresh) = (first(&local, asked.search.reach), true);
        } else if local.matrix.is_none() && difference > asked.search.last_difference {
            difference = (difference * SHORTEN).max(asked.search.last_difference);
            local = look_again(asked, &at, local.value, difference, &mut rows)?;
            matrix = first(&local, asked.search.reach);
        } else {
            return Some(());
        }
    }
}

/// The rows' matrix, or one whose first step is as long as the reach.
fn first(local: &Local, reach: f64) -> Matrix6<f64> {
    let steep = local.gradient.norm() / reach.max(f64::MIN_POSITIVE);
    let plain = Matrix6::identity() * if steep > 0.0 && steep.is_finite() { steep } else { 1.0 };
    local.matrix.filter(|m| m.trace() > 0.0).map_or(plain, |m| m + Matrix6::identity() * (1e-6 * m.trace()))
}

fn look(asked: &mut Asked<'_>, at: &Vector6<f64>, difference: f64, rows: &mut Vec<Row>) -> Option<Local> {
    if let Ok(value) = asked.linearise(at, rows)? {
        return Some(of_rows(value, rows));
    }
    let value = asked.value(at)?;
    Some(Local { value, gradient: gradient(asked, at, difference)?, matrix: None })
}

/// Where the value is known already.
fn look_again(
    asked: &mut Asked<'_>,
    at: &Vector6<f64>,
    value: f64,
    difference: f64,
    rows: &mut Vec<Row>,
) -> Option<Local> {
    match asked.linearise(at, rows)? {
        Ok(value) => Some(of_rows(value, rows)),
        Err(_) => Some(Local { value, gradient: gradient(asked, at, difference)?, matrix: None }),
    }
}

fn of_rows(value: f64, rows: &[Row]) -> Local {
    let (mut gradient, mut matrix) = (Vector6::zeros(), Matrix6::zeros());
    for row in rows {
        gradient += row.derivative * (row.weight * row.residual);
        matrix.syger(row.weight, &row.derivative, &row.derivative, 1.0);
    }
    matrix.fill_upper_triangle_with_lower_triangle();
    Local { value, gradient, matrix: Some(matrix) }
}

/// The step within the bounds at which `gradient' s + s' matrix s / 2` is least, one variable after the other until none moves.
fn programme(
    asked: &Asked<'_>,
    matrix: &Matrix6<f64>,
    gradient: &Vector6<f64>,
    at: &Vector6<f64>,
) -> Vector6<f64> {
    let search = asked.search;
    let mut step = Vector6::zeros();
    for _ in 0..ROUNDS {
        let mut largest = 0.0_f64;
        for i in 0..6 {
            let slope = gradient[i] + matrix.row(i).transpose().dot(&step);
            let curvature = matrix[(i, i)];
            if curvature <= 0.0 || !slope.is_finite() {
                continue;
            }
            let to = (step[i] - slope / curvature).clamp(search.low[i] - at[i], search.high[i] - at[i]);
            largest = largest.max((to - step[i]).abs());
            step[i] = to;
        }
        if largest < 0.01 * search.tolerance {
            break;
        }
    }
    step
}

/// The first point along the step, halved and halved again, at which the function has fallen enough; `Some(None)` where the step falls below
/// the tolerance before.
fn line_search(
    asked: &mut Asked<'_>,
    at: &Vector6<f64>,
    local: &Local,
    step: &Vector6<f64>,
) -> Option<Option<(Vector6<f64>, f64)>> {
    let promised = -local.gradient.dot(step);
    let mut share = 1.0;
    while (step * share).amax() >= asked.search.tolerance {
        let next = asked.search.within(&(at + step * share));
        let value = asked.value(&next)?;
        if value < local.value - ARMIJO * share * promised.max(0.0) {
            return Some(Some((next, value)));
        }
        share /= 2.0;
    }
    Some(None)
}
