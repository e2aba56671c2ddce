//! Poses of other programs brought in: `biplane import` makes a table of starts of them, `biplane difference` holds results against them.
//!
//! Formats that count frames from the first (`.tra`, XMALab, JointTrack) are given the labels of a trial's frames in order. JointTrack's poses are in the
//! frame of a camera and need the study's calibration.

use std::path::Path;

use biplane_acquisition::poses::{Poses, jointtrack, tra, xmalab};
use biplane_geometry::{Point3, Pose};
use biplane_stage::{Context, Store, StoreError};

use crate::calibrate::{CalibrateError, calibrate};
use crate::diagnostics::{meant, slashes};
use crate::exports::{TraLayout, TraSection};
use crate::models::look;
use crate::prepare::{InputErrors, Prepared};
use crate::results::pose_line;
use crate::steps::Steps;
use crate::study::Study;
use crate::summary::aligned;
use crate::tables::{EXAMPLE_HEADER, PoseRow, PoseTable, TableError, same_frame};
use crate::walk::Way;

/// What to read, and how.
#[derive(Debug, Clone, Default)]
pub struct Foreign {
    /// The trial whose frames it has; needed where the study has several.
    pub trial: Option<String>,
    /// The bodies in the file, in order.
    pub bodies: Vec<String>,
    /// The view whose camera JointTrack's poses are in; the first one if not given.
    pub view: Option<String>,
    /// How a `.tra` is written, where its numbers allow more than one.
    pub layout: Option<TraLayout>,
    /// Whether a `.tra` is in centimetres.
    pub centimetres: bool,
}

