//! The noise of a picture, as a whole and by grey level: the median of Immerkaer's difference mask (J. Immerkaer, Fast noise
//! variance estimation, 1996), which edges and slopes hardly change.
//!
//! X-rays are counted, so noise grows with the level, by a law that a camera's look-up table may have bent: it is measured in
//! 16 classes of level. **Not guaranteed:** noise that neighbouring pixels share, which the mask does not see.

use biplane_artifact::Frame;
use pulp::Arch;

use crate::{Grey, scaled_rows};

/// Classes of level.
const CLASSES: usize = 16;
/// A class with fewer places takes the noise of the whole.
const FEWEST: usize = 200;
/// One place in so many rows and columns is looked at.
const STEP: usize = 4;

/// Standard deviation of single pixels, grey levels of 0..255.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    overall: f64,
    by_level: [f64; CLASSES],
}

impl Noise {
    /// Of the whole picture.
    pub fn overall(&self) -> f64 {
        self.overall
    }

    /// Where the picture has this level.
    pub fn at(&self, level: f64) -> f64 {
        let place = level / 255.0 * CLASSES as f64 - 0.5;
        let first = place.floor().clamp(0.0, (CLASSES - 2) as f64);
        let part = (place - first).clamp(0.0, 1.0);
        let k = first as usize;
        self.by_level[k] * (1.0 - part) + self.by_level[k + 1] * part
    }
}

/// The standard deviation that the mask's sizes show; 0 where there are none.
fn deviation(sizes: &mut [f32]) -> f64 {
    if sizes.is_empty() {
        return 0.0;
    }
    let middle = sizes.len() / 2;
    let (_, median, _) = sizes.select_nth_unstable_by(middle, f32::total_cmp);
    // The mask's weights have a root sum of squares of 6; the median of |N(0, 1)| is 0.6745.
    f64::from(*median) / 6.0 / 0.6745
}

impl Noise {
    /// Of a frame. Places where the mask is exactly 0 (saturated, or outside the intensifier) do not count.
    pub fn of(frame: &Frame) -> Self {
        measure([frame.width, frame.height], scaled_rows(frame))
    }
}

impl Grey {
    /// Its noise. Places where the mask is exactly 0 (saturated, or outside the intensifier) do not count.
    pub fn noise(&self) -> Noise {
        let w = self.width;
        let row = |y: usize, out: &mut [f32]| out.copy_from_slice(&self.samples[y * w..(y + 1) * w]);
        measure([w, self.height], row)
    }
}

fn measure(size: [usize; 2], row: impl Fn(usize, &mut [f32])) -> Noise {
    Arch::new().dispatch(
        #[inline(always)]
        || measure_rows(size, row),
    )
}

#[inline(always)]
fn measure_rows([w, h]: [usize; 2], row: impl Fn(usize, &mut [f32])) -> Noise {
    let mut all = Vec::with_capacity(w * h / (STEP * STEP));
    let mut classes: [Vec<f32>; CLASSES] = Default::default();
    let mut rows = [vec![0.0; w], vec![0.0; w], vec![0.0; w]];
    for y in (1..h.saturating_sub(1)).step_by(STEP) {
        for (row_number, out) in (y - 1..).zip(&mut rows) {
            row(row_number, out);
        }
        let [above, here, below] = rows.each_ref().map(|r| &r[..w]);
        for x in (1..w.saturating_sub(1)).step_by(STEP) {
            let [above, here, below] = [above, here, below].map(|r| [r[x - 1], r[x], r[x + 1]]);
            let corners = above[0] + above[2] + below[0] + below[2];
            let sides = above[1] + here[0] + here[2] + below[1];
            let value = (corners - 2.0 * sides + 4.0 * here[1]).abs();
            if value > 0.0 {
                all.push(value);
                let level = (corners + sides + here[1]) / 9.0;
                classes[((level * (CLASSES as f32 / 255.0)) as usize).min(CLASSES - 1)].push(value);
            }
        }
    }
    let overall = deviation(&mut all);
    let by_level =
        classes.map(|mut class| if class.len() < FEWEST { overall } else { deviation(&mut class) });
    Noise { overall, by_level }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_found_as_a_whole_and_by_level() {
        // A ramp across with noise of 1 to 5 levels, by a generator that is as good as this needs.
        let (width, height) = (512, 256);
        let mut state = 1_u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / (1_u64 << 31) as f64 - 0.5
        };
        let samples = (0..width * height)
            .map(|k| {
                let level = (k % width) as f64 * 0.4 + 20.0;
                let sigma = 1.0 + 4.0 * level / 255.0;
                // The sum of 12 uniform numbers has variance 1.
                (level + sigma * (0..12).map(|_| uniform()).sum::<f64>()) as f32
            })
            .collect();
        let noise = Grey { width, height, samples }.noise();
        for level in [40.0, 120.0, 200.0] {
            let expected = 1.0 + 4.0 * level / 255.0;
            assert!((noise.at(level) / expected - 1.0).abs() < 0.1, "{level}: {}", noise.at(level));
        }
        assert!((2.5..3.5).contains(&noise.overall()));
        assert_eq!(Grey { width: 64, height: 64, samples: vec![9.0; 64 * 64] }.noise().overall(), 0.0);
    }
}
