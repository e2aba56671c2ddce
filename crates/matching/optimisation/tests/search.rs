//! `method = "search"`: every objective and every optimiser on the outlines of another program, from starts some millimetres and degrees off; what
//! cannot be searched is said.
//!
//! Outlines are those of a mesh of 36,000 points, the mesh that is matched has 3,500.

// A test whose set-up fails has failed.
#![allow(clippy::unwrap_used)]

mod scene;

use biplane_artifact::{Curves, Match, ModelMesh, Start, Verdict};
use biplane_geometry::{Mesh, Pose, PoseError, Twist, Vector3};
use biplane_objective::Kind;
use biplane_optimisation::{MatchBody, MatchError, MatchInputs, MatchParams, Method, SearchParams};
use biplane_optimiser::Optimiser;
use biplane_stage::{Context, Hashed, Stage};
use scene::{mesh, posed, workspace};

/// The bone at its first pose: its mesh, its pose and what the stage reads, from a start 4 mm and 4 degrees off.
fn bone() -> (Mesh, Pose, MatchInputs) {
    let folder = workspace().join("fixtures/scene");
    let scene = serde_json::from_slice(&std::fs::read(folder.join("scene.json")).unwrap()).unwrap();
    let mesh = mesh(&folder.join("bone_3500.stl"));
    let posed = posed(&folder, &scene, "bone", "36000", 0);
    let twist =
        Twist { translation: Vector3::new(2.7, -1.3, 2.6), rotation: Vector3::new(-0.023, 0.046, 0.046) };
    let start = posed.pose.moved(&twist, &posed.pose.transform(&mesh.area_centroid()));
    let inputs = MatchInputs {
        curves: posed.views.iter().map(|v| Hashed::new(v.1.clone())).collect(),
        calibrations: posed.views.iter().map(|v| Hashed::new(v.0.clone())).collect(),
        model: Hashed::new(ModelMesh(mesh.clone())),
        start: vec![Hashed::new(Start(start))],
        calibration_uncertainty: vec![],
    };
    (mesh, posed.pose, inputs)
}

fn run(inputs: &MatchInputs, search: SearchParams) -> Match {
    let params = MatchParams { method: Method::Search, search, inset_px: 0.0, ..MatchParams::default() };
    MatchBody::run(inputs, &params, &Context::new()).unwrap()
}

fn error(found: &Match, truth: &Pose, mesh: &Mesh) -> [f64; 2] {
    let PoseError { translation_mm, rotation_rad } =
        Pose::from(found.pose).error_against(truth, &mesh.area_centroid());
    [translation_mm, rotation_rad.to_degrees()]
}

#[test]
fn every_objective_finds_the_pose() {
    let (mesh, truth, inputs) = bone();
    for objective in Kind::ALL {
        let optimiser = if objective.has_rows() { Optimiser::LevenbergMarquardt } else { Optimiser::Bfgs };
        let found = run(&inputs, SearchParams { objective, optimiser, starts: 3, ..SearchParams::default() });
        let [mm, deg] = error(&found, &truth, &mesh);
        println!(
            "{:15} {mm:.4} mm, {deg:.4} degrees, {} calls, {:?} {}",
            objective.name(),
            found.iterations,
            found.verdict,
            found.reason
        );
        assert!(mm < 0.3 && deg < 0.6, "{}: {mm} mm, {deg} degrees", objective.name());
        assert!(
            found.starts.tried == 3 && found.starts.converged > 0,
            "{}: {:?}",
            objective.name(),
            found.starts
        );
        assert_eq!(found.verdict, Verdict::Good, "{}: {}", objective.name(), found.reason);
    }
}

