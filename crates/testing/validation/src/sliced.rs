//! Slices of the phantom's bodies: cut exactly out of a fine mesh, as maps of labels, and as a scanner finds them; and the surfaces that
//! the product's own stages make of them.
//!
//! Exact contours come from the mesh of 200,000 points, which lies within 0.001 mm of the solid where that is smooth.

use std::collections::HashMap;

use biplane_artifact::{
    BoneSurface, ContourSlice, ModelMesh, SliceContour, SliceContours, SlicePoint, Volume,
};
use biplane_geometry::{Mesh, Point3, Rigid};
use biplane_label_surface::{LabelSurface, LabelSurfaceInputs, LabelSurfaceParams};
use biplane_lofting::{Loft, LoftInputs, LoftParams};
use biplane_phantom::{Body, MriFaults, MriScene, ScannedBone, SliceGrid, Solid, TissueLevels, gradient};
use biplane_point_model::{Model, ModelInputs, ModelParams};
use biplane_slices::{Method, SlicesParams, slice_contours};
use biplane_stage::{Context, Hashed, Stage};
use biplane_surface::spread_points;

use crate::SceneError;

/// Room around a body in its stack of slices, mm.
const MARGIN_MM: f64 = 8.0;
/// A point in the marrow of each bone, model coordinates, mm.
fn marrow(body: Body) -> Point3 {
    match body {
        Body::ProximalTibia => Point3::new(0.0, 0.0, 20.0),
        _ => Point3::new(0.0, 0.0, -10.0),
    }
}

fn fault(error: impl std::fmt::Display) -> SceneError {
    SceneError::Mesh(error.to_string())
}

/// The contours in which planes `slice_mm` apart cut a closed mesh, with points `step_mm` apart: across x, as sagittal slices are.
/// `i` runs along y and `j` along z.
pub fn cut(mesh: &Mesh, slice_mm: f64, step_mm: f64) -> SliceContours {
    let (low, high) = mesh.bounding_box();
    // Not on the mesh's own symmetric places, and at another place for each distance.
    let first = low.x - 1.5 * slice_mm + 0.123_456_7 * slice_mm;
    let count = ((high.x - first) / slice_mm).ceil() as usize + 1;
    let slices = (0..count).map(|k| {
        let x = first + k as f64 * slice_mm;
        let contours = section(mesh, x).into_iter().map(|ring| {
            let even = evenly(&ring, step_mm);
            SliceContour { points: even.into_iter().map(|[y, z]| SlicePoint::rounded(y, z, 0.0)).collect() }
        });
        let contours = contours.filter(|c| c.points.len() > 2).collect();
        ContourSlice { origin_mm: [x, 0.0, 0.0], contours, flags: Vec::new(), edited: false }
    });
    SliceContours {
        columns: 1,
        rows: 1,
        column_step_mm: [0.0, 1.0, 0.0],
        row_step_mm: [0.0, 0.0, 1.0],
        slices: slices.collect(),
        warnings: Vec::new(),
    }
}

/// An edge of a mesh from the vertex below the plane to the one above it.
type Edge = (u32, u32);

/// The closed lines in which a plane of constant x cuts a closed mesh, `(y, z)`, with the body on the left of each: so a contour is
/// counter-clockwise and a hole is not.
fn section(mesh: &Mesh, x: f64) -> Vec<Vec<[f64; 2]>> {
    let above = |v: u32| mesh.vertices()[v as usize].x > x;
    let mut next: HashMap<Edge, (Edge, [f64; 2])> = HashMap::new();
    let mut begins = Vec::new();
    for triangle in mesh.triangles() {
        // One edge goes up through the plane and one goes down.
        let edges = (0..3).map(|k| (triangle[k], triangle[(k + 1) % 3]));
        let (mut up, mut down) = (None, None);
        for (a, b) in edges {
            match (above(a), above(b)) {
                (false, true) => up = Some((a, b)),
                (true, false) => down = Some((b, a)),
                _ => {}
            }
        }
        // Seen from outside and along x, the body lies to the left of the way from the edge that goes down to the one that goes up.
        if let (Some(up), Some(down)) = (up, down) {
            let [p, q] = [down.0, down.1].map(|v| mesh.vertices()[v as usize]);
            let at = p + (q - p) * ((x - p.x) / (q.x - p.x));
            next.insert(down, (up, [at.y, at.z]));
            begins.push(down);
        }
    }
    let mut rings = Vec::new();
    for begin in begins {
        let (mut at, mut ring) = (begin, Vec::new());
        while let Some((to, place)) = next.remove(&at) {
            ring.push(place);
            at = to;
        }
        if ring.len() > 2 {
            rings.push(ring);
        }
    }
    rings
}

