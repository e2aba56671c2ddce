//! Smoothing a stack by a Gaussian whose size is in mm, whatever its voxels.

use crate::stack::Stack;

/// Weights beyond this many standard deviations are left out.
const REACH: f64 = 3.0;

/// Smooths along rows, columns and slices with the standard deviations given, mm; 0 leaves an axis as it is. Weights are
/// those of the places of the voxels that there are, so a border does not darken and slices may be spaced unevenly.
pub(crate) fn gaussian(stack: &Stack, values: &[f32], sigma_mm: [f64; 3]) -> Vec<f32> {
    let mut values = values.to_vec();
    let steps = [1, stack.size[0], stack.slice_voxels()];
    for axis in 0..3 {
        let count = stack.size[axis];
        if sigma_mm[axis] <= 0.0 || count == 1 {
            continue;
        }
        let at = |n: usize| match axis {
            2 => stack.heights_mm[n],
            _ => n as f64 * stack.pixel_mm[axis],
        };
        let taps: Vec<(usize, Vec<f32>)> = (0..count).map(|n| taps(&at, n, count, sigma_mm[axis])).collect();
        // Lines side by side in memory are smoothed together: a sum over whole rows of neighbours.
        let step = steps[axis];
        let mut line = vec![0.0_f32; count * step];
        for block in values.chunks_exact_mut(count * step) {
            line.fill(0.0);
            for (n, (first, weights)) in taps.iter().enumerate() {
                if step == 1 {
                    line[n] = weights.iter().zip(&block[*first..]).map(|(w, f)| w * f).sum();
                    continue;
                }
                let out = &mut line[n * step..(n + 1) * step];
                for (m, weight) in weights.iter().enumerate() {
                    let from = &block[(first + m) * step..(first + m + 1) * step];
                    for (o, f) in out.iter_mut().zip(from) {
                        *o += weight * f;
                    }
                }
            }
            block.copy_from_slice(&line);
        }
    }
    values
}

/// The first place that counts for place `n`, and the weights from there on, of sum 1.
fn taps(at: &impl Fn(usize) -> f64, n: usize, count: usize, sigma: f64) -> (usize, Vec<f32>) {
    let reaches = |m: usize| (at(m) - at(n)).abs() <= REACH * sigma;
    let first = (0..=n).rev().take_while(|&m| reaches(m)).last().unwrap_or(n);
    let last = (n..count).take_while(|&m| reaches(m)).last().unwrap_or(n);
    let weight = |m: usize| (-((at(m) - at(n)) / sigma).powi(2) / 2.0).exp();
    let sum: f64 = (first..=last).map(weight).sum();
    (first, (first..=last).map(|m| (weight(m) / sum) as f32).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_becomes_a_bell_of_the_size_in_mm_and_a_level_stays() {
        let heights_mm = (0..21).map(|k| f64::from(k) * 2.0).collect();
        let stack = Stack { size: [41, 41, 21], pixel_mm: [0.5, 0.25], heights_mm };
        let mut values = vec![0.0; stack.voxels()];
        values[stack.index([20, 20, 10])] = 1.0;
        let smooth = gaussian(&stack, &values, [1.0, 0.5, 2.0]);
        let at = |i, j, k| f64::from(smooth[stack.index([i, j, k])]);
        for (here, mm, sigma) in
            [(at(22, 20, 10), 1.0, 1.0), (at(20, 23, 10), 0.75, 0.5), (at(20, 20, 11), 2.0, 2.0)]
        {
            let wanted = (-(mm / sigma) * (mm / sigma) / 2.0_f64).exp();
            assert!((here / at(20, 20, 10) - wanted).abs() < 1e-5);
        }
        assert!(
            gaussian(&stack, &vec![3.0; stack.voxels()], [1.0; 3]).iter().all(|v| (v - 3.0).abs() < 1e-5)
        );
    }
}
