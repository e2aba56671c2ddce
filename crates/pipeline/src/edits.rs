//! A person's contours: which files of `edits/` belong to which picture, and what they say.
//!
//! `edits/<trial>/<frame>_<view>.svg` (or `.csv`) stands for the automatic contours of the bodies that it speaks of, in that one
//! picture. A file that nobody changed since it was written is no edit. What lies there and is of no picture is said, with the
//! name that may be meant: a person's work is not lost without a word. Nothing here writes.

use std::path::{Path, PathBuf};

use biplane_acquisition::edits::read_edit;
use biplane_artifact::EditedContour;
use biplane_stage::Hashed;

use crate::diagnostics::meant;
use crate::models::LANDMARKS;
use crate::prepare::Job;
use crate::slices::SLICES;
use crate::sources::FrameFacts;
use crate::study::{Study, Trial};
use crate::tables::same_frame;

/// Endings of files of edits.
const ENDINGS: [&str; 2] = ["svg", "csv"];

/// What a person drew in one picture.
#[derive(Debug, Clone)]
pub struct Drawn {
    /// Its file, relative to the study's folder.
    pub file: String,
    /// The bodies that it speaks of.
    pub bodies: Vec<DrawnBody>,
    /// Whether the picture is another one than the file was written for.
    pub picture_changed: bool,
    /// Worth a look.
    pub warnings: Vec<String>,
}

/// What a person drew for one body.
#[derive(Debug, Clone)]
pub struct DrawnBody {
    /// Its place among the bodies of the job.
    pub place: usize,
    /// The pieces; none where nothing of the outline is to be trusted.
    pub contour: Hashed<EditedContour>,
    /// Whether a person changed it; otherwise it is as the program wrote it, and no edit.
    pub touched: bool,
}

impl Drawn {
    /// The edit of a body of the job, if there is one.
    pub fn of(&self, place: usize) -> Option<&Hashed<EditedContour>> {
        self.bodies.iter().find(|b| b.place == place && b.touched).map(|b| &b.contour)
    }
}

/// Gives each job the files that are of its pictures, and returns those that are of none, with the reason.
pub fn find(study: &Study, jobs: &mut [Job]) -> Vec<(PathBuf, String)> {
    let mut strays = Vec::new();
    for path in entries(&study.edits()) {
        let name = file_name(&path);
        if path.is_dir() && name == SLICES && !study.slices.is_empty() {
            // What a person drew in slices: `crate::slices::drawn`.
            continue;
        }
        if path.is_dir() && name == LANDMARKS && study.bodies.iter().any(|b| b.axes.is_some()) {
            // A person's landmarks: `crate::models::landmarks`.
            continue;
        }
        if path.is_dir() {
            let Some(trial) = study.trials.iter().position(|t| t.name == name) else {
                let known = study.trials.iter().map(|t| t.name.as_str());
                let why = format!("the study has no trial `{name}`: {}", meant(&name, known));
                strays.extend(entries(&path).into_iter().filter(|p| is_edit(p)).map(|p| (p, why.clone())));
                continue;
            };
            for file in entries(&path).into_iter().filter(|p| is_edit(p)) {
                match picture_of(&file, study, trial, jobs) {
                    Ok((job, slot)) => {
                        if let Some(list) = jobs.get_mut(job).and_then(|j| j.edits.get_mut(slot)) {
                            list.push(file);
                        }
                    }
                    Err(why) => strays.push((file, why)),
                }
            }
        } else if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("svg")) {
            strays.push((
                path,
                "it lies beside the trials' folders; expected edits/TRIAL/FRAME_VIEW.svg".to_owned(),
            ));
        }
    }
    strays
}

/// What is in a folder, hidden files left out, in order.
pub(crate) fn entries(folder: &Path) -> Vec<PathBuf> {
    let read = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|e| e.path());
    let mut paths: Vec<PathBuf> = read.filter(|p| !file_name(p).starts_with('.')).collect();
    paths.sort();
    paths
}

pub(crate) fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

