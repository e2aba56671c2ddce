//! The stage `loft`: the contours of a bone's slices in, its surface out.

use biplane_artifact::{BoneSurface, SliceContours, SurfaceReport};
use biplane_stage::{Context, Stage, inputs};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::stack::Stack;
use crate::{diagonal, distance, faults};

inputs! {
    /// The contours of one bone.
    pub struct LoftInputs {
        contours: SliceContours,
    }
}

/// How contours become a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Signed distances of the slices, interpolated: closed, and branches where the bone does.
    #[default]
    Distance,
    /// The thesis's way: points of neighbouring contours joined by the shorter diagonal, one contour a slice.
    Diagonal,
}

/// How an end of the bone between two slices is closed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Caps {
    /// By a dome that goes on as the last slices let expect; flat where the volume cuts the bone off.
    #[default]
    Shape,
    /// By a flat lid in the last slice.
    Flat,
}

/// How contours become a surface.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct LoftParams {
    /// How contours become a surface.
    pub method: Method,
    /// For `distance`: side of the grid's cells in the slices' planes, mm, and about that of the triangles; 0 takes it from how far
    /// apart the contours' points are. 0, or 0.02 to 20.
    #[schemars(range(min = 0.0, max = 20.0))]
    pub cell_mm: f64,
    /// How an end of the bone between two slices is closed; `diagonal` closes flat always.
    pub caps: Caps,
    /// For `distance`: how far a contour that overlaps none of the next slice may lie from the one that continues it, centre to
    /// centre and off the way it had, in mean widths of the two. 0 to 5.
    #[schemars(range(min = 0.0, max = 5.0))]
    pub reach: f64,
    /// For `distance`: against the stairs of thick slices, contours that are unlike the two slices below and above them are moved by up to half
    /// this, mm, with the volume kept; what is off by much more is taken for shape. 0 (none) to 10.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub smoothing_mm: f64,
    /// For `diagonal`: whether contours are closed. If not, none is joined from its last point to its first.
    pub closed: bool,
    /// For `diagonal` where `closed = false`: no triangle has a diagonal longer than this, mm. 0.01 to 1000.
    #[schemars(range(min = 0.01, max = 1000.0))]
    pub gap_mm: f64,
}

impl Default for LoftParams {
    fn default() -> Self {
        Self {
            method: Method::Distance,
            cell_mm: 0.0,
            caps: Caps::Shape,
            reach: 1.5,
            smoothing_mm: 0.0,
            closed: true,
            gap_mm: 10.0,
        }
    }
}

/// Why contours do not become a surface.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LoftError {
    /// A parameter out of range.
    #[error("[loft] {name} = {value}, expected {expected}")]
    Parameter {
        /// The key in pipeline.toml.
        name: &'static str,
        /// What it is.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// The steps from pixel to pixel do not span a plane.
    #[error(
        "the slices' steps are {column:?} mm along a row and {row:?} mm along a column; they have to span a plane"
    )]
    Steps {
        /// Along a row.
        column: [f64; 3],
        /// Along a column.
        row: [f64; 3],
    },
    /// A slice without a place.
    #[error("slice {slice} has its origin at {origin:?} mm; each number has to be finite and at most 1e7")]
    Origin {
        /// Number of the slice, from 0.
        slice: usize,
        /// As given.
        origin: [f64; 3],
    },
    /// A point without a place.
    #[error(
        "slice {slice}, contour {contour}, point {point} is at ({i}, {j}) px; both numbers have to be finite, and the point at most 1e7 mm from the origin"
    )]
    Point {
        /// Number of the slice, from 0.
        slice: usize,
        /// Number of the contour in it, from 0.
        contour: usize,
        /// Number of the point in it, from 0.
        point: usize,
        /// As given.
        i: f64,
        /// As given.
        j: f64,
    },
    /// A contour that encloses nothing.
    #[error(
        "slice {slice}, contour {contour} has {distinct} different points; a closed contour needs at least 3: redraw or remove it"
    )]
    Few {
        /// Number of the slice, from 0.
        slice: usize,
        /// Number of the contour in it, from 0.
        contour: usize,
        /// How many there are.
        distinct: usize,
    },
    /// Slices that do not lie behind each other.
    #[error(
        "slice {slice} does not lie behind the one before it; sort the volume's slices along their normal"
    )]
    Order {
        /// Number of the slice, from 0.
        slice: usize,
    },
    /// No contour.
    #[error("none of the {slices} slices has a contour of the bone")]
    Empty {
        /// How many there are.
        slices: usize,
    },
    /// One slice, of unknown thickness.
    #[error(
        "there is one slice only, and no other that says how thick it is; a surface needs at least two slices"
    )]
    Single,
    /// The method joins neighbours and there are none.
    #[error(
        "method = \"diagonal\" joins contours of neighbouring slices, but only slice {slice} has one; use method = \"distance\""
    )]
    NoNeighbours {
        /// Number of the slice, from 0.
        slice: usize,
    },
    /// All of it is smaller than a cell.
    #[error(
        "every contour is smaller than a cell of the grid ({cell_mm} mm); set a smaller cell_mm in [loft]"
    )]
    Small {
        /// Side of a cell, mm.
        cell_mm: f64,
    },
}

