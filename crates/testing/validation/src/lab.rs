//! What every section measures with: the phantom knee, the two fluoroscopes, the effort and the seed.

use std::path::{Path, PathBuf};

use biplane_artifact::Curves;
use biplane_geometry::{Mesh, Pose};
use biplane_lofting::LoftParams;
use biplane_optimisation::{BinghamParams, EdgeBias, MatchParams};
use biplane_phantom::{Body, TrueFluoroscope, ideal_outline};
use rayon::prelude::*;

use crate::knee::{Posture, Workshop};
use crate::scene::{Claim, Made, Origin};
use crate::sliced::{contours_of_mri, loft, model};
use crate::{Scene, SceneError};

/// How much is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// A minute or two: the default method, fewer frames.
    Quick,
    /// Everything.
    Full,
}

/// The bench on which sections measure.
#[derive(Debug)]
pub struct Lab {
    /// The project's folder: fixtures are below it.
    pub root: PathBuf,
    /// How much is measured.
    pub effort: Effort,
    /// Seed of all that is drawn.
    pub seed: u64,
    /// Meshes of the phantom.
    pub workshop: Workshop,
}

/// Frames of known truth: label, pose, the curves of each view.
pub type Frames = Vec<(String, Pose, Vec<Curves>)>;

/// Distance of the points of ideal outlines, px.
const OUTLINE_STEP_PX: f64 = 0.5;

impl Lab {
    /// A bench.
    pub fn new(root: &Path, effort: Effort, seed: u64) -> Self {
        Self { root: root.to_owned(), effort, seed, workshop: Workshop::default() }
    }

    /// The first number for a full run, the second for a quick one.
    pub fn count(&self, full: usize, quick: usize) -> usize {
        match self.effort {
            Effort::Full => full,
            Effort::Quick => quick,
        }
    }

    /// Whether this is a full run.
    pub fn full(&self) -> bool {
        self.effort == Effort::Full
    }

    /// Ideal outlines of a body in postures, straight from its solid.
    pub fn outlines(&self, body: Body, postures: &[(String, Posture)], views: &[TrueFluoroscope]) -> Frames {
        postures
            .par_iter()
            .map(|(label, posture)| {
                let pose = posture.pose(body);
                let seen = |view| Curves(ideal_outline(body.solid(), &pose, view, OUTLINE_STEP_PX));
                (label.clone(), pose, views.iter().map(seen).collect())
            })
            .collect()
    }

    /// The model of so many points that the stages make of a bone's simulated MRI: sagittal slices of 1 mm, pixels of 0.5 mm, the usual
    /// faults.
    ///
    /// # Errors
    /// The body is no bone, or a stage's own.
    pub fn scanned(&self, body: Body, points: u32) -> Result<Mesh, SceneError> {
        let contours = contours_of_mri(body, 0.5, 1.0, self.seed)?;
        model(loft(&contours, &LoftParams::default())?, points)
    }

    /// A scene of ideal outlines and a mesh of `points`, claiming accuracy.
    ///
    /// # Errors
    /// The body cannot be meshed.
    pub fn ideal(
        &self,
        body: Body,
        points: usize,
        views: &[TrueFluoroscope],
        frames: Frames,
    ) -> Result<Scene, SceneError> {
        self.ideal_with(&*self.workshop.surface(body, points)?, views, frames)
    }

    /// A scene of ideal outlines and a mesh, claiming accuracy.
    ///
    /// # Errors
    /// The mesh made the truth.
    pub fn ideal_with(
        &self,
        mesh: &Mesh,
        views: &[TrueFluoroscope],
        frames: Frames,
    ) -> Result<Scene, SceneError> {
        let made = Made { origin: Origin::Solid, claim: Claim::Accuracy, params: ideal_params() };
        Scene::made(made, mesh, &calibrations(views), frames)
    }
}

/// The views' calibrations as they truly are, called A, B and so on.
pub fn calibrations(views: &[TrueFluoroscope]) -> Vec<biplane_artifact::Calibration> {
    views.iter().zip("ABCDEFGH".chars()).map(|(v, name)| v.calibration(&name.to_string())).collect()
}

/// The default, but it looks for edges as far as starts of set A are off: there are none but the body's.
pub fn ideal_params() -> MatchParams {
    MatchParams { search_px: 200.0, ..MatchParams::default() }
}

/// The same for outlines that are no edges of X-ray pictures, and so do not lie inside the body's.
pub fn unbiased_params() -> MatchParams {
    MatchParams { edge_bias: EdgeBias::None, ..ideal_params() }
}

/// The thesis's settings.
pub fn thesis_params() -> BinghamParams {
    BinghamParams::default()
}
