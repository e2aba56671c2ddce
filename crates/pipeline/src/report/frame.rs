//! The stage `report_frame`: one frame of the report, with its pictures and, as vectors, the outlines of the posed bodies and the edge curves.
//!
//! A page opened from disk may load scripts but no data, so a frame is a script with one call. Pictures are JPEG in it, as text, because
//! WebGL takes no picture of a file; each is in it once, and what is drawn over it is numbers that the page draws. All is in **recorded**
//! pixels, through the distortion of a picture that is not corrected.
//!
//! A residual is how far outside the outline the edge lies that its normal crosses, in ideal px, with the view's inset put back:
//! `r = crossing + inset`. The matcher also predicts an inset for each rim from the body's chords; that part is left in `r`.

use std::sync::Arc;

use biplane_artifact::{Calibration, Curves, Frame, Match, ModelMesh, ReportFrame};
use biplane_edge_field::EdgeField;
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::Point2;
use biplane_outline::{Outline, RimMesh, RimWithoutCutEnds, Sampling};
use biplane_stage::{Context, Stage, inputs};
use image::codecs::jpeg::JpegEncoder;
use image::{ExtendedColorType, ImageEncoder};
use serde::{Deserialize, Serialize};

use crate::drawings::base64;

inputs! {
    /// The pictures of a frame and the bodies matched in them.
    pub struct ReportFrameInputs {
        /// Pictures that can be read.
        frames: [Frame],
        /// Of each picture.
        calibrations: [Calibration],
        /// What each body was matched to: body by body, one a picture.
        curves: [Curves],
        /// The bodies.
        models: [ModelMesh],
        /// Their matches, in the same order.
        matches: [Match],
    }
}

/// What of a frame is shown.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct ReportFrameParams {
    /// Place in the trial of each picture's view.
    pub slots: Vec<usize>,
    /// The bodies that have a match.
    pub bodies: Vec<ShownBody>,
}

/// A body that is shown.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
pub struct ShownBody {
    /// Its place among the trial's bodies.
    pub place: usize,
    /// Its cut ends are no outline.
    pub without_cut_ends: bool,
    /// It is brighter than what is beside it.
    pub bright: bool,
}

/// Samples of an outline are about so far apart, px.
const STEP_PX: f64 = 2.0;
/// How far from the outline an edge is looked for, px, and how far it may be turned against it, as a cosine.
const REACH_PX: f64 = 12.0;
const MIN_COSINE: f64 = 0.75;
/// Places are stored as whole numbers: `(px + OFFSET_PX) * PARTS`.
const OFFSET_PX: f64 = 1024.0;
const PARTS: f64 = 8.0;
/// Residuals are stored in so many parts of a px; the least whole number says that no edge was found.
const RESIDUAL_PARTS: f64 = 100.0;
/// Pictures with more columns or rows than this are halved.
const MOST_PX: usize = 1536;
/// Of JPEG, of 100.
const QUALITY: u8 = 82;
/// Share of the pixels that may be brighter than white.
const CUT: f64 = 0.002;

