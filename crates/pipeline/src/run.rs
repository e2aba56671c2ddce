//! Runs a study: calibration pictures to fluoroscopes, every frame's pictures to curves, curves to poses, frames that need it once more with
//! what those beside them say, poses to overlays, then `poses.csv` and the report.
//!
//! Frames are spread over threads; what comes out does not depend on how many, nor on the order they finish in. A frame
//! that fails stops nothing but itself.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use biplane_artifact::{Contour, Curves, Match};
use biplane_stage::{Context, Hashed, How, Item, Store, StoreError, Stored};
use rayon::prelude::*;

use crate::calibrate::{CalibrateError, Calibrated, calibrate};
use crate::diagnostics::slashes;
use crate::edits::Drawn;
use crate::exports;
use crate::joints;
use crate::joints::run::JointsRun;
use crate::logging::Progress;
use crate::made::Made;
use crate::models;
use crate::outcome::{BodyOutcome, ContourOutcome, Failure, FrameOutcome, Outcome, StartKind, StepCount};
use crate::prepare::{InputErrors, Job, Prepared};
use crate::report::{self, Provenance, REPORT, ReportError};
use crate::results::{README, copy_if_other, poses_csv, write_if_changed};
use crate::slices;
use crate::smoothing::{self, SmoothRun, smoothed_csv};
use crate::steps::{
    AXES, CONTOUR, DISTORTION, Done, EDIT, ENVIRONMENT, ItemError, JOINT, LABEL_SURFACE, LOFT, MATCH, MODEL,
    OVERLAY, REPORT_FRAME, SEGMENT, SLICES, SMOOTH, SPOTS, STEPS, Steps, TRACK,
};
use crate::study::{Plate, PlateSource, Study, SurfaceSource, ViewSource};
use crate::tracking::{Attempt, Single, Tracked, track};
use crate::walk::Way;

