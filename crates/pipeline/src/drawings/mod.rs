//! Drawings by which a person judges a calibration (the plate, what is left of its distortion, the beads, the fluoroscopes in space)
//! and contours of slices.
//!
//! Each is a function from artifacts to SVG text, and a stage around it. A drawing holds everything it shows (the picture too),
//! runs nothing, refers to nothing outside, and is the same bytes for the same artifacts. Where the verdict is not good it has a
//! red frame with the reasons on top.

mod arrows;
mod backdrop;
pub(crate) mod base64;
mod bead;
mod camera;
mod colours;
mod contour_panel;
mod distance_map;
mod figures;
mod labels;
mod legend;
mod model;
mod model_numbers;
#[cfg(test)]
mod model_tests;
mod plate;
mod residual;
mod shaded;
mod sheet;
mod slices;
mod space;
mod svg;
#[cfg(test)]
mod tests;

use biplane_artifact::{BeadList, Drawing, Environment, Frame, PlateFit};
use biplane_stage::{Context, Stage, inputs};
use serde::{Deserialize, Serialize};

pub use bead::bead_drawing;
pub use model::{DrawModel, ModelDrawing, ModelDrawingInputs, ModelDrawingParams, model_drawing};
pub use plate::plate_drawing;
pub use residual::residual_drawing;
pub use slices::{DrawSlices, SliceDrawingInputs, SliceDrawingParams, slice_drawing};
pub use space::space_drawing;

/// Why there is no drawing.
#[derive(Debug, thiserror::Error)]
pub enum DrawingError {
    /// A frame without pixels, or not as many as it says.
    #[error("the picture says {width} x {height} pixels but holds {samples}: read it again from its file")]
    Frame {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Pixels.
        samples: usize,
    },
    /// The frame belongs to something else.
    #[error(
        "the picture has {} x {} pixels, what was found in it is of {} x {}: give the picture it was found in",
        frame[0], frame[1], artifact[0], artifact[1]
    )]
    Size {
        /// Columns and rows of the frame.
        frame: [usize; 2],
        /// Those of the artifact.
        artifact: [usize; 2],
    },
    /// There is no such view.
    #[error("view {view} (from 0) is asked for, the environment has {views}")]
    View {
        /// Which.
        view: usize,
        /// How many there are.
        views: usize,
    },
    /// A table that cannot be looked up.
    #[error(
        "the distortion table says {} x {} samples at positive distances and holds {samples}: every one must be a number, \
         at least 2 x 2 of them; make the fit again",
        count[0], count[1]
    )]
    Table {
        /// Samples along x and y.
        count: [usize; 2],
        /// Samples there are.
        samples: usize,
    },
    /// The volume cannot be cut into slices as is asked for.
    #[error(transparent)]
    Cut(#[from] biplane_slices::SlicesError),
    /// The picture cannot be written.
    #[error("the picture in a drawing could not be written as PNG: {0}")]
    Png(#[from] image::ImageError),
}

/// What a drawing of a plate says beside what the fit says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlateDrawingParams {
    /// The view's name in the study, for the title.
    pub view: String,
    /// `max_held_out_px` of `[distortion]`.
    pub max_held_out_px: f64,
}

/// Which picture of the beads is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BeadDrawingParams {
    /// Which view, by its place.
    pub view: usize,
    /// Which picture of the view, from 0.
    pub picture: usize,
    /// `max_reprojection_px` of `[environment]`.
    pub max_reprojection_px: f64,
}

/// The limits that a drawing of the environment shows.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpaceDrawingParams {
    /// `max_reprojection_px` of `[environment]`.
    pub max_reprojection_px: f64,
    /// `max_triangulation_mm` of `[environment]`.
    pub max_triangulation_mm: f64,
}

inputs! {
    /// A picture of a plate and what was made of it.
    pub struct PlateDrawingInputs {
        frame: Frame,
        fit: PlateFit,
    }
}

inputs! {
    /// What was made of a plate.
    pub struct ResidualDrawingInputs {
        fit: PlateFit,
    }
}

inputs! {
    /// A picture of the beads and what was made of all of them.
    pub struct BeadDrawingInputs {
        frame: Frame,
        environment: Environment,
        beads: BeadList,
    }
}

inputs! {
    /// The fluoroscopes and the beads they were found from.
    pub struct SpaceDrawingInputs {
        environment: Environment,
        beads: BeadList,
    }
}

/// The stage `draw-plate`: [`plate_drawing`].
#[derive(Debug, Clone, Copy)]
pub struct DrawPlate;

impl Stage for DrawPlate {
    const NAME: &'static str = "draw-plate";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = PlateDrawingInputs;
    type Params = PlateDrawingParams;
    type Output = Drawing;
    type Error = DrawingError;

    fn run(
        inputs: &PlateDrawingInputs,
        params: &PlateDrawingParams,
        _: &Context,
    ) -> Result<Drawing, DrawingError> {
        plate_drawing(&inputs.frame, &inputs.fit, params).map(Drawing)
    }
}

/// The stage `draw-residuals`: [`residual_drawing`].
#[derive(Debug, Clone, Copy)]
pub struct DrawResiduals;

impl Stage for DrawResiduals {
    const NAME: &'static str = "draw-residuals";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = ResidualDrawingInputs;
    type Params = PlateDrawingParams;
    type Output = Drawing;
    type Error = DrawingError;

    fn run(
        inputs: &ResidualDrawingInputs,
        params: &PlateDrawingParams,
        _: &Context,
    ) -> Result<Drawing, DrawingError> {
        residual_drawing(&inputs.fit, params).map(Drawing)
    }
}

/// The stage `draw-beads`: [`bead_drawing`].
#[derive(Debug, Clone, Copy)]
pub struct DrawBeads;

impl Stage for DrawBeads {
    const NAME: &'static str = "draw-beads";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = BeadDrawingInputs;
    type Params = BeadDrawingParams;
    type Output = Drawing;
    type Error = DrawingError;

    fn run(
        inputs: &BeadDrawingInputs,
        params: &BeadDrawingParams,
        _: &Context,
    ) -> Result<Drawing, DrawingError> {
        bead_drawing(&inputs.frame, &inputs.environment, &inputs.beads, params).map(Drawing)
    }
}

/// The stage `draw-space`: [`space_drawing`].
#[derive(Debug, Clone, Copy)]
pub struct DrawSpace;

impl Stage for DrawSpace {
    const NAME: &'static str = "draw-space";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = SpaceDrawingInputs;
    type Params = SpaceDrawingParams;
    type Output = Drawing;
    type Error = std::convert::Infallible;

    fn run(
        inputs: &SpaceDrawingInputs,
        params: &SpaceDrawingParams,
        _: &Context,
    ) -> Result<Drawing, std::convert::Infallible> {
        Ok(Drawing(space_drawing(&inputs.environment, &inputs.beads, params)))
    }
}
