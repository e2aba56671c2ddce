//! `biplane compare`: objectives by optimisers on one study, as the thesis's Tables 5.1 and 5.2 compare methods.
//!
//! Each method searches the same frames from the same starts, Gaussian around the study's own start (or the reference's pose where there is none), as
//! `[match.search]` says; `method = "rim"` and `"bingham2006"` are beside them. The error of a method is that of its answers, the lowest
//! objective of a frame's searches; where no reference is given, how far apart its searches end says how repeatable it is.
//!
//! Nothing is written into the store but what a run would write there too; poses that are found here are no results.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use biplane_artifact::{ContentHash, Curves};
use biplane_geometry::{Point3, Pose, PoseError};
use biplane_objective::{DistanceField, Kind};
use biplane_optimisation::{
    Ended, MatchInputs, MatchParams, Method, SearchParams, Single, lowest, prepared_rim,
};
use biplane_optimiser::Optimiser;
use biplane_outline::RimMesh;
use biplane_stage::{Context, Store, StoreError, Stored};
use nalgebra::{Matrix4, Vector3};
use rayon::prelude::*;

use crate::calibrate::{CalibrateError, calibrate};
use crate::diagnostics::{meant, slashes};
use crate::logging::Progress;
use crate::models::look::models;
use crate::prepare::{InputErrors, Job, Prepared};
use crate::steps::{ItemError, Steps};
use crate::study::Study;
use crate::summary::aligned;
use crate::tables::{PoseTable, TableError, same_frame};
use crate::walk::Way;

/// A single search is right below this, as the thesis's tables count it: mm of the centroid, and degrees.
const RIGHT: (f64, f64) = (1.0, 1.0);

/// What to compare.
#[derive(Debug, Clone, Default)]
pub struct CompareWish {
    /// Objectives of `[match.search]`.
    pub objectives: Vec<Kind>,
    /// Optimisers of each.
    pub optimisers: Vec<Optimiser>,
    /// `method = "rim"` and `"bingham2006"` too.
    pub presets: bool,
    /// This trial alone.
    pub trial: Option<String>,
    /// This body alone.
    pub body: Option<String>,
    /// Frames of a trial, evenly over it; 0 for all.
    pub frames: usize,
    /// Starts of a frame, in place of those of `[match.search]`.
    pub starts: Option<usize>,
    /// Calls of a search, in place of those of `[match.search]`.
    pub calls: Option<usize>,
    /// Known poses.
    pub reference: Option<PathBuf>,
    /// Where to write the table as CSV.
    pub csv: Option<PathBuf>,
    /// Threads; 0 is one for each core.
    pub threads: usize,
}

/// Why there is no comparison.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
    /// Inputs that everything hangs on are wrong.
    #[error(transparent)]
    Inputs(#[from] InputErrors),
    /// The store cannot be used.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// There are no fluoroscopes.
    #[error("The calibration failed, so nothing can be matched.\n{0}")]
    Calibration(#[from] CalibrateError),
    /// There is no such trial or body.
    #[error("there is no {what} `{wanted}`, {hint}")]
    NoSuch {
        /// Trial or body.
        what: &'static str,
        /// What was asked for.
        wanted: String,
        /// What may be meant, or what there is.
        hint: String,
    },
    /// Nothing is left to search.
    #[error("nothing to compare: {0}")]
    Nothing(String),
    /// The reference cannot be read.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The reference cannot be used.
    #[error("{path}: {what}")]
    Reference {
        /// The file.
        path: String,
        /// What was found and expected.
        what: String,
    },
    /// The parameters do not do.
    #[error("{0}")]
    Parameters(String),
    /// The table cannot be written.
    #[error("cannot write {path}: {source}")]
    Write {
        /// The file.
        path: String,
        /// Why.
        source: csv::Error,
    },
    /// No threads.
    #[error("cannot start threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// A person stopped it.
    #[error("stopped after {done} of {all} searches; a comparison is told when all are done")]
    Stopped {
        /// Searches that were finished.
        done: usize,
        /// All of them.
        all: usize,
    },
}

/// One way to find poses.
#[derive(Debug, Clone)]
struct Contender {
    objective: &'static str,
    optimiser: &'static str,
    params: MatchParams,
}

/// One body in one frame, and where to start.
struct Scene<'a> {
    name: String,
    inputs: MatchInputs,
    rim: Arc<RimMesh>,
    /// Where the curves that may be the body's are.
    near: Pose,
    starts: Vec<Pose>,
    known: Option<Pose>,
    context: &'a Context,
}