/// Why poses cannot be brought in.
#[derive(Debug, thiserror::Error)]
pub enum ExchangeError {
    /// The study's inputs.
    #[error(transparent)]
    Inputs(#[from] InputErrors),
    /// The store.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The calibration.
    #[error(transparent)]
    Calibration(#[from] CalibrateError),
    /// A table of ours.
    #[error(transparent)]
    Table(#[from] TableError),
    /// A file of another program.
    #[error(transparent)]
    Poses(#[from] biplane_acquisition::poses::PosesError),
    /// It cannot be read.
    #[error("{0}: {1}")]
    Unreadable(String, std::io::Error),
    /// What was asked for cannot be.
    #[error("{0}")]
    Asked(String),
}

/// A study with its calibrations and models, as far as they are there.
struct Open {
    prepared: Prepared,
    cameras: Vec<Option<Pose>>,
    pivots: Vec<Point3>,
}

fn open(study: Study) -> Result<Open, ExchangeError> {
    let prepared = Prepared::of(study)?;
    let store = Store::open(&prepared.study.hidden())?;
    let context = Context::new();
    let (calibrated, _) = calibrate(&prepared, &store, &context, Way::Look(Vec::new()));
    let calibrated = calibrated?.unwrap_or_default();
    let (models, _) = look::look(&prepared, &store, &context, &mut Vec::new());
    let steps = Steps {
        prepared: &prepared,
        calibrated: &calibrated,
        models: &models,
        store: &store,
        context: &context,
    };
    let pivots = steps.pivots();
    let cameras = calibrated.calibrations.iter().map(|c| jointtrack::laboratory_from_camera(c)).collect();
    Ok(Open { prepared, cameras, pivots })
}

/// The place of a name in a list; the list in the message where it is not there.
fn place(what: &str, name: &str, known: &[&str]) -> Result<usize, ExchangeError> {
    known.iter().position(|k| *k == name).ok_or_else(|| {
        let meant = meant(name, known.iter().copied());
        ExchangeError::Asked(format!("the study has no {what} `{name}`: {meant}"))
    })
}

impl Open {
    /// The poses of a file as rows of a table.
    fn read(&self, path: &Path, wish: &Foreign) -> Result<PoseTable, ExchangeError> {
        let study = &self.prepared.study;
        let name = slashes(path);
        let bytes = std::fs::read(path).map_err(|e| ExchangeError::Unreadable(name.clone(), e))?;
        let text = String::from_utf8_lossy(&bytes);
        let first = text.lines().find(|l| !l.trim().is_empty() && !l.starts_with('#')).unwrap_or_default();
        let columns: Vec<&str> = first.split(',').map(str::trim).collect();
        if columns.contains(&"frame") && columns.contains(&"body") {
            return Ok(PoseTable::parse(path, &bytes)?);
        }
        let trials: Vec<&str> = study.trials.iter().map(|t| t.name.as_str()).collect();
        let trial = match (&wish.trial, trials.as_slice()) {
            (Some(name), _) => place("trial", name, &trials)?,
            (None, [_]) => 0,
            (None, _) => {
                let text = format!(
                    "{name} does not say of which trial it is: add --trial NAME ({})",
                    trials.join(", ")
                );
                return Err(ExchangeError::Asked(text));
            }
        };
        let known: Vec<&str> = study.bodies.iter().map(|b| b.name.as_str()).collect();
        let bodies = if wish.bodies.is_empty() {
            study.trials[trial].bodies.clone()
        } else {
            wish.bodies.iter().map(|b| place("body", b, &known)).collect::<Result<_, _>>()?
        };
        let all: Vec<Poses> = if first.trim_start().starts_with("JT") {
            let names: Vec<&str> = study.views.iter().map(|v| v.name.as_str()).collect();
            let view = wish.view.as_ref().map_or(Ok(0), |v| place("fluoroscope", v, &names))?;
            let camera = self.cameras.get(view).copied().flatten().ok_or_else(|| {
                ExchangeError::Asked(format!(
                    "{name} is in the frame of a camera, and that of view {} is not known: `biplane run` first, or give its calibration \
                     (a mirrored picture has none that JointTrack knows)",
                    names.get(view).copied().unwrap_or_default()
                ))
            })?;
            vec![jointtrack::read(&name, &text, &camera)?]
        } else if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("tra")) {
            let layout = self.layout(&name, &text, bodies.len(), wish)?;
            let section = TraSection { layout, centimetres: wish.centimetres, spaces: false };
            tra::read(&name, &text, bodies.len(), section.dialect())?
        } else {
            vec![xmalab::read(&name, &text)?]
        };
        if all.len() != bodies.len() {
            let text = format!("{name} holds one body: name it, --body {}", known.join(" or --body "));
            return Err(ExchangeError::Asked(text));
        }
        let labels: Vec<&str> =
            self.prepared.jobs.iter().filter(|j| j.trial == trial).map(|j| j.label.as_str()).collect();
        let mut rows = Vec::new();
        for (body, poses) in bodies.iter().zip(&all) {
            if poses.len() > labels.len() {
                let text = format!(
                    "{name} has {} frames, trial {} has {}: they are not of the same frames",
                    poses.len(),
                    trials[trial],
                    labels.len()
                );
                return Err(ExchangeError::Asked(text));
            }
            for (frame, (label, pose)) in labels.iter().zip(poses).enumerate() {
                rows.extend(pose.map(|pose| PoseRow {
                    trial: Some(trials[trial].to_owned()),
                    frame: (*label).to_owned(),
                    body: known[*body].to_owned(),
                    pose,
                    line: frame as u64 + 1,
                }));
            }
        }
        Ok(PoseTable { path: path.to_owned(), rows })
    }

    /// The layout of a `.tra`, as it is said or as its numbers allow alone.
    fn layout(
        &self,
        name: &str,
        text: &str,
        bodies: usize,
        wish: &Foreign,
    ) -> Result<TraLayout, ExchangeError> {
        if let Some(layout) = wish.layout {
            return Ok(layout);
        }
        let word = |layout: &tra::Layout| match layout {
            tra::Layout::MatrixRows => (TraLayout::MatrixRows, "matrix-rows"),
            tra::Layout::MatrixColumns => (TraLayout::MatrixColumns, "matrix-columns"),
            tra::Layout::Degrees => (TraLayout::Degrees, "degrees"),
            tra::Layout::Radians => (TraLayout::Radians, "radians"),
        };
        let allowed: Vec<(TraLayout, &str)> = tra::dialects(name, text, bodies).iter().map(word).collect();
        match allowed.as_slice() {
            [(only, _)] => Ok(*only),
            [] => Err(ExchangeError::Asked(format!(
                "{name} does not hold {bodies} bodies a line in any layout: name its bodies in order, --body A --body B"
            ))),
            several => {
                let words: Vec<&str> = several.iter().map(|(_, word)| *word).collect();
                let text = format!("{name} may be {}: say which, --layout {}", words.join(" or "), words[0]);
                Err(ExchangeError::Asked(text))
            }
        }
    }
}

/// A table of starts from a file of another program.
///
/// # Errors
/// [`ExchangeError`].
pub fn import(study: Study, path: &Path, wish: &Foreign) -> Result<String, ExchangeError> {
    let table = open(study)?.read(path, wish)?;
    let mut text = format!("{EXAMPLE_HEADER}\n");
    for row in &table.rows {
        let trial = row.trial.as_deref().unwrap_or_default();
        text += &(pose_line(trial, &row.frame, &row.body, row.pose) + "\n");
    }
    Ok(text)
}

/// Frames that are named for each body.
const NAMED: usize = 3;

/// How far the results lie from the poses of a file, body by body; both may be files.
///
/// # Errors
/// [`ExchangeError`].
pub fn difference(
    study: Study,
    path: &Path,
    results: Option<&Path>,
    wish: &Foreign,
) -> Result<String, ExchangeError> {
    let open = open(study)?;
    let study = &open.prepared.study;
    let own = results.map_or_else(|| study.output.join("poses.csv"), Path::to_owned);
    let (ours, theirs) = (open.read(&own, wish)?, open.read(path, wish)?);
    let mut lines = Vec::new();
    let mut worst = String::new();
    for (number, body) in study.bodies.iter().enumerate() {
        let pivot = open.pivots[number];
        let mut errors: Vec<(f64, f64, String)> = Vec::new();
        let mut along = [Vec::new(), Vec::new(), Vec::new()];
        for row in ours.rows.iter().filter(|r| r.body == body.name) {
            let same = |r: &&PoseRow| {
                let trial = r.trial.is_none() || row.trial.is_none() || r.trial == row.trial;
                trial && r.body == row.body && same_frame(&r.frame, &row.frame)
            };
            let Some(other) = theirs.rows.iter().find(same) else { continue };
            let off = row.pose.error_against(&other.pose, &pivot);
            let moved = row.pose.transform(&pivot) - other.pose.transform(&pivot);
            (0..3).for_each(|k| along[k].push(moved[k]));
            let frame = format!("{} {}", row.trial.as_deref().unwrap_or_default(), row.frame);
            errors.push((off.translation_mm, off.rotation_rad.to_degrees(), frame));
        }
        if errors.is_empty() {
            continue;
        }
        let rank = |of: fn(&(f64, f64, String)) -> f64, share: f64| {
            let mut values: Vec<f64> = errors.iter().map(of).collect();
            values.sort_by(f64::total_cmp);
            let last = values.len() - 1;
            values[((share * values.len() as f64).ceil() as usize).saturating_sub(1).min(last)]
        };
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let mut cells = vec![body.name.clone(), errors.len().to_string()];
        cells.extend([0.5, 0.95, 1.0].map(|s| format!("{:.3}", rank(|e| e.0, s))));
        cells.extend([0.5, 0.95, 1.0].map(|s| format!("{:.3}", rank(|e| e.1, s))));
        cells.extend(along.iter().map(|a| format!("{:+.3}", mean(a))));
        lines.push(cells);
        errors.sort_by(|a, b| b.0.total_cmp(&a.0));
        let named: Vec<String> = errors
            .iter()
            .take(NAMED)
            .map(|(mm, deg, frame)| format!("{} ({mm:.3} mm, {deg:.3} deg)", frame.trim()))
            .collect();
        worst += &format!("{} is farthest off in {}\n", body.name, named.join(", "));
    }
    if lines.is_empty() {
        let text = format!("{} and {} have no body in a frame in common", slashes(&own), slashes(path));
        return Err(ExchangeError::Asked(text));
    }
    let header = [
        "body",
        "frames",
        "mm: median",
        "95 %",
        "worst",
        "deg: median",
        "95 %",
        "worst",
        "mean x, mm",
        "mean y",
        "mean z",
    ];
    let columns: Vec<usize> = (1..header.len()).collect();
    Ok(format!(
        "{} against {}; places are of the mesh's area centroid, in the laboratory's axes\n\n{}\n{worst}",
        study.relative(&own),
        slashes(path),
        aligned(&header, lines.into_iter(), &columns)
    ))
}
