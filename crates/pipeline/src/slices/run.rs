//! Runs the steps of all bones in volumes and writes what they gave: a table and a sheet a bone.

use std::path::{Path, PathBuf};

use biplane_artifact::{Content, Picture, SliceContours};
use biplane_stage::{Context, How, Store};
use rayon::prelude::*;

use super::table::{README, slices_csv};
use super::walk::{Sliced, walk};
use super::{SLICES, flags_of};
use crate::diagnostics::slashes;
use crate::logging::Progress;
use crate::outcome::{Failure, SlicesOutcome};
use crate::prepare::Prepared;
use crate::results::{copy_if_other, write_if_changed};
use crate::steps::{ItemError, SLICES as STEP};
use crate::walk::Way;

/// What the bones of a study gave.
#[derive(Debug, Default)]
pub struct SlicesRun {
    /// What was found, one a bone of the study.
    pub found: Vec<Sliced>,
    /// In the order of the study.
    pub outcomes: Vec<SlicesOutcome>,
    /// Step and how it was done.
    pub done: Vec<(&'static str, String, How)>,
    /// Items that could not be done.
    pub failures: Vec<Failure>,
    /// Worth a look.
    pub warnings: Vec<String>,
    /// Volumes, what was drawn, and their hashes.
    pub inputs: Vec<(String, String)>,
    /// Files that were written, and their hashes.
    pub made: Vec<(String, String)>,
    /// Files of edits that were used, and those that nobody changed.
    pub edits: [usize; 2],
}

/// Runs all bones side by side; `None` if the run was stopped.
pub fn run(prepared: &Prepared, store: &Store, context: &Context) -> Option<SlicesRun> {
    let study = &prepared.study;
    if study.slices.is_empty() {
        return Some(SlicesRun::default());
    }
    let progress = Progress::new("Slices", study.slices.len(), "bones");
    let bones: Vec<Option<SlicesRun>> = (0..study.slices.len())
        .into_par_iter()
        .map(|bone| {
            let own = if context.cancelled() { None } else { of_bone(prepared, bone, store, context) };
            progress.tick();
            own
        })
        .collect();
    let mut all = SlicesRun::default();
    for bone in bones {
        let SlicesRun { found, outcomes, done, failures, warnings, inputs, made, edits } = bone?;
        all.found.extend(found);
        all.outcomes.extend(outcomes);
        all.done.extend(done);
        all.failures.extend(failures);
        all.warnings.extend(warnings);
        all.inputs.extend(inputs);
        all.made.extend(made);
        all.edits.iter_mut().zip(edits).for_each(|(sum, part)| *sum += part);
    }
    let readme = Path::new(SLICES).join("README.txt");
    if !all.made.is_empty() {
        match write_if_changed(&study.output.join(&readme), README.as_bytes()) {
            Ok(_) => all.made.push(made(&readme, README.as_bytes())),
            Err(error) => all.warnings.push(format!("cannot write {}: {error}", slashes(&readme))),
        }
    }
    Some(all)
}

fn of_bone(prepared: &Prepared, bone: usize, store: &Store, context: &Context) -> Option<SlicesRun> {
    let study = &prepared.study;
    let name = &study.slices[bone].name;
    let volume = study.relative(&study.slices[bone].volume);
    let (found, walk) = walk(prepared, bone, store, context, Way::Run(Vec::new()));
    let mut all = SlicesRun { failures: walk.faults, ..SlicesRun::default() };
    if let Way::Run(done) = walk.way {
        all.done = done;
    }
    let found = match found {
        Ok(found) => found,
        Err(ItemError::Cancelled) => return None,
        Err(ItemError::Failed(message)) => {
            all.failures.push(Failure { item: format!("{STEP}/{name}"), message: study.shorten(&message) });
            Sliced::default()
        }
    };
    if let Some(facts) = &found.facts {
        all.inputs.push((volume.clone(), facts.hash().to_hex()));
        all.warnings.extend(facts.notes.iter().map(|note| format!("slices of {name} ({volume}): {note}")));
    }
    for drawn in &found.drawn {
        all.edits[usize::from(!drawn.touched)] += 1;
        all.warnings.extend(drawn.warnings.iter().cloned());
        if drawn.touched {
            all.inputs.push((drawn.file.clone(), drawn.contour.hash().to_hex()));
        }
    }
    let mut outcome = SlicesOutcome { bone, ..SlicesOutcome::default() };
    if let Some(contours) = &found.contours {
        all.warnings.extend(contours.warnings.iter().map(|w| format!("slices of {name}: {w}")));
        outcome.count(contours);
        if let Some(text) = outcome.to_look_at() {
            all.warnings.push(format!("slices of {name}: look at {text}"));
        }
        for (place, fault) in write(study, name, contours, &found, &mut outcome, &mut all.made) {
            let message =
                study.shorten(&format!("cannot write {}: {fault}", slashes(&study.output.join(place))));
            all.failures.push(Failure { item: format!("{STEP}/{name}"), message });
        }
    }
    all.warnings.iter_mut().for_each(|w| *w = study.shorten(w));
    all.outcomes.push(outcome);
    all.found.push(found);
    Some(all)
}

/// Writes the table and the sheet; returns what could not be written.
fn write(
    study: &crate::study::Study,
    name: &str,
    contours: &SliceContours,
    found: &Sliced,
    outcome: &mut SlicesOutcome,
    list: &mut Vec<(String, String)>,
) -> Vec<(PathBuf, std::io::Error)> {
    let mut faults = Vec::new();
    let folder = Path::new(SLICES);
    let (table, bytes) = (folder.join(format!("{name}.csv")), slices_csv(contours));
    match write_if_changed(&study.output.join(&table), &bytes) {
        Ok(_) => list.push(made(&table, &bytes)),
        Err(error) => faults.push((table.clone(), error)),
    }
    outcome.table = Some(table);
    if let Some(stored) = &found.sheet {
        let place = folder.join(format!("{name}.svg"));
        let to = study.output.join(&place);
        match copy_if_other(stored, &to).and_then(|()| std::fs::read(&to)) {
            Ok(bytes) => list.push(made(&place, &bytes)),
            Err(error) => faults.push((place.clone(), error)),
        }
        outcome.sheet = Some(place);
    }
    faults
}

/// A file as the list of what runs made has it.
fn made(place: &Path, bytes: &[u8]) -> (String, String) {
    (slashes(place), Picture(bytes.to_vec()).content_hash().to_hex())
}

impl SlicesOutcome {
    /// Counts what is in contours.
    fn count(&mut self, contours: &SliceContours) {
        self.slices = contours.slices.len();
        self.with_bone = contours.slices.iter().filter(|s| !s.contours.is_empty()).count();
        self.contours = contours.slices.iter().map(|s| s.contours.len()).sum();
        self.holes = contours.slices.iter().flat_map(|s| &s.contours).filter(|c| c.is_hole()).count();
        let numbered = || contours.slices.iter().enumerate();
        self.edited = numbered().filter(|(_, s)| s.edited).map(|(n, _)| n).collect();
        self.flagged =
            numbered().filter(|(_, s)| !s.flags.is_empty()).map(|(n, s)| (n, flags_of(s))).collect();
    }
}
