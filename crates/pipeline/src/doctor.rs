//! `biplane doctor`: does the calibration still fit the frames of a trial?
//!
//! Three looks, each with its limit in `[doctor]`: how far the views disagree about where matched bodies are, across their epipolar
//! planes ([`disagreement`]); how far the intensifier's round border has moved since the calibration pictures; and how unsure the
//! calibration alone makes a pose in this geometry. **Not seen:** an error of calibration that moves both views' rays within their
//! epipolar planes; it shifts or scales everything alike.

use std::collections::BTreeMap;
use std::sync::Arc;

use biplane_artifact::{Calibration, Circle, ContentHash, Match, Verdict};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Mesh, Pose};
use biplane_optimisation::{Disagreement, EdgeField, View, disagreement};
use biplane_outline::{RimMesh, RimWithoutCutEnds};
use biplane_spots::find_border;
use biplane_stage::{Context, Hashed, Store, StoreError, Stored};
use rayon::prelude::*;

use crate::calibrate::{CalibrateError, Calibrated, calibrate};
use crate::logging::Progress;
use crate::models::{self, BodyModel};
use crate::prepare::{InputErrors, Job, Prepared};
use crate::steps::{Standing, Steps, read_stored};
use crate::study::{Body, Study};
use crate::summary::aligned;
use crate::walk::Way;

/// Frames of a trial whose border is looked at.
const BORDERS: usize = 9;
/// A median counts as other than zero beyond this many of its standard errors.
const SURE: f64 = 4.0;

/// What the doctor found.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnosis {
    /// For people.
    pub text: String,
    /// Whether all limits are kept.
    pub well: bool,
}

/// Why nothing can be said.
#[derive(Debug, thiserror::Error)]
pub enum DoctorError {
    /// Inputs that everything hangs on are wrong.
    #[error(transparent)]
    Inputs(#[from] InputErrors),
    /// The store cannot be used.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// There are no fluoroscopes.
    #[error("The calibration itself failed.\n{0}")]
    Calibration(#[from] CalibrateError),
    /// There is no such trial.
    #[error("there is no trial `{wanted}`; the study has {known}")]
    Trial {
        /// What was asked for.
        wanted: String,
        /// What there is.
        known: String,
    },
    /// Nothing was matched yet.
    #[error("no match of trial `{0}` is up to date: `biplane run` first")]
    NoMatch(String),
}

/// Looks at one trial, or at all of them, with the results of the last run.
///
/// # Errors
/// See [`DoctorError`].
pub fn doctor(study: Study, trial: Option<&str>) -> Result<Diagnosis, DoctorError> {
    let prepared = Prepared::of(study)?;
    let store = Store::open(&prepared.study.hidden())?;
    let context = Context::new();
    let (calibrated, _) = calibrate(&prepared, &store, &context, Way::Run(Vec::new()));
    let calibrated = calibrated?.unwrap_or_default();
    let (models, _) = models::look::look(&prepared, &store, &context, &mut Vec::new());
    let steps = Steps {
        prepared: &prepared,
        calibrated: &calibrated,
        models: &models,
        store: &store,
        context: &context,
    };
    let study = &prepared.study;
    let wanted: Vec<usize> =
        (0..study.trials.len()).filter(|t| trial.is_none_or(|name| study.trials[*t].name == name)).collect();
    if let (Some(name), []) = (trial, &wanted[..]) {
        let known: Vec<&str> = study.trials.iter().map(|t| t.name.as_str()).collect();
        return Err(DoctorError::Trial { wanted: name.to_owned(), known: known.join(", ") });
    }
    let rim = |(model, body): (&Option<BodyModel>, &Body)| {
        let of = |mesh: &Mesh| match body.ignore_cut_ends {
            true => RimWithoutCutEnds::new(mesh).0,
            false => Arc::new(RimMesh::new(mesh)),
        };
        model.as_ref().map(|m| m.load().map(|mesh| of(&mesh.0))).transpose()
    };
    let meshes: Vec<Option<Arc<RimMesh>>> = models
        .iter()
        .zip(&study.bodies)
        .map(rim)
        .collect::<Result<_, _>>()
        .map_err(|e| InputErrors(vec![e]))?;
    let mut found = Diagnosis { text: String::new(), well: true };
    for trial in wanted {
        let looked = Looking { steps: &steps, calibrated: &calibrated, meshes: &meshes, trial };
        looked.trial(&mut found)?;
    }
    if let Err(error) = prepared.index.save(false) {
        tracing::debug!("the index of inputs was not written: {error}");
    }
    found.text += if found.well {
        "\nThe calibration fits these frames as far as the views can tell.\n"
    } else {
        "\nThe calibration does not fit these frames. Was a fluoroscope moved, or the picture's size or field changed since the\n\
         calibration pictures were taken? Are the views exchanged? Calibrate again, or use the pictures of that day.\n"
    };
    Ok(found)
}

struct Looking<'a> {
    steps: &'a Steps<'a>,
    calibrated: &'a Calibrated,
    /// None of a body whose model is not there: it has no match either.
    meshes: &'a [Option<Arc<RimMesh>>],
    trial: usize,
}

/// One body in one frame whose match did not fail.
struct Matched {
    body: usize,
    found: Match,
    /// None with one view.
    disagreement: Option<Disagreement>,
}

impl Looking<'_> {
    fn study(&self) -> &Study {
        &self.steps.prepared.study
    }

