//! The part of `biplane edits` that is of slices: the files, whether they are used, how far they moved the contours.

use biplane_artifact::{ContourSlice, EditedContour, SliceContours};
use biplane_stage::{Context, Store};

use super::drawn::DrawnSlice;
use super::edited::pixel_mm;
use super::walk::walk;
use crate::look::Fate;
use crate::prepare::Prepared;
use crate::steps::SLICE_EDITS;
use crate::walk::Way;

/// Rows of the list, and what cannot be used.
pub fn list(prepared: &Prepared, store: &Store, context: &Context) -> (Vec<Vec<String>>, Vec<String>) {
    let (mut rows, mut faults) = (Vec::new(), Vec::new());
    for (bone, files) in prepared.slice_edits.iter().enumerate().filter(|(_, files)| !files.is_empty()) {
        let study = &prepared.study;
        let name = &study.slices[bone].name;
        let (found, walk) = walk(prepared, bone, store, context, Way::Look(Vec::new()));
        if let Way::Look(looks) = walk.way {
            let failing = looks.into_iter().filter(|l| l.step == SLICE_EDITS && l.fate == Fate::Fails);
            faults.extend(failing.map(|l| l.line));
        }
        match found {
            Err(error) => faults.push(format!("slices/{name}: {error}")),
            Ok(found) => match &found.automatic {
                Some(automatic) => rows.extend(found.drawn.iter().map(|d| row(d, name, automatic))),
                None => rows.extend(files.iter().map(|(_, path)| {
                    let mut row = vec!["-".to_owned(); 7];
                    row[0] = study.relative(path);
                    row[1].clone_from(name);
                    row[6] = "`biplane run` first".to_owned();
                    row
                })),
            },
        }
    }
    (rows, faults)
}

fn row(drawn: &DrawnSlice, name: &str, automatic: &SliceContours) -> Vec<String> {
    let moved = automatic.slices.get(drawn.slice).filter(|_| drawn.touched);
    let moved = moved.and_then(|slice| moved_px(&drawn.contour, slice));
    let number = |n: Option<f64>| n.map_or_else(|| "-".to_owned(), |n| format!("{n:.2}"));
    let remark = match (drawn.touched, drawn.contour.pieces.is_empty()) {
        (false, _) => "not edited yet: it is as it was written".to_owned(),
        (true, true) => "the bone is not in this slice".to_owned(),
        (true, false) if drawn.volume_changed => "the volume has changed since".to_owned(),
        (true, false) => format!("1 px is {:.2} mm", pixel_mm(automatic)),
    };
    let used = if drawn.touched { "yes" } else { "no" };
    let [median, largest] = moved.map_or([None; 2], |m| m.map(Some));
    vec![
        drawn.file.clone(),
        name.to_owned(),
        used.to_owned(),
        number(median),
        number(largest),
        "-".to_owned(),
        remark,
    ]
}

/// How far what was drawn is from the nearest automatic point, px: median and largest. `None` where either is nothing.
fn moved_px(drawn: &EditedContour, slice: &ContourSlice) -> Option<[f64; 2]> {
    let points: Vec<[f64; 2]> =
        slice.contours.iter().flat_map(|c| c.points.iter().map(|p| [p.i, p.j])).collect();
    let nearest =
        |[x, y]: &[f64; 2]| points.iter().map(|[i, j]| (i - x).hypot(j - y)).fold(f64::INFINITY, f64::min);
    let mut far: Vec<f64> = drawn.pieces.iter().flat_map(|p| p.points.iter().map(nearest)).collect();
    far.sort_by(f64::total_cmp);
    let largest = *far.last()?;
    largest.is_finite().then(|| [far[far.len() / 2], largest])
}
