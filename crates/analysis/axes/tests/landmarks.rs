//! Axes from what a person gave: points, landmarks by name, some of them, misspelt ones.

#![allow(clippy::unwrap_used)] // the helpers of tests are tests

use biplane_artifact::{AxesSource, BodyAxes, BodyKind, Landmark, Landmarks, ModelMesh, Side};
use biplane_axes::{Axes, AxesError, AxesInputs, AxesParams, body_axes, landmark_names};
use biplane_geometry::{Mesh, Vector3};
use biplane_phantom::{Body, mesh};
use biplane_stage::{Context, Hashed, Stage};

fn list(points: &[(&str, [f64; 3])]) -> Vec<Landmark> {
    points.iter().map(|(name, at_mm)| Landmark { name: (*name).to_owned(), at_mm: *at_mm }).collect()
}

fn femur() -> Mesh {
    mesh(Body::DistalFemur.solid(), 2_500).unwrap()
}

fn run(mesh: &Mesh, body: BodyKind, points: &[(&str, [f64; 3])]) -> Result<BodyAxes, AxesError> {
    let params = AxesParams { body, side: Some(Side::Right), ..AxesParams::default() };
    body_axes(mesh, &list(points), &params, &Context::new())
}

const MEDIAL: (&str, [f64; 3]) = ("Medial Epicondyle", [-41.0, -4.0, -16.0]);
const LATERAL: (&str, [f64; 3]) = ("LATERAL-epicondyle", [39.0, -3.0, -16.0]);

#[test]
fn the_stage_needs_a_side_and_takes_a_list_of_landmarks() {
    let inputs = |landmarks: Vec<Landmarks>| AxesInputs {
        model: Hashed::new(ModelMesh(femur())),
        landmarks: landmarks.into_iter().map(Hashed::new).collect(),
    };
    let params = AxesParams { body: BodyKind::Femur, ..AxesParams::default() };
    let error = Axes::run(&inputs(Vec::new()), &params, &Context::new()).unwrap_err();
    assert!(
        error.to_string().contains("side = \"left\"") && error.to_string().contains("[[body]]"),
        "{error}"
    );
    let params = AxesParams { side: Some(Side::Left), ..params };
    let given = Landmarks(list(&[("origin", [0.0; 3]), ("x", [0.0, 9.0, 0.0]), ("y", [0.0, 0.0, 9.0])]));
    let found = Axes::run(&inputs(vec![given]), &params, &Context::new()).unwrap();
    assert_eq!(found.source, AxesSource::Points);
    assert_eq!(found.axes, [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]], "points are not mirrored");
    let cancelled = Context::new();
    cancelled.cancel();
    assert_eq!(Axes::run(&inputs(Vec::new()), &params, &cancelled), Err(AxesError::Cancelled));
}

#[test]
fn a_whole_set_keeps_the_mechanical_axis_and_asks_nothing_of_the_shape() {
    let hip = ("hip_centre", [-20.0, 0.0, 400.0]);
    let found = run(&femur(), BodyKind::Femur, &[MEDIAL, LATERAL, hip]).unwrap();
    let middle = Vector3::new(-1.0, -3.5, -16.0);
    let y = (Vector3::from(hip.1) - middle).normalize();
    assert_eq!(found.source, AxesSource::Landmarks);
    assert!((Vector3::from(found.origin_mm) - middle).norm() < 1e-9, "{:?}", found.origin_mm);
    assert!((Vector3::from(found.axes[1]) - y).norm() < 1e-9, "y is kept");
    let z = Vector3::from(found.axes[2]);
    let across = Vector3::from(LATERAL.1) - Vector3::from(MEDIAL.1);
    assert!(z.dot(&across.cross(&y)).abs() < 1e-9 && z.dot(&across) > 0.0, "z in the plane of both");
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
}

