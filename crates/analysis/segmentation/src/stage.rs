//! The stage `segment`: one frame in, its curves out.

use biplane_artifact::{Curves, Frame};
use biplane_stage::{Context, Stage, inputs};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{find_edges, link};

inputs! {
    /// One frame.
    pub struct SegmentInputs {
        frame: Frame,
    }
}

/// How edges are found. Grey levels are those of the frame scaled to 0..255, whatever its bits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SegmentParams {
    /// Standard deviation of the Gaussian that smooths the frame first, px. Larger finds fewer false edges and rounds
    /// corners off. 0 to 20.
    #[schemars(range(min = 0.0, max = 20.0))]
    pub smoothing_px: f64,
    /// An edge begins where the smoothed gradient reaches this, grey levels per px.
    #[schemars(range(min = 0.0))]
    pub high_threshold: f64,
    /// and goes on while it stays above this, grey levels per px.
    #[schemars(range(min = 0.0))]
    pub low_threshold: f64,
    /// Curves with fewer points (about one a pixel) are left out.
    #[schemars(range(min = 1))]
    pub min_points: usize,
}

impl Default for SegmentParams {
    fn default() -> Self {
        Self { smoothing_px: 1.0, high_threshold: 2.5, low_threshold: 1.0, min_points: 10 }
    }
}

/// Why a frame has no curves.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SegmentError {
    /// A parameter out of range.
    #[error("[segment] {name} = {value}, expected {expected}")]
    Parameter {
        /// The key in pipeline.toml.
        name: &'static str,
        /// What it is.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// No edge passes the thresholds.
    #[error(
        "no edge in a frame of {width} x {height} pixels: its steepest places stay below high_threshold = {high} grey \
         levels per px; lower it in [segment], or look whether the picture is blank"
    )]
    NoEdge {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// The threshold.
        high: f64,
    },
}

impl SegmentParams {
    /// # Errors
    /// Names the first parameter that is out of its range.
    pub fn check(&self) -> Result<(), SegmentError> {
        let Self { smoothing_px, high_threshold, low_threshold, min_points: _ } = *self;
        let bad = |name, value, expected| Err(SegmentError::Parameter { name, value, expected });
        if !(0.0..=20.0).contains(&smoothing_px) {
            return bad("smoothing_px", smoothing_px, "0 to 20 px");
        }
        if !(low_threshold >= 0.0 && low_threshold.is_finite()) {
            return bad("low_threshold", low_threshold, "a number of 0 or more");
        }
        if !(high_threshold >= low_threshold && high_threshold.is_finite()) {
            return bad("high_threshold", high_threshold, "at least low_threshold");
        }
        Ok(())
    }
}

/// The stage `segment`.
#[derive(Debug, Clone, Copy)]
pub struct Segment;

impl Stage for Segment {
    const NAME: &'static str = "segment";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = SegmentInputs;
    type Params = SegmentParams;
    type Output = Curves;
    type Error = SegmentError;

    fn run(inputs: &SegmentInputs, params: &SegmentParams, _: &Context) -> Result<Curves, SegmentError> {
        curves(&inputs.frame, params)
    }
}

/// The edge curves of a frame.
///
/// # Errors
/// A parameter out of range, or a frame without edges.
pub fn curves(frame: &Frame, params: &SegmentParams) -> Result<Curves, SegmentError> {
    params.check()?;
    let scale = 255.0 / ((1_u32 << frame.bits.clamp(1, 16)) - 1) as f32;
    let samples = frame.samples.iter().map(|&s| f32::from(s) * scale).collect();
    let map = find_edges(frame.width, frame.height, samples, params);
    if map.points.is_empty() {
        let (width, height) = (frame.width, frame.height);
        return Err(SegmentError::NoEdge { width, height, high: params.high_threshold });
    }
    Ok(Curves::rounded(link(&map, params.min_points)))
}