pub(crate) fn is_edit(path: &Path) -> bool {
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    ENDINGS.contains(&ending.as_str()) && path.is_file()
}

/// The job and the slot of a file's picture, by its name `<frame>_<view>`.
fn picture_of(file: &Path, study: &Study, trial: usize, jobs: &[Job]) -> Result<(usize, usize), String> {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let ending = file.extension().unwrap_or_default().to_string_lossy();
    if let Some(name) = stem.strip_suffix(".new") {
        return Err(format!(
            "it was written beside the edit that is used; take what you need from it, or rename it {name}.{ending}"
        ));
    }
    let Trial { name, frames, .. } = &study.trials[trial];
    let views: Vec<&str> = frames.iter().map(|(v, _)| study.views[*v].name.as_str()).collect();
    // A view's name may have a `_` in it.
    let parts = views
        .iter()
        .enumerate()
        .find_map(|(slot, view)| Some((stem.strip_suffix(view)?.strip_suffix('_')?, slot)));
    let Some((frame, slot)) = parts else {
        let view = stem.rsplit_once('_').map_or(stem.as_str(), |(_, view)| view);
        return Err(format!(
            "its name is not FRAME_VIEW: trial {name} has no view `{view}`: {}",
            meant(view, views.iter().copied())
        ));
    };
    let of_trial = jobs.iter().enumerate().filter(|(_, j)| j.trial == trial);
    let found = of_trial.clone().find(|(_, j)| same_frame(&j.label, frame));
    found.map(|(job, _)| (job, slot)).ok_or_else(|| {
        let labels: Vec<&str> = of_trial.map(|(_, j)| j.label.as_str()).collect();
        let ends = labels.first().zip(labels.last()).map(|(a, b)| format!(", it has {a} to {b}"));
        format!("trial {name} has no frame `{frame}`{}", ends.unwrap_or_default())
    })
}

/// Reads what was drawn in a picture, if anything was.
///
/// # Errors
/// There are several files for it, or its file cannot be used: says which, where in it, and what to do.
pub fn read(study: &Study, job: &Job, slot: usize, facts: &FrameFacts) -> Result<Option<Drawn>, String> {
    let path = match job.edits.get(slot).map_or(&[][..], Vec::as_slice) {
        [] => return Ok(None),
        [path] => path,
        several => {
            let names: Vec<String> = several.iter().map(|p| study.relative(p)).collect();
            return Err(format!("{} are all for one picture; keep one of them", names.join(" and ")));
        }
    };
    let trial = &study.trials[job.trial];
    let names: Vec<&str> = job.bodies.iter().map(|(body, ..)| study.bodies[*body].name.as_str()).collect();
    let edit = read_edit(path, &names, facts.size).map_err(|e| study.shorten(&e.to_string()))?;
    let file = study.relative(path);
    let mut warnings: Vec<String> = edit.notes.iter().map(|note| format!("{file}: {note}")).collect();
    let bodies: Vec<DrawnBody> = edit
        .bodies
        .into_iter()
        .map(|b| DrawnBody { place: b.body, contour: Hashed::new(b.contour), touched: b.touched })
        .collect();
    let touched = bodies.iter().any(|b| b.touched);
    let picture_changed = edit.about.picture.is_some_and(|hash| hash != facts.hash());
    let view = study.views[trial.frames[slot].0].name.as_str();
    let other = [
        ("trial", &edit.about.trial, trial.name.as_str()),
        ("frame", &edit.about.frame, job.label.as_str()),
        ("view", &edit.about.view, view),
    ];
    let other = other.iter().find_map(|(what, said, is)| Some((what, said.as_deref().filter(|s| s != is)?)));
    match other {
        Some((what, said)) if touched => {
            warnings.push(format!("{file} was written for {what} {said}; it is used here, as its name says"));
        }
        None if touched && picture_changed => {
            warnings.push(format!(
                "{file}: the picture has changed since it was drawn; it is used, look whether it still fits"
            ));
        }
        _ => {}
    }
    Ok(Some(Drawn { file, bodies, picture_changed, warnings }))
}
