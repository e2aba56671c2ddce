//! Smoothing along a ring of evenly spread points, by local parabolas.
//!
//! At each point a parabola is fitted to its neighbours by weighted least squares (Savitzky and Golay; weights of Cleveland's
//! tricube), so that what bends slowly stays where it is; what lies off the parabolas counts less and less.

use nalgebra::{Matrix3, Vector3};

/// Values smoothed, and the standard deviation of each.
pub(crate) struct Smoothed {
    pub values: Vec<f64>,
    pub sigmas: Vec<f64>,
}

const ROUNDS: usize = 3;

/// `reach` is how many neighbours on either side count, fractions included.
pub(crate) fn smoothed(values: &[f64], sigmas: &[f64], reach: f64) -> Smoothed {
    let count = values.len();
    let side = (reach.floor() as usize).min(count.saturating_sub(1) / 2);
    let mut trust = vec![1.0; count];
    let mut smooth = Smoothed { values: values.to_vec(), sigmas: sigmas.to_vec() };
    if side < 1 {
        return smooth;
    }
    for _ in 0..ROUNDS {
        for n in 0..count {
            let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
            for m in 0..=2 * side {
                let off = m as f64 - side as f64;
                let at = (n + count + m - side) % count;
                let kernel = (1.0 - (off.abs() / reach.max(side as f64 + 0.5)).powi(3)).powi(3);
                let weight = kernel * trust[at] / (sigmas[at] * sigmas[at]).max(f64::MIN_POSITIVE);
                let u = off / side as f64;
                let row = Vector3::new(1.0, u, u * u);
                normal += row * row.transpose() * weight;
                right += row * (weight * values[at]);
            }
            // Keeps the curvature tame where hardly anything is trusted.
            let ridge = 1e-6 * normal[(0, 0)] + f64::MIN_POSITIVE;
            normal[(1, 1)] += ridge;
            normal[(2, 2)] += ridge;
            if let Some(inverse) = normal.try_inverse() {
                smooth.values[n] = (inverse * right)[0];
                smooth.sigmas[n] = inverse[(0, 0)].max(0.0).sqrt();
            }
        }
        let off: Vec<f64> = (0..count).map(|n| ((values[n] - smooth.values[n]) / sigmas[n]).abs()).collect();
        let mut sorted = off.clone();
        sorted.sort_by(f64::total_cmp);
        // 1.4826 times the median of sizes is the standard deviation of what is normal.
        let usual = (1.4826 * sorted[count / 2]).max(0.5);
        for (t, o) in trust.iter_mut().zip(&off) {
            *t = (1.0 + (o / (3.0 * usual)).powi(2)).powi(-2);
        }
    }
    smooth
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_wave_stays_and_a_stray_value_goes() {
        let wave = |n: usize| (n as f64 * std::f64::consts::TAU / 60.0).sin();
        let mut values: Vec<f64> = (0..60).map(wave).collect();
        values[20] += 5.0;
        let smooth = smoothed(&values, &[0.1; 60], 5.0);
        let worst = (0..60).map(|n| (smooth.values[n] - wave(n)).abs()).fold(0.0, f64::max);
        assert!(worst < 0.03, "{worst}");
        assert!(smooth.sigmas.iter().all(|s| (0.02..0.09).contains(s)));
    }
}
