//! The stage `distortion`: spots of a plate's picture and the plate's pattern in, the map to ideal pixels out.

use biplane_artifact::{PlateClicks, PlateFit, PlatePattern, Spots};
use biplane_stage::{Context, Stage, inputs};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::model::FitError;
use crate::plate_fit::fit_plate;
use crate::recognise::RecogniseError;

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
    /// The family of maps; all are fitted and their held-out residuals reported, whichever is taken.
    pub model: Model,
    /// Degree where `model = "polynomial"`, 1 to 7. The thesis has 4; of 12 px of pincushion and of S-shape it leaves 0.03 px that
    /// 5 does not.
    #[schemars(range(min = 1, max = 7))]
    pub degree: u32,
    /// Neighbours of the local weighted mean, 6 to 50.
    pub neighbours: usize,
    /// A spot whose residual is this many times the robust spread is left out.
    pub reject_sigmas: f64,
    /// Side of an ideal pixel in the plate's plane, mm. If it is left out, ideal pixels are as large as recorded ones in the middle of
    /// the picture. It decides only how ideal pixels are counted: lengths come from the plate's pattern.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pixel_mm: Option<f64>,
    /// Held-out residual, root mean square, above which a plate is called doubtful, px.
    #[schemars(range(min = 0.0))]
    pub max_held_out_px: f64,
    /// Share of the picture's spots that must belong to the plate, else it is taken for a picture of something else. 0 to 1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub min_matched_share: f64,
    /// Share of the spots that belong to no hole of the plate (scratches, dirt) above which a plate is called doubtful. 0 to 1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub max_stray_share: f64,
    /// Share of the holes among those found that were not found, above which a plate is called doubtful. 0 to 1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub max_missing_share: f64,
    /// Share of the picture, within its round border, that must be near a hole, else a plate is called doubtful: elsewhere the map is a
    /// continuation. 0 to 1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub min_covered_share: f64,
    /// Tilt of the plate against the intensifier above which it is called doubtful, degrees.
    #[schemars(range(min = 0.0, max = 90.0))]
    pub max_tilt_deg: f64,
    /// About how far the source is from the plate, mm. Only for the tilt, which is seen by perspective.
    #[schemars(range(min = 1.0))]
    pub source_distance_mm: f64,
}

impl Default for DistortionParams {
    fn default() -> Self {
        Self {
            model: Model::Best,
            degree: 5,
            neighbours: 12,
            reject_sigmas: 5.0,
            pixel_mm: None,
            max_held_out_px: 0.3,
            min_matched_share: 0.5,
            max_stray_share: 0.1,
            max_missing_share: 0.1,
            min_covered_share: 0.75,
            max_tilt_deg: 1.0,
            source_distance_mm: 1000.0,
        }
    }
}

/// Why there is no map.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DistortionError {
    /// A parameter out of its range.
    #[error("[distortion] {name} = {value}, expected {expected}")]
    Parameter {
        /// The key in pipeline.toml.
        name: &'static str,
        /// What it is.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// Spots, plate and clicks do not go together.
    #[error(transparent)]
    Recognise(#[from] RecogniseError),
    /// The spots that belong to the plate determine no map.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// A picture of no size, or of one that no detector has.
    #[error("the spots are of a picture of {} x {} pixels, expected 1 to {most} each way", size[0], size[1])]
    Size {
        /// Columns and rows.
        size: [usize; 2],
        /// How many there may be.
        most: usize,
    },
    /// The spots lie along a line.
    #[error(
        "the {spots} spots that belong to the plate lie along a line: they say nothing of the distortion across it; use a picture in \
         which holes fill the view"
    )]
    Line {
        /// How many.
        spots: usize,
    },
}

impl DistortionParams {
    /// Checks what [`fit`](crate::fit) does not.
    ///
    /// # Errors
    /// Names the first parameter that is out of its range.
    pub fn check(&self) -> Result<(), DistortionError> {
        let bad = |name, value, expected| Err(DistortionError::Parameter { name, value, expected });
        if let Some(value) = self.pixel_mm.filter(|v| !(*v > 0.0 && v.is_finite())) {
            return bad("pixel_mm", value, "a length above 0 mm");
        }
        if !(1..=7).contains(&self.degree) {
            return bad("degree", f64::from(self.degree), "1 to 7");
        }
        if !(6..=50).contains(&self.neighbours) {
            return bad("neighbours", self.neighbours as f64, "6 to 50");
        }
        if !(2.0..=1e9).contains(&self.reject_sigmas) {
            return bad("reject_sigmas", self.reject_sigmas, "at least 2");
        }
        let shares = [
            ("min_matched_share", self.min_matched_share),
            ("max_stray_share", self.max_stray_share),
            ("max_missing_share", self.max_missing_share),
            ("min_covered_share", self.min_covered_share),
        ];
        if let Some((name, value)) = shares.into_iter().find(|(_, v)| !(0.0..=1.0).contains(v)) {
            return bad(name, value, "a share of 0 to 1");
        }
        if !(0.0..=f64::MAX).contains(&self.max_held_out_px) {
            return bad("max_held_out_px", self.max_held_out_px, "0 px or more");
        }
        if !(0.0..=90.0).contains(&self.max_tilt_deg) {
            return bad("max_tilt_deg", self.max_tilt_deg, "0 to 90 degrees");
        }
        if !(1.0..=f64::MAX).contains(&self.source_distance_mm) {
            return bad("source_distance_mm", self.source_distance_mm, "1 mm or more");
        }
        Ok(())
    }
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
