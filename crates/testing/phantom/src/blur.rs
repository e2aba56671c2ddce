//! Gaussian blur of a picture, which keeps its sum: beyond its border a picture goes on as its mirror image.

/// Standard deviations that a kernel reaches: what is beyond has 6e-5 of its weight.
const REACH: f64 = 4.0;

/// Weights at 0, 1, 2, ... px; their sum over both sides is 1.
fn kernel(sigma_px: f64) -> Vec<f32> {
    let reach = (REACH * sigma_px).ceil().max(1.0) as usize;
    // The mean of the Gaussian over a pixel would blur by the pixel once more, so its value is taken.
    let weights: Vec<f64> = (0..=reach).map(|k| (-0.5 * (k as f64 / sigma_px).powi(2)).exp()).collect();
    let sum = 2.0 * weights.iter().sum::<f64>() - weights[0];
    weights.iter().map(|w| (w / sum) as f32).collect()
}

/// A place of a line of `n` pixels that goes on mirrored on both sides.
fn mirrored(at: isize, n: usize) -> usize {
    let period = 2 * n as isize;
    let at = at.rem_euclid(period);
    (if at < n as isize { at } else { period - 1 - at }) as usize
}

/// Blurs row by row pixels of a picture `width` pixels wide.
pub(crate) fn gaussian(values: &mut [f32], width: usize, sigma_px: f64) {
    if sigma_px < 0.05 || values.is_empty() {
        // Neighbours would weigh less than 1e-80.
        return;
    }
    let kernel = kernel(sigma_px);
    let reach = kernel.len() - 1;
    let height = values.len() / width;

    let mut line = vec![0.0; width + 2 * reach];
    for row in values.chunks_exact_mut(width) {
        for (at, value) in line.iter_mut().enumerate() {
            *value = row[mirrored(at as isize - reach as isize, width)];
        }
        for (x, value) in row.iter_mut().enumerate() {
            *value = kernel[0] * line[x + reach];
        }
        for (k, weight) in kernel.iter().enumerate().skip(1) {
            let (left, right) = (&line[reach - k..], &line[reach + k..]);
            for ((value, l), r) in row.iter_mut().zip(left).zip(right) {
                *value += weight * (l + r);
            }
        }
    }

    let rows = values.to_vec();
    let row = |y: isize| {
        let y = mirrored(y, height);
        &rows[y * width..(y + 1) * width]
    };
    for (y, into) in values.chunks_exact_mut(width).enumerate() {
        for (value, v) in into.iter_mut().zip(row(y as isize)) {
            *value = kernel[0] * v;
        }
        for (k, weight) in kernel.iter().enumerate().skip(1) {
            let (above, below) = (row(y as isize - k as isize), row(y as isize + k as isize));
            for ((value, a), b) in into.iter_mut().zip(above).zip(below) {
                *value += weight * (a + b);
            }
        }
    }
}

/// Side of the blocks of [`broad`], px.
const BLOCK: usize = 16;

/// A picture blurred so broadly that it may be computed from the means of blocks of 16 x 16 pixels, `sigma_px` being at
/// least some 20 px; between the blocks' middles it is linear.
pub(crate) fn broad(values: &[f32], width: usize, sigma_px: f64) -> Vec<f32> {
    let height = values.len() / width.max(1);
    let (columns, rows) = (width.div_ceil(BLOCK), height.div_ceil(BLOCK));
    let mut blocks = vec![0.0_f32; columns * rows];
    let mut counts = vec![0.0_f32; columns * rows];
    for (y, row) in values.chunks_exact(width.max(1)).enumerate() {
        for (x, value) in row.iter().enumerate() {
            let block = (y / BLOCK) * columns + x / BLOCK;
            blocks[block] += value;
            counts[block] += 1.0;
        }
    }
    for (block, count) in blocks.iter_mut().zip(&counts) {
        *block /= count;
    }
    gaussian(&mut blocks, columns, sigma_px / BLOCK as f64);

    // The two blocks next to a pixel and the share of the second.
    let between = |at: usize, blocks: usize| {
        let place = ((at as f32 + 0.5) / BLOCK as f32 - 0.5).clamp(0.0, (blocks - 1) as f32);
        let first = (place as usize).min(blocks.saturating_sub(2));
        (first, (first + 1).min(blocks - 1), place - first as f32)
    };
    let across: Vec<_> = (0..width).map(|x| between(x, columns)).collect();
    let mut smooth = Vec::with_capacity(values.len());
    for y in 0..height {
        let (above, below, s) = between(y, rows);
        for &(left, right, t) in &across {
            let at =
                |row: usize| blocks[row * columns + left] * (1.0 - t) + blocks[row * columns + right] * t;
            smooth.push(at(above) * (1.0 - s) + at(below) * s);
        }
    }
    smooth
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blur_keeps_the_sum_and_has_its_width() {
        for (x, y) in [(20, 15), (0, 0), (39, 1)] {
            let mut picture = vec![0.0; 40 * 31];
            picture[y * 40 + x] = 1.0;
            gaussian(&mut picture, 40, 1.7);
            assert!((picture.iter().sum::<f32>() - 1.0).abs() < 1e-5);
            if (x, y) == (20, 15) {
                let spread = |f: fn(usize) -> f64, mean: f64| -> f64 {
                    let of = |(i, v): (usize, &f32)| (f(i) - mean).powi(2) * f64::from(*v);
                    picture.iter().enumerate().map(of).sum::<f64>().sqrt()
                };
                // What lies beyond 4 standard deviations is cut off: 0.05 % of the variance.
                assert!((spread(|i| (i % 40) as f64, 20.0) - 1.7).abs() < 2e-3);
                assert!((spread(|i| (i / 40) as f64, 15.0) - 1.7).abs() < 2e-3);
            }
        }
    }

    #[test]
    fn a_broad_blur_keeps_an_even_picture_and_the_mean() {
        let even = broad(&vec![0.25; 100 * 70], 100, 40.0);
        assert!(even.iter().all(|v| (v - 0.25).abs() < 1e-6));
        let mut step = vec![0.0; 128 * 128];
        step[..64 * 128].fill(1.0);
        let smooth = broad(&step, 128, 30.0);
        assert!((smooth.iter().sum::<f32>() / 16384.0 - 0.5).abs() < 1e-3);
        // The edge lies in the middle, where a step's blur is a half.
        assert!((smooth[64 * 128 + 60] - 0.5).abs() < 0.02);
    }
}
