//! The stage `slices`: a volume in, the closed contours of one bone in each of its slices out.

use biplane_artifact::{ContourSlice, SliceContour, SliceContours, SliceFlag, SlicePoint, Volume};
use biplane_stage::{Context, Stage, inputs};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::stack::Stack;
use crate::{Across, bone, labels, review, ring, turned};

inputs! {
    /// One volume.
    pub struct SlicesInputs {
        volume: Volume,
    }
}

/// How the bone is told from the rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// The volume is a map of labels, and one of them is the bone.
    #[default]
    Labels,
    /// The volume is an MRI or CT; the bone is found from a seed in its marrow.
    Bone,
}

/// How cortical bone looks in the volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Contrast {
    /// Darker than marrow and than what surrounds the bone: MRI.
    #[default]
    Dark,
    /// Brighter than both: CT.
    Bright,
}

/// Which bone, and how it is found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SlicesParams {
    /// How the bone is told from the rest.
    pub method: Method,
    /// Which way the volume is cut.
    pub across: Across,
    /// For `labels`: the bone's number. 1 to 65535.
    #[schemars(range(max = 65535))]
    pub label: u32,
    /// For `labels`: standard deviation of the Gaussian that takes the stairs off, pixels. 0.3 to 3.
    #[schemars(range(min = 0.3, max = 3.0))]
    pub smoothing_px: f64,
    /// For `bone`: a point in the bone's marrow, mm, left-posterior-superior; at least 2 mm from the cortical shell.
    pub seed_mm: Option<[f64; 3]>,
    /// For `bone`: how cortical bone looks.
    pub contrast: Contrast,
    /// For `bone`: the cortical shell is nowhere thicker than this, mm, measured in the slice. 0.5 to 30.
    #[schemars(range(min = 0.5, max = 30.0))]
    pub shell_mm: f64,
    /// For `bone`: by how much neighbouring marrow may differ in level, as a share of it; smaller where contours run out into
    /// fat that is nearly as bright. 0.02 to 0.6.
    #[schemars(range(min = 0.02, max = 0.6))]
    pub tolerance: f64,
    /// For `bone`: a hole of the shell narrower than twice this is no way out, mm. Marrow thinner than twice this is lost, unless
    /// it hangs on thicker marrow beside it. 0 to 20.
    #[schemars(range(min = 0.0, max = 20.0))]
    pub leak_mm: f64,
}

impl Default for SlicesParams {
    fn default() -> Self {
        Self {
            method: Method::Labels,
            across: Across::Scanned,
            label: 0,
            smoothing_px: 1.0,
            seed_mm: None,
            contrast: Contrast::Dark,
            shell_mm: 6.0,
            tolerance: 0.15,
            leak_mm: 2.0,
        }
    }
}

/// Why a volume has no contours.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SlicesError {
    /// A parameter out of range.
    #[error("[slices] {name} = {value}, expected {expected}")]
    Parameter {
        /// The key in pipeline.toml.
        name: &'static str,
        /// What it is.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// The method needs a seed.
    #[error(
        "[slices] method = \"bone\" needs seed_mm = [x, y, z], a point in the bone's marrow, mm (left-posterior-superior)"
    )]
    NoSeed,
    /// Samples and sizes do not agree.
    #[error(
        "a volume of {size:?} voxels with {samples} samples; it needs at least one voxel and a sample for each"
    )]
    Size {
        /// Columns, rows, slices.
        size: [usize; 3],
        /// Samples there are.
        samples: usize,
    },
    /// A sample is NaN or infinite.
    #[error("slice {slice} has a sample that is not a finite number")]
    Sample {
        /// Number of the slice, from 0.
        slice: usize,
    },
    /// Rows and columns are not at right angles or have no length.
    #[error(
        "the volume's steps are {column:?} mm along a row and {row:?} mm along a column; they have to be at right angles, \
             each 1e-6 to 1000 mm long"
    )]
    Steps {
        /// Along a row.
        column: [f64; 3],
        /// Along a column.
        row: [f64; 3],
    },
    /// Slices that do not lie behind each other.
    #[error(
        "slice {slice} does not lie behind the one before it; sort the volume's slices along their normal"
    )]
    Order {
        /// Number of the slice, from 0.
        slice: usize,
    },
    /// Slices that cannot be cut another way.
    #[error(
        "the {slices} slices are not at one distance behind each other, so the volume can only be cut as it is stored: \
             set across = \"stored\" in [slices]"
    )]
    Uneven {
        /// How many there are.
        slices: usize,
    },
    /// No voxel has the label.
    #[error(
        "no voxel has the label {label}; the volume has the labels {present}; set label in [slices] to one of them"
    )]
    NoLabel {
        /// As asked for.
        label: u32,
        /// Those there are.
        present: String,
    },
    /// The seed is not in the volume.
    #[error(
        "seed_mm = {seed:?} lies outside of the volume, which reaches from {low:?} to {high:?} mm \
             (left-posterior-superior, along x, y, z); give a point in the bone's marrow"
    )]
    SeedOutside {
        /// As given.
        seed: [f64; 3],
        /// Smallest coordinates of the volume, whole mm.
        low: [i64; 3],
        /// Largest coordinates of the volume, whole mm.
        high: [i64; 3],
    },
    /// Nothing like a bone is around the seed.
    #[error(
        "around seed_mm = {seed:?} {found}; move the seed into the middle of the marrow, or change {change} in [slices]"
    )]
    NoBone {
        /// As given.
        seed: [f64; 3],
        /// What is there instead.
        found: String,
        /// Keys that may help.
        change: &'static str,
    },
    /// The run was cancelled.
    #[error("cancelled")]
    Cancelled,
}

