//! A person's landmarks of bodies: the file in `edits/landmarks/` where there is one, else the one that pipeline.toml names.

use std::path::PathBuf;

use biplane_acquisition::landmarks::read_landmarks;
use biplane_artifact::Landmarks;
use biplane_stage::Hashed;

use super::LANDMARKS;
use crate::diagnostics::meant;
use crate::edits::{entries, file_name};
use crate::study::{Body, Study};

/// Landmarks of a body and the file that they are from.
#[derive(Debug, Clone)]
pub struct GivenLandmarks {
    /// The file.
    pub path: PathBuf,
    /// Its points.
    pub points: Hashed<Landmarks>,
}

/// Reads a body's landmarks; `None` where a person gave none.
///
/// # Errors
/// A message: there are several files in `edits/landmarks/` for it, or the file cannot be used.
pub fn given(study: &Study, body: &Body) -> Result<Option<GivenLandmarks>, String> {
    if body.axes.is_none() {
        return Ok(None);
    }
    let own: Vec<PathBuf> = study.edited_landmarks(&body.name).into_iter().filter(|p| p.is_file()).collect();
    if let [first, second, ..] = &own[..] {
        let [first, second] = [first, second].map(|p| study.relative(p));
        return Err(format!("{first} and {second} are both landmarks of {}; keep one of them", body.name));
    }
    let Some(path) = own.into_iter().next().or_else(|| body.landmarks.clone()) else { return Ok(None) };
    let read = read_landmarks(&path).map_err(|e| e.to_string())?;
    Ok(Some(GivenLandmarks { path, points: Hashed::new(read) }))
}

/// Files in `edits/landmarks/` that are of no body with axes, with the reason.
pub fn strays(study: &Study) -> Vec<(PathBuf, String)> {
    let with_axes = || study.bodies.iter().filter(|b| b.axes.is_some()).map(|b| b.name.as_str());
    let known: Vec<PathBuf> = with_axes().flat_map(|name| study.edited_landmarks(name)).collect();
    let folder = study.edits().join(LANDMARKS);
    let strangers = entries(&folder).into_iter().filter(|path| path.is_file() && !known.contains(path));
    let told = strangers.map(|path| {
        let name = file_name(&path);
        let stem = name.split('.').next().unwrap_or_default();
        let why = if study.bodies.iter().any(|b| b.name == stem && b.axes.is_none()) {
            format!(
                "it is not said what body {stem} is: add axes = {{ body = ..., side = ... }} to its [[body]]"
            )
        } else {
            let hint = meant(stem, with_axes());
            format!("expected edits/landmarks/BODY.csv (or .fcsv, .mrk.json) of a body with axes: {hint}")
        };
        (path, why)
    });
    told.collect()
}
