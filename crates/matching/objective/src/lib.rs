//! How well a body at a pose fits its outlines, in one view, two, or more: each objective of the thesis and its survey (1.1.4, 3.2) behind one
//! interface.
//!
//! | [`Kind`] | what is measured | from |
//! |---|---|---|
//! | `spline_grid` | mean distance of the grid outline's points from the spline, Eqs. 3.4 to 3.6 | the thesis |
//! | `spline_rim` | the same of the exact rim | the thesis |
//! | `image_to_model` | edge points of the image from the visible outline, with direction, robust | Lowe 1991 |
//! | `symmetric` | the mean of that and of the outline's points from edges | |
//! | `non_overlap` | area under either the model's shadow or the contour, not under both | Banks and Hodge 1996 |
//! | `inverse_point` | closest approach of the rays of edge points to the surface, in a grid of signed distances | Lavallee and Szeliski 1995 |
//!
//! All values are in mm at the body's depth and are summed over the views; less is better; a view in which the body has no outline counts
//! [`NO_OUTLINE`]. Each but `spline_grid` gives its gradient as rows ([`Row`]), so that Levenberg and Marquardt's method can search it. A new
//! objective, digitally reconstructed radiographs say, is a type with this trait: the pose comes in, a number goes out, rows where there are any.
//!
//! **Robust** ones weigh residuals by Geman and McClure's function, whose scale shrinks over stages ([`Objective::enter`]): wide to see far, fine
//! to leave out what is not the body's. An objective is a function of the pose and the stage alone, with no memory of earlier poses.
//!
//! **Guaranteed:** a finite value for any pose; nothing is allocated per evaluation once buffers have grown. The rows' sum is the exact gradient of
//! the function where the outline's triangles stay the same and each point keeps its partner; between such places it jumps, by less the
//! finer the mesh. **Not guaranteed:** that a lowest value is the right pose.

mod area;
mod edges;
mod field;
mod inverse_point;
mod kernel;
mod motion;
mod near;
mod region;
mod shadow;
mod spline;
mod variables;

use std::sync::Arc;

use biplane_artifact::Curves;
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Mesh, Pose};
use biplane_optimiser::Row;
use biplane_outline::RimMesh;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use area::NonOverlap;
pub use edges::EdgeDistance;
pub use field::DistanceField;
pub use inverse_point::InversePoint;
pub use region::Region;
pub use shadow::Shadow;
pub use spline::{SplineDistance, pieces};
pub use variables::Variables;

/// What a view counts, mm, in which the body has no outline (listing A.2.1, lines 134 to 143).
pub const NO_OUTLINE: f64 = 100.0;

/// How well a body at a pose fits.
pub trait Objective {
    /// The value at a pose (`world_from_model`), mm; less is better; finite.
    fn value(&mut self, pose: &Pose) -> f64;

    /// The same, with rows whose sum of `weight * residual * derivative` is its gradient by a twist about the body's centroid: translation (mm),
    /// then rotation (rad), laboratory axes. Rows are added to `rows`. `None` for an objective that has none.
    fn linearise(&mut self, pose: &Pose, rows: &mut Vec<Row>) -> Option<f64>;

    /// In how many stages it wants to be searched, one after the other.
    fn stages(&self) -> usize {
        1
    }

    /// Begins a stage, from 0. Values of different stages do not compare.
    fn enter(&mut self, _stage: usize) {}
}

/// What one view shows of the body.
#[derive(Debug, Clone)]
pub struct Target {
    /// The fluoroscope.
    pub fluoroscope: Fluoroscope,
    /// Edges or contours, ideal pixels. They ought to be those of the body alone.
    pub curves: Curves,
    /// Size of a pixel at the body's depth, mm. Constant over a search.
    pub mm_per_px: f64,
}

