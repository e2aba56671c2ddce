//! What a wrong calibration does to matches, against ideal outlines of the phantom's femoral component, whose truth the code under
//! test has no part in.

#![allow(clippy::unwrap_used)]

use biplane_artifact::{CalibrationUncertainty, Curves};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Pose, Vector3};
use biplane_optimisation::{
    EdgeBias, EdgeField, MatchParams, RefineParams, View, disagreement, match_anywhere, match_body,
    pose_covariance_of_calibration, refine, with_calibration,
};
use biplane_outline::RimMesh;
use biplane_phantom::{Body, TrueFluoroscope, biplane, ideal_outline, mesh};
use nalgebra::{Matrix6, UnitQuaternion, Vector6};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

struct Scene {
    rim: RimMesh,
    pose: Pose,
    truth: [TrueFluoroscope; 2],
    curves: Vec<Curves>,
}

fn scene() -> Scene {
    let truth = biplane(80.0);
    let solid = Body::FemoralComponent.solid();
    let pose = Pose::new(UnitQuaternion::from_euler_angles(0.3, -0.2, 0.5), Vector3::new(4.0, -3.0, 6.0));
    let curves = truth.iter().map(|view| Curves(ideal_outline(solid, &pose, view, 0.5))).collect();
    Scene { rim: RimMesh::new(&mesh(solid, 15_000).unwrap()), pose, truth, curves }
}

impl Scene {
    fn views(&self, believed: &[TrueFluoroscope; 2]) -> Vec<View> {
        let view = |(view, curves): (&TrueFluoroscope, &Curves)| View {
            fluoroscope: Fluoroscope::from(&view.calibration("A")),
            edges: EdgeField::new(curves, None),
        };
        believed.iter().zip(&self.curves).map(view).collect()
    }

    fn matched(&self, believed: &[TrueFluoroscope; 2]) -> Pose {
        refine(&self.rim, &self.views(believed), &self.pose, &MatchParams::default().search()).pose
    }
}

fn moved(view: &TrueFluoroscope, by: Vector3) -> TrueFluoroscope {
    TrueFluoroscope { source: view.source + by, centre: view.centre + by, ..view.clone() }
}

#[test]
fn two_views_disagree_by_what_one_is_moved() {
    let scene = scene();
    let search = MatchParams::default().search();
    let disagree = |believed: &[TrueFluoroscope; 2]| {
        let pose = scene.matched(believed);
        disagreement(&scene.rim, &scene.views(believed), &pose, &search).unwrap()
    };
    let right = disagree(&scene.truth);
    assert!(right.mm.abs() < 0.005, "{right:?}");
    let [a, b] = &scene.truth;
    // Both views look along z = 0, so z is across every epipolar plane near the middle, and the other axes lie in them.
    for up in [0.3, -0.6] {
        let off = disagree(&[a.clone(), moved(b, Vector3::new(0.0, 0.0, up))]);
        assert!((off.mm.abs() - f64::abs(up)).abs() < 0.02 + 0.05 * f64::abs(up), "{up}: {off:?}");
        let other = disagree(&[moved(a, Vector3::new(0.0, 0.0, up)), b.clone()]);
        assert!((other.mm + off.mm).abs() < 0.02 + 0.05 * f64::abs(up), "{up}: {other:?}");
    }
    let within = disagree(&[a.clone(), moved(b, Vector3::new(0.0, 0.5, 0.0))]);
    assert!(within.mm.abs() < 0.05, "moved within the epipolar planes it cannot be seen: {within:?}");
}

#[test]
fn one_view_alone_cannot_disagree() {
    let scene = scene();
    let views = scene.views(&scene.truth);
    let search = MatchParams::default().search();
    assert_eq!(disagreement(&scene.rim, &views[..1], &scene.pose, &search), None);
}

/// What the uncertainty of the true views' places brings to the pose.
fn predicted(scene: &Scene, uncertainty: &CalibrationUncertainty) -> Matrix6<f64> {
    let search = MatchParams::default().search();
    let pose = scene.matched(&scene.truth);
    let views = scene.views(&scene.truth);
    pose_covariance_of_calibration(&scene.rim, &views, &pose, uncertainty, &search).unwrap()
}

