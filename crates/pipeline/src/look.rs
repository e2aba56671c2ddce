//! What a run would do, without doing it: `plan` and `explain`.

use std::sync::{Mutex, PoisonError};

use biplane_artifact::{Contour, Curves, Match, Verdict};
use biplane_stage::{Context, Explanation, Hashed, Item, Store, StoreError, Stored};
use rayon::prelude::*;

use crate::calibrate::{CalibrateError, calibrate};
use crate::edits::Drawn;
use crate::joints::of_job;
use crate::joints::run::Axes;
use crate::models;
use crate::prepare::{InputErrors, Job, Prepared};
use crate::smoothing;
use crate::steps::{
    CONTOUR, EDIT, ItemError, MATCH, OVERLAY, REPORT_FRAME, REPORT_MODEL, SEGMENT, STEPS, Steps, TRACK,
    read_stored,
};
use crate::study::Study;
use crate::summary::aligned;
use crate::tracking::{Attempt, Single, Tracked, track};
use crate::walk::Way;

/// Why nothing can be said.
#[derive(Debug, thiserror::Error)]
pub enum LookError {
    /// Inputs that everything hangs on are wrong.
    #[error(transparent)]
    Inputs(#[from] InputErrors),
    /// The store cannot be used.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The calibration cannot be looked at.
    #[error(transparent)]
    Calibration(#[from] CalibrateError),
}

/// What would become of one item.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fate {
    /// It is in the store.
    Cached,
    /// It would run.
    Runs,
    /// It would run if what it follows comes out differently.
    Follows,
    /// It cannot be done.
    Fails,
}

/// One item, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Look {
    /// The step.
    pub step: &'static str,
    /// What would become of it.
    pub fate: Fate,
    /// `step/trial/frame/...: why`
    pub line: String,
}

/// Looks at every item of a study, in the order of trials and frames.
///
/// # Errors
/// Inputs that everything hangs on are wrong, or the store cannot be used.
pub fn look(study: Study) -> Result<Vec<Look>, LookError> {
    let prepared = Prepared::of(study)?;
    for warning in &prepared.warnings {
        tracing::warn!("{warning}");
    }
    let store = Store::open(&prepared.study.hidden())?;
    let context = Context::new();
    let (calibrated, way) = calibrate(&prepared, &store, &context, Way::Look(Vec::new()));
    let calibrated = calibrated?.unwrap_or_default();
    let mut made = Vec::new();
    let (models, axes) = models::look::look(&prepared, &store, &context, &mut made);
    let steps = Steps {
        prepared: &prepared,
        calibrated: &calibrated,
        models: &models,
        store: &store,
        context: &context,
    };
    let mut frames: Vec<FrameLook> = prepared.jobs.par_iter().map(|job| look_at(&steps, job)).collect();
    look_together(&steps, &axes, &mut frames);
    for body in crate::report::models::shown(&prepared.study) {
        let item = Item::from(prepared.study.bodies[body].name.as_str());
        match steps.explain_report_model(body) {
            Ok(Some(why)) => {
                let fate = if why.cached() { Fate::Cached } else { Fate::Runs };
                made.push(Look { step: REPORT_MODEL, fate, line: why.to_string() });
            }
            Ok(None) => {}
            // Whether there is a model is said where it is made.
            Err(_) if steps.ever_made(REPORT_MODEL, &item) => {
                made.push(Look::after(REPORT_MODEL, &item, true))
            }
            Err(_) => {}
        }
    }
    if let Err(error) = prepared.index.save(false) {
        tracing::debug!("the index of inputs was not written: {error}");
    }
    let before = match way {
        Way::Look(before) => before,
        Way::Run(_) => Vec::new(),
    };
    Ok(before.into_iter().chain(made).chain(frames.into_iter().flat_map(|f| f.looks)).collect())
}

/// What is known of one frame.
struct FrameLook {
    looks: Vec<Look>,
    /// Whether a picture, or an edit, cannot be used.
    fails: bool,
    bodies: Vec<BodyLook>,
}