    fn jobs(&self) -> impl Iterator<Item = &Job> {
        self.steps.prepared.jobs.iter().filter(|job| job.trial == self.trial)
    }

    fn trial(&self, diagnosis: &mut Diagnosis) -> Result<(), DoctorError> {
        let study = self.study();
        let name = &study.trials[self.trial].name;
        let jobs: Vec<&Job> = self.jobs().collect();
        let progress = Progress::new("Looking", jobs.len(), "frames");
        let looked: Vec<Option<Vec<Matched>>> = jobs
            .par_iter()
            .map(|job| {
                let matches = self.matches(job);
                progress.tick();
                matches
            })
            .collect();
        drop(progress);
        let all: Vec<Matched> = looked.into_iter().flatten().flatten().collect();
        if all.is_empty() {
            return Err(DoctorError::NoMatch(name.clone()));
        }
        diagnosis.text += &format!("Trial {name}: {} matches in {} frames\n\n", all.len(), jobs.len());
        self.views_agree(&all, diagnosis);
        self.borders_stay(&jobs, diagnosis);
        self.poses_are_sure(&all, diagnosis);
        Ok(())
    }

    /// The matches of a frame; none unless everything that it takes is in the store.
    fn matches(&self, job: &Job) -> Option<Vec<Matched>> {
        let Standing { automatic, drawn } = self.steps.standing(job)?;
        let mut found_here = Vec::new();
        // Bodies share them unless a person drew one of them.
        let mut views: Option<(Vec<ContentHash>, Vec<View>)> = None;
        for (place, (body, ..)) in job.bodies.iter().enumerate() {
            let Ok(Some(curves)) = self.steps.explain_curves(job, place, &automatic, &drawn) else {
                continue;
            };
            let Ok((_, Some(stored))) = self.steps.explain_match(job, place, &curves) else { continue };
            let Ok(found) = read_stored(self.steps.store, &stored) else { continue };
            // What a wrong calibration made doubtful speaks too.
            if found.verdict == Verdict::Failed {
                continue;
            }
            let hashes: Vec<ContentHash> = curves.iter().map(Stored::hash).collect();
            if views.as_ref().is_none_or(|(of, _)| *of != hashes) {
                let made = curves.iter().enumerate().map(|(slot, stored)| {
                    let curves = read_stored(self.steps.store, stored).ok()?;
                    let fluoroscope = self.fluoroscope(self.steps.view(job, slot).0);
                    Some(View { edges: EdgeField::new(&curves, fluoroscope.distortion()), fluoroscope })
                });
                views = made.collect::<Option<_>>().map(|made| (hashes, made));
            }
            let pose = Pose::from(found.pose);
            let search = self.study().matching.search();
            let pair = views.as_ref().and_then(|(_, v)| v.get(..2));
            let mesh = self.meshes[*body].as_ref();
            let disagreement =
                pair.zip(mesh).and_then(|(pair, mesh)| disagreement(mesh, pair, &pose, &search));
            found_here.push(Matched { body: *body, found: Match::clone(&found), disagreement });
        }
        Some(found_here)
    }

