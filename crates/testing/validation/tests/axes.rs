//! Axes proposed for real bones and implants: what was found, whether it points where pictures of the meshes say that it should, and
//! whether it turns with the mesh. Skipped, with a message, where the data is not there.
//! `cargo test -p biplane-validation --test axes -- --nocapture` shows the figures.

#![allow(clippy::unwrap_used)] // the helpers of tests are tests

use std::path::{Path, PathBuf};
use std::time::Instant;

use biplane_acquisition::meshes::{LengthUnit, read_mesh};
use biplane_acquisition::volumes::read_volume;
use biplane_artifact::{AxesFeature, BodyAxes, BodyKind, Landmark, Side};
use biplane_axes::{AxesError, AxesParams, ModelFrame, body_axes};
use biplane_geometry::{Mesh, Point3, Vector3};
use biplane_label_surface::{LabelSurfaceParams, label_surface};
use biplane_stage::Context;
use nalgebra::{Matrix3, Rotation3};

/// A folder of the real data, if it is there.
fn data(folder: &str) -> Option<PathBuf> {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(3)?;
    let path = workspace.parent()?.join("shared/data/real").join(folder);
    if path.is_dir() {
        return Some(path);
    }
    println!("skipped: {folder} is not there");
    None
}

fn model(path: &Path, unit: LengthUnit) -> Mesh {
    read_mesh(path, Some(unit)).unwrap().model.0
}

fn params(body: BodyKind, side: Side) -> AxesParams {
    AxesParams { body, side: Some(side), frame: ModelFrame::Unknown }
}

fn propose(name: &str, mesh: &Mesh, params: &AxesParams) -> BodyAxes {
    let begin = Instant::now();
    let found = body_axes(mesh, &[], params, &Context::new()).unwrap();
    println!(
        "{name}: {} triangles, {:.2} s; origin {:.2?}; x {:.3?}, y {:.3?}, z {:.3?}",
        mesh.triangles().len(),
        begin.elapsed().as_secs_f64(),
        found.origin_mm,
        found.axes[0],
        found.axes[1],
        found.axes[2]
    );
    for feature in &found.features {
        match feature {
            AxesFeature::Cylinder { name, radius_mm, .. } => println!("  {name}: radius {radius_mm:.2} mm"),
            AxesFeature::Sphere { name, radius_mm, .. } => println!("  {name}: radius {radius_mm:.2} mm"),
            _ => {}
        }
    }
    found.warnings.iter().for_each(|w| println!("  {w}"));
    let [x, y, z] = found.axes.map(Vector3::from);
    assert!((x.cross(&y) - z).norm() < 1e-12 && x.dot(&y).abs() < 1e-12, "{name}: not square");
    assert!((x.norm() - 1.0).abs() < 1e-12 && (y.norm() - 1.0).abs() < 1e-12, "{name}: not of unit length");
    found
}

/// Largest angle between found axes and those that are expected, degrees.
fn off(found: &BodyAxes, wanted: [[f64; 3]; 3]) -> f64 {
    let angle = |a: Vector3, b: Vector3| a.cross(&b).norm().atan2(a.dot(&b)).to_degrees();
    let all = found.axes.into_iter().zip(wanted).map(|(a, b)| angle(a.into(), b.into()));
    all.fold(0.0, f64::max)
}

fn radii(found: &BodyAxes) -> Vec<f64> {
    let radius = |f: &AxesFeature| match f {
        AxesFeature::Cylinder { radius_mm, .. } => Some(*radius_mm),
        _ => None,
    };
    found.features.iter().filter_map(radius).collect()
}

fn said(found: &BodyAxes, what: &str) -> bool {
    found.warnings.iter().any(|w| w.contains(what))
}

/// x to the front, y up, z to the right of a model whose own axes were looked at in pictures of it.
const FLANGE_AT_MINUS_X: [[f64; 3]; 3] = [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]];
const FLANGE_AT_PLUS_Y: [[f64; 3]; 3] = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]];
/// Left-posterior-superior.
const SCANNER: [[f64; 3]; 3] = [[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]];