/// What a contender's searches of a scene gave.
struct Found {
    /// Each with the seconds it took.
    ends: Vec<(Ended, f64)>,
    /// Seconds before the first search.
    prepared_s: f64,
}

/// One line of the table.
#[derive(Debug, Clone, PartialEq)]
struct Line {
    objective: &'static str,
    optimiser: &'static str,
    searches: usize,
    converged: f64,
    /// Share of searches that are right; with a reference.
    right: Option<f64>,
    /// Of answers, mm and degrees: median, 95 % and worst; with a reference.
    error: Option<[[f64; 3]; 2]>,
    /// Standard deviation of a coordinate of the centroid, mm, and of a component of the rotation, degrees, over a frame's searches.
    spread: Option<[f64; 2]>,
    calls: f64,
    ms: f64,
    /// Why there is nothing, or less.
    note: String,
}

/// Compares, and says what came of it.
///
/// # Errors
/// See [`CompareError`]. A method that cannot search some frame is no error: its line says so.
pub fn compare(study: Study, wish: &CompareWish, context: &Context) -> Result<String, CompareError> {
    let prepared = Prepared::of(study)?;
    let store = Store::open(&prepared.study.hidden())?;
    let known = wish.reference.as_deref().map(|path| reference(path, &prepared.study, wish)).transpose()?;
    let mut search = prepared.study.matching.search;
    search.starts = wish.starts.unwrap_or(search.starts);
    search.calls = wish.calls.unwrap_or(search.calls);
    let (contenders, mut lines) = contenders(&prepared.study.matching, &search, wish)?;
    let scenes = scenes(&prepared, &store, context, wish, known.as_ref(), &search)?;
    let tasks: Vec<(usize, usize)> =
        (0..contenders.len()).flat_map(|c| (0..scenes.len()).map(move |s| (c, s))).collect();
    let searches = contenders.len() * scenes.iter().map(|s| s.starts.len()).sum::<usize>();
    let progress = Progress::new("Comparing", searches, "searches");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(wish.threads).build()?;
    let found: Vec<Option<Result<Found, String>>> = pool.install(|| {
        tasks.par_iter().map(|&(c, s)| scenes[s].search(&contenders[c].params, &progress)).collect()
    });
    drop(progress);
    if context.cancelled() || found.iter().any(Option::is_none) {
        let done = found.iter().flatten().flatten().map(|f| f.ends.len()).sum();
        return Err(CompareError::Stopped { done, all: searches });
    }
    let found: Vec<Result<Found, String>> = found.into_iter().flatten().collect();
    lines.splice(
        0..0,
        contenders
            .iter()
            .zip(found.chunks(scenes.len()))
            .map(|(contender, found)| line(contender, &scenes, found)),
    );
    if let Err(error) = prepared.index.save(false) {
        tracing::debug!("the index of inputs was not written: {error}");
    }
    if let Some(path) = &wish.csv {
        let written = write_csv(path, &lines);
        written.map_err(|source| CompareError::Write { path: slashes(path), source })?;
    }
    let names: Vec<&str> = scenes.iter().map(|s| s.name.as_str()).collect();
    Ok(told(&lines, &names, &search, wish))
}

/// What is compared, and lines of what cannot be.
fn contenders(
    params: &MatchParams,
    search: &SearchParams,
    wish: &CompareWish,
) -> Result<(Vec<Contender>, Vec<Line>), CompareError> {
    let (mut all, mut none) = (Vec::new(), Vec::new());
    for objective in &wish.objectives {
        for optimiser in &wish.optimisers {
            let own = SearchParams { objective: *objective, optimiser: *optimiser, ..*search };
            let (objective, optimiser) = (objective.name(), optimiser.name());
            let own = MatchParams { method: Method::Search, search: own, ..params.clone() };
            match own.check() {
                Ok(()) => all.push(Contender { objective, optimiser, params: own }),
                Err(biplane_optimisation::MatchError::Optimiser { .. }) => none.push(Line {
                    note: "the optimiser needs derivatives, the objective has none".to_owned(),
                    ..Line::empty(objective, optimiser)
                }),
                Err(error) => return Err(CompareError::Parameters(error.to_string())),
            }
        }
    }
    if wish.presets {
        // The thesis's own search has as many calls as it says; its starts are those of all here.
        for (method, name) in [(Method::Rim, "rim"), (Method::Bingham2006, "bingham2006")] {
            let params = MatchParams { method, ..params.clone() };
            all.push(Contender { objective: name, optimiser: "", params });
        }
    }
    if all.is_empty() {
        let what = "no objective can be searched by any of these optimisers, and no preset is asked for";
        return Err(CompareError::Nothing(what.to_owned()));
    }
    Ok((all, none))
}