    fn fluoroscope(&self, view: usize) -> Fluoroscope {
        let calibration: &Hashed<Calibration> = &self.calibrated.calibrations[view];
        Fluoroscope::from(&**calibration)
    }

    fn views_agree(&self, all: &[Matched], diagnosis: &mut Diagnosis) {
        let limit = self.study().doctor.max_disagreement_mm;
        let mut of_bodies: BTreeMap<usize, Vec<Disagreement>> = BTreeMap::new();
        for good in all {
            of_bodies.entry(good.body).or_default().extend(good.disagreement);
        }
        of_bodies.retain(|_, list| !list.is_empty());
        if of_bodies.is_empty() {
            diagnosis.text +=
                "One view alone cannot be held against another: whether it fits is not known.\n\n";
            return;
        }
        let names: Vec<&str> = self.study().trials[self.trial]
            .frames
            .iter()
            .map(|(v, _)| self.study().views[*v].name.as_str())
            .collect();
        diagnosis.text += &format!(
            "Views {} and {} about where a body is, across their epipolar planes (limit {limit} mm)\n",
            names.first().unwrap_or(&"1"),
            names.get(1).unwrap_or(&"2")
        );
        let rows = of_bodies.iter().map(|(body, list)| {
            let mut values: Vec<f64> = list.iter().map(|d| d.mm).collect();
            let middle = median(&mut values);
            let mut off: Vec<f64> = values.iter().map(|v| (v - middle).abs()).collect();
            let spread = 1.4826 * median(&mut off);
            let mut sigmas: Vec<f64> = list.iter().map(|d| d.sigma_mm).collect();
            let stated = median(&mut sigmas);
            // Frames of one trial share much of what spoils them, so the error of the median is no smaller than a third of one
            // frame's stated one.
            let error = (1.25 * spread / (list.len() as f64).sqrt()).max(stated / 3.0);
            let (half, _) = list.split_at(list.len() / 2);
            let mut first: Vec<f64> = half.iter().map(|d| d.mm).collect();
            let mut last: Vec<f64> = list[list.len() / 2..].iter().map(|d| d.mm).collect();
            let drift = median(&mut last) - median(&mut first);
            let bad = middle.abs() > limit && middle.abs() > SURE * error;
            diagnosis.well &= !bad;
            vec![
                self.study().bodies[*body].name.clone(),
                list.len().to_string(),
                format!("{middle:+.3}"),
                format!("{spread:.3}"),
                format!("{stated:.3}"),
                format!("{drift:+.3}"),
                if bad { "does not fit".to_owned() } else { "fits".to_owned() },
            ]
        });
        let rows: Vec<Vec<String>> = rows.collect();
        diagnosis.text += &aligned(
            &["body", "frames", "median mm", "spread mm", "stated sigma mm", "later less earlier mm", ""],
            rows.into_iter(),
            &[1, 2, 3, 4, 5],
        );
        diagnosis.text += "\n";
    }

