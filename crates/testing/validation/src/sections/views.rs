//! Tables 5.3 to 5.5: one view against two, outline and model of one mesh.

use std::sync::Arc;

use biplane_artifact::Curves;
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Mesh, Point3, Pose, Twist, Vector3};
use biplane_optimisation::{BinghamParams, MatchParams};
use biplane_outline::{Outline, RimMesh, Sampling};
use biplane_phantom::{Body, TrueFluoroscope, ball_mesh, biplane};
use nalgebra::UnitQuaternion;

use super::SectionError;
use crate::knee::Posture;
use crate::lab::{Frames, calibrations, ideal_params, thesis_params};
use crate::outcome::{Method, Outcome, by_plane, outcomes, outline_curves};
use crate::plot::{Panel, Series, lines};
use crate::scene::{Claim, Made, Origin};
use crate::{Cell, Column, Lab, Row, Scene, SceneError, Section, Spread, Table, set_a};

/// The thesis's tolerances.
const TOLERANCES: [f64; 4] = [0.05, 0.005, 0.0005, 0.000_005];
/// Table 5.3: one view in plane and out of plane, two views in plane and out of plane, mm.
const SPHERE: [[&str; 4]; 4] = [
    ["3.88 ± 6.69", "3.11 ± 4.68", "0.5189 ± 2.126", "0.9667 ± 2.093"],
    ["0.40 ± 0.65", "2.73 ± 4.42", "0.0004 ± 0.011", "0.0008 ± 0.010"],
    ["0.20 ± 0.55", "1.34 ± 3.76", "0.0002 ± 0.002", "0.0007 ± 0.002"],
    ["0.16 ± 0.44", "1.09 ± 3.04", "0.0002 ± 0.001", "0.0006 ± 0.001"],
];
/// Table 5.4: position, mm, then rotation, degrees, each as in Table 5.3.
const FEMORAL: [(&str, [&str; 4], [&str; 4]); 4] = [
    (
        "pose 1",
        ["0.24 ± 0.44", "2.20 ± 3.75", "0.0005 ± 0.001", "0.0000 ± 0.001"],
        ["0.09 ± 0.27", "0.07 ± 0.07", "0.001 ± 0.003", "0.002 ± 0.003"],
    ),
    (
        "pose 2",
        ["0.05 ± 0.48", "0.44 ± 3.81", "0.0005 ± 0.001", "0.0002 ± 0.001"],
        ["0.28 ± 1.47", "0.41 ± 2.13", "0.000 ± 0.000", "0.009 ± 0.006"],
    ),
    (
        "pose 3",
        ["0.09 ± 0.38", "1.14 ± 4.63", "0.0066 ± 0.003", "0.0024 ± 0.002"],
        ["0.08 ± 0.76", "0.02 ± 1.25", "0.007 ± 0.011", "0.041 ± 0.008"],
    ),
    (
        "average",
        ["0.13 ± 0.43", "1.26 ± 4.06", "0.0025 ± 0.002", "0.0009 ± 0.001"],
        ["0.15 ± 0.83", "0.17 ± 1.15", "0.003 ± 0.004", "0.018 ± 0.005"],
    ),
];
/// Radius of the sphere, mm, and points of its model.
const BALL: (f64, usize) = (25.0, 9_500);
/// Starts of a pose.
const STARTS: usize = 10;

/// Outlines that the product draws of the very mesh that it will match: no accuracy can be claimed from them.
fn shared(
    mesh: &Mesh,
    poses: &[(String, Pose)],
    views: &[TrueFluoroscope],
    still_mm: f64,
) -> Result<Scene, SceneError> {
    let rim = RimMesh::new(mesh);
    let calibrations = calibrations(views);
    let fluoroscopes: Vec<Fluoroscope> = calibrations.iter().map(Fluoroscope::from).collect();
    let mut outline = Outline::new();
    let mut seen = |pose: &Pose, view: &Fluoroscope| -> Curves {
        outline.trace(&rim, pose, view, Sampling { step_px: 0.25 });
        outline_curves(&outline)
    };
    let frames: Frames = poses
        .iter()
        .map(|(label, pose)| (label.clone(), *pose, fluoroscopes.iter().map(|f| seen(pose, f)).collect()))
        .collect();
    // A ball can turn, and one view leaves depth loose: neither speaks against a pose here.
    let params = MatchParams {
        inset_px: 0.0,
        still_mm,
        good_sigma_mm: f64::MAX,
        good_sigma_deg: f64::MAX,
        ..ideal_params()
    };
    let made = Made { origin: Origin::mesh(mesh), claim: Claim::SearchAlone, params };
    Scene::made(made, mesh, &calibrations, frames)
}

