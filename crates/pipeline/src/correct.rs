//! `biplane correct`: the frames of a study without distortion, as pictures for other programs.
//!
//! The program itself never needs them: it corrects edge points. Beside the pictures of each view lies `mask_VIEW.png`, white where a
//! corrected pixel shows something that was recorded. Corrected pixels are the ideal ones that `calibration/fluoroscopes.json` and what
//! `biplane convert` makes of it count in.

use std::path::Path;

use biplane_artifact::{Circle, Frame};
use biplane_distortion::{Interpolation, Remap, RemapError};
use biplane_fluoroscope::Distortion;
use biplane_stage::{Context, Store, StoreError};
use clap::ValueEnum;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use rayon::prelude::*;

use crate::calibrate::{CalibrateError, calibrate};
use crate::diagnostics::slashes;
use crate::logging::Progress;
use crate::prepare::{InputErrors, Prepared};
use crate::results::write_if_changed;
use crate::study::Study;
use crate::walk::Way;

/// How a grey between recorded pixels is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum By {
    /// From 16 neighbours: sharper.
    Bicubic,
    /// From 4 neighbours: never beyond their greys.
    Bilinear,
}

/// Why nothing was corrected.
#[derive(Debug, thiserror::Error)]
pub enum CorrectError {
    /// Inputs that everything hangs on are wrong.
    #[error(transparent)]
    Inputs(#[from] InputErrors),
    /// The store cannot be used.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// There are no fluoroscopes.
    #[error("The calibration failed.\n{0}")]
    Calibration(#[from] CalibrateError),
    /// No view has distortion.
    #[error(
        "no fluoroscope of the study has distortion (a `plate` or a `distortion` table): its pictures are taken as corrected"
    )]
    None,
    /// A picture cannot be corrected.
    #[error("{path}: {source}")]
    Picture {
        /// Which.
        path: String,
        /// Why.
        source: RemapError,
    },
    /// A picture cannot be read, or one cannot be written.
    #[error("{0}")]
    File(String),
    /// A file with something else in it is in the way.
    #[error("{0} exists and holds something else; name another folder, or add --force")]
    Exists(String),
    /// A person stopped it.
    #[error("stopped: the pictures written so far stay")]
    Stopped,
}

/// Corrects every frame of a study into `folder`: `TRIAL/VIEW/LABEL.png`, and `mask_VIEW.png`. Returns what to say.
///
/// # Errors
/// See [`CorrectError`].
pub fn correct(
    study: Study,
    folder: &Path,
    by: By,
    force: bool,
    context: &Context,
) -> Result<String, CorrectError> {
    let prepared = Prepared::of(study)?;
    let store = Store::open(&prepared.study.hidden())?;
    let (calibrated, _) = calibrate(&prepared, &store, context, Way::Run(Vec::new()));
    let calibrated = match calibrated {
        Err(CalibrateError::Cancelled) => return Err(CorrectError::Stopped),
        other => other?.unwrap_or_default(),
    };
    let study = &prepared.study;
    let mut remaps: Vec<Option<Remap>> = Vec::new();
    for (view, calibration) in calibrated.calibrations.iter().enumerate() {
        let border: Option<Circle> = calibrated.plates.get(view).and_then(|p| p.as_ref()?.border);
        remaps.push(match &calibration.distortion {
            None => None,
            Some(table) => {
                let size = calibration.size;
                let remap = Remap::new(&Distortion::from(table), size, size, border.as_ref());
                Some(
                    remap
                        .map_err(|source| CorrectError::Picture { path: calibration.view.clone(), source })?,
                )
            }
        });
    }
    if remaps.iter().all(Option::is_none) {
        return Err(CorrectError::None);
    }
    for (remap, view) in remaps.iter().zip(&study.views) {
        if let Some(remap) = remap {
            let [width, height] = remap.size();
            let samples = remap.valid().into_iter().map(|v| if v { 255 } else { 0 }).collect();
            let mask = Frame { width, height, samples, bits: 8 };
            put(&folder.join(format!("mask_{}.png", view.name)), &mask, force)?;
        }
    }
    let interpolation = match by {
        By::Bicubic => Interpolation::Bicubic,
        By::Bilinear => Interpolation::Bilinear,
    };
    let progress = Progress::new("Correcting", prepared.jobs.len(), "frames");
    let written: Vec<usize> = prepared
        .jobs
        .par_iter()
        .map(|job| {
            if context.cancelled() {
                return Err(CorrectError::Stopped);
            }
            let trial = &study.trials[job.trial];
            let mut count = 0;
            for ((view, _), source) in trial.frames.iter().zip(&job.pictures) {
                let Some(Some(remap)) = remaps.get(*view) else { continue };
                let path = || study.relative(&source.path);
                let frame = prepared.read(source).map_err(|e| CorrectError::File(e.to_string()))?;
                let corrected = remap.frame(&frame, interpolation);
                let corrected = corrected.map_err(|source| CorrectError::Picture { path: path(), source })?;
                let place = folder.join(&trial.name).join(&study.views[*view].name);
                put(&place.join(format!("{}.png", job.label)), &corrected, force)?;
                count += 1;
            }
            progress.tick();
            Ok(count)
        })
        .collect::<Result<_, _>>()?;
    drop(progress);
    Ok(format!(
        "{} corrected pictures in {} ({interpolation:?}, {}); mask_VIEW.png is white where a pixel is valid\n",
        written.iter().sum::<usize>(),
        slashes(folder),
        "ideal pixels: as calibration/fluoroscopes.json counts them",
    ))
}

/// Writes a picture as PNG of 8 or 16 bits.
fn put(path: &Path, frame: &Frame, force: bool) -> Result<(), CorrectError> {
    let file =
        |what: &dyn std::fmt::Display| CorrectError::File(format!("cannot write {}: {what}", slashes(path)));
    let (bytes, colour) = if frame.bits <= 8 {
        let most = (1_u32 << frame.bits) - 1;
        // A PNG of 8 bits has white at 255.
        let byte = |s: &u16| (u32::from(*s) * 255 / most).min(255) as u8;
        (frame.samples.iter().map(byte).collect::<Vec<u8>>(), ExtendedColorType::L8)
    } else {
        let most = (1_u64 << frame.bits) - 1;
        let word = |s: &u16| ((u64::from(*s) * 65535 / most).min(65535) as u16).to_ne_bytes();
        (frame.samples.iter().flat_map(word).collect(), ExtendedColorType::L16)
    };
    let mut png = Vec::new();
    PngEncoder::new(&mut png)
        .write_image(&bytes, frame.width as u32, frame.height as u32, colour)
        .map_err(|e| file(&e))?;
    if !force && path.exists() && std::fs::read(path).is_ok_and(|old| old != png) {
        return Err(CorrectError::Exists(slashes(path)));
    }
    write_if_changed(path, &png).map_err(|e| file(&e))?;
    Ok(())
}
