//! What a person drew in slices: `edits/slices/<bone>/<slice>.svg` or `.csv`, the same files as those of frames. Nothing here writes.

use std::path::PathBuf;

use biplane_acquisition::edits::read_edit;
use biplane_artifact::{ContentHash, ContentHasher, EditedContour, EditedPiece, SliceContours};
use biplane_slices::Across;
use biplane_stage::Hashed;

use super::SLICES;
use crate::diagnostics::meant;
use crate::edits::{entries, file_name, is_edit};
use crate::sources::VolumeFacts;
use crate::study::{SlicedBone, Study};

/// An end of a piece this near to the border of the slice was cut off there, px: points are at most 1 px apart.
const BORDER_PX: f64 = 1.5;

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
    let mut contour = body.contour;
    if body.touched {
        contour = closed(contour, size).map_err(|name| {
            format!(
                "{file}: piece `{name}` is open; a bone's contour in a slice is closed: close the path, without marks (in a table, end at \
                 its first point or say closed = 1). Only at the border of the slice it may be open"
            )
        })?;
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
        contour: Hashed::new(contour),
        touched: body.touched,
        volume_changed,
        warnings,
    }))
}

/// The pieces as closed contours. Where the border of the slice cuts one, its stretches within are joined along the border.
///
/// # Errors
/// The name of a piece that is open within the slice.
fn closed(contour: EditedContour, size: [usize; 2]) -> Result<EditedContour, String> {
    let at_border =
        |p: &[f64; 2]| (0..2).any(|a| p[a] <= BORDER_PX - 0.5 || p[a] >= size[a] as f64 - 0.5 - BORDER_PX);
    let mut pieces: Vec<EditedPiece> = Vec::new();
    let mut joined: Option<String> = None;
    for piece in contour.pieces {
        if piece.closed {
            joined = None;
            pieces.push(piece);
            continue;
        }
        let ends = [piece.points.first(), piece.points.last()];
        if !ends.into_iter().flatten().all(at_border) {
            return Err(piece.name);
        }
        match pieces.last_mut().filter(|_| joined.as_ref() == Some(&piece.name)) {
            Some(last) => last.points.extend(piece.points),
            None => {
                joined = Some(piece.name.clone());
                pieces.push(EditedPiece { closed: true, ..piece });
            }
        }
    }
    Ok(EditedContour { pieces })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn piece(name: &str, points: &[[f64; 2]], closed: bool) -> EditedPiece {
        EditedPiece { name: name.to_owned(), points: points.to_vec(), closed }
    }

    #[test]
    fn what_the_border_cuts_is_closed_along_it() {
        let ring = piece("a", &[[2.0, 2.0], [4.0, 2.0], [3.0, 4.0]], true);
        let left = piece("b", &[[2.0, 19.2], [2.0, 10.0], [6.0, 10.0], [6.0, 19.4]], false);
        let right = piece("b", &[[8.0, 19.4], [8.0, 12.0], [9.0, 19.0]], false);
        let other = piece("c", &[[29.4, 5.0], [20.0, 6.0], [29.0, 9.0]], false);
        let drawn = EditedContour { pieces: vec![ring.clone(), left.clone(), right.clone(), other.clone()] };
        let all = closed(drawn, [30, 20]).unwrap().pieces;
        assert!(all.iter().all(|p| p.closed));
        assert_eq!(all[0], ring);
        assert_eq!(all[1].points, [left.points, right.points].concat());
        assert_eq!((all.len(), &all[2].points), (3, &other.points));
        let open = piece("d", &[[2.0, 19.2], [2.0, 10.0], [6.0, 10.0]], false);
        assert_eq!(closed(EditedContour { pieces: vec![open] }, [30, 20]), Err("d".to_owned()));
    }
}
