//! `cargo xtask kinematics`: a study's `kinematics.csv` against what known poses of both bodies give.
//!
//! Grood and Suntay's values are computed here once more, straight from matrices and by other formulas than the program's, so that a
//! mistake in a sign or an axis does not hide.

use std::error::Error;
use std::path::Path;

use biplane::study::Study;
use biplane::tables::same_frame;
use biplane_artifact::{Artifact, BodyAxes, Side};
use biplane_geometry::{Pose, Vector3};
use biplane_validation::{Distribution, read_reference};
use nalgebra::Matrix3;

/// Columns of the values, angles first.
const COLUMNS: [&str; 6] =
    ["flexion_deg", "adduction_deg", "internal_rotation_deg", "lateral_mm", "anterior_mm", "distraction_mm"];

/// Columns of the axes in the laboratory, and the origin, mm.
fn placed(pose: &Pose, axes: &BodyAxes) -> (Matrix3<f64>, Vector3) {
    let matrix = pose.matrix();
    let rotation: Matrix3<f64> = matrix.fixed_view::<3, 3>(0, 0).into_owned();
    let own = Matrix3::from_columns(&axes.axes.map(Vector3::from));
    (rotation * own, rotation * Vector3::from(axes.origin_mm) + pose.translation())
}

fn values(femur: (Matrix3<f64>, Vector3), tibia: (Matrix3<f64>, Vector3), side: Side) -> [f64; 6] {
    let column = |m: &Matrix3<f64>, k: usize| m.column(k).into_owned();
    let (e1, e3) = (column(&femur.0, 2), column(&tibia.0, 1));
    let floating = e3.cross(&e1).normalize();
    // By the angles between axes: flexion from the femur's y axis to the floating axis, rotation from the tibia's x axis to it.
    let flexion = -floating.dot(&column(&femur.0, 1)).atan2(floating.dot(&column(&femur.0, 0)));
    let rotation = -floating.dot(&column(&tibia.0, 2)).atan2(floating.dot(&column(&tibia.0, 0)));
    let adduction = e1.dot(&e3).asin();
    let between = tibia.1 - femur.1;
    let outwards = if side == Side::Left { -1.0 } else { 1.0 };
    [
        flexion.to_degrees(),
        outwards * adduction.to_degrees(),
        -outwards * rotation.to_degrees(),
        outwards * between.dot(&e1),
        between.dot(&floating),
        -between.dot(&e3),
    ]
}

/// Prints the differences and says whether they keep the limits.
pub fn kinematics(
    pipeline: &Path,
    name: &str,
    references: [&Path; 2],
    (limit_mm, limit_deg): (f64, f64),
) -> Result<bool, Box<dyn Error>> {
    let study = Study::load(pipeline)?;
    let joint = study.joints.iter().find(|j| j.name == name);
    let joint = joint.ok_or_else(|| format!("{} has no joint `{name}`", pipeline.display()))?;
    let axes = |body: usize| -> Result<BodyAxes, Box<dyn Error>> {
        let path = study.output.join("models").join(format!("{}_axes.json", study.bodies[body].name));
        Ok(BodyAxes::decode(&std::fs::read(&path).map_err(|e| format!("{}: {e}", path.display()))?)?)
    };
    let (proximal, distal) = (axes(joint.proximal)?, axes(joint.distal)?);
    let known = (read_reference(references[0])?, read_reference(references[1])?);
    let mut table = csv::Reader::from_path(study.output.join("kinematics.csv"))?;
    let header = table.headers()?.clone();
    let at = |column: &str| {
        header
            .iter()
            .position(|h| h == column)
            .ok_or_else(|| format!("kinematics.csv has no column {column}"))
    };
    let (frame_at, joint_at) = (at("frame")?, at("joint")?);
    let columns: Vec<usize> = COLUMNS.iter().map(|c| at(c)).collect::<Result<_, _>>()?;
    let halves: Vec<usize> =
        COLUMNS.iter().map(|c| at(&format!("interval95_{c}"))).collect::<Result<_, _>>()?;
    let mut errors: [Vec<f64>; 6] = Default::default();
    let mut held = [0; 6];
    for row in table.records() {
        let row = row?;
        let of = |list: &[(String, Pose)]| {
            list.iter().find(|(label, _)| same_frame(&row[frame_at], label)).map(|k| k.1)
        };
        let (Some(femur), Some(tibia)) = (of(&known.0), of(&known.1)) else { continue };
        if row[joint_at] != *name {
            continue;
        }
        let truth = values(placed(&femur, &proximal), placed(&tibia, &distal), joint.side);
        for k in 0..6 {
            // A row without a value is as wrong as can be.
            let off = row[columns[k]].parse::<f64>().map_or(f64::INFINITY, |found| (found - truth[k]).abs());
            held[k] += usize::from(row[halves[k]].parse::<f64>().is_ok_and(|half| off <= half));
            errors[k].push(off);
        }
    }
    let frames = errors[0].len();
    println!("joint {name}: {frames} of {} frames with known poses of both bodies", known.0.len());
    let mut well = frames > 0 && frames == known.0.len();
    for (k, errors) in errors.into_iter().enumerate() {
        let found = Distribution::of(errors);
        let limit = if k < 3 { limit_deg } else { limit_mm };
        well &= found.worst <= limit;
        println!(
            "  {:22} {found}; limit {limit}; 95 % interval holds the truth in {} of {frames}",
            COLUMNS[k], held[k]
        );
    }
    Ok(well)
}
