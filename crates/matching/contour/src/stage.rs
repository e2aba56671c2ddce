//! Inputs, parameters and errors of the stage `contour`.

use std::sync::Arc;

use biplane_artifact::{Calibration, Contour, Curves, Match, ModelMesh};
use biplane_edge_field::EdgeField;
use biplane_fluoroscope::Fluoroscope;
use biplane_outline::{Outline, RimMesh, RimWithoutCutEnds, Sampling};
use biplane_stage::{Context, Stage, inputs};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::choose;

inputs! {
    /// One body in one view of one frame.
    pub struct ContourInputs {
        /// The frame's curves.
        curves: Curves,
        /// Its view.
        calibration: Calibration,
        /// The body.
        model: ModelMesh,
        /// Its pose.
        matched: Match,
    }
}

/// Whether a body is darker or brighter than what surrounds it in the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Contrast {
    /// As X-rays make bone and metal.
    Dark,
    /// The other way round.
    Bright,
}

/// How edges are chosen for an outline, and when a person should look.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ContourParams {
    /// An edge farther from the outline is not the body's, px, after the inset of its edges as a whole; nor is one beyond both
    /// 1 px and four of their deviations.
    #[schemars(range(min = 0.1, max = 50.0))]
    pub reach_px: f64,
    /// An edge turned from the outline by more is not the body's, degrees.
    #[schemars(range(min = 1.0, max = 89.0))]
    pub turned_deg: f64,
    /// Two curves are told apart if one is nearer by more than this, px.
    #[schemars(range(min = 0.0, max = 50.0))]
    pub apart_px: f64,
    /// Pieces with fewer points are left out.
    #[schemars(range(min = 1))]
    pub min_points: usize,
    /// `"dark"`, or `"bright"` if bodies are brighter than their surroundings.
    pub contrast: Contrast,
    /// A frame is flagged where less than this share of the outline has an edge, 0 to 1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub flag_found_share: f64,
    /// and where more than this share of the outline has edges of two curves that cannot be told apart, 0 to 1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub flag_unclear_share: f64,
    /// Whether the body's flat ends, where its volume was cut, are no outline. Each body's own: `[[body]]` says it.
    #[schemars(skip)]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub ignore_cut_ends: bool,
}

impl Default for ContourParams {
    fn default() -> Self {
        Self {
            reach_px: 3.0,
            turned_deg: 25.0,
            apart_px: 1.0,
            min_points: 8,
            contrast: Contrast::Dark,
            flag_found_share: 0.75,
            flag_unclear_share: 0.1,
            ignore_cut_ends: false,
        }
    }
}

/// Why there is no contour.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ContourError {
    /// A parameter out of range.
    #[error("[contour] {name} = {value}, expected {expected}")]
    Parameter {
        /// The key in pipeline.toml.
        name: &'static str,
        /// What it is.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
}

impl ContourParams {
    /// # Errors
    /// Names the first parameter that is out of its range.
    pub fn check(&self) -> Result<(), ContourError> {
        let Self {
            reach_px,
            turned_deg,
            apart_px,
            min_points: _,
            contrast: _,
            flag_found_share,
            flag_unclear_share,
            ignore_cut_ends: _,
        } = *self;
        let within = |name, value: f64, low: f64, high: f64, expected| {
            if (low..=high).contains(&value) {
                Ok(())
            } else {
                Err(ContourError::Parameter { name, value, expected })
            }
        };
        within("reach_px", reach_px, 0.1, 50.0, "0.1 to 50 px")?;
        within("turned_deg", turned_deg, 1.0, 89.0, "1 to 89 degrees")?;
        within("apart_px", apart_px, 0.0, 50.0, "0 to 50 px")?;
        within("flag_found_share", flag_found_share, 0.0, 1.0, "0 to 1")?;
        within("flag_unclear_share", flag_unclear_share, 0.0, 1.0, "0 to 1")
    }
}

/// The stage `contour`.
#[derive(Debug, Clone, Copy)]
pub struct ContourOf;

/// Distance of the outline's samples, px.
const STEP_PX: f64 = 1.0;

impl Stage for ContourOf {
    const NAME: &'static str = "contour";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = ContourInputs;
    type Params = ContourParams;
    type Output = Contour;
    type Error = ContourError;

    fn run(
        inputs: &ContourInputs,
        params: &ContourParams,
        context: &Context,
    ) -> Result<Contour, ContourError> {
        params.check()?;
        let view = Fluoroscope::from(&*inputs.calibration);
        let (model, hash) = (&inputs.model.0, inputs.model.hash());
        let mesh = if params.ignore_cut_ends {
            Arc::clone(&context.prepared(hash, || RimWithoutCutEnds::new(model)).0)
        } else {
            context.prepared(hash, || RimMesh::new(model))
        };
        let mut outline = Outline::new();
        outline.trace(&mesh, &inputs.matched.pose.into(), &view, Sampling { step_px: STEP_PX });
        let edges = EdgeField::new(&inputs.curves, view.distortion());
        let seen: Vec<_> =
            outline.points().iter().filter(|p| view.on_image(&p.pixel, 2.0)).copied().collect();
        Ok(choose(&seen, &edges, &inputs.curves, params))
    }
}
