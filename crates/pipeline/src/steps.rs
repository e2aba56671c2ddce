//! The steps of the method as items of a study: what each reads, its name in the store, how it runs and is explained.
//!
//! `segment/<trial>/<frame>/<view>` makes curves from a picture, `edit/<trial>/<frame>/<view>/<body>` from what a person drew in it,
//! `match/<trial>/<frame>/<body>` a pose from the curves of all views, `track/<trial>/<frame>/<body>` one more where other frames or bodies
//! help, `contour/<trial>/<frame>/<view>/<body>` says which curves are
//! the body's outline, `overlay/<trial>/<frame>/<view>` is a picture with the outlines of the posed bodies. Those of slices are in
//! [`crate::slices`], those of models in [`crate::models`], those of the report in [`crate::report::item`].

use biplane_artifact::{
    Artifact, CalibrationUncertainty, Contour, Curves, EditedContour, Match, ModelMesh, Picture,
};
use biplane_contour::{ContourInputs, ContourOf};
use biplane_geometry::Point3;
use biplane_optimisation::{MatchBody, MatchInputs, TrackFrame, TrackInputs};
use biplane_segmentation::{Segment, SegmentInputs, Trace, TraceInputs};
use biplane_stage::{
    Context, ExecuteError, Explanation, Hashed, How, Item, KeyParts, ParamsText, Promise, Promised, Stage,
    Store, StoreError, Stored,
};

use crate::calibrate::Calibrated;
use crate::edits::{self, Drawn};
use crate::models::BodyModel;
use crate::overlay::{Overlay, OverlayInputs, OverlayParams};
use crate::prepare::{Job, Prepared};
use crate::sources::FrameFacts;
use crate::study::ViewSource;
use crate::tracking::Attempt;

/// Step of holes and beads in calibration pictures.
pub const SPOTS: &str = "spots";
/// Step of distortion.
pub const DISTORTION: &str = "distortion";
/// Step of the fluoroscopes.
pub const ENVIRONMENT: &str = "environment";
/// Step of drawings of the calibration.
pub const DRAWING: &str = "drawing";
/// Step of contours of slices.
pub const SLICES: &str = "slices";
/// Step of contours of slices with what a person drew in their place.
pub const SLICE_EDITS: &str = "slice_edits";
/// Step of surfaces from contours of slices.
pub const LOFT: &str = "loft";
/// Step of surfaces from maps of labels.
pub const LABEL_SURFACE: &str = "label_surface";
/// Step of the meshes that are matched.
pub const MODEL: &str = "model";
/// Step of local coordinate systems of bodies.
pub const AXES: &str = "axes";
/// Step of edge curves.
pub const SEGMENT: &str = "segment";
/// Step of curves along what a person drew.
pub const EDIT: &str = "edit";
/// Step of poses.
pub const MATCH: &str = "match";
/// Step of poses from what other frames and bodies say.
pub const TRACK: &str = "track";
/// Step of the curves that are outlines.
pub const CONTOUR: &str = "contour";
/// Step of smoothed trials.
pub const SMOOTH: &str = "smooth";
/// Step of joints.
pub const JOINT: &str = "joint";
/// Step of pictures for people.
pub const OVERLAY: &str = "overlay";
/// Step of bodies for the report.
pub const REPORT_MODEL: &str = "report_model";
/// Step of frames of the report.
pub const REPORT_FRAME: &str = "report_frame";
/// All steps in order.
pub const STEPS: [&str; 20] = [
    SPOTS,
    DISTORTION,
    ENVIRONMENT,
    SLICES,
    SLICE_EDITS,
    LOFT,
    LABEL_SURFACE,
    MODEL,
    AXES,
    DRAWING,
    SEGMENT,
    EDIT,
    MATCH,
    TRACK,
    CONTOUR,
    SMOOTH,
    JOINT,
    OVERLAY,
    REPORT_MODEL,
    REPORT_FRAME,
];

