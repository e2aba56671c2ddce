//! MayaCam 1.0: one camera in five lines of three comma values, as XMALab exports it and Autoscoper reads it.
//!
//! ```text
//! x,y,z             the source
//! rx,ry,rz          degrees; the camera's axes (right, up, back) are the columns of Rz(rz) Ry(ry) Rx(rx)
//! px,py,pz          middle of the film plane in the camera's axes: scale (W/2 - u0, H/2 - v0, Z)
//! u0,v0,Z           principal point, counted from 1, rows upward; focal length in pixels, negative
//! scale,W,H         0 for W or H means 1024
//! ```
//!
//! XMALab writes `u0 = cx + 1`, `v0 = (H - 1 - cy) + 1`, `Z = -(fx + fy)/2` and a scale of 0.1 that is not a pixel's size;
//! so the third line and the scale are not used here, as Autoscoper does not use them. Lengths are taken as mm, the unit of
//! XMALab's cube; Autoscoper's comments say cm, and its sample file has mm.

use std::path::Path;

use biplane_artifact::PixelOrigin;
use nalgebra::{Matrix3, Rotation3, Vector3};

use super::camera::{Camera, NewWorld};
use super::write::{WriteError, WriteOptions, Written, checked, number, one_focal};
use super::{CalibratedView, CalibrationError, MAX_SIDE, ReadOptions, fields, lines, quote};

/// Pixels of a side that the file gives as 0.
const DEFAULT_SIDE: f64 = 1024.0;
/// What XMALab writes as scale.
const SCALE: f64 = 0.1;

/// Whether a text is five lines of three numbers.
pub(super) fn is_mayacam1(text: &str) -> bool {
    let triple = |l: &str| fields(l).iter().filter(|f| f.parse::<f64>().is_ok()).count() == 3;
    lines(text).count() == 5 && lines(text).all(|(_, line)| triple(line))
}

pub(super) fn parse(
    path: &Path,
    text: &str,
    options: &ReadOptions,
) -> Result<CalibratedView, CalibrationError> {
    let value = |what: String| CalibrationError::Value { path: path.to_owned(), what };
    let mut rows = [[0.0; 3]; 5];
    let mut given = lines(text);
    for row in &mut rows {
        let (line, found) = given.next().unwrap_or((text.lines().count() + 1, "the end of the file"));
        let numbers: Vec<f64> =
            fields(found).iter().filter_map(|f| f.parse().ok().filter(|v: &f64| v.is_finite())).collect();
        *row = <[f64; 3]>::try_from(numbers).map_err(|_| CalibrationError::Line {
            path: path.to_owned(),
            line,
            expected: "three finite numbers".to_owned(),
            found: quote(found),
        })?;
    }
    let [source, degrees, _, [u0, v0, z], [_, width, height]] = rows;
    let side = |given: f64| if given == 0.0 { DEFAULT_SIDE } else { given };
    let (width, height) = (side(width), side(height));
    if [width, height].iter().any(|s| !(1.0..=MAX_SIDE).contains(s) || s.fract() != 0.0) {
        return Err(value(format!(
            "line 5 says {width} x {height} pixels; expected scale, width and height, whole numbers from 1 to {MAX_SIDE}"
        )));
    }
    if z >= 0.0 {
        return Err(value(format!(
            "line 4 has the focal length {z}; expected u0,v0,Z with a negative Z: MayaCam 1.0 looks along -z"
        )));
    }
    let half = if options.pixel_origin == PixelOrigin::Corner { 0.5 } else { 0.0 };
    let camera = Camera {
        focal: [-z; 2],
        skew: 0.0,
        principal: [u0 - 1.0 - half, height - v0 - half],
        axes: towards_opencv(&camera_axes(degrees)),
        source: source.into(),
    };
    let calibration = camera.calibration("", [width as usize, height as usize], None);
    Ok(CalibratedView { calibration, pixel_mm: None, coefficients: None, covariance: false })
}

/// Right, up and back as columns, from angles about x, y, z in degrees.
fn camera_axes(degrees: [f64; 3]) -> Matrix3<f64> {
    // nalgebra's roll, pitch, yaw: Rz(yaw) Ry(pitch) Rx(roll).
    let [roll, pitch, yaw] = degrees.map(f64::to_radians);
    Rotation3::from_euler_angles(roll, pitch, yaw).into_inner()
}

/// From columns right, up, back to rows right, down, away: also the way back, of a transposed matrix.
fn towards_opencv(axes: &Matrix3<f64>) -> Matrix3<f64> {
    Matrix3::from_rows(&[
        axes.column(0).transpose(),
        -axes.column(1).transpose(),
        -axes.column(2).transpose(),
    ])
}

/// Writes one view as MayaCam 1.0.
///
/// # Errors
/// The picture is mirrored or distorted, or a skew or unequal focal lengths would move a projection by more than 0.01 px.
pub fn write_mayacam1(view: &CalibratedView, options: &WriteOptions) -> Result<Written, WriteError> {
    const FORMAT: &str = "MayaCam 1.0";
    let camera = Camera::of(&view.calibration);
    let mut lost = Vec::new();
    let focal = one_focal(&camera, &mut lost);
    let axes = towards_opencv(&camera.axes.transpose()).transpose();
    let (roll, pitch, yaw) = Rotation3::from_matrix_unchecked(axes).euler_angles();
    let [width, height] = view.calibration.size.map(|n| n as f64);
    let half = if options.pixel_origin == PixelOrigin::Corner { 0.5 } else { 0.0 };
    let (u0, v0) = (camera.principal[0] + half + 1.0, height - (camera.principal[1] + half));
    let rows: [Vector3<f64>; 5] = [
        camera.source,
        Vector3::new(roll, pitch, yaw).map(f64::to_degrees),
        Vector3::new(width / 2.0 - u0, height / 2.0 - v0, -focal) * SCALE,
        Vector3::new(u0, v0, -focal),
        Vector3::new(SCALE, width, height),
    ];
    let text: String =
        rows.iter().map(|r| format!("{},{},{}\n", number(r.x), number(r.y), number(r.z))).collect();
    if view.pixel_mm.is_some() {
        lost.push("the size of a pixel, and with it the distance of the detector".to_owned());
    }
    let back = parse(Path::new(""), &text, &options.reading()).ok();
    checked(FORMAT, &[(view, back)], &NewWorld::same(), options, lost, text)
}
