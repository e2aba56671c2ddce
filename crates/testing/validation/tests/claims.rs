//! What may claim accuracy: truth and model are never one mesh.

#![allow(clippy::unwrap_used)]

use std::path::Path;

use biplane_optimisation::MatchParams;
use biplane_phantom::{Body, Exposure, biplane};
use biplane_validation::knee::{FINEST, Posture};
use biplane_validation::lab::calibrations;
use biplane_validation::pictures::{Equipment, Knee};
use biplane_validation::{Claim, Effort, Lab, Made, Origin, Scene, SceneError};

fn lab() -> Lab {
    Lab::new(Path::new("."), Effort::Quick, 1)
}

fn made(origin: Origin, claim: Claim) -> Made {
    Made { origin, claim, params: MatchParams::default() }
}

#[test]
fn accuracy_is_not_claimed_with_the_mesh_that_made_the_truth() {
    let lab = lab();
    let views = calibrations(&biplane(90.0));
    let [coarse, fine] = [1_000, 3_500].map(|n| lab.workshop.surface(Body::TibialTray, n).unwrap());
    let scene = |origin, claim| Scene::made(made(origin, claim), &coarse, &views, Vec::new());
    let shared = scene(Origin::mesh(&coarse), Claim::Accuracy).err();
    assert!(matches!(shared, Some(SceneError::SharedMesh { .. })), "one mesh for truth and model");
    // A finer model than the truth's is no better: then the truth is the approximation.
    let finer = Scene::made(made(Origin::mesh(&coarse), Claim::Accuracy), &fine, &views, Vec::new()).err();
    assert!(matches!(finer, Some(SceneError::SharedMesh { .. })), "the model is finer than the truth");
    assert!(scene(Origin::mesh(&fine), Claim::Accuracy).is_ok());
    assert!(scene(Origin::Solid, Claim::Accuracy).is_ok());
    assert!(scene(Origin::mesh(&coarse), Claim::SearchAlone).is_ok());
}

#[test]
fn pictures_are_made_of_finer_meshes_than_are_matched() {
    let lab = lab();
    let equipment = Equipment::new(&biplane(90.0), &Exposure::ideal());
    for body in Knee::Implants.bodies() {
        let scene =
            |points| lab.recorded_scene(body, points, &[], &equipment.calibrations(), MatchParams::default());
        assert!(matches!(scene(FINEST).err(), Some(SceneError::SharedMesh { .. })));
        assert!(scene(15_000).is_ok());
    }
}

/// The bodies of a knee do not run into each other, whatever the posture: an X-ray of such a scene would show nothing real.
#[test]
fn implants_of_a_posture_keep_apart() {
    let lab = lab();
    let [femoral, tray] = Knee::Implants.bodies();
    let surface = lab.workshop.surface(femoral, 3_500).unwrap();
    for flexion in [0.0, 30.0, 60.0, 90.0, 110.0] {
        let posture = Posture::flexed(flexion);
        let tray_from_femoral = posture.pose(tray).inverse() * posture.pose(femoral);
        let nearest = surface
            .vertices()
            .iter()
            .map(|v| tray.solid().value(&tray_from_femoral.transform(v)))
            .fold(f64::INFINITY, f64::min);
        assert!(nearest > 1.0, "at {flexion} degrees they are {nearest} mm apart");
    }
}
