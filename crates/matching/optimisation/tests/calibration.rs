//! What a wrong calibration does to matches, against ideal outlines of the phantom's femoral component, whose truth the code under
//! test has no part in.

#![allow(clippy::unwrap_used)]

use biplane_artifact::Curves;
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Point3, Pose, Vector3};
use biplane_optimisation::{
    EdgeField, MatchParams, View, disagreement, pose_covariance_of_calibration, refine,
};
use biplane_outline::RimMesh;
use biplane_phantom::{Body, TrueFluoroscope, biplane, ideal_outline, mesh};
use nalgebra::{DMatrix, Matrix2xX, UnitQuaternion};

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
        let derivative = |number: usize, point: &Point3| {
            let mut all = Matrix2xX::zeros(1);
            if number == view {
                let at = |by: Vector3| {
                    let moved = TrueFluoroscope {
                        source: scene.truth[view].source + by,
                        ..scene.truth[view].clone()
                    };
                    moved.project(point).map(|(pixel, _)| pixel)
                };
                all.set_column(0, &((at(by * 0.01)? - at(by * -0.01)?) / 0.02));
            }
            Some(all)
        };
        let found = pose_covariance_of_calibration(
            &scene.rim,
            &scene.views(&scene.truth),
            &scene.pose,
            &DMatrix::from_element(1, 1, 1.0),
            derivative,
        )
        .unwrap();
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