/// What is in the store of one body of a frame.
#[derive(Default)]
struct BodyLook {
    curves: Vec<Stored<Curves>>,
    matched: Option<Stored<Match>>,
    /// One a view; none where a person drew it.
    contours: Vec<Option<Stored<Contour>>>,
}

/// Looks at what the frames of a trial do for each other, and at what is drawn of them.
fn look_together(steps: &Steps<'_>, axes: &Axes, frames: &mut [FrameLook]) {
    let prepared = steps.prepared;
    let all = frames.iter().all(|f| f.bodies.iter().all(|b| b.matched.is_some()) || f.fails);
    let looks: Mutex<Vec<(usize, Look)>> = Mutex::default();
    let item_of = |job: &Job, place: usize| steps.item(job, &prepared.study.bodies[job.bodies[place].0].name);
    let tracked = if all && prepared.study.tracks() {
        let read = |frame: &FrameLook| {
            let matches = frame.bodies.iter().map(|b| read_stored(steps.store, b.matched.as_ref()?).ok());
            let outline = |c: &Option<Stored<Contour>>| read_stored(steps.store, c.as_ref()?).ok();
            let outlines: Vec<Vec<Option<Hashed<Contour>>>> =
                frame.bodies.iter().map(|b| b.contours.iter().map(outline).collect()).collect();
            let mut of_bodies: Vec<Vec<Option<&Contour>>> = Vec::new();
            for outlines in &outlines {
                of_bodies.push(outlines.iter().map(Option::as_deref).collect());
            }
            Single::of(matches.collect(), &of_bodies)
        };
        let singles: Vec<Single> = frames.par_iter().map(read).collect();
        let attempt = |wanted: &Attempt| {
            let explained = steps.explain_track(wanted, &frames[wanted.job].bodies[wanted.place].curves);
            let (look, found) = match explained {
                Ok((why, stored)) => {
                    let fate = if why.cached() { Fate::Cached } else { Fate::Runs };
                    let found = stored.and_then(|stored| read_stored(steps.store, &stored).ok());
                    (Look { step: TRACK, fate, line: why.to_string() }, found)
                }
                Err(error) => {
                    let name = item_of(&prepared.jobs[wanted.job], wanted.place);
                    let line = format!("{TRACK}/{name}: {}", prepared.study.shorten(&error.to_string()));
                    (Look { step: TRACK, fate: Fate::Fails, line }, None)
                }
            };
            looks.lock().unwrap_or_else(PoisonError::into_inner).push((wanted.job, look));
            Ok(found)
        };
        // Looking stops for nothing.
        track(prepared, &singles, &steps.pivots(), &attempt).unwrap_or_default()
    } else {
        for (number, job) in prepared.jobs.iter().enumerate() {
            let before = (0..job.bodies.len()).map(|place| item_of(job, place));
            let before = before.filter(|item| steps.ever_made(TRACK, item));
            let mut looks = looks.lock().unwrap_or_else(PoisonError::into_inner);
            looks.extend(before.map(|item| (number, Look::after(TRACK, &item, true))));
        }
        Tracked::default()
    };
    let mut looks = looks.into_inner().unwrap_or_else(PoisonError::into_inner);
    looks.sort_by(|a, b| (a.0, &a.1.line).cmp(&(b.0, &b.1.line)));
    for (number, look) in looks {
        frames[number].looks.push(look);
    }
    let smooth = if prepared.study.smoothing.enabled {
        smoothing::look(steps, all, |job, place| {
            let verdict = final_verdict(steps, &tracked, job, place, &frames[job].bodies)?;
            let own = || frames[job].bodies.get(place)?.matched.as_ref().map(Stored::promise);
            let promise = tracked.changed.get(&(job, place)).map(Hashed::promise).or_else(own)?;
            Some((promise, verdict))
        })
    } else {
        Vec::new()
    };
    frames.par_iter_mut().enumerate().for_each(|(number, frame)| {
        let job = &prepared.jobs[number];
        let mut matches = Vec::new();
        for (place, body) in frame.bodies.iter().enumerate() {
            match tracked.changed.get(&(number, place)) {
                Some(found) => {
                    for (slot, curves) in body.curves.iter().enumerate() {
                        let item = steps.item_of_body(job, slot, place);
                        frame.looks.push(after(steps, CONTOUR, &item, false, true, || {
                            Ok(steps.explain_contour(job, slot, place, curves, found.promise())?.0)
                        }));
                    }
                    matches.push(found.promise());
                }
                None => matches.extend(body.matched.as_ref().map(Stored::promise)),
            }
        }
        let verdicts = |place: usize| final_verdict(steps, &tracked, number, place, &frame.bodies);
        let joints: Vec<Look> = of_job(prepared, job)
            .filter(|(.., places)| !all || places.iter().all(|p| verdicts(*p) != Some(Verdict::Failed)))
            .map(|(_, joint, [a, b])| {
                let ready = all && matches.len() == job.bodies.len();
                steps.look_at_joint(job, joint, axes, ready.then(|| [matches[a], matches[b]]))
            })
            .collect();
        frame.looks.extend(joints);
        for slot in 0..job.pictures.len() {
            let item = steps.item(job, steps.view(job, slot).1);
            // Where it is not known yet what frames do for each other, those that needed nothing most likely need nothing again.
            let alone = all || (0..job.bodies.len()).all(|p| !steps.ever_made(TRACK, &item_of(job, p)));
            let ready = alone && matches.len() == job.bodies.len();
            let explain = || steps.explain_overlay(job, slot, &matches);
            frame.looks.push(after(steps, OVERLAY, &item, frame.fails, ready, explain));
        }
        let item = steps.item_of_frame(job);
        let alone = all || (0..job.bodies.len()).all(|p| !steps.ever_made(TRACK, &item_of(job, p)));
        let known = matches.len() == job.bodies.len();
        let shown: Vec<_> = matches
            .iter()
            .zip(&frame.bodies)
            .enumerate()
            .map(|(place, (found, body))| (place, *found, body.curves.as_slice()))
            .collect();
        let explain = || steps.explain_report_frame(job, &shown);
        frame.looks.push(after(steps, REPORT_FRAME, &item, frame.fails, alone && known, explain));
    });
    if let Some(last) = frames.last_mut() {
        last.looks.extend(smooth);
    }
}

