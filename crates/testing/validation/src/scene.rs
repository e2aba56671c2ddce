//! A recorded or simulated trial with reference poses, read and segmented by the product's own code.

use std::path::{Path, PathBuf};

use biplane_acquisition::calibration::{CalibrationError, read_calibration, read_distortion_csv};
use biplane_acquisition::images::{ImageError, read_frame};
use biplane_acquisition::meshes::{LengthUnit, MeshFileError, read_mesh};
use biplane_artifact::{Curves, PixelOrigin};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Mesh, Pose};
use biplane_optimisation::{EdgeField, View};
use biplane_outline::RimMesh;
use biplane_segmentation::{SegmentParams, find_edges, link};
use rayon::prelude::*;

/// The files of one view.
#[derive(Debug, Clone)]
pub struct ViewFiles {
    /// The view's name.
    pub name: String,
    /// Its calibration.
    pub calibration: PathBuf,
    /// Samples of its distortion, if its pictures are not corrected.
    pub distortion: Option<PathBuf>,
    /// Folder of its frames, named by the reference's labels.
    pub frames: PathBuf,
    /// Extension of its frames.
    pub extension: String,
}

/// The files of a scene.
#[derive(Debug, Clone)]
pub struct SceneFiles {
    /// One or more views.
    pub views: Vec<ViewFiles>,
    /// Where the calibrations count pixels from.
    pub pixel_origin: PixelOrigin,
    /// The body, mm.
    pub mesh: PathBuf,
    /// CSV with a header, a row a frame: label and 16 numbers of `world_from_model`, row by row.
    pub reference: PathBuf,
}

/// One body over the frames of a scene.
pub struct Scene {
    /// The mesh.
    pub mesh: Mesh,
    /// The mesh as the matcher has it.
    pub rim: RimMesh,
    /// View names.
    pub names: Vec<String>,
    /// Label, reference pose and views of each frame.
    pub frames: Vec<(String, Pose, Vec<View>)>,
}

/// Why a scene could not be read.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// A calibration.
    #[error(transparent)]
    Calibration(#[from] CalibrationError),
    /// A frame.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// The mesh.
    #[error(transparent)]
    Mesh(#[from] MeshFileError),
    /// The reference.
    #[error("{path}: row {row} is not a label and a 4x4 matrix of a rotation and a translation")]
    Reference {
        /// The file.
        path: PathBuf,
        /// Row, counting the header as 1; 0 if the file cannot be read at all.
        row: usize,
    },
}

/// Reads a table of labels and 4x4 matrices.
fn read_reference(path: &Path) -> Result<Vec<(String, Pose)>, SceneError> {
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

impl Scene {
    /// Reads and segments everything.
    ///
    /// # Errors
    /// The first file that cannot be read.
    pub fn load(files: &SceneFiles, segment: &SegmentParams) -> Result<Self, SceneError> {
        let mesh = read_mesh(&files.mesh, LengthUnit::Millimetres)?.model.0;
        let mut fluoroscopes = Vec::new();
        for view in &files.views {
            let mut calibration = read_calibration(&view.calibration, &view.name, files.pixel_origin)?;
            if let Some(path) = &view.distortion {
                calibration.distortion = Some(read_distortion_csv(path)?);
            }
            fluoroscopes.push(Fluoroscope::from(&calibration));
        }
        let frames = read_reference(&files.reference)?
            .into_par_iter()
            .map(|(label, pose)| {
                let views = files
                    .views
                    .iter()
                    .zip(&fluoroscopes)
                    .map(|(view, fluoroscope)| {
                        let frame = read_frame(view.frames.join(format!("{label}.{}", view.extension)), 0)?;
                        let scale = 255.0 / ((1_u32 << frame.bits) - 1) as f32;
                        let samples = frame.samples.iter().map(|&s| f32::from(s) * scale).collect();
                        let map = find_edges(frame.width, frame.height, samples, segment);
                        let curves = Curves::rounded(link(&map, segment.min_points));
                        let edges = EdgeField::new(&curves, fluoroscope.distortion());
                        Ok(View { fluoroscope: fluoroscope.clone(), edges })
                    })
                    .collect::<Result<Vec<_>, SceneError>>()?;
                Ok((label, pose, views))
            })
            .collect::<Result<Vec<_>, SceneError>>()?;
        let rim = RimMesh::new(&mesh);
        Ok(Self { mesh, rim, names: files.views.iter().map(|v| v.name.clone()).collect(), frames })
    }
}