/// Known poses: frame, body (any, if none is named) and pose.
type Known = Vec<(Option<String>, String, Option<String>, Pose)>;

/// A table of poses, or one of 16 numbers a row.
fn reference(path: &Path, study: &Study, wish: &CompareWish) -> Result<Known, CompareError> {
    match PoseTable::read(path) {
        Ok(table) => Ok(table.rows.into_iter().map(|r| (r.trial, r.frame, Some(r.body), r.pose)).collect()),
        Err(TableError::NoColumn { .. }) => {
            let wrong = |what: String| CompareError::Reference { path: slashes(path), what };
            if wish.body.is_none() && study.bodies.len() > 1 {
                let names: Vec<&str> = study.bodies.iter().map(|b| b.name.as_str()).collect();
                return Err(wrong(format!(
                    "the table has no column `body`: say whose poses these are, --body {}",
                    names.join(" or --body ")
                )));
            }
            let mut reader = csv::Reader::from_path(path).map_err(|e| wrong(e.to_string()))?;
            let mut known = Vec::new();
            for (row, record) in reader.records().enumerate() {
                let record = record.map_err(|e| wrong(e.to_string()))?;
                let numbers: Vec<f64> = record.iter().skip(1).filter_map(|v| v.trim().parse().ok()).collect();
                let matrix = (numbers.len() == 16).then(|| Matrix4::from_row_slice(&numbers));
                let pose = matrix.as_ref().and_then(Pose::from_matrix).ok_or_else(|| {
                    wrong(format!(
                        "line {}: expected a frame and the 16 numbers of world_from_model, or a table of poses (frame, body, tx_mm, ...)",
                        row + 2
                    ))
                })?;
                known.push((None, record.get(0).unwrap_or_default().trim().to_owned(), None, pose));
            }
            Ok(known)
        }
        Err(error) => Err(error.into()),
    }
}

/// So many of a list, evenly over it.
fn evenly<T>(all: Vec<T>, count: usize) -> Vec<T> {
    let total = all.len();
    if count == 0 || count >= total {
        return all;
    }
    let mut chosen: Vec<usize> = (0..count).map(|k| (k * 2 + 1) * total / (2 * count)).collect();
    chosen.dedup();
    all.into_iter().enumerate().filter(|(k, _)| chosen.contains(k)).map(|(_, item)| item).collect()
}

