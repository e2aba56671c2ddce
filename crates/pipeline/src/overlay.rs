//! The stage `overlay`: a frame with the outlines of its posed bodies drawn on it, for people to judge a match by.
//!
//! Outlines are drawn where the picture shows them: through the distortion of a picture that is not corrected. Each body
//! has a colour by its place ([`COLOURS`]); a body whose match failed is drawn in gaps.

use std::sync::Arc;

use biplane_artifact::{Calibration, Frame, Match, ModelMesh, Picture, Verdict};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::Point2;
use biplane_outline::{Outline, RimMesh, RimWithoutCutEnds, Sampling};
use biplane_stage::{Context, Stage, inputs};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use serde::{Deserialize, Serialize};

inputs! {
    /// One picture and the bodies matched in it.
    pub struct OverlayInputs {
        /// The picture.
        frame: Frame,
        /// Its view.
        calibration: Calibration,
        /// The bodies.
        models: [ModelMesh],
        /// Their matches, in the same order.
        matches: [Match],
    }
}

/// What of the bodies is drawn.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct OverlayParams {
    /// Places of the bodies whose cut ends are no outline.
    pub without_cut_ends: Vec<usize>,
}

/// Colours of the bodies by their place (red, green, blue), over again for more; told apart by colour-blind people too.
pub const COLOURS: [[u8; 3]; 5] =
    [[86, 200, 255], [255, 176, 0], [255, 110, 180], [60, 220, 130], [190, 150, 255]];
/// Half the width of a line, px.
const HALF_WIDTH: f64 = 0.9;
/// How much of the picture a line hides, 0 to 1.
const OPACITY: f64 = 0.9;
/// Length of the strokes and gaps of a failed match, px.
const DASH_PX: f64 = 9.0;

/// Why there is no overlay.
#[derive(Debug, thiserror::Error)]
pub enum OverlayError {
    /// Models and matches are not one a body.
    #[error("{models} models but {matches} matches: expected one of each a body")]
    Bodies {
        /// Models.
        models: usize,
        /// Matches.
        matches: usize,
    },
    /// The picture cannot be written.
    #[error("the overlay could not be written as PNG: {0}")]
    Png(#[from] image::ImageError),
}

/// The stage `overlay`.
#[derive(Debug, Clone, Copy)]
pub struct Overlay;

impl Stage for Overlay {
    const NAME: &'static str = "overlay";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = OverlayInputs;
    type Params = OverlayParams;
    type Output = Picture;
    type Error = OverlayError;

    fn run(
        inputs: &OverlayInputs,
        params: &OverlayParams,
        context: &Context,
    ) -> Result<Picture, OverlayError> {
        let (models, matches) = (inputs.models.len(), inputs.matches.len());
        if models != matches {
            return Err(OverlayError::Bodies { models, matches });
        }
        let frame = &inputs.frame;
        let most = f64::from((1_u32 << frame.bits.clamp(1, 16)) - 1);
        let mut pixels: Vec<[f64; 3]> =
            frame.samples.iter().map(|s| [f64::from(*s) / most * 255.0; 3]).collect();
        let view = Fluoroscope::from(&*inputs.calibration);
        let mut outline = Outline::new();
        for (place, (model, found)) in inputs.models.iter().zip(&inputs.matches).enumerate() {
            let mesh = if params.without_cut_ends.contains(&place) {
                Arc::clone(&context.prepared(model.hash(), || RimWithoutCutEnds::new(&model.0)).0)
            } else {
                context.prepared(model.hash(), || RimMesh::new(&model.0))
            };
            outline.trace(&mesh, &found.pose.into(), &view, Sampling { step_px: 0.5 });
            let recorded = |p: &Point2| view.distortion().map_or(Some(*p), |d| d.recorded(p));
            let drawn = |p: &Point2| {
                found.verdict != Verdict::Failed || ((p.x + p.y) / DASH_PX).rem_euclid(2.0) < 1.0
            };
            let points = outline.points().iter().filter_map(|p| recorded(&p.pixel)).filter(|p| drawn(p));
            let cover = cover(points, frame.width, frame.height);
            let colour = COLOURS[place % COLOURS.len()];
            for (pixel, cover) in pixels.iter_mut().zip(cover) {
                let alpha = OPACITY * f64::from(cover);
                for (level, c) in pixel.iter_mut().zip(colour) {
                    *level += alpha * (f64::from(c) - *level);
                }
            }
        }
        let bytes: Vec<u8> = pixels.iter().flatten().map(|v| coarse(*v)).collect();
        let mut png = Vec::new();
        let (compression, filter) = (CompressionType::Default, FilterType::Adaptive);
        PngEncoder::new_with_quality(&mut png, compression, filter).write_image(
            &bytes,
            frame.width as u32,
            frame.height as u32,
            ExtendedColorType::Rgb8,
        )?;
        Ok(Picture(png))
    }
}

/// A level in steps of 4 of 255: nobody sees them, and without the last bits of noise the file is a third as large.
fn coarse(level: f64) -> u8 {
    (level.clamp(0.0, 255.0) as u8 & !3) | 2
}

/// How far each pixel is covered by discs about the points, 0 to 1, with a soft edge of a pixel.
fn cover(points: impl Iterator<Item = Point2>, width: usize, height: usize) -> Vec<f32> {
    let mut cover = vec![0.0_f32; width * height];
    let reach = HALF_WIDTH + 0.5;
    for p in points {
        let range = |centre: f64, size: usize| {
            // Casting from a float saturates, so a point far outside gives an empty range.
            ((centre - reach).ceil().max(0.0) as usize)
                ..((centre + reach).floor() + 1.0).clamp(0.0, size as f64) as usize
        };
        for y in range(p.y, height) {
            for x in range(p.x, width) {
                let distance = (Point2::new(x as f64, y as f64) - p).norm();
                let value = (reach - distance).clamp(0.0, 1.0) as f32;
                let pixel = &mut cover[y * width + x];
                *pixel = pixel.max(value);
            }
        }
    }
    cover
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_covers_its_pixel_and_none_outside_the_picture() {
        let points = [(2.0, 1.0), (-50.0, 1.0), (1e300, 1.0), (2.0, -0.9)].map(|(x, y)| Point2::new(x, y));
        let cover = cover(points.into_iter(), 5, 4);
        assert_eq!(cover[5 + 2], 1.0);
        assert!(cover[2] > 0.0 && cover[2] < 1.0, "a soft edge");
        assert_eq!(cover[3 * 5], 0.0);
    }
}
