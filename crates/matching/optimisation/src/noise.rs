//! How sure a pose is of the noise of its edges: from the residuals and their correlation along the contour.
//!
//! The pose solves `sum_i l_i g_i u_i = 0` with `g_i` the derivatives of the residuals, `l_i` the lengths that they stand for and
//! `u_i = w(r_i) r_i` the residuals with their robust weights. So its covariance is the sandwich `A^-1 M A^-1` of M-estimators (Huber 1967):
//! `A` is the normal matrix with the mean slope of `u` in place of the mean weight, and `M = sum_ij l_i l_j g_i g_j' c(d_ij)`, `c` the
//! covariance of `u` at the distance `d` in the picture: `s^2 exp(-d / L)`.
//!
//! **Variance and correlation length** are those whose model of the residuals' products at 24 distances fits best. A fit takes out of residuals what
//! it can explain: over a contour of length `C` that they have `p` parameters for, products are smaller by `s^2 2 p L / C` at every distance
//! short beside `C`. That is in the model, so that noise which varies slowly, and is mostly fitted away, is not taken for small.
//!
//! The variance of so few independent residuals is not sure: the covariance is that of Student's distribution.
//!
//! How often truths lie inside what is stated is measured, not guaranteed: `cargo xtask validate --only coverage`, with the goals that are
//! missed. **Not in it:** errors of the calibration, and what a mesh leaves out of its body beyond what residuals show.

use nalgebra::{Matrix6, Vector6};

use crate::refine::{Buffers, robust_slope, robust_weight};

/// Distances at which products of residuals are taken, px: the upper ends of the bins.
const BINS: usize = 24;
const BIN_PX: f64 = 4.0;
/// Correlation lengths that are tried, px: from a point's own noise to what no contour could tell from an error of the pose.
const LENGTHS_PX: [f64; 13] = [0.5, 1.0, 1.5, 2.5, 4.0, 6.0, 9.0, 13.0, 20.0, 30.0, 45.0, 65.0, 90.0];
/// Rows of a view whose products are taken, at most.
const PRODUCT_ROWS: usize = 256;
/// Rows of a view that stand for all in the sum over pairs, at most.
const PAIR_ROWS: usize = 96;

/// Residuals of one view with their robust weights, where they are, and their centred derivatives.
struct Series {
    pixel: Vec<[f64; 2]>,
    value: Vec<f64>,
    weight: Vec<f64>,
    derivative: Vec<Vector6<f64>>,
    contour_px: f64,
}

/// The covariance of a pose with this normal matrix (mm^2) and these rows; none where they do not hold it.
pub(crate) fn covariance(
    normal: &Matrix6<f64>,
    scale_squared: f64,
    buffers: &Buffers,
) -> Option<Matrix6<f64>> {
    let (mut slopes, mut weights) = (0.0, 0.0);
    let mut all = Vec::new();
    let mut rows_in_all = 0;
    for (view, (rows, inset)) in buffers.by_view().enumerate() {
        rows_in_all += rows.len();
        let mut series = Series {
            pixel: Vec::with_capacity(rows.len()),
            value: Vec::with_capacity(rows.len()),
            weight: Vec::with_capacity(rows.len()),
            derivative: Vec::with_capacity(rows.len()),
            contour_px: 0.0,
        };
        let (mut sum, mut mean) = (0.0, Vector6::zeros());
        for row in rows {
            let left = row.residual - inset;
            let robust = robust_weight(scale_squared, left);
            slopes += row.weight() * robust_slope(scale_squared, left);
            weights += row.weight() * robust;
            mean += row.derivative * (row.weight() * robust);
            sum += row.weight() * robust;
            let pixel = buffers.sample(view, row).pixel;
            series.pixel.push([pixel.x, pixel.y]);
            series.value.push(robust * left);
            series.weight.push(row.weight());
            series.contour_px += row.length;
        }
        if sum > 0.0 {
            mean /= sum;
        }
        series.derivative.extend(rows.iter().map(|row| row.derivative - mean));
        all.push(series);
    }
    let fitted = 6.0 + all.len() as f64;
    if weights <= 0.0 || rows_in_all as f64 <= fitted {
        return None;
    }
    let (variance, length) = correlation(&all, fitted)?;
    let mut middle = Matrix6::zeros();
    for series in &all {
        middle += spread(series, length);
    }
    // A slope near zero says that most residuals are outliers: such a pose is not sure of anything.
    let slope = (slopes / weights).max(0.05);
    let inverse = (normal * slope).try_inverse()?;
    // The variance is itself known from so many independent residuals: errors over it are Student's, whose variance is larger.
    let contour: f64 = all.iter().map(|s| s.contour_px).sum();
    let freedom = (contour / (2.0 * length)).min(rows_in_all as f64) - fitted;
    let student = if freedom > 4.0 { freedom / (freedom - 2.0) } else { 2.0 };
    Some(inverse * middle * inverse * (variance * student)).filter(|c| c.iter().all(|v| v.is_finite()))
}