impl Target {
    /// From curves in recorded pixels, corrected for the fluoroscope's distortion if it has one.
    pub fn new(fluoroscope: Fluoroscope, recorded: &Curves, mm_per_px: f64) -> Self {
        let curves = match fluoroscope.distortion() {
            None => recorded.clone(),
            Some(distortion) => Curves(recorded.0.iter().map(|curve| distortion.correct(curve)).collect()),
        };
        Self { fluoroscope, curves, mm_per_px }
    }
}

/// A body, prepared.
#[derive(Debug, Clone)]
pub struct Body<'a> {
    /// Its mesh.
    pub mesh: &'a Mesh,
    /// The same for its rim.
    pub rim: &'a RimMesh,
    /// Signed distances, where they are made already; else [`Kind::InversePoint`] makes its own.
    pub field: Option<Arc<DistanceField>>,
}

/// How objectives measure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// +1 for a body darker than what is beside it, -1 for a brighter one.
    pub contrast: f64,
    /// Distance of points along outlines and along the image's curves, px.
    pub spacing_px: f64,
    /// Points of the grid outline that are compared with the spline, evenly along it.
    pub outline_points: usize,
    /// Cells of the grid outline along the body's shorter side.
    pub grid: usize,
    /// How far a partner is sought, px.
    pub reach_px: f64,
    /// Scale of the robust function in the first stage, px.
    pub wide_px: f64,
    /// Scale in the last stage, px.
    pub fine_px: f64,
    /// Stages from wide to fine.
    pub stages: usize,
    /// By how much edges lie inside the outline as a whole, px (1 sigma): solved for in each view, in the last stage of robust objectives, up to twice as
    /// much; 0 holds it at zero.
    pub inset_px: f64,
}

/// The objectives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Grid outline to spline.
    SplineGrid,
    /// Exact rim to spline.
    SplineRim,
    /// Edge points to outline.
    ImageToModel,
    /// Both ways.
    Symmetric,
    /// Area under one but not under both.
    NonOverlap,
    /// Rays to surface.
    InversePoint,
}

/// Why there is no such objective of these curves.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ObjectiveError {
    /// A view has no curve.
    #[error("view {0} (counted from 1) has no edge of the body: nothing to compare with")]
    NoCurve(usize),
    /// Contours enclose nothing.
    #[error(
        "the contours of view {0} (counted from 1) surround no area, so none can fail to overlap: use an objective that takes pieces of a \
         contour, or draw a closed one"
    )]
    NoArea(usize),
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::SplineGrid,
        Self::SplineRim,
        Self::ImageToModel,
        Self::Symmetric,
        Self::NonOverlap,
        Self::InversePoint,
    ];

    /// Its name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::SplineGrid => "spline_grid",
            Self::SplineRim => "spline_rim",
            Self::ImageToModel => "image_to_model",
            Self::Symmetric => "symmetric",
            Self::NonOverlap => "non_overlap",
            Self::InversePoint => "inverse_point",
        }
    }

    /// Whether it gives rows.
    pub fn has_rows(self) -> bool {
        self != Self::SplineGrid
    }

    /// The objective of a body in some views.
    ///
    /// # Errors
    /// [`ObjectiveError`], where the curves do not do.
    pub fn of<'a>(
        self,
        body: &Body<'a>,
        targets: &[Target],
        settings: &Settings,
    ) -> Result<Box<dyn Objective + 'a>, ObjectiveError> {
        if let Some(none) = targets.iter().position(|t| t.curves.point_count() == 0) {
            return Err(ObjectiveError::NoCurve(none + 1));
        }
        Ok(match self {
            Self::SplineGrid => Box::new(SplineDistance::of_grid(body, targets, settings)),
            Self::SplineRim => Box::new(SplineDistance::of_rim(body, targets, settings)),
            Self::ImageToModel => Box::new(EdgeDistance::new(body, targets, settings, 0.0)),
            Self::Symmetric => Box::new(EdgeDistance::new(body, targets, settings, 0.5)),
            Self::NonOverlap => Box::new(NonOverlap::new(body, targets, settings)?),
            Self::InversePoint => Box::new(InversePoint::new(body, targets, settings)),
        })
    }
}

#[cfg(test)]
mod tests;
