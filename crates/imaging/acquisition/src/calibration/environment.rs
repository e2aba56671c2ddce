//! The fluoroscopes that this program found from beads ([`Environment`]), as it stores them: JSON, all views in one file.
//!
//! Each view's projection is taken as it stands. The distortion is not in it: that is in the plate's fit, so what is read
//! here is for corrected pictures unless a table is given beside.

use std::path::Path;

use biplane_artifact::{Artifact, Calibration, Environment, ViewEnvironment};
use nalgebra::{Matrix3, Vector3};

use super::{CalibratedView, CalibrationError, MAX_SIDE};

/// Whether a JSON text has the keys of an environment.
pub(super) fn is_environment(text: &str) -> bool {
    text.starts_with('{')
        && ["\"views\"", "\"bead_frames\"", "\"triangulated\""].iter().all(|k| text.contains(k))
}

pub(super) fn parse(path: &Path, text: &str) -> Result<Vec<(String, CalibratedView)>, CalibrationError> {
    let value = |what: String| CalibrationError::Value { path: path.to_owned(), what };
    let environment = Environment::decode(text.as_bytes()).map_err(|e| value(e.to_string()))?;
    environment
        .views
        .into_iter()
        .map(|view| {
            let name = view.view.clone();
            let view = read(view).map_err(|what| value(format!("view {name}: {what}")))?;
            Ok((name, view))
        })
        .collect()
}

fn read(view: ViewEnvironment) -> Result<CalibratedView, String> {
    let ViewEnvironment { view, size, pixel_mm, source, matrix, .. } = view;
    if size.iter().any(|s| !(1.0..=MAX_SIDE).contains(&(*s as f64))) {
        return Err(format!("size is {} x {} pixels; expected 1 to {MAX_SIDE}", size[0], size[1]));
    }
    if !(pixel_mm > 0.0 && pixel_mm < 100.0) {
        return Err(format!("pixel_mm is {pixel_mm}; expected the side of a pixel in mm"));
    }
    let m = Matrix3::from_fn(|i, j| matrix[i][j]);
    let depth = Vector3::from(matrix[2]).norm();
    let usable = m.iter().chain(&source).all(|v| v.is_finite()) && m.try_inverse().is_some();
    if !usable || (depth - 1.0).abs() > 1e-6 {
        return Err(format!(
            "its matrix is no projection (the third row has length {depth}; expected 1, the depth in mm); run the \
             calibration again"
        ));
    }
    let calibration = Calibration { view, size, source, matrix, distortion: None };
    Ok(CalibratedView { calibration, pixel_mm: Some(pixel_mm), coefficients: None, covariance: true })
}
