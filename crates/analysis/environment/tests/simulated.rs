//! Bead frames of the simulated studies, made by another program: their true fluoroscopes and their own distortion samples.
//!
//! Spots are the true shadows with noise of 0.1 px, recorded through the table: what the finder of spots does with the pictures
//! themselves is measured by the crate `biplane-validation`.

// Clippy lets `#[test]` functions unwrap, but not what they call.
#![allow(clippy::unwrap_used)]

mod scene;

use std::path::{Path, PathBuf};

use biplane_artifact::{DistortionTable, Verdict};
use biplane_environment::{EnvironmentParams, source_region};
use biplane_fluoroscope::Distortion;
use biplane_geometry::{Point3, Vector3};
use biplane_phantom::{Ball, BeadFrame, BeadLayout, TrueFluoroscope};
use scene::{NOISE_PX, Scene, exact_spots};

fn numbers(path: &Path) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(path).unwrap();
    text.lines().skip(1).map(|l| l.split(',').map(|v| v.parse().unwrap()).collect()).collect()
}

/// A study's truth and calibration, below the workspace's fixtures.
fn study(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../fixtures").join(name)
}

#[test]
fn frames_of_another_simulator_give_its_fluoroscopes() {
    for name in ["knee", "knee-natural"] {
        let folder = study(name);
        let truth: serde_json::Value =
            serde_json::from_slice(&std::fs::read(folder.join("truth/fluoroscopes.json")).unwrap()).unwrap();
        let mut scene = Scene::exact(&BeadLayout::large(), 0.5, 90.0, 1);
        let balls: Vec<Ball> = numbers(&folder.join("calibration/beads.csv"))
            .iter()
            .map(|r| Ball { centre: Point3::new(r[1], r[2], r[3]), radius: r[4] })
            .collect();
        for (bead, ball) in scene.list.0.iter_mut().zip(&balls) {
            bead.at_mm = ball.centre.coords.into();
            bead.radius_mm = Some(ball.radius);
            bead.mark = ball.radius > 2.0;
        }
        let frame = BeadFrame { beads: balls, attenuation_per_mm: 1.0, tube: None };
        for (v, view) in ["A", "B"].into_iter().enumerate() {
            let f = &truth["fluoroscopes"][view];
            let of = |key: &str| -> Vector3 {
                let v = f[key].as_array().unwrap();
                Vector3::from_fn(|k, _| v[k].as_f64().unwrap())
            };
            scene.fluoroscopes[v] = TrueFluoroscope {
                source: Point3::from(of("source")),
                centre: Point3::from(of("centre")),
                along_x: of("u"),
                along_y: of("v"),
                ..scene.fluoroscopes[v].clone()
            };
            let samples = numbers(&folder.join(format!("truth/distortion_{view}.csv")));
            let side = (samples.len() as f64).sqrt() as usize;
            let step = samples[1][0] - samples[0][0];
            let table = DistortionTable {
                first_px: [samples[0][0], samples[0][1]],
                step_px: [step, step],
                count: [side, side],
                ideal_px: samples.iter().map(|s| [s[2], s[3]]).collect(),
            };
            let distortion = Distortion::from(&table);
            scene.detectors[v].distortion = Some(table);
            scene.spots[v] = exact_spots(&frame, &scene.fluoroscopes[v]);
            for s in &mut scene.spots[v].spots {
                s.at_px = distortion.recorded(&s.at_px.into()).unwrap().into();
            }
        }
        scene.add_noise(NOISE_PX, 3);
        let found = scene.find(&EnvironmentParams::default()).unwrap();
        for (v, (view, truth)) in found.views.iter().zip(&scene.fluoroscopes).enumerate() {
            println!(
                "{name} {}: source {:.2} mm off, detector {:.2} mm, reprojection {:.3} px",
                view.view,
                (Point3::from(view.source) - truth.source).norm(),
                (Point3::from(view.centre) - truth.centre).norm(),
                view.reprojection_rms_px
            );
            assert!(source_region(&found, v, 0.9999).unwrap().holds(&truth.source));
            assert!(view.reprojection_rms_px < 0.2);
        }
        assert_eq!(found.verdict, Verdict::Good, "{:?}", found.warnings);
    }
}
