//! Gaussian smoothing: rows, then columns, a row at a time, so that what is being worked on stays in the cache.

use biplane_artifact::Frame;
use pulp::Arch;

use crate::{Grey, scaled_rows};

/// Half of a Gaussian's weights, from its middle outwards to 4 standard deviations; the whole sums to 1.
pub(crate) fn half_kernel(sigma: f64) -> Vec<f32> {
    let reach = (4.0 * sigma).ceil() as usize;
    let weights: Vec<f64> = (0..=reach).map(|i| (-0.5 * (i as f64 / sigma).powi(2)).exp()).collect();
    let sum = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
    weights.iter().map(|w| (w / sum) as f32).collect()
}

/// Index `i` of a line of `n`, mirrored at the centres of its first and last sample.
fn mirrored(i: isize, n: usize) -> usize {
    let last = n as isize - 1;
    if last == 0 {
        return 0;
    }
    let i = i.rem_euclid(2 * last);
    (if i > last { 2 * last - i } else { i }) as usize
}

impl Grey {
    /// Convolution with a Gaussian of standard deviation `sigma` px; the picture is mirrored at its edges. With 0 it stays as it is.
    pub fn smoothed(&self, sigma: f64) -> Self {
        let (width, height) = (self.width, self.height);
        if sigma <= 0.0 || width * height == 0 {
            return self.clone();
        }
        let row = |y: usize, out: &mut [f32]| out.copy_from_slice(&self.samples[y * width..(y + 1) * width]);
        Self { width, height, samples: smoothed([width, height], sigma, row) }
    }

    /// The same of a frame's samples scaled to 0..255, without a copy of them in between.
    pub fn of_smoothed(frame: &Frame, sigma: f64) -> Self {
        let (width, height) = (frame.width, frame.height);
        if sigma <= 0.0 || width * height == 0 {
            return Self::of(frame);
        }
        Self { width, height, samples: smoothed([width, height], sigma, scaled_rows(frame)) }
    }
}

/// Convolution of a picture given by its rows.
fn smoothed([width, height]: [usize; 2], sigma: f64, row: impl Fn(usize, &mut [f32])) -> Vec<f32> {
    let kernel = half_kernel(sigma);
    let mut samples = vec![0.0_f32; width * height];
    Arch::new().dispatch(
        #[inline(always)]
        || smooth(height, row, &kernel, width, &mut samples),
    );
    samples
}

/// `out = k * samples` in both directions.
#[inline(always)]
fn smooth(height: usize, source: impl Fn(usize, &mut [f32]), kernel: &[f32], width: usize, out: &mut [f32]) {
    let reach = kernel.len() - 1;
    // The last rows that were smoothed along themselves; as many as a column's sum needs.
    let kept = (2 * reach + 1).min(height);
    let mut ring = vec![0.0_f32; kept * width];
    let mut line = vec![0.0_f32; width + 2 * reach];
    let mut done = 0;
    for (y, out) in out.chunks_exact_mut(width).enumerate() {
        while done < (y + reach + 1).min(height) {
            source(done, &mut line[reach..reach + width]);
            for i in 0..reach {
                line[i] = line[reach + mirrored(i as isize - reach as isize, width)];
                line[reach + width + i] = line[reach + mirrored((width + i) as isize, width)];
            }
            let slot = done % kept * width;
            let pair = |k: usize| (&line[reach - k..], &line[reach + k..]);
            weigh(kernel, pair, &mut ring[slot..slot + width]);
            done += 1;
        }
        let row = |i: isize| {
            let slot = mirrored(i, height) % kept * width;
            &ring[slot..slot + width]
        };
        weigh(kernel, |k| (row(y as isize - k as isize), row(y as isize + k as isize)), out);
    }
}

/// `out[i]` is the sum of `kernel[k] * (a[i] + b[i])` over the pairs `a`, `b` at distance `k`; the middle counts once.
#[inline(always)]
fn weigh<'a>(kernel: &[f32], pair: impl Fn(usize) -> (&'a [f32], &'a [f32]), out: &mut [f32]) {
    let n = out.len();
    let middle = &pair(0).0[..n];
    for i in 0..n {
        out[i] = kernel[0] * middle[i];
    }
    for (k, &weight) in kernel.iter().enumerate().skip(1) {
        let (a, b) = pair(k);
        let (a, b) = (&a[..n], &b[..n]);
        for i in 0..n {
            out[i] += weight * (a[i] + b[i]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smoothing_keeps_a_constant_and_the_mean_of_a_spike() {
        let flat = Grey { width: 9, height: 7, samples: vec![3.0; 63] };
        assert!(flat.smoothed(1.5).samples.iter().all(|v| (v - 3.0).abs() < 1e-5));
        let mut spike = Grey { width: 41, height: 41, samples: vec![0.0; 41 * 41] };
        spike.samples[20 * 41 + 20] = 1.0;
        let s = spike.smoothed(2.0);
        assert!((s.samples.iter().sum::<f32>() - 1.0).abs() < 1e-4);
        // Peak of a two-dimensional Gaussian: 1 / (2 pi sigma^2), and what the tails left out add.
        assert!((s.samples[20 * 41 + 20] - 0.0398).abs() < 2e-4);
        assert_eq!(s.samples[18 * 41 + 20], s.samples[22 * 41 + 20]);
    }

    #[test]
    fn it_is_the_sum_that_the_definition_says() {
        let (width, height) = (13, 6);
        let samples: Vec<f32> = (0..width * height).map(|i| ((i * 7919) % 101) as f32).collect();
        let smoothed = Grey { width, height, samples: samples.clone() }.smoothed(1.2);
        let kernel = half_kernel(1.2);
        let reach = kernel.len() as isize - 1;
        for (place, found) in smoothed.samples.iter().enumerate() {
            let (x, y) = ((place % width) as isize, (place / width) as isize);
            let mut sum = 0.0;
            for (j, i) in (-reach..=reach).flat_map(|j| (-reach..=reach).map(move |i| (j, i))) {
                let weight = kernel[j.unsigned_abs()] * kernel[i.unsigned_abs()];
                sum += weight * samples[mirrored(y + j, height) * width + mirrored(x + i, width)];
            }
            assert!((found - sum).abs() < 1e-3, "{place}: {found} is not {sum}");
        }
    }

    #[test]
    fn a_frame_is_smoothed_as_its_grey_levels_are() {
        let samples = (0..40 * 31).map(|i| (i * 7919 % 4096) as u16).collect();
        let frame = Frame { width: 40, height: 31, samples, bits: 12 };
        for sigma in [0.0, 0.7, 3.0] {
            assert_eq!(Grey::of_smoothed(&frame, sigma), Grey::of(&frame).smoothed(sigma));
        }
    }

    #[test]
    fn a_picture_narrower_than_the_kernel_is_smoothed_too() {
        let tiny = Grey { width: 2, height: 1, samples: vec![0.0, 1.0] };
        assert!((tiny.smoothed(5.0).samples[0] - 0.5).abs() < 0.1);
        let single = Grey { width: 1, height: 1, samples: vec![7.0] }.smoothed(3.0);
        assert!((single.samples[0] - 7.0).abs() < 1e-4);
        let none = Grey { width: 0, height: 5, samples: vec![] };
        assert_eq!(none.smoothed(1.0), none);
    }
}
