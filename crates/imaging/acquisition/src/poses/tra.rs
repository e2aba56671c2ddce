//! Autoscoper's `.tra`: one line a frame, the bones one after the other, no header, `NaN` where a pose is missing.
//!
//! The file does not say which of its dialects it has: 4x4 matrices or x, y, z, yaw, pitch, roll (`R = Rz(yaw) Ry(pitch) Rx(roll)`); matrices by
//! rows or by columns; commas or spaces; mm or cm; degrees or radians. A [`Dialect`] says it. [`dialects`] tells which of them the numbers allow.

use biplane_geometry::{Pose, Vector3};
use nalgebra::{Matrix4, UnitQuaternion};

use super::{Poses, PosesError, decimal, numbers};

/// How a pose is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layout {
    /// A 4x4 matrix, row by row.
    MatrixRows,
    /// A 4x4 matrix, column by column.
    MatrixColumns,
    /// x, y, z, yaw, pitch, roll in degrees.
    Degrees,
    /// x, y, z, yaw, pitch, roll in radians.
    Radians,
}

/// Which of its dialects a file has; commas and spaces are told apart by reading.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dialect {
    /// How a pose is written.
    pub layout: Layout,
    /// Whether lengths are in centimetres rather than millimetres.
    pub centimetres: bool,
    /// Whether numbers are parted by spaces rather than commas (of files that are written).
    pub spaces: bool,
}

impl Default for Dialect {
    /// What Autoscoper saves unless it is told otherwise.
    fn default() -> Self {
        Self { layout: Layout::MatrixRows, centimetres: false, spaces: false }
    }
}

impl Layout {
    fn width(self) -> usize {
        match self {
            Self::MatrixRows | Self::MatrixColumns => 16,
            Self::Degrees | Self::Radians => 6,
        }
    }
}

fn mm(dialect: Dialect) -> f64 {
    if dialect.centimetres { 10.0 } else { 1.0 }
}

/// One pose of a line; `Ok(None)` where a number is none.
fn pose(values: &[f64], dialect: Dialect) -> Result<Option<Pose>, String> {
    if values.iter().any(|v| v.is_nan()) {
        return Ok(None);
    }
    match dialect.layout {
        Layout::MatrixRows | Layout::MatrixColumns => {
            let matrix = if dialect.layout == Layout::MatrixRows {
                Matrix4::from_row_slice(values)
            } else {
                Matrix4::from_column_slice(values)
            };
            let mut scaled = matrix;
            for i in 0..3 {
                scaled[(i, 3)] *= mm(dialect);
            }
            Pose::from_matrix(&scaled)
                .map(Some)
                .ok_or_else(|| "these 16 numbers are not a rotation and a translation".to_owned())
        }
        Layout::Degrees | Layout::Radians => {
            let unit = if dialect.layout == Layout::Degrees { 1f64.to_radians() } else { 1.0 };
            let turn = |axis: Vector3, k: usize| UnitQuaternion::from_scaled_axis(axis * (values[k] * unit));
            let rotation = turn(Vector3::z(), 3) * turn(Vector3::y(), 4) * turn(Vector3::x(), 5);
            let pose = Pose::new(rotation, Vector3::new(values[0], values[1], values[2]) * mm(dialect));
            let finite = values.iter().all(|v| v.is_finite());
            if finite { Ok(Some(pose)) } else { Err("an infinite number".to_owned()) }
        }
    }
}

/// The poses of `bodies` bodies in the order of the file.
///
/// # Errors
/// A line has another count of numbers, or numbers that are no pose.
pub fn read(path: &str, text: &str, bodies: usize, dialect: Dialect) -> Result<Vec<Poses>, PosesError> {
    let width = dialect.layout.width();
    let mut all = vec![Poses::new(); bodies];
    for (number, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let fail = |what: String| PosesError::Line { path: path.to_owned(), line: number + 1, what };
        let values = numbers(line).map_err(fail)?;
        if values.len() != bodies * width {
            return Err(fail(format!(
                "{} numbers, expected {} for {bodies} bodies of {width} each: say how many bodies the file has, and its dialect",
                values.len(),
                bodies * width
            )));
        }
        for (poses, values) in all.iter_mut().zip(values.chunks(width)) {
            poses.push(pose(values, dialect).map_err(fail)?);
        }
    }
    Ok(all)
}

