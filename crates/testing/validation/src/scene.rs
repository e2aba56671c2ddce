//! One body over frames with poses to hold the answers against: of a study, read and segmented by the product's own code,
//! or made from known truth.
//!
//! **Never the same mesh twice:** a made scene says where its truth's shape came from, and one that claims accuracy
//! refuses a model that is the mesh of the truth ([`SceneError::SharedMesh`]).

use std::path::{Path, PathBuf};

use biplane::calibrate::{CalibrateError, calibrate};
use biplane::models::look::models;
use biplane::prepare::{InputErrors, Prepared};
use biplane::study::{Study, StudyError};
use biplane::tables::same_frame;
use biplane::walk::Way;
use biplane_acquisition::images::ImageError;
use biplane_artifact::{Calibration, Content, ContentHash, Curves, ModelMesh};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Mesh, Pose};
use biplane_optimisation::{EdgeField, MatchParams, View};
use biplane_outline::RimMesh;
use biplane_segmentation::{SegmentError, curves};
use biplane_stage::{Context, Store, StoreError};
use rayon::prelude::*;

/// One body over the frames of a study.
pub struct Scene {
    /// The mesh, mm.
    pub mesh: Mesh,
    /// The mesh as the matcher has it.
    pub rim: RimMesh,
    /// How the study finds poses.
    pub params: MatchParams,
    /// View names.
    pub names: Vec<String>,
    /// The frames that have a reference.
    pub frames: Vec<Posed>,
}

/// A frame with its views and the pose to compare with.
pub struct Posed {
    /// The frame's trial.
    pub trial: String,
    /// Its label.
    pub label: String,
    /// `world_from_model`, from somebody else.
    pub reference: Pose,
    /// One a view.
    pub views: Vec<View>,
    /// The edges that the views were made of, in recorded pixels.
    pub curves: Vec<Curves>,
}

/// Where the shape that made the pictures or outlines came from.
#[derive(Debug, Clone, PartialEq)]
pub enum Origin {
    /// A function of space.
    Solid,
    /// A mesh, with its content and number of points.
    Mesh(ContentHash, usize),
    /// A file of another program that says so.
    OtherFile,
}

impl Origin {
    /// This mesh.
    pub fn mesh(mesh: &Mesh) -> Self {
        Self::Mesh(ModelMesh(mesh.clone()).content_hash(), mesh.vertices().len())
    }
}

/// What the figures of a scene say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Claim {
    /// How near the answers are to the truth: truth and model must be different descriptions of the body.
    Accuracy,
    /// How well the search ends where it should: truth and model may be one mesh.
    SearchAlone,
}

/// How a scene of known truth was made.
#[derive(Debug, Clone, PartialEq)]
pub struct Made {
    /// Where the truth's shape came from.
    pub origin: Origin,
    /// What its figures say.
    pub claim: Claim,
    /// How poses are sought.
    pub params: MatchParams,
}

/// Why a scene could not be read.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The pipeline file.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// Its inputs.
    #[error(transparent)]
    Inputs(#[from] InputErrors),
    /// No folder to calibrate in.
    #[error("no temporary folder: {0}")]
    Folder(std::io::Error),
    /// The store in it.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// Its raw calibration pictures.
    #[error(transparent)]
    Calibrate(#[from] CalibrateError),
    /// A frame.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// A frame without edges.
    #[error(transparent)]
    Segment(#[from] SegmentError),
    /// A mesh.
    #[error("{0}")]
    Mesh(String),
    /// The body is not in the study.
    #[error("{path}: the study has no body `{body}`; it has {known}")]
    Body {
        /// The pipeline file.
        path: PathBuf,
        /// What was asked for.
        body: String,
        /// What there is.
        known: String,
    },
    /// Accuracy cannot be claimed.
    #[error(
        "truth and model are one mesh, or the truth's has no more points ({truth}) than the model's ({model}): \
         accuracy cannot be claimed"
    )]
    SharedMesh {
        /// Points of the truth's mesh.
        truth: usize,
        /// Points of the model's.
        model: usize,
    },
    /// The reference.
    #[error(
        "{path}: row {row} is not a label and the 16 numbers of a rotation and a translation, row by row"
    )]
    Reference {
        /// The file.
        path: PathBuf,
        /// Row, counting the header as 1; 0 if the file cannot be read at all.
        row: usize,
    },
}

/// Reads a CSV with a header and, a row a frame, the label and 16 numbers of `world_from_model`, row by row.
///
/// # Errors
/// The file cannot be read, or a row is something else.
pub fn read_reference(path: &Path) -> Result<Vec<(String, Pose)>, SceneError> {
    let bad = |row: usize| SceneError::Reference { path: path.to_path_buf(), row };
    let mut reader = csv::Reader::from_path(path).map_err(|_| bad(0))?;
    let mut poses = Vec::new();
    for (index, record) in reader.records().enumerate() {
        let record = record.map_err(|_| bad(index + 2))?;
        let numbers: Vec<f64> = record.iter().skip(1).filter_map(|v| v.trim().parse().ok()).collect();
        let matrix = (numbers.len() == 16).then(|| nalgebra::Matrix4::from_row_slice(&numbers));
        let pose = matrix.as_ref().and_then(Pose::from_matrix).ok_or_else(|| bad(index + 2))?;
        poses.push((record.get(0).unwrap_or_default().to_owned(), pose));
    }
    Ok(poses)
}