/// The bodies and frames that are searched.
fn scenes<'a>(
    prepared: &Prepared,
    store: &Store,
    context: &'a Context,
    wish: &CompareWish,
    known: Option<&Known>,
    search: &SearchParams,
) -> Result<Vec<Scene<'a>>, CompareError> {
    let study = &prepared.study;
    let trials: Vec<&str> = study.trials.iter().map(|t| t.name.as_str()).collect();
    let bodies: Vec<&str> = study.bodies.iter().map(|b| b.name.as_str()).collect();
    for (what, wanted, known) in [("trial", &wish.trial, &trials), ("body", &wish.body, &bodies)] {
        if let Some(wanted) = wanted.as_deref().filter(|w| !known.contains(w)) {
            let hint = meant(wanted, known.iter().copied());
            let wanted = wanted.to_owned();
            return Err(CompareError::NoSuch { what, wanted, hint });
        }
    }
    let (calibrated, _) = calibrate(prepared, store, context, Way::Run(Vec::new()));
    let calibrated = calibrated?.unwrap_or_default();
    let models = models(prepared, store, context);
    let steps = Steps { prepared, calibrated: &calibrated, models: &models, store, context };
    let wanted = |name: &str, wish: &Option<String>| wish.as_deref().is_none_or(|w| w == name);
    let (mut scenes, mut without) = (Vec::new(), Vec::new());
    for trial in (0..study.trials.len()).filter(|t| wanted(trials[*t], &wish.trial)) {
        let jobs: Vec<&Job> = prepared.jobs.iter().filter(|job| job.trial == trial).collect();
        let pose_of = |job: &Job, body: &str| {
            let rows = known.into_iter().flatten().find(|(of_trial, frame, of_body, _)| {
                of_trial.as_deref().is_none_or(|t| t == trials[trial])
                    && of_body.as_deref().is_none_or(|b| b == body)
                    && same_frame(frame, &job.label)
            });
            rows.map(|(.., pose)| *pose)
        };
        // Frames without a known pose say nothing of errors.
        let jobs: Vec<&Job> = jobs
            .into_iter()
            .filter(|job| {
                let mut names =
                    job.bodies.iter().map(|(body, ..)| bodies[*body]).filter(|b| wanted(b, &wish.body));
                known.is_none() || names.any(|body| pose_of(job, body).is_some())
            })
            .collect();
        for job in evenly(jobs, wish.frames) {
            for place in (0..job.bodies.len()).filter(|p| wanted(bodies[job.bodies[*p].0], &wish.body)) {
                if context.cancelled() {
                    return Err(CompareError::Stopped { done: 0, all: 0 });
                }
                let name = format!("{}/{}/{}", trials[trial], job.label, bodies[job.bodies[place].0]);
                let pose = pose_of(job, bodies[job.bodies[place].0]);
                match scene((&steps, context), job, place, pose, search, &name) {
                    Ok(scene) if known.is_none() || scene.known.is_some() => scenes.push(scene),
                    Ok(_) => {}
                    Err(why) => {
                        tracing::warn!("{name}: {why}");
                        without.push(why);
                    }
                }
            }
        }
    }
    match without.into_iter().next() {
        _ if !scenes.is_empty() => Ok(scenes),
        Some(why) => Err(CompareError::Nothing(why)),
        None if known.is_some() => Err(CompareError::Nothing(
            "the reference has no pose of a body in a frame of the study".to_owned(),
        )),
        None => Err(CompareError::Nothing("no trial looks for such a body in any frame".to_owned())),
    }
}

/// One body in one frame: its curves, what a person drew in their place, its mesh and its starts.
fn scene<'a>(
    (steps, context): (&Steps<'_>, &'a Context),
    job: &Job,
    place: usize,
    known: Option<Pose>,
    search: &SearchParams,
    name: &str,
) -> Result<Scene<'a>, String> {
    let text = |e: ItemError| e.to_string();
    let mut curves: Vec<Stored<Curves>> = Vec::new();
    for slot in 0..job.pictures.len() {
        let (automatic, _) = steps.segment(job, slot).map_err(text)?;
        let drawn = steps.drawn(job, slot).map_err(text)?;
        curves.push(match drawn.as_ref().and_then(|d| d.of(place)) {
            None => automatic,
            Some(edit) => steps.trace(job, slot, place, &automatic, edit).map_err(text)?.0,
        });
    }
    let inputs = steps.match_inputs(job, place, &curves)?;
    let params = steps.prepared.study.matching_of(job.bodies[place].0);
    let rim = prepared_rim(&inputs, &params, context);
    let near = inputs.start.first().map(|start| start.0).or(known);
    let near = near.ok_or("no start pose, and no reference to start around")?;
    let starts = search.starts(&near, rim.centroid());
    Ok(Scene { name: name.to_owned(), inputs, rim, near, starts, known, context })
}

impl Scene<'_> {
    /// All searches of a contender; `None` if the comparison was stopped.
    fn search(&self, params: &MatchParams, progress: &Progress) -> Option<Result<Found, String>> {
        let hash: ContentHash = self.inputs.model.hash();
        let field = || self.context.prepared(hash, || DistanceField::new(&self.inputs.model.0));
        // Made once a mesh, so it is no part of any search's time.
        if params.method == Method::Search && params.search.objective == Kind::InversePoint {
            field();
        }
        let begun = Instant::now();
        let mut single = match Single::new(&self.inputs, &self.rim, field, &self.near, params) {
            Ok(single) => single,
            Err(why) => {
                self.starts.iter().for_each(|_| progress.tick());
                return Some(Err(why));
            }
        };
        let prepared_s = begun.elapsed().as_secs_f64();
        let mut ends = Vec::with_capacity(self.starts.len());
        for start in &self.starts {
            if self.context.cancelled() {
                return None;
            }
            let begun = Instant::now();
            let ended = single.from(start);
            ends.push((ended, begun.elapsed().as_secs_f64()));
            progress.tick();
        }
        Some(Ok(Found { ends, prepared_s }))
    }

    fn centroid(&self) -> &Point3 {
        self.rim.centroid()
    }
}

