//! One body from its mesh file, contours or labels to the model that is matched, its axes and its sheet: run, or looked at.

use std::path::PathBuf;
use std::sync::Arc;

use biplane_artifact::{BodyAxes, BoneSurface, ModelMesh, SliceContours};
use biplane_axes::{Axes, AxesInputs};
use biplane_label_surface::{LabelSurface, LabelSurfaceInputs};
use biplane_lofting::{Loft, LoftInputs};
use biplane_point_model::{Model, ModelInputs};
use biplane_stage::{Context, Hashed, Item, ParamsText, Promised, Store};

use super::{BodyModel, MODELS, MeshOfFile};
use crate::drawings::{DrawModel, ModelDrawingInputs, ModelDrawingParams};
use crate::prepare::Prepared;
use crate::slices::walk::{Sliced, read};
use crate::steps::{AXES, DRAWING, ItemError, LABEL_SURFACE, LOFT, MODEL};
use crate::study::{Body, SurfaceSource};
use crate::walk::{Walk, Way};

/// What was made of one body, as far as it is there.
#[derive(Debug, Default)]
pub struct Modelled {
    /// Made from slices.
    pub surface: Option<Hashed<BoneSurface>>,
    /// The contours that it was made from.
    pub contours: Option<Hashed<SliceContours>>,
    /// What is matched.
    pub model: Option<BodyModel>,
    /// Its local coordinate system.
    pub axes: Option<Hashed<BodyAxes>>,
    /// Where the sheet is stored.
    pub sheet: Option<PathBuf>,
}

/// Walks over the steps of a body; what became of each is in the walk. `sliced` is what was found of the study's bones.
///
/// # Errors
/// The run was stopped, or the store cannot be used.
pub fn walk<'a>(
    prepared: &'a Prepared,
    body: usize,
    sliced: &[Sliced],
    store: &'a Store,
    context: &'a Context,
    way: Way,
) -> (Result<Modelled, ItemError>, Walk<'a>) {
    let mut walk = Walk::new(&prepared.study, store, context, way);
    let found = of_body(prepared, body, sliced, &mut walk);
    if walk.input_changed {
        let file = prepared.meshes[body].as_ref().map(|mesh| mesh.path().to_owned());
        let bone = prepared.study.bodies[body].surface.bone();
        let volume = bone.map(|bone| prepared.study.slices[bone].volume.clone());
        let reference = prepared.references[body].as_ref().map(|mesh| mesh.path().to_owned());
        for path in [file, volume, reference].into_iter().flatten() {
            prepared.index.distrust(&path);
        }
    }
    (found, walk)
}

fn of_body(
    prepared: &Prepared,
    number: usize,
    sliced: &[Sliced],
    walk: &mut Walk<'_>,
) -> Result<Modelled, ItemError> {
    let body = &prepared.study.bodies[number];
    let mut made = Modelled::default();
    let from = match &prepared.meshes[number] {
        Some(file) => Some(From::File(Arc::clone(file))),
        None => {
            let surface = surface(prepared, body, sliced, walk, &mut made)?;
            surface.map(|surface| {
                made.surface = Some(surface.clone());
                From::Slices(surface)
            })
        }
    };
    let item = Item::of([body.name.as_str()]);
    let of_sheet = Item::of([MODELS, body.name.as_str()]);
    made.model = match from {
        None => {
            walk.follows(MODEL, &item);
            None
        }
        Some(from) => model(body, from, &item, walk)?,
    };
    let Some(matched) = made.model.clone() else {
        if body.axes.is_some() {
            walk.follows(AXES, &item);
        }
        walk.follows(DRAWING, &of_sheet);
        return Ok(made);
    };
    if let Some(wanted) = &body.axes {
        let params = ParamsText::of(wanted).map_err(ItemError::of)?;
        let landmarks = prepared.landmarks[number].as_ref();
        let promised = AxesInputs::<Promised> {
            model: matched.promise(),
            landmarks: landmarks.iter().map(|l| l.points.promise()).collect(),
        };
        let load = || {
            let landmarks = landmarks.iter().map(|l| l.points.clone()).collect();
            Ok(AxesInputs { model: matched.load()?, landmarks })
        };
        let found = walk.step::<Axes>(AXES, &item, &params, &promised, load)?;
        made.axes = found.map(|(axes, _)| axes);
        if made.axes.is_none() && matches!(walk.way, Way::Look(_)) {
            walk.follows(DRAWING, &of_sheet);
            return Ok(made);
        }
    }
    made.sheet = sheet(prepared, number, &made, &matched, &of_sheet, walk)?;
    Ok(made)
}

