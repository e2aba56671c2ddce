//! The step `joint`, run or looked at, and what is written of it.

use std::path::Path;

use biplane_artifact::{BodyAxes, Content, JointPose, Match, Picture, Verdict};
use biplane_kinematics::Joint;
use biplane_stage::{Hashed, How, KeyParts, ParamsText, Promise};
use rayon::prelude::*;

use super::plot::plot;
use super::series::series;
use super::table::{README, by_angle_csv, kinematics_csv};
use super::{JointFrame, JointOutcome, KINEMATICS, StudyJoint, of_job};
use crate::diagnostics::slashes;
use crate::look::{Fate, Look};
use crate::outcome::{Failure, Outcome};
use crate::prepare::Job;
use crate::results::write_if_changed;
use crate::steps::{ItemError, JOINT, Steps, read_stored};
use crate::study::Study;

/// Axes of the study's bodies, where they have such.
pub type Axes = [Option<Hashed<BodyAxes>>];

/// What the joints of a study gave.
#[derive(Debug, Default)]
pub struct JointsRun {
    /// In the order of the study.
    pub outcomes: Vec<JointOutcome>,
    /// Step, item, and how it was done.
    pub done: Vec<(&'static str, String, How)>,
    /// Items that could not be done.
    pub failures: Vec<Failure>,
    /// Worth a look.
    pub warnings: Vec<String>,
}

/// The worse verdict of two bodies; a body without a match has failed.
fn worse(matches: [Option<&Hashed<Match>>; 2]) -> Verdict {
    let verdict = |m: Option<&Hashed<Match>>| m.map_or(Verdict::Failed, |m| m.verdict);
    verdict(matches[0]).max(verdict(matches[1]))
}

/// Runs all joints of all frames; `None` if the run was stopped. `matches` are the final ones of the bodies of each job.
pub fn run(steps: &Steps<'_>, axes: &Axes, matches: &[Vec<Option<Hashed<Match>>>]) -> Option<JointsRun> {
    let prepared = steps.prepared;
    let outcome = |joint| JointOutcome { joint, ..JointOutcome::default() };
    let outcomes = (0..prepared.study.joints.len()).map(outcome).collect();
    let mut all = JointsRun { outcomes, ..JointsRun::default() };
    let jobs: Vec<_> = prepared
        .jobs
        .par_iter()
        .zip(matches)
        .map(|(job, matches)| {
            let joints = of_job(prepared, job).map(|(number, joint, places)| {
                let [a, b] = places.map(|p| matches.get(p).and_then(Option::as_ref));
                let verdict = worse([a, b]);
                let found = match (a, b) {
                    (Some(a), Some(b)) if verdict != Verdict::Failed => {
                        Some(steps.joint(job, joint, axes, &[a.clone(), b.clone()]))
                    }
                    _ => None,
                };
                (number, verdict, found)
            });
            joints.collect::<Vec<_>>()
        })
        .collect();
    for (frame, (job, joints)) in prepared.jobs.iter().zip(jobs).enumerate() {
        for (number, verdict, found) in joints {
            let joint = &prepared.study.joints[number];
            let item = format!("{JOINT}/{}", steps.item(job, &joint.name));
            let pose = match found {
                None => None,
                Some(Ok((pose, how))) => {
                    all.done.push((JOINT, item, how));
                    Some(JointPose::clone(&pose))
                }
                Some(Err(ItemError::Cancelled)) => return None,
                Some(Err(ItemError::Failed(message))) => {
                    all.failures.push(Failure { item, message: prepared.study.shorten(&message) });
                    None
                }
            };
            all.outcomes[number].frames.push((frame, JointFrame { verdict, pose }));
        }
    }
    for outcome in &all.outcomes {
        let joint = &prepared.study.joints[outcome.joint];
        all.warnings.extend(penetration(steps, joint, outcome));
    }
    Some(all)
}

/// What a person should know of surfaces that are in each other.
fn penetration(steps: &Steps<'_>, joint: &StudyJoint, outcome: &JointOutcome) -> Option<String> {
    let prepared = steps.prepared;
    let depth = |frame: &JointFrame| frame.pose.as_ref()?.penetration_mm;
    let deep: Vec<(usize, f64)> = outcome
        .frames
        .iter()
        .filter_map(|(frame, found)| Some((*frame, depth(found)?)))
        .filter(|(_, depth)| *depth > joint.most_penetration_mm)
        .collect();
    let (worst, depth) = deep.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let job = &prepared.jobs[worst];
    let bodies = [joint.proximal, joint.distal].map(|b| prepared.study.bodies[b].name.as_str());
    Some(format!(
        "joint {}: {} and {} are in each other by more than {} mm in {} of {} frames, by {depth:.2} mm in frame {} of trial {}: a model, a pose or the \
         calibration is off by as much",
        joint.name,
        bodies[0],
        bodies[1],
        joint.most_penetration_mm,
        deep.len(),
        outcome.frames.len(),
        job.label,
        prepared.study.trials[job.trial].name
    ))
}

impl Steps<'_> {
    /// Brings two bodies of a frame to the values of their joint.
    ///
    /// # Errors
    /// The stage failed, or the store did.
    pub fn joint(
        &self,
        job: &Job,
        joint: &StudyJoint,
        axes: &Axes,
        matches: &[Hashed<Match>; 2],
    ) -> Result<(Hashed<JointPose>, How), ItemError> {
        let params = ParamsText::of(&joint.params()).map_err(ItemError::of)?;
        let promised = self.joint_promised(joint, axes, [matches[0].promise(), matches[1].promise()])?;
        let load = || self.joint_inputs(joint, axes, matches);
        let item = self.item(job, &joint.name);
        let done = self
            .store
            .execute::<Joint, _>(JOINT, &item, &params, &promised, load, self.context)
            .map_err(|error| match error {
                biplane_stage::ExecuteError::Cancelled => ItemError::Cancelled,
                other => ItemError::of(other),
            })?;
        Ok((read_stored(self.store, &done.output).map_err(ItemError::Failed)?, done.how))
    }

