//! The report's own items: `report_frame/<trial>/<frame>` is one frame of it, `report_model/<body>` a body with few enough triangles to be turned
//! with the mouse. Both come after everything else and nothing hangs on them.

use biplane_artifact::{Curves, Match, ModelMesh, ReportFrame};
use biplane_optimisation::Contrast;
use biplane_point_model::{Method, Model, ModelInputs, ModelParams};
use biplane_stage::{Explanation, Hashed, How, Item, KeyParts, ParamsText, Promise, Promised, Stored};

use super::frame::{DrawReportFrame, ReportFrameInputs, ReportFrameParams, ShownBody};
use crate::models::BodyModel;
use crate::prepare::Job;
use crate::steps::{Done, ItemError, REPORT_FRAME, REPORT_MODEL, Steps, read_stored};

/// Points of a body in the report: about twice as many triangles. The outline of a bone of 100 mm moves by some hundredths of a mm.
const POINTS: u32 = 2500;

/// A body of a frame as it is shown: its place in the trial, its match, what it was matched to.
pub type Shown<'a, M> = (usize, M, &'a [Stored<Curves>]);

impl Steps<'_> {
    /// Name of the item of a frame.
    pub fn item_of_frame(&self, job: &Job) -> Item {
        Item::of([self.prepared.study.trials[job.trial].name.as_str(), &job.label])
    }

    /// Pictures that can be read, and what of the frame is shown.
    fn report_frame_parts(
        &self,
        job: &Job,
        bodies: &[Shown<'_, Promise<Match>>],
    ) -> Result<(ParamsText, ReportFrameInputs<Promised>), ItemError> {
        let facts: Vec<_> =
            (0..job.pictures.len()).filter_map(|s| Some((s, self.picture(job, s).ok()?))).collect();
        if facts.is_empty() {
            return Err(ItemError::Failed("none of its pictures can be used".to_owned()));
        }
        let slots: Vec<usize> = facts.iter().map(|(slot, _)| *slot).collect();
        let bodies: Vec<_> =
            bodies.iter().filter(|(.., curves)| slots.iter().all(|s| *s < curves.len())).collect();
        let study = &self.prepared.study;
        let shown = |place: usize| ShownBody {
            place,
            without_cut_ends: study.bodies[job.bodies[place].0].ignore_cut_ends,
            bright: study.matching.contrast == Contrast::Bright,
        };
        let params =
            ReportFrameParams { slots: slots.clone(), bodies: bodies.iter().map(|b| shown(b.0)).collect() };
        let models = bodies.iter().map(|b| self.model(job.bodies[b.0].0).map(BodyModel::promise));
        let curves = bodies.iter().flat_map(|(.., curves)| slots.iter().map(|s| curves[*s].promise()));
        let promised = ReportFrameInputs {
            frames: facts.iter().map(|(_, facts)| facts.promise()).collect(),
            calibrations: slots
                .iter()
                .map(|s| self.calibrated.calibrations[self.view(job, *s).0].promise())
                .collect(),
            curves: curves.collect(),
            models: models.collect::<Result<_, _>>()?,
            matches: bodies.iter().map(|b| b.1).collect(),
        };
        Ok((ParamsText::of(&params).map_err(ItemError::of)?, promised))
    }

    /// Draws a frame for the report.
    ///
    /// # Errors
    /// None of its pictures can be used, the stage failed, or the store did.
    pub fn report_frame(&self, job: &Job, bodies: &[Shown<'_, Hashed<Match>>]) -> Done<Stored<ReportFrame>> {
        let promises: Vec<_> =
            bodies.iter().map(|(place, found, curves)| (*place, found.promise(), *curves)).collect();
        let (params, promised) = self.report_frame_parts(job, &promises)?;
        let slots: Vec<usize> = (0..job.pictures.len()).filter(|s| self.picture(job, *s).is_ok()).collect();
        let load = || -> Result<ReportFrameInputs, String> {
            let read = |slot: &usize| self.prepared.read(&job.pictures[*slot]).map(Hashed::new);
            let frames = slots.iter().map(|slot| read(slot).map_err(|e| e.to_string()));
            let bodies = bodies.iter().filter(|(.., curves)| slots.iter().all(|s| *s < curves.len()));
            let curves = bodies
                .clone()
                .flat_map(|(.., curves)| slots.iter().map(|s| read_stored(self.store, &curves[*s])));
            Ok(ReportFrameInputs {
                frames: frames.collect::<Result<_, _>>()?,
                calibrations: slots
                    .iter()
                    .map(|s| self.calibrated.calibrations[self.view(job, *s).0].clone())
                    .collect(),
                curves: curves.collect::<Result<_, _>>()?,
                models: bodies
                    .clone()
                    .map(|b| self.load_model(job.bodies[b.0].0))
                    .collect::<Result<_, _>>()?,
                matches: bodies.map(|b| b.1.clone()).collect(),
            })
        };
        self.store
            .execute::<DrawReportFrame, _>(
                REPORT_FRAME,
                &self.item_of_frame(job),
                &params,
                &promised,
                load,
                self.context,
            )
            .map(|done| (done.output, done.how))
            .map_err(|e| self.failed(job, None, e))
    }

    /// Why a frame would be drawn for the report.
    ///
    /// # Errors
    /// None of its pictures can be used, or the store cannot.
    pub fn explain_report_frame(
        &self,
        job: &Job,
        bodies: &[Shown<'_, Promise<Match>>],
    ) -> Result<Explanation, ItemError> {
        let (params, promised) = self.report_frame_parts(job, bodies)?;
        let parts = KeyParts::of::<DrawReportFrame>(&params, &promised);
        self.explain::<DrawReportFrame>(REPORT_FRAME, &self.item_of_frame(job), &parts).map(|(why, _)| why)
    }

    /// What a body is simplified by for the report; `None` where it has few enough points as it is.
    fn report_model_parts(
        &self,
        body: usize,
    ) -> Result<Option<(ParamsText, ModelInputs<Promised>)>, ItemError> {
        let model = self.model(body)?;
        let points = match model {
            BodyModel::File(file) => file.facts.points,
            BodyModel::Made(mesh) => mesh.0.vertices().len(),
        };
        if points <= POINTS as usize {
            return Ok(None);
        }
        let params = ModelParams {
            points: POINTS,
            method: Method::Simplified,
            keep_edges_deg: 40.0,
            max_error_mm: 0.0,
        };
        let inputs = ModelInputs::<Promised> { mesh: vec![model.promise()], surface: Vec::new() };
        Ok(Some((ParamsText::of(&params).map_err(ItemError::of)?, inputs)))
    }

    /// A body for the report, and how it was come by if a step made it.
    ///
    /// # Errors
    /// There is no model, or it cannot be simplified.
    pub fn report_model(&self, body: usize) -> Result<(Hashed<ModelMesh>, Option<How>), ItemError> {
        let whole = || self.load_model(body).map_err(ItemError::Failed);
        let Some((params, promised)) = self.report_model_parts(body)? else { return Ok((whole()?, None)) };
        let load = || self.load_model(body).map(|mesh| ModelInputs { mesh: vec![mesh], surface: Vec::new() });
        let item = Item::from(self.prepared.study.bodies[body].name.as_str());
        let done = self
            .store
            .execute::<Model, _>(REPORT_MODEL, &item, &params, &promised, load, self.context)
            .map_err(|error| match error {
                biplane_stage::ExecuteError::Cancelled => ItemError::Cancelled,
                error => ItemError::of(error),
            })?;
        Ok((read_stored(self.store, &done.output).map_err(ItemError::Failed)?, Some(done.how)))
    }

    /// Why a body would be simplified for the report; `None` where it is not.
    ///
    /// # Errors
    /// There is no model, or the store cannot be read.
    pub fn explain_report_model(&self, body: usize) -> Result<Option<Explanation>, ItemError> {
        let Some((params, promised)) = self.report_model_parts(body)? else { return Ok(None) };
        let item = Item::from(self.prepared.study.bodies[body].name.as_str());
        let parts = KeyParts::of::<Model>(&params, &promised);
        self.explain::<Model>(REPORT_MODEL, &item, &parts).map(|(why, _)| Some(why))
    }
}
