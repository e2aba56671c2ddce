//! The stage `distortion`: spots of a plate's picture and the plate's pattern in, the map to ideal pixels out.

use biplane_artifact::{PlateClicks, PlateFit, PlatePattern, Spots};
use biplane_stage::{Context, Stage, inputs};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

inputs! {
    /// One picture of a plate.
    pub struct DistortionInputs {
        spots: Spots,
        pattern: PlatePattern,
        /// A person's correspondences: none or one.
        clicks: [PlateClicks],
    }
}

/// A family of maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Model {
    /// One polynomial in x and y for the whole picture, of degree `degree`.
    Polynomial,
    /// Local weighted mean of second-degree polynomials through `neighbours` spots each (Goshtasby 1988; XMALab).
    LocalWeightedMean,
    /// Whichever has the least held-out residual.
    Best,
}

/// How distortion is fitted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct DistortionParams {
    /// The family of maps.
    pub model: Model,
    /// Degree of the polynomial, 1 to 7.
    #[schemars(range(min = 1, max = 7))]
    pub degree: u32,
    /// Neighbours of the local weighted mean, 6 to 50.
    pub neighbours: usize,
    /// A spot whose residual is this many times the robust spread is left out.
    pub reject_sigmas: f64,
    /// Held-out residual, root mean square, above which a plate is called doubtful, px.
    pub max_held_out_px: f64,
}

impl Default for DistortionParams {
    fn default() -> Self {
        Self { model: Model::Polynomial, degree: 4, neighbours: 12, reject_sigmas: 5.0, max_held_out_px: 0.3 }
    }
}

/// Why there is no map.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DistortionError {
    /// Too few spots.
    #[error("{found} spots of the picture belong to the plate, at least {needed} are needed")]
    TooFew {
        /// How many.
        found: usize,
        /// How many at least.
        needed: usize,
    },
}

/// The stage `distortion`.
#[derive(Debug, Clone, Copy)]
pub struct FitDistortion;

impl Stage for FitDistortion {
    const NAME: &'static str = "distortion";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = DistortionInputs;
    type Params = DistortionParams;
    type Output = PlateFit;
    type Error = DistortionError;

    fn run(
        inputs: &DistortionInputs,
        params: &DistortionParams,
        _: &Context,
    ) -> Result<PlateFit, DistortionError> {
        fit_plate(&inputs.spots, &inputs.pattern, inputs.clicks.first().map(|c| &**c), params)
    }
}

/// The distortion that a plate's picture shows.
///
/// # Errors
/// See [`DistortionError`].
pub fn fit_plate(
    spots: &Spots,
    _pattern: &PlatePattern,
    _clicks: Option<&PlateClicks>,
    params: &DistortionParams,
) -> Result<PlateFit, DistortionError> {
    Err(DistortionError::TooFew { found: spots.spots.len(), needed: params.neighbours })
}