    /// What would become of a joint in a frame.
    pub fn look_at_joint(
        &self,
        job: &Job,
        joint: &StudyJoint,
        axes: &Axes,
        matches: Option<[Promise<Match>; 2]>,
    ) -> Look {
        let item = self.item(job, &joint.name);
        let Some(matches) = matches else { return Look::after(JOINT, &item, self.ever_made(JOINT, &item)) };
        let parts = || {
            let params = ParamsText::of(&joint.params()).map_err(ItemError::of)?;
            let promised = self.joint_promised(joint, axes, matches)?;
            let parts = KeyParts::of::<Joint>(&params, &promised);
            self.store.explain::<Joint>(JOINT, &item, &parts).map_err(ItemError::of)
        };
        match parts() {
            Ok(why) => {
                let fate = if why.cached() { Fate::Cached } else { Fate::Runs };
                Look { step: JOINT, fate, line: why.to_string() }
            }
            Err(error) => {
                let line = format!("{JOINT}/{item}: {}", self.prepared.study.shorten(&error.to_string()));
                Look { step: JOINT, fate: Fate::Fails, line }
            }
        }
    }
}

/// Why a table of joints was not written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// A file.
    #[error("cannot write {0}: {1}")]
    File(String, std::io::Error),
    /// A table.
    #[error("cannot make a table of joints: {0}")]
    Table(#[from] csv::Error),
    /// A plot.
    #[error("cannot draw a joint: {0}")]
    Plot(String),
}

/// Writes the tables and plots of joints, and names the plots with the hashes of their bytes.
///
/// # Errors
/// [`WriteError`].
pub fn write(study: &Study, outcome: &mut Outcome) -> Result<Vec<(String, String)>, WriteError> {
    if study.joints.is_empty() {
        return Ok(Vec::new());
    }
    let put = |place: &Path, bytes: &[u8]| {
        let path = study.output.join(place);
        write_if_changed(&path, bytes).map_err(|e| WriteError::File(slashes(&path), e))
    };
    put(Path::new("kinematics.csv"), &kinematics_csv(study, outcome)?)?;
    put(Path::new("kinematics.README.txt"), README.as_bytes())?;
    if let Some(bytes) = by_angle_csv(study, outcome)? {
        put(Path::new("kinematics_by_angle.csv"), &bytes)?;
    }
    let mut made = Vec::new();
    for number in 0..outcome.joints.len() {
        let of = &outcome.joints[number];
        let joint = &study.joints[of.joint];
        let mut plots = Vec::new();
        for series in series(outcome, of, joint) {
            let trial = &study.trials[series.trial].name;
            let svg = plot(study, outcome, joint, &series).map_err(WriteError::Plot)?;
            let place = Path::new(KINEMATICS).join(format!("{}_{trial}.svg", joint.name));
            put(&place, svg.as_bytes())?;
            made.push((slashes(&place), Picture(svg.into_bytes()).content_hash().to_hex()));
            plots.push(place);
        }
        outcome.joints[number].plots = plots;
    }
    Ok(made)
}