impl LoftParams {
    /// # Errors
    /// Names the first parameter that is out of its range.
    pub fn check(&self) -> Result<(), LoftError> {
        let Self { method: _, cell_mm, caps: _, reach, smoothing_mm, closed: _, gap_mm } = *self;
        let bad = |name, value, expected| Err(LoftError::Parameter { name, value, expected });
        if cell_mm != 0.0 && !(0.02..=20.0).contains(&cell_mm) {
            return bad("cell_mm", cell_mm, "0 (chosen from the contours' points), or 0.02 to 20 mm");
        }
        if !(0.0..=5.0).contains(&reach) {
            return bad("reach", reach, "0 to 5 widths");
        }
        if !(0.0..=10.0).contains(&smoothing_mm) {
            return bad("smoothing_mm", smoothing_mm, "0 (none) to 10 mm");
        }
        if !(0.01..=1000.0).contains(&gap_mm) {
            return bad("gap_mm", gap_mm, "0.01 to 1000 mm");
        }
        Ok(())
    }
}

/// The stage `loft`.
#[derive(Debug, Clone, Copy)]
pub struct Loft;

impl Stage for Loft {
    const NAME: &'static str = "loft";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = LoftInputs;
    type Params = LoftParams;
    type Output = BoneSurface;
    type Error = LoftError;

    fn run(inputs: &LoftInputs, params: &LoftParams, _: &Context) -> Result<BoneSurface, LoftError> {
        loft(&inputs.contours, params)
    }
}

/// The surface through the contours of a bone, checked: `faults` of its report are what [`biplane_surface`] finds. Where smoothing has
/// made triangles cross, the vertices around are taken back.
///
/// # Errors
/// A parameter out of range, or contours that are no stack of closed contours.
pub fn loft(contours: &SliceContours, params: &LoftParams) -> Result<BoneSurface, LoftError> {
    params.check()?;
    let stack = Stack::of(contours)?;
    let made = made(&stack, params)?;
    Ok(faults::checked(&stack, made))
}

/// As [`loft`], without the checks: volume, area and pieces in the report are 0, and it has no faults.
///
/// # Errors
/// As [`loft`].
pub fn surface_of(contours: &SliceContours, params: &LoftParams) -> Result<BoneSurface, LoftError> {
    params.check()?;
    let stack = Stack::of(contours)?;
    let made = made(&stack, params)?;
    Ok(BoneSurface { mesh: made.mesh, report: made.report })
}

/// A surface with what its checks need.
pub(crate) struct Made {
    /// In the scanner's frame.
    pub mesh: biplane_geometry::Mesh,
    /// Its vertices before they were moved along and across the surface; none where nothing was moved.
    pub unmoved: Option<Vec<biplane_geometry::Point3>>,
    /// Its volume before it was smoothed; none where it was not.
    pub unsmoothed_volume_mm3: Option<f64>,
    /// What is known without checks.
    pub report: SurfaceReport,
}

fn made(stack: &Stack, params: &LoftParams) -> Result<Made, LoftError> {
    let mut made = match params.method {
        Method::Distance => distance::surface(stack, params)?,
        Method::Diagonal => diagonal::surface(stack, params)?,
    };
    made.report.slices = stack.slices.iter().filter(|s| !s.contours.is_empty()).count();
    made.report.warnings.splice(0..0, stack.warnings.iter().cloned());
    Ok(made)
}
