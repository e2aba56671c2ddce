//! `results/exports/`: the poses and joints of a run in the formats of other programs, as `[export]` asks for them.
//!
//! A frame whose match failed is missing in all of them (each format has its word for that); what is doubtful or ambiguous is written, and listed in
//! `README.txt` beside the files, with each format's convention.

use std::path::Path;

use biplane_acquisition::poses::opensim::{self, Table};
use biplane_acquisition::poses::tra::{self, Dialect, Layout};
use biplane_acquisition::poses::{Poses, jointtrack, xmalab};
use biplane_artifact::{Calibration, Content, Picture, Verdict};
use biplane_geometry::Pose;
use biplane_stage::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::diagnostics::slashes;
use crate::joints::series::series;
use crate::outcome::Outcome;
use crate::results::{UNKNOWN, write_if_changed};
use crate::study::Study;

/// The folder of results that is theirs.
pub const EXPORTS: &str = "exports";

/// A format of another program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// `poses.json`: everything that is known of poses and joints, for programs.
    Json,
    /// Autoscoper: `TRIAL.tra`, the bodies of the trial side by side.
    Tra,
    /// XMALab: `TRIAL_BODY_xmalab.csv`, rigid bodies.
    Xmalab,
    /// JointTrack Manual: `TRIAL_BODY.jts`, in the frame of a camera.
    Jts,
    /// JointTrack Auto: `TRIAL_BODY.jtak`, in the frame of a camera.
    Jtak,
    /// OpenSim: `TRIAL_JOINT.mot`, the values of a joint over time.
    Mot,
    /// OpenSim: `TRIAL_BODY.sto`, place and quaternion of a body over time.
    Sto,
}

/// `[export]`: results for other programs, in `results/exports`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ExportSection {
    /// Which: any of `"json"`, `"tra"`, `"xmalab"`, `"jts"`, `"jtak"`, `"mot"`, `"sto"`.
    pub formats: Vec<Format>,
    /// How `.tra` files are written, which do not say it themselves.
    pub tra: TraSection,
    /// The view whose camera `.jts` and `.jtak` files are in; the first one if not given.
    pub view: Option<String>,
}

/// How a `.tra` is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TraSection {
    /// 4x4 matrices row by row or column by column, or x, y, z, yaw, pitch, roll.
    pub layout: TraLayout,
    /// Lengths in centimetres rather than millimetres.
    pub centimetres: bool,
    /// Numbers parted by spaces rather than commas.
    pub spaces: bool,
}

/// How one pose of a `.tra` is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema, clap::ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum TraLayout {
    /// A 4x4 matrix, row by row.
    #[default]
    MatrixRows,
    /// A 4x4 matrix, column by column.
    MatrixColumns,
    /// x, y, z, yaw, pitch, roll in degrees.
    Degrees,
    /// x, y, z, yaw, pitch, roll in radians.
    Radians,
}

impl TraSection {
    /// As the reader and writer know it.
    pub fn dialect(self) -> Dialect {
        let layout = match self.layout {
            TraLayout::MatrixRows => Layout::MatrixRows,
            TraLayout::MatrixColumns => Layout::MatrixColumns,
            TraLayout::Degrees => Layout::Degrees,
            TraLayout::Radians => Layout::Radians,
        };
        Dialect { layout, centimetres: self.centimetres, spaces: self.spaces }
    }
}

/// Why exports were not written.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// A file.
    #[error("cannot write {0}: {1}")]
    Write(String, std::io::Error),
    /// A picture as seen from behind its detector.
    #[error(
        "[export]: the pictures of view {0} are mirrored, which JointTrack's files do not know; name another view, or leave out \"jts\" and \"jtak\""
    )]
    Mirrored(String),
}

/// The poses of a body over the frames of a trial, without those that failed.
fn poses(outcome: &Outcome, trial: usize, body: usize) -> Poses {
    outcome
        .frames
        .iter()
        .filter(|f| f.trial == trial)
        .map(|f| {
            let body = f.bodies.iter().find(|b| b.body == body)?;
            let found = body.result.as_ref().ok()?;
            (found.verdict != Verdict::Failed).then(|| Pose::from(found.pose))
        })
        .collect()
}

