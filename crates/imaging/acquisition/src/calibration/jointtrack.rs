//! Calibrations of JointTrack, one-plane (`JT_INTCALIB`, `JTA_INTCALIB`) and two-plane (`JTA_INTCALIB_BIPLANE`).
//!
//! ```text
//! JT_INTCALIB            JTA_INTCALIB_BIPLANE
//! distance, mm           the four numbers of A, the four of B
//! x0, mm                 origin of B in A: three numbers, mm
//! y0, mm                 axes of B, Q: nine numbers, row by row; p_B = Q' (p_A - origin)
//! size of a pixel, mm
//! ```
//!
//! Numbers stand on lines of their own or between commas, blanks or tabs. The camera is the world (of two, camera A): the
//! source is its origin, x to the right, y up, z towards the source, so objects have negative z. With the distance `f`
//! and a pixel of `p`: column = W/2 + x0/p - (f/p) X/Z, and the same with H, y0 and Y for rows counted from the bottom.
//! How many pixels a picture has is not in the file: the reader is told.

use std::path::Path;

use biplane_artifact::PixelOrigin;
use nalgebra::{Matrix3, RowVector3, Vector3};

use super::camera::{Camera, NewWorld, nearest_rotation};
use super::write::{WriteError, WriteOptions, Written, checked, number, one_focal, pixel_mm};
use super::{CalibratedView, CalibrationError, ReadOptions, quote};

/// First words of the one-plane form.
const ONE_PLANE: [&str; 2] = ["JT_INTCALIB", "JTA_INTCALIB"];
/// First word of the two-plane form.
const TWO_PLANE: &str = "JTA_INTCALIB_BIPLANE";

/// How many views a text says that it has, by its first word.
pub(super) fn planes(text: &str) -> Option<usize> {
    let first = text.split(is_between).find(|w| !w.is_empty())?;
    if ONE_PLANE.contains(&first) {
        Some(1)
    } else if first == TWO_PLANE {
        Some(2)
    } else {
        None
    }
}

fn is_between(c: char) -> bool {
    c == ',' || c.is_whitespace()
}

/// The numbers after the first word.
fn numbers<const N: usize>(path: &Path, text: &str) -> Result<[f64; N], CalibrationError> {
    let words = text
        .lines()
        .enumerate()
        .flat_map(|(i, line)| line.split(is_between).filter(|w| !w.is_empty()).map(move |w| (i + 1, w)));
    let mut words = words.skip(1);
    let mut values = [0.0; N];
    for (place, value) in values.iter_mut().enumerate() {
        let (line, word) = words.next().unwrap_or((text.lines().count() + 1, ""));
        *value = word.parse().ok().filter(|v: &f64| v.is_finite()).ok_or_else(|| CalibrationError::Line {
            path: path.to_owned(),
            line,
            expected: format!("number {} of {N} after the first word", place + 1),
            found: quote(word),
        })?;
    }
    match words.next() {
        None => Ok(values),
        Some((line, word)) => Err(CalibrationError::Line {
            path: path.to_owned(),
            line,
            expected: format!("the end of the file after {N} numbers"),
            found: quote(word),
        }),
    }
}

/// Reads the one view, or the two, in the frame of the first camera.
pub(super) fn parse(
    path: &Path,
    text: &str,
    options: &ReadOptions,
) -> Result<Vec<(String, CalibratedView)>, CalibrationError> {
    let size = options.size.ok_or_else(|| CalibrationError::NeedsSize { path: path.to_owned() })?;
    if planes(text) == Some(1) {
        let plane = numbers::<4>(path, text)?;
        return Ok(vec![(
            String::new(),
            view(path, plane, Matrix3::identity(), Vector3::zeros(), size, options)?,
        )]);
    }
    let all = numbers::<20>(path, text)?;
    let four = |from: usize| [all[from], all[from + 1], all[from + 2], all[from + 3]];
    let (axes, off) = nearest_rotation(Matrix3::from_row_slice(&all[11..20]));
    let value = |what: String| CalibrationError::Value { path: path.to_owned(), what };
    if off > 1e-3 || axes.determinant() < 0.0 {
        return Err(value(format!(
            "the axes of camera B are no rotation: they differ from unit vectors at right angles by {off:.2e} (expected at \
             most 1e-3) or mirror"
        )));
    }
    let origin = Vector3::new(all[8], all[9], all[10]);
    let a = view(path, four(0), Matrix3::identity(), Vector3::zeros(), size, options)?;
    let b = view(path, four(4), axes, origin, size, options)?;
    Ok(vec![("A".to_owned(), a), ("B".to_owned(), b)])
}

/// A view from its four numbers, the camera's axes as columns, and where it stands.
fn view(
    path: &Path,
    [distance, x0, y0, pixel]: [f64; 4],
    axes: Matrix3<f64>,
    source: Vector3<f64>,
    size: [usize; 2],
    options: &ReadOptions,
) -> Result<CalibratedView, CalibrationError> {
    if distance <= 0.0 || pixel <= 0.0 || pixel > 100.0 {
        return Err(CalibrationError::Value {
            path: path.to_owned(),
            what: format!(
                "a distance of {distance} mm and pixels of {pixel} mm; expected, in this order, the distance of source and \
                 detector (mm), two offsets (mm) and the side of a pixel (mm)"
            ),
        });
    }
    let camera = Camera {
        focal: [distance / pixel; 2],
        skew: 0.0,
        principal: principal([x0 / pixel, y0 / pixel], size, options.pixel_origin),
        axes: right_down_away(&axes),
        source,
    };
    let calibration = camera.calibration("", size, None);
    Ok(CalibratedView { calibration, pixel_mm: Some(pixel), coefficients: None, covariance: false })
}

