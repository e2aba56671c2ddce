//! Smoothing of whole trials, where `[smooth]` asks for it: `results/poses_smoothed.csv` beside the raw `results/poses.csv`, never in its place.
//!
//! `smooth/<trial>/<body>` takes the good matches of a body in all frames of a trial.

use biplane_artifact::{Match, SmoothedTrial, Verdict};
use biplane_geometry::Point3;
use biplane_stage::{ExecuteError, Hashed, How, Item, KeyParts, ParamsText, Promise, Promised};
use biplane_trial::{Smooth, SmoothInputs, SmoothParams};
use rayon::prelude::*;

use crate::look::{Fate, Look};
use crate::outcome::{Failure, Outcome};
use crate::results::{INTERVALS, POSE, fixed, pose_cells};
use crate::steps::{ItemError, SMOOTH, Steps, read_stored};
use crate::study::Study;

/// What `poses_smoothed.README.txt` says.
pub const README: &str = include_str!("smoothed_readme.txt");

/// Standard deviations to either side that hold 95 % of a normal number.
const NINETY_FIVE: f64 = 1.959_964;

/// A body over a trial, smoothed.
#[derive(Debug, Clone)]
pub struct SmoothOutcome {
    /// Index of the trial.
    pub trial: usize,
    /// Index of the body.
    pub body: usize,
    /// What came out.
    pub smoothed: Hashed<SmoothedTrial>,
}

