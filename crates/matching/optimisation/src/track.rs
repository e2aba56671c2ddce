//! The stage `track`: a body in one frame once more, with what the frames beside it and the other bodies in it say.
//!
//! A frame is matched by itself first (the stage `match`). What does not come out good, or does not go with the frames beside it, comes
//! here: the search starts from where those say the body is, and edges that lie on the outlines of bodies that are known are left out
//! ([`crate::claimed`]).
//!
//! **Verdict.** A pose that fits by itself and lies where the frames beside it say is good, also where another one far off fits alike: a
//! body of little relief has its mirror image in a frame, but does not jump into it and back from one frame to the next. One that fits but jumps is
//! doubtful, and so is one that lies where it should while another fits clearly better. Where nothing fits, the reason says what is seen of
//! the body at the place where it should be: out of the picture, or hidden.
//!
//! **Guaranteed:** a pose that does not fit by itself is never called good. **Not guaranteed:** that frames which agree are right.

use std::sync::Arc;

use biplane_artifact::{
    Alternative, Calibration, CalibrationUncertainty, Curves, Match, ModelMesh, Prediction, Verdict,
};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Point3, Pose};
use biplane_outline::{RimMesh, RimWithoutCutEnds};
use biplane_stage::{Context, Hashed, Stage, inputs};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::answer::CLEARLY;
use crate::claimed::without_claimed;
use crate::stage::{MatchError, MatchParams, match_anywhere, views_of};
use crate::{View, assess};

inputs! {
    /// One body in one frame, with what is known beside it.
    pub struct TrackInputs {
        /// One a view.
        curves: [Curves],
        /// One a view, in the same order.
        calibrations: [Calibration],
        /// The body.
        model: ModelMesh,
        /// What the frame says by itself.
        own: Match,
        /// Where the frames beside it say the body is; none where this frame is settled but for its edges.
        predicted: [Prediction],
        /// The other bodies whose pose in this frame is known,
        others: [ModelMesh],
        /// and their poses.
        other_matches: [Match],
        /// How sure the calibrations are, all together; empty where nothing is known of it.
        calibration_uncertainty: [CalibrationUncertainty],
    }
}

/// How the frames of a trial help each other.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TrackParams {
    /// Whether frames that are not good by themselves, or jump, are tried again from the frames beside them. Only with
    /// `[match] method = "rim"`.
    pub enabled: bool,
    /// Over how many frames a pose is predicted from the nearest one that is good.
    #[schemars(range(min = 1, max = 1000))]
    pub reach_frames: usize,
    /// A frame jumps if it is farther from where the frames beside it say than this many times what the trial's own motion makes usual.
    #[schemars(range(min = 1.0, max = 100.0))]
    pub jump_factor: f64,
    /// But not if it is nearer than this, mm,
    #[schemars(range(min = 0.01, max = 100.0))]
    pub jump_mm: f64,
    /// and turned by less than this, degrees.
    #[schemars(range(min = 0.01, max = 180.0))]
    pub jump_deg: f64,
    /// Edges within this distance of the outline of another body of the frame are that body's, px.
    #[schemars(range(min = 0.1, max = 20.0))]
    pub claim_px: f64,
    /// Two bodies of a frame that both have more than this share of their edges in common are each tried again without the other's, 0 to 1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub shared_share: f64,
    /// Whether lost frames are given a pose between those of the frames beside them. It is marked, has no uncertainty, and its verdict
    /// stays `failed`.
    pub bridge: bool,
}

impl Default for TrackParams {
    fn default() -> Self {
        Self {
            enabled: true,
            reach_frames: 10,
            jump_factor: 8.0,
            jump_mm: 1.0,
            jump_deg: 2.0,
            claim_px: 1.5,
            shared_share: 0.1,
            bridge: false,
        }
    }
}

impl TrackParams {
    /// # Errors
    /// Names the first parameter that is out of its range.
    pub fn check(&self) -> Result<(), MatchError> {
        let Self {
            enabled: _,
            reach_frames,
            jump_factor,
            jump_mm,
            jump_deg,
            claim_px,
            shared_share,
            bridge: _,
        } = *self;
        let within = |name, value: f64, low: f64, high: f64, expected| {
            if (low..=high).contains(&value) {
                Ok(())
            } else {
                Err(MatchError::TrackParameter { name, value, expected })
            }
        };
        within("reach_frames", reach_frames as f64, 1.0, 1000.0, "1 to 1000")?;
        within("jump_factor", jump_factor, 1.0, 100.0, "1 to 100")?;
        within("jump_mm", jump_mm, 0.01, 100.0, "0.01 to 100 mm")?;
        within("jump_deg", jump_deg, 0.01, 180.0, "0.01 to 180 degrees")?;
        within("claim_px", claim_px, 0.1, 20.0, "0.1 to 20 px")?;
        within("shared_share", shared_share, 0.0, 1.0, "0 to 1")
    }
}

