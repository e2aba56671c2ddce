//! JointTrack's poses: `JT_EULER_312` (`.jts`), `JTA_EULER_KINEMATICS` (`.jtak`) and `JTA_EULER_POSE` (`.jtap`).
//!
//! A line of labels, then `x, y, z` in mm and turns about z, x and y in degrees, `R = Rz Rx Ry`, one line a frame, `NOT_OPTIMIZED` where there
//! is none. All are in the frame of the (first) camera: x right, y up, z towards the source, its origin in the source. So a calibration is needed to come
//! to the laboratory ([`laboratory_from_camera`]).

use biplane_artifact::Calibration;
use biplane_geometry::{Pose, Vector3};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};

use super::{Poses, PosesError, decimal, numbers, short};
use crate::calibration::right_up_back_of;

/// First lines that are known.
const KINDS: [&str; 3] = ["JT_EULER_312", "JTA_EULER_KINEMATICS", "JTA_EULER_POSE"];
/// A frame without a pose.
const MISSING: &str = "NOT_OPTIMIZED";

/// Which of JointTrack's files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// `.jts`, of JointTrack Manual.
    Jts,
    /// `.jtak`, of JointTrack Auto.
    Jtak,
}

/// The frame of a view's camera as a rigid motion: `x_laboratory = R x_camera + t`; none for a mirrored picture, which these files do not know.
pub fn laboratory_from_camera(calibration: &Calibration) -> Option<Pose> {
    let axes: Matrix3<f64> = right_up_back_of(calibration)?;
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes.transpose()));
    Some(Pose::new(rotation, Vector3::from(calibration.source)))
}

/// Poses in the laboratory, of one body.
///
/// # Errors
/// The first line is not known, or a line is no pose.
pub fn read(path: &str, text: &str, laboratory_from_camera: &Pose) -> Result<Poses, PosesError> {
    let mut lines = text.lines().enumerate();
    let kind = lines.next().map(|(_, line)| line.trim()).unwrap_or_default();
    if !KINDS.contains(&kind) {
        return Err(PosesError::File {
            path: path.to_owned(),
            what: format!("begins with `{}`, expected {}", short(kind), KINDS.join(", ")),
        });
    }
    lines.next();
    let mut poses = Poses::new();
    for (number, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
        let fail = |what: String| PosesError::Line { path: path.to_owned(), line: number + 1, what };
        if line.contains(MISSING) {
            poses.push(None);
            continue;
        }
        let values = numbers(line).map_err(fail)?;
        let [x, y, z, about_z, about_x, about_y] = values[..] else {
            return Err(fail(format!(
                "{} numbers, expected x, y, z and three turns, or {MISSING}",
                values.len()
            )));
        };
        if values.iter().any(|v| !v.is_finite()) {
            return Err(fail("a number that is not finite".to_owned()));
        }
        let turn =
            |axis: Vector3, degrees: f64| UnitQuaternion::from_scaled_axis(axis * degrees.to_radians());
        let rotation =
            turn(Vector3::z(), about_z) * turn(Vector3::x(), about_x) * turn(Vector3::y(), about_y);
        let in_camera = Pose::new(rotation, Vector3::new(x, y, z));
        poses.push(Some(in_laboratory(laboratory_from_camera, &in_camera)));
    }
    Ok(poses)
}

fn in_laboratory(laboratory: &Pose, in_camera: &Pose) -> Pose {
    let rotation = laboratory.rotation();
    Pose::new(rotation * in_camera.rotation(), rotation * in_camera.translation() + laboratory.translation())
}

/// The text of a file.
pub fn write(poses: &Poses, laboratory_from_camera: &Pose, kind: Kind) -> String {
    let first = match kind {
        Kind::Jts => KINDS[0],
        Kind::Jtak => KINDS[1],
    };
    let labels = ["x_tran", "y_tran", "z_tran", "z_rot", "x_rot", "y_rot"].map(|l| format!("{l:>18}"));
    let mut text = format!("{first}\n{}\n", labels.join(","));
    let back = laboratory_from_camera.rotation().inverse();
    for pose in poses {
        match pose {
            None => text += &format!("{MISSING}\n"),
            Some(pose) => {
                let rotation = (back * pose.rotation()).to_rotation_matrix();
                let place = back * (pose.translation() - laboratory_from_camera.translation());
                let turns = z_x_y(rotation.matrix()).map(f64::to_degrees);
                let cells: Vec<String> =
                    place.iter().chain(&turns).map(|v| format!("{:>18}", decimal(*v, 9))).collect();
                text += &format!("{}\n", cells.join(","));
            }
        }
    }
    text
}

/// Turns about z, x and y that make up a rotation; the last is 0 at a lock.
fn z_x_y(r: &Matrix3<f64>) -> [f64; 3] {
    let about_x = r[(2, 1)].clamp(-1.0, 1.0).asin();
    if about_x.cos() > 1e-9 {
        [(-r[(0, 1)]).atan2(r[(1, 1)]), about_x, (-r[(2, 0)]).atan2(r[(2, 2)])]
    } else {
        [r[(1, 0)].atan2(r[(0, 0)]), about_x, 0.0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::poses::tests::{any, damage, same};

    fn view() -> Pose {
        let rotation = UnitQuaternion::from_euler_angles(0.4, -1.2, 2.0);
        Pose::new(rotation, Vector3::new(300.0, -900.0, 120.0))
    }

    #[test]
    fn what_is_written_comes_back_through_the_camera() {
        let poses = any(28, 1);
        for kind in [Kind::Jts, Kind::Jtak] {
            let text = write(&poses, &view(), kind);
            same(&poses, &read("x.jts", &text, &view()).unwrap(), 1e-6, 1e-7);
        }
    }

    #[test]
    fn a_body_before_the_source_lies_at_negative_z() {
        let calibration = Calibration {
            view: "A".to_owned(),
            size: [1024, 1024],
            source: [0.0, 0.0, -1000.0],
            matrix: [[2000.0, 0.0, 512.0], [0.0, 2000.0, 512.0], [0.0, 0.0, 1.0]],
            distortion: None,
        };
        let camera = laboratory_from_camera(&calibration).unwrap();
        let pose = Pose::new(UnitQuaternion::identity(), Vector3::new(5.0, 7.0, 20.0));
        let text = write(&vec![Some(pose)], &camera, Kind::Jts);
        let values = numbers(text.lines().nth(2).unwrap()).unwrap();
        // Rows of the picture grow downwards, JointTrack's y grows upwards.
        assert_eq!(values[..3], [5.0, -7.0, -1020.0]);
    }

    #[test]
    fn no_damage_makes_the_reader_panic_and_others_files_are_told() {
        damage(&write(&any(5, 4), &view(), Kind::Jts), |text| drop(read("x.jts", text, &view())));
        let error = read("x.jts", "frame,x\n", &view()).unwrap_err().to_string();
        assert!(error.starts_with("x.jts: begins with `frame,x`, expected JT_EULER_312"), "{error}");
    }
}
