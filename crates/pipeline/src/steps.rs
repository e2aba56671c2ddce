//! The steps of the method as items of a study: what each reads, its name in the store, how it runs and is explained.
//!
//! `segment/<trial>/<frame>/<view>` makes curves from a picture, `match/<trial>/<frame>/<body>` a pose from the curves of
//! all views, `overlay/<trial>/<frame>/<view>` a picture with the outlines of the posed bodies.

use biplane_artifact::{Artifact, Calibration, Curves, Match, Picture};
use biplane_optimisation::{MatchBody, MatchInputs};
use biplane_segmentation::{Segment, SegmentInputs};
use biplane_stage::{
    Context, ExecuteError, Explanation, Hashed, How, Item, KeyParts, Promise, Promised, Stage, Store,
    StoreError, Stored,
};

use crate::overlay::{Overlay, OverlayInputs};
use crate::prepare::{Job, Prepared};
use crate::sources::FrameFacts;
use crate::study::ViewSource;

/// Step of holes and beads in calibration pictures.
pub const SPOTS: &str = "spots";
/// Step of distortion.
pub const DISTORTION: &str = "distortion";
/// Step of the fluoroscopes.
pub const ENVIRONMENT: &str = "environment";
/// Step of drawings of the calibration.
pub const DRAWING: &str = "drawing";
/// Step of edge curves.
pub const SEGMENT: &str = "segment";
/// Step of poses.
pub const MATCH: &str = "match";
/// Step of pictures for people.
pub const OVERLAY: &str = "overlay";
/// All steps in order.
pub const STEPS: [&str; 7] = [SPOTS, DISTORTION, ENVIRONMENT, DRAWING, SEGMENT, MATCH, OVERLAY];

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
    /// One a view; none as long as they are not known.
    pub calibrations: &'a [Hashed<Calibration>],
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
        let expected = self.calibrations.get(view).map_or(facts.size, |c| c.size);
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
    pub fn segment(&self, job: &Job, slot: usize) -> Result<(Stored<Curves>, How), ItemError> {
        let facts = self.picture(job, slot)?;
        let promised = SegmentInputs::<Promised> { frame: facts.promise(), mask: Vec::new() };
        let load = || {
            self.prepared
                .read(&job.pictures[slot])
                .map(|f| SegmentInputs { frame: Hashed::new(f), mask: Vec::new() })
        };
        let item = self.item(job, self.view(job, slot).1);
        self.store
            .execute::<Segment, _>(SEGMENT, &item, &self.prepared.segment, &promised, load, self.context)
            .map(|done| (done.output, done.how))
            .map_err(|e| self.failed(job, Some(slot), e))
    }

    fn match_promised(&self, job: &Job, place: usize, curves: &[Stored<Curves>]) -> MatchInputs<Promised> {
        let (body, _, start) = &job.bodies[place];
        MatchInputs {
            curves: curves.iter().map(Stored::promise).collect(),
            calibrations: (0..curves.len())
                .map(|slot| self.calibrations[self.view(job, slot).0].promise())
                .collect(),
            model: self.prepared.meshes[*body].facts.promise(),
            start: start.promise(),
        }
    }

    /// Brings one body to its pose.
    ///
    /// # Errors
    /// The stage failed, or the store did.
    pub fn matching(
        &self,
        job: &Job,
        place: usize,
        curves: &[Stored<Curves>],
    ) -> Result<(Hashed<Match>, How), ItemError> {
        let (body, _, start) = &job.bodies[place];
        let load = || -> Result<MatchInputs, String> {
            Ok(MatchInputs {
                curves: curves.iter().map(|c| read_stored(self.store, c)).collect::<Result<_, _>>()?,
                calibrations: (0..curves.len())
                    .map(|slot| self.calibrations[self.view(job, slot).0].clone())
                    .collect(),
                model: self.prepared.meshes[*body].load()?,
                start: start.clone(),
            })
        };
        let promised = self.match_promised(job, place, curves);
        let item = self.item(job, &self.prepared.study.bodies[*body].name);
        let done = self
            .store
            .execute::<MatchBody, _>(MATCH, &item, &self.prepared.matching, &promised, load, self.context)
            .map_err(|e| self.failed(job, None, e))?;
        Ok((read_stored(self.store, &done.output).map_err(ItemError::Failed)?, done.how))
    }

    fn overlay_promised(
        &self,
        job: &Job,
        slot: usize,
        facts: &FrameFacts,
        matches: &[Promise<Match>],
    ) -> OverlayInputs<Promised> {
        OverlayInputs {
            frame: facts.promise(),
            calibration: self.calibrations[self.view(job, slot).0].promise(),
            models: job.bodies.iter().map(|(body, ..)| self.prepared.meshes[*body].facts.promise()).collect(),
            matches: matches.to_vec(),
        }
    }

    /// Draws the bodies of a frame on one of its pictures; one match a body of the job.
    ///
    /// # Errors
    /// The stage failed, or the store did.
    pub fn overlay(
        &self,
        job: &Job,
        slot: usize,
        matches: &[Hashed<Match>],
    ) -> Result<(Stored<Picture>, How), ItemError> {
        let facts = self.picture(job, slot)?;
        let (view, name) = self.view(job, slot);
        let load = || -> Result<OverlayInputs, String> {
            let models = job.bodies.iter().map(|(body, ..)| self.prepared.meshes[*body].load());
            Ok(OverlayInputs {
                frame: Hashed::new(self.prepared.read(&job.pictures[slot]).map_err(|e| e.to_string())?),
                calibration: self.calibrations[view].clone(),
                models: models.collect::<Result<_, _>>()?,
                matches: matches.to_vec(),
            })
        };
        let promises: Vec<Promise<Match>> = matches.iter().map(Hashed::promise).collect();
        let promised = self.overlay_promised(job, slot, &facts, &promises);
        self.store
            .execute::<Overlay, _>(
                OVERLAY,
                &self.item(job, name),
                &self.prepared.overlay,
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
        let promised = self.overlay_promised(job, slot, &self.picture(job, slot)?, matches);
        let parts = KeyParts::of::<Overlay>(&self.prepared.overlay, &promised);
        self.explain::<Overlay>(OVERLAY, &self.item(job, self.view(job, slot).1), &parts).map(|(why, _)| why)
    }

    /// For people; a file that is not what the index of inputs said is read again next time.
    fn failed<S: std::fmt::Display, L: std::fmt::Display>(
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
                for (body, ..) in &job.bodies {
                    self.prepared.index.distrust(self.prepared.meshes[*body].path());
                }
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
        let parts = KeyParts::of::<Segment>(
            &self.prepared.segment,
            &SegmentInputs::<Promised> { frame: facts.promise(), mask: Vec::new() },
        );
        self.explain::<Segment>(SEGMENT, &self.item(job, self.view(job, slot).1), &parts)
    }

    /// Why a body would be matched, and its match if it is there.
    ///
    /// # Errors
    /// The store cannot be read.
    pub fn explain_match(&self, job: &Job, place: usize, curves: &[Stored<Curves>]) -> Explained<Match> {
        let promised = self.match_promised(job, place, curves);
        let parts = KeyParts::of::<MatchBody>(&self.prepared.matching, &promised);
        let item = self.item(job, &self.prepared.study.bodies[job.bodies[place].0].name);
        self.explain::<MatchBody>(MATCH, &item, &parts)
    }

    fn explain<S: Stage>(&self, step: &str, item: &Item, parts: &KeyParts) -> Explained<S::Output> {
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