/// The text of a file.
pub fn write(bodies: &[Poses], dialect: Dialect) -> String {
    let frames = bodies.iter().map(Vec::len).max().unwrap_or(0);
    let separator = if dialect.spaces { " " } else { "," };
    let mut text = String::new();
    for frame in 0..frames {
        let cells: Vec<String> = bodies
            .iter()
            .flat_map(|poses| match poses.get(frame).copied().flatten() {
                None => vec!["NaN".to_owned(); dialect.layout.width()],
                Some(pose) => values(&pose, dialect).iter().map(|v| decimal(*v, 16)).collect(),
            })
            .collect();
        text += &cells.join(separator);
        text.push('\n');
    }
    text
}

fn values(pose: &Pose, dialect: Dialect) -> Vec<f64> {
    let mut matrix = pose.matrix();
    for i in 0..3 {
        matrix[(i, 3)] /= mm(dialect);
    }
    match dialect.layout {
        Layout::MatrixRows => matrix.transpose().iter().copied().collect(),
        Layout::MatrixColumns => matrix.iter().copied().collect(),
        Layout::Degrees | Layout::Radians => {
            let unit = if dialect.layout == Layout::Degrees { 1f64.to_radians() } else { 1.0 };
            let (roll, pitch, yaw) = pose.rotation().euler_angles();
            let turns = [yaw, pitch, roll].map(|a| a / unit);
            [matrix[(0, 3)], matrix[(1, 3)], matrix[(2, 3)]].into_iter().chain(turns).collect()
        }
    }
}

/// The layouts that the numbers of a file with `bodies` bodies allow. Lengths are never told by their numbers.
pub fn dialects(path: &str, text: &str, bodies: usize) -> Vec<Layout> {
    let allowed = |layout: &Layout| {
        let dialect = Dialect { layout: *layout, ..Dialect::default() };
        let Ok(all) = read(path, text, bodies, dialect) else { return false };
        // A turn of more than a few whole ones is none in radians.
        *layout != Layout::Radians
            || text.lines().filter_map(|l| numbers(l).ok()).all(|values| {
                values
                    .chunks(6)
                    .all(|v| v.iter().skip(3).all(|a| a.is_nan() || a.abs() <= 4.0 * std::f64::consts::PI))
            }) && all.iter().any(|p| !p.is_empty())
    };
    let all = [Layout::MatrixRows, Layout::MatrixColumns, Layout::Degrees, Layout::Radians];
    all.into_iter().filter(allowed).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::poses::tests::{any, damage, same};

    #[test]
    fn every_dialect_comes_back() {
        let bodies = vec![any(21, 1), any(21, 2)];
        for layout in [Layout::MatrixRows, Layout::MatrixColumns, Layout::Degrees, Layout::Radians] {
            for (centimetres, spaces) in [(false, false), (true, true)] {
                let dialect = Dialect { layout, centimetres, spaces };
                let text = write(&bodies, dialect);
                let back = read("x.tra", &text, 2, dialect).unwrap();
                for (a, b) in bodies.iter().zip(&back) {
                    same(a, b, 1e-9, 1e-7);
                }
                assert!(dialects("x.tra", &text, 2).contains(&layout), "{layout:?}");
            }
        }
    }

    #[test]
    fn rows_and_columns_are_told_apart_by_the_numbers() {
        let bodies = vec![any(5, 3)];
        let rows = write(&bodies, Dialect::default());
        assert_eq!(dialects("x.tra", &rows, 1), [Layout::MatrixRows]);
        let angles = write(&bodies, Dialect { layout: Layout::Degrees, ..Dialect::default() });
        assert_eq!(dialects("x.tra", &angles, 1), [Layout::Degrees]);
        let error = read("x.tra", &rows, 2, Dialect::default()).unwrap_err().to_string();
        assert!(error.starts_with("x.tra:1: 16 numbers, expected 32 for 2 bodies"), "{error}");
    }

    #[test]
    fn no_damage_makes_the_reader_panic() {
        let text = write(&[any(5, 4)], Dialect::default());
        damage(&text, |text| {
            let _ = read("x.tra", text, 1, Dialect::default());
            let _ = dialects("x.tra", text, 1);
        });
    }
}