/// Times of a trial's frames, s; the frames' numbers from 0 where nothing says the rate.
fn times(outcome: &Outcome, trial: usize) -> (Vec<f64>, bool) {
    let frames: Vec<_> = outcome.frames.iter().filter(|f| f.trial == trial).collect();
    let known = frames.iter().all(|f| f.time_s.is_some());
    let time =
        |(k, f): (usize, &&crate::outcome::FrameOutcome)| f.time_s.filter(|_| known).unwrap_or(k as f64);
    (frames.iter().enumerate().map(time).collect(), known)
}

/// Writes what the study asks for, and names the files with the hashes of their bytes.
///
/// # Errors
/// [`ExportError`].
pub fn write(
    study: &Study,
    outcome: &Outcome,
    calibrations: &[Hashed<Calibration>],
) -> Result<Vec<(String, String)>, ExportError> {
    let wanted = &study.export;
    let mut files: Vec<(String, String)> = Vec::new();
    let mut formats = wanted.formats.clone();
    formats.sort_unstable();
    formats.dedup();
    for format in &formats {
        match format {
            Format::Json => files.push(("poses.json".to_owned(), everything(study, outcome))),
            Format::Tra => {
                for (number, trial) in study.trials.iter().enumerate() {
                    let all: Vec<Poses> = trial.bodies.iter().map(|b| poses(outcome, number, *b)).collect();
                    files.push((format!("{}.tra", trial.name), tra::write(&all, wanted.tra.dialect())));
                }
            }
            Format::Xmalab => each_body(study, |trial, body, name| {
                files.push((format!("{name}_xmalab.csv"), xmalab::write(&poses(outcome, trial, body))));
                Ok(())
            })?,
            Format::Jts | Format::Jtak => {
                let number = wanted.view.as_ref().and_then(|v| study.views.iter().position(|o| o.name == *v));
                let view = number.unwrap_or(0);
                let camera = calibrations.get(view).and_then(|c| jointtrack::laboratory_from_camera(c));
                let camera = camera.ok_or_else(|| {
                    ExportError::Mirrored(study.views.get(view).map(|v| v.name.clone()).unwrap_or_default())
                })?;
                let (kind, ending) = match format {
                    Format::Jts => (jointtrack::Kind::Jts, "jts"),
                    _ => (jointtrack::Kind::Jtak, "jtak"),
                };
                each_body(study, |trial, body, name| {
                    let text = jointtrack::write(&poses(outcome, trial, body), &camera, kind);
                    files.push((format!("{name}.{ending}"), text));
                    Ok(())
                })?;
            }
            Format::Sto => each_body(study, |trial, body, name| {
                files.push((format!("{name}.sto"), body_over_time(outcome, trial, body, name)));
                Ok(())
            })?,
            Format::Mot => files.extend(joints_over_time(study, outcome)),
        }
    }
    if files.is_empty() {
        return Ok(Vec::new());
    }
    files.push(("README.txt".to_owned(), readme(study, outcome)));
    let mut made = Vec::new();
    for (name, text) in files {
        let place = Path::new(EXPORTS).join(name);
        let path = study.output.join(&place);
        write_if_changed(&path, text.as_bytes()).map_err(|e| ExportError::Write(slashes(&path), e))?;
        made.push((slashes(&place), Picture(text.into_bytes()).content_hash().to_hex()));
    }
    Ok(made)
}

fn each_body(
    study: &Study,
    mut with: impl FnMut(usize, usize, &str) -> Result<(), ExportError>,
) -> Result<(), ExportError> {
    for (number, trial) in study.trials.iter().enumerate() {
        for body in &trial.bodies {
            with(number, *body, &format!("{}_{}", trial.name, study.bodies[*body].name))?;
        }
    }
    Ok(())
}

/// What every table over time says of its frames and units.
fn note(timed: bool) -> String {
    let time =
        if timed { "time in seconds" } else { "time counts frames from 0: nothing says the frame rate" };
    format!("lengths in mm, {time}; failed frames are nan")
}