/// Where a model begins.
enum From {
    File(Arc<MeshOfFile>),
    Slices(Hashed<BoneSurface>),
}

/// The surface of a body from the slices of a bone.
fn surface(
    prepared: &Prepared,
    body: &Body,
    sliced: &[Sliced],
    walk: &mut Walk<'_>,
    made: &mut Modelled,
) -> Result<Option<Hashed<BoneSurface>>, ItemError> {
    let item = Item::of([body.name.as_str()]);
    let bone = body.surface.bone();
    let found = bone.and_then(|bone| sliced.get(bone));
    made.contours = found.and_then(|f| f.contours.clone());
    match &body.surface {
        SurfaceSource::File(_) => Ok(None),
        SurfaceSource::Contours(_, params) => {
            let Some(contours) = made.contours.clone() else {
                walk.follows(LOFT, &item);
                return Ok(None);
            };
            let params = ParamsText::of(params).map_err(ItemError::of)?;
            let found = walk.ready::<Loft>(LOFT, &item, &params, LoftInputs { contours })?;
            Ok(found.map(|(surface, _)| surface))
        }
        SurfaceSource::Labels(bone, params) => {
            let Some(facts) = found.and_then(|f| f.facts.as_ref()) else {
                walk.follows(LABEL_SURFACE, &item);
                return Ok(None);
            };
            let params = ParamsText::of(params).map_err(ItemError::of)?;
            let promised = LabelSurfaceInputs::<Promised> { volume: facts.promise() };
            let load = || Ok(LabelSurfaceInputs { volume: read(&prepared.study.slices[*bone])?.0 });
            let found = walk.step::<LabelSurface>(LABEL_SURFACE, &item, &params, &promised, load)?;
            Ok(found.map(|(surface, _)| surface))
        }
    }
}

/// The model that is matched.
fn model(body: &Body, from: From, item: &Item, walk: &mut Walk<'_>) -> Result<Option<BodyModel>, ItemError> {
    let wanted = match (&body.model, &from) {
        (None, From::File(file)) => return Ok(Some(BodyModel::File(Arc::clone(file)))),
        (wanted, _) => wanted.unwrap_or_default(),
    };
    let params = ParamsText::of(&wanted).map_err(ItemError::of)?;
    let promised = match &from {
        From::File(file) => ModelInputs::<Promised> { mesh: vec![file.facts.promise()], surface: Vec::new() },
        From::Slices(surface) => {
            ModelInputs::<Promised> { mesh: Vec::new(), surface: vec![surface.promise()] }
        }
    };
    let load = || {
        Ok(match &from {
            From::File(file) => ModelInputs { mesh: vec![file.load()?], surface: Vec::new() },
            From::Slices(surface) => ModelInputs { mesh: Vec::new(), surface: vec![surface.clone()] },
        })
    };
    let found = walk.step::<Model>(MODEL, item, &params, &promised, load)?;
    Ok(found.map(|(mesh, _): (Hashed<ModelMesh>, PathBuf)| BodyModel::Made(mesh)))
}

/// The sheet that shows the model, with what it was made from.
fn sheet(
    prepared: &Prepared,
    number: usize,
    made: &Modelled,
    model: &BodyModel,
    item: &Item,
    walk: &mut Walk<'_>,
) -> Result<Option<PathBuf>, ItemError> {
    let body = &prepared.study.bodies[number];
    let reference = prepared.references[number].as_ref();
    let params = ParamsText::of(&ModelDrawingParams { body: body.name.clone() }).map_err(ItemError::of)?;
    let (axes, contours, surface) = (made.axes.as_ref(), made.contours.as_ref(), made.surface.as_ref());
    let promised = ModelDrawingInputs::<Promised> {
        model: model.promise(),
        axes: axes.iter().map(|a| a.promise()).collect(),
        contours: contours.iter().map(|c| c.promise()).collect(),
        surface: surface.iter().map(|s| s.promise()).collect(),
        reference: reference.iter().map(|r| r.facts.promise()).collect(),
    };
    let load = || {
        Ok(ModelDrawingInputs {
            model: model.load()?,
            axes: axes.cloned().into_iter().collect(),
            contours: contours.cloned().into_iter().collect(),
            surface: surface.cloned().into_iter().collect(),
            reference: reference.map(|r| r.load()).transpose()?.into_iter().collect(),
        })
    };
    let found = walk.step::<DrawModel>(DRAWING, item, &params, &promised, load)?;
    Ok(found.map(|(_, stored)| stored))
}
