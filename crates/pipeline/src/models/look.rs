//! What would become of the slices of all bones and the models of all bodies, and the models that are there.

use biplane_artifact::BodyAxes;
use biplane_stage::{Context, Hashed, Store};

use super::BodyModel;
use super::walk::walk;
use crate::look::{Fate, Look};
use crate::prepare::Prepared;
use crate::slices;
use crate::slices::walk::Sliced;
use crate::steps::{MODEL, SLICES};
use crate::walk::Way;

/// The models of all bodies, made where they are not in the store. What cannot be made is `None`.
pub fn models(prepared: &Prepared, store: &Store, context: &Context) -> Vec<Option<BodyModel>> {
    let run = || Way::Run(Vec::new());
    let bones = 0..prepared.study.slices.len();
    let sliced =
        bones.map(|bone| slices::walk::walk(prepared, bone, store, context, run()).0.unwrap_or_default());
    let sliced: Vec<Sliced> = sliced.collect();
    let bodies = 0..prepared.study.bodies.len();
    bodies.map(|body| walk(prepared, body, &sliced, store, context, run()).0.ok()?.model).collect()
}

/// What of a body is in the store: its model and its axes.
pub type InStore = (Vec<Option<BodyModel>>, Vec<Option<Hashed<BodyAxes>>>);

/// Looks at bones and bodies in the order of the study, and gives each body's model and axes where they are in the store.
pub fn look(prepared: &Prepared, store: &Store, context: &Context, looks: &mut Vec<Look>) -> InStore {
    let study = &prepared.study;
    let fails = |step, name: &str, error: &dyn std::fmt::Display| Look {
        step,
        fate: Fate::Fails,
        line: study.shorten(&format!("{step}/{name}: {error}")),
    };
    let mut sliced = Vec::new();
    for (number, bone) in study.slices.iter().enumerate() {
        let (found, walk) = slices::walk::walk(prepared, number, store, context, Way::Look(Vec::new()));
        if let Way::Look(own) = walk.way {
            looks.extend(own);
        }
        sliced.push(found.unwrap_or_else(|error| {
            looks.push(fails(SLICES, &bone.name, &error));
            Sliced::default()
        }));
    }
    let (mut models, mut axes) = (Vec::new(), Vec::new());
    for (number, body) in study.bodies.iter().enumerate() {
        let (found, walk) = walk(prepared, number, &sliced, store, context, Way::Look(Vec::new()));
        if let Way::Look(own) = walk.way {
            looks.extend(own);
        }
        let (model, own) = match found {
            Ok(found) => (found.model, found.axes),
            Err(error) => {
                looks.push(fails(MODEL, &body.name, &error));
                (None, None)
            }
        };
        models.push(model);
        axes.push(own);
    }
    (models, axes)
}