#[test]
fn a_left_body_has_z_to_the_right_that_is_medially() {
    let mirrored = |p: (&'static str, [f64; 3])| (p.0, [-p.1[0], p.1[1], p.1[2]]);
    let given = [MEDIAL, LATERAL, ("hip_centre", [-20.0, 0.0, 400.0])].map(mirrored);
    let vertices = femur().vertices().iter().map(|v| [-v.x, v.y, v.z].into()).collect();
    let left = Mesh::new(vertices, femur().triangles().iter().map(|&[a, b, c]| [a, c, b]).collect()).unwrap();
    let params = AxesParams { body: BodyKind::Femur, side: Some(Side::Left), ..AxesParams::default() };
    let found = body_axes(&left, &list(&given), &params, &Context::new()).unwrap();
    let z = Vector3::from(found.axes[2]);
    // The lateral epicondyle lies at -39, the medial one at 41.
    assert!(z.x > 0.99, "from lateral to medial: {z:?}");
    assert!(found.axes[0][1] > 0.99, "x is anterior: {:?}", found.axes[0]);
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
}

#[test]
fn what_a_person_leaves_open_is_filled_in_and_said() {
    let found = run(&femur(), BodyKind::Femur, &[MEDIAL, LATERAL]).unwrap();
    let z = (Vector3::from(LATERAL.1) - Vector3::from(MEDIAL.1)).normalize();
    assert!((Vector3::from(found.axes[2]) - z).norm() < 1e-9, "the person's line is kept");
    assert!((Vector3::from(found.origin_mm) - Vector3::new(-1.0, -3.5, -16.0)).norm() < 1e-9);
    assert_eq!(found.source, AxesSource::Landmarks);
    assert!(
        found.warnings.iter().any(|w| w.contains("proposed from the shape: shaft_distal, shaft_proximal")),
        "{:?}",
        found.warnings
    );
    // One of the pair that the shape proposes.
    let found = run(&femur(), BodyKind::Femur, &[("medial_condyle", [-22.0, -16.0, -26.5])]).unwrap();
    assert!(found.warnings.iter().any(|w| w.contains("lateral_condyle")), "{:?}", found.warnings);
    let origin = run(&femur(), BodyKind::Femur, &[("origin", [1.0, 2.0, 3.0])]).unwrap();
    assert_eq!(origin.origin_mm.map(|v| (v * 1e9).round() / 1e9), [1.0, 2.0, 3.0]);
}

#[test]
fn misspelt_lone_and_double_landmarks_are_errors_that_say_what_would_do() {
    let misspelt = ("medial_epicondile", MEDIAL.1);
    let error = run(&femur(), BodyKind::Femur, &[misspelt, LATERAL]).unwrap_err().to_string();
    println!("{error}");
    assert!(error.contains("\"medial_epicondile\" (unknown; did you mean medial_epicondyle?)"), "{error}");
    assert!(error.contains("there is lateral_epicondyle") && error.contains("hip_centre"), "{error}");
    let error = run(&femur(), BodyKind::Femur, &[MEDIAL]).unwrap_err().to_string();
    assert!(error.contains("medial_epicondyle alone fixes nothing"), "{error}");
    let error = run(&femur(), BodyKind::Femur, &[MEDIAL, ("fme", MEDIAL.1)]).unwrap_err();
    assert!(matches!(error, AxesError::LandmarkTwice { name: "medial_epicondyle", .. }), "{error}");
    let error = run(&femur(), BodyKind::Femur, &[("medial_epicondyle", [f64::NAN; 3])]).unwrap_err();
    assert!(matches!(error, AxesError::LandmarkNotFinite { .. }), "{error}");
    let hip = ("hip_centre", [400.0, -3.0, -16.0]);
    let error = run(&femur(), BodyKind::Femur, &[MEDIAL, LATERAL, hip]).unwrap_err();
    assert!(matches!(error, AxesError::LandmarksDegenerate { .. }), "{error}");
    // Where the shape cannot fill in, the error says why.
    let coarse = Mesh::new(femur().vertices().to_vec(), femur().triangles()[..50].to_vec()).unwrap();
    let error = run(&coarse, BodyKind::Femur, &[MEDIAL, LATERAL]).unwrap_err().to_string();
    assert!(error.contains("50 triangles") && error.contains("shaft_proximal"), "{error}");
}

#[test]
fn landmarks_against_the_shape_are_doubted() {
    let hip = ("hip_centre", [-20.0, 0.0, 400.0]);
    let swapped = [("medial_epicondyle", LATERAL.1), ("lateral_epicondyle", MEDIAL.1), hip];
    let found = run(&femur(), BodyKind::Femur, &swapped).unwrap();
    assert!(found.warnings.iter().any(|w| w.contains("swapped")), "{:?}", found.warnings);
    let metres =
        [("medial_epicondyle", [-410.0, -40.0, -160.0]), ("lateral_epicondyle", [390.0, -30.0, -160.0]), hip];
    let found = run(&femur(), BodyKind::Femur, &metres).unwrap();
    assert!(found.warnings.iter().any(|w| w.contains("outside of the mesh's box")), "{:?}", found.warnings);
    let strange = run(&femur(), BodyKind::Femur, &[MEDIAL, LATERAL, hip, ("screw 7", [0.0; 3])]).unwrap();
    assert!(
        strange.warnings.iter().any(|w| w.contains("\"screw 7\" is no landmark")),
        "{:?}",
        strange.warnings
    );
}

#[test]
fn every_body_has_a_set_that_does_without_its_shape() {
    let [o, x, y, z] = [[0.0; 3], [20.0, 0.0, 0.0], [0.0, 20.0, 0.0], [0.0, 0.0, 20.0]];
    let minus = |p: [f64; 3]| p.map(|v| -v);
    let ball = biplane_phantom::ball_mesh(30.0, 1_000).unwrap();
    let tibia =
        [("medial_plateau", minus(z)), ("lateral_plateau", z), ("ankle", minus(y)), ("intercondylar", o)];
    let malleoli = [
        ("medial plateau", minus(z)),
        ("lateral plateau", z),
        ("MM", [0.0, -30.0, -9.0]),
        ("LM", [0.0, -30.0, 9.0]),
    ];
    let patella = [("apex", minus(y)), ("superior", y), ("medial", minus(z)), ("lateral", z)];
    let component = [("medial", minus(z)), ("lateral", z), ("peg base", o), ("peg tip", y)];
    let flange = [("medial", minus(z)), ("lateral", z), ("posterior", o), ("anterior", x)];
    let tray = [("medial", minus(z)), ("lateral", z), ("keel_tip", minus(y)), ("plate_center", o)];
    let femur =
        [("medial_condyle", minus(z)), ("lateral_condyle", z), ("shaft_distal", o), ("shaft_proximal", y)];
    for (body, given) in [
        (BodyKind::Tibia, tibia),
        (BodyKind::Tibia, malleoli),
        (BodyKind::Patella, patella),
        (BodyKind::FemoralComponent, component),
        (BodyKind::FemoralComponent, flange),
        (BodyKind::TibialTray, tray),
        (BodyKind::Femur, femur),
    ] {
        let found = run(&ball, body, &given).unwrap();
        assert_eq!(
            found.axes.map(|a| a.map(|v| (v * 1e9).round() / 1e9 + 0.0)),
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            "{body:?}"
        );
        assert_eq!(found.source, AxesSource::Landmarks);
    }
    assert!(
        landmark_names(BodyKind::Femur)
            .any(|(name, aliases)| name == "hip_centre" && aliases.contains(&"hjc"))
    );
}

#[test]
fn any_other_body_has_its_principal_axes() {
    let tray = mesh(Body::TibialTray.solid(), 2_500).unwrap();
    let found = body_axes(&tray, &[], &AxesParams::default(), &Context::new()).unwrap();
    // Width, then depth or height of the tray with its stem; never a mirror image.
    let [x, y, z] = found.axes.map(Vector3::from);
    assert!((x.cross(&y) - z).norm() < 1e-12);
    assert!(y.x.abs() > 0.99, "the longest spread is the width: {y:?}");
    let ball = biplane_phantom::ball_mesh(30.0, 1_000).unwrap();
    let found = body_axes(&ball, &[], &AxesParams::default(), &Context::new()).unwrap();
    assert!(found.warnings.len() >= 2, "neither axes nor senses: {:?}", found.warnings);
}