#[test]
fn implants_have_the_axes_that_their_makers_drew_them_in() {
    use BodyKind::{FemoralComponent, TibialTray};
    use LengthUnit::{Metres, Millimetres};
    for (folder, file, unit, body, wanted, most) in [
        (
            "implant-meshes",
            "femoral-component-decimated.stl",
            Metres,
            FemoralComponent,
            FLANGE_AT_MINUS_X,
            0.1,
        ),
        ("implant-meshes", "tibial-tray-decimated.stl", Metres, TibialTray, FLANGE_AT_MINUS_X, 0.1),
        ("knee-implant-biplane", "femur0.stl", Millimetres, FemoralComponent, FLANGE_AT_PLUS_Y, 0.1),
        ("knee-implant-biplane", "tibia0.stl", Millimetres, TibialTray, FLANGE_AT_PLUS_Y, 0.1),
        ("knee-implant-single", "KR_right_7_fem.stl", Millimetres, FemoralComponent, FLANGE_AT_MINUS_X, 2.0),
        ("knee-implant-single", "KR_right_6_tib.stl", Millimetres, TibialTray, FLANGE_AT_MINUS_X, 0.1),
    ] {
        let Some(folder) = data(folder) else { continue };
        let mesh = model(&folder.join(file), unit);
        let found = propose(file, &mesh, &params(body, Side::Right));
        let off = off(&found, wanted);
        println!("  {off:.3} degrees off its maker's axes");
        assert!(off < most, "{file}: {off} degrees");
        // The cylinders' root mean square distance is below 1.2 % of the width, or it would be said.
        assert!(!said(&found, "no good cylinders") && !said(&found, "other side"), "{:?}", found.warnings);
        if body == FemoralComponent {
            let [a, b] = radii(&found)[..] else { panic!("two cylinders") };
            assert!((15.0..30.0).contains(&a) && (a - b).abs() < 0.3, "{file}: {a} and {b} mm");
        }
        if file.starts_with("KR_right_7") {
            let wrong = propose("  the same given as left", &mesh, &params(body, Side::Left));
            assert!(said(&wrong, "other side"));
        }
    }
}

#[test]
fn an_insert_is_no_tray_and_a_resected_femur_needs_landmarks() {
    let Some(folder) = data("implant-meshes") else { return };
    let insert = model(&folder.join("tibial-insert-decimated.stl"), LengthUnit::Metres);
    let refused = body_axes(&insert, &[], &params(BodyKind::TibialTray, Side::Right), &Context::new());
    println!("insert as a tray: {refused:?}");
    assert!(matches!(refused, Err(AxesError::Shape { .. })));

    // Its condyles were cut for the component; its head is there. A program apart from this one (spheres through four vertices at random,
    // the one with most vertices within 0.5 mm, then least squares) has its centre at HEAD and a radius of 23.8 mm.
    const HEAD: [f64; 3] = [1.97, -1.48, 1.99];
    let femur = model(&folder.join("femur.stl"), LengthUnit::Metres);
    let refused = body_axes(&femur, &[], &params(BodyKind::Femur, Side::Right), &Context::new());
    println!("resected femur: {}", refused.as_ref().unwrap_err());
    assert!(matches!(refused, Err(AxesError::Shape { .. })));
    let below = || femur.vertices().iter().filter(|v| v.y < -380.0);
    let medial = below().min_by(|a, b| a.z.total_cmp(&b.z)).unwrap();
    let lateral = below().max_by(|a, b| a.z.total_cmp(&b.z)).unwrap();
    let landmark = |name: &str, p: &Point3| Landmark { name: name.to_owned(), at_mm: (*p).into() };
    let given = [landmark("medial epicondyle", medial), landmark("lateral epicondyle", lateral)];
    let found = body_axes(&femur, &given, &params(BodyKind::Femur, Side::Right), &Context::new()).unwrap();
    println!("with its epicondyles: x {:.3?}, y {:.3?}, {:?}", found.axes[0], found.axes[1], found.warnings);
    let head = found.features.iter().find_map(|f| match f {
        AxesFeature::Sphere { centre_mm, radius_mm, .. } => Some((Vector3::from(*centre_mm), *radius_mm)),
        _ => None,
    });
    let (centre, radius) = head.unwrap();
    let far = (centre - Vector3::from(HEAD)).norm();
    println!("its head: {far:.2} mm from where another program has it, radius {radius:.2} mm");
    assert!(far < 1.0 && (radius - 23.8).abs() < 1.0);
    assert!(found.axes[0][0] > 0.95 && found.axes[1][1] > 0.95, "x is in front and y up in this model");
    assert!(said(&found, "hip_centre"), "{:?}", found.warnings);

    let patella = model(&folder.join("patella.stl"), LengthUnit::Metres);
    let found = propose("patella, resected", &patella, &params(BodyKind::Patella, Side::Right));
    assert!(found.axes[0][0] > 0.99, "the cut face is behind: {:?}", found.axes);
    assert!(found.axes[1][1] > 0.93, "the apex is below: {:?}", found.axes);
}

