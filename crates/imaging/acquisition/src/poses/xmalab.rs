//! XMALab's rigid bodies: a CSV with 16 numbers a frame, `R11, R12, R13, 0, R21, ..., TX, TY, TZ, 1`: the matrix from the body to the world
//! for row vectors, so the 3x3 is transposed. A header and a column with the frame's number, from 1, are optional; `NaN` where a pose is missing.

use biplane_geometry::Pose;
use nalgebra::Matrix4;

use super::{Poses, PosesError, decimal, numbers, short};

/// Frames that a file may count up to.
const MOST_FRAMES: usize = 1_000_000;

/// The names of the sixteen columns.
const COLUMNS: &str = "R11,R12,R13,0,R21,R22,R23,0,R31,R32,R33,0,TX,TY,TZ,1";

/// The poses of one body. Frames that the file passes over are missing.
///
/// # Errors
/// A line has neither 16 nor 17 numbers, or numbers that are no pose.
pub fn read(path: &str, text: &str) -> Result<Poses, PosesError> {
    let mut poses = Poses::new();
    for (number, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let fail = |what: String| PosesError::Line { path: path.to_owned(), line: number + 1, what };
        let values = match numbers(line) {
            Ok(values) => values,
            // A header.
            Err(_) if poses.is_empty() && line.contains(|c: char| c.is_alphabetic()) => continue,
            Err(what) => return Err(fail(what)),
        };
        let (frame, values) = match values[..] {
            [frame, ref values @ ..] if values.len() == 16 => {
                if frame.fract() != 0.0 || !(1.0..=MOST_FRAMES as f64).contains(&frame) {
                    let what =
                        format!("the frame's number `{}` is none from 1 to {MOST_FRAMES}", short(line));
                    return Err(fail(what));
                }
                (frame as usize - 1, values)
            }
            ref values if values.len() == 16 => (poses.len(), values),
            _ => return Err(fail(format!("{} numbers, expected 16, or 17 with the frame's", values.len()))),
        };
        let pose = if values.iter().any(|v| v.is_nan()) {
            None
        } else {
            let matrix = Matrix4::from_column_slice(values);
            let what = "these 16 numbers are not a rotation (for row vectors) and a translation";
            Some(Pose::from_matrix(&matrix).ok_or_else(|| fail(what.to_owned()))?)
        };
        if frame < poses.len() {
            return Err(fail(format!("frame {} comes twice, or out of order", frame + 1)));
        }
        poses.resize(frame, None);
        poses.push(pose);
    }
    Ok(poses)
}

/// The text of a file, with a header and the frames' numbers.
pub fn write(poses: &Poses) -> String {
    let mut text = format!("frame,{COLUMNS}\n");
    for (frame, pose) in poses.iter().enumerate() {
        let cells: Vec<String> = match pose {
            None => vec!["NaN".to_owned(); 16],
            Some(pose) => pose.matrix().iter().map(|v| decimal(*v, 12)).collect(),
        };
        text += &format!("{},{}\n", frame + 1, cells.join(","));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::poses::tests::{any, damage, same};

    #[test]
    fn what_is_written_comes_back_and_so_does_a_file_without_header_and_numbers() {
        let poses = any(20, 1);
        let text = write(&poses);
        same(&poses, &read("x.csv", &text).unwrap(), 1e-9, 1e-7);
        let bare: String =
            text.lines().skip(1).map(|l| format!("{}\n", l.split_once(',').unwrap().1)).collect();
        same(&poses, &read("x.csv", &bare).unwrap(), 1e-9, 1e-7);
        // A pose at x = 10 has its translation in the last row of the row-vector form.
        let pose =
            Pose::new(nalgebra::UnitQuaternion::identity(), biplane_geometry::Vector3::new(10.0, 0.0, 0.0));
        assert!(
            write(&vec![Some(pose)])
                .ends_with(",10.000000000000,0.000000000000,0.000000000000,1.000000000000\n")
        );
    }

    #[test]
    fn gaps_are_missing_and_faults_name_their_line() {
        let pose = any(1, 2);
        let line = write(&pose).lines().nth(1).unwrap()[1..].to_owned();
        let found = read("x.csv", &format!("1{line}\n3{line}\n")).unwrap();
        assert_eq!(found.iter().map(Option::is_some).collect::<Vec<_>>(), [true, false, true]);
        let error = read("x.csv", &format!("3{line}\n2{line}\n")).unwrap_err().to_string();
        assert_eq!(error, "x.csv:2: frame 2 comes twice, or out of order");
        let error = read("x.csv", &format!("99999999999{line}\n")).unwrap_err().to_string();
        assert!(error.contains("none from 1 to 1000000"), "{error}");
    }

    #[test]
    fn no_damage_makes_the_reader_panic() {
        damage(&write(&any(5, 4)), |text| drop(read("x.csv", text)));
    }
}
