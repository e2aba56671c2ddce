//! The stage `slice_edits`: what a person drew in slices in the place of what was found there.

use biplane_artifact::{EditedContour, SliceContours};
use biplane_slices::{ReplaceError, replace};
use biplane_stage::{Context, Stage, inputs};
use serde::{Deserialize, Serialize};

inputs! {
    /// The contours of a bone, and what was drawn for some of its slices.
    pub struct SliceEditsInputs {
        contours: SliceContours,
        /// One a slice.
        drawn: [EditedContour],
    }
}

/// Which slices were drawn, and how well.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SliceEditsParams {
    /// Number of the slice of each drawing.
    pub slices: Vec<usize>,
    /// How well a hand places a line, px (1 sigma): `hand_sigma_px` of `[edit]`.
    pub hand_sigma_px: f64,
}

/// The stage `slice_edits`.
#[derive(Debug, Clone, Copy)]
pub struct SliceEdits;

impl Stage for SliceEdits {
    const NAME: &'static str = "slice_edits";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = SliceEditsInputs;
    type Params = SliceEditsParams;
    type Output = SliceContours;
    type Error = ReplaceError;

    fn run(
        inputs: &SliceEditsInputs,
        params: &SliceEditsParams,
        _: &Context,
    ) -> Result<SliceContours, ReplaceError> {
        let mut contours = SliceContours::clone(&inputs.contours);
        let sigma_mm = params.hand_sigma_px * pixel_mm(&contours);
        for (slice, drawn) in params.slices.iter().zip(&inputs.drawn) {
            let rings: Vec<Vec<[f64; 2]>> = drawn.pieces.iter().map(|p| p.points.clone()).collect();
            replace(&mut contours, *slice, &rings, sigma_mm)?;
        }
        Ok(contours)
    }
}

/// Side of a square as large as a pixel of the slices, mm.
pub fn pixel_mm(contours: &SliceContours) -> f64 {
    let length = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
    (length(contours.column_step_mm) * length(contours.row_step_mm)).sqrt()
}
