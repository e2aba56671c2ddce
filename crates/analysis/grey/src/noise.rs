//! The noise of a picture, as a whole and by grey level: the median of Immerkaer's difference mask (J. Immerkaer, Fast noise
//! variance estimation, 1996), which slopes do not change and edges little.
//!
//! X-rays are counted, so noise grows with the level, by a law that a camera's look-up table may have bent: it is measured in
//! 16 classes of level. In a picture that was smoothed the mask is as wide as the smoothing, and so sees what noise neighbouring
//! pixels share at that width ([`Grey::noise_before_smoothing`]); [`Grey::noise`] sees that of single pixels alone.

use pulp::Arch;

use crate::Grey;
use crate::smooth::half_kernel;

/// Classes of level.
const CLASSES: usize = 16;
/// A class with fewer places takes the noise of the whole.
const FEWEST: usize = 200;
/// One place in so many rows and columns is looked at.
const STEP: usize = 4;

/// Standard deviation of single pixels, grey levels of 0..255.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    by_level: [f64; CLASSES],
}

impl Noise {
    /// Where the picture has this level.
    pub fn at(&self, level: f64) -> f64 {
        let place = level / 255.0 * CLASSES as f64 - 0.5;
        let first = place.floor().clamp(0.0, (CLASSES - 2) as f64);
        let part = (place - first).clamp(0.0, 1.0);
        let k = first as usize;
        self.by_level[k] * (1.0 - part) + self.by_level[k + 1] * part
    }
}

/// What the mask shows at one place.
#[derive(Clone, Copy)]
struct Place {
    /// Square of the slope.
    slope: f32,
    /// Size of the mask's value.
    size: f32,
}

/// The standard deviation that sizes of the mask show; 0 where there are none. Of noise of deviation 1 the mask has deviation
/// `scale`: 6, the root sum of squares of its weights, where pixels are independent.
fn deviation(sizes: &mut [f32], scale: f64) -> f64 {
    if sizes.is_empty() {
        return 0.0;
    }
    let middle = sizes.len() / 2;
    let (_, median, _) = sizes.select_nth_unstable_by(middle, f32::total_cmp);
    // The median of |N(0, 1)| is 0.6745.
    f64::from(*median) / scale / 0.6745
}

/// The same in the half of the places with the smallest slopes: that leaves edges out, and chooses nothing of noise, whose slopes
/// and second differences are independent.
fn deviation_where_even(places: &mut [Place], scale: f64) -> f64 {
    let half = places.len().div_ceil(2);
    if half > 0 {
        places.select_nth_unstable_by(half - 1, |a, b| a.slope.total_cmp(&b.slope));
    }
    let mut sizes: Vec<f32> = places[..half].iter().map(|p| p.size).collect();
    deviation(&mut sizes, scale)
}

impl Grey {
    /// Standard deviation of the noise of single pixels, all levels together: from the median of the mask where it is not exactly 0
    /// (saturated, or outside the intensifier).
    pub fn noise(&self) -> f64 {
        let mut sizes = Vec::with_capacity(self.samples.len() / (STEP * STEP));
        self.each_place(1, |_, place| sizes.push(place.size));
        deviation(&mut sizes, 6.0)
    }

    /// The white noise that would leave in this picture, smoothed with `smoothing_px`, what noise is left: for noise that neighbouring
    /// pixels share it is larger than that of single pixels. Places where the mask is 0 do not count.
    ///
    /// The mask's pixels are two standard deviations apart; how much of white noise it sees follows from the weights of the smoothing.
    pub fn noise_before_smoothing(&self, smoothing_px: f64) -> Noise {
        let half = if smoothing_px > 0.0 { half_kernel(smoothing_px) } else { vec![1.0] };
        let weight = |i: isize| half.get(i.unsigned_abs()).map_or(0.0, |w| f64::from(*w));
        let reach = half.len() as isize;
        // Covariance of smoothed white noise along one axis.
        let shared = |lag: isize| (-reach..=reach).map(|i| weight(i) * weight(i + lag)).sum::<f64>();
        let apart = (2.0 * smoothing_px).round().max(1.0) as isize;
        let along = 6.0 * shared(0) - 8.0 * shared(apart) + 2.0 * shared(2 * apart);
        let mut classes: [Vec<Place>; CLASSES] = Default::default();
        Arch::new().dispatch(
            #[inline(always)]
            || {
                self.each_place(apart.unsigned_abs(), |level, place| {
                    classes[((level * (CLASSES as f32 / 255.0)) as usize).min(CLASSES - 1)].push(place);
                });
            },
        );
        // The whole is the mean of its classes: choosing small slopes among all levels would choose those with little noise.
        let found = classes.each_mut().map(|class| {
            let enough = class.len() >= FEWEST;
            enough.then(|| (class.len() as f64, deviation_where_even(class, along)))
        });
        let count: f64 = found.iter().flatten().map(|(n, _)| n).sum();
        let overall = if count > 0.0 {
            found.iter().flatten().map(|(n, deviation)| n * deviation / count).sum()
        } else {
            deviation_where_even(&mut classes.concat(), along)
        };
        Noise { by_level: found.map(|class| class.map_or(overall, |(_, deviation)| deviation)) }
    }

