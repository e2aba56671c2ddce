//! What the page draws: every pose of every frame as numbers, in one object of JSON. Pictures are not in it: a frame has its own file.
//!
//! Numbers have as many digits as anyone can see in a plot or needs to start a search from: 0.1 um, 1e-6 of a quaternion.

use std::collections::BTreeMap;

use biplane_artifact::{Match, PoseRecord};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Point2, Pose};
use serde::Serialize;

use super::{Contents, Joint, SearchPath, colour, look, url};
use crate::diagnostics::slashes;
use crate::outcome::{BodyOutcome, FrameOutcome, Outcome, StartKind};
use crate::results::UNKNOWN;
use crate::study::Study;

/// Cells of the map from ideal to recorded pixels along each side.
const CELLS: usize = 32;
/// How far beyond the picture that map reaches, px.
const MARGIN_PX: f64 = 64.0;

/// All that the page draws.
#[derive(Serialize)]
pub(super) struct Data<'a> {
    name: &'a str,
    version: &'static str,
    contrast_bright: bool,
    views: Vec<View<'a>>,
    bodies: Vec<Body<'a>>,
    trials: Vec<Trial<'a>>,
    searches: &'a [SearchPath],
}

/// A fluoroscope: `w (x, y, 1) = matrix (X - source)`.
#[derive(Serialize)]
struct View<'a> {
    name: &'a str,
    size: [usize; 2],
    source: [f64; 3],
    matrix: [[f64; 3]; 3],
    /// Where the detector's plane is known.
    detector_mm: Option<f64>,
    /// From ideal to recorded pixels, where they differ.
    recorded: Option<Recorded>,
}

/// A grid over ideal pixels, row by row; null where the map cannot be undone.
#[derive(Serialize)]
struct Recorded {
    first: [f64; 2],
    step: [f64; 2],
    count: usize,
    px: Vec<Option<[f64; 2]>>,
}

#[derive(Serialize)]
struct Body<'a> {
    name: &'a str,
    /// Area centroid, mm, model frame.
    centroid: Option<[f64; 3]>,
}

#[derive(Serialize)]
struct Trial<'a> {
    name: &'a str,
    views: Vec<usize>,
    bodies: Vec<usize>,
    colours: Vec<String>,
    frames: Vec<&'a str>,
    /// Seconds from the first picture; empty where not known.
    times: Vec<f64>,
    /// Address of each frame's file; null where there is none.
    scripts: Vec<Option<String>>,
    rows: Vec<Row>,
    joints: Vec<&'a Joint>,
}

/// One body over a trial, a value a frame.
#[derive(Serialize, Default)]
struct Row {
    /// A letter a frame: g, d, a, f.
    verdicts: String,
    /// Translation (mm) and quaternion (scalar first).
    poses: Vec<Option<[f64; 7]>>,
    /// Half-widths of the 95 % intervals: of the centroid (mm), of the rotation (degrees), along laboratory axes.
    half_95: Vec<Option<[f64; 6]>>,
    /// The smoothed poses, beside the raw ones, where there are such.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    smoothed: Vec<Option<[f64; 7]>>,
    fit_mm: Vec<Option<f64>>,
    rms_px: Vec<Option<Vec<f64>>>,
    share: Vec<Option<Vec<f64>>>,
    start: String,
    /// By the number of the frame, where there is something to say.
    reasons: BTreeMap<usize, String>,
    look: BTreeMap<usize, String>,
    edited: Vec<usize>,
    alternatives: BTreeMap<usize, [f64; 7]>,
    /// What a person gave in `edits/poses.csv`.
    edits: BTreeMap<usize, [f64; 7]>,
}

pub(super) fn data<'a>(
    study: &'a Study,
    outcome: &'a Outcome,
    contents: &Contents<'a>,
    joints: &'a [Joint],
) -> Data<'a> {
    let centroids = &contents.bodies.centroids;
    Data {
        name: &study.name,
        version: env!("CARGO_PKG_VERSION"),
        contrast_bright: study.matching.contrast == biplane_optimisation::Contrast::Bright,
        views: (0..study.views.len()).filter_map(|view| of_view(study, outcome, view)).collect(),
        bodies: (0..study.bodies.len())
            .map(|body| Body {
                name: &study.bodies[body].name,
                centroid: centroids.get(body).map(|c| [c.x, c.y, c.z].map(|v| rounded(v, 1e5))),
            })
            .collect(),
        trials: (0..study.trials.len()).map(|trial| of_trial(study, outcome, joints, trial)).collect(),
        searches: contents.searches,
    }
}

fn rounded(value: f64, parts: f64) -> f64 {
    (value * parts).round() / parts
}

/// With four digits.
fn short(value: f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return 0.0;
    }
    let parts = 10_f64.powi(3 - value.abs().log10().floor() as i32);
    if parts.is_finite() && parts > 0.0 { rounded(value, parts) } else { value }
}

fn numbers(pose: PoseRecord) -> [f64; 7] {
    let PoseRecord { translation_mm: [x, y, z], quaternion_wxyz: [w, i, j, k] } = pose;
    let mut all = [x, y, z].map(|v| rounded(v, 1e4)).to_vec();
    all.extend([w, i, j, k].map(|v| rounded(v, 1e7)));
    std::array::from_fn(|n| all[n])
}

