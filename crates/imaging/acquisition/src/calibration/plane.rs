//! The detector plane as JSON: where the source stands, where the middle of the picture lies in the laboratory, and which
//! way its columns and rows run. One file holds all views.
//!
//! ```json
//! { "pixel_mm": 0.3076, "size": [1024, 1024],
//!   "fluoroscopes": { "A": { "source": [x,y,z], "centre": [x,y,z], "u": [x,y,z], "v": [x,y,z] } } }
//! ```
//!
//! `u` is the unit vector of growing columns, `v` of growing rows. The ideal pixel `(x, y)`, counted from the centre of
//! the first one, lies at `centre + ((x - (W-1)/2) u + (y - (H-1)/2) v) pixel_mm`: `centre` is the middle of the picture,
//! whichever way pixels are counted. With `a = u pixel_mm`, `b = v pixel_mm`, `O` the point of pixel (0, 0) and `l` the
//! distance of source `s` and plane, the matrix is `l [a b (O - s)]^-1`, so that `w` is the depth in mm.
//!
//! `n` (unit normal) and `l` may be given and are then checked. A fluoroscope may have a `pixel_mm` and a `size` of its own,
//! which count before those of the file. Every other key is left alone.

use std::collections::BTreeMap;
use std::path::Path;

use biplane_artifact::Calibration;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use super::camera::{Camera, NewWorld};
use super::write::{WriteError, WriteOptions, Written, checked, one_focal, pixel_mm};
use super::{CalibratedView, CalibrationError, read_text};

#[derive(Deserialize)]
struct File {
    pixel_mm: Option<f64>,
    size: Option<[usize; 2]>,
    fluoroscopes: BTreeMap<String, Fluoroscope>,
}

#[derive(Deserialize)]
struct Fluoroscope {
    pixel_mm: Option<f64>,
    size: Option<[usize; 2]>,
    source: [f64; 3],
    centre: [f64; 3],
    u: [f64; 3],
    v: [f64; 3],
    n: Option<[f64; 3]>,
    l: Option<f64>,
}

/// Reads one view.
///
/// # Errors
/// The text is not JSON of this form (the message names line and column), has no such view, or its axes are not unit
/// vectors at right angles, its source lies in the detector's plane, or `n` or `l` contradict the rest.
pub fn read_plane_json(path: impl AsRef<Path>, view: &str) -> Result<Calibration, CalibrationError> {
    let path = path.as_ref();
    let mut views = parse(path, &read_text(path)?)?;
    match views.iter().position(|(name, _)| name == view) {
        Some(place) => Ok(views.swap_remove(place).1.calibration),
        None => Err(CalibrationError::NoSuchView {
            path: path.to_owned(),
            view: view.to_owned(),
            known: views.into_iter().map(|(name, _)| name).collect(),
        }),
    }
}

fn file(path: &Path, text: &str) -> Result<File, CalibrationError> {
    serde_json::from_str(text).map_err(|e| CalibrationError::Value {
        path: path.to_owned(),
        what: format!(
            "{e}; expected `pixel_mm`, `size` and `fluoroscopes` with `source`, `centre`, `u` and `v` each"
        ),
    })
}

/// All views, by their names.
pub(super) fn parse(path: &Path, text: &str) -> Result<Vec<(String, CalibratedView)>, CalibrationError> {
    let File { pixel_mm, size, fluoroscopes } = file(path, text)?;
    let views = fluoroscopes.into_iter().map(|(view, mut fluoroscope)| {
        fluoroscope.pixel_mm = fluoroscope.pixel_mm.or(pixel_mm);
        fluoroscope.size = fluoroscope.size.or(size);
        let read = one(path, &view, fluoroscope)?;
        Ok((view, read))
    });
    views.collect()
}