/// The verdict of a body's final match, where it is there.
fn final_verdict(
    steps: &Steps<'_>,
    tracked: &Tracked,
    job: usize,
    place: usize,
    bodies: &[BodyLook],
) -> Option<Verdict> {
    if let Some(found) = tracked.changed.get(&(job, place)) {
        return Some(found.verdict);
    }
    let own = read_stored(steps.store, bodies.get(place)?.matched.as_ref()?).ok()?;
    Some(own.verdict)
}

fn look_at(steps: &Steps<'_>, job: &Job) -> FrameLook {
    let study = &steps.prepared.study;
    let mut looks = Vec::new();
    let mut curves = Vec::new();
    for slot in 0..job.pictures.len() {
        let item = steps.item(job, steps.view(job, slot).1);
        let (fate, line) = match steps.explain_segment(job, slot) {
            Ok((why, stored)) => {
                let fate = if why.cached() { Fate::Cached } else { Fate::Runs };
                curves.push(stored);
                (fate, why.to_string())
            }
            Err(error) => {
                curves.push(None);
                (Fate::Fails, format!("{SEGMENT}/{item}: {}", study.shorten(&error.to_string())))
            }
        };
        looks.push(Look { step: SEGMENT, fate, line });
    }
    let drawn: Vec<Option<Drawn>> =
        (0..job.pictures.len()).map(|slot| drawn_in(steps, job, slot, &mut looks)).collect();
    let fails = looks.iter().any(|l| l.fate == Fate::Fails);
    let mut bodies = Vec::new();
    for (place, (body, _, _)) in job.bodies.iter().enumerate() {
        let mut own = Vec::new();
        for (slot, drawn) in drawn.iter().enumerate() {
            let automatic = curves.get(slot).and_then(Option::as_ref);
            let Some(edit) = drawn.as_ref().and_then(|d| d.of(place)) else {
                own.extend(automatic.cloned());
                continue;
            };
            let item = steps.item_of_body(job, slot, place);
            looks.push(match automatic {
                Some(automatic) => after(steps, EDIT, &item, false, true, || {
                    let (why, stored) = steps.explain_trace(job, slot, place, automatic, edit)?;
                    own.extend(stored);
                    Ok(why)
                }),
                None => after(steps, EDIT, &item, fails, false, || Err(ItemError::Cancelled)),
            });
        }
        let item = steps.item(job, &study.bodies[*body].name);
        let modelled = steps.model(*body).is_ok();
        let ready = own.len() == job.pictures.len() && !steps.calibrated.calibrations.is_empty() && modelled;
        let mut matched = None;
        looks.push(after(steps, MATCH, &item, fails, ready, || {
            let (why, stored) = steps.explain_match(job, place, &own)?;
            matched = stored;
            Ok(why)
        }));
        let mut contours = Vec::new();
        for (slot, curves) in (0..job.pictures.len()).map(|slot| (slot, own.get(slot))) {
            let item = steps.item_of_body(job, slot, place);
            let ready = curves.zip(matched.as_ref()).filter(|_| own.len() == job.pictures.len());
            let mut found = None;
            looks.push(after(steps, CONTOUR, &item, fails, ready.is_some(), || match ready {
                Some((curves, matched)) => {
                    let (why, stored) = steps.explain_contour(job, slot, place, curves, matched.promise())?;
                    found = stored;
                    Ok(why)
                }
                None => Err(ItemError::Cancelled),
            }));
            let edited = drawn[slot].as_ref().is_some_and(|d| d.of(place).is_some());
            contours.push(found.filter(|_| !edited));
        }
        bodies.push(BodyLook { curves: own, matched, contours });
    }
    FrameLook { looks, fails, bodies }
}