impl Line {
    fn empty(objective: &'static str, optimiser: &'static str) -> Self {
        Self {
            objective,
            optimiser,
            searches: 0,
            converged: 0.0,
            right: None,
            error: None,
            spread: None,
            calls: 0.0,
            ms: 0.0,
            note: String::new(),
        }
    }
}

/// The line of a contender; one of `found` a scene.
fn line(contender: &Contender, scenes: &[Scene<'_>], found: &[Result<Found, String>]) -> Line {
    let done: Vec<(&Scene<'_>, &Found)> =
        scenes.iter().zip(found).filter_map(|(scene, found)| Some((scene, found.as_ref().ok()?))).collect();
    let failed = found.iter().filter_map(|f| f.as_ref().err());
    let note = match (failed.clone().next(), failed.count()) {
        (Some(why), count) => format!("{count} of {} frames: {why}", scenes.len()),
        _ => String::new(),
    };
    let searches: usize = done.iter().map(|(_, found)| found.ends.len()).sum();
    if searches == 0 {
        return Line { note, ..Line::empty(contender.objective, contender.optimiser) };
    }
    let per_search = |sum: f64| sum / searches as f64;
    let all = || done.iter().flat_map(|(scene, found)| found.ends.iter().map(move |(e, s)| (*scene, e, *s)));
    let error = |scene: &Scene<'_>, pose: &Pose| {
        let PoseError { translation_mm, rotation_rad } = pose.error_against(&scene.known?, scene.centroid());
        Some([translation_mm, rotation_rad.to_degrees()])
    };
    let right = all().filter_map(|(scene, e, _)| error(scene, &e.pose));
    let right: Vec<bool> = right.map(|[mm, deg]| mm < RIGHT.0 && deg < RIGHT.1).collect();
    let answers = done.iter().filter_map(|(scene, found)| {
        let ends: Vec<Ended> = found.ends.iter().map(|(e, _)| *e).collect();
        error(scene, &lowest(&ends)?.pose)
    });
    let answers: Vec<[f64; 2]> = answers.collect();
    let prepared: f64 = done.iter().map(|(_, found)| found.prepared_s).sum();
    Line {
        searches,
        converged: per_search(all().filter(|(_, e, _)| e.converged).count() as f64),
        right: (!right.is_empty()).then(|| right.iter().filter(|r| **r).count() as f64 / right.len() as f64),
        error: (!answers.is_empty())
            .then(|| [0, 1].map(|k| quantiles(answers.iter().map(|a| a[k]).collect()))),
        spread: spread(&done),
        calls: per_search(all().map(|(_, e, _)| e.calls as f64).sum()),
        ms: 1e3 * per_search(prepared + all().map(|(.., s)| s).sum::<f64>()),
        note,
        ..Line::empty(contender.objective, contender.optimiser)
    }
}

/// Median, 95 % and largest of at least one number.
fn quantiles(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let place = (share * values.len() as f64).ceil() as usize;
        values[place.clamp(1, values.len()) - 1]
    };
    [at(0.5), at(0.95), at(1.0)]
}