/// The principal point from its offsets to the right and up from `(W/2, H/2)`, px; and, being its own inverse, back.
fn principal(offset: [f64; 2], size: [usize; 2], origin: PixelOrigin) -> [f64; 2] {
    let [x, y] = middle(size, origin);
    [x + offset[0], y - offset[1]]
}

/// Where the file's `(W/2, H/2)`, rows from the bottom, lies when the centre of the first pixel at the top is (0, 0).
fn middle(size: [usize; 2], origin: PixelOrigin) -> [f64; 2] {
    let half = if origin == PixelOrigin::Corner { 0.5 } else { 0.0 };
    let [width, height] = size.map(|n| n as f64);
    [width / 2.0 - half, height - 1.0 - (height / 2.0 - half)]
}

/// Rows right, down, away from columns right, up, towards the source.
fn right_down_away(axes: &Matrix3<f64>) -> Matrix3<f64> {
    let row = |i: usize, sign: f64| -> RowVector3<f64> { axes.column(i).transpose() * sign };
    Matrix3::from_rows(&[row(0, 1.0), row(1, -1.0), row(2, -1.0)])
}

/// The axes of a camera as JointTrack has them, as rows: right, up, towards the source.
fn right_up_back(camera: &Camera) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0)) * camera.axes
}

/// Right, up and towards the source, as rows, of a view whose picture is as seen from the source; none of a mirrored one.
pub fn right_up_back_of(calibration: &biplane_artifact::Calibration) -> Option<Matrix3<f64>> {
    let camera = Camera::of(calibration);
    (!camera.is_mirrored()).then(|| right_up_back(&camera))
}

/// The four numbers of a view, on a line each.
fn four(
    format: &'static str,
    view: &CalibratedView,
    options: &WriteOptions,
    lost: &mut Vec<String>,
) -> Result<String, WriteError> {
    let camera = Camera::of(&view.calibration);
    let pixel = pixel_mm(format, view, options)?;
    let middle = middle(view.calibration.size, options.pixel_origin);
    let offset = [camera.principal[0] - middle[0], middle[1] - camera.principal[1]].map(|px| px * pixel);
    let distance = one_focal(&camera, lost) * pixel;
    Ok([distance, offset[0], offset[1], pixel].map(|v| number(v) + "\n").concat())
}

/// The frame of a camera instead of the laboratory's.
fn world_of(camera: &Camera) -> NewWorld {
    NewWorld { rotation: right_up_back(camera), origin: camera.source }
}

/// How to come back from the frame of a camera.
fn way_back(world: &NewWorld) -> String {
    let axes = world.rotation.transpose();
    let row = |i: usize| {
        format!("{:.9},{:.9},{:.9},{:.6}", axes[(i, 0)], axes[(i, 1)], axes[(i, 2)], world.origin[i])
    };
    format!(
        "the camera is the world of this format; laboratory_from_camera, row by row: {} / {} / {}",
        row(0),
        row(1),
        row(2)
    )
}

/// One view of what was written.
fn read_back(
    text: &str,
    place: usize,
    of: &CalibratedView,
    options: &WriteOptions,
) -> Option<CalibratedView> {
    let reading = ReadOptions { size: Some(of.calibration.size), ..options.reading() };
    Some(parse(Path::new(""), text, &reading).ok()?.into_iter().nth(place)?.1)
}

/// Writes one view for JointTrack: `JT_INTCALIB`.
///
/// # Errors
/// The size of a pixel is not known, the picture is mirrored or distorted, or a skew or unequal focal lengths would move a
/// projection by more than 0.01 px.
pub fn write_jointtrack(view: &CalibratedView, options: &WriteOptions) -> Result<Written, WriteError> {
    const FORMAT: &str = "JointTrack, one plane";
    let mut lost =
        vec!["the laboratory's frame: one view alone has none".to_owned(), "the picture's size".to_owned()];
    let text = format!("{}\n{}", ONE_PLANE[0], four(FORMAT, view, options, &mut lost)?);
    let world = world_of(&Camera::of(&view.calibration));
    let back = read_back(&text, 0, view, options);
    let mut written = checked(FORMAT, &[(view, back)], &world, options, lost, text)?;
    written.notes.push(way_back(&world));
    Ok(written)
}

/// Writes two views for JointTrack: `JTA_INTCALIB_BIPLANE`. The frame of the first one's camera becomes the world.
///
/// # Errors
/// As [`write_jointtrack`].
pub fn write_jointtrack_biplane(
    views: [&CalibratedView; 2],
    options: &WriteOptions,
) -> Result<Written, WriteError> {
    const FORMAT: &str = "JointTrack, two planes";
    let [a, b] = views;
    let mut lost =
        vec!["the laboratory's frame: camera A is the world".to_owned(), "the pictures' size".to_owned()];
    let mut text = format!("{TWO_PLANE}\n");
    for view in views {
        text += &four(FORMAT, view, options, &mut lost)?;
    }
    let (camera_a, camera_b) = (Camera::of(&a.calibration), Camera::of(&b.calibration));
    let world = world_of(&camera_a);
    let origin = world.rotation * (camera_b.source - world.origin);
    let axes = world.rotation * right_up_back(&camera_b).transpose();
    for v in origin.iter() {
        text += &(number(*v) + "\n");
    }
    for row in axes.row_iter() {
        text += &format!("{},{},{}\n", number(row[0]), number(row[1]), number(row[2]));
    }
    let pairs = [(a, read_back(&text, 0, a, options)), (b, read_back(&text, 1, b, options))];
    let mut written = checked(FORMAT, &pairs, &world, options, lost, text)?;
    written.notes.push(way_back(&world));
    if a.calibration.size != b.calibration.size {
        written.notes.push("the two pictures differ in size; JointTrack takes them as one".to_owned());
    }
    Ok(written)
}
