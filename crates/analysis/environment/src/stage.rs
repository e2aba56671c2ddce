//! The stage `environment`: spots of the bead pictures of all views in, the fluoroscopes out.

use biplane_artifact::{BeadClicks, BeadList, Detector, Environment, Spots};
use biplane_stage::{Context, Stage, inputs};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{EnvironmentError, find_environment};

inputs! {
    /// All pictures of one frame of beads.
    pub struct EnvironmentInputs {
        /// One a view.
        detectors: [Detector],
        /// One a picture: all views of the first placing of the frame, then all views of the second, and so on.
        spots: [Spots],
        beads: BeadList,
        /// A person's clicks: none or one.
        clicks: [BeadClicks],
    }
}

/// How fluoroscopes are found from beads.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct EnvironmentParams {
    /// The pictures are mirror images: they show the scene as seen from behind the detector.
    pub mirrored: bool,
    /// A bead whose residual is this many times the robust spread is left out.
    pub reject_sigmas: f64,
    /// Reprojection error, root mean square, above which a view is called doubtful, px.
    pub max_reprojection_px: f64,
    /// Leave-one-out triangulation error, root mean square, above which the environment is called doubtful, mm.
    pub max_triangulation_mm: f64,
}

impl Default for EnvironmentParams {
    fn default() -> Self {
        Self { mirrored: false, reject_sigmas: 5.0, max_reprojection_px: 0.5, max_triangulation_mm: 0.2 }
    }
}

/// The stage `environment`.
#[derive(Debug, Clone, Copy)]
pub struct FindEnvironment;

impl Stage for FindEnvironment {
    const NAME: &'static str = "environment";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = EnvironmentInputs;
    type Params = EnvironmentParams;
    type Output = Environment;
    type Error = EnvironmentError;

    fn run(
        inputs: &EnvironmentInputs,
        params: &EnvironmentParams,
        _: &Context,
    ) -> Result<Environment, EnvironmentError> {
        let detectors: Vec<&Detector> = inputs.detectors.iter().map(|d| &**d).collect();
        let spots: Vec<&Spots> = inputs.spots.iter().map(|s| &**s).collect();
        find_environment(&detectors, &spots, &inputs.beads, inputs.clicks.first().map(|c| &**c), params)
    }
}
