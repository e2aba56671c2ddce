//! The stage `label_surface`: a map of labels in, the surface of one label out.

use std::collections::BTreeSet;

use biplane_artifact::{BoneSurface, SurfaceReport, Volume};
use biplane_geometry::Mesh;
use biplane_stage::{Context, Stage, inputs};
use biplane_surface::MeshCheck;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::faults::faults;
use crate::field::Field;
use crate::net::net;
use crate::parts::{Mask, Piece};
use crate::stack::Stack;

/// The method's name in reports.
const METHOD: &str = "labels";
/// Most labels that an error names.
const MOST_NAMED: usize = 20;
/// Most pieces that a warning names.
const MOST_PIECES: usize = 8;
/// Share of the volume by which the surface's may differ before the level is moved.
const VOLUME: f64 = 2e-5;
/// The level is moved no farther than this from one half.
const MOST_LEVEL: f64 = 0.15;
/// Surfaces that are tried for it.
const TRIES: usize = 5;
/// Slices this many times as thick as a pixel want lofting.
const THICK: f64 = 3.0;

inputs! {
    /// One map of labels.
    pub struct LabelSurfaceInputs {
        volume: Volume,
    }
}

/// Which pieces of a label are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Keep {
    /// The largest one, with hollows in it filled. What was left out is warned of.
    #[default]
    Largest,
    /// All, with their hollows.
    All,
}

/// Which label, and how it is made smooth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct LabelSurfaceParams {
    /// The bone's number in the map of labels. 1 to 65535.
    #[schemars(range(max = 65535))]
    pub label: u32,
    /// How far the surface is smoothed, mm: standard deviation of the kernel. Along each direction it is never less than 0.6 of the
    /// voxels' distance, below which their stairs remain. 0 to 10.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub smoothing_mm: f64,
    /// Which pieces of the label are kept.
    pub keep: Keep,
}

impl Default for LabelSurfaceParams {
    fn default() -> Self {
        Self { label: 0, smoothing_mm: 1.0, keep: Keep::Largest }
    }
}

/// Why a label has no surface.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LabelSurfaceError {
    /// A parameter out of range.
    #[error("[label_surface] {name} = {value}, expected {expected}")]
    Parameter {
        /// The key in pipeline.toml.
        name: &'static str,
        /// What it is.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
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
    /// No voxel has the label.
    #[error("no voxel has the label {label}; the volume has the labels {present}; set label to one of them")]
    NoLabel {
        /// As asked for.
        label: u32,
        /// Those there are.
        present: String,
    },
    /// Nothing is left of the label once it is smooth.
    #[error(
        "nothing is left of label {label} ({voxels} voxels) when it is smoothed by {smoothing_mm} mm; set smoothing_mm to less, \
             or choose another label: one as thin as a voxel has no surface"
    )]
    Vanished {
        /// As asked for.
        label: u32,
        /// Voxels it has.
        voxels: usize,
        /// As asked for.
        smoothing_mm: f64,
    },
    /// The run was cancelled.
    #[error("cancelled")]
    Cancelled,
}

impl LabelSurfaceParams {
    /// # Errors
    /// Names the first parameter that is out of its range.
    pub fn check(&self) -> Result<(), LabelSurfaceError> {
        let Self { label, smoothing_mm, keep: _ } = *self;
        let bad = |name, value, expected| Err(LabelSurfaceError::Parameter { name, value, expected });
        if !(1..=65535).contains(&label) {
            return bad("label", f64::from(label), "the bone's number in the map of labels, 1 to 65535");
        }
        if !(0.0..=10.0).contains(&smoothing_mm) {
            return bad("smoothing_mm", smoothing_mm, "0 to 10 mm");
        }
        Ok(())
    }
}

/// The stage `label_surface`.
#[derive(Debug, Clone, Copy)]
pub struct LabelSurface;

impl Stage for LabelSurface {
    const NAME: &'static str = "label_surface";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = LabelSurfaceInputs;
    type Params = LabelSurfaceParams;
    type Output = BoneSurface;
    type Error = LabelSurfaceError;

    fn run(
        inputs: &LabelSurfaceInputs,
        params: &LabelSurfaceParams,
        context: &Context,
    ) -> Result<BoneSurface, LabelSurfaceError> {
        label_surface(&inputs.volume, params, context)
    }
}

