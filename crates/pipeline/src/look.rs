//! What a run would do, without doing it: `plan` and `explain`.

use biplane_stage::{Context, Store, StoreError};
use rayon::prelude::*;

use crate::prepare::{InputErrors, Job, Prepared};
use crate::steps::{MATCH, SEGMENT, Steps};
use crate::study::Study;
use crate::summary::aligned;

/// Why nothing can be said.
#[derive(Debug, thiserror::Error)]
pub enum LookError {
    /// Inputs that everything hangs on are wrong.
    #[error(transparent)]
    Inputs(#[from] InputErrors),
    /// The store cannot be used.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// What would become of one item.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fate {
    /// It is in the store.
    Cached,
    /// It would run.
    Runs,
    /// It would run if what it follows comes out differently.
    Follows,
    /// It cannot be done.
    Fails,
}

/// One item, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Look {
    /// The step.
    pub step: &'static str,
    /// What would become of it.
    pub fate: Fate,
    /// `step/trial/frame/...: why`
    pub line: String,
}

/// Looks at every item of a study, in the order of trials and frames.
///
/// # Errors
/// Inputs that everything hangs on are wrong, or the store cannot be used.
pub fn look(study: Study) -> Result<Vec<Look>, LookError> {
    let prepared = Prepared::of(study)?;
    let store = Store::open(&prepared.study.hidden())?;
    let context = Context::new();
    let steps = Steps { prepared: &prepared, store: &store, context: &context };
    let looks: Vec<Vec<Look>> = prepared.jobs.par_iter().map(|job| look_at(&steps, job)).collect();
    if let Err(error) = prepared.index.save(false) {
        tracing::debug!("the index of inputs was not written: {error}");
    }
    Ok(looks.into_iter().flatten().collect())
}

fn look_at(steps: &Steps<'_>, job: &Job) -> Vec<Look> {
    let study = &steps.prepared.study;
    let mut looks = Vec::new();
    let mut curves = Vec::new();
    for slot in 0..job.pictures.len() {
        let item = steps.item(job, steps.view(job, slot).1);
        let (fate, line) = match steps.explain_segment(job, slot) {
            Ok((why, stored)) => {
                let fate = if why.cached() { Fate::Cached } else { Fate::Runs };
                curves.extend(stored);
                (fate, why.to_string())
            }
            Err(error) => (Fate::Fails, format!("{SEGMENT}/{item}: {}", study.shorten(&error.to_string()))),
        };
        looks.push(Look { step: SEGMENT, fate, line });
    }
    let fails = looks.iter().any(|l| l.fate == Fate::Fails);
    for (place, (body, _, _)) in job.bodies.iter().enumerate() {
        let item = steps.item(job, &study.bodies[*body].name);
        let (fate, line) = if fails {
            (Fate::Fails, format!("{MATCH}/{item}: cannot run, a picture of its frame fails"))
        } else if curves.len() < job.pictures.len() && !steps.ever_made(MATCH, &item) {
            (Fate::Runs, format!("{MATCH}/{item}: never ran"))
        } else if curves.len() < job.pictures.len() {
            (Fate::Follows, format!("{MATCH}/{item}: runs if its curves come out differently"))
        } else {
            match steps.explain_match(job, place, &curves) {
                Ok(why) => (if why.cached() { Fate::Cached } else { Fate::Runs }, why.to_string()),
                Err(error) => (Fate::Fails, format!("{MATCH}/{item}: {}", study.shorten(&error.to_string()))),
            }
        };
        looks.push(Look { step: MATCH, fate, line });
    }
    looks
}

/// Counts a step.
pub fn counts(looks: &[Look]) -> String {
    let rows = [SEGMENT, MATCH].into_iter().map(|step| {
        let of = |fate| looks.iter().filter(|l| l.step == step && l.fate == fate).count().to_string();
        vec![step.to_owned(), of(Fate::Cached), of(Fate::Runs), of(Fate::Follows), of(Fate::Fails)]
    });
    aligned(
        &["step", "cached", "to run", "to run if what comes before changes", "cannot run"],
        rows,
        &[1, 2, 3, 4],
    )
}