/// How a pose stands off another one, as a covariance orders it.
fn off(scene: &Scene, pose: &Pose, from: &Pose) -> Vector6<f64> {
    let centroid = scene.rim.centroid();
    let moved = pose.transform(centroid) - from.transform(centroid);
    let turned = (pose.rotation() * from.rotation().inverse()).scaled_axis();
    Vector6::new(moved.x, moved.y, moved.z, turned.x, turned.y, turned.z)
}

#[test]
fn a_pose_moves_with_the_calibration_as_is_predicted() {
    let scene = scene();
    let centroid = *scene.rim.centroid();
    let right = scene.matched(&scene.truth);
    for (view, by) in [
        (0, Vector3::new(1.5, 0.0, 0.0)),
        (1, Vector3::new(0.0, -0.9, 0.0)),
        (0, Vector3::new(-0.7, 0.4, 0.0)),
    ] {
        let mut believed = scene.truth.clone();
        believed[view].source += by;
        let error = scene.matched(&believed).error_against(&right, &centroid);
        // One parameter: how far along `by` the source is; with a variance of 1 the covariance is the square of the motion.
        let mut uncertainty = CalibrationUncertainty::independent(&[[1000.0, 0.0, 0.0]; 2]);
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            uncertainty.covariance[9 * view + i][9 * view + j] = by[i] * by[j];
        }
        let found = predicted(&scene, &uncertainty);
        let sigma = |from: usize| (from..from + 3).map(|i| found[(i, i)]).sum::<f64>().sqrt();
        // Errors within the epipolar planes: those across them leave residuals that robust weights answer to, not linearly.
        // Robust weights and lost edges make the real motion differ a little from the linear one.
        let near = |a: f64, b: f64, floor: f64| (a - b).abs() < 0.1 * b + floor;
        assert!(
            near(error.translation_mm, sigma(0), 0.01),
            "{by}: {} mm, predicted {}",
            error.translation_mm,
            sigma(0)
        );
        assert!(
            near(error.rotation_rad, sigma(3), 3e-4),
            "{by}: {} rad, predicted {}",
            error.rotation_rad,
            sigma(3)
        );
        assert!(sigma(0) > 0.02, "the case moves something");
    }
}

#[test]
fn all_parameters_of_a_placement_together_bring_what_each_brings() {
    let scene = scene();
    // Large enough to stand out of what a match repeats to by itself, and weighed evenly, so that the answer is linear.
    let (source, detector) = (0.2, 0.2);
    let even = RefineParams { least_scale_px: 10.0, still_mm: 1e-6, ..MatchParams::default().search() };
    let uncertainty = CalibrationUncertainty::independent(&[[1000.0, source, detector]; 2]);
    let found = predicted(&scene, &uncertainty);
    let mut expected = Matrix6::zeros();
    for (view, axis) in (0..2).flat_map(|view| (0..3).map(move |axis| (view, axis))) {
        for of_source in [true, false] {
            let matched = |sign: f64| {
                let mut believed = scene.truth.clone();
                let by = Vector3::from_fn(|i, _| if i == axis { sign } else { 0.0 });
                match of_source {
                    true => believed[view].source += by * source,
                    false => believed[view].centre += by * detector,
                }
                refine(&scene.rim, &scene.views(&believed), &scene.pose, &even).pose
            };
            let moved = off(&scene, &matched(1.0), &matched(-1.0)) / 2.0;
            expected += moved * moved.transpose();
        }
    }
    // What a match repeats to by itself, where samples change their edge point: mm and rad.
    let own = |i: usize| if i < 3 { 1e-3 } else { 6e-5 };
    for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
        let scale = (expected[(i, i)] * expected[(j, j)]).sqrt();
        let error = (found[(i, j)] - expected[(i, j)]).abs();
        assert!(
            error < 0.05 * scale + own(i) * own(j),
            "{i} {j}: {} predicted, {} matched, scale {scale}",
            found[(i, j)],
            expected[(i, j)]
        );
    }
}

