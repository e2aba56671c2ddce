//! How the noise of neighbouring pixels goes together.
//!
//! An intensifier blurs its quantum noise with its picture, so the noise of neighbours is nearly the same and averages out less than
//! independent noise would. The correlation is measured on the even light
//! around spots. **Not guaranteed:** noise that goes together over more than [`REACH`] px.

use crate::window::Window;

/// Farthest lag, px.
const REACH: usize = 4;

/// Correlation of the noise by lag. Lags and their opposites are one.
#[derive(Debug, Clone)]
pub(crate) struct Correlation {
    /// Columns, rows and correlation of each lag but 0.
    lags: Vec<(isize, usize, f64)>,
}

/// Lags of half a plane, without 0.
fn half_plane() -> impl Iterator<Item = (isize, usize)> {
    let reach = REACH as isize;
    (0..=REACH)
        .flat_map(move |dy| (-reach..=reach).map(move |dx| (dx, dy)))
        .filter(|&(dx, dy)| dy > 0 || dx > 0)
}

/// Values of a window's pixels in rows that are apart by more than the farthest lag; 0 elsewhere.
fn raster(window: &Window, values: impl Iterator<Item = f64>) -> (Vec<f64>, usize) {
    let stride = window.stride + REACH;
    let rows = window.size.div_ceil(window.stride.max(1)) + REACH + 1;
    let mut raster = vec![0.0; rows * stride];
    for (place, value) in window.places.iter().zip(values) {
        raster[place / window.stride * stride + place % window.stride] = value;
    }
    (raster, stride)
}

/// Sum of the products of all values with those a lag away.
fn product(raster: &[f64], stride: usize, (dx, dy): (isize, usize)) -> f64 {
    let shift = (dy * stride) as isize + dx;
    let shifted = &raster[shift.unsigned_abs()..];
    raster.iter().zip(shifted).map(|(a, b)| a * b).sum()
}

impl Correlation {
    /// Measured on windows whose pixels hold noise alone (`residual` gives it for each).
    pub fn measured<'a>(windows: impl Iterator<Item = (&'a Window, &'a [f64])>) -> Self {
        let mut sums = vec![[0.0; 2]; half_plane().count()];
        let mut own = [0.0; 2];
        for (window, residuals) in windows {
            let (noise, stride) = raster(window, residuals.iter().copied());
            let (mask, _) = raster(window, residuals.iter().map(|_| 1.0));
            own[0] += product(&noise, stride, (0, 0));
            own[1] += product(&mask, stride, (0, 0));
            for (sum, lag) in sums.iter_mut().zip(half_plane()) {
                sum[0] += product(&noise, stride, lag);
                sum[1] += product(&mask, stride, lag);
            }
        }
        let variance = own[0] / own[1].max(1.0);
        let correlation = |[sum, count]: [f64; 2]| {
            if variance > 0.0 && count > 0.0 { (sum / count / variance).clamp(-1.0, 1.0) } else { 0.0 }
        };
        let lags = half_plane().zip(sums).map(|((dx, dy), sum)| (dx, dy, correlation(sum))).collect();
        Self { lags }
    }

    /// Variance of a sum of a window's noise with weights, in variances of the noise.
    pub fn variance(&self, window: &Window, weights: impl Iterator<Item = f64>) -> f64 {
        let (raster, stride) = raster(window, weights);
        let alone = product(&raster, stride, (0, 0));
        let together = self.lags.iter().map(|&(dx, dy, c)| 2.0 * c * product(&raster, stride, (dx, dy)));
        // Sampled correlations need not be those of any noise; never less than a tenth of independent noise.
        (alone + together.sum::<f64>()).max(0.1 * alone)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::Pixel;
    use rand::{Rng, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn the_variance_of_a_mean_of_blurred_noise_is_told() {
        let (w, h) = (60, 60);
        let pixel = Pixel { x: 0.0, y: 0.0, value: 0.0, ground: 1.0 };
        let window =
            Window { pixels: vec![pixel; w * h], places: (0..w * h).collect(), stride: w, size: w * h };
        let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
        // Noise that is the mean of 2 x 2 independent numbers.
        let fine: Vec<f64> = (0..(w + 1) * (h + 1)).map(|_| random.random::<f64>() - 0.5).collect();
        let at = |x: usize, y: usize| fine[y * (w + 1) + x];
        let noise: Vec<f64> = (0..w * h)
            .map(|i| (i % w, i / w))
            .map(|(x, y)| (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1)) / 4.0)
            .collect();
        let correlation = Correlation::measured([(&window, &noise[..])].into_iter());
        // A mean over many pixels has four times the variance of independent noise, but for the window's edge.
        let inside =
            |i: usize| f64::from(u8::from((20..40).contains(&(i % w)) && (20..40).contains(&(i / w))));
        let variance = correlation.variance(&window, (0..w * h).map(inside)) / 400.0;
        assert!((variance - 3.8).abs() < 0.5, "{variance}");
    }
}