/// What a person drew in a picture; a look at what cannot be read.
fn drawn_in(steps: &Steps<'_>, job: &Job, slot: usize, looks: &mut Vec<Look>) -> Option<Drawn> {
    // A picture that cannot be used was said already.
    steps.picture(job, slot).ok()?;
    steps.drawn(job, slot).unwrap_or_else(|error| {
        let item = steps.item(job, steps.view(job, slot).1);
        looks.push(Look { step: EDIT, fate: Fate::Fails, line: format!("{EDIT}/{item}: {error}") });
        None
    })
}

/// A look at an item that follows others: `fails` if one of them cannot be done, `ready` if all are in the store.
fn after(
    steps: &Steps<'_>,
    step: &'static str,
    item: &Item,
    fails: bool,
    ready: bool,
    explain: impl FnOnce() -> Result<Explanation, ItemError>,
) -> Look {
    let (fate, line) = if fails {
        (Fate::Fails, format!("{step}/{item}: cannot run, a picture of its frame (or an edit) fails"))
    } else if ready {
        match explain() {
            Ok(why) => (if why.cached() { Fate::Cached } else { Fate::Runs }, why.to_string()),
            Err(error) => {
                let message = steps.prepared.study.shorten(&error.to_string());
                (Fate::Fails, format!("{step}/{item}: {message}"))
            }
        }
    } else {
        return Look::after(step, item, steps.ever_made(step, item));
    };
    Look { step, fate, line }
}

impl Look {
    /// At an item that follows another one which would run; whether it ever ran `before`.
    pub(crate) fn after(step: &'static str, item: &Item, before: bool) -> Self {
        let (fate, why) = if before {
            (Fate::Follows, "runs if what it follows comes out differently")
        } else {
            (Fate::Runs, "never ran")
        };
        Self { step, fate, line: format!("{step}/{item}: {why}") }
    }
}

/// Counts a step.
pub fn counts(looks: &[Look]) -> String {
    let used = STEPS.into_iter().filter(|step| looks.iter().any(|l| l.step == *step));
    let rows = used.map(|step| {
        let of = |fate| looks.iter().filter(|l| l.step == step && l.fate == fate).count().to_string();
        vec![step.to_owned(), of(Fate::Cached), of(Fate::Runs), of(Fate::Follows), of(Fate::Fails)]
    });
    aligned(
        &["step", "cached", "to run", "to run if what comes before changes", "cannot run"],
        rows,
        &[1, 2, 3, 4],
    )
}