/// Why there is no page of a frame.
#[derive(Debug, thiserror::Error)]
pub enum ReportFrameError {
    /// What belongs together has not the same length.
    #[error(
        "{frames} pictures, {calibrations} calibrations, {models} models, {matches} matches and {curves} sets of curves do not belong together"
    )]
    Numbers {
        /// Pictures.
        frames: usize,
        /// Calibrations.
        calibrations: usize,
        /// Models.
        models: usize,
        /// Matches.
        matches: usize,
        /// Sets of curves.
        curves: usize,
    },
    /// The picture cannot be written.
    #[error("the picture could not be written as JPEG: {0}")]
    Jpeg(#[from] image::ImageError),
    /// The numbers cannot be written.
    #[error("the frame could not be written: {0}")]
    Json(#[from] serde_json::Error),
}

#[derive(Serialize)]
struct Page {
    views: Vec<View>,
}

#[derive(Serialize)]
struct View {
    slot: usize,
    /// Columns and rows of the recorded picture.
    size: [usize; 2],
    picture: String,
    /// Recorded pixels of a curve after those of another.
    edges: Edges,
    outlines: Vec<Drawn>,
}

#[derive(Serialize)]
struct Edges {
    /// Points of each curve; negative for a closed one.
    counts: Vec<i32>,
    /// `u16`, x and y.
    points: String,
    /// Which bodies (by their place) each curve was for; empty where all.
    bodies: Vec<Vec<usize>>,
}

#[derive(Serialize)]
struct Drawn {
    place: usize,
    inset_px: f64,
    /// `u16`, x, y, direction of the normal (65536 parts of a turn), length of outline that a sample stands for (parts of a px).
    samples: String,
    /// `i16`.
    residuals: String,
}

/// The stage `report_frame`.
#[derive(Debug, Clone, Copy)]
pub struct DrawReportFrame;

impl Stage for DrawReportFrame {
    const NAME: &'static str = "report_frame";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = ReportFrameInputs;
    type Params = ReportFrameParams;
    type Output = ReportFrame;
    type Error = ReportFrameError;

    fn run(
        inputs: &ReportFrameInputs,
        params: &ReportFrameParams,
        context: &Context,
    ) -> Result<ReportFrame, ReportFrameError> {
        let ReportFrameInputs { frames, calibrations, curves, models, matches } = inputs;
        let bodies = params.bodies.len();
        if frames.len() != calibrations.len()
            || frames.len() != params.slots.len()
            || models.len() != bodies
            || matches.len() != bodies
            || curves.len() != bodies * frames.len()
        {
            return Err(ReportFrameError::Numbers {
                frames: frames.len(),
                calibrations: calibrations.len(),
                models: models.len(),
                matches: matches.len(),
                curves: curves.len(),
            });
        }
        let mut views = Vec::new();
        let mut outline = Outline::new();
        for (number, (frame, calibration)) in frames.iter().zip(calibrations).enumerate() {
            let view = Fluoroscope::from(&**calibration);
            let mut outlines = Vec::new();
            let mut sets: Vec<(biplane_artifact::ContentHash, &Curves, Vec<usize>)> = Vec::new();
            for (at, shown) in params.bodies.iter().enumerate() {
                let (model, found) = (&models[at], &matches[at]);
                let own = &curves[at * frames.len() + number];
                match sets.iter_mut().find(|(hash, ..)| *hash == own.hash()) {
                    Some((.., places)) => places.push(shown.place),
                    None => sets.push((own.hash(), &**own, vec![shown.place])),
                }
                let mesh = if shown.without_cut_ends {
                    Arc::clone(&context.prepared(model.hash(), || RimWithoutCutEnds::new(&model.0)).0)
                } else {
                    context.prepared(model.hash(), || RimMesh::new(&model.0))
                };
                outline.trace(&mesh, &found.pose.into(), &view, Sampling { step_px: STEP_PX });
                let field = EdgeField::new(own, view.distortion());
                let inset = found.views.get(params.slots[number]).map_or(0.0, |v| v.inset_px);
                outlines.push(drawn(shown, &outline, &field, &view, inset));
            }
            views.push(View {
                slot: params.slots[number],
                size: [frame.width, frame.height],
                picture: format!("data:image/jpeg;base64,{}", base64::encode(&jpeg(frame)?)),
                edges: edges(&sets, bodies),
                outlines,
            });
        }
        Ok(ReportFrame::of_json(&serde_json::to_string(&Page { views })?))
    }
}

/// A place in pixels as a whole number.
fn whole(px: f64) -> u16 {
    ((px + OFFSET_PX) * PARTS).round().clamp(0.0, 65535.0) as u16
}

fn drawn(
    shown: &ShownBody,
    outline: &Outline,
    field: &EdgeField,
    view: &Fluoroscope,
    inset_px: f64,
) -> Drawn {
    let bright = if shown.bright { -1.0 } else { 1.0 };
    let (mut samples, mut residuals) = (Vec::new(), Vec::new());
    for p in outline.points() {
        let recorded = |p: &Point2| view.distortion().map_or(Some(*p), |d| d.recorded(p));
        let (Some(at), Some(outward)) = (recorded(&p.pixel), recorded(&(p.pixel + p.normal))) else {
            continue;
        };
        let normal = outward - at;
        let turn = normal.y.atan2(normal.x) / std::f64::consts::TAU;
        let direction = ((turn.rem_euclid(1.0) * 65536.0).round() as u32 & 0xffff) as u16;
        let length = (p.length_px * PARTS).round().clamp(1.0, 65535.0) as u16;
        for v in [whole(at.x), whole(at.y), direction, length] {
            samples.extend(v.to_le_bytes());
        }
        let inside = view.on_image(&p.pixel, 0.0);
        let edge = field.crossing(
            &(p.pixel - p.normal * inset_px),
            &p.normal,
            &(p.normal * bright),
            REACH_PX,
            MIN_COSINE,
        );
        let residual = edge.filter(|_| inside).map_or(i16::MIN, |r| (r * RESIDUAL_PARTS).round() as i16);
        residuals.extend(residual.to_le_bytes());
    }
    Drawn {
        place: shown.place,
        inset_px: (inset_px * 1000.0).round() / 1000.0,
        samples: base64::encode(&samples),
        residuals: base64::encode(&residuals),
    }
}

/// Every second point of each curve, and its last; about two pixels apart is as finely as anyone sees them.
fn edges(sets: &[(biplane_artifact::ContentHash, &Curves, Vec<usize>)], bodies: usize) -> Edges {
    let (mut counts, mut points, mut of) = (Vec::new(), Vec::new(), Vec::new());
    for (_, curves, places) in sets {
        for curve in &curves.0 {
            let last = curve.points.len().saturating_sub(1);
            let kept = curve.points.iter().enumerate().filter(|(k, _)| k % 2 == 0 || *k == last);
            let mut count = 0;
            for (_, p) in kept {
                points
                    .extend([whole(p.position.x), whole(p.position.y)].iter().flat_map(|v| v.to_le_bytes()));
                count += 1;
            }
            counts.push(if curve.closed { -count } else { count });
            if places.len() < bodies {
                of.push(places.clone());
            }
        }
    }
    Edges { counts, points: base64::encode(&points), bodies: of }
}

/// The picture with eight bits; of more bits the brightest levels are used, in whole steps of two, so that neighbouring frames look alike.
fn jpeg(frame: &Frame) -> Result<Vec<u8>, image::ImageError> {
    let Frame { width, height, ref samples, bits } = *frame;
    let mut sorted = samples.clone();
    let brightest = ((sorted.len() as f64 * (1.0 - CUT)) as usize).min(sorted.len().saturating_sub(1));
    let white = if sorted.is_empty() { 0 } else { *sorted.select_nth_unstable(brightest).1 };
    let mut most = (1_u32 << bits.clamp(1, 16)) - 1;
    while bits > 8 && most > 255 && u32::from(white) * 2 < most {
        most /= 2;
    }
    let step = width.max(height).div_ceil(MOST_PX).max(1);
    let small = [width / step, height / step];
    let mut levels = Vec::with_capacity(small[0] * small[1]);
    for y in 0..small[1] {
        for x in 0..small[0] {
            let block =
                (0..step).flat_map(|dy| (0..step).map(move |dx| (y * step + dy) * width + x * step + dx));
            let sum: f64 = block.filter_map(|k| samples.get(k)).map(|s| f64::from(*s)).sum();
            levels
                .push((sum / (step * step) as f64 / f64::from(most) * 255.0).round().clamp(0.0, 255.0) as u8);
        }
    }
    let mut bytes = Vec::new();
    JpegEncoder::new_with_quality(&mut bytes, QUALITY).write_image(
        &levels,
        small[0] as u32,
        small[1] as u32,
        ExtendedColorType::L8,
    )?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(bits: u32, white: u16, size: usize) -> Frame {
        let samples = (0..size * size).map(|k| if k % size < size / 2 { white } else { 0 }).collect();
        Frame { width: size, height: size, samples, bits }
    }

    #[test]
    fn twelve_bits_in_sixteen_are_no_black_picture_and_large_ones_are_halved() {
        let read = |frame: &Frame| image::load_from_memory(&jpeg(frame).unwrap()).unwrap().to_luma8();
        let dark = read(&frame(16, 4095, 64));
        assert!(dark.get_pixel(8, 8).0[0] > 250, "{:?}", dark.get_pixel(8, 8));
        assert!(dark.get_pixel(56, 8).0[0] < 5);
        // Eight bits stay as they are: a dark picture is one.
        assert!(read(&frame(8, 60, 64)).get_pixel(8, 8).0[0].abs_diff(60) < 4);
        let large = read(&frame(8, 255, 2 * MOST_PX));
        assert_eq!(large.dimensions(), (MOST_PX as u32, MOST_PX as u32));
    }

    #[test]
    fn a_place_is_stored_to_a_sixteenth_of_a_pixel() {
        for px in [-1000.03, -0.5, 0.0, 511.97, 6000.4] {
            let back = f64::from(whole(px)) / PARTS - OFFSET_PX;
            assert!((back - px).abs() <= 0.5 / PARTS + 1e-9, "{px} {back}");
        }
        assert_eq!([whole(-1e9), whole(f64::NAN), whole(1e300)], [0, 0, 65535]);
    }
}
