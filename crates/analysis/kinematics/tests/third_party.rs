//! Another program's poses and the kinematics that it wrote with them, reproduced to the rounding of its files. The data are not part of the
//! project; without them the test says so and passes.
//!
//! Its relation: `v = Rt' (tf - tt)`, and the z-x-y angles of `Rf' Rt` in degrees; of left knees the turns about z and y have the other sign,
//! of right knees the first component of `v`.

#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use biplane_artifact::{Match, Side, StartsTried, Verdict};
use biplane_geometry::{Point3, Pose, Vector3};
use biplane_kinematics::{Convention, Frame, joint_values};
use nalgebra::{Matrix3, UnitQuaternion};

fn matched(pose: Pose) -> Match {
    Match {
        pose: pose.into(),
        verdict: Verdict::Good,
        reason: String::new(),
        views: vec![],
        objective: 0.0,
        covariance: [[0.0; 6]; 6],
        calibration_covariance: None,
        interval_95: [0.0; 6],
        starts: StartsTried { tried: 1, converged: 1, spread: None },
        alternative: None,
        iterations: 0,
    }
}

/// Poses of a `.jts` or `.jtak` file: x, y, z in mm, then turns about z, x and y in degrees.
fn poses(path: &Path) -> Vec<Option<Pose>> {
    let text = std::fs::read_to_string(path).unwrap();
    let pose = |line: &str| {
        let v: Vec<f64> = line.split([',', ' ']).filter_map(|w| w.trim().parse().ok()).collect();
        let about =
            |axis: Vector3, degrees: f64| UnitQuaternion::from_scaled_axis(axis * degrees.to_radians());
        (v.len() == 6).then(|| {
            let turn = about(Vector3::z(), v[3]) * about(Vector3::x(), v[4]) * about(Vector3::y(), v[5]);
            Pose::new(turn, Vector3::new(v[0], v[1], v[2]))
        })
    };
    text.lines().skip(2).filter(|l| !l.trim().is_empty()).map(pose).collect()
}

/// Folders with kinematics below one.
fn movements(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    entries.sort();
    for entry in entries {
        if entry.is_dir() {
            movements(&entry, found);
        } else if entry.file_name().is_some_and(|n| n == "kin_gt.csv") {
            found.push(folder.to_owned());
        }
    }
}

#[test]
fn another_programs_kinematics_come_out_of_its_poses() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data/real/kinematics");
    if !data.is_dir() {
        println!("skipped: {} is not there", data.display());
        return;
    }
    let mut folders = Vec::new();
    movements(&data, &mut folders);
    let frame = Frame { origin: Point3::origin(), axes: Matrix3::identity(), centroid: Point3::origin() };
    let (mut frames, mut worst) = (0, 0.0_f64);
    for folder in &folders {
        let first = |names: &[&str]| names.iter().map(|n| folder.join(n)).find(|p| p.is_file()).unwrap();
        let femur = poses(&first(&["fem.jts", "fem.jtak"]));
        let tibia = poses(&first(&["tib.jts", "tib.jtak"]));
        let left = folder.join("left.txt").is_file();
        let table = std::fs::read_to_string(folder.join("kin_gt.csv")).unwrap();
        let rows: Vec<Vec<f64>> = table
            .lines()
            .map(|line| line.split(',').filter_map(|v| v.trim().parse().ok()).collect())
            .filter(|row: &Vec<f64>| row.len() == 6)
            .collect();
        assert_eq!((femur.len(), tibia.len()), (rows.len(), rows.len()), "{}", folder.display());
        for ((femur, tibia), row) in femur.iter().zip(&tibia).zip(&rows) {
            let (Some(femur), Some(tibia)) = (femur, tibia) else { continue };
            let side = if left { Side::Left } else { Side::Right };
            let joint =
                joint_values((&matched(*femur), &frame), (&matched(*tibia), &frame), Convention::Zxy, side);
            let [z, x, y] = [0, 1, 2].map(|k| joint.values[k].to_degrees());
            // Where the femur lies in the tibia's axes.
            let v = Pose::from(joint.proximal_from_distal).inverse().translation();
            let (turns, slides) = if left { (-1.0, 1.0) } else { (1.0, -1.0) };
            let found = [slides * v.x, v.y, v.z, turns * z, x, turns * y];
            for (a, b) in found.iter().zip(row) {
                let apart = (a - b).abs();
                worst = worst.max(apart.min((apart - 360.0).abs()));
            }
            frames += 1;
        }
    }
    println!("{frames} frames of {} movements, worst difference {worst:.6}", folders.len());
    assert!(frames > 50 && worst < 1.5e-4, "{frames} frames, worst {worst}");
}