/// The surface of one label, in the scanner's frame.
///
/// # Errors
/// A parameter out of range, a volume that is no stack of slices, no such label, one of which nothing is left, or that the context
/// was cancelled.
pub fn label_surface(
    volume: &Volume,
    params: &LabelSurfaceParams,
    context: &Context,
) -> Result<BoneSurface, LabelSurfaceError> {
    params.check()?;
    let LabelSurfaceParams { label, smoothing_mm, keep } = *params;
    let stack = Stack::of(volume)?;
    let Some(mut mask) = Mask::of(volume, &stack, label) else {
        return Err(LabelSurfaceError::NoLabel { label, present: present(volume) });
    };
    let mut warnings = pieces_and_hollows(&mut mask, &stack, keep);
    warnings.extend(at_the_border(&mask, &stack));
    let cancelled = || if context.cancelled() { Err(LabelSurfaceError::Cancelled) } else { Ok(()) };
    cancelled()?;
    let field = Field::of(&mask, &stack, smoothing_mm);
    cancelled()?;
    let unsmoothed_volume_mm3 = mask.volume_mm3(&stack);
    let voxels = mask.inside.iter().filter(|v| **v == 1).count();
    let vanished = || LabelSurfaceError::Vanished { label, voxels, smoothing_mm };
    let mut mesh = of_volume(&field, &stack, unsmoothed_volume_mm3).ok_or_else(vanished)?;
    cancelled()?;
    if field.coarser {
        let step = field.lines[0].step;
        warnings.push(format!("the label is so large that the surface has a point every {step:.2} mm only"));
    }
    let mut check = MeshCheck::of(&mesh);
    if keep == Keep::Largest && check.pieces > 1 {
        let (kept, left_out) = largest(&mesh, &check);
        warnings.push(format!(
            "smoothed, the label falls into {} pieces; the largest is kept, the others ({left_out:.1} mm^3) are left out",
            check.pieces
        ));
        if let Some(kept) = kept {
            mesh = kept;
            check = MeshCheck::of(&mesh);
        }
    }
    let volume_mm3 = check.signed_volume_mm3;
    let change = 100.0 * (volume_mm3 / unsmoothed_volume_mm3 - 1.0);
    if change.abs() > 1.0 {
        warnings
            .push(format!("smoothing changed the volume by {change:.1} %: parts are as thin as it reaches"));
    }
    let report = SurfaceReport {
        method: METHOD.to_owned(),
        slices: mask.slices(),
        contours: 0,
        volume_mm3,
        unsmoothed_volume_mm3,
        area_mm2: check.area_mm2,
        pieces: check.pieces,
        faults: faults(&mesh, &check, &stack),
        warnings,
    };
    Ok(BoneSurface { mesh, report })
}

/// The surface at the level, near one half, at which it encloses a volume; found by secants.
fn of_volume(field: &Field, stack: &Stack, wanted_mm3: f64) -> Option<Mesh> {
    let excess = |m: &Mesh| m.signed_volume() / wanted_mm3 - 1.0;
    let mut level = 0.5;
    let mut best = net(field, stack, level as f32)?;
    let mut off = excess(&best);
    // A higher level has less inside; the first step takes the field to fall by 1 over the thickness of a shell.
    let mut slope = -1.0;
    for _ in 1..TRIES {
        if off.abs() <= VOLUME {
            break;
        }
        let next = (level - off / slope).clamp(0.5 - MOST_LEVEL, 0.5 + MOST_LEVEL);
        let Some(tried) = net(field, stack, next as f32) else { break };
        let next_off = excess(&tried);
        let next_slope = (next_off - off) / (next - level);
        let better = next_off.abs() < off.abs();
        if next_slope < 0.0 {
            slope = next_slope;
        }
        if !better {
            break;
        }
        (best, level, off) = (tried, next, next_off);
    }
    Some(best)
}

/// The piece of a mesh that encloses most, and the volume of the others.
fn largest(mesh: &Mesh, check: &MeshCheck) -> (Option<Mesh>, f64) {
    let origin = mesh.vertices()[0];
    let mut volumes = vec![0.0; check.pieces];
    for (t, piece) in check.piece_of.iter().enumerate() {
        let [a, b, c] = mesh.corners(t).map(|p| p - origin);
        volumes[*piece as usize] += a.cross(&b).dot(&c) / 6.0;
    }
    let kept = (0..volumes.len()).fold(0, |k, n| if volumes[n] > volumes[k] { n } else { k });
    let mut number = vec![u32::MAX; mesh.vertices().len()];
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    for (corners, _) in mesh.triangles().iter().zip(&check.piece_of).filter(|(_, p)| **p as usize == kept) {
        triangles.push(corners.map(|v| {
            let number = &mut number[v as usize];
            if *number == u32::MAX {
                *number = vertices.len() as u32;
                vertices.push(mesh.vertices()[v as usize]);
            }
            *number
        }));
    }
    (Mesh::new(vertices, triangles).ok(), volumes.iter().sum::<f64>() - volumes[kept])
}

