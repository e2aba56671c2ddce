//! The stage `smooth`: the matches of one body over a trial in, its most probable motion out.

use biplane_artifact::{Match, SmoothedTrial};
use biplane_geometry::{Point3, Pose};
use biplane_stage::{Context, Stage, inputs};
use nalgebra::Matrix6;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::smooth::{Measured, smooth};

inputs! {
    /// One body over a trial.
    pub struct SmoothInputs {
        /// The matches that are used, in the order of their frames.
        matches: [Match],
    }
}

/// How a trial is smoothed.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SmoothSettings {
    /// Whether whole trials are smoothed. Raw poses are always written too: `results/poses_smoothed.csv` stands beside `results/poses.csv`.
    pub enabled: bool,
    /// Usual acceleration of a body's middle, mm/s^2 (mm a frame, a frame, where nothing says the frame rate). Not given, the one under which
    /// the trial's matches are most probable.
    #[schemars(range(min = 1e-9))]
    pub acceleration_mm_s2: Option<f64>,
    /// Usual acceleration of its turning, degrees/s^2.
    #[schemars(range(min = 1e-9))]
    pub acceleration_deg_s2: Option<f64>,
    /// Whether frames without a match that can be used are bridged. They are marked, and less sure.
    pub bridge: bool,
}

/// Parameters of the stage.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SmoothParams {
    /// When each frame of the trial was taken, s, or its number.
    pub times: Vec<f64>,
    /// Numbers of the frames whose matches are the inputs.
    pub frames: Vec<usize>,
    /// The middle of the body (model, mm), which covariances are about.
    pub pivot_mm: [f64; 3],
    /// Intensities of place (mm^2 / t^3) and turning (rad^2 / t^3), where they are given.
    pub intensity: [Option<f64>; 2],
    /// As [`SmoothSettings::bridge`].
    pub bridge: bool,
}

/// Why a trial cannot be smoothed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SmoothError {
    /// Too little to go by.
    #[error(
        "cannot be smoothed: {found} frames with a pose that is good, expected three or more at times that grow, each with a covariance"
    )]
    Few {
        /// How many there are.
        found: usize,
    },
}

/// The stage `smooth`.
#[derive(Debug, Clone, Copy)]
pub struct Smooth;

impl Stage for Smooth {
    const NAME: &'static str = "smooth";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = SmoothInputs;
    type Params = SmoothParams;
    type Output = SmoothedTrial;
    type Error = SmoothError;

    fn run(inputs: &SmoothInputs, params: &SmoothParams, _: &Context) -> Result<SmoothedTrial, SmoothError> {
        let rows = |c: &[[f64; 6]; 6]| Matrix6::from_fn(|i, j| c[i][j]);
        let mut frames: Vec<(f64, Option<Measured>)> = params.times.iter().map(|t| (*t, None)).collect();
        for (number, found) in params.frames.iter().zip(&inputs.matches) {
            let calibration = found.calibration_covariance.as_ref().map_or_else(Matrix6::zeros, rows);
            let covariance = rows(&found.covariance) - calibration;
            let measured = Measured { pose: Pose::from(found.pose), covariance, calibration };
            if let Some(frame) = frames.get_mut(*number) {
                frame.1 = Some(measured);
            }
        }
        let pivot = Point3::from(params.pivot_mm);
        smooth(&frames, &pivot, params.intensity, params.bridge)
            .ok_or(SmoothError::Few { found: inputs.matches.len() })
    }
}
