//! `biplane edit --slices`: contours of slices written into `edits/slices/` for a person to put right. **No file that is there is
//! ever overwritten.**

use std::path::{Path, PathBuf};

use biplane_acquisition::edits::{Sketch, SketchBody, SketchPiece, write_drawing, write_table};
use biplane_artifact::{ContourSlice, Frame, SliceContour, Volume};
use biplane_slices::turned;
use biplane_stage::{Context, Store};

use super::drawn::picture_hash;
use super::edited::pixel_mm;
use super::walk::{Sliced, read, walk};
use super::{SLICES, flags_of};
use crate::diagnostics::slashes;
use crate::edit::{EditCommandError, create, known, own_backdrop, shown_copy};
use crate::overlay::COLOURS;
use crate::prepare::Prepared;
use crate::study::Study;
use crate::walk::Way;

/// Which slices, and how.
#[derive(Debug, Clone, Copy)]
pub struct SliceWish<'a> {
    /// The bone.
    pub bone: &'a str,
    /// This slice alone; without it, those that a person should look at.
    pub slice: Option<&'a str>,
    /// As tables, not as drawings.
    pub csv: bool,
    /// Beside the edits that are there, as `.new`.
    pub again: bool,
}

/// Writes what is wished and says what was written, and what to do with it.
///
/// # Errors
/// See [`EditCommandError`]; what was written before it stays.
pub fn edit_slices(study: Study, wish: &SliceWish<'_>) -> Result<String, EditCommandError> {
    let prepared = Prepared::of(study)?;
    let store = Store::open(&prepared.study.hidden())?;
    let context = Context::new();
    let study = &prepared.study;
    let names = || study.slices.iter().map(|s| s.name.as_str());
    known("bone in [[slices]]", Some(wish.bone), names(), |a, b| a == b)?;
    let bone = names().position(|name| name == wish.bone).unwrap_or_default();
    let (found, _) = walk(&prepared, bone, &store, &context, Way::Look(Vec::new()));
    let found = found.map_err(|e| EditCommandError::Item(e.to_string()))?;
    let (Some(automatic), Some(_)) = (&found.automatic, &found.facts) else {
        return Err(EditCommandError::Item(format!(
            "slices/{}: its contours are not up to date, or its volume cannot be read; `biplane run` first",
            wish.bone
        )));
    };
    let chosen: Vec<usize> = match wish.slice {
        Some(text) => {
            let last = automatic.slices.len().saturating_sub(1);
            let slice = text.parse().ok().filter(|n| *n <= last).ok_or_else(|| EditCommandError::NoSuch {
                what: "slice",
                wanted: text.to_owned(),
                meant: format!("the slices of {} are 0 to {last}", wish.bone),
            })?;
            vec![slice]
        }
        None => {
            let contours = found.contours.as_ref().unwrap_or(automatic);
            let flagged = contours.slices.iter().enumerate().filter(|(_, s)| !s.flags.is_empty());
            flagged.map(|(n, _)| n).collect()
        }
    };
    let (volume, ..) = read(&study.slices[bone]).map_err(EditCommandError::Item)?;
    let volume =
        turned(&volume, study.slices[bone].find.across).map_err(|e| EditCommandError::Item(e.to_string()))?;
    let (mut text, mut written) = (String::new(), 0);
    for slice in chosen {
        let old = prepared.slice_edits[bone].iter().find(|(n, _)| *n == slice).filter(|_| !wish.again);
        match (old, wish.slice) {
            (Some((_, path)), Some(_)) => return Err(EditCommandError::Exists(study.relative(path))),
            (Some((_, path)), None) => text += &format!("{} is there already\n", study.relative(path)),
            (None, _) => {
                let path = write(&prepared, bone, slice, &found, &volume, wish)?;
                text += &format!("wrote {}\n", study.relative(&path));
                written += 1;
            }
        }
    }
    Ok(text
        + match (written, wish.csv) {
            (0, _) => "nothing was written; name a slice: `biplane edit --slices BONE SLICE`\n",
            (_, true) => "Edit them where they are, then `biplane run`.\n",
            (_, false) => {
                "Open them in Inkscape: drag nodes, delete a path, draw one in the layer of the bone; every path is closed, and one \
                 within another is a hole. Save where they are, then `biplane run`.\n"
            }
        })
}