/// What smoothing a study gave.
#[derive(Debug, Default)]
pub struct SmoothRun {
    /// In the order of trials and bodies.
    pub outcomes: Vec<SmoothOutcome>,
    /// Step, item, and how it was done.
    pub done: Vec<(&'static str, String, How)>,
    /// Items that could not be done.
    pub failures: Vec<Failure>,
}

/// A body over a trial: the frames of the trial, and which of them have a match that is used.
struct Line {
    trial: usize,
    body: usize,
    item: Item,
    params: SmoothParams,
    /// Number of the job and the body's place in it, of each match that is used.
    used: Vec<(usize, usize)>,
}

/// The bodies of all trials; `verdict` is that of a body's final match.
fn lines(steps: &Steps<'_>, verdict: impl Fn(usize, usize) -> Option<Verdict>) -> Vec<Line> {
    let (prepared, pivots) = (steps.prepared, steps.pivots());
    let settings = &prepared.study.smoothing;
    let mut lines = Vec::new();
    for (trial, about) in prepared.study.trials.iter().enumerate() {
        let jobs: Vec<usize> =
            (0..prepared.jobs.len()).filter(|j| prepared.jobs[*j].trial == trial).collect();
        let seconds: Option<Vec<f64>> = jobs.iter().map(|j| prepared.jobs[*j].time_s).collect();
        let times = seconds.unwrap_or_else(|| (0..jobs.len()).map(|k| k as f64).collect());
        let span = times.last().zip(times.first()).map_or(0.0, |(b, a)| b - a);
        let interval = span / (jobs.len().max(2) - 1) as f64;
        // White acceleration whose mean over a frame is as large as is usual.
        let density = |usual: Option<f64>| usual.map(|a| a * a * interval);
        for (place, body) in about.bodies.iter().enumerate() {
            let used: Vec<(usize, usize)> = (0..jobs.len())
                .filter(|k| verdict(jobs[*k], place) == Some(Verdict::Good))
                .map(|k| (jobs[k], place))
                .collect();
            let frames =
                used.iter().filter_map(|(job, _)| jobs.iter().position(|other| other == job)).collect();
            let pivot = pivots.get(*body).copied().unwrap_or_else(Point3::origin);
            let params = SmoothParams {
                times: times.clone(),
                frames,
                pivot_mm: pivot.coords.into(),
                intensity: [
                    density(settings.acceleration_mm_s2),
                    density(settings.acceleration_deg_s2.map(f64::to_radians)),
                ],
                bridge: settings.bridge,
            };
            let name = prepared.study.bodies[*body].name.as_str();
            lines.push(Line {
                trial,
                body: *body,
                item: Item::of([about.name.as_str(), name]),
                params,
                used,
            });
        }
    }
    lines
}

/// Smooths all bodies of all trials; `None` if the run was stopped. `matches` are the final ones of the bodies of each job.
pub fn run(steps: &Steps<'_>, matches: &[Vec<Option<Hashed<Match>>>]) -> Option<SmoothRun> {
    let of = |job: usize, place: usize| matches.get(job)?.get(place)?.as_ref();
    let lines = lines(steps, |job, place| of(job, place).map(|m| m.verdict));
    let found: Vec<_> = lines
        .par_iter()
        .map(|line| {
            let params = ParamsText::of(&line.params).map_err(ItemError::of)?;
            let inputs: Vec<Hashed<Match>> =
                line.used.iter().filter_map(|(job, place)| of(*job, *place).cloned()).collect();
            let promised = SmoothInputs::<Promised> { matches: inputs.iter().map(Hashed::promise).collect() };
            let load = || Ok::<_, String>(SmoothInputs { matches: inputs.clone() });
            let done =
                steps.store.execute::<Smooth, _>(SMOOTH, &line.item, &params, &promised, load, steps.context);
            let done = done.map_err(|error| match error {
                ExecuteError::Cancelled => ItemError::Cancelled,
                other => ItemError::of(other),
            })?;
            Ok((read_stored(steps.store, &done.output).map_err(ItemError::Failed)?, done.how))
        })
        .collect();
    let mut all = SmoothRun::default();
    for (line, found) in lines.iter().zip(found) {
        let item = format!("{SMOOTH}/{}", line.item);
        match found {
            Ok((smoothed, how)) => {
                all.done.push((SMOOTH, item, how));
                all.outcomes.push(SmoothOutcome { trial: line.trial, body: line.body, smoothed });
            }
            Err(ItemError::Cancelled) => return None,
            Err(ItemError::Failed(message)) => {
                all.failures.push(Failure { item, message: steps.prepared.study.shorten(&message) });
            }
        }
    }
    Some(all)
}

/// What would become of smoothing; `of` gives the final match of a body in a job and its verdict, where it is there. Where any is not, all follows.
pub fn look(
    steps: &Steps<'_>,
    known: bool,
    of: impl Fn(usize, usize) -> Option<(Promise<Match>, Verdict)>,
) -> Vec<Look> {
    let look = |line: Line| {
        if !known {
            return Look::after(SMOOTH, &line.item, steps.ever_made(SMOOTH, &line.item));
        }
        let parts = || {
            let params = ParamsText::of(&line.params).map_err(ItemError::of)?;
            let matches = line.used.iter().filter_map(|(job, place)| Some(of(*job, *place)?.0)).collect();
            let parts = KeyParts::of::<Smooth>(&params, &SmoothInputs::<Promised> { matches });
            steps.store.explain::<Smooth>(SMOOTH, &line.item, &parts).map_err(ItemError::of)
        };
        match parts() {
            Ok(why) => {
                let fate = if why.cached() { Fate::Cached } else { Fate::Runs };
                Look { step: SMOOTH, fate, line: why.to_string() }
            }
            Err(error) => {
                Look { step: SMOOTH, fate: Fate::Fails, line: format!("{SMOOTH}/{}: {error}", line.item) }
            }
        }
    };
    lines(steps, |job, place| of(job, place).map(|m| m.1)).into_iter().map(look).collect()
}

/// The bytes of `poses_smoothed.csv`.
///
/// # Errors
/// Never for a table in memory; the signature is that of the CSV writer.
pub fn smoothed_csv(study: &Study, outcome: &Outcome) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut header: Vec<String> = ["trial", "frame", "body", "kind"].map(str::to_owned).to_vec();
    header.extend(POSE.map(str::to_owned));
    header.extend(["time_s", "moved_mm", "moved_deg"].map(str::to_owned));
    header.extend(INTERVALS.map(|what| format!("interval95_{what}")));
    writer.write_record(&header)?;
    for of in &outcome.smoothed {
        let frames = outcome.frames.iter().filter(|f| f.trial == of.trial);
        for (frame, pose) in frames.zip(&of.smoothed.frames) {
            let Some(pose) = pose else { continue };
            let kind = if pose.measured { "smoothed" } else { "bridged" };
            let mut cells = vec![
                study.trials[of.trial].name.clone(),
                frame.label.clone(),
                study.bodies[of.body].name.clone(),
                kind.to_owned(),
            ];
            cells.extend(pose_cells(pose.pose));
            cells.push(frame.time_s.map_or(String::new(), |t| fixed(t, 6)));
            if pose.measured {
                cells.extend([fixed(pose.moved[0], 6), fixed(pose.moved[1].to_degrees(), 6)]);
            } else {
                cells.extend([String::new(), String::new()]);
            }
            cells.extend((0..6).map(|k| {
                let half = NINETY_FIVE * pose.covariance[k][k].max(0.0).sqrt();
                fixed(if k < 3 { half } else { half.to_degrees() }, 6)
            }));
            writer.write_record(&cells)?;
        }
    }
    writer.into_inner().map_err(|e| csv::Error::from(e.into_error()))
}

/// One line a body and trial on what smoothing did, for the end of a run and the report.
pub fn effect(study: &Study, of: &SmoothOutcome) -> String {
    let found = &of.smoothed;
    let bridged = found.frames.iter().flatten().filter(|f| !f.measured).count();
    let [place, turn] = found.normalised_innovation;
    let bridges = if bridged > 0 { format!(", {bridged} frames bridged") } else { String::new() };
    format!(
        "smoothing moved {} in {} by {:.4} mm and {:.4} deg (root mean square){bridges}; innovations over what is stated: {place:.2} of place, {turn:.2} \
         of turning (1 where noise is as stated)",
        study.bodies[of.body].name,
        study.trials[of.trial].name,
        found.moved[0],
        found.moved[1].to_degrees(),
    )
}
