//! One bone from its volume to its contours, with what a person drew, and to the sheet that shows them: run, or looked at.

use std::cell::OnceCell;
use std::path::PathBuf;

use biplane_acquisition::volumes::read_volume;
use biplane_artifact::{SliceContours, Volume};
use biplane_slices::{Slices, SlicesInputs};
use biplane_stage::{Context, Hashed, Item, ParamsText, Promised, Store};

use super::drawn::{self, DrawnSlice};
use super::edited::{SliceEdits, SliceEditsInputs, SliceEditsParams};
use crate::drawings::{DrawSlices, SliceDrawingInputs, SliceDrawingParams};
use crate::prepare::Prepared;
use crate::sources::VolumeFacts;
use crate::steps::{DRAWING, ItemError, SLICE_EDITS, SLICES};
use crate::study::SlicedBone;
use crate::walk::{Walk, Way};

/// What was found of one bone, as far as it is there.
#[derive(Debug, Default)]
pub struct Sliced {
    /// Of its volume.
    pub facts: Option<VolumeFacts>,
    /// As the program finds them.
    pub automatic: Option<Hashed<SliceContours>>,
    /// What a person drew.
    pub drawn: Vec<DrawnSlice>,
    /// With what a person drew in the place of the automatic ones.
    pub contours: Option<Hashed<SliceContours>>,
    /// Where the sheet is stored.
    pub sheet: Option<PathBuf>,
}

/// Walks over the steps of a bone; what became of each is in the walk.
///
/// # Errors
/// The run was stopped, or the store cannot be used.
pub fn walk<'a>(
    prepared: &'a Prepared,
    bone: usize,
    store: &'a Store,
    context: &'a Context,
    way: Way,
) -> (Result<Sliced, ItemError>, Walk<'a>) {
    let mut walk = Walk::new(&prepared.study, store, context, way);
    let found = of_bone(prepared, bone, &mut walk);
    if walk.input_changed {
        prepared.index.distrust(&prepared.study.slices[bone].volume);
    }
    (found, walk)
}

fn of_bone(prepared: &Prepared, number: usize, walk: &mut Walk<'_>) -> Result<Sliced, ItemError> {
    let study = &prepared.study;
    let bone = &study.slices[number];
    let item = Item::of([bone.name.as_str()]);
    let files = &prepared.slice_edits[number];
    let of_sheet = Item::of([SLICES, bone.name.as_str()]);
    // Read at most once, and not at all where everything is there.
    let volume: OnceCell<Result<Hashed<Volume>, String>> = OnceCell::new();
    let load = || volume.get_or_init(|| read(bone).map(|(volume, ..)| volume)).clone();
    let facts = prepared.index.volume(&bone.volume, || {
        let (read, notes, files) = read(bone)?;
        let facts = VolumeFacts::of(&read, notes);
        let _ = volume.set(Ok(read));
        Ok::<_, String>((facts, files))
    });
    let facts = match facts {
        Ok(facts) => facts,
        Err(message) => {
            walk.fault::<()>(SLICES, &item, &message)?;
            return Ok(Sliced::default());
        }
    };
    let mut sliced = Sliced { facts: Some(facts.clone()), ..Sliced::default() };
    let params = ParamsText::of(&bone.find).map_err(ItemError::of)?;
    let promised = SlicesInputs::<Promised> { volume: facts.promise() };
    let found =
        walk.step::<Slices>(SLICES, &item, &params, &promised, || Ok(SlicesInputs { volume: load()? }))?;
    let Some((automatic, _)) = found else {
        if !files.is_empty() {
            walk.follows(SLICE_EDITS, &item);
        }
        walk.follows(DRAWING, &of_sheet);
        return Ok(sliced);
    };
    sliced.automatic = Some(automatic.clone());
    sliced.drawn = match drawn::read(study, bone, files, &automatic, &facts) {
        Ok(drawn) => drawn,
        Err(faults) => {
            for fault in &faults {
                walk.fault::<()>(SLICE_EDITS, &item, fault)?;
            }
            return Ok(sliced);
        }
    };
    let used: Vec<&DrawnSlice> = sliced.drawn.iter().filter(|d| d.touched).collect();
    let contours = if used.is_empty() {
        automatic
    } else {
        let slices = used.iter().map(|d| d.slice).collect();
        let params = SliceEditsParams { slices, hand_sigma_px: study.edit.hand_sigma_px };
        let params = ParamsText::of(&params).map_err(ItemError::of)?;
        let drawn = used.iter().map(|d| d.contour.clone()).collect();
        let given = SliceEditsInputs { contours: automatic, drawn };
        let Some((edited, _)) = walk.ready::<SliceEdits>(SLICE_EDITS, &item, &params, given)? else {
            walk.follows(DRAWING, &of_sheet);
            return Ok(sliced);
        };
        edited
    };
    sliced.contours = Some(contours.clone());
    let params = SliceDrawingParams { bone: bone.name.clone(), across: bone.find.across };
    let params = ParamsText::of(&params).map_err(ItemError::of)?;
    let promised = SliceDrawingInputs::<Promised> { volume: facts.promise(), contours: contours.promise() };
    let given = || Ok(SliceDrawingInputs { volume: load()?, contours });
    let sheet = walk.step::<DrawSlices>(DRAWING, &of_sheet, &params, &promised, given)?;
    sliced.sheet = sheet.map(|(_, stored)| stored);
    Ok(sliced)
}

/// A volume, what its reader noted, and its files.
pub type Read = (Hashed<Volume>, Vec<String>, Vec<PathBuf>);

/// Reads a bone's volume.
///
/// # Errors
/// It cannot be read.
pub fn read(bone: &SlicedBone) -> Result<Read, String> {
    let file = read_volume(&bone.volume).map_err(|e| e.to_string())?;
    let notes = file.notes.iter().map(ToString::to_string).collect();
    Ok((Hashed::new(file.volume), notes, file.files))
}