/// Standard deviation over a frame's searches that came to rest, root of the mean over frames and axes: mm and degrees.
fn spread(done: &[(&Scene<'_>, &Found)]) -> Option<[f64; 2]> {
    let mut sums = [0.0, 0.0];
    let mut degrees_of_freedom = 0;
    for (scene, found) in done {
        let rested: Vec<&Pose> =
            found.ends.iter().filter(|(e, _)| e.converged).map(|(e, _)| &e.pose).collect();
        let Some(first) = rested.first().filter(|_| rested.len() > 1) else { continue };
        let off = |pose: &&Pose| {
            let moved = pose.transform(scene.centroid()) - first.transform(scene.centroid());
            [moved, (pose.rotation() * first.rotation().inverse()).scaled_axis()]
        };
        let offs: Vec<[Vector3<f64>; 2]> = rested.iter().map(off).collect();
        for (k, sum) in sums.iter_mut().enumerate() {
            let mean = offs.iter().map(|o| o[k]).sum::<Vector3<f64>>() / offs.len() as f64;
            *sum += offs.iter().map(|o| (o[k] - mean).norm_squared()).sum::<f64>() / 3.0;
        }
        degrees_of_freedom += rested.len() - 1;
    }
    let [mm, rad] = sums.map(|sum| (sum / degrees_of_freedom as f64).sqrt());
    (degrees_of_freedom > 0).then(|| [mm, rad.to_degrees()])
}

fn told(lines: &[Line], scenes: &[&str], search: &SearchParams, wish: &CompareWish) -> String {
    let known = wish.reference.is_some();
    let mut text = format!(
        "{} bodies in frames ({}{}), {} starts each: the study's own and Gaussian ones around it, sigma {} mm and {} degrees, cut at {} sigma, seed {}; \
         at most {} calls a search\n\n",
        scenes.len(),
        scenes.iter().take(3).copied().collect::<Vec<_>>().join(", "),
        if scenes.len() > 3 { ", ..." } else { "" },
        search.starts,
        search.start_sigma_mm,
        search.start_sigma_deg,
        search.start_cut_sigma,
        search.seed,
        search.calls,
    );
    let mut header = vec!["objective", "optimiser", "converged %"];
    if known {
        header.extend(["right %", "error mm", "95 %", "worst", "error deg", "95 %", "worst"]);
    }
    header.extend(["sd mm", "sd deg", "calls", "ms", ""]);
    let right: Vec<usize> = (2..header.len() - 1).collect();
    let rows = lines.iter().map(|line| {
        let optional =
            |value: Option<f64>, digits: usize| value.map_or("-".to_owned(), |v| format!("{v:.digits$}"));
        let ran = |value: f64, digits: usize| optional((line.searches > 0).then_some(value), digits);
        let mut row =
            vec![line.objective.to_owned(), line.optimiser.to_owned(), ran(100.0 * line.converged, 0)];
        if known {
            row.push(optional(line.right.map(|r| 100.0 * r), 0));
            for kind in 0..2 {
                row.extend((0..3).map(|k| optional(line.error.map(|e| e[kind][k]), 3)));
            }
        }
        row.extend((0..2).map(|k| optional(line.spread.map(|s| s[k]), 3)));
        row.extend([ran(line.calls, 0), ran(line.ms, 1), line.note.clone()]);
        row
    });
    text += &aligned(&header, rows, &right);
    text += "\nconverged: searches that came to rest before their calls were used up. ";
    if known {
        text += "right: searches that ended within 1 mm and 1 degree of the reference. error: of the answers (the lowest objective of a \
                 frame's searches), at the mesh's centroid. ";
    }
    text += "sd: standard deviation of a coordinate over a frame's searches that came to rest. calls, ms: mean of a search; calls of `rim` are its \
             steps, each about one evaluation with derivatives.";
    if wish.threads != 1 {
        text += " Times were taken on several threads at once: take them with --threads 1.";
    }
    text + "\n"
}

fn write_csv(path: &Path, lines: &[Line]) -> Result<(), csv::Error> {
    let mut writer = csv::Writer::from_path(path)?;
    writer.write_record([
        "objective",
        "optimiser",
        "searches",
        "converged_share",
        "right_share",
        "error_median_mm",
        "error_95_mm",
        "error_worst_mm",
        "error_median_deg",
        "error_95_deg",
        "error_worst_deg",
        "sd_mm",
        "sd_deg",
        "calls",
        "ms",
        "note",
    ])?;
    for line in lines {
        let number = |value: Option<f64>| value.map_or(String::new(), |v| format!("{v:.6}"));
        let ran = |value: f64| number((line.searches > 0).then_some(value));
        let mut row = vec![line.objective.to_owned(), line.optimiser.to_owned(), line.searches.to_string()];
        row.extend([ran(line.converged), number(line.right)]);
        row.extend((0..6).map(|k| number(line.error.map(|e| e[k / 3][k % 3]))));
        row.extend((0..2).map(|k| number(line.spread.map(|s| s[k]))));
        row.extend([ran(line.calls), ran(line.ms), line.note.clone()]);
        writer.write_record(row)?;
    }
    writer.flush()?;
    Ok(())
}