    fn borders_stay(&self, jobs: &[&Job], diagnosis: &mut Diagnosis) {
        let limit = self.study().doctor.max_border_shift_px;
        let mut rows = Vec::new();
        for (slot, (view, _)) in self.study().trials[self.trial].frames.iter().enumerate() {
            let name = &self.study().views[*view].name;
            let Some(reference) = self.calibrated.plates.get(*view).and_then(|p| p.as_ref()?.border) else {
                continue;
            };
            let step = jobs.len().div_ceil(BORDERS).max(1);
            let seen: Vec<Circle> = jobs
                .par_iter()
                .step_by(step)
                .filter_map(|job| find_border(&self.steps.prepared.read(job.pictures.get(slot)?).ok()?))
                .collect();
            let shift = |axis: usize| {
                let mut shifts: Vec<f64> =
                    seen.iter().map(|c| c.centre_px[axis] - reference.centre_px[axis]).collect();
                median(&mut shifts)
            };
            let mut radii: Vec<f64> = seen.iter().map(|c| c.radius_px - reference.radius_px).collect();
            let radius = median(&mut radii);
            let moved = shift(0).hypot(shift(1)).max(radius.abs());
            let bad = !seen.is_empty() && moved > limit;
            diagnosis.well &= !bad;
            let judged = match (seen.is_empty(), bad) {
                (true, _) => "no border in the frames",
                (_, true) => "has moved",
                _ => "stays",
            };
            rows.push(vec![
                name.clone(),
                seen.len().to_string(),
                format!("{:+.2}", shift(0)),
                format!("{:+.2}", shift(1)),
                format!("{radius:+.2}"),
                judged.to_owned(),
            ]);
        }
        if rows.is_empty() {
            diagnosis.text += "No plate picture with a round border: whether the picture has moved on the detector is not known.\n\n";
            return;
        }
        diagnosis.text += &format!(
            "The intensifier's border in the frames less that in the plate's picture (limit {limit} px)\n"
        );
        diagnosis.text +=
            &aligned(&["view", "frames", "x px", "y px", "radius px", ""], rows.into_iter(), &[1, 2, 3, 4]);
        diagnosis.text += "\n";
    }

    fn poses_are_sure(&self, all: &[Matched], diagnosis: &mut Diagnosis) {
        if self.calibrated.uncertainties.get(self.trial).is_none_or(Option::is_none) {
            diagnosis.text += "The calibration comes from files, and it is not said how sure it is (`uncertainty` of each fluoroscope): \
                               what it adds to the uncertainty of a pose is not known.\n";
            return;
        }
        let limit = self.study().doctor.max_pose_sigma_mm;
        let mut rows = Vec::new();
        for body in self.study().trials[self.trial].bodies.iter().copied() {
            let own: Vec<&Matched> = all.iter().filter(|g| g.body == body).collect();
            let Some(good) = own.get(own.len() / 2) else { continue };
            let sigma = good.found.calibration_sigmas();
            let judged = match sigma {
                Some([mm, _]) if mm <= limit => "sure",
                Some(_) => "unsure",
                None => "not held by the outlines",
            };
            diagnosis.well &= judged == "sure";
            let [mm, rad] = sigma.unwrap_or([f64::NAN; 2]);
            let all = [good.found.translation_sigma_mm(), good.found.rotation_sigma_rad()];
            let [edge_mm, edge_rad] =
                [(all[0], mm), (all[1], rad)].map(|(all, own)| (all * all - own * own).sqrt());
            rows.push(vec![
                self.study().bodies[body].name.clone(),
                format!("{mm:.3}"),
                format!("{:.3}", rad.to_degrees()),
                format!("{edge_mm:.3}"),
                format!("{:.3}", edge_rad.to_degrees()),
                judged.to_owned(),
            ]);
        }
        diagnosis.text += &format!(
            "Standard deviation of a pose (a frame in the middle) from the calibration, and from its edges (limit {limit} mm from the calibration)\n"
        );
        diagnosis.text += &aligned(
            &["body", "calibration mm", "degrees", "edges mm", "degrees", ""],
            rows.into_iter(),
            &[1, 2, 3, 4],
        );
    }
}

fn median(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}
