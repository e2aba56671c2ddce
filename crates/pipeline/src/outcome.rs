//! What a run found, ready to be written: every frame of every trial, every body in it, and what went wrong.

use std::path::PathBuf;

use biplane_artifact::{AxesSource, Match, Side, SurfaceReport, Verdict};
use biplane_geometry::Pose;

use crate::calibrate::Calibrated;
use crate::joints::JointOutcome;
use crate::smoothing::SmoothOutcome;
use crate::tracking::Bridge;

/// Where a start pose came from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum StartKind {
    /// A row of `edits/poses.csv`.
    Edit,
    /// A row of the trial's table of starts.
    File,
    /// Between given ones, or the nearest given one at the ends.
    Interpolated,
    /// None was given: the body is looked for anywhere.
    Anywhere,
    /// Where other frames say it is, or without the edges of other bodies: what the frame gave by itself was tried again.
    Neighbours,
}

impl StartKind {
    /// The word in files and tables.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Edit => "edit",
            Self::File => "file",
            Self::Interpolated => "interpolated",
            Self::Anywhere => "anywhere",
            Self::Neighbours => "neighbours",
        }
    }
}

/// One body in one frame.
#[derive(Debug, Clone)]
pub struct BodyOutcome {
    /// Index of the body in the study.
    pub body: usize,
    /// Where its start came from.
    pub start: StartKind,
    /// The start itself, if there is one.
    pub start_pose: Option<Pose>,
    /// The match, or why there is none.
    pub result: Result<Match, String>,
    /// Where it is said to be all the same, where it is lost and frames beside it are to bridge that.
    pub bridged: Option<Bridge>,
    /// Its outline in each view, in the order of the trial's views; empty where there is no match.
    pub contours: Vec<ContourOutcome>,
}

/// The outline of a body in one picture.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ContourOutcome {
    /// Whether a person drew it.
    pub edited: bool,
    /// Why a person should look at it; none where one drew it.
    pub flags: Vec<String>,
}

impl BodyOutcome {
    /// The verdict; a match that could not be made has failed.
    pub fn verdict(&self) -> Verdict {
        self.result.as_ref().map_or(Verdict::Failed, |m| m.verdict)
    }

    /// The views (by their place in the trial) whose outline a person should look at, and why. A match that failed is looked at anyway.
    pub fn flagged(&self) -> impl Iterator<Item = (usize, &[String])> {
        let open = self.verdict() != Verdict::Failed;
        let views = self.contours.iter().enumerate().filter(move |(_, c)| open && !c.flags.is_empty());
        views.map(|(slot, c)| (slot, c.flags.as_slice()))
    }

    /// Why the verdict is not good, or what made it good beside the frame itself; mostly empty if it is.
    pub fn reason(&self) -> String {
        let bridged = self.bridged.as_ref().map(|b| {
            format!("the pose is no match: it bridges frames {} and {}; ", b.between[0], b.between[1])
        });
        let reason = match &self.result {
            Ok(found) => found.reason.clone(),
            Err(message) => format!("not matched: {message}"),
        };
        bridged.unwrap_or_default() + &reason
    }

    /// Root mean square over the views of the fit in mm and in px, if there is a match.
    pub fn fit(&self) -> Option<[f64; 2]> {
        let views = &self.result.as_ref().ok()?.views;
        let mean = |f: fn(&biplane_artifact::ViewFit) -> f64| {
            (views.iter().map(|v| f(v).powi(2)).sum::<f64>() / views.len() as f64).sqrt()
        };
        (!views.is_empty()).then(|| [mean(|v| v.rms_mm), mean(|v| v.rms_px)])
    }
}

/// One pair (or more) of pictures taken together.
#[derive(Debug, Clone)]
pub struct FrameOutcome {
    /// Index of the trial in the study.
    pub trial: usize,
    /// The frame's label.
    pub label: String,
    /// Seconds from the trial's first picture, if known.
    pub time_s: Option<f64>,
    /// In the order of the trial's bodies.
    pub bodies: Vec<BodyOutcome>,
    /// Index of the view, and its overlay relative to the folder of results, where there is one.
    pub overlays: Vec<(usize, PathBuf)>,
    /// Its part of the report relative to the folder of results, where there is one.
    pub script: Option<PathBuf>,
}

/// A bone in the slices of a volume.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SlicesOutcome {
    /// Index of the bone in the study.
    pub bone: usize,
    /// Slices of the volume; none where they could not be found.
    pub slices: usize,
    /// Those that the bone is in.
    pub with_bone: usize,
    /// Contours in all of them, holes too.
    pub contours: usize,
    /// Contours that are holes.
    pub holes: usize,
    /// Slices that a person drew.
    pub edited: Vec<usize>,
    /// Slices to look at, and why.
    pub flagged: Vec<(usize, String)>,
    /// Their table, relative to the folder of results.
    pub table: Option<PathBuf>,
    /// Their sheet, relative to the folder of results.
    pub sheet: Option<PathBuf>,
}

