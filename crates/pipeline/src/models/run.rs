//! Makes the models of all bodies of a study and writes what people and other programs want of them.

use std::path::Path;

use biplane_artifact::{Artifact, BodyAxes, BoneSurface, Content, Picture};
use biplane_stage::{Context, Hashed, How, Store};
use rayon::prelude::*;

use super::tables::{README, axes_csv, stl};
use super::walk::{Modelled, walk};
use super::{BodyModel, MODELS};
use crate::diagnostics::slashes;
use crate::logging::Progress;
use crate::outcome::{Failure, ModelOutcome};
use crate::prepare::Prepared;
use crate::results::{copy_if_other, write_if_changed};
use crate::slices::walk::Sliced;
use crate::steps::{ItemError, MODEL};
use crate::study::{Study, SurfaceSource};
use crate::walk::Way;

/// What the bodies of a study gave.
#[derive(Debug, Default)]
pub struct ModelsRun {
    /// What is matched, one a body of the study; `None` where it could not be made.
    pub models: Vec<Option<BodyModel>>,
    /// Their axes, where they have such.
    pub axes: Vec<Option<Hashed<BodyAxes>>>,
    /// In the order of the study.
    pub outcomes: Vec<ModelOutcome>,
    /// Step and how it was done.
    pub done: Vec<(&'static str, String, How)>,
    /// Items that could not be done.
    pub failures: Vec<Failure>,
    /// Worth a look.
    pub warnings: Vec<String>,
    /// Mesh files and landmarks, and their hashes.
    pub inputs: Vec<(String, String)>,
    /// Files that were written, and their hashes.
    pub made: Vec<(String, String)>,
}

/// Runs all bodies side by side; `None` if the run was stopped. `sliced` is what was found of the study's bones.
pub fn run(prepared: &Prepared, sliced: &[Sliced], store: &Store, context: &Context) -> Option<ModelsRun> {
    let study = &prepared.study;
    let progress = Progress::new("Models", study.bodies.len(), "bodies");
    let bodies: Vec<Option<ModelsRun>> = (0..study.bodies.len())
        .into_par_iter()
        .map(|body| {
            let own =
                if context.cancelled() { None } else { of_body(prepared, body, sliced, store, context) };
            progress.tick();
            own
        })
        .collect();
    let mut all = ModelsRun::default();
    for body in bodies {
        let ModelsRun { models, axes, outcomes, done, failures, warnings, inputs, made } = body?;
        all.models.extend(models);
        all.axes.extend(axes);
        all.outcomes.extend(outcomes);
        all.done.extend(done);
        all.failures.extend(failures);
        all.warnings.extend(warnings);
        all.inputs.extend(inputs);
        all.made.extend(made);
    }
    if !all.made.is_empty() {
        all.write(study, "README.txt", README.as_bytes().to_vec(), MODELS);
    }
    Some(all)
}

fn of_body(
    prepared: &Prepared,
    body: usize,
    sliced: &[Sliced],
    store: &Store,
    context: &Context,
) -> Option<ModelsRun> {
    let study = &prepared.study;
    let name = &study.bodies[body].name;
    let (found, walk) = walk(prepared, body, sliced, store, context, Way::Run(Vec::new()));
    let mut all = ModelsRun { failures: walk.faults, ..ModelsRun::default() };
    if let Way::Run(done) = walk.way {
        all.done = done;
    }
    let found = match found {
        Ok(found) => found,
        Err(ItemError::Cancelled) => return None,
        Err(ItemError::Failed(message)) => {
            all.failures.push(Failure { item: format!("{MODEL}/{name}"), message: study.shorten(&message) });
            Modelled::default()
        }
    };
    for mesh in [&prepared.meshes[body], &prepared.references[body]].into_iter().flatten() {
        all.inputs.push((study.relative(mesh.path()), mesh.facts.hash().to_hex()));
    }
    if let Some(landmarks) = &prepared.landmarks[body] {
        all.inputs.push((study.relative(&landmarks.path), landmarks.points.hash().to_hex()));
    }
    let mut outcome = ModelOutcome::of(study, body, &found);
    if let Some(surface) = &found.surface {
        all.warnings.extend(of_surface(name, surface));
    }
    if let Some(axes) = &found.axes {
        all.warnings.extend(axes.warnings.iter().map(|w| format!("axes of {name}: {w}")));
        all.write(study, &format!("{name}_axes.csv"), axes_csv(axes), name);
        all.write(study, &format!("{name}_axes.json"), axes.encode(), name);
    }
    if let Some(BodyModel::Made(mesh)) = &found.model {
        all.write(study, &format!("{name}.stl"), stl(&mesh.0), name);
        all.write(study, &format!("{name}.ply"), mesh.encode(), name);
    }
    if let Some(stored) = &found.sheet {
        let place = Path::new(MODELS).join(format!("{name}.svg"));
        let to = study.output.join(&place);
        match copy_if_other(stored, &to).and_then(|()| std::fs::read(&to)) {
            Ok(bytes) => {
                all.made.push((slashes(&place), Picture(bytes).content_hash().to_hex()));
                outcome.sheet = Some(place);
            }
            Err(error) => all.failed(study, &place, name, &error),
        }
    }
    all.warnings.iter_mut().for_each(|w| *w = study.shorten(w));
    all.models.push(found.model);
    all.axes.push(found.axes);
    all.outcomes.push(outcome);
    Some(all)
}

/// What a person should know of a surface made from slices.
fn of_surface(name: &str, surface: &BoneSurface) -> Vec<String> {
    let report = &surface.report;
    let faults = report.faults.iter().map(|fault| match fault.slice {
        Some(slice) => format!("surface of {name}, slice {slice}: {}", fault.what),
        None => format!("surface of {name}: {}", fault.what),
    });
    faults.chain(report.warnings.iter().map(|w| format!("surface of {name}: {w}"))).collect()
}

impl ModelsRun {
    /// Writes one file of a body to the results, and remembers it.
    fn write(&mut self, study: &Study, file: &str, bytes: Vec<u8>, body: &str) {
        let place = Path::new(MODELS).join(file);
        match write_if_changed(&study.output.join(&place), &bytes) {
            Ok(_) => self.made.push((slashes(&place), Picture(bytes).content_hash().to_hex())),
            Err(error) => self.failed(study, &place, body, &error),
        }
    }