/// Why an item has no output.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ItemError {
    /// The run was stopped.
    #[error("stopped")]
    Cancelled,
    /// For people.
    #[error("{0}")]
    Failed(String),
}

/// Why an item would run, and its output if it is there.
pub type Explained<A> = Result<(Explanation, Option<Stored<A>>), ItemError>;

/// An item's output and how it was come by.
pub type Done<A> = Result<(A, How), ItemError>;

/// What of a frame's pictures is in the store and up to date, one a view.
#[derive(Debug)]
pub struct Standing {
    /// Their curves.
    pub automatic: Vec<Stored<Curves>>,
    /// What a person drew in them.
    pub drawn: Vec<Option<Drawn>>,
}

impl ItemError {
    pub(crate) fn of(error: impl std::fmt::Display) -> Self {
        Self::Failed(error.to_string())
    }
}

/// A study, its store, and how to run.
#[derive(Debug)]
pub struct Steps<'a> {
    /// The study.
    pub prepared: &'a Prepared,
    /// The fluoroscopes; without calibrations as long as they are not known.
    pub calibrated: &'a Calibrated,
    /// One a body; `None` where its model is not there, or not known yet.
    pub models: &'a [Option<BodyModel>],
    /// Its store.
    pub store: &'a Store,
    /// Threads see this to stop.
    pub context: &'a Context,
}

