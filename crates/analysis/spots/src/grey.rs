//! A grey picture in floating point: scaled to 0..255, smoothed by Gaussians, halved.
//!
//! Coordinates are pixels with the centre of the first one at (0, 0). **Guaranteed:** no value lies outside the range of
//! the samples. **Not guaranteed:** weights beyond 3 standard deviations, which are left out.

use biplane_artifact::Frame;

/// Grey levels row by row.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Grey {
    pub width: usize,
    pub height: usize,
    pub samples: Vec<f32>,
}

/// Half of a Gaussian's weights, from its middle outwards; the whole sums to 1.
fn half_kernel(sigma: f64) -> Vec<f32> {
    let reach = (3.0 * sigma).ceil() as usize;
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
    /// The samples of a frame, 0..255 whatever its bits. The frame holds `width * height` samples.
    pub fn of(frame: &Frame) -> Self {
        let full = f64::from((1_u32 << frame.bits.clamp(1, 16)) - 1);
        let scale = (255.0 / full) as f32;
        let samples = frame.samples.iter().map(|&s| f32::from(s) * scale).collect();
        Self { width: frame.width, height: frame.height, samples }
    }

    /// Convolution with a Gaussian of standard deviation `sigma` px; the picture is mirrored at its edges.
    pub fn smoothed(&self, sigma: f64) -> Self {
        let kernel = half_kernel(sigma);
        let (w, h) = (self.width, self.height);
        let reach = kernel.len() - 1;
        let mut across = vec![0.0_f32; w * h];
        let mut line = vec![0.0_f32; w + 2 * reach];
        for (row, out) in self.samples.chunks_exact(w).zip(across.chunks_exact_mut(w)) {
            for (i, v) in line.iter_mut().enumerate().take(reach) {
                *v = row[mirrored(i as isize - reach as isize, w)];
            }
            line[reach..reach + w].copy_from_slice(row);
            for (i, v) in line[reach + w..].iter_mut().enumerate() {
                *v = row[mirrored((w + i) as isize, w)];
            }
            for (o, v) in out.iter_mut().zip(&line[reach..]) {
                *o = kernel[0] * v;
            }
            for (k, weight) in kernel.iter().enumerate().skip(1) {
                for ((o, a), b) in out.iter_mut().zip(&line[reach - k..]).zip(&line[reach + k..]) {
                    *o += weight * (a + b);
                }
            }
        }
        let mut samples = vec![0.0_f32; w * h];
        for (y, out) in samples.chunks_exact_mut(w).enumerate() {
            let row = |i: isize| {
                let y = mirrored(i, h);
                &across[y * w..(y + 1) * w]
            };
            for (o, v) in out.iter_mut().zip(row(y as isize)) {
                *o = kernel[0] * v;
            }
            for (k, weight) in kernel.iter().enumerate().skip(1) {
                let (above, below) = (row(y as isize - k as isize), row(y as isize + k as isize));
                for ((o, a), b) in out.iter_mut().zip(above).zip(below) {
                    *o += weight * (a + b);
                }
            }
        }
        Self { width: w, height: h, samples }
    }

    /// Every second sample of every second row, from the first one: pixel `(x, y)` is `(2 x, 2 y)` of this one.
    pub fn halved(&self) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let rows = self.samples.chunks_exact(self.width).step_by(2);
        let samples = rows.flat_map(|row| row.iter().step_by(2).copied()).collect();
        Self { width, height, samples }
    }

    /// Standard deviation of the noise, grey levels: the median of Immerkaer's difference mask (J. Immerkaer, Fast noise
    /// variance estimation, 1996) where it is not 0, which edges and slopes hardly change.
    pub fn noise(&self) -> f64 {
        let (w, h) = (self.width, self.height);
        let mut sizes = Vec::with_capacity(w * h / 9);
        for y in (1..h.saturating_sub(1)).step_by(3) {
            for x in (1..w.saturating_sub(1)).step_by(3) {
                let at = |dx: usize, dy: usize| self.samples[(y + dy - 1) * w + x + dx - 1];
                let corners = at(0, 0) + at(2, 0) + at(0, 2) + at(2, 2);
                let sides = at(1, 0) + at(0, 1) + at(2, 1) + at(1, 2);
                let value = (corners - 2.0 * sides + 4.0 * at(1, 1)).abs();
                if value > 0.0 {
                    sizes.push(value);
                }
            }
        }
        if sizes.is_empty() {
            return 0.0;
        }
        let middle = sizes.len() / 2;
        let (_, median, _) = sizes.select_nth_unstable_by(middle, f32::total_cmp);
        // The mask's weights have a root sum of squares of 6; the median of |N(0, 1)| is 0.6745.
        f64::from(*median) / 6.0 / 0.6745
    }

    /// The value between the four pixels around a place, or of the nearest pixel outside the picture.
    pub fn at(&self, x: f64, y: f64) -> f64 {
        let (x, y) = (x.clamp(0.0, self.width as f64 - 1.0), y.clamp(0.0, self.height as f64 - 1.0));
        let (i, j) = (x as usize, y as usize);
        let (fx, fy) = (x - i as f64, y - j as f64);
        let (k, l) = ((i + 1).min(self.width - 1), (j + 1).min(self.height - 1));
        let sample = |i: usize, j: usize| f64::from(self.samples[j * self.width + i]);
        let above = sample(i, j) * (1.0 - fx) + sample(k, j) * fx;
        let below = sample(i, l) * (1.0 - fx) + sample(k, l) * fx;
        above * (1.0 - fy) + below * fy
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
        assert!((s.samples[20 * 41 + 20] - 0.0398).abs() < 4e-4);
    }

    #[test]
    fn a_picture_narrower_than_the_kernel_is_smoothed_and_halved_too() {
        let tiny = Grey { width: 2, height: 1, samples: vec![0.0, 1.0] };
        assert!((tiny.smoothed(5.0).samples[0] - 0.5).abs() < 0.1);
        assert_eq!(tiny.halved(), Grey { width: 1, height: 1, samples: vec![0.0] });
        let single = Grey { width: 1, height: 1, samples: vec![7.0] }.smoothed(3.0);
        assert!((single.samples[0] - 7.0).abs() < 1e-4);
    }

    #[test]
    fn between_pixels_values_are_linear() {
        let ramp = Grey { width: 3, height: 2, samples: vec![0.0, 1.0, 2.0, 10.0, 11.0, 12.0] };
        assert!((ramp.at(1.25, 0.5) - 6.25).abs() < 1e-12);
        assert_eq!(ramp.at(-5.0, 9.0), 10.0);
    }
}