    fn failed(&mut self, study: &Study, place: &Path, body: &str, error: &std::io::Error) {
        let message = study.shorten(&format!("cannot write {}: {error}", slashes(&study.output.join(place))));
        self.failures.push(Failure { item: format!("{MODEL}/{body}"), message });
    }
}

impl ModelOutcome {
    /// Counts what was made of a body.
    fn of(study: &Study, number: usize, found: &Modelled) -> Self {
        let body = &study.bodies[number];
        let from = match &body.surface {
            SurfaceSource::File(mesh) => study.relative(&mesh.path),
            SurfaceSource::Contours(bone, _) => format!("slices of {}", study.slices[*bone].name),
            SurfaceSource::Labels(bone, params) => {
                format!("label {} of {}", params.label, study.relative(&study.slices[*bone].volume))
            }
        };
        let [points, triangles] = match &found.model {
            Some(BodyModel::File(file)) => [file.facts.points, file.facts.triangles],
            Some(BodyModel::Made(mesh)) => [mesh.0.vertices().len(), mesh.0.triangles().len()],
            None => [0, 0],
        };
        Self {
            body: number,
            from,
            points,
            triangles,
            made: matches!(found.model, Some(BodyModel::Made(_))),
            surface: found.surface.as_ref().map(|s| s.report.clone()),
            axes: found.axes.as_ref().map(|a| (a.source, a.side)),
            sheet: None,
        }
    }
}
