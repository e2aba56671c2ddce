//! A walk over steps of the method that serves both running and looking, so that what `explain` says is what `run` does.

use std::path::PathBuf;

use biplane_stage::{
    Context, ExecuteError, Hashed, How, Inputs, Item, KeyParts, ParamsText, Stage, Store, Stored,
};

use crate::look::{Fate, Look};
use crate::outcome::Failure;
use crate::steps::{ItemError, read_stored};
use crate::study::Study;

/// Whether steps run, or are looked at.
#[derive(Debug)]
pub enum Way {
    /// Name of a step, of an item, and how it was done.
    Run(Vec<(&'static str, String, How)>),
    /// What would become of each item.
    Look(Vec<Look>),
}

/// Runs steps, or looks at them, and remembers what became of each.
#[derive(Debug)]
pub struct Walk<'a> {
    study: &'a Study,
    store: &'a Store,
    context: &'a Context,
    /// What was done, or would be.
    pub way: Way,
    /// Items that could not be done, and why; none where steps are looked at.
    pub faults: Vec<Failure>,
    /// Whether an input held something else than the index of inputs says.
    pub input_changed: bool,
}

/// The output of a step and its file; none where it is not there, or cannot be.
pub type Stepped<A> = Result<Option<(Hashed<A>, PathBuf)>, ItemError>;

impl<'a> Walk<'a> {
    /// At its beginning.
    pub fn new(study: &'a Study, store: &'a Store, context: &'a Context, way: Way) -> Self {
        Self { study, store, context, way, faults: Vec::new(), input_changed: false }
    }

    /// A step whose inputs are all at hand.
    ///
    /// # Errors
    /// The run was stopped, or the store cannot be used.
    pub fn ready<S: Stage>(
        &mut self,
        step: &'static str,
        item: &Item,
        params: &ParamsText,
        inputs: S::Inputs,
    ) -> Stepped<S::Output> {
        let hashes = inputs.hashes();
        self.step::<S>(step, item, params, &hashes, || Ok(inputs))
    }

    /// Runs a step and gives its output, or looks whether it is there; `None` where it is not, or cannot be.
    ///
    /// # Errors
    /// The run was stopped, or the store cannot be used.
    pub fn step<S: Stage>(
        &mut self,
        step: &'static str,
        item: &Item,
        params: &ParamsText,
        hashes: &<S::Inputs as Inputs>::Hashes,
        load: impl FnOnce() -> Result<S::Inputs, String>,
    ) -> Stepped<S::Output> {
        let stored: Stored<S::Output> = match &mut self.way {
            Way::Run(done) => {
                let outcome = self.store.execute::<S, _>(step, item, params, hashes, load, self.context);
                match outcome {
                    Ok(outcome) => {
                        done.push((step, format!("{step}/{item}"), outcome.how));
                        outcome.output
                    }
                    Err(ExecuteError::Cancelled) => return Err(ItemError::Cancelled),
                    Err(error) => {
                        self.input_changed |= matches!(error, ExecuteError::InputChanged { .. });
                        return self.fault(step, item, &error);
                    }
                }
            }
            Way::Look(looks) => {
                let parts = KeyParts::of::<S>(params, hashes);
                let why = self.store.explain::<S>(step, item, &parts).map_err(ItemError::of)?;
                let fate = if why.cached() { Fate::Cached } else { Fate::Runs };
                looks.push(Look { step, fate, line: why.to_string() });
                match self.store.get::<S::Output>(parts.key()).ok().flatten() {
                    Some(stored) => stored,
                    None => return Ok(None),
                }
            }
        };
        let value = read_stored(self.store, &stored).map_err(ItemError::Failed)?;
        Ok(Some((value, stored.path().to_owned())))
    }

    /// Keeps a fault, and goes on with what does not need the item.
    ///
    /// # Errors
    /// Never; the signature is that of a step.
    pub fn fault<T>(
        &mut self,
        step: &'static str,
        item: &Item,
        why: &dyn std::fmt::Display,
    ) -> Result<Option<T>, ItemError> {
        let (item, message) = (format!("{step}/{item}"), self.study.shorten(&why.to_string()));
        match &mut self.way {
            Way::Look(looks) => {
                looks.push(Look { step, fate: Fate::Fails, line: format!("{item}: {message}") })
            }
            Way::Run(_) => self.faults.push(Failure { item, message }),
        }
        Ok(None)
    }

    /// An item that cannot be looked at before what it follows has run.
    pub fn follows(&mut self, step: &'static str, item: &Item) {
        let before = self.store.link_path(step, item).symlink_metadata().is_ok();
        if let Way::Look(looks) = &mut self.way {
            looks.push(Look::after(step, item, before));
        }
    }
}