/// Points about `step` apart along a closed line.
fn evenly(ring: &[[f64; 2]], step: f64) -> Vec<[f64; 2]> {
    let sides = || ring.iter().zip(ring.iter().cycle().skip(1));
    let length = |(a, b): (&[f64; 2], &[f64; 2])| (b[0] - a[0]).hypot(b[1] - a[1]);
    let whole: f64 = sides().map(length).sum();
    let count = (whole / step).round().max(3.0);
    let (mut passed, mut points) = (0.0, Vec::new());
    for (a, b) in sides() {
        let own = length((a, b));
        while (points.len() as f64) < count && points.len() as f64 * whole / count <= passed + own {
            let t = (points.len() as f64 * whole / count - passed) / own.max(f64::MIN_POSITIVE);
            points.push([a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]);
        }
        passed += own;
    }
    points
}

fn volume(grid: &SliceGrid, samples: Vec<f32>) -> Volume {
    let step = |a: usize| (grid.axes[a] * grid.spacing_mm[a]).into();
    Volume {
        columns: grid.size[0],
        rows: grid.size[1],
        column_step_mm: step(0),
        row_step_mm: step(1),
        origins_mm: (0..grid.size[2]).map(|k| grid.position([0.0, 0.0, k as f64]).coords.into()).collect(),
        samples,
    }
}

/// A map in which label 1 is every voxel that a solid fills by half or more, in sagittal slices.
///
/// # Errors
/// The stack is too large.
pub fn labels(solid: &dyn Solid, pixel_mm: f64, slice_mm: f64) -> Result<Volume, SceneError> {
    let grid = SliceGrid::covering(solid.bounds(), MARGIN_MM, 0, pixel_mm, slice_mm);
    let filled = grid.filled(solid, &Rigid::identity()).map_err(fault)?;
    Ok(volume(&grid, filled.into_iter().map(|f| if f >= 0.5 { 1.0 } else { 0.0 }).collect()))
}

/// Contours of a map of labels.
///
/// # Errors
/// The stage's own.
pub fn contours_of_labels(volume: &Volume) -> Result<SliceContours, SceneError> {
    let params = SlicesParams { label: 1, ..SlicesParams::default() };
    slice_contours(volume, &params, &Context::new()).map_err(fault)
}

/// Contours of a bone in a simulated MRI of sagittal slices with the usual faults, found from one seed in its marrow.
///
/// # Errors
/// The body is no bone, or the stage's own.
pub fn contours_of_mri(
    body: Body,
    pixel_mm: f64,
    slice_mm: f64,
    seed: u64,
) -> Result<SliceContours, SceneError> {
    let inner = body.inner().ok_or_else(|| fault(format!("{} has no marrow", body.name())))?;
    let bone = ScannedBone {
        outer: body.solid(),
        inner,
        cartilage: None,
        scanner_from_model: Rigid::identity(),
        label: 1,
    };
    let scene = MriScene { bones: vec![bone], limb: None, levels: TissueLevels::default() };
    let grid = SliceGrid::covering(body.solid().bounds(), MARGIN_MM, 0, pixel_mm, slice_mm);
    let stack = scene.scan(&grid, &MriFaults::usual(seed)).map_err(fault)?;
    let stack = volume(&grid, stack.samples.iter().map(|&s| f32::from(s)).collect());
    let at = Some(marrow(body).coords.into());
    let params = SlicesParams { method: Method::Bone, seed_mm: at, ..SlicesParams::default() };
    slice_contours(&stack, &params, &Context::new()).map_err(fault)
}

/// The surface that the stage makes of contours.
///
/// # Errors
/// The stage's own.
pub fn loft(contours: &SliceContours, params: &LoftParams) -> Result<BoneSurface, SceneError> {
    let inputs = LoftInputs { contours: Hashed::new(contours.clone()) };
    Loft::run(&inputs, params, &Context::new()).map_err(fault)
}

/// The surface that the stage makes of label 1 of a map.
///
/// # Errors
/// The stage's own.
pub fn label_surface(volume: &Volume) -> Result<BoneSurface, SceneError> {
    let inputs = LabelSurfaceInputs { volume: Hashed::new(volume.clone()) };
    let params = LabelSurfaceParams { label: 1, ..LabelSurfaceParams::default() };
    LabelSurface::run(&inputs, &params, &Context::new()).map_err(fault)
}

/// The model of so many points that the stage makes of a surface.
///
/// # Errors
/// The stage's own.
pub fn model(surface: BoneSurface, points: u32) -> Result<Mesh, SceneError> {
    let inputs = ModelInputs { mesh: Vec::new(), surface: vec![Hashed::new(surface)] };
    let params = ModelParams { points, ..ModelParams::default() };
    let ModelMesh(mesh) = Model::run(&inputs, &params, &Context::new()).map_err(fault)?;
    Ok(mesh)
}

/// Points of a surface that are looked at.
const LOOKED_AT: usize = 20_000;

/// Signed distances of points spread evenly over a mesh from a solid's surface, mm, with each point.
pub fn distances(mesh: &Mesh, solid: &dyn Solid) -> Vec<(Point3, f64)> {
    let signed = |p: Point3| (p, solid.value(&p) / gradient(solid, &p).norm().max(0.1));
    spread_points(mesh, LOOKED_AT).into_iter().map(signed).collect()
}