/// Writes one slice as the program finds it; returns the file.
fn write(
    prepared: &Prepared,
    bone: usize,
    slice: usize,
    found: &Sliced,
    volume: &Volume,
    wish: &SliceWish<'_>,
) -> Result<PathBuf, EditCommandError> {
    let study = &prepared.study;
    let of = &study.slices[bone];
    let (Some(contours), Some(facts)) = (&found.automatic, &found.facts) else {
        return Err(EditCommandError::NotRun(format!("slices/{}", of.name)));
    };
    let body = SketchBody {
        name: of.name.clone(),
        colour: COLOURS[0],
        pieces: pieces(&contours.slices[slice], pixel_mm(contours)),
        flags: remarks(slice, &contours.slices[slice]),
    };
    let sketch = Sketch {
        trial: SLICES.to_owned(),
        frame: slice.to_string(),
        view: of.name.clone(),
        picture: picture_hash(facts, of.find.across),
        size: [contours.columns, contours.rows],
        bodies: vec![body],
    };
    let folder = study.edits().join(SLICES).join(&of.name);
    let stem = slice.to_string();
    let new = if wish.again { ".new" } else { "" };
    let (ending, text) = if wish.csv {
        ("csv", write_table(&sketch))
    } else {
        ("svg", write_drawing(&sketch, &backdrop(volume, slice, &folder, &stem)?))
    };
    let path = folder.join(format!("{stem}{new}.{ending}"));
    create(&path, text.as_bytes()).map_err(|source| match source.kind() {
        std::io::ErrorKind::AlreadyExists => EditCommandError::Exists(study.relative(&path)),
        _ => EditCommandError::Write { path: slashes(&path), source },
    })?;
    Ok(path)
}

/// What a person should know before editing a slice.
fn remarks(number: usize, slice: &ContourSlice) -> Vec<String> {
    let flags = Some(flags_of(slice)).filter(|flags| !flags.is_empty()).map(|f| format!("look at it: {f}"));
    let how = format!(
        "Slice {number}: every path is closed, one within another is a hole, and what is here takes the place of all contours of the \
         slice. An empty layer says that the bone is not in it."
    );
    flags.into_iter().chain([how]).collect()
}

/// The contours of a slice as closed pieces.
fn pieces(slice: &ContourSlice, pixel_mm: f64) -> Vec<SketchPiece> {
    let piece = |c: &SliceContour| SketchPiece {
        points: c.points.iter().map(|p| [p.i, p.j]).collect(),
        sigmas: c.points.iter().map(|p| p.sigma_mm / pixel_mm).collect(),
        closed: true,
        trusted: [0, c.points.len().saturating_sub(1)],
    };
    slice.contours.iter().map(piece).collect()
}

/// Writes a grey picture of the slice beside the drawing, its darkest level black and its brightest white; gives its name.
fn backdrop(volume: &Volume, slice: usize, folder: &Path, stem: &str) -> Result<String, EditCommandError> {
    let samples = volume.slice(slice).unwrap_or_default();
    let (low, high) = samples.iter().fold((f32::MAX, f32::MIN), |(low, high), s| (low.min(*s), high.max(*s)));
    let range = (high - low).max(f32::MIN_POSITIVE);
    // Casting from a float saturates.
    let level = |s: &f32| ((s - low) / range * f32::from(u16::MAX)) as u16;
    let samples = samples.iter().map(level).collect();
    let frame = Frame { width: volume.columns, height: volume.rows, samples, bits: 16 };
    let bytes = shown_copy(&frame).map_err(|e| EditCommandError::Item(e.to_string()))?;
    own_backdrop(folder, stem, bytes)
}