impl SlicesOutcome {
    /// The slices to look at, by reason; `None` where there is none.
    pub fn to_look_at(&self) -> Option<String> {
        let mut reasons: Vec<(&str, Vec<[usize; 2]>)> = Vec::new();
        for (slice, why) in &self.flagged {
            match reasons.iter_mut().find(|(reason, _)| reason == why).map(|(_, runs)| runs) {
                Some(runs) => match runs.last_mut() {
                    Some([_, last]) if *last + 1 == *slice => *last = *slice,
                    _ => runs.push([*slice; 2]),
                },
                None => reasons.push((why, vec![[*slice; 2]])),
            }
        }
        let run = |[first, last]: &[usize; 2]| match last - first {
            0 => first.to_string(),
            1 => format!("{first}, {last}"),
            _ => format!("{first} to {last}"),
        };
        let part = |(why, runs): &(&str, Vec<[usize; 2]>)| {
            format!("{} ({why})", runs.iter().map(run).collect::<Vec<_>>().join(", "))
        };
        let parts: Vec<String> = reasons.iter().map(part).collect();
        let plural = if self.flagged.len() == 1 { "slice" } else { "slices" };
        (!parts.is_empty()).then(|| format!("{} {plural}: {}", self.flagged.len(), parts.join("; ")))
    }
}

/// The model of a body.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModelOutcome {
    /// Index of the body in the study.
    pub body: usize,
    /// What its surface comes from, for people.
    pub from: String,
    /// Vertices of what is matched; none where it could not be made.
    pub points: usize,
    /// Triangles of what is matched.
    pub triangles: usize,
    /// Whether a step made it; otherwise it is a mesh file as it is.
    pub made: bool,
    /// How its surface was made from slices, if it was.
    pub surface: Option<SurfaceReport>,
    /// Who said where its axes lie, and its side, if it has axes.
    pub axes: Option<(AxesSource, Side)>,
    /// Its sheet, relative to the folder of results.
    pub sheet: Option<PathBuf>,
}

/// An item that could not be done.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure {
    /// `step/trial/frame/...`
    pub item: String,
    /// Why, for people.
    pub message: String,
}

/// How many items of one step were done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StepCount {
    /// Taken from the store.
    pub cached: usize,
    /// Run now.
    pub ran: usize,
    /// Failed, or not reached.
    pub failed: usize,
}

/// All that a run found.
#[derive(Debug, Default)]
pub struct Outcome {
    /// The fluoroscopes, and what their pictures say of them.
    pub calibration: Calibrated,
    /// In the order of trials and frames.
    pub frames: Vec<FrameOutcome>,
    /// In the order of the study.
    pub slices: Vec<SlicesOutcome>,
    /// In the order of the study.
    pub models: Vec<ModelOutcome>,
    /// In the order of the study.
    pub joints: Vec<JointOutcome>,
    /// In the order of trials and bodies; none where trials are not smoothed.
    pub smoothed: Vec<SmoothOutcome>,
    /// Worth a look, in order.
    pub warnings: Vec<String>,
    /// In order.
    pub failures: Vec<Failure>,
    /// Files of edits that were used, and those that nobody changed since they were written.
    pub edits: [usize; 2],
    /// Name of a step and its count, in the order of the steps.
    pub steps: Vec<(&'static str, StepCount)>,
}

impl Outcome {
    /// All bodies in all frames.
    pub fn rows(&self) -> impl Iterator<Item = (&FrameOutcome, &BodyOutcome)> {
        self.frames.iter().flat_map(|f| f.bodies.iter().map(move |b| (f, b)))
    }

    /// The outlines that a person should look at: frame, body, the view's place in the trial, and why.
    pub fn flagged(&self) -> impl Iterator<Item = (&FrameOutcome, &BodyOutcome, usize, &[String])> {
        self.rows().flat_map(|(frame, body)| body.flagged().map(move |(slot, why)| (frame, body, slot, why)))
    }

    /// How many verdicts are good, doubtful, ambiguous and failed.
    pub fn verdicts(&self) -> [usize; 4] {
        let mut counts = [0; 4];
        for (_, body) in self.rows() {
            counts[body.verdict() as usize] += 1;
        }
        counts
    }

    /// Whether anything failed: an item that could not be done, or a match that does not fit.
    pub fn any_failed(&self) -> bool {
        !self.failures.is_empty() || self.verdicts()[Verdict::Failed as usize] > 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbouring_slices_to_look_at_are_told_as_one() {
        let flagged = [(3, "jumped"), (5, "lost"), (6, "lost"), (7, "lost"), (9, "jumped"), (10, "jumped")];
        let flagged = flagged.map(|(slice, why)| (slice, why.to_owned())).to_vec();
        let outcome = SlicesOutcome { flagged, ..SlicesOutcome::default() };
        assert_eq!(outcome.to_look_at().unwrap(), "6 slices: 3, 9, 10 (jumped); 5 to 7 (lost)");
        assert_eq!(SlicesOutcome::default().to_look_at(), None);
    }
}
