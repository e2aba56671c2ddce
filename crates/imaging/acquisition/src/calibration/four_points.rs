//! Four points a fluoroscope, as the thesis lists its environment (Bingham 2006, A.2.1: the viewpoint and three points of
//! the plane, its origin, one on its first axis and one on its second), with the pixels that make a picture of the plane.
//!
//! ```csv
//! view,columns,rows,point,x_mm,y_mm,z_mm,x_px,y_px
//! A,1024,1024,viewpoint,0,0,1000,,
//! A,1024,1024,origin,0,0,0,511.5,511.5
//! A,1024,1024,first,157.3,0,0,1023,511.5
//! A,1024,1024,second,0,-157.3,0,511.5,1023
//! ```
//!
//! The thesis's own matrix has the coordinates alone, and its contours are in mm on the plane; `x_px,y_px` say where in the
//! picture each point of the plane lies, the centre of the first pixel at (0, 0). Any three points of the plane that are
//! not in a line do. With `a`, `b` the steps of a column and a row on the plane, `O` the point of pixel (0, 0) and `l` the
//! distance of source `s` and plane, the matrix is `l [a b (O - s)]^-1`. So a skew, unequal pixels and a mirrored picture
//! have their place here.

use std::path::Path;

use biplane_artifact::Calibration;
use nalgebra::{Matrix2, Matrix3, Vector3};

use super::camera::{Camera, NewWorld};
use super::write::{WriteError, WriteOptions, Written, checked, number, pixel_mm};
use super::{CalibratedView, CalibrationError, MAX_SIDE, Table};

const HEADER: &str = "view,columns,rows,point,x_mm,y_mm,z_mm,x_px,y_px";
const POINTS: [&str; 4] = ["viewpoint", "origin", "first", "second"];

/// Whether a text has this header, in any order.
pub(super) fn is_four_points(text: &str) -> bool {
    let columns = ["view", "columns", "rows", "point", "x_px", "y_px"];
    Table::parse(Path::new(""), text).is_ok_and(|t| columns.iter().all(|c| t.column(c).is_some()))
}

/// What the rows of a view say so far.
#[derive(Default)]
struct Given {
    name: String,
    size: [usize; 2],
    points: [Option<[f64; 3]>; 4],
    pixels: [[f64; 2]; 4],
}

pub(super) fn parse(path: &Path, text: &str) -> Result<Vec<(String, CalibratedView)>, CalibrationError> {
    let table = Table::parse(path, text)?;
    let [view, columns, rows, point, x_px, y_px] =
        ["view", "columns", "rows", "point", "x_px", "y_px"].map(|c| table.required(c));
    let (view, columns, rows, point, x_px, y_px) = (view?, columns?, rows?, point?, x_px?, y_px?);
    let place = table.lengths(["x", "y", "z"])?;
    let mut views: Vec<Given> = Vec::new();
    for row in &table.rows {
        let name = table.text(row, view);
        let size = [table.count(row, columns)?, table.count(row, rows)?];
        if size.iter().any(|s| !(1.0..=MAX_SIDE).contains(&(*s as f64))) {
            let found = format!("{} x {}", size[0], size[1]);
            return Err(table.error(
                row.line,
                &format!("a picture of 1 to {MAX_SIDE} pixels a side"),
                &found,
            ));
        }
        let found = match views.iter().position(|v| v.name == name) {
            Some(found) => found,
            None => {
                views.push(Given { name: name.to_owned(), size, ..Given::default() });
                views.len() - 1
            }
        };
        let Some(given) = views.get_mut(found) else { continue };
        if given.size != size {
            let expected =
                format!("a picture of {} x {} pixels as in its first row", given.size[0], given.size[1]);
            return Err(table.error(row.line, &expected, &format!("{} x {}", size[0], size[1])));
        }
        let which = POINTS.iter().position(|p| *p == table.text(row, point)).ok_or_else(|| {
            table.error(row.line, "viewpoint, origin, first or second", &super::quote(table.text(row, point)))
        })?;
        if given.points[which].is_some() {
            return Err(table.error(row.line, "each point once", &format!("the {} again", POINTS[which])));
        }
        given.points[which] = Some(table.point(row, &place)?);
        if which > 0 {
            given.pixels[which] = [table.number(row, x_px)?, table.number(row, y_px)?];
        }
    }
    if views.is_empty() {
        return Err(CalibrationError::Value {
            path: path.to_owned(),
            what: "no row; expected four a view".to_owned(),
        });
    }
    views.iter().map(|given| Ok((given.name.clone(), fluoroscope(path, given)?))).collect()
}

