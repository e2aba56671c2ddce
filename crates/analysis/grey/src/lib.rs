//! A grey picture in floating point: scaled to 0..255, smoothed by Gaussians, halved, and the noise in it.
//!
//! Coordinates are pixels with the centre of the first one at (0, 0). Loops over pixels run with the widest vectors that the
//! processor has (AVX2 where it is there); each pixel's sum is taken in the same order everywhere, so the bytes do not depend
//! on it.
//!
//! **Guaranteed:** no smoothed value lies outside the range of the samples, but for rounding. **Not guaranteed:** weights beyond
//! 4 standard deviations, which are left out.

mod noise;
mod smooth;

use biplane_artifact::Frame;

pub use noise::Noise;
pub use pulp::Arch as Processor;

/// Grey levels row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Grey {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `width * height` levels; `samples[y * width + x]`.
    pub samples: Vec<f32>,
}

impl Grey {
    /// The samples of a frame, 0..255 whatever its bits. The frame holds `width * height` samples.
    pub fn of(frame: &Frame) -> Self {
        let scale = scale(frame);
        let samples = frame.samples.iter().map(|&s| f32::from(s) * scale).collect();
        Self { width: frame.width, height: frame.height, samples }
    }

    /// Every second sample of every second row, from the first one: pixel `(x, y)` is `(2 x, 2 y)` of this one.
    pub fn halved(&self) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let rows = self.samples.chunks_exact(self.width).step_by(2);
        let samples = rows.flat_map(|row| row.iter().step_by(2).copied()).collect();
        Self { width, height, samples }
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

/// What brings a frame's samples to 0..255.
fn scale(frame: &Frame) -> f32 {
    let full = f64::from((1_u32 << frame.bits.clamp(1, 16)) - 1);
    (255.0 / full) as f32
}

/// Writes a row of a frame's samples, scaled to 0..255.
fn scaled_rows(frame: &Frame) -> impl Fn(usize, &mut [f32]) {
    let scale = scale(frame);
    #[inline(always)]
    move |y, out| {
        let row = &frame.samples[y * frame.width..(y + 1) * frame.width];
        for (o, s) in out.iter_mut().zip(row) {
            *o = f32::from(*s) * scale;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_pixels_values_are_linear() {
        let ramp = Grey { width: 3, height: 2, samples: vec![0.0, 1.0, 2.0, 10.0, 11.0, 12.0] };
        assert!((ramp.at(1.25, 0.5) - 6.25).abs() < 1e-12);
        assert_eq!(ramp.at(-5.0, 9.0), 10.0);
    }

    #[test]
    fn a_narrow_picture_is_halved() {
        let tiny = Grey { width: 2, height: 1, samples: vec![0.0, 1.0] };
        assert_eq!(tiny.halved(), Grey { width: 1, height: 1, samples: vec![0.0] });
    }

    #[test]
    fn levels_are_scaled_to_255_whatever_the_bits() {
        let frame = Frame { width: 2, height: 1, samples: vec![0, 4095], bits: 12 };
        assert_eq!(Grey::of(&frame).samples, [0.0, 255.0]);
    }
}