impl SlicesParams {
    /// # Errors
    /// Names the first parameter that is out of its range.
    pub fn check(&self) -> Result<(), SlicesError> {
        let Self {
            method,
            across: _,
            label,
            smoothing_px,
            seed_mm,
            contrast: _,
            shell_mm,
            tolerance,
            leak_mm,
        } = *self;
        let bad = |name, value, expected| Err(SlicesError::Parameter { name, value, expected });
        if method == Method::Labels && !(1..=65535).contains(&label) {
            return bad("label", f64::from(label), "the bone's number in the map of labels, 1 to 65535");
        }
        if !(0.3..=3.0).contains(&smoothing_px) {
            return bad("smoothing_px", smoothing_px, "0.3 to 3 px");
        }
        match seed_mm {
            None if method == Method::Bone => return Err(SlicesError::NoSeed),
            Some(seed) => {
                if let Some(&value) = seed.iter().find(|v| !(-1e5..=1e5).contains(*v)) {
                    return bad("seed_mm", value, "three numbers of at most 100000 mm");
                }
            }
            None => {}
        }
        if !(0.5..=30.0).contains(&shell_mm) {
            return bad("shell_mm", shell_mm, "0.5 to 30 mm");
        }
        if !(0.02..=0.6).contains(&tolerance) {
            return bad("tolerance", tolerance, "0.02 to 0.6");
        }
        if !(0.0..=20.0).contains(&leak_mm) {
            return bad("leak_mm", leak_mm, "0 to 20 mm");
        }
        Ok(())
    }
}

/// The stage `slices`.
#[derive(Debug, Clone, Copy)]
pub struct Slices;

impl Stage for Slices {
    const NAME: &'static str = "slices";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = SlicesInputs;
    type Params = SlicesParams;
    type Output = SliceContours;
    type Error = SlicesError;

    fn run(
        inputs: &SlicesInputs,
        params: &SlicesParams,
        context: &Context,
    ) -> Result<SliceContours, SlicesError> {
        slice_contours(&inputs.volume, params, context)
    }
}