/// Noise of outlines of 0.3 px, whose correlation falls to 1/e in 20 px (points lie 0.5 px apart).
fn noisy(curves: &[Curves], normal: &mut impl FnMut() -> f64) -> Vec<Curves> {
    let mut curves = curves.to_vec();
    let kept = (-0.5_f64 / 20.0).exp();
    for curve in curves.iter_mut().flat_map(|c| c.0.iter_mut()) {
        let mut noise = normal();
        for point in &mut curve.points {
            noise = kept * noise + (1.0 - kept * kept).sqrt() * normal();
            point.position += point.direction * (0.3 * noise);
        }
    }
    curves
}

#[test]
fn wrong_calibrations_drawn_at_random_move_poses_as_much_as_is_stated() {
    const DRAWS: usize = 150;
    let mut scene = scene();
    let clean = scene.curves.clone();
    let mut random = Xoshiro256PlusPlus::seed_from_u64(7);
    // Twelve uniform numbers make one that is normal nearly.
    let mut normal = move || (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
    let names = ["A".to_owned(), "B".to_owned()];
    let params = MatchParams { edge_bias: EdgeBias::Constant, ..MatchParams::default() };
    // Mean squares of the six errors, and what is stated of the calibration's part.
    let mut drawn = |source: f64, detector: f64| {
        let uncertainty = CalibrationUncertainty::independent(&[[1000.0, source, detector]; 2]);
        let (mut squares, mut stated) = (Vector6::zeros(), Vector6::zeros());
        for _ in 0..DRAWS {
            scene.curves = noisy(&clean, &mut normal);
            let mut vector = |sigma: f64| Vector3::from_fn(|_, _| sigma * normal());
            let believed = scene.truth.clone().map(|view| TrueFluoroscope {
                source: view.source + vector(source),
                centre: view.centre + vector(detector),
                ..view
            });
            let (views, start) = (scene.views(&believed), Some(&scene.pose));
            let of = (views.as_slice(), names.as_slice());
            let found =
                match_anywhere(&scene.rim, of, Some(&uncertainty), start, Vec::new, &params, || false)
                    .unwrap();
            squares += off(&scene, &found.pose.into(), &scene.pose).map(|v| v * v) / DRAWS as f64;
            let own = found.calibration_covariance.unwrap();
            stated += Vector6::from_fn(|i, _| own[i][i]) / DRAWS as f64;
        }
        (squares, stated)
    };
    let (noise, _) = drawn(0.0, 0.0);
    let (squares, stated) = drawn(0.3, 0.1);
    for i in 0..6 {
        // One on average; of so many draws its standard deviation is 0.12.
        let ratio = squares[i] / (noise[i] + stated[i]);
        assert!((ratio - 1.0).abs() < 0.36, "{i}: {ratio}");
    }
}

#[test]
fn the_calibrations_part_is_added_to_a_match() {
    let scene = scene();
    let views = scene.views(&scene.truth);
    let params = MatchParams::default();
    let names = ["A".to_owned(), "B".to_owned()];
    let found = match_body(&scene.rim, &views, &names, &scene.pose, &params, || false).unwrap();
    assert_eq!(found.calibration_covariance, None);
    let uncertainty = CalibrationUncertainty::independent(&[[1000.0, 0.3, 0.1]; 2]);
    let with =
        |uncertainty| with_calibration(found.clone(), &scene.rim, &views, uncertainty, &params.search());
    let folded = with(&uncertainty);
    let own = folded.calibration_covariance.unwrap();
    for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
        assert_eq!(folded.covariance[i][j], found.covariance[i][j] + own[i][j]);
    }
    for (i, own) in own.iter().enumerate() {
        let half = 1.959_964 * folded.covariance[i][i].sqrt();
        assert!((folded.interval_95[i] - half).abs() < 1e-12 && own[i] > 0.0);
    }
    assert_eq!((folded.pose, folded.verdict), (found.pose, found.verdict));
    // One of other views is not taken.
    let other = CalibrationUncertainty::independent(&[[1000.0, 0.3, 0.1]; 3]);
    assert_eq!(with(&other), found);
}