fn one(path: &Path, view: &str, fluoroscope: Fluoroscope) -> Result<CalibratedView, CalibrationError> {
    let value = |what: String| CalibrationError::Value { path: path.to_owned(), what };
    let Fluoroscope { pixel_mm, size, source, centre, u, v, n, l } = fluoroscope;
    let (Some(pixel_mm), Some(size)) = (pixel_mm, size) else {
        return Err(value(format!("fluoroscope {view} has no `pixel_mm` or no `size`, nor has the file")));
    };
    if size.iter().any(|&s| s == 0 || s > 16384) {
        return Err(value(format!("size is {} x {} pixels; expected 1 to 16384", size[0], size[1])));
    }
    if !(pixel_mm > 0.0 && pixel_mm < 100.0) {
        return Err(value(format!("pixel_mm is {pixel_mm}; expected the side of a pixel in mm")));
    }
    let [source, centre, u, v] = [source, centre, u, v].map(Vector3::from);
    let off = (u.norm() - 1.0).abs().max((v.norm() - 1.0).abs()).max(u.dot(&v).abs());
    if off > 1e-4 {
        return Err(value(format!(
            "fluoroscope {view}: u and v differ from unit vectors at right angles by {off:.2e}; expected at most 1e-4"
        )));
    }
    // Away from the source, whichever way round the picture is.
    let normal = u.cross(&v).normalize();
    let along = (centre - source).dot(&normal);
    let (normal, distance) = if along < 0.0 { (-normal, -along) } else { (normal, along) };
    if distance < 1.0 {
        return Err(value(format!(
            "fluoroscope {view}: the source lies {distance:.3} mm from the detector's plane; expected hundreds of mm"
        )));
    }
    if let Some(n) = n.map(Vector3::from)
        && (n - normal).norm() > 1e-3
    {
        return Err(value(format!(
            "fluoroscope {view}: n is [{:.4}, {:.4}, {:.4}], but u, v and the source give [{:.4}, {:.4}, {:.4}]",
            n.x, n.y, n.z, normal.x, normal.y, normal.z
        )));
    }
    if let Some(l) = l
        && (l - distance).abs() > 1e-5 * distance
    {
        return Err(value(format!(
            "fluoroscope {view}: l is {l} mm, but source and plane are {distance} mm apart"
        )));
    }
    let (a, b) = (u * pixel_mm, v * pixel_mm);
    let origin = centre - a * ((size[0] as f64 - 1.0) / 2.0) - b * ((size[1] as f64 - 1.0) / 2.0);
    let Some(inverse) = Matrix3::from_columns(&[a, b, origin - source]).try_inverse() else {
        return Err(value(format!(
            "fluoroscope {view}: the source and the detector's plane do not make a projection"
        )));
    };
    let m = inverse * distance;
    let calibration = Calibration {
        view: view.to_owned(),
        size,
        source: source.into(),
        matrix: [0, 1, 2].map(|i| [m[(i, 0)], m[(i, 1)], m[(i, 2)]]),
        distortion: None,
    };
    Ok(CalibratedView { calibration, pixel_mm: Some(pixel_mm), coefficients: None, covariance: false })
}

/// A file as it is written.
#[derive(Serialize)]
struct Out {
    fluoroscopes: BTreeMap<String, OutFluoroscope>,
}

#[derive(Serialize)]
struct OutFluoroscope {
    pixel_mm: f64,
    size: [usize; 2],
    source: [f64; 3],
    centre: [f64; 3],
    u: [f64; 3],
    v: [f64; 3],
}

/// Writes views as source and plane; each has its own size and pixels.
///
/// # Errors
/// The size of a pixel is not known, there is a distortion, or a skew or unequal focal lengths would move a projection by
/// more than 0.01 px.
pub fn write_plane_json(views: &[CalibratedView], options: &WriteOptions) -> Result<Written, WriteError> {
    const FORMAT: &str = "source and plane (JSON)";
    let mut fluoroscopes = BTreeMap::new();
    let mut lost = Vec::new();
    for view in views {
        let camera = Camera::of(&view.calibration);
        let pixel_mm = pixel_mm(FORMAT, view, options)?;
        let distance = one_focal(&camera, &mut lost) * pixel_mm;
        let size = view.calibration.size;
        let [u, v, normal] = [0, 1, 2].map(|i| camera.axes.row(i).transpose());
        let off = [0, 1].map(|a| ((size[a] as f64 - 1.0) / 2.0 - camera.principal[a]) * pixel_mm);
        let centre = camera.source + normal * distance + u * off[0] + v * off[1];
        let [source, centre, u, v] = [camera.source, centre, u, v].map(Into::into);
        let plane = OutFluoroscope { pixel_mm, size, source, centre, u, v };
        fluoroscopes.insert(view.calibration.view.clone(), plane);
    }
    // Numbers and texts always have a JSON form.
    let text = serde_json::to_string_pretty(&Out { fluoroscopes }).unwrap_or_default() + "\n";
    let back: BTreeMap<String, CalibratedView> =
        parse(Path::new(""), &text).unwrap_or_default().into_iter().collect();
    let pairs: Vec<_> = views.iter().map(|view| (view, back.get(&view.calibration.view).cloned())).collect();
    checked(FORMAT, &pairs, &NewWorld::same(), options, lost, text)
}