/// Parameters of the stage: those of the match of the body, and what of `[track]` one frame hangs on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrackFrameParams {
    /// Of the body's match.
    pub matching: MatchParams,
    /// As [`TrackParams::claim_px`].
    pub claim_px: f64,
    /// One a body of `others`: whether its flat ends are no outline.
    pub others_without_cut_ends: Vec<bool>,
}

/// Chooses among `own` and the matches that were found from predictions; `pivot` is the mesh's centroid (model, mm). `seen` says how the
/// body would be seen at the first prediction, where it is lost.
fn decide(
    own: Match,
    tried: Vec<Match>,
    predicted: &[Prediction],
    pivot: &Point3,
    seen: impl FnOnce() -> String,
) -> Match {
    let fits = |m: &Match| matches!(m.verdict, Verdict::Good | Verdict::Ambiguous);
    let off = |m: &Match, p: &Prediction| Pose::from(m.pose).error_against(&p.pose, pivot);
    let expected = |m: &Match| {
        predicted.iter().any(|p| {
            let off = off(m, p);
            off.translation_mm <= p.within_mm && off.rotation_rad <= p.within_rad
        })
    };
    let better = |a: &Match, b: &Match| a.objective < b.objective;
    let steps = tried.iter().map(|m| m.iterations).sum::<u32>() + own.iterations;
    let starts = tried.iter().map(|m| m.starts.tried).sum::<u32>() + own.starts.tried;
    let all: Vec<&Match> = std::iter::once(&own).chain(&tried).collect();
    let best_of = |wanted: &dyn Fn(&Match) -> bool| {
        all.iter().copied().filter(|m| wanted(m)).reduce(|best, m| if better(m, best) { m } else { best })
    };
    let count = move |mut found: Match| {
        found.iterations = steps;
        found.starts.tried = starts;
        found
    };
    if predicted.is_empty() {
        // The same place without the edges of others.
        let anew = tried.iter().filter(|m| fits(m)).reduce(|best, m| if better(m, best) { m } else { best });
        return count(anew.cloned().unwrap_or(own));
    }
    if let Some(found) = best_of(&|m| fits(m) && expected(m)) {
        let mut found = found.clone();
        let rival = best_of(&|m| fits(m) && !expected(m));
        let rival = rival.map(|m| Alternative { pose: m.pose, objective: m.objective }).or(found.alternative);
        found.alternative = rival;
        (found.verdict, found.reason) = match rival {
            Some(rival) if rival.objective < found.objective - CLEARLY => (
                Verdict::Doubtful,
                "lies where the frames beside it say, but another pose fits better: look at both".to_owned(),
            ),
            Some(rival) => {
                let away = Pose::from(rival.pose).error_against(&found.pose.into(), pivot);
                let reason = format!(
                    "another pose, {:.1} mm and {:.1} deg away, fits as well; the frames beside it decide",
                    away.translation_mm,
                    away.rotation_rad.to_degrees()
                );
                (Verdict::Good, reason)
            }
            None => (Verdict::Good, String::new()),
        };
        return count(found);
    }
    if fits(&own) {
        let nearest = predicted
            .iter()
            .map(|p| off(&own, p))
            .reduce(|a, b| if b.translation_mm < a.translation_mm { b } else { a });
        let mut found = own;
        if let (Some(away), Verdict::Good) = (nearest, found.verdict) {
            found.verdict = Verdict::Doubtful;
            found.reason = format!(
                "jumps: {:.1} mm and {:.1} deg from where the frames beside it say",
                away.translation_mm,
                away.rotation_rad.to_degrees()
            );
        }
        return count(found);
    }
    let rank = |m: &Match| (m.verdict, m.objective);
    let best = all.iter().copied().reduce(|best, m| {
        let (a, b) = (rank(m), rank(best));
        if a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).is_lt() { m } else { best }
    });
    let mut found = best.cloned().unwrap_or(own.clone());
    match found.verdict {
        Verdict::Failed => found.reason = format!("lost: {}; {}", seen(), found.reason),
        Verdict::Good => {
            found.verdict = Verdict::Doubtful;
            found.reason = "fits, but does not lie where the frames beside it say".to_owned();
        }
        Verdict::Doubtful | Verdict::Ambiguous => {}
    }
    count(found)
}