/// Leaves what is to be kept, and says what else there is.
fn pieces_and_hollows(mask: &mut Mask, stack: &Stack, keep: Keep) -> Vec<String> {
    let mut warnings = Vec::new();
    match keep {
        Keep::Largest => {
            let others = mask.keep_largest(stack);
            if !others.is_empty() {
                warnings.push(format!("pieces beside the largest are left out: {}", named(&others)));
            }
            let hollows = mask.hollows(stack, true);
            if !hollows.is_empty() {
                warnings.push(format!("hollows inside are filled: {}", named(&hollows)));
            }
        }
        Keep::All => {
            let pieces = mask.listed(stack);
            if pieces.len() > 1 {
                warnings.push(format!("the label is in {} pieces: {}", pieces.len(), named(&pieces)));
            }
            let hollows = mask.hollows(stack, false);
            if !hollows.is_empty() {
                warnings.push(format!("there are hollows inside: {}", named(&hollows)));
            }
        }
    }
    warnings
}

/// Pieces as a person reads them, the largest first.
fn named(pieces: &[Piece]) -> String {
    let mut sorted: Vec<&Piece> = pieces.iter().collect();
    sorted.sort_by_key(|p| std::cmp::Reverse(p.voxels));
    let one = |p: &&Piece| {
        let [from, to] = p.slices;
        let slices = if from == to { format!("slice {from}") } else { format!("slices {from} to {to}") };
        let voxels = if p.voxels == 1 { "voxel" } else { "voxels" };
        format!("{} {voxels} ({:.2} mm^3) in {slices}", p.voxels, p.volume_mm3)
    };
    let mut words: Vec<String> = sorted.iter().take(MOST_PIECES).map(one).collect();
    if let Some(rest) = sorted.get(MOST_PIECES..).filter(|r| !r.is_empty()) {
        let voxels: usize = rest.iter().map(|p| p.voxels).sum();
        words.push(format!("and {} more of {voxels} voxels together", rest.len()));
    }
    words.join(", ")
}

/// Where the label goes on beyond the volume, and slices that are thick.
fn at_the_border(mask: &Mask, stack: &Stack) -> Vec<String> {
    let mut warnings = Vec::new();
    let ends = [
        ["the first column", "the last column"],
        ["the first row", "the last row"],
        ["the first slice", "the last slice"],
    ];
    let touched: Vec<&str> = mask
        .touches(stack)
        .iter()
        .flatten()
        .zip(ends.iter().flatten())
        .filter_map(|(touches, name)| touches.then_some(*name))
        .collect();
    if !touched.is_empty() {
        warnings.push(format!(
            "the label reaches {} of the volume and is cut off there: the surface is closed by a flat lid",
            touched.join(", ")
        ));
    }
    let slices = mask.low[2]..mask.low[2] + mask.size[2];
    let thickest = slices.map(|k| stack.thickness_mm(2, k)).fold(0.0, f64::max);
    let longest = thickest.max(stack.pixel_mm[0]).max(stack.pixel_mm[1]);
    let shortest = thickest.min(stack.pixel_mm[0]).min(stack.pixel_mm[1]);
    if longest > THICK * shortest {
        warnings.push(format!(
            "voxels are {longest:.2} mm long and {shortest:.2} mm wide: where the surface runs along the slices it shows their \
             stairs; lofted contours follow it better"
        ));
    }
    warnings
}

/// The labels that there are, as a person reads them.
fn present(volume: &Volume) -> String {
    let whole = |s: &&f32| (1.0..=65535.0).contains(*s) && s.fract() == 0.0;
    let labels: BTreeSet<u16> = volume.samples.iter().filter(whole).map(|&s| s as u16).collect();
    if labels.is_empty() {
        return "none above 0".to_owned();
    }
    let mut named: Vec<String> = labels.iter().take(MOST_NAMED).map(u16::to_string).collect();
    if labels.len() > MOST_NAMED {
        named.push(format!("and {} more (is it a map of labels?)", labels.len() - MOST_NAMED));
    }
    named.join(", ")
}