impl Steps<'_> {
    /// Name of a job's item in the store.
    pub fn item(&self, job: &Job, last: &str) -> Item {
        Item::of([self.prepared.study.trials[job.trial].name.as_str(), &job.label, last])
    }

    /// Name of the view of a job's picture.
    pub fn view(&self, job: &Job, slot: usize) -> (usize, &str) {
        let view = self.prepared.study.trials[job.trial].frames[slot].0;
        (view, self.prepared.study.views[view].name.as_str())
    }

    /// Whether an item has ever had an output.
    pub fn ever_made(&self, step: &str, item: &Item) -> bool {
        self.store.link_path(step, item).symlink_metadata().is_ok()
    }

    /// What is known of a picture; its size must be that of the view's calibration.
    ///
    /// # Errors
    /// It cannot be read, or has another size.
    pub fn picture(&self, job: &Job, slot: usize) -> Result<FrameFacts, ItemError> {
        let source = &job.pictures[slot];
        let facts =
            self.prepared.index.frame(&source.path, source.index_in_file, || self.prepared.read(source));
        let facts = facts.map_err(ItemError::of)?;
        let (view, name) = self.view(job, slot);
        let expected = self.calibrated.calibrations.get(view).map_or(facts.size, |c| c.size);
        if facts.size != expected {
            let [found, expected] = [facts.size, expected].map(|[w, h]| format!("{w} x {h}"));
            let calibration = match &self.prepared.study.views[view].source {
                ViewSource::File { calibration, .. } => calibration.display().to_string(),
                ViewSource::Pictures { .. } => "from its pictures of beads".to_owned(),
            };
            return Err(ItemError::Failed(format!(
                "{}: {found} pixels, but the calibration of view {name} ({calibration}) is for {expected}. Use the pictures \
                 that were calibrated, neither cropped nor scaled, or the calibration that belongs to these",
                source.path.display(),
            )));
        }
        Ok(facts)
    }

    /// Brings one picture to its curves.
    ///
    /// # Errors
    /// The picture cannot be used, the stage failed, or the store did.
    pub fn segment(&self, job: &Job, slot: usize) -> Done<Stored<Curves>> {
        let facts = self.picture(job, slot)?;
        let promised = self.segment_promised(job, slot, &facts);
        let mask = &self.prepared.masks[self.view(job, slot).0];
        let load = || {
            let frame = self.prepared.read(&job.pictures[slot]);
            frame.map(|f| SegmentInputs { frame: Hashed::new(f), mask: mask.clone() })
        };
        let item = self.item(job, self.view(job, slot).1);
        self.store
            .execute::<Segment, _>(SEGMENT, &item, &self.prepared.segment, &promised, load, self.context)
            .map(|done| (done.output, done.how))
            .map_err(|e| self.failed(job, Some(slot), e))
    }

    fn segment_promised(&self, job: &Job, slot: usize, facts: &FrameFacts) -> SegmentInputs<Promised> {
        let mask = &self.prepared.masks[self.view(job, slot).0];
        SegmentInputs { frame: facts.promise(), mask: mask.iter().map(Hashed::promise).collect() }
    }

    /// What a person drew in a picture, if anything.
    ///
    /// # Errors
    /// The picture or the file cannot be used.
    pub fn drawn(&self, job: &Job, slot: usize) -> Result<Option<Drawn>, ItemError> {
        let facts = self.picture(job, slot)?;
        edits::read(&self.prepared.study, job, slot, &facts).map_err(ItemError::Failed)
    }

    /// Name of the item of a body in one picture.
    pub fn item_of_body(&self, job: &Job, slot: usize, place: usize) -> Item {
        let study = &self.prepared.study;
        let (trial, body) = (&study.trials[job.trial].name, &study.bodies[job.bodies[place].0].name);
        Item::of([trial.as_str(), &job.label, self.view(job, slot).1, body])
    }

    fn trace_promised(
        &self,
        job: &Job,
        slot: usize,
        curves: &Stored<Curves>,
        edit: &Hashed<EditedContour>,
    ) -> Result<TraceInputs<Promised>, ItemError> {
        let frame = self.picture(job, slot)?.promise();
        Ok(TraceInputs { frame, curves: curves.promise(), edit: edit.promise() })
    }

    /// Brings what a person drew for a body to curves.
    ///
    /// # Errors
    /// The picture cannot be used, the stage failed, or the store did.
    pub fn trace(
        &self,
        job: &Job,
        slot: usize,
        place: usize,
        curves: &Stored<Curves>,
        edit: &Hashed<EditedContour>,
    ) -> Done<Stored<Curves>> {
        let promised = self.trace_promised(job, slot, curves, edit)?;
        let load = || -> Result<TraceInputs, String> {
            let frame = self.prepared.read(&job.pictures[slot]).map_err(|e| e.to_string())?;
            let curves = read_stored(self.store, curves)?;
            Ok(TraceInputs { frame: Hashed::new(frame), curves, edit: edit.clone() })
        };
        let item = self.item_of_body(job, slot, place);
        self.store
            .execute::<Trace, _>(EDIT, &item, &self.prepared.edit, &promised, load, self.context)
            .map(|done| (done.output, done.how))
            .map_err(|e| self.failed(job, Some(slot), e))
    }

    /// Why what a person drew would be worked on, and its curves if they are there.
    ///
    /// # Errors
    /// The picture cannot be used, or the store cannot.
    pub fn explain_trace(
        &self,
        job: &Job,
        slot: usize,
        place: usize,
        curves: &Stored<Curves>,
        edit: &Hashed<EditedContour>,
    ) -> Explained<Curves> {
        let parts =
            KeyParts::of::<Trace>(&self.prepared.edit, &self.trace_promised(job, slot, curves, edit)?);
        self.explain::<Trace>(EDIT, &self.item_of_body(job, slot, place), &parts)
    }

    /// The curves that a body is matched to, one a view: what a person drew where there is such, the `automatic` ones elsewhere. `None`
    /// where they are not in the store.
    ///
    /// # Errors
    /// A picture cannot be used, or the store cannot.
    pub fn explain_curves(
        &self,
        job: &Job,
        place: usize,
        automatic: &[Stored<Curves>],
        drawn: &[Option<Drawn>],
    ) -> Result<Option<Vec<Stored<Curves>>>, ItemError> {
        let slots = automatic.iter().zip(drawn).enumerate();
        let own = slots.map(|(slot, (curves, drawn))| match drawn.as_ref().and_then(|d| d.of(place)) {
            None => Ok(Some(curves.clone())),
            Some(edit) => Ok(self.explain_trace(job, slot, place, curves, edit)?.1),
        });
        own.collect()
    }

    /// What a frame's bodies are matched to; `None` unless all of it is there.
    pub fn standing(&self, job: &Job) -> Option<Standing> {
        let slots = 0..job.pictures.len();
        let automatic =
            slots.clone().map(|slot| self.explain_segment(job, slot).ok()?.1).collect::<Option<_>>()?;
        let drawn = slots.map(|slot| self.drawn(job, slot).ok()).collect::<Option<_>>()?;
        Some(Standing { automatic, drawn })
    }

    /// The model of a body of the study.
    ///
    /// # Errors
    /// It could not be made, or is not known yet.
    pub fn model(&self, body: usize) -> Result<&BodyModel, ItemError> {
        let name = || &self.prepared.study.bodies[body].name;
        let model = self.models.get(body).and_then(Option::as_ref);
        model.ok_or_else(|| ItemError::Failed(format!("the model of {} is not there", name())))
    }

    fn contour_promised(
        &self,
        job: &Job,
        slot: usize,
        place: usize,
        curves: &Stored<Curves>,
        matched: Promise<Match>,
    ) -> Result<ContourInputs<Promised>, ItemError> {
        Ok(ContourInputs {
            curves: curves.promise(),
            calibration: self.calibrated.calibrations[self.view(job, slot).0].promise(),
            model: self.model(job.bodies[place].0)?.promise(),
            matched,
        })
    }

    /// All that says which curves of a picture are the outline of a posed body.
    ///
    /// # Errors
    /// The curves or the mesh cannot be read any more.
    pub fn contour_inputs(
        &self,
        job: &Job,
        slot: usize,
        place: usize,
        curves: &Stored<Curves>,
        matched: &Hashed<Match>,
    ) -> Result<ContourInputs, String> {
        Ok(ContourInputs {
            curves: read_stored(self.store, curves)?,
            calibration: self.calibrated.calibrations[self.view(job, slot).0].clone(),
            model: self.load_model(job.bodies[place].0)?,
            matched: matched.clone(),
        })
    }

    /// Finds the outline of a posed body among the curves of a picture.
    ///
    /// # Errors
    /// The stage failed, or the store did.
    pub fn contour(
        &self,
        job: &Job,
        slot: usize,
        place: usize,
        curves: &Stored<Curves>,
        matched: &Hashed<Match>,
    ) -> Done<Hashed<Contour>> {
        let promised = self.contour_promised(job, slot, place, curves, matched.promise())?;
        let load = || self.contour_inputs(job, slot, place, curves, matched);
        let item = self.item_of_body(job, slot, place);
        let done = self
            .store
            .execute::<ContourOf, _>(
                CONTOUR,
                &item,
                &self.prepared.contour[job.bodies[place].0],
                &promised,
                load,
                self.context,
            )
            .map_err(|e| self.failed(job, None, e))?;
        Ok((read_stored(self.store, &done.output).map_err(ItemError::Failed)?, done.how))
    }

    /// Why the outline of a body would be looked for, and what it is if it is there.
    ///
    /// # Errors
    /// The store cannot be read.
    pub fn explain_contour(
        &self,
        job: &Job,
        slot: usize,
        place: usize,
        curves: &Stored<Curves>,
        matched: Promise<Match>,
    ) -> Explained<Contour> {
        let promised = self.contour_promised(job, slot, place, curves, matched)?;
        let parts = KeyParts::of::<ContourOf>(&self.prepared.contour[job.bodies[place].0], &promised);
        self.explain::<ContourOf>(CONTOUR, &self.item_of_body(job, slot, place), &parts)
    }

    pub(crate) fn load_model(&self, body: usize) -> Result<Hashed<ModelMesh>, String> {
        self.model(body).map_err(|e| e.to_string())?.load()
    }

    /// How sure the calibrations of a trial are, if anything is known of it.
    fn uncertainty(&self, job: &Job) -> Vec<Hashed<CalibrationUncertainty>> {
        self.calibrated
            .uncertainties
            .get(job.trial)
            .iter()
            .filter_map(|known| known.as_ref().cloned())
            .collect()
    }

    fn match_promised(
        &self,
        job: &Job,
        place: usize,
        curves: &[Stored<Curves>],
    ) -> Result<MatchInputs<Promised>, ItemError> {
        let (body, _, start) = &job.bodies[place];
        Ok(MatchInputs {
            curves: curves.iter().map(Stored::promise).collect(),
            calibrations: (0..curves.len())
                .map(|slot| self.calibrated.calibrations[self.view(job, slot).0].promise())
                .collect(),
            model: self.model(*body)?.promise(),
            start: start.iter().map(Hashed::promise).collect(),
            calibration_uncertainty: self.uncertainty(job).iter().map(Hashed::promise).collect(),
        })
    }

    /// All that a body is matched by.
    ///
    /// # Errors
    /// The curves or the mesh cannot be read any more.
    pub fn match_inputs(
        &self,
        job: &Job,
        place: usize,
        curves: &[Stored<Curves>],
    ) -> Result<MatchInputs, String> {
        let (body, _, start) = &job.bodies[place];
        Ok(MatchInputs {
            curves: curves.iter().map(|c| read_stored(self.store, c)).collect::<Result<_, _>>()?,
            calibrations: (0..curves.len())
                .map(|slot| self.calibrated.calibrations[self.view(job, slot).0].clone())
                .collect(),
            model: self.load_model(*body)?,
            start: start.iter().cloned().collect(),
            calibration_uncertainty: self.uncertainty(job),
        })
    }

    /// Brings one body to its pose.
    ///
    /// # Errors
    /// The stage failed, or the store did.
    pub fn matching(&self, job: &Job, place: usize, curves: &[Stored<Curves>]) -> Done<Hashed<Match>> {
        let body = &job.bodies[place].0;
        let load = || self.match_inputs(job, place, curves);
        let promised = self.match_promised(job, place, curves)?;
        let item = self.item(job, &self.prepared.study.bodies[*body].name);
        let done = self
            .store
            .execute::<MatchBody, _>(
                MATCH,
                &item,
                &self.prepared.matching[*body],
                &promised,
                load,
                self.context,
            )
            .map_err(|e| self.failed(job, None, e))?;
        Ok((read_stored(self.store, &done.output).map_err(ItemError::Failed)?, done.how))
    }

    fn track_parts(
        &self,
        wanted: &Attempt,
        curves: &[Stored<Curves>],
    ) -> Result<(ParamsText, TrackInputs<Promised>), ItemError> {
        let job = &self.prepared.jobs[wanted.job];
        let body = job.bodies[wanted.place].0;
        let others: Vec<usize> = wanted.others.iter().map(|(place, _)| job.bodies[*place].0).collect();
        let params =
            ParamsText::of(&self.prepared.study.tracking_of(body, &others)).map_err(ItemError::of)?;
        let MatchInputs { curves, calibrations, model, start: _, calibration_uncertainty } =
            self.match_promised(job, wanted.place, curves)?;
        let promised = TrackInputs {
            curves,
            calibrations,
            model,
            own: wanted.own.promise(),
            predicted: wanted.predicted.iter().map(Hashed::promise).collect(),
            others: others
                .iter()
                .map(|body| self.model(*body).map(BodyModel::promise))
                .collect::<Result<_, _>>()?,
            other_matches: wanted.others.iter().map(|(_, found)| found.promise()).collect(),
            calibration_uncertainty,
        };
        Ok((params, promised))
    }

    /// Tries a body in a frame again, with what other frames and bodies say.
    ///
    /// # Errors
    /// The stage failed, or the store did.
    pub fn track(&self, wanted: &Attempt, curves: &[Stored<Curves>]) -> Done<Hashed<Match>> {
        let job = &self.prepared.jobs[wanted.job];
        let (params, promised) = self.track_parts(wanted, curves)?;
        let load = || -> Result<TrackInputs, String> {
            let MatchInputs { curves, calibrations, model, start: _, calibration_uncertainty } =
                self.match_inputs(job, wanted.place, curves)?;
            let others = wanted.others.iter().map(|(place, _)| self.load_model(job.bodies[*place].0));
            Ok(TrackInputs {
                curves,
                calibrations,
                model,
                own: wanted.own.clone(),
                predicted: wanted.predicted.clone(),
                others: others.collect::<Result<_, _>>()?,
                other_matches: wanted.others.iter().map(|(_, found)| found.clone()).collect(),
                calibration_uncertainty,
            })
        };
        let item = self.item(job, &self.prepared.study.bodies[job.bodies[wanted.place].0].name);
        let done = self
            .store
            .execute::<TrackFrame, _>(TRACK, &item, &params, &promised, load, self.context)
            .map_err(|e| self.failed(job, None, e))?;
        Ok((read_stored(self.store, &done.output).map_err(ItemError::Failed)?, done.how))
    }

    /// Why a body would be tried again, and its match if it is there.
    ///
    /// # Errors
    /// The store cannot be read.
    pub fn explain_track(&self, wanted: &Attempt, curves: &[Stored<Curves>]) -> Explained<Match> {
        let job = &self.prepared.jobs[wanted.job];
        let (params, promised) = self.track_parts(wanted, curves)?;
        let parts = KeyParts::of::<TrackFrame>(&params, &promised);
        let item = self.item(job, &self.prepared.study.bodies[job.bodies[wanted.place].0].name);
        self.explain::<TrackFrame>(TRACK, &item, &parts)
    }

    /// The middle of each body of the study in its model, as far as it is known, mm.
    pub fn pivots(&self) -> Vec<Point3> {
        let of = |body| match self.model(body) {
            Ok(BodyModel::File(file)) => Point3::from(file.facts.centroid),
            Ok(BodyModel::Made(mesh)) => mesh.0.area_centroid(),
            Err(_) => Point3::origin(),
        };
        (0..self.prepared.study.bodies.len()).map(of).collect()
    }

    fn overlay_params(&self, job: &Job) -> Result<ParamsText, ItemError> {
        let bodies = &self.prepared.study.bodies;
        let without_cut_ends =
            (0..job.bodies.len()).filter(|place| bodies[job.bodies[*place].0].ignore_cut_ends).collect();
        ParamsText::of(&OverlayParams { without_cut_ends }).map_err(ItemError::of)
    }

    fn overlay_promised(
        &self,
        job: &Job,
        slot: usize,
        facts: &FrameFacts,
        matches: &[Promise<Match>],
    ) -> Result<OverlayInputs<Promised>, ItemError> {
        let models = job.bodies.iter().map(|(body, ..)| self.model(*body).map(BodyModel::promise));
        Ok(OverlayInputs {
            frame: facts.promise(),
            calibration: self.calibrated.calibrations[self.view(job, slot).0].promise(),
            models: models.collect::<Result<_, _>>()?,
            matches: matches.to_vec(),
        })
    }

    /// Draws the bodies of a frame on one of its pictures; one match a body of the job.
    ///
    /// # Errors
    /// The stage failed, or the store did.
    pub fn overlay(&self, job: &Job, slot: usize, matches: &[Hashed<Match>]) -> Done<Stored<Picture>> {
        let facts = self.picture(job, slot)?;
        let (view, name) = self.view(job, slot);
        let load = || -> Result<OverlayInputs, String> {
            let models = job.bodies.iter().map(|(body, ..)| self.load_model(*body));
            Ok(OverlayInputs {
                frame: Hashed::new(self.prepared.read(&job.pictures[slot]).map_err(|e| e.to_string())?),
                calibration: self.calibrated.calibrations[view].clone(),
                models: models.collect::<Result<_, _>>()?,
                matches: matches.to_vec(),
            })
        };
        let promises: Vec<Promise<Match>> = matches.iter().map(Hashed::promise).collect();
        let promised = self.overlay_promised(job, slot, &facts, &promises)?;
        self.store
            .execute::<Overlay, _>(
                OVERLAY,
                &self.item(job, name),
                &self.overlay_params(job)?,
                &promised,
                load,
                self.context,
            )
            .map(|done| (done.output, done.how))
            .map_err(|e| self.failed(job, Some(slot), e))
    }

    /// Why a picture would be drawn on.
    ///
    /// # Errors
    /// The picture cannot be used, or the store cannot.
    pub fn explain_overlay(
        &self,
        job: &Job,
        slot: usize,
        matches: &[Promise<Match>],
    ) -> Result<Explanation, ItemError> {
        let promised = self.overlay_promised(job, slot, &self.picture(job, slot)?, matches)?;
        let parts = KeyParts::of::<Overlay>(&self.overlay_params(job)?, &promised);
        self.explain::<Overlay>(OVERLAY, &self.item(job, self.view(job, slot).1), &parts).map(|(why, _)| why)
    }

    /// For people; a file that is not what the index of inputs said is read again next time.
    pub(crate) fn failed<S: std::fmt::Display, L: std::fmt::Display>(
        &self,
        job: &Job,
        slot: Option<usize>,
        error: ExecuteError<S, L>,
    ) -> ItemError {
        match &error {
            ExecuteError::Cancelled => return ItemError::Cancelled,
            ExecuteError::InputChanged { role } if role == "frame" => {
                if let Some(slot) = slot {
                    self.prepared.index.distrust(&job.pictures[slot].path);
                }
            }
            ExecuteError::InputChanged { .. } => {
                let files = job.bodies.iter().filter_map(|(body, ..)| self.model(*body).ok()?.file());
                files.for_each(|file| self.prepared.index.distrust(file));
            }
            _ => {}
        }
        ItemError::of(error)
    }

    /// Why a picture would be worked on, and its curves if they are there.
    ///
    /// # Errors
    /// The picture cannot be used, or the store cannot.
    pub fn explain_segment(&self, job: &Job, slot: usize) -> Explained<Curves> {
        let facts = self.picture(job, slot)?;
        let parts =
            KeyParts::of::<Segment>(&self.prepared.segment, &self.segment_promised(job, slot, &facts));
        self.explain::<Segment>(SEGMENT, &self.item(job, self.view(job, slot).1), &parts)
    }

    /// Why a body would be matched, and its match if it is there.
    ///
    /// # Errors
    /// The store cannot be read.
    pub fn explain_match(&self, job: &Job, place: usize, curves: &[Stored<Curves>]) -> Explained<Match> {
        let promised = self.match_promised(job, place, curves)?;
        let parts = KeyParts::of::<MatchBody>(&self.prepared.matching[job.bodies[place].0], &promised);
        let item = self.item(job, &self.prepared.study.bodies[job.bodies[place].0].name);
        self.explain::<MatchBody>(MATCH, &item, &parts)
    }

    pub(crate) fn explain<S: Stage>(
        &self,
        step: &str,
        item: &Item,
        parts: &KeyParts,
    ) -> Explained<S::Output> {
        let why = self.store.explain::<S>(step, item, parts).map_err(ItemError::of)?;
        let found = if why.cached() {
            self.store.get::<S::Output>(parts.key()).map_err(ItemError::of)?
        } else {
            None
        };
        Ok((why, found))
    }
}

/// Reads a stored output; a damaged one is taken away, so that the next run makes it again.
pub(crate) fn read_stored<A: Artifact>(store: &Store, stored: &Stored<A>) -> Result<Hashed<A>, String> {
    stored.load().map_err(|error| {
        if let StoreError::Damaged(damage) = &error
            && store.discard(damage.key).is_ok()
        {
            return format!("{damage}. It was taken away: run again to make it anew");
        }
        error.to_string()
    })
}
