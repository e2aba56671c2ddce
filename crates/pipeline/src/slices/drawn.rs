//! What a person drew in slices: `edits/slices/<bone>/<slice>.svg` or `.csv`, the same files as those of frames. Nothing here writes.

use std::path::PathBuf;

use biplane_acquisition::edits::read_edit;
use biplane_artifact::{ContentHash, ContentHasher, EditedContour, SliceContours};
use biplane_slices::Across;
use biplane_stage::Hashed;

use super::SLICES;
use crate::diagnostics::meant;
use crate::edits::{entries, file_name, is_edit};
use crate::sources::VolumeFacts;
use crate::study::{SlicedBone, Study};

/// What a person drew in one slice.
#[derive(Debug, Clone)]
pub struct DrawnSlice {
    /// Number of the slice.
    pub slice: usize,
    /// Its file, relative to the study's folder.
    pub file: String,
    /// The closed pieces, px; none says that the bone is not in that slice.
    pub contour: Hashed<EditedContour>,
    /// Whether a person changed it; otherwise it is as the program wrote it, and no edit.
    pub touched: bool,
    /// Whether the volume is another one than the file was written for, or is cut another way.
    pub volume_changed: bool,
    /// Worth a look.
    pub warnings: Vec<String>,
}

/// The files of the slices of each bone, with the number of the slice.
pub type SliceFiles = Vec<Vec<(usize, PathBuf)>>;

/// The files of each bone, and those that are of none, with the reason.
pub fn find(study: &Study) -> (SliceFiles, Vec<(PathBuf, String)>) {
    let mut files: SliceFiles = study.slices.iter().map(|_| Vec::new()).collect();
    let mut strays = Vec::new();
    if study.slices.is_empty() {
        return (files, strays);
    }
    for folder in entries(&study.edits().join(SLICES)) {
        let name = file_name(&folder);
        if !folder.is_dir() {
            if is_edit(&folder) {
                strays.push((folder, "expected edits/slices/BONE/SLICE.svg".to_owned()));
            }
            continue;
        }
        let bone = study.slices.iter().position(|s| s.name == name);
        for file in entries(&folder).into_iter().filter(|p| is_edit(p)) {
            let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let list = bone.and_then(|bone| files.get_mut(bone));
            match (list, stem.parse::<usize>()) {
                (Some(list), Ok(slice)) => list.push((slice, file)),
                (None, _) => {
                    let known = study.slices.iter().map(|s| s.name.as_str());
                    strays.push((file, format!("[[slices]] has no bone `{name}`: {}", meant(&name, known))));
                }
                (Some(_), Err(_)) if stem.ends_with(".new") => strays.push((
                    file,
                    "it was written beside the edit that is used; take what you need from it".to_owned(),
                )),
                (Some(_), Err(_)) => {
                    strays.push((file, "its name is not the number of a slice, such as 17.svg".to_owned()));
                }
            }
        }
    }
    (files, strays)
}

/// What a drawing of a slice is of: the volume and the way it is cut.
pub fn picture_hash(facts: &VolumeFacts, across: Across) -> ContentHash {
    let mut hasher = ContentHasher::new("slice", 1);
    hasher.text(&facts.hash().to_hex()).text(&format!("{across:?}"));
    hasher.finish()
}

/// Reads what was drawn in the slices of a bone; a file that says nothing of it is left out.
///
/// # Errors
/// There are several files for a slice, or a file cannot be used: says which, where in it, and what to do.
pub fn read(
    study: &Study,
    bone: &SlicedBone,
    files: &[(usize, PathBuf)],
    contours: &SliceContours,
    facts: &VolumeFacts,
) -> Result<Vec<DrawnSlice>, Vec<String>> {
    let (mut drawn, mut faults) = (Vec::new(), Vec::new());
    for (place, (slice, path)) in files.iter().enumerate() {
        let file = study.relative(path);
        if let Some((_, other)) = files.iter().take(place).find(|(number, _)| number == slice) {
            let other = study.relative(other);
            faults.push(format!("{other} and {file} are both for slice {slice}; keep one of them"));
            continue;
        }
        if *slice >= contours.slices.len() {
            let last = contours.slices.len().saturating_sub(1);
            faults.push(format!(
                "{file}: the volume has the slices 0 to {last}; name the file after one of them"
            ));
            continue;
        }
        match read_one(bone, *slice, path, &file, contours, facts) {
            Ok(found) => drawn.extend(found),
            Err(message) => faults.push(study.shorten(&message)),
        }
    }
    drawn.sort_by_key(|d| d.slice);
    if faults.is_empty() { Ok(drawn) } else { Err(faults) }
}

fn read_one(
    bone: &SlicedBone,
    slice: usize,
    path: &std::path::Path,
    file: &str,
    contours: &SliceContours,
    facts: &VolumeFacts,
) -> Result<Option<DrawnSlice>, String> {
    let size = [contours.columns, contours.rows];
    let edit = read_edit(path, &[bone.name.as_str()], size).map_err(|e| e.to_string())?;
    let mut warnings: Vec<String> = edit.notes.iter().map(|note| format!("{file}: {note}")).collect();
    let volume_changed = edit.about.picture.is_some_and(|hash| hash != picture_hash(facts, bone.find.across));
    let Some(body) = edit.bodies.into_iter().next() else { return Ok(None) };
    if body.touched {
        if let Some(open) = body.contour.pieces.iter().find(|p| !p.closed) {
            return Err(format!(
                "{file}: piece `{}` is open, or leaves the slice; a bone's contour in a slice is closed: close the path (in a table, \
                 end at its first point or say closed = 1), within the picture and without marks",
                open.name
            ));
        }
        let other =
            [("slice", &edit.about.frame, slice.to_string()), ("bone", &edit.about.view, bone.name.clone())];
        let other =
            other.iter().find_map(|(what, said, is)| Some((what, said.as_ref().filter(|s| *s != is)?)));
        if let Some((what, said)) = other {
            warnings.push(format!("{file} was written for {what} {said}; it is used here, as its name says"));
        } else if volume_changed {
            warnings.push(format!(
                "{file}: the volume has changed since it was drawn; it is used, look whether it still fits"
            ));
        }
    }
    Ok(Some(DrawnSlice {
        slice,
        file: file.to_owned(),
        contour: Hashed::new(body.contour),
        touched: body.touched,
        volume_changed,
        warnings,
    }))
}