fn fluoroscope(path: &Path, given: &Given) -> Result<CalibratedView, CalibrationError> {
    let value = |what: String| CalibrationError::Value {
        path: path.to_owned(),
        what: format!("view {}: {what}", given.name),
    };
    let mut points = [Vector3::zeros(); 4];
    for ((slot, point), name) in points.iter_mut().zip(given.points).zip(POINTS) {
        *slot =
            Vector3::from(point.ok_or_else(|| value(format!("no row for its {name}; expected four rows")))?);
    }
    let [source, origin, first, second] = points;
    let pixels = given.pixels.map(nalgebra::Vector2::from);
    // Columns: how far the two points are from the origin, in pixels and in space.
    let inverse = Matrix2::from_columns(&[pixels[2] - pixels[1], pixels[3] - pixels[1]]).try_inverse();
    let in_space = nalgebra::Matrix3x2::from_columns(&[first - origin, second - origin]);
    let steps = inverse.map(|inverse| in_space * inverse);
    let steps = steps.filter(|s| s.iter().all(|v| v.is_finite()));
    let flat = "its three points of the plane lie in a line, in space or in the picture";
    let steps = steps.ok_or_else(|| value(flat.to_owned()))?;
    let (a, b) = (steps.column(0).into_owned(), steps.column(1).into_owned());
    let normal = a.cross(&b);
    if normal.norm() < 1e-6 * a.norm() * b.norm() || normal.norm() == 0.0 {
        return Err(value(flat.to_owned()));
    }
    let corner = origin - a * pixels[1].x - b * pixels[1].y;
    let distance = (corner - source).dot(&normal.normalize()).abs();
    if distance < 1.0 {
        return Err(value(format!(
            "its viewpoint lies {distance:.3} mm from the plane of the other three points; expected hundreds of mm"
        )));
    }
    let Some(inverse) = Matrix3::from_columns(&[a, b, corner - source]).try_inverse() else {
        return Err(value("its points do not make a projection".to_owned()));
    };
    let m = inverse * distance;
    // Known only where pixels are squares.
    let square =
        (a.norm() - b.norm()).abs() < 1e-6 * a.norm() && a.dot(&b).abs() < 1e-6 * a.norm() * b.norm();
    let calibration = Calibration {
        view: given.name.clone(),
        size: given.size,
        source: source.into(),
        matrix: [0, 1, 2].map(|i| [m[(i, 0)], m[(i, 1)], m[(i, 2)]]),
        distortion: None,
    };
    let pixel_mm = square.then(|| (a.norm() + b.norm()) / 2.0);
    Ok(CalibratedView { calibration, pixel_mm, coefficients: None, covariance: false })
}

/// Writes views as four points each.
///
/// # Errors
/// The size of a pixel is not known, which says how far the plane is, or there is a distortion.
pub fn write_four_points(views: &[CalibratedView], options: &WriteOptions) -> Result<Written, WriteError> {
    const FORMAT: &str = "four points";
    let mut text = format!("{HEADER}\n");
    for view in views {
        let camera = Camera::of(&view.calibration);
        let distance = camera.focal[0] * pixel_mm(FORMAT, view, options)?;
        let [columns, rows] = view.calibration.size;
        let name = &view.calibration.view;
        let s = camera.source;
        text +=
            &format!("{name},{columns},{rows},viewpoint,{},{},{},,\n", number(s.x), number(s.y), number(s.z));
        let [right, bottom] = [columns, rows].map(|n| (n as f64 - 1.0).max(1.0));
        let middle = [right / 2.0, bottom / 2.0];
        let pixels = [middle, [right, middle[1]], [middle[0], bottom]];
        for (point, [x, y]) in POINTS[1..].iter().zip(pixels) {
            let p = s + camera.ray([x, y]) * distance;
            text += &format!(
                "{name},{columns},{rows},{point},{},{},{},{x},{y}\n",
                number(p.x),
                number(p.y),
                number(p.z)
            );
        }
    }
    let back = parse(Path::new(""), &text).unwrap_or_default();
    let mut back = back.into_iter().map(|(_, view)| view);
    let pairs: Vec<_> = views.iter().map(|view| (view, back.next())).collect();
    checked(FORMAT, &pairs, &NewWorld::same(), options, Vec::new(), text)
}