    /// Gives the mean level and what the mask shows at places all over the picture, its pixels this far apart.
    #[inline(always)]
    fn each_place(&self, apart: usize, mut found: impl FnMut(f32, Place)) {
        let (w, h) = (self.width, self.height);
        for y in (apart..h.saturating_sub(apart)).step_by(STEP) {
            let row = |y: usize| &self.samples[y * w..(y + 1) * w];
            let (above, here, below) = (row(y - apart), row(y), row(y + apart));
            for x in (apart..w.saturating_sub(apart)).step_by(STEP) {
                let [above, here, below] = [above, here, below].map(|r| [r[x - apart], r[x], r[x + apart]]);
                let corners = above[0] + above[2] + below[0] + below[2];
                let sides = above[1] + here[0] + here[2] + below[1];
                let size = (corners - 2.0 * sides + 4.0 * here[1]).abs();
                // Rounding leaves traces of an even picture that was smoothed.
                if size > 1e-3 {
                    let across = here[2] - here[0] + (above[2] - above[0] + below[2] - below[0]) / 2.0;
                    let down = below[1] - above[1] + (below[0] - above[0] + below[2] - above[2]) / 2.0;
                    let slope = across * across + down * down;
                    found((corners + sides + here[1]) / 9.0, Place { slope, size });
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Noise of deviation 1, by a generator that is as good as this needs.
    fn noise(count: usize) -> Vec<f64> {
        let mut state = 1_u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / (1_u64 << 31) as f64 - 0.5
        };
        // The sum of 12 uniform numbers has variance 1.
        (0..count).map(|_| (0..12).map(|_| uniform()).sum()).collect()
    }

    /// A ramp across with noise of 1 to 5 levels.
    fn ramp() -> Grey {
        let (width, height) = (512, 2048);
        let noise = noise(width * height);
        let sample = |(k, n): (usize, &f64)| {
            let level = (k % width) as f64 * 0.4 + 20.0;
            (level + deviation_at(level) * n) as f32
        };
        Grey { width, height, samples: noise.iter().enumerate().map(sample).collect() }
    }

    fn deviation_at(level: f64) -> f64 {
        1.0 + 4.0 * level / 255.0
    }

    #[test]
    fn noise_is_found_as_a_whole_and_by_level_before_and_after_smoothing() {
        let ramp = ramp();
        let found = [
            ramp.noise_before_smoothing(0.0),
            ramp.smoothed(0.7).noise_before_smoothing(0.7),
            ramp.smoothed(1.0).noise_before_smoothing(1.0),
            ramp.smoothed(2.0).noise_before_smoothing(2.0),
        ];
        for (i, noise) in found.iter().enumerate() {
            for level in [40.0, 120.0, 200.0] {
                let ratio = noise.at(level) / deviation_at(level);
                assert!((ratio - 1.0).abs() < 0.1, "{i}, {level}: {ratio}");
            }
        }
        assert!((2.5..3.5).contains(&ramp.noise()));
        let even = Grey { width: 64, height: 64, samples: vec![9.0; 64 * 64] };
        assert_eq!(even.noise(), 0.0);
        assert_eq!(even.smoothed(1.0).noise_before_smoothing(1.0).at(9.0), 0.0);
    }

    #[test]
    fn noise_that_neighbours_share_is_seen_after_smoothing_alone() {
        // White noise of 20 levels, shared over 1 px by a blur: of wide smoothing it is still noise of 20 levels.
        let samples = noise(512 * 512).iter().map(|n| (100.0 + 20.0 * n) as f32).collect();
        let shared = Grey { width: 512, height: 512, samples }.smoothed(1.0);
        assert!(shared.noise() < 3.0, "{}", shared.noise());
        let found = shared.smoothed(3.0).noise_before_smoothing(3.0).at(100.0);
        // Both blurs together are one of sqrt(10) px.
        assert!((15.0..21.0).contains(&found), "{found}");
    }
}