fn body_over_time(outcome: &Outcome, trial: usize, body: usize, name: &str) -> String {
    let (times, timed) = times(outcome, trial);
    let labels = ["tx_mm", "ty_mm", "tz_mm", "qw", "qx", "qy", "qz"].map(str::to_owned).to_vec();
    let row = |pose: &Option<Pose>| {
        let record = pose.map(biplane_artifact::PoseRecord::from);
        let values =
            record.map(|r| r.translation_mm.into_iter().chain(r.quaternion_wxyz).map(Some).collect());
        values.unwrap_or_else(|| vec![None; 7])
    };
    let rows = times.iter().zip(&poses(outcome, trial, body)).map(|(t, pose)| (*t, row(pose))).collect();
    let table = Table { name: name.to_owned(), in_degrees: false, labels, rows };
    let pose = "x_world = R(q) x_model + t, q a unit quaternion, scalar first".to_owned();
    opensim::write(&table, &[note(timed), pose])
}

fn joints_over_time(study: &Study, outcome: &Outcome) -> Vec<(String, String)> {
    let mut files = Vec::new();
    for of in &outcome.joints {
        let Some(joint) = study.joints.get(of.joint) else { continue };
        for series in series(outcome, of, joint) {
            let (times, timed) = times(outcome, series.trial);
            let first = outcome.frames.iter().position(|f| f.trial == series.trial).unwrap_or(0);
            let rows = series.frames.iter().filter_map(|frame| {
                let time = times.get(frame.frame.checked_sub(first)?)?;
                let values = frame.values.map_or(vec![None; 6], |v| v.iter().map(|v| Some(*v)).collect());
                Some((*time, values))
            });
            let name = format!("{}_{}", study.trials[series.trial].name, joint.name);
            let labels = joint.convention.names().to_vec();
            let table = Table { name: name.clone(), in_degrees: true, labels, rows: rows.collect() };
            let signs = "signs as in kinematics.README.txt".to_owned();
            files.push((format!("{name}.mot"), opensim::write(&table, &[note(timed), signs])));
        }
    }
    files
}

/// A number for JSON; none where nothing is known.
fn known(value: f64) -> Value {
    if value.is_finite() && value.abs() < UNKNOWN { json!(value) } else { Value::Null }
}