#[test]
fn every_optimiser_finds_the_pose() {
    let (mesh, truth, inputs) = bone();
    for optimiser in Optimiser::ALL {
        // Those that draw need more than eight hundred.
        let drawing = [Optimiser::ParticleSwarm, Optimiser::SimulatedAnnealing, Optimiser::Genetic];
        let calls = if drawing.contains(&optimiser) { 3000 } else { 800 };
        let search = SearchParams {
            objective: Kind::ImageToModel,
            optimiser,
            calls,
            starts: 1,
            spacing_px: 4.0,
            ..SearchParams::default()
        };
        let found = run(&inputs, search);
        let [mm, deg] = error(&found, &truth, &mesh);
        println!("{:20} {mm:.4} mm, {deg:.4} degrees, {} calls", optimiser.name(), found.iterations);
        assert!(found.iterations as usize <= calls);
        assert!(mm < 0.5 && deg < 1.0, "{}: {mm} mm, {deg} degrees", optimiser.name());
        assert_eq!(found, run(&inputs, search), "{}: the same on every run", optimiser.name());
    }
}

#[test]
fn what_cannot_be_searched_is_said() {
    let (_, _, inputs) = bone();
    let search = SearchParams { objective: Kind::SplineGrid, ..SearchParams::default() };
    let params = MatchParams { method: Method::Search, search, ..MatchParams::default() };
    let refused = MatchBody::run(&inputs, &params, &Context::new());
    let expected = MatchError::Optimiser { objective: "spline_grid", optimiser: "levenberg_marquardt" };
    assert_eq!(refused, Err(expected));
    for (change, key) in [
        (SearchParams { starts: 0, ..SearchParams::default() }, "search.starts"),
        (SearchParams { fine_px: 90.0, ..SearchParams::default() }, "search.fine_px"),
        (SearchParams { tolerance_mm: f64::NAN, ..SearchParams::default() }, "search.tolerance_mm"),
    ] {
        let Err(MatchError::Parameter { name, .. }) = change.check() else { panic!("{key} was taken") };
        assert_eq!(name, key);
    }
    // A view without edges of the body: the answer says why it has failed.
    let mut blind = inputs.clone();
    blind.curves[1] = Hashed::new(Curves::default());
    let found = run(&blind, SearchParams::default());
    assert_eq!(found.verdict, Verdict::Failed);
    assert!(found.reason.starts_with("view 2 (counted from 1) has no edge of the body"), "{}", found.reason);
    // And without a start there is nothing to begin with.
    let nowhere = MatchInputs { start: vec![], ..inputs };
    let params = MatchParams { method: Method::Search, ..MatchParams::default() };
    assert_eq!(MatchBody::run(&nowhere, &params, &Context::new()), Err(MatchError::NoStart));
}

#[test]
fn starts_are_the_given_one_and_gaussian_ones_of_the_seed() {
    let (mesh, truth, _) = bone();
    let centroid = mesh.area_centroid();
    let params =
        SearchParams { starts: 500, start_sigma_mm: 5.0, start_sigma_deg: 3.0, ..SearchParams::default() };
    let starts = params.starts(&truth, &centroid);
    assert_eq!((starts.len(), starts[0], starts.clone()), (500, truth, params.starts(&truth, &centroid)));
    assert_ne!(starts[1], SearchParams { seed: 2, ..params }.starts(&truth, &centroid)[1]);
    let mean_square = |of: fn(&PoseError) -> f64| {
        starts[1..].iter().map(|s| of(&s.error_against(&truth, &centroid)).powi(2)).sum::<f64>() / 499.0
    };
    // Cut at two standard deviations, a normal number has 0.7737 of its variance.
    assert!((mean_square(|e| e.translation_mm) / (3.0 * 25.0 * 0.7737) - 1.0).abs() < 0.1);
    assert!((mean_square(|e| e.rotation_rad.to_degrees()) / (3.0 * 9.0 * 0.7737) - 1.0).abs() < 0.1);
    let farthest = starts.iter().map(|s| s.error_against(&truth, &centroid).translation_mm);
    assert!(farthest.fold(0.0, f64::max) <= 10.0 * 3.0_f64.sqrt() + 1e-9);
}
