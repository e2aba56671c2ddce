//! The stage `spots`: one picture in, its round spots out.

use biplane_artifact::{Frame, Spots};
use biplane_stage::{Context, Stage, inputs};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::find::find_spots;

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
    /// Smallest radius of a spot, px. Raise it where something small and round that is no spot is found.
    #[schemars(range(min = 1.0))]
    pub min_radius_px: f64,
    /// Largest radius of a spot, px, at least the smallest. Raise it where beads are larger than that.
    #[schemars(range(min = 1.0, max = 500.0))]
    pub max_radius_px: f64,
    /// Least difference of a spot to its surroundings, grey levels. Lower it where spots are faint and the picture is clean.
    #[schemars(range(min = 0.0))]
    pub min_contrast: f64,
}

impl Default for SpotSettings {
    fn default() -> Self {
        Self { min_radius_px: 1.5, max_radius_px: 40.0, min_contrast: 8.0 }
    }
}

impl SpotSettings {
    /// Checks that every parameter is in its range.
    ///
    /// # Errors
    /// Names the first one that is not.
    pub fn check(&self) -> Result<(), SpotError> {
        let Self { min_radius_px, max_radius_px, min_contrast } = *self;
        let is = |holds: bool, name: &'static str, value: f64, expected: &'static str| {
            if holds { Ok(()) } else { Err(SpotError::Parameter { name, value, expected }) }
        };
        is((1.0..=500.0).contains(&min_radius_px), "min_radius_px", min_radius_px, "1 to 500 px")?;
        is(
            (min_radius_px..=500.0).contains(&max_radius_px),
            "max_radius_px",
            max_radius_px,
            "min_radius_px to 500 px",
        )?;
        is((0.0..=255.0).contains(&min_contrast), "min_contrast", min_contrast, "0 to 255 grey levels")
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
    /// A picture that does not hold what its size says.
    #[error("a picture of {width} x {height} pixels with {samples} grey levels, expected one a pixel")]
    Picture {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Grey levels that it has.
        samples: usize,
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
