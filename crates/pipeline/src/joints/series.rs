//! A joint over the frames of one trial: what hangs on more than one of them.

use biplane_kinematics::{Crossing, HelicalAxis, by_angle, helical_axis, unwrap};

use super::{HelicalFrom, JointFrame, JointOutcome, StudyJoint};
use crate::outcome::Outcome;

/// Standard deviations to either side that hold 95 % of a normal number.
const NINETY_FIVE: f64 = 1.959_964;

/// One frame of a trial.
#[derive(Debug, Clone)]
pub struct SeriesFrame<'a> {
    /// Its number in the outcome.
    pub frame: usize,
    /// What was found of the joint.
    pub joint: &'a JointFrame,
    /// Angles, degrees, without jumps of a whole turn, and translations, mm.
    pub values: Option<[f64; 6]>,
    /// Half-widths of their 95 % intervals.
    pub half_widths: Option<[f64; 6]>,
    /// The helical axis of the motion to this frame.
    pub helical: Option<HelicalAxis>,
}

/// A joint over a trial.
#[derive(Debug, Clone)]
pub struct Series<'a> {
    /// Index of the trial.
    pub trial: usize,
    /// In order.
    pub frames: Vec<SeriesFrame<'a>>,
}

/// A joint's frames, trial by trial.
pub fn series<'a>(outcome: &Outcome, of: &'a JointOutcome, joint: &StudyJoint) -> Vec<Series<'a>> {
    let mut all: Vec<Series<'a>> = Vec::new();
    for (frame, found) in &of.frames {
        let Some(trial) = outcome.frames.get(*frame).map(|f| f.trial) else { continue };
        if all.last().is_none_or(|series| series.trial != trial) {
            all.push(Series { trial, frames: Vec::new() });
        }
        let values = found.pose.as_ref().map(|p| {
            let [a, b, c] = p.angles_rad;
            let [x, y, z] = p.translations_mm;
            [a, b, c, x, y, z]
        });
        let half_widths = found.pose.as_ref().and_then(|p| p.covariance).map(|c| {
            let half = |k: usize| NINETY_FIVE * c[k][k].max(0.0).sqrt();
            std::array::from_fn(|k| if k < 3 { half(k).to_degrees() } else { half(k) })
        });
        if let Some(series) = all.last_mut() {
            series.frames.push(SeriesFrame {
                frame: *frame,
                joint: found,
                values,
                half_widths,
                helical: None,
            });
        }
    }
    for series in &mut all {
        complete(series, joint);
    }
    all
}

fn complete(series: &mut Series<'_>, joint: &StudyJoint) {
    for k in 0..3 {
        let mut angle: Vec<Option<f64>> = series.frames.iter().map(|f| f.values.map(|v| v[k])).collect();
        unwrap(&mut angle);
        for (frame, angle) in series.frames.iter_mut().zip(angle) {
            if let (Some(values), Some(angle)) = (&mut frame.values, angle) {
                values[k] = angle.to_degrees() + 0.0;
            }
        }
    }
    let mut from = None;
    for frame in &mut series.frames {
        let Some(pose) = &frame.joint.pose else { continue };
        let now = pose.proximal_from_distal;
        frame.helical = from.and_then(|from| helical_axis(&from, &now, joint.helical_least_deg.to_radians()));
        if from.is_none() || joint.helical_from == HelicalFrom::Previous {
            from = Some(now);
        }
    }
}

impl Series<'_> {
    /// Where the first angle passes multiples of `step` degrees; single frames without a value are passed over.
    pub fn crossings(&self, step: f64) -> Vec<Crossing> {
        let angle: Vec<Option<f64>> = self.frames.iter().map(|f| f.values.map(|v| v[0])).collect();
        by_angle(&angle, step, 1)
    }
}