/// `poses.json`.
fn everything(study: &Study, outcome: &Outcome) -> String {
    let frames: Vec<Value> = outcome
        .frames
        .iter()
        .map(|frame| {
            let bodies: Vec<Value> = frame
                .bodies
                .iter()
                .map(|body| {
                    let found = body.result.as_ref().ok();
                    let matrix = found.map(|m| {
                        let matrix = Pose::from(m.pose).matrix();
                        (0..4).map(|i| (0..4).map(|j| matrix[(i, j)]).collect::<Vec<_>>()).collect::<Vec<_>>()
                    });
                    let rows = |c: &[[f64; 6]; 6]| -> Vec<Vec<Value>> {
                        c.iter().map(|row| row.iter().map(|v| known(*v)).collect()).collect()
                    };
                    json!({
                        "body": study.bodies[body.body].name,
                        "verdict": body.verdict().word(),
                        "reason": body.reason(),
                        "start": body.start.word(),
                        "world_from_model": matrix,
                        "translation_mm": found.map(|m| m.pose.translation_mm),
                        "quaternion_wxyz": found.map(|m| m.pose.quaternion_wxyz),
                        "covariance": found.map(|m| rows(&m.covariance)),
                        "calibration_covariance": found.and_then(|m| m.calibration_covariance.as_ref().map(rows)),
                        "interval_95": found.map(|m| m.interval_95.map(known)),
                        "rms_px": found.map(|m| m.views.iter().map(|v| v.rms_px).collect::<Vec<_>>()),
                        "bridged": body.bridged.as_ref().map(|b| json!({
                            "translation_mm": b.pose.translation_mm,
                            "quaternion_wxyz": b.pose.quaternion_wxyz,
                            "between": b.between,
                        })),
                    })
                })
                .collect();
            json!({
                "trial": study.trials[frame.trial].name,
                "frame": frame.label,
                "time_s": frame.time_s,
                "bodies": bodies,
            })
        })
        .collect();
    let joints: Vec<Value> = outcome
        .joints
        .iter()
        .filter_map(|of| Some((study.joints.get(of.joint)?, of)))
        .map(|(joint, of)| {
            let series: Vec<Value> = series(outcome, of, joint)
                .iter()
                .flat_map(|s| s.frames.iter().map(move |f| (s.trial, f)))
                .map(|(trial, f)| {
                    json!({
                        "trial": study.trials[trial].name,
                        "frame": outcome.frames[f.frame].label,
                        "time_s": outcome.frames[f.frame].time_s,
                        "verdict": f.joint.verdict.word(),
                        "values": f.values,
                        "half_width_95": f.half_widths,
                        "distance_mm": f.joint.pose.as_ref().and_then(|p| p.distance_mm),
                        "penetration_mm": f.joint.pose.as_ref().and_then(|p| p.penetration_mm),
                    })
                })
                .collect();
            json!({
                "joint": joint.name,
                "proximal": study.bodies[joint.proximal].name,
                "distal": study.bodies[joint.distal].name,
                "side": joint.side,
                "convention": joint.convention,
                "names": joint.convention.names(),
                "units": ["deg", "deg", "deg", "mm", "mm", "mm"],
                "frames": series,
            })
        })
        .collect();
    let all = json!({
        "format": "biplane poses",
        "version": 1,
        "conventions": {
            "pose": "x_world = R x_model + t; mm; unit quaternion, scalar first",
            "covariance": "translation x, y, z (mm) of the mesh's area centroid, then rotation vector x, y, z (rad), both along the axes of the world",
            "interval_95": "half-widths, in the order of the covariance (mm, rad)",
            "missing": "null",
        },
        "study": study.name,
        "frames": frames,
        "joints": joints,
    });
    // A value of numbers and texts always has a JSON form.
    serde_json::to_string_pretty(&all).unwrap_or_default() + "\n"
}

fn readme(study: &Study, outcome: &Outcome) -> String {
    let mut text = String::from(include_str!("exports_readme.txt"));
    let dialect = study.export.tra;
    text += &format!(
        "\nThe .tra files here: {}, {}, parted by {}; bodies in this order:\n",
        match dialect.layout {
            TraLayout::MatrixRows => "4x4 matrices row by row",
            TraLayout::MatrixColumns => "4x4 matrices column by column",
            TraLayout::Degrees => "x, y, z, yaw, pitch, roll in degrees",
            TraLayout::Radians => "x, y, z, yaw, pitch, roll in radians",
        },
        if dialect.centimetres { "cm" } else { "mm" },
        if dialect.spaces { "spaces" } else { "commas" }
    );
    for trial in &study.trials {
        let bodies: Vec<&str> = trial.bodies.iter().map(|b| study.bodies[*b].name.as_str()).collect();
        text += &format!("  {}.tra: {}\n", trial.name, bodies.join(", "));
    }
    text += "\nThe frames of each trial, from the first:\n";
    for (number, trial) in study.trials.iter().enumerate() {
        let labels: Vec<&str> =
            outcome.frames.iter().filter(|f| f.trial == number).map(|f| f.label.as_str()).collect();
        let ends = labels.first().zip(labels.last()).map_or(String::new(), |(a, b)| format!(", {a} to {b}"));
        text += &format!("  {}: {} frames{ends}\n", trial.name, labels.len());
    }
    let open = |verdict: Verdict| matches!(verdict, Verdict::Doubtful | Verdict::Ambiguous);
    let listed: Vec<String> = outcome
        .rows()
        .filter(|(_, body)| open(body.verdict()))
        .map(|(frame, body)| {
            let trial = &study.trials[frame.trial].name;
            let name = &study.bodies[body.body].name;
            format!("  {trial} {} {name}: {}: {}\n", frame.label, body.verdict().word(), body.reason())
        })
        .collect();
    if !listed.is_empty() {
        text += "\nWritten, though not good; look at them before they are used:\n";
        text += &listed.concat();
    }
    text
}