/// In plane and out of plane of the first view: of position (mm) and rotation (degrees).
struct Planes {
    position: [Spread; 2],
    rotation: [Spread; 2],
    counted: Cell,
}

fn planes(all: &[&Outcome], view: &TrueFluoroscope) -> Planes {
    let counted: Vec<&Outcome> = all.iter().filter(|o| o.counts).copied().collect();
    let [in_mm, out_mm, in_deg, out_deg] = by_plane(&counted, view).map(|v| Spread::of(&v));
    Planes {
        position: [in_mm, out_mm],
        rotation: [in_deg, out_deg],
        counted: Cell::Share(counted.len(), all.len()),
    }
}

fn plane_columns(unit: &str) -> Vec<Column> {
    let mut columns: Vec<Column> =
        ["one view, in plane", "one view, out of plane", "two views, in plane", "two views, out of plane"]
            .iter()
            .map(|name| Column::at_most(&format!("{name}, {unit}"), 4))
            .collect();
    columns.push(Column::at_least("one view: starts that count", 0));
    columns.push(Column::at_least("two views: starts that count", 0));
    columns
}

fn cells(spreads: [Spread; 4], counted: [&Cell; 2]) -> Vec<Cell> {
    spreads.map(Cell::Spread).into_iter().chain(counted.map(Cell::clone)).collect()
}

fn published(label: String, cells: &[&str; 4]) -> Row {
    let cells = cells.iter().copied().chain(["-", "-"]).map(Cell::text).collect();
    Row { label, ours: false, cells }
}