/// Why a run came to no end.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// Inputs that everything hangs on are wrong.
    #[error(transparent)]
    Inputs(#[from] InputErrors),
    /// The fluoroscopes were not found.
    #[error("The calibration failed, so no frame was matched.\n{0}")]
    Calibration(String),
    /// The store cannot be used.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The results cannot be written.
    #[error("cannot write {path}: {source}")]
    Write {
        /// Which file.
        path: String,
        /// Why.
        source: std::io::Error,
    },
    /// The table cannot be made.
    #[error("cannot make poses.csv: {0}")]
    Table(#[from] csv::Error),
    /// The page cannot be made.
    #[error(transparent)]
    Report(#[from] ReportError),
    /// The tables of joints cannot be written.
    #[error(transparent)]
    Joints(#[from] joints::run::WriteError),
    /// Files for other programs cannot be written.
    #[error(transparent)]
    Exports(#[from] exports::ExportError),
    /// No threads.
    #[error("cannot start threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// A person stopped it.
    #[error(
        "stopped: {done} of {frames} frames are finished and kept. poses.csv and the report are written at the end of a whole \
         run; until then they are those of the one before, if any. The same command goes on from here"
    )]
    Stopped {
        /// Frames that were finished.
        done: usize,
        /// All frames.
        frames: usize,
    },
}

/// What one frame gave.
struct Frame {
    outcome: FrameOutcome,
    failures: Vec<Failure>,
    warnings: Vec<String>,
    counts: BTreeMap<&'static str, StepCount>,
    inputs: Vec<(String, String)>,
    /// Files of edits that were used, and those that nobody changed.
    edits: [usize; 2],
    /// Overlays and the hashes of their bytes.
    made: Vec<(String, String)>,
    /// One a body: what it was matched by, and to.
    bodies: Vec<BodyState>,
    /// What the frame gave by itself.
    single: Single,
}

/// What one body of a frame was matched by, and to.
#[derive(Default)]
struct BodyState {
    curves: Vec<Stored<Curves>>,
    /// Whether a person drew it, one a view.
    edited: Vec<bool>,
    matched: Option<Hashed<Match>>,
}

/// Runs everything that is to do on `threads` threads (0: one a core) and writes the results.
///
/// # Errors
/// See [`RunError`]. Items that fail are no error: they are in the outcome.
pub fn run(study: Study, threads: usize, context: &Context) -> Result<(Study, Outcome), RunError> {
    let prepared = Prepared::of(study)?;
    let store = Store::open(&prepared.study.hidden())?;
    writable(&prepared.study.output)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    for warning in &prepared.warnings {
        tracing::warn!("{warning}");
    }
    for view in &prepared.study.views {
        if let ViewSource::File { calibration, pixel_origin, .. } = &view.source {
            let (file, origin) = (prepared.study.relative(calibration), pixel_origin.word());
            tracing::info!(
                "view {}: {file}, whose pixels are counted from the {origin} of the first one",
                view.name
            );
        }
    }
    let mut provenance = provenance(&prepared);
    let (mut warnings, mut steps) =
        (prepared.warnings.clone(), STEPS.map(|name| (name, StepCount::default())));
    let mut calibrated = calibration(&prepared, &store, context, &mut steps, &mut warnings)?;
    provenance.inputs.append(&mut calibrated.inputs);
    let sliced = pool.install(|| slices::run::run(&prepared, &store, context));
    let Some(sliced) = sliced else {
        return Err(RunError::Stopped { done: 0, frames: prepared.jobs.len() });
    };
    count(sliced.done, &mut steps, &mut warnings);
    failed(&sliced.failures, &mut steps);
    for warning in &sliced.warnings {
        tracing::warn!("{warning}");
    }
    warnings.extend(sliced.warnings);
    provenance.inputs.extend(sliced.inputs);
    let modelled = pool.install(|| models::run::run(&prepared, &sliced.found, &store, context));
    let Some(modelled) = modelled else {
        return Err(RunError::Stopped { done: 0, frames: prepared.jobs.len() });
    };
    count(modelled.done, &mut steps, &mut warnings);
    failed(&modelled.failures, &mut steps);
    for warning in &modelled.warnings {
        tracing::warn!("{warning}");
    }
    warnings.extend(modelled.warnings);
    provenance.inputs.extend(modelled.inputs);
    let steps_of_frames = Steps {
        prepared: &prepared,
        calibrated: &calibrated,
        models: &modelled.models,
        store: &store,
        context,
    };
    let progress = Progress::new("Matching", prepared.jobs.len(), "frames");
    let frames: Vec<Option<Frame>> = pool.install(|| {
        prepared
            .jobs
            .par_iter()
            .map(|job| {
                let frame = run_frame(&steps_of_frames, job);
                progress.tick();
                frame
            })
            .collect()
    });
    drop(progress);
    let done = frames.iter().flatten().count();
    let mut stopped = done < frames.len();
    let mut frames = frames;
    if !stopped {
        stopped = pool.install(|| together(&steps_of_frames, &mut frames)).is_none();
    }
    let (mut jointed, mut smoothed) = (JointsRun::default(), SmoothRun::default());
    let own = |frame: &Option<Frame>| {
        frame.iter().flat_map(|f| &f.bodies).map(|body| body.matched.clone()).collect::<Vec<_>>()
    };
    if !stopped && prepared.study.smoothing.enabled {
        let matches: Vec<_> = frames.iter().map(own).collect();
        match pool.install(|| smoothing::run(&steps_of_frames, &matches)) {
            Some(found) => smoothed = found,
            None => stopped = true,
        }
    }
    count(std::mem::take(&mut smoothed.done), &mut steps, &mut warnings);
    failed(&smoothed.failures, &mut steps);
    if !stopped && !prepared.study.joints.is_empty() {
        let matches: Vec<_> = frames.iter().map(own).collect();
        match pool.install(|| joints::run::run(&steps_of_frames, &modelled.axes, &matches)) {
            Some(found) => jointed = found,
            None => stopped = true,
        }
    }
    count(std::mem::take(&mut jointed.done), &mut steps, &mut warnings);
    failed(&jointed.failures, &mut steps);
    jointed.warnings.iter().for_each(|warning| tracing::warn!("{warning}"));
    warnings.append(&mut jointed.warnings);
    let bodies = if stopped { None } else { report::models::bodies(&steps_of_frames) };
    stopped |= bodies.is_none();
    let bodies = bodies.unwrap_or_default();
    count(bodies.done.clone(), &mut steps, &mut warnings);
    failed(&bodies.failures, &mut steps);
    let written = calibrated.write(&prepared.study.output, &prepared.study.views);
    let written = written.map_err(|(place, source)| RunError::Write {
        path: slashes(&prepared.study.output.join(place)),
        source,
    })?;
    let of_frames: Vec<_> = frames.iter().flatten().flat_map(|f| f.made.iter().cloned()).collect();
    let mut outcome = gather(frames.into_iter().flatten(), steps, warnings, &mut provenance);
    outcome.calibration = std::mem::take(&mut calibrated);
    outcome.slices = sliced.outcomes;
    outcome.models = modelled.outcomes;
    outcome.failures.extend(bodies.failures.iter().cloned());
    outcome.failures.splice(0..0, sliced.failures.into_iter().chain(modelled.failures));
    outcome.failures.append(&mut smoothed.failures);
    outcome.smoothed = smoothed.outcomes;
    outcome.failures.append(&mut jointed.failures);
    outcome.joints = jointed.outcomes;
    let plots = if stopped { Vec::new() } else { joints::run::write(&prepared.study, &mut outcome)? };
    let exported = if stopped {
        Vec::new()
    } else {
        exports::write(&prepared.study, &outcome, &outcome.calibration.calibrations)?
    };
    let plots = plots.into_iter().chain(exported);
    let made = of_frames.into_iter().chain(written).chain(sliced.made).chain(modelled.made).chain(plots);
    let made = Made::of(made);
    outcome.edits.iter_mut().zip(sliced.edits).for_each(|(sum, part)| *sum += part);
    let (study, jobs) = (prepared.study, prepared.jobs.len());
    let hidden = study.hidden();
    let index = prepared.index.save(!stopped);
    index.map_err(|source| RunError::Write { path: slashes(&hidden.join("inputs.json")), source })?;
    let removed = made.save(&study.output, !stopped);
    let removed = removed
        .map_err(|source| RunError::Write { path: slashes(&study.output.join("overlays")), source })?;
    if removed > 0 {
        tracing::info!("removed {removed} picture(s) of earlier runs that are not of this study any more");
    }
    if stopped {
        return Err(RunError::Stopped { done, frames: jobs });
    }
    write(&study, &outcome, &provenance, &bodies)?;
    Ok((study, outcome))
}

/// That results can be written is known before an hour of work, not after it.
fn writable(folder: &Path) -> Result<(), RunError> {
    let made = folder.exists();
    let tried = std::fs::create_dir_all(folder)
        .and_then(|()| tempfile::Builder::new().prefix(".writing-").tempfile_in(folder).map(drop));
    tried.map_err(|source| RunError::Write {
        path: format!("{} (the folder of results)", slashes(folder)),
        source,
    })?;
    if !made {
        // A run that is stopped leaves no empty folder.
        let _ = std::fs::remove_dir(folder);
    }
    Ok(())
}

fn run_frame(steps: &Steps<'_>, job: &Job) -> Option<Frame> {
    if steps.context.cancelled() {
        return None;
    }
    let study = &steps.prepared.study;
    let mut frame = Frame {
        outcome: FrameOutcome {
            trial: job.trial,
            label: job.label.clone(),
            time_s: job.time_s,
            bodies: Vec::new(),
            overlays: Vec::new(),
            script: None,
        },
        failures: Vec::new(),
        warnings: Vec::new(),
        counts: BTreeMap::new(),
        inputs: Vec::new(),
        edits: [0; 2],
        made: Vec::new(),
        bodies: Vec::new(),
        single: Single::default(),
    };
    let slots: Vec<_> =
        (0..job.pictures.len()).into_par_iter().map(|slot| steps.segment(job, slot)).collect();
    let mut curves = Vec::new();
    let mut missing: Option<String> = None;
    for (slot, result) in slots.into_iter().enumerate() {
        let (_, view) = steps.view(job, slot);
        let name = format!("{SEGMENT}/{}", steps.item(job, view));
        let source = &job.pictures[slot];
        if let Ok(facts) = steps.picture(job, slot) {
            let part =
                if source.index_in_file > 0 { format!("#{}", source.index_in_file) } else { String::new() };
            frame.inputs.push((study.relative(&source.path) + &part, facts.hash().to_hex()));
        }
        match frame.keep(study, SEGMENT, &name, result)? {
            Ok(stored) => curves.push(stored),
            Err(_) => _ = missing.get_or_insert(format!("{name} failed")),
        }
    }
    let drawn = drawn_in_frame(steps, job, &mut frame, &mut missing)?;
    let bodies: Vec<_> = (0..job.bodies.len())
        .into_par_iter()
        .map(|place| {
            // Without a model nothing is matched; why there is none is said once, where it was made.
            let without = || steps.model(job.bodies[place].0).err().map(|e| e.to_string());
            match missing.clone().or_else(without) {
                Some(message) => Err(message),
                None => Ok(run_body(steps, job, place, &curves, &drawn)),
            }
        })
        .collect();
    let mut outlines = Vec::new();
    for (place, ((body, start, pose), result)) in job.bodies.iter().zip(bodies).enumerate() {
        let mut contours: Vec<Option<Hashed<Contour>>> = Vec::new();
        let mut state = BodyState::default();
        let result = match result {
            // What only follows from another failure is not listed again.
            Err(message) => {
                frame.counts.entry(MATCH).or_default().failed += 1;
                Err(message)
            }
            Ok(body) => keep_body(steps, job, place, body, &mut frame, &mut state, &mut contours)?,
        };
        frame.outcome.bodies.push(BodyOutcome {
            body: *body,
            start: start.clone(),
            start_pose: pose.as_ref().map(|start| start.0),
            result,
            bridged: None,
            contours: contour_outcomes(&state.edited, &contours),
        });
        frame.bodies.push(state);
        outlines.push(contours);
    }
    let matches = frame.bodies.iter().map(|body| body.matched.clone()).collect();
    let mut automatic: Vec<Vec<Option<&Contour>>> = Vec::new();
    for (body, found) in frame.bodies.iter().zip(&outlines) {
        let own = found.iter().zip(&body.edited);
        automatic.push(own.map(|(found, edited)| found.as_deref().filter(|_| !edited)).collect());
    }
    frame.single = Single::of(matches, &automatic);
    Some(frame)
}

/// Whether a person drew each outline of a body, and what of it one should look at.
fn contour_outcomes(edited: &[bool], found: &[Option<Hashed<Contour>>]) -> Vec<ContourOutcome> {
    let outlines = edited.iter().zip(found);
    let outcome = |(edited, found): (&bool, &Option<Hashed<Contour>>)| ContourOutcome {
        edited: *edited,
        // Where a person drew, a person has looked.
        flags: found.as_ref().filter(|_| !edited).map(|found| found.flags.clone()).unwrap_or_default(),
    };
    outlines.map(outcome).collect()
}

/// Lets the frames of a trial help each other, then draws them all; `None` if the run was stopped.
fn together(steps: &Steps<'_>, frames: &mut [Option<Frame>]) -> Option<()> {
    let prepared = steps.prepared;
    let single = |frame: &mut Option<Frame>| frame.as_mut().map(|f| std::mem::take(&mut f.single));
    let singles: Vec<Single> = frames.iter_mut().map(|frame| single(frame).unwrap_or_default()).collect();
    let tries: Mutex<Vec<(usize, String, Done<()>)>> = Mutex::default();
    let attempt = |wanted: &Attempt| {
        let job = &prepared.jobs[wanted.job];
        let body = frames.get(wanted.job).and_then(Option::as_ref).and_then(|f| f.bodies.get(wanted.place));
        let Some(body) = body else { return Ok(None) };
        let (found, kept) = match steps.track(wanted, &body.curves) {
            Ok((found, how)) => (Some(found), Ok(((), how))),
            Err(ItemError::Cancelled) => return Err(ItemError::Cancelled),
            // It stays as it was.
            Err(failed) => (None, Err(failed)),
        };
        let item = steps.item(job, &prepared.study.bodies[job.bodies[wanted.place].0].name);
        let mut tries = tries.lock().unwrap_or_else(PoisonError::into_inner);
        tries.push((wanted.job, format!("{TRACK}/{item}"), kept));
        Ok(found)
    };
    let tracked = track(prepared, &singles, &steps.pivots(), &attempt).ok()?;
    let mut tries = tries.into_inner().unwrap_or_else(PoisonError::into_inner);
    tries.sort_by(|a, b| (a.0, &a.1).cmp(&(b.0, &b.1)));
    for (job, item, result) in tries {
        if let Some(frame) = &mut frames[job] {
            let _ = frame.keep(&prepared.study, TRACK, &item, result)?;
        }
    }
    let progress = Progress::new("Drawing", frames.len(), "frames");
    let drawn: Vec<Option<()>> = frames
        .par_iter_mut()
        .enumerate()
        .map(|(number, frame)| {
            progress.tick();
            finish_frame(steps, number, frame.as_mut()?, &tracked)
        })
        .collect();
    drawn.into_iter().collect()
}

/// Gives a frame what others changed in it, and draws it; `None` if the run was stopped.
fn finish_frame(steps: &Steps<'_>, number: usize, frame: &mut Frame, tracked: &Tracked) -> Option<()> {
    if steps.context.cancelled() {
        return None;
    }
    let (job, study) = (&steps.prepared.jobs[number], &steps.prepared.study);
    for place in 0..frame.bodies.len() {
        frame.outcome.bodies[place].bridged = tracked.bridged.get(&(number, place)).cloned();
        let Some(found) = tracked.changed.get(&(number, place)) else { continue };
        let mut state = std::mem::take(&mut frame.bodies[place]);
        let anew: Vec<_> = state
            .curves
            .iter()
            .enumerate()
            .map(|(slot, curves)| steps.contour(job, slot, place, curves, found))
            .collect();
        let mut contours = Vec::new();
        for (slot, result) in anew.into_iter().enumerate() {
            let name = format!("{CONTOUR}/{}", steps.item_of_body(job, slot, place));
            contours.push(frame.keep(study, CONTOUR, &name, result)?.ok());
        }
        state.matched = Some(found.clone());
        let outcome = &mut frame.outcome.bodies[place];
        outcome.start = StartKind::Neighbours;
        outcome.result = Ok(Match::clone(found));
        outcome.contours = contour_outcomes(&state.edited, &contours);
        frame.bodies[place] = state;
    }
    let matches: Vec<Hashed<Match>> = frame.bodies.iter().filter_map(|body| body.matched.clone()).collect();
    if matches.len() == job.bodies.len() {
        overlays(steps, job, &matches, frame)?;
    } else {
        frame.counts.entry(OVERLAY).or_default().failed += job.pictures.len();
    }
    report_frame(steps, job, frame)
}

/// Draws a frame for the report and copies it to the results; `None` if the run was stopped.
fn report_frame(steps: &Steps<'_>, job: &Job, frame: &mut Frame) -> Option<()> {
    let study = &steps.prepared.study;
    // A picture that cannot be used was told already.
    if (0..job.pictures.len()).all(|slot| steps.picture(job, slot).is_err()) {
        frame.counts.entry(REPORT_FRAME).or_default().failed += 1;
        return Some(());
    }
    let bodies = frame.bodies.iter().enumerate();
    let shown: Vec<_> =
        bodies.filter_map(|(place, b)| Some((place, b.matched.clone()?, b.curves.as_slice()))).collect();
    let result = steps.report_frame(job, &shown);
    let name = format!("{REPORT_FRAME}/{}", steps.item_of_frame(job));
    let Ok(stored) = frame.keep(study, REPORT_FRAME, &name, result)? else { return Some(()) };
    let place = Path::new(REPORT).join("frames").join(&study.trials[job.trial].name);
    let place = place.join(format!("{}.js", job.label));
    match copy_if_other(stored.path(), &study.output.join(&place)) {
        Ok(()) => {
            frame.made.push((slashes(&place), stored.hash().to_hex()));
            frame.outcome.script = Some(place);
        }
        Err(error) => {
            let message = format!("cannot write {}: {error}", slashes(&study.output.join(&place)));
            frame.counts.entry(REPORT_FRAME).or_default().failed += 1;
            frame.failures.push(Failure { item: name, message: study.shorten(&message) });
        }
    }
    Some(())
}

/// What a person drew in the pictures of a frame; `None` if the run was stopped.
fn drawn_in_frame(
    steps: &Steps<'_>,
    job: &Job,
    frame: &mut Frame,
    missing: &mut Option<String>,
) -> Option<Vec<Option<Drawn>>> {
    let study = &steps.prepared.study;
    let mut all = Vec::new();
    for slot in 0..job.pictures.len() {
        // A picture that cannot be used was counted already.
        let result = if steps.picture(job, slot).is_ok() { steps.drawn(job, slot) } else { Ok(None) };
        let drawn = match result {
            Ok(drawn) => drawn,
            Err(ItemError::Cancelled) => return None,
            Err(ItemError::Failed(message)) => {
                let name = format!("{EDIT}/{}", steps.item(job, steps.view(job, slot).1));
                missing.get_or_insert(format!("{name} failed"));
                frame.counts.entry(EDIT).or_default().failed += 1;
                frame.failures.push(Failure { item: name, message });
                None
            }
        };
        if let Some(drawn) = &drawn {
            let used = drawn.bodies.iter().filter(|b| b.touched);
            frame.inputs.extend(used.clone().map(|b| {
                let body = &study.bodies[job.bodies[b.place].0].name;
                (format!("{} ({body})", drawn.file), b.contour.hash().to_hex())
            }));
            frame.edits[usize::from(used.count() == 0)] += 1;
            frame.warnings.extend(drawn.warnings.iter().cloned());
        }
        all.push(drawn);
    }
    Some(all)
}

/// What became of one body of a frame, item by item.
struct BodyRun {
    curves: Vec<Stored<Curves>>,
    traced: Vec<(Item, Result<How, ItemError>)>,
    matched: Done<Hashed<Match>>,
    /// With whether a person drew it.
    contours: Vec<(Item, Done<Hashed<Contour>>, bool)>,
}

/// Brings one body of a frame from the curves, or what a person drew in their place, to its pose and its outlines.
fn run_body(
    steps: &Steps<'_>,
    job: &Job,
    place: usize,
    automatic: &[Stored<Curves>],
    drawn: &[Option<Drawn>],
) -> BodyRun {
    let mut traced = Vec::new();
    let mut curves = Vec::new();
    let edit_of = |slot: usize| drawn.get(slot)?.as_ref()?.of(place);
    for (slot, stored) in automatic.iter().enumerate() {
        let Some(edit) = edit_of(slot) else {
            curves.push(stored.clone());
            continue;
        };
        let result = steps.trace(job, slot, place, stored, edit).map(|(stored, how)| {
            curves.push(stored);
            how
        });
        traced.push((steps.item_of_body(job, slot, place), result));
    }
    if curves.len() < automatic.len() {
        let failed = traced.iter().find(|(_, result)| result.is_err());
        let name = failed.map(|(item, _)| format!("{EDIT}/{item} failed")).unwrap_or_default();
        return BodyRun { curves, traced, matched: Err(ItemError::Failed(name)), contours: Vec::new() };
    }
    let matched = steps.matching(job, place, &curves);
    let contours = matched.iter().flat_map(|(found, _)| {
        curves.iter().enumerate().map(move |(slot, curves)| {
            let result = steps.contour(job, slot, place, curves, found);
            (steps.item_of_body(job, slot, place), result, edit_of(slot).is_some())
        })
    });
    let contours = contours.collect();
    BodyRun { curves, traced, matched, contours }
}

/// Counts what became of a body; `None` if the run was stopped.
fn keep_body(
    steps: &Steps<'_>,
    job: &Job,
    place: usize,
    body: BodyRun,
    frame: &mut Frame,
    state: &mut BodyState,
    contours: &mut Vec<Option<Hashed<Contour>>>,
) -> Option<Result<Match, String>> {
    let study = &steps.prepared.study;
    let mut follows = false;
    for (item, result) in body.traced {
        let name = format!("{EDIT}/{item}");
        follows |= frame.keep(study, EDIT, &name, result.map(|how| ((), how)))?.is_err();
    }
    let name = format!("{MATCH}/{}", steps.item(job, &study.bodies[job.bodies[place].0].name));
    let result = match body.matched {
        Err(ItemError::Failed(message)) if follows => {
            frame.counts.entry(MATCH).or_default().failed += 1;
            Err(message)
        }
        result => frame.keep(study, MATCH, &name, result)?,
    };
    for (item, result, edited) in body.contours {
        let name = format!("{CONTOUR}/{item}");
        state.edited.push(edited);
        contours.push(frame.keep(study, CONTOUR, &name, result)?.ok());
    }
    state.curves = body.curves;
    state.matched = result.as_ref().ok().cloned();
    Some(result.map(|found| Match::clone(&found)))
}

impl Frame {
    /// Counts an item, and lists it if it failed; `None` if the run was stopped.
    fn keep<T>(
        &mut self,
        study: &Study,
        step: &'static str,
        item: &str,
        result: Done<T>,
    ) -> Option<Result<T, String>> {
        let count = self.counts.entry(step).or_default();
        match result {
            Ok((found, how)) => {
                match how {
                    How::Cached => count.cached += 1,
                    How::Ran => count.ran += 1,
                    How::Remade(damage) => {
                        count.ran += 1;
                        self.warnings.push(format!("{item} was made again: {damage}"));
                    }
                }
                Some(Ok(found))
            }
            Err(ItemError::Cancelled) => None,
            Err(ItemError::Failed(message)) => {
                let message = study.shorten(&message);
                count.failed += 1;
                self.failures.push(Failure { item: item.to_owned(), message: message.clone() });
                Some(Err(message))
            }
        }
    }
}

/// Draws the overlays of a frame and copies them to the results; `None` if the run was stopped.
fn overlays(steps: &Steps<'_>, job: &Job, matches: &[Hashed<Match>], frame: &mut Frame) -> Option<()> {
    let study = &steps.prepared.study;
    let drawn: Vec<_> =
        (0..job.pictures.len()).into_par_iter().map(|slot| steps.overlay(job, slot, matches)).collect();
    for (slot, result) in drawn.into_iter().enumerate() {
        let (view, view_name) = steps.view(job, slot);
        let name = format!("{OVERLAY}/{}", steps.item(job, view_name));
        let place = Path::new("overlays").join(&study.trials[job.trial].name);
        let place = place.join(format!("{}_{view_name}.png", job.label));
        let Ok(stored) = frame.keep(study, OVERLAY, &name, result)? else { continue };
        match copy_if_other(stored.path(), &study.output.join(&place)) {
            Ok(()) => {
                frame.made.push((slashes(&place), stored.hash().to_hex()));
                frame.outcome.overlays.push((view, place));
            }
            Err(error) => {
                let message = format!("cannot write {}: {error}", slashes(&study.output.join(&place)));
                frame.counts.entry(OVERLAY).or_default().failed += 1;
                frame.failures.push(Failure { item: name, message: study.shorten(&message) });
            }
        }
    }
    Some(())
}

/// Finds the fluoroscopes, or takes them from files; counts what was done.
fn calibration(
    prepared: &Prepared,
    store: &Store,
    context: &Context,
    steps: &mut [(&'static str, StepCount)],
    warnings: &mut Vec<String>,
) -> Result<Calibrated, RunError> {
    let (calibrated, way) = calibrate(prepared, store, context, Way::Run(Vec::new()));
    let done = match way {
        Way::Run(done) => done,
        Way::Look(_) => Vec::new(),
    };
    let mut own = Vec::new();
    count(done, steps, &mut own);
    let calibrated = calibrated.map_err(|error| match error {
        CalibrateError::Cancelled => RunError::Stopped { done: 0, frames: prepared.jobs.len() },
        CalibrateError::Failed(list) => RunError::Calibration(list.join("\n")),
    })?;
    // Running leaves nothing unknown.
    let calibrated = calibrated.unwrap_or_default();
    own.extend(calibrated.warnings(&prepared.study.views));
    for warning in &own {
        tracing::warn!("{warning}");
    }
    warnings.extend(own);
    Ok(calibrated)
}

/// Counts what was done, step by step; what had to be made again is a warning.
fn count(
    done: Vec<(&'static str, String, How)>,
    steps: &mut [(&'static str, StepCount)],
    warnings: &mut Vec<String>,
) {
    for (step, item, how) in done {
        if let Some((_, count)) = steps.iter_mut().find(|(name, _)| *name == step) {
            match how {
                How::Cached => count.cached += 1,
                How::Ran => count.ran += 1,
                How::Remade(damage) => {
                    count.ran += 1;
                    warnings.push(format!("{item} was made again: {damage}"));
                }
            }
        }
    }
}

/// Counts items that could not be done.
fn failed(failures: &[Failure], steps: &mut [(&'static str, StepCount)]) {
    for failure in failures {
        let step = failure.item.split('/').next().unwrap_or_default();
        steps.iter_mut().filter(|(name, _)| *name == step).for_each(|(_, count)| count.failed += 1);
    }
}

fn gather(
    frames: impl Iterator<Item = Frame>,
    mut steps: [(&'static str, StepCount); STEPS.len()],
    warnings: Vec<String>,
    provenance: &mut Provenance,
) -> Outcome {
    let mut outcome = Outcome { warnings, ..Outcome::default() };
    let mut inputs: BTreeMap<String, String> = provenance.inputs.drain(..).collect();
    for frame in frames {
        for (step, part) in frame.counts {
            if let Some((_, sum)) = steps.iter_mut().find(|(name, _)| *name == step) {
                sum.cached += part.cached;
                sum.ran += part.ran;
                sum.failed += part.failed;
            }
        }
        for warning in &frame.warnings {
            tracing::warn!("{warning}");
        }
        inputs.extend(frame.inputs);
        for (sum, part) in outcome.edits.iter_mut().zip(frame.edits) {
            *sum += part;
        }
        outcome.warnings.extend(frame.warnings);
        outcome.failures.extend(frame.failures);
        outcome.frames.push(frame.outcome);
    }
    provenance.inputs = inputs.into_iter().collect();
    outcome.steps = steps.into_iter().filter(|(_, c)| c.cached + c.ran + c.failed > 0).collect();
    outcome
}

/// Parameters and the hashes of calibrations and meshes; those of pictures come with the frames.
fn provenance(prepared: &Prepared) -> Provenance {
    let study = &prepared.study;
    let text = |result: Result<String, toml::ser::Error>| result.unwrap_or_default();
    let (mut inputs, mut parameters) = (Vec::new(), Vec::new());
    for (view, calibration) in study.views.iter().zip(prepared.equipment.known()) {
        if let ViewSource::File { calibration: file, pixel_origin, distortion, uncertainty } = &view.source {
            let distortion = distortion.as_ref().map(|d| format!(", {}", study.relative(d)));
            let (file, origin) = (study.relative(file), pixel_origin.word());
            let name = format!(
                "{file}{} (view {}, pixel_origin {origin})",
                distortion.unwrap_or_default(),
                view.name
            );
            inputs.push((name, calibration.hash().to_hex()));
            let stated =
                uncertainty.map(|u| (format!("uncertainty of {}", view.name), text(toml::to_string(&u))));
            parameters.extend(stated);
        }
    }
    if let Some(calibration) = prepared.equipment.inputs() {
        let beads = study.beads.as_ref().map(|b| study.relative(&b.list));
        inputs.extend(beads.map(|file| (file, calibration.beads.hash().to_hex())));
        if let (Some(Plate { pattern: PlateSource::List(file), .. }), Some(pattern)) =
            (&study.plate, &calibration.pattern)
        {
            inputs.push((study.relative(file), pattern.hash().to_hex()));
        }
        parameters.push((SPOTS.to_owned(), text(toml::to_string(&study.spots))));
        parameters.push((DISTORTION.to_owned(), text(toml::to_string(&study.distortion))));
        parameters.push((ENVIRONMENT.to_owned(), text(toml::to_string(&study.environment))));
    }
    for bone in &study.slices {
        parameters.push((format!("{SLICES} {}", bone.name), text(toml::to_string(&bone.find))));
    }
    for body in &study.bodies {
        let name = &body.name;
        let (step, of_surface) = match &body.surface {
            SurfaceSource::File(_) => (MODEL, None),
            SurfaceSource::Contours(_, loft) => (LOFT, Some(toml::to_string(loft))),
            SurfaceSource::Labels(_, labels) => (LABEL_SURFACE, Some(toml::to_string(labels))),
        };
        parameters.extend(of_surface.map(|p| (format!("{step} {name}"), text(p))));
        parameters.extend(body.model.as_ref().map(|m| (format!("{MODEL} {name}"), text(toml::to_string(m)))));
        parameters.push((format!("{MATCH} {name}"), format!("ignore_cut_ends = {}\n", body.ignore_cut_ends)));
        parameters.extend(body.axes.as_ref().map(|a| (format!("{AXES} {name}"), text(toml::to_string(a)))));
    }
    parameters.push((SEGMENT.to_owned(), text(toml::to_string(&study.segment))));
    parameters.push((EDIT.to_owned(), text(toml::to_string(&study.edit))));
    parameters.push((MATCH.to_owned(), text(toml::to_string(&study.matching))));
    parameters.push((SMOOTH.to_owned(), text(toml::to_string(&study.smoothing))));
    parameters.push((TRACK.to_owned(), text(toml::to_string(&study.tracking))));
    for joint in &study.joints {
        parameters.push((format!("{JOINT} {}", joint.name), text(toml::to_string(joint))));
    }
    parameters.push((CONTOUR.to_owned(), text(toml::to_string(&study.contour))));
    Provenance { parameters, inputs }
}

fn write(
    study: &Study,
    outcome: &Outcome,
    provenance: &Provenance,
    bodies: &report::models::Bodies,
) -> Result<(), RunError> {
    let contents = report::Contents { provenance, bodies, searches: &[] };
    let scripts = report::scripts(bodies);
    let files = [
        ("poses.csv", poses_csv(study, outcome)?),
        ("poses.README.txt", README.as_bytes().to_vec()),
        ("report.html", report::page(study, outcome, &contents)?.into_bytes()),
    ];
    let smoothed = [
        ("poses_smoothed.csv", smoothed_csv(study, outcome)?),
        ("poses_smoothed.README.txt", smoothing::README.as_bytes().to_vec()),
    ];
    let smoothed = smoothed.into_iter().filter(|_| !outcome.smoothed.is_empty());
    let named = files.into_iter().chain(smoothed).map(|(name, bytes)| (Path::new(name).to_owned(), bytes));
    for (name, bytes) in named.chain(scripts) {
        let path = study.output.join(name);
        write_if_changed(&path, &bytes).map_err(|source| RunError::Write { path: slashes(&path), source })?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body(result: Result<Match, String>) -> BodyOutcome {
        let start_pose = Some(biplane_geometry::Pose::identity());
        BodyOutcome { body: 0, start: StartKind::File, start_pose, result, bridged: None, contours: vec![] }
    }

    #[test]
    fn counts_are_added_in_the_order_of_the_steps() {
        let frame = |ran| Frame {
            outcome: FrameOutcome {
                trial: 0,
                label: "1".into(),
                time_s: None,
                bodies: vec![body(Err("why".into()))],
                overlays: vec![],
                script: None,
            },
            failures: vec![],
            warnings: vec!["w".into()],
            counts: BTreeMap::from([(SEGMENT, StepCount { cached: 1, ran, failed: 0 })]),
            edits: [1, 0],
            inputs: vec![("b".into(), "2".into()), ("a".into(), "1".into())],
            made: vec![],
            bodies: vec![],
            single: Single::default(),
        };
        let mut provenance = Provenance { parameters: vec![], inputs: vec![("c".into(), "3".into())] };
        let steps = STEPS.map(|name| (name, StepCount::default()));
        let outcome = gather([frame(2), frame(3)].into_iter(), steps, vec!["first".into()], &mut provenance);
        assert_eq!(outcome.steps, [(SEGMENT, StepCount { cached: 2, ran: 5, failed: 0 })], "no empty steps");
        assert_eq!(outcome.warnings, ["first", "w", "w"]);
        assert_eq!(outcome.verdicts(), [0, 0, 0, 2]);
        let names: Vec<&str> = provenance.inputs.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["a", "b", "c"]);
    }
}
