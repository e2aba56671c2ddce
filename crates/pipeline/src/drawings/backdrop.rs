//! A picture to draw on: stretched in contrast, made smaller and dimmed, so that marks stand out of it.

use biplane_artifact::Frame;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use super::svg::Svg;
use super::{DrawingError, base64};

/// At most so many columns and rows are kept.
const MOST: usize = 1024;
/// Share of the pixels that may be darker than black, and brighter than white: less than a few beads cover.
const CUT: f64 = 0.001;
/// The level of white: bright marks must stand out of it.
const WHITE: f64 = 190.0;

/// A picture as PNG, in base64, and how large it is.
#[derive(Debug)]
pub(super) struct Backdrop {
    base64: String,
    /// Columns and rows of the frame.
    size: [f64; 2],
    /// Columns and rows that the PNG stands for: the last ones may reach over the frame's edge.
    covered: [f64; 2],
}

impl Backdrop {
    /// # Errors
    /// The frame has no pixels or not as many as its size says, or cannot be written as PNG.
    pub(super) fn new(frame: &Frame) -> Result<Self, DrawingError> {
        let Frame { width, height, ref samples, .. } = *frame;
        if samples.is_empty() || width.checked_mul(height) != Some(samples.len()) {
            return Err(DrawingError::Frame { width, height, samples: samples.len() });
        }
        let step = width.max(height).div_ceil(MOST);
        let small = [width.div_ceil(step), height.div_ceil(step)];
        let (black, white) = range(samples);
        let mut levels = Vec::with_capacity(small[0] * small[1]);
        for top in (0..height).step_by(step) {
            let rows = top..(top + step).min(height);
            for left in (0..width).step_by(step) {
                let columns = left..(left + step).min(width);
                let number = (rows.len() * columns.len()) as f64;
                let sum: f64 = rows
                    .clone()
                    .flat_map(|y| &samples[y * width..][columns.clone()])
                    .map(|s| f64::from(*s))
                    .sum();
                let share = ((sum / number - black) / (white - black)).clamp(0.0, 1.0);
                // In steps of 4: nobody sees them, and without the last bits of noise the file is far smaller.
                levels.push((share * WHITE) as u8 & !3);
            }
        }
        let mut png = Vec::new();
        PngEncoder::new_with_quality(&mut png, CompressionType::Best, FilterType::Adaptive).write_image(
            &levels,
            small[0] as u32,
            small[1] as u32,
            ExtendedColorType::L8,
        )?;
        Ok(Self {
            base64: base64::encode(&png),
            size: [width as f64, height as f64],
            covered: small.map(|n| (n * step) as f64),
        })
    }

    /// Its size when it is drawn as large as fits into `most`, and how many units a pixel then has.
    pub(super) fn fitted(&self, most: [f64; 2]) -> ([f64; 2], f64) {
        fitted(self.size, most)
    }

    /// Draws it at `corner` with `size`; what is drawn on it is in recorded pixels (centre of the first one at (0, 0)).
    pub(super) fn draw(&self, svg: &mut Svg, corner: [f64; 2], size: [f64; 2], marks: impl FnOnce(&mut Svg)) {
        svg.window(corner, size, [-0.5, -0.5], self.size, |svg| {
            svg.png([-0.5, -0.5], self.covered, &self.base64);
            marks(svg);
        });
    }
}

/// A picture's size when it is drawn as large as fits into `most`, and how many units a pixel then has.
pub(super) fn fitted(size: [f64; 2], most: [f64; 2]) -> ([f64; 2], f64) {
    let scale = (most[0] / size[0].max(1.0)).min(most[1] / size[1].max(1.0));
    (size.map(|v| v * scale), scale)
}

/// The grey levels to show as black and white.
fn range(samples: &[u16]) -> (f64, f64) {
    let mut histogram = vec![0_usize; 1 << 16];
    samples.iter().for_each(|s| histogram[usize::from(*s)] += 1);
    let cut = (samples.len() as f64 * CUT) as usize;
    let beyond = |levels: &mut dyn Iterator<Item = usize>| {
        let mut seen = 0;
        for level in levels {
            seen += histogram[level];
            if seen > cut {
                return Some(level);
            }
        }
        None
    };
    let black = beyond(&mut (0..1 << 16)).unwrap_or(0);
    let white = beyond(&mut (0..1 << 16).rev()).unwrap_or(0);
    (black as f64, white.max(black + 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contrast_reaches_from_the_darkest_to_the_brightest_thousandth() {
        let mut samples = vec![500_u16; 10_000];
        samples[..11].fill(100);
        samples[20..31].fill(900);
        samples[40..50].fill(65_535);
        assert_eq!(range(&samples), (100.0, 900.0));
        assert_eq!(range(&[7]), (7.0, 8.0), "a picture of one level has a range all the same");
    }

    #[test]
    fn a_frame_that_is_not_as_large_as_it_says_is_refused() {
        for (width, height, samples) in [(0, 0, 0), (3, 2, 5), (usize::MAX, 2, 5)] {
            let frame = Frame { width, height, samples: vec![0; samples], bits: 8 };
            assert!(matches!(Backdrop::new(&frame), Err(DrawingError::Frame { .. })));
        }
    }

    #[test]
    fn a_large_frame_is_made_smaller_and_stays_in_place() {
        let frame = Frame { width: 2050, height: 3, samples: vec![9; 6150], bits: 12 };
        let backdrop = Backdrop::new(&frame).unwrap();
        assert_eq!(backdrop.covered, [2052.0, 3.0], "684 columns of 3 px");
        let ([wide, _], scale) = backdrop.fitted([700.0, 700.0]);
        assert_eq!((wide, scale), (700.0, 700.0 / 2050.0));
    }
}