/// What is seen of a body at a pose, in words.
fn seen_at(mesh: &RimMesh, views: &[View], names: &[String], pose: &Pose, params: &MatchParams) -> String {
    let there = assess(mesh, views, pose, &params.search());
    let share = |part: f64, whole: f64| if whole > 0.0 { (100.0 * part / whole).min(100.0) } else { 0.0 };
    let said = there.evidence.iter().zip(names).map(|(e, name)| {
        format!(
            "view {name} {:.0} % of the outline on the picture and {:.0} % of that with an edge",
            share(e.in_image_px, e.outline_px),
            share(e.matched_px, e.in_image_px)
        )
    });
    format!("where the frames beside it say the body is, {}", said.collect::<Vec<_>>().join(", "))
}

/// The stage `track`.
#[derive(Debug, Clone, Copy)]
pub struct TrackFrame;

impl Stage for TrackFrame {
    const NAME: &'static str = "track";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = TrackInputs;
    type Params = TrackFrameParams;
    type Output = Match;
    type Error = MatchError;

    fn run(inputs: &TrackInputs, params: &TrackFrameParams, context: &Context) -> Result<Match, MatchError> {
        let matching = &params.matching;
        matching.check()?;
        let (curves, calibrations) = (inputs.curves.len(), inputs.calibrations.len());
        if curves != calibrations || curves == 0 {
            return Err(MatchError::Views { curves, calibrations });
        }
        let rim = |model: &Hashed<ModelMesh>, without_cut_ends: bool| {
            if without_cut_ends {
                Arc::clone(&context.prepared(model.hash(), || RimWithoutCutEnds::new(&model.0)).0)
            } else {
                context.prepared(model.hash(), || RimMesh::new(&model.0))
            }
        };
        let mesh = rim(&inputs.model, matching.ignore_cut_ends);
        let others: Vec<Arc<RimMesh>> = inputs
            .others
            .iter()
            .zip(params.others_without_cut_ends.iter().copied().chain(std::iter::repeat(false)))
            .map(|(model, without)| rim(model, without))
            .collect();
        let posed: Vec<(&RimMesh, Pose)> =
            others.iter().zip(&inputs.other_matches).map(|(mesh, m)| (&**mesh, m.pose.into())).collect();
        let own: Pose = inputs.own.pose.into();
        let supposed = match inputs.predicted.first() {
            Some(first) if inputs.own.verdict != Verdict::Good => first.pose,
            _ => own,
        };
        let contrast = matching.search().contrast;
        let mut taken = 0;
        let left: Vec<Hashed<Curves>> = inputs
            .curves
            .iter()
            .zip(&inputs.calibrations)
            .map(|(curves, calibration)| {
                let view = Fluoroscope::from(&**calibration);
                let (left, lost) =
                    without_claimed(curves, &view, (&mesh, &supposed), &posed, contrast, params.claim_px);
                taken += lost;
                if lost == 0 { curves.clone() } else { Hashed::new(left) }
            })
            .collect();
        let views = views_of(&left, &inputs.calibrations);
        let names: Vec<String> = inputs.calibrations.iter().map(|c| c.view.clone()).collect();
        let uncertainty = inputs.calibration_uncertainty.first().map(|known| &**known);
        // A prediction is near; further starts around it are what neighbours know no better.
        let once = MatchParams { retries: 0, ..matching.clone() };
        let mut starts: Vec<Pose> = inputs.predicted.iter().map(|p| p.pose).collect();
        if taken > 0 {
            starts.push(own);
        }
        starts.extend(inputs.own.alternative.map(|other| Pose::from(other.pose)));
        let tried = starts
            .iter()
            .map(|start| {
                match_anywhere(&mesh, (&views, &names), uncertainty, Some(start), Vec::new, &once, || {
                    context.cancelled()
                })
            })
            .collect::<Result<Vec<_>, _>>()?;
        let predicted: Vec<Prediction> = inputs.predicted.iter().map(|p| **p).collect();
        let seen = || seen_at(&mesh, &views, &names, &supposed, matching);
        Ok(decide(Match::clone(&inputs.own), tried, &predicted, mesh.centroid(), seen))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_artifact::StartsTried;
    use biplane_geometry::Vector3;

    /// A match at `x` mm along x.
    fn at(x: f64, verdict: Verdict, objective: f64) -> Match {
        Match {
            pose: Pose::new(nalgebra::UnitQuaternion::identity(), Vector3::new(x, 0.0, 0.0)).into(),
            verdict,
            reason: "why".to_owned(),
            views: vec![],
            objective,
            covariance: [[0.0; 6]; 6],
            calibration_covariance: None,
            interval_95: [0.0; 6],
            starts: StartsTried { tried: 1, converged: 1, spread: None },
            alternative: None,
            iterations: 5,
        }
    }

    fn expected_at(x: f64) -> [Prediction; 1] {
        let pose = Pose::new(nalgebra::UnitQuaternion::identity(), Vector3::new(x, 0.0, 0.0));
        [Prediction { pose, within_mm: 1.0, within_rad: 0.1 }]
    }

    fn decided(own: Match, tried: Vec<Match>, predicted: &[Prediction]) -> (f64, Verdict, String) {
        let found = decide(own, tried, predicted, &Point3::origin(), || "nothing is seen".to_owned());
        (found.pose.translation_mm[0], found.verdict, found.reason)
    }

    #[test]
    fn a_lost_frame_is_found_from_its_neighbours() {
        let found =
            decided(at(30.0, Verdict::Failed, 0.7), vec![at(0.2, Verdict::Good, 0.1)], &expected_at(0.0));
        assert_eq!(found, (0.2, Verdict::Good, String::new()));
    }

    #[test]
    fn of_two_that_fit_alike_the_neighbours_decide_and_say_so() {
        for own in [Verdict::Good, Verdict::Ambiguous] {
            let tried = vec![at(0.2, Verdict::Ambiguous, 0.11)];
            let (x, verdict, reason) = decided(at(9.0, own, 0.1), tried, &expected_at(0.0));
            assert_eq!((x, verdict), (0.2, Verdict::Good));
            assert!(reason.starts_with("another pose, 8.8 mm and 0.0 deg away, fits as well"), "{reason}");
        }
    }

    #[test]
    fn a_jump_that_nothing_explains_and_a_much_better_pose_elsewhere_are_doubtful() {
        let (x, verdict, reason) = decided(at(9.0, Verdict::Good, 0.1), vec![], &expected_at(0.0));
        assert_eq!((x, verdict), (9.0, Verdict::Doubtful));
        assert!(reason.starts_with("jumps: 9.0 mm"), "{reason}");
        let tried = vec![at(0.2, Verdict::Good, 0.3)];
        let (x, verdict, _) = decided(at(9.0, Verdict::Good, 0.1), tried, &expected_at(0.0));
        assert_eq!((x, verdict), (0.2, Verdict::Doubtful));
        // What the frame itself could not tell stays so where no neighbour decides.
        let own = at(9.0, Verdict::Ambiguous, 0.1);
        assert_eq!(decided(own, vec![], &expected_at(0.0)).1, Verdict::Ambiguous);
    }

    #[test]
    fn what_does_not_fit_is_never_good_and_lost_is_said() {
        let tried = vec![at(0.0, Verdict::Failed, 0.6), at(0.1, Verdict::Doubtful, 0.5)];
        let found = decided(at(30.0, Verdict::Failed, 0.4), tried, &expected_at(0.0));
        assert_eq!(found, (0.1, Verdict::Doubtful, "why".to_owned()));
        let tried = vec![at(9.0, Verdict::Good, 0.1)];
        let (_, verdict, reason) = decided(at(30.0, Verdict::Failed, 0.7), tried, &expected_at(0.0));
        assert_eq!(verdict, Verdict::Doubtful, "fits elsewhere: {reason}");
        let tried = vec![at(0.0, Verdict::Failed, 0.6)];
        let (_, verdict, reason) = decided(at(30.0, Verdict::Failed, 0.7), tried, &expected_at(0.0));
        assert_eq!((verdict, reason.as_str()), (Verdict::Failed, "lost: nothing is seen; why"));
    }

    #[test]
    fn without_neighbours_the_same_place_is_tried_without_the_edges_of_others() {
        let found = decided(at(0.3, Verdict::Good, 0.1), vec![at(0.1, Verdict::Good, 0.2)], &[]);
        assert_eq!(found.0, 0.1);
        let found = decided(at(0.3, Verdict::Good, 0.1), vec![at(5.0, Verdict::Failed, 0.9)], &[]);
        assert_eq!(found.0, 0.3);
        let counted = decide(
            at(0.0, Verdict::Good, 0.1),
            vec![at(0.0, Verdict::Good, 0.1)],
            &[],
            &Point3::origin(),
            String::new,
        );
        assert_eq!((counted.iterations, counted.starts.tried), (10, 2));
    }
}
