//! Joints of a study: from the final poses of two bodies in each frame to `kinematics.csv`, its table by angle, and plots.
//!
//! `joint/<trial>/<frame>/<joint>` gives a joint's values in one frame. What hangs on several frames (unwrapped angles, helical axes, values at
//! even steps of an angle) is put together when the tables are written, so a frame that changes reruns one item.

pub mod plot;
pub mod run;
pub mod section;
pub mod series;
pub mod table;

use biplane_artifact::{JointPose, Match, Side, Verdict};
use biplane_kinematics::{Convention, JointInputs, JointParams};
use biplane_stage::{Hashed, Promise, Promised};
use serde::Serialize;

use crate::joints::run::Axes;
use crate::prepare::{Job, Prepared};
use crate::steps::{ItemError, Steps};

/// The folder of results with the plots.
pub const KINEMATICS: &str = "kinematics";

/// What helical axes are measured from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub enum HelicalFrom {
    /// The first frame of the trial with a pose.
    #[default]
    First,
    /// The frame before.
    Previous,
}

/// A joint of the study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StudyJoint {
    /// Its name.
    pub name: String,
    /// Index of the proximal body.
    pub proximal: usize,
    /// Index of the distal body.
    pub distal: usize,
    /// Of which side of the subject it is.
    pub side: Side,
    /// How it is described.
    pub convention: Convention,
    /// Whether the distance of the surfaces is found.
    pub distance: bool,
    /// Surfaces that are deeper in each other are warned of, mm.
    pub most_penetration_mm: f64,
    /// What helical axes are measured from.
    pub helical_from: HelicalFrom,
    /// Smaller turns have no helical axis, degrees.
    pub helical_least_deg: f64,
    /// Steps of the first angle at which values are written, degrees.
    pub resample_deg: Option<f64>,
}

impl StudyJoint {
    /// Parameters of its step.
    pub fn params(&self) -> JointParams {
        JointParams { convention: self.convention, side: self.side, distance: self.distance }
    }
}

/// A joint in the frames of all trials.
#[derive(Debug, Clone, Default)]
pub struct JointOutcome {
    /// Index of the joint in the study.
    pub joint: usize,
    /// By the number of the frame in the outcome; a frame of a trial without both bodies is not in it.
    pub frames: Vec<(usize, JointFrame)>,
    /// Its plots, relative to the folder of results.
    pub plots: Vec<std::path::PathBuf>,
}

/// A joint in one frame.
#[derive(Debug, Clone)]
pub struct JointFrame {
    /// The worse verdict of the two bodies.
    pub verdict: Verdict,
    /// Its values; none where a body has no pose to rely on.
    pub pose: Option<JointPose>,
}

impl Steps<'_> {
    fn joint_promised(
        &self,
        joint: &StudyJoint,
        axes: &Axes,
        matches: [Promise<Match>; 2],
    ) -> Result<JointInputs<Promised>, ItemError> {
        let axes = |body: usize| axes.get(body).and_then(Option::as_ref).map(Hashed::promise);
        let [proximal, distal] = matches;
        Ok(JointInputs {
            proximal,
            distal,
            proximal_model: self.model(joint.proximal)?.promise(),
            distal_model: self.model(joint.distal)?.promise(),
            proximal_axes: axes(joint.proximal).into_iter().collect(),
            distal_axes: axes(joint.distal).into_iter().collect(),
        })
    }

    fn joint_inputs(
        &self,
        joint: &StudyJoint,
        axes: &Axes,
        matches: &[Hashed<Match>; 2],
    ) -> Result<JointInputs, String> {
        let axes = |body: usize| axes.get(body).and_then(Clone::clone);
        let model = |body: usize| self.model(body).map_err(|e| e.to_string())?.load();
        let [proximal, distal] = matches.clone();
        Ok(JointInputs {
            proximal,
            distal,
            proximal_model: model(joint.proximal)?,
            distal_model: model(joint.distal)?,
            proximal_axes: axes(joint.proximal).into_iter().collect(),
            distal_axes: axes(joint.distal).into_iter().collect(),
        })
    }
}

/// Places of a joint's bodies in a job, if it has both.
pub(crate) fn places(job: &Job, joint: &StudyJoint) -> Option<[usize; 2]> {
    let place = |body: usize| job.bodies.iter().position(|(b, ..)| *b == body);
    Some([place(joint.proximal)?, place(joint.distal)?])
}

/// The joints of a study that a job's bodies make up.
pub(crate) fn of_job<'a>(
    prepared: &'a Prepared,
    job: &'a Job,
) -> impl Iterator<Item = (usize, &'a StudyJoint, [usize; 2])> {
    let joints = prepared.study.joints.iter().enumerate();
    joints.filter_map(|(number, joint)| Some((number, joint, places(job, joint)?)))
}