#[test]
fn bones_of_an_mri_stand_as_the_subject_lay() {
    let Some(folder) = data("knee-mri") else { return };
    let volume = read_volume(folder.join("knee-labels.nrrd")).unwrap().volume;
    for (label, body, most) in
        [(5, BodyKind::Femur, 5.0), (6, BodyKind::Tibia, 6.0), (7, BodyKind::Patella, 15.0)]
    {
        let label = LabelSurfaceParams { label, ..LabelSurfaceParams::default() };
        let mesh = label_surface(&volume, &label, &Context::new()).unwrap().mesh;
        // A right knee: it lies at x = -70 mm, and its fibula farther from the middle.
        let blind = propose("from the shape alone", &mesh, &params(body, Side::Right));
        let lps = AxesParams { frame: ModelFrame::Lps, ..params(body, Side::Right) };
        let found = propose("with frame = \"lps\"", &mesh, &lps);
        let leaning = off(&found, SCANNER);
        println!("  {body:?}: {leaning:.2} degrees off the scanner's axes at most");
        assert!(leaning < most, "{body:?}");
        assert!(!said(&found, "other side") && !said(&found, "no good cylinders"), "{:?}", found.warnings);
        if body == BodyKind::Patella {
            // Its base has a spur that tapers like an apex: the shape alone does not tell up from down, and says so.
            assert!(off(&blind, SCANNER) < most || said(&blind, "which end is the apex"));
            continue;
        }
        assert!(off(&blind, SCANNER) < most, "{body:?} without the frame");
        let wrong = body_axes(&mesh, &[], &params(body, Side::Left), &Context::new()).unwrap();
        assert!(said(&wrong, "other side"), "{body:?} given as left: {:?}", wrong.warnings);
        for (k, axis) in [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()].iter().enumerate() {
            let turn = Rotation3::from_axis_angle(axis, 1.1 + k as f64);
            let vertices = mesh.vertices().iter().map(|v| turn * v).collect();
            let turned = Mesh::new(vertices, mesh.triangles().to_vec()).unwrap();
            let moved = body_axes(&turned, &[], &params(body, Side::Right), &Context::new()).unwrap();
            let back = moved.axes.map(|a| turn.transpose() * Vector3::from(a));
            let apart = (Matrix3::from_columns(&back)
                - Matrix3::from_columns(&blind.axes.map(Vector3::from)))
            .norm()
            .to_degrees();
            let far =
                (turn.transpose() * Point3::from(moved.origin_mm) - Point3::from(blind.origin_mm)).norm();
            println!("  turned: {apart:.1e} degrees, {far:.1e} mm");
            assert!(apart < 0.01 && far < 0.01, "{body:?} turned");
        }
    }
}