/// Variance of the noise, px^2, and its correlation length, px.
fn correlation(all: &[Series], fitted: f64) -> Option<(f64, f64)> {
    // Sums of products and their number; the first is that of each value with itself.
    let (mut products, mut counts) = ([0.0; BINS + 1], [0.0; BINS + 1]);
    let mut apart = [0.0; BINS + 1];
    for series in all {
        let step = series.value.len().div_ceil(PRODUCT_ROWS).max(1);
        let chosen: Vec<usize> = (0..series.value.len()).step_by(step).collect();
        for (n, &i) in chosen.iter().enumerate() {
            products[0] += series.value[i] * series.value[i];
            counts[0] += 1.0;
            for &j in &chosen[..n] {
                let (x, y) =
                    (series.pixel[i][0] - series.pixel[j][0], series.pixel[i][1] - series.pixel[j][1]);
                let squared = x * x + y * y;
                if squared < (BIN_PX * BINS as f64) * (BIN_PX * BINS as f64) {
                    let distance = squared.sqrt();
                    let bin = 1 + (distance / BIN_PX) as usize;
                    if bin <= BINS {
                        products[bin] += series.value[i] * series.value[j];
                        counts[bin] += 1.0;
                        apart[bin] += distance;
                    }
                }
            }
        }
    }
    let contour: f64 = all.iter().map(|s| s.contour_px).sum();
    if contour <= 0.0 || counts[0] <= 0.0 {
        return None;
    }
    let mut best: Option<(f64, f64, f64)> = None;
    for length in LENGTHS_PX {
        // Least squares for the variance, bins weighed by their numbers of pairs.
        let lost = (2.0 * fitted * length / contour).min(0.9);
        let (mut own, mut with) = (0.0, 0.0);
        for bin in 0..=BINS {
            if counts[bin] > 0.0 {
                let model = (-(apart[bin] / counts[bin]) / length).exp() - lost;
                own += counts[bin] * model * model;
                with += products[bin] * model;
            }
        }
        let variance = with / own;
        // What the fit leaves, less what is the same for all lengths.
        let misfit = -with * with / own;
        if variance > 0.0 && best.is_none_or(|b| misfit < b.0) {
            best = Some((misfit, variance, length));
        }
    }
    // Residuals that are nought to the last bit are as they are.
    best.map(|b| (b.1, b.2)).or(Some((products[0] / counts[0], LENGTHS_PX[0])))
}

/// `sum_ij l_i l_j g_i g_j' exp(-d_ij / L)` of one view: some rows stand for all, each for the stretch of contour to its neighbours.
fn spread(series: &Series, length: f64) -> Matrix6<f64> {
    let step = series.value.len().div_ceil(PAIR_ROWS).max(1);
    // Rows that follow each other need not be neighbours on the contour: each stands as it is, its weight raised for those passed over.
    let chosen: Vec<usize> = (0..series.value.len()).step_by(step).collect();
    if chosen.is_empty() {
        return Matrix6::zeros();
    }
    let total: f64 = series.weight.iter().sum();
    let raised = total / chosen.iter().map(|i| series.weight[*i]).sum::<f64>();
    let stretch = series.contour_px / chosen.len() as f64 / length;
    // Means over stretches of an exponential correlation: with itself, and with others.
    let own = 2.0 / stretch * (1.0 - (1.0 - (-stretch).exp()) / stretch);
    let others = if stretch < 30.0 { ((stretch / 2.0).sinh() / (stretch / 2.0)).powi(2) } else { 0.0 };
    let mut sum = Matrix6::zeros();
    for (n, &i) in chosen.iter().enumerate() {
        let mut pull = series.derivative[i] * (0.5 * own * series.weight[i]);
        for &j in &chosen[..n] {
            let (x, y) = (series.pixel[i][0] - series.pixel[j][0], series.pixel[i][1] - series.pixel[j][1]);
            let distance = (x * x + y * y).sqrt() / length;
            if distance < 8.0 + stretch {
                let correlation = (others * (-distance).exp()).min(own);
                pull += series.derivative[j] * (correlation * series.weight[j]);
            }
        }
        sum += series.derivative[i] * pull.transpose() * series.weight[i];
    }
    (sum + sum.transpose()) * (raised * raised)
}
