//! Ideal outlines that another program made (`fixtures/scene`): polygons in mm on the detector, of a finer mesh than the
//! one that is matched, or of the very same one where only the search is looked at; and the offsets of its start poses.

use std::path::Path;

use biplane_acquisition::meshes::{LengthUnit, read_mesh};
use biplane_artifact::Curves;
use biplane_geometry::{Curve, EdgePoint, Point2, Pose, Vector2, Vector3};
use biplane_optimisation::MatchParams;
use biplane_phantom::TrueFluoroscope;
use nalgebra::Matrix4;
use serde::Deserialize;

use crate::scene::{Claim, Made, Origin};
use crate::{Scene, SceneError};

#[derive(Deserialize)]
struct File {
    views: Vec<FileView>,
    objects: std::collections::BTreeMap<String, FileObject>,
    start_offsets: std::collections::BTreeMap<String, Vec<[f64; 6]>>,
}

#[derive(Deserialize)]
struct FileView {
    name: String,
    source: [f64; 3],
    centre: [f64; 3],
    u: [f64; 3],
    v: [f64; 3],
    pixel: f64,
    size: [usize; 2],
}

#[derive(Deserialize)]
struct FileObject {
    poses: Vec<FilePose>,
}

#[derive(Deserialize)]
struct FilePose {
    matrix: [[f64; 4]; 4],
}

/// Distance of the points that stand for an outline, px.
const STEP_PX: f64 = 0.5;

/// A closed polygon in ideal pixels as edge points: directions point out of it whichever way it runs.
pub fn polygon_curve(corners: &[Point2]) -> Curve {
    let next = |i: usize| corners[(i + 1) % corners.len()];
    let twice_area: f64 = corners.iter().enumerate().map(|(i, p)| p.x * next(i).y - next(i).x * p.y).sum();
    let mut points = Vec::new();
    for (i, p) in corners.iter().enumerate() {
        let side = next(i) - p;
        let length = side.norm();
        if length == 0.0 {
            continue;
        }
        let direction = Vector2::new(side.y, -side.x) * (twice_area.signum() / length);
        let parts = (length / STEP_PX).ceil() as usize;
        points.extend((0..parts).map(|k| EdgePoint {
            position: p + side * ((k as f64 + 0.5) / parts as f64),
            direction,
            strength: 1.0,
            sigma_px: 0.01,
        }));
    }
    Curve { points, closed: true }
}

/// The bodies of `fixtures/scene`.
pub const BODIES: [&str; 2] = ["bone", "implant"];

fn bad(path: &Path, what: impl std::fmt::Display) -> SceneError {
    SceneError::Mesh(format!("{}: {what}", path.display()))
}

fn described(folder: &Path) -> Result<File, SceneError> {
    let path = folder.join("scene.json");
    let text = std::fs::read_to_string(&path).map_err(|e| bad(&path, e))?;
    serde_json::from_str(&text).map_err(|e| bad(&path, e))
}

/// Offsets of the thesis's pose variables about the model's origin (mm, degrees) from the truth's, for start poses: set A, set B.
///
/// # Errors
/// The file cannot be read, or has no such sets.
pub fn offsets(root: &Path) -> Result<[Vec<[f64; 6]>; 2], SceneError> {
    let folder = root.join("fixtures/scene");
    let mut sets = described(&folder)?.start_offsets;
    let mut set = |name: &str| {
        sets.remove(name).ok_or_else(|| bad(&folder.join("scene.json"), format!("no start_offsets.{name}")))
    };
    Ok([set("A_truncated_gauss_sigma10_clip20")?, set("B_gauss_sigma20")?])
}

/// A body of `fixtures/scene` below `root`: outlines of its mesh of `outlines` points, its mesh of `points` to be matched.
/// Where they are one mesh, the scene claims no accuracy.
///
/// # Errors
/// A file cannot be read, or is something else.
pub fn scene(
    root: &Path,
    body: &str,
    outlines: usize,
    points: usize,
    params: &MatchParams,
) -> Result<Scene, SceneError> {
    let folder = root.join("fixtures/scene");
    let path = folder.join("scene.json");
    let file = described(&folder)?;
    let views: Vec<TrueFluoroscope> = file
        .views
        .iter()
        .map(|v| TrueFluoroscope {
            source: v.source.into(),
            centre: v.centre.into(),
            along_x: Vector3::from(v.u),
            along_y: Vector3::from(v.v),
            pixel_mm: v.pixel,
            size: v.size,
        })
        .collect();
    let object = file.objects.get(body).ok_or_else(|| bad(&path, format!("no object `{body}`")))?;
    let mut frames = Vec::new();
    for (number, pose) in object.poses.iter().enumerate() {
        let matrix = Matrix4::from_fn(|i, j| pose.matrix[i][j]);
        let truth = Pose::from_matrix(&matrix).ok_or_else(|| bad(&path, format!("pose {number}")))?;
        let mut curves = Vec::new();
        for (view, seen) in file.views.iter().zip(&views) {
            let path = folder.join(format!("sil_{body}_{outlines}_pose{number}_{}.csv", view.name));
            let mut reader =
                csv::ReaderBuilder::new().has_headers(false).from_path(&path).map_err(|e| bad(&path, e))?;
            let middle = seen.size.map(|n| (n as f64 - 1.0) / 2.0);
            let corners = reader
                .deserialize::<(f64, f64)>()
                .map(|row| {
                    row.map(|(a, b)| Point2::new(middle[0] + a / view.pixel, middle[1] + b / view.pixel))
                })
                .collect::<Result<Vec<_>, _>>()
                .map_err(|e| bad(&path, e))?;
            curves.push(Curves(vec![polygon_curve(&corners)]));
        }
        frames.push((format!("pose {number}"), truth, curves));
    }
    let mesh = folder.join(format!("{body}_{points}.stl"));
    let mesh =
        read_mesh(&mesh, Some(LengthUnit::Millimetres)).map_err(|e| SceneError::Mesh(e.to_string()))?.model.0;
    let names: Vec<String> = file.views.iter().map(|v| v.name.clone()).collect();
    let made = match outlines == points {
        true => Made { origin: Origin::mesh(&mesh), claim: Claim::SearchAlone, params: params.clone() },
        false => Made { origin: Origin::OtherFile, claim: Claim::Accuracy, params: params.clone() },
    };
    let calibrations: Vec<_> = views.iter().zip(&names).map(|(v, name)| v.calibration(name)).collect();
    Scene::made(made, &mesh, &calibrations, frames)
}
