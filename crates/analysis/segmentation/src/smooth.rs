//! Gaussian smoothing of a grey picture, and its noise.

/// A grey picture in floating point, row by row.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Grey {
    pub width: usize,
    pub height: usize,
    pub samples: Vec<f32>,
}

/// Half of a Gaussian's weights, from its middle outwards to 4 standard deviations; the whole sums to 1.
fn half_kernel(sigma: f64) -> Vec<f32> {
    let reach = (4.0 * sigma).ceil() as usize;
    let weights: Vec<f64> = (0..=reach).map(|i| (-0.5 * (i as f64 / sigma).powi(2)).exp()).collect();
    let sum = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
    weights.iter().map(|w| (w / sum) as f32).collect()
}

/// Index `i` of a line of `n`, mirrored at both ends.
fn mirrored(i: isize, n: usize) -> usize {
    let period = 2 * n as isize;
    let i = i.rem_euclid(period);
    (if i >= n as isize { period - 1 - i } else { i }) as usize
}

impl Grey {
    /// Convolution with a Gaussian of standard deviation `sigma` px; the picture is mirrored at its border.
    pub fn smoothed(&self, sigma: f64) -> Self {
        if sigma <= 0.0 {
            return self.clone();
        }
        let kernel = half_kernel(sigma);
        let (w, h) = (self.width, self.height);
        let reach = kernel.len() - 1;
        let mut across = vec![0.0_f32; w * h];
        let mut line = vec![0.0_f32; w + 2 * reach];
        for (row, out) in self.samples.chunks_exact(w).zip(across.chunks_exact_mut(w)) {
            for (i, v) in line.iter_mut().enumerate() {
                *v = row[mirrored(i as isize - reach as isize, w)];
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

    /// Standard deviation of the noise, grey levels: the median over the picture's part that is not flat of Immerkaer's
    /// difference mask (J. Immerkaer, Fast noise variance estimation, 1996), which edges and slopes hardly change.
    pub fn noise(&self) -> f64 {
        let (w, h) = (self.width, self.height);
        let mut sizes = Vec::with_capacity(w * h / 4);
        for y in (1..h.saturating_sub(1)).step_by(2) {
            for x in (1..w.saturating_sub(1)).step_by(2) {
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
        // Peak of a two-dimensional Gaussian: 1 / (2 pi sigma^2).
        assert!((s.samples[20 * 41 + 20] - 0.0398).abs() < 2e-4);
        assert_eq!(s.samples[18 * 41 + 20], s.samples[22 * 41 + 20]);
        assert!((s.samples[20 * 41 + 18] - s.samples[18 * 41 + 20]).abs() < 1e-7);
    }

    #[test]
    fn a_picture_narrower_than_the_kernel_is_smoothed_too() {
        let tiny = Grey { width: 2, height: 1, samples: vec![0.0, 1.0] };
        assert!((tiny.smoothed(5.0).samples[0] - 0.5).abs() < 0.02);
    }
}