/// A body's mesh as it is matched: read, or made from slices in `store`.
///
/// # Errors
/// The study, its inputs or the mesh cannot be read, or it has no such body.
pub fn read_body(
    prepared: &Prepared,
    store: &Store,
    path: &Path,
    body: &str,
) -> Result<(usize, Mesh), SceneError> {
    let bodies = &prepared.study.bodies;
    let Some(index) = bodies.iter().position(|b| b.name == body) else {
        let known: Vec<&str> = bodies.iter().map(|b| b.name.as_str()).collect();
        return Err(SceneError::Body {
            path: path.to_owned(),
            body: body.to_owned(),
            known: known.join(", "),
        });
    };
    let models = models(prepared, store, &Context::new());
    let model = models.into_iter().nth(index).flatten();
    let model = model.ok_or_else(|| SceneError::Mesh(format!("the model of {body} could not be made")))?;
    Ok((index, model.load().map_err(SceneError::Mesh)?.0.clone()))
}

impl Scene {
    /// Reads and segments the frames of the study at `pipeline` that `reference` has poses of `body` for.
    ///
    /// # Errors
    /// The first thing that cannot be read.
    pub fn load(pipeline: &Path, body: &str, reference: &Path) -> Result<Self, SceneError> {
        let mut prepared = Prepared::of(Study::load(pipeline)?)?;
        // Nothing of the study's own results is used or touched: raw calibration pictures are calibrated from anew.
        let folder = tempfile::tempdir().map_err(SceneError::Folder)?;
        prepared.study.output = folder.path().join("results");
        let store = Store::open(&folder.path().join("store"))?;
        let (calibrated, _) = calibrate(&prepared, &store, &Context::new(), Way::Run(Vec::new()));
        let calibrated = calibrated?.unwrap_or_default();
        let (index, mesh) = read_body(&prepared, &store, pipeline, body)?;
        let poses = read_reference(reference)?;
        let study = &prepared.study;
        let fluoroscopes: Vec<Fluoroscope> =
            calibrated.calibrations.iter().map(|c| Fluoroscope::from(&**c)).collect();
        let wanted: Vec<_> = prepared
            .jobs
            .iter()
            .filter(|job| job.bodies.iter().any(|b| b.0 == index))
            .filter_map(|job| Some((job, poses.iter().find(|p| same_frame(&p.0, &job.label))?.1)))
            .collect();
        let frames = wanted
            .into_par_iter()
            .map(|(job, reference)| {
                let trial = &study.trials[job.trial];
                let (mut views, mut all) = (Vec::new(), Vec::new());
                for ((view, _), source) in trial.frames.iter().zip(&job.pictures) {
                    let curves = curves(&prepared.read(source)?, None, &study.segment)?;
                    let fluoroscope = fluoroscopes[*view].clone();
                    views
                        .push(View { edges: EdgeField::new(&curves, fluoroscope.distortion()), fluoroscope });
                    all.push(curves);
                }
                Ok(Posed {
                    trial: trial.name.clone(),
                    label: job.label.clone(),
                    reference,
                    views,
                    curves: all,
                })
            })
            .collect::<Result<Vec<_>, SceneError>>()?;
        let names = study.views.iter().map(|v| v.name.clone()).collect();
        Ok(Self { rim: RimMesh::new(&mesh), mesh, params: study.matching.clone(), names, frames })
    }
    /// A scene of known truth: label, true pose and curves (one a view, recorded pixels) of each frame, and the mesh to be
    /// matched.
    ///
    /// # Errors
    /// [`SceneError::SharedMesh`] where it claims accuracy without a right to.
    pub fn made(
        made: Made,
        mesh: &Mesh,
        calibrations: &[Calibration],
        frames: Vec<(String, Pose, Vec<Curves>)>,
    ) -> Result<Self, SceneError> {
        let Made { origin, claim, params } = made;
        if let (Claim::Accuracy, Origin::Mesh(hash, truth)) = (claim, origin) {
            let model = mesh.vertices().len();
            if hash == ModelMesh(mesh.clone()).content_hash() || truth <= model {
                return Err(SceneError::SharedMesh { truth, model });
            }
        }
        let fluoroscopes: Vec<Fluoroscope> = calibrations.iter().map(Fluoroscope::from).collect();
        let posed = |(label, reference, curves): (String, Pose, Vec<Curves>)| {
            let view = |(fluoroscope, curves): (&Fluoroscope, &Curves)| View {
                edges: EdgeField::new(curves, fluoroscope.distortion()),
                fluoroscope: fluoroscope.clone(),
            };
            let views = fluoroscopes.iter().zip(&curves).map(view).collect();
            Posed { trial: String::new(), label, reference, views, curves }
        };
        Ok(Self {
            rim: RimMesh::new(mesh),
            mesh: mesh.clone(),
            params,
            names: calibrations.iter().map(|c| c.view.clone()).collect(),
            frames: frames.into_iter().map(posed).collect(),
        })
    }
}