fn of_view<'a>(study: &'a Study, outcome: &Outcome, view: usize) -> Option<View<'a>> {
    let calibration = outcome.calibration.calibrations.get(view)?;
    let name = &study.views[view].name;
    let environment = outcome.calibration.environment.as_ref();
    let found = environment.and_then(|e| e.views.iter().find(|v| v.view == *name));
    Some(View {
        name,
        size: calibration.size,
        source: calibration.source,
        matrix: calibration.matrix,
        detector_mm: found.map(|v| v.source_to_detector_mm),
        recorded: recorded(&Fluoroscope::from(&**calibration)),
    })
}

fn recorded(view: &Fluoroscope) -> Option<Recorded> {
    let distortion = view.distortion()?;
    let size = view.size().map(|n| n as f64);
    let step = size.map(|n| (n + 2.0 * MARGIN_PX) / CELLS as f64);
    let at = |k: usize| {
        let [column, row] = [k % (CELLS + 1), k / (CELLS + 1)].map(|n| n as f64);
        let ideal = Point2::new(column * step[0] - MARGIN_PX, row * step[1] - MARGIN_PX);
        distortion.recorded(&ideal).map(|p| [rounded(p.x, 1e3), rounded(p.y, 1e3)])
    };
    let px = (0..(CELLS + 1).pow(2)).map(at).collect();
    Some(Recorded { first: [-MARGIN_PX; 2], step, count: CELLS + 1, px })
}

fn of_trial<'a>(study: &'a Study, outcome: &'a Outcome, joints: &'a [Joint], trial: usize) -> Trial<'a> {
    let recording = &study.trials[trial];
    let frames: Vec<&FrameOutcome> = outcome.frames.iter().filter(|f| f.trial == trial).collect();
    let views: Vec<usize> = recording.frames.iter().map(|(view, _)| *view).collect();
    let names: Vec<String> = views.iter().map(|v| study.views[*v].name.clone()).collect();
    let timed = frames.iter().all(|f| f.time_s.is_some());
    let row = |place: usize| {
        let mut row = Row::default();
        for (number, frame) in frames.iter().enumerate() {
            add(&mut row, number, frame.bodies.get(place), &names);
        }
        let body = recording.bodies.get(place);
        if let Some(of) = outcome.smoothed.iter().find(|s| s.trial == trial && Some(&s.body) == body) {
            row.smoothed = of.smoothed.frames.iter().map(|f| f.map(|f| numbers(f.pose))).collect();
        }
        row
    };
    Trial {
        name: &recording.name,
        views,
        bodies: recording.bodies.clone(),
        colours: (0..recording.bodies.len()).map(colour).collect(),
        frames: frames.iter().map(|f| f.label.as_str()).collect(),
        times: if timed {
            frames.iter().filter_map(|f| f.time_s).map(|t| rounded(t, 1e6)).collect()
        } else {
            vec![]
        },
        scripts: frames.iter().map(|f| f.script.as_deref().map(|path| url(&slashes(path)))).collect(),
        rows: (0..recording.bodies.len()).map(row).collect(),
        joints: joints.iter().filter(|joint| joint.trial == trial).collect(),
    }
}

fn add(row: &mut Row, number: usize, body: Option<&BodyOutcome>, views: &[String]) {
    let found = body.and_then(|b| b.result.as_ref().ok());
    row.verdicts.push(body.map_or('f', |b| b.verdict().word().chars().next().unwrap_or('f')));
    let bridged = body.and_then(|b| b.bridged.as_ref()).map(|b| b.pose);
    let start = body.and_then(|b| b.start_pose).map(|pose: Pose| PoseRecord::from(pose));
    row.poses.push(bridged.or(found.map(|m| m.pose)).or(start).map(numbers));
    let known = |m: &&Match| m.interval_95.iter().all(|w| *w < UNKNOWN);
    let half = |m: &Match| {
        std::array::from_fn(|i| short(m.interval_95[i] * if i < 3 { 1.0 } else { 1.0_f64.to_degrees() }))
    };
    row.half_95.push(found.filter(known).map(half));
    row.fit_mm.push(body.and_then(BodyOutcome::fit).map(|[mm, _]| short(mm)));
    row.rms_px.push(found.map(|m| m.views.iter().map(|v| short(v.rms_px)).collect()));
    row.share.push(found.map(|m| m.views.iter().map(|v| rounded(v.matched_share, 1e3)).collect()));
    row.start.push(body.map_or('-', |b| b.start.word().chars().next().unwrap_or('-')));
    let Some(body) = body else { return };
    let (reason, wanted) = (body.reason(), look(body, views));
    if !reason.is_empty() {
        row.reasons.insert(number, reason);
    }
    if !wanted.is_empty() {
        row.look.insert(number, wanted);
    }
    let given = body.start_pose.filter(|_| body.start == StartKind::Edit);
    row.edits.extend(given.map(|pose| (number, numbers(pose.into()))));
    if body.start == StartKind::Edit || body.contours.iter().any(|c| c.edited) {
        row.edited.push(number);
    }
    row.alternatives.extend(found.and_then(|m| m.alternative).map(|a| (number, numbers(a.pose))));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_four_digits() {
        assert_eq!(
            [123456.0, 0.000123456, -9.99961, 0.0, f64::INFINITY].map(short),
            [123500.0, 0.0001235, -10.0, 0.0, 0.0]
        );
    }
}