/// Measures it.
pub fn measure(lab: &Lab) -> Result<Option<Section>, SectionError> {
    let both = biplane(90.0);
    let table = |id: &str, heading: &str, unit: &str| Table {
        id: id.to_owned(),
        heading: heading.to_owned(),
        columns: plane_columns(unit),
        rows: Vec::new(),
    };
    let mut sphere = table("5.3", "Table 5.3: sphere of 50 mm, tolerance", "mm");
    let mut position = table("5.4-position", "Table 5.4: femoral component, position", "mm");
    let mut rotation = table("5.4-rotation", "Table 5.4: femoral component, rotation", "°");
    let mut geometry = table("5.5", "Table 5.5: geometry", "mm");
    let methods: &[Method] = if lab.full() { &Method::BOTH } else { &[Method::Default] };

    let ball = Arc::new(ball_mesh(BALL.0, BALL.1).map_err(|e| SceneError::Mesh(e.to_string()))?);
    let at_origin = [("placed".to_owned(), Pose::new(UnitQuaternion::identity(), Vector3::zeros()))];
    let draw_ball = |truth: &Pose, centroid: &_, frame| {
        // A ball's start differs in position alone.
        set_a(truth, centroid, lab.seed, frame, STARTS)
            .into_iter()
            .map(|start| Pose::new(truth.rotation(), start.translation()))
            .collect::<Vec<_>>()
    };
    let mut by_tolerance: Vec<Series> = Vec::new();
    let mut sphere_at_thesis = Vec::new();
    for (tolerance, thesis) in TOLERANCES.iter().zip(&SPHERE) {
        sphere.rows.push(published(format!("{tolerance}, thesis"), thesis));
        for &method in methods {
            let mut found = Vec::new();
            for views in [&both[..1], &both[..]] {
                let scene = shared(&ball, &at_origin, views, *tolerance)?;
                let thesis = BinghamParams { tolerance: *tolerance, outline_points: 60, ..thesis_params() };
                let all = outcomes(&scene, method, &thesis, &draw_ball);
                found.push(planes(&all.iter().collect::<Vec<_>>(), &both[0]));
            }
            let [a, b] = [found[0].position, found[1].position];
            let row = cells([a[0], a[1], b[0], b[1]], [&found[0].counted, &found[1].counted]);
            for (what, spread) in [("one view, in plane", a[0]), ("one view, out of plane", a[1])] {
                let name = format!("{}, {what}", method.name());
                let point = (-tolerance.log10(), spread.rms);
                match by_tolerance.iter_mut().find(|s| s.name == name) {
                    Some(series) => series.points.push(point),
                    None => by_tolerance.push(Series { name, points: vec![point] }),
                }
            }
            if *tolerance == 0.0005 {
                sphere_at_thesis.push((method, row.clone()));
            }
            sphere.rows.push(Row::ours(format!("{tolerance}, {}", method.name()), row));
        }
    }

    let mesh = lab.workshop.surface(Body::FemoralComponent, 15_000)?;
    let postures = [0.0, 1.0, 2.0].map(|k| {
        let posture = Posture::flexed(90.0).moved(Vector3::new(4.0 * k - 4.0, 3.0 - 3.0 * k, 2.0 * k));
        let turn = Twist { translation: Vector3::zeros(), rotation: Vector3::z() * (20.0 * k).to_radians() };
        let pose = posture.pose(Body::FemoralComponent).moved(&turn, &Point3::origin());
        (format!("pose {}", k + 1.0), pose)
    });
    let draw = |truth: &Pose, centroid: &_, frame| set_a(truth, centroid, lab.seed, frame, STARTS);
    let mut found = Vec::new();
    for &method in methods {
        let mut by_views = Vec::new();
        for views in [&both[..1], &both[..]] {
            let scene = shared(&mesh, &postures, views, 0.0005)?;
            by_views.push(outcomes(&scene, method, &thesis_params(), &draw));
        }
        found.push((method, by_views));
    }
    for (number, (label, thesis_mm, thesis_deg)) in FEMORAL.iter().enumerate() {
        position.rows.push(published(format!("{label}, thesis"), thesis_mm));
        rotation.rows.push(published(format!("{label}, thesis"), thesis_deg));
        for (method, by_views) in &found {
            let of = |all: &[Outcome]| {
                let picked: Vec<&Outcome> = all.iter().filter(|o| number == 3 || o.frame == number).collect();
                planes(&picked, &both[0])
            };
            let (one, two) = (of(&by_views[0]), of(&by_views[1]));
            let counted = [&one.counted, &two.counted];
            let row = |a: [Spread; 2], b: [Spread; 2]| cells([a[0], a[1], b[0], b[1]], counted);
            let name = format!("{label}, {}", method.name());
            position.rows.push(Row::ours(&name, row(one.position, two.position)));
            rotation.rows.push(Row::ours(&name, row(one.rotation, two.rotation)));
            if number == 3 {
                let name = format!("femoral component, {}", method.name());
                geometry.rows.push(Row::ours(name, row(one.position, two.position)));
            }
        }
    }
    geometry.rows.insert(0, published("femoral component, thesis".to_owned(), &FEMORAL[3].1));
    geometry.rows.push(published("sphere, thesis".to_owned(), &SPHERE[2]));
    for (method, row) in sphere_at_thesis {
        geometry.rows.push(Row::ours(format!("sphere, {}", method.name()), row));
    }
    let panel = Panel {
        x: "tolerance, minus its decimal logarithm".to_owned(),
        y: "root mean square error, mm".to_owned(),
        series: by_tolerance,
        limit: None,
    };
    Ok(Some(Section {
        title: "One view against two: Tables 5.3 to 5.5, which claim no accuracy".to_owned(),
        text: vec![
            "As in the thesis, outline and model are one mesh here, so these figures say how well the search ends, and what one \
             view leaves loose, and nothing of accuracy. Ten starts a pose. In plane is across the first view's axis, out of \
             plane along it (rotations: in plane about it). Mean ± sample standard deviation [root mean square] of the starts \
             that count. The tolerance is the thesis's on each variable; ours is the length of a step (`still_mm`)."
                .to_owned(),
        ],
        tables: vec![sphere, position, rotation, geometry],
        plots: vec![lines(
            "table-5-3.svg",
            "Table 5.3: error of the sphere with one view against the tolerance",
            &[panel],
        )?],
    }))
}