/// The contours of one bone in each slice of a volume.
///
/// # Errors
/// A parameter out of range, a volume that is no stack of slices, no such label, a seed that is not in a bone, or that the
/// context was cancelled.
pub fn slice_contours(
    volume: &Volume,
    params: &SlicesParams,
    context: &Context,
) -> Result<SliceContours, SlicesError> {
    params.check()?;
    let volume = turned(volume, params.across)?;
    let stack = Stack::of(&volume)?;
    let mut seed_at = None;
    let (rings, mut warnings) = match (params.method, params.seed_mm) {
        (Method::Bone, Some(seed)) => {
            let at = place_of_seed(&volume, &stack, seed)?;
            seed_at = Some(at);
            let found = bone::contours(&volume, &stack, at, seed, params, context)?;
            (found.slices, found.warnings)
        }
        _ => {
            let found = labels::contours(&volume, &stack, params.label, params.smoothing_px, context)?;
            (found, Vec::new())
        }
    };
    let slices = volume.origins_mm.iter().zip(rings).map(|(&origin_mm, found)| ContourSlice {
        origin_mm,
        contours: found.rings.into_iter().map(|points| SliceContour { points }).collect(),
        flags: if found.unclear { vec![SliceFlag::Unclear] } else { Vec::new() },
        edited: false,
    });
    let mut contours = SliceContours {
        columns: volume.columns,
        rows: volume.rows,
        column_step_mm: volume.column_step_mm,
        row_step_mm: volume.row_step_mm,
        slices: slices.collect(),
        warnings: Vec::new(),
    };
    review::flag(&mut contours, stack.pixel_mm, &stack.heights_mm);
    if let Some(([i, j], k)) = seed_at {
        let slice = &mut contours.slices[k];
        let turns = |c: &SliceContour| {
            ring::winding(&c.points.iter().map(|p| [p.i, p.j]).collect::<Vec<_>>(), [i, j])
        };
        if slice.contours.iter().map(turns).sum::<i32>() < 1 {
            slice.flags.push(SliceFlag::SeedOutside);
        }
    }
    warnings.extend(sheared(&volume));
    contours.warnings = warnings;
    Ok(contours)
}

/// The contours of one slice.
#[derive(Debug, Clone, Default)]
pub(crate) struct Found {
    /// Closed, in order, in the sense of [`SliceContour`].
    pub rings: Vec<Vec<SlicePoint>>,
    /// Whether much of them has no edge.
    pub unclear: bool,
}

/// A place in a slice, px, and the number of the slice.
pub(crate) type SeedPlace = ([f64; 2], usize);

fn place_of_seed(volume: &Volume, stack: &Stack, seed: [f64; 3]) -> Result<SeedPlace, SlicesError> {
    let [u, v] = [volume.column_step_mm, volume.row_step_mm].map(Vector3::from);
    let normal = u.cross(&v).normalize();
    let from = |k: usize| Vector3::from(seed) - Vector3::from(volume.origins_mm[k]);
    let off = |k: usize| from(k).dot(&normal).abs();
    let nearest = (0..stack.size[2]).min_by(|&a, &b| off(a).total_cmp(&off(b))).unwrap_or(0);
    let place = [u, v].map(|step| from(nearest).dot(&step) / step.norm_squared());
    let inside = (0..2).all(|a| place[a] >= -0.5 && place[a] <= stack.size[a] as f64 - 0.5);
    if inside && off(nearest) <= stack.thickness_mm(nearest) {
        return Ok((place, nearest));
    }
    let ends = [0.0, stack.size[0] as f64 - 1.0];
    let sides = [0.0, stack.size[1] as f64 - 1.0];
    let corners: Vec<[f64; 3]> = [0, stack.size[2] - 1]
        .into_iter()
        .flat_map(|k| ends.into_iter().flat_map(move |i| sides.into_iter().map(move |j| (i, j, k))))
        .filter_map(|(i, j, k)| volume.place_mm(i, j, k))
        .collect();
    let least = |a: usize| corners.iter().map(|c| c[a]).fold(f64::INFINITY, f64::min);
    let most = |a: usize| corners.iter().map(|c| c[a]).fold(f64::NEG_INFINITY, f64::max);
    Err(SlicesError::SeedOutside {
        seed,
        low: std::array::from_fn(|a| least(a).floor() as i64),
        high: std::array::from_fn(|a| most(a).ceil() as i64),
    })
}

/// Slices that are shifted against each other: neighbours are then not those that this takes for them.
fn sheared(volume: &Volume) -> Option<String> {
    let [u, v] = [volume.column_step_mm, volume.row_step_mm].map(Vector3::from);
    let (first, last) = (volume.origins_mm.first()?, volume.origins_mm.last()?);
    let across = Vector3::from(*last) - Vector3::from(*first);
    let shift = [u, v].map(|step| across.dot(&step.normalize()) / across.norm().max(f64::MIN_POSITIVE));
    let degrees = shift[0].hypot(shift[1]).min(1.0).asin().to_degrees();
    (degrees > 3.0).then(|| {
        format!(
            "the slices are not stacked along their normal but {degrees:.0} degrees off it (a tilted gantry?): places are \
             right, but a bone is followed from slice to slice as if they were"
        )
    })
}
