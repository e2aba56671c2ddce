//! X-ray pictures of the phantom knee, and what the product's segmentation makes of them.

use std::sync::Arc;

use biplane_artifact::{Calibration, Curves, Frame};
use biplane_geometry::{Mesh, Point3, Pose};
use biplane_phantom::{
    Absorber, Body, Ellipsoid, Exposure, Material, PosedBody, Surface, TrueFluoroscope, picture,
};
use biplane_segmentation::{SegmentParams, curves};
use rayon::prelude::*;

use crate::knee::{FINEST, Posture};
use crate::lab::{Frames, Lab};
use crate::scene::{Claim, Made, Origin};
use crate::{Scene, SceneError};
use biplane_optimisation::MatchParams;

/// What is in the beam.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Knee {
    /// Femoral component and tray on bones.
    Implants,
    /// Femur, tibia and patella.
    Natural,
}

impl Knee {
    /// The bodies whose poses are sought.
    pub fn bodies(self) -> [Body; 2] {
        match self {
            Self::Implants => [Body::FemoralComponent, Body::TibialTray],
            Self::Natural => [Body::DistalFemur, Body::ProximalTibia],
        }
    }

    /// All bodies whose shadows are in the pictures, those that are sought first: each with its size and its pose.
    pub fn shadows(self, posture: &Posture) -> Vec<(Body, f64, Pose)> {
        let mut all: Vec<_> = self.bodies().map(|body| (body, 1.0, posture.pose(body))).into();
        match self {
            Self::Implants => all.extend(
                Self::Natural
                    .bodies()
                    .map(|bone| (bone, BELOW_IMPLANT, posture.pose_below_implant(bone, BELOW_IMPLANT))),
            ),
            Self::Natural => all.push((Body::Patella, 1.0, posture.pose(Body::Patella))),
        }
        all
    }
}

/// Points of the surfaces that only stand in the beam.
const COARSE: usize = 36_000;
/// Size of the bones below implants: cut and inside them.
const BELOW_IMPLANT: f64 = 0.86;
/// Semi-axes of the limb, mm.
const LIMB_MM: [f64; 3] = [68.0, 72.0, f64::INFINITY];

/// Pictures of one posture, a view each, with their segmentation.
#[derive(Debug, Clone)]
pub struct Recorded {
    /// What it is called.
    pub label: String,
    /// Where the knee was.
    pub posture: Posture,
    /// One a view.
    pub frames: Vec<Frame>,
    /// One a view, recorded pixels.
    pub curves: Vec<Curves>,
}

/// How pictures are taken: fluoroscopes as they are, with the exposure of each.
#[derive(Debug, Clone)]
pub struct Equipment {
    /// A view and how its pictures are taken.
    pub views: Vec<(TrueFluoroscope, Exposure)>,
}

impl Equipment {
    /// All views with the same exposure.
    pub fn new(views: &[TrueFluoroscope], exposure: &Exposure) -> Self {
        Self { views: views.iter().map(|v| (v.clone(), exposure.clone())).collect() }
    }

    /// The truth as the product reads it, with the distortion as a table of samples 16 px apart.
    pub fn calibrations(&self) -> Vec<Calibration> {
        let names = "ABCDEFGH".chars().map(String::from);
        self.views
            .iter()
            .zip(names)
            .map(|((view, exposure), name)| Calibration {
                distortion: exposure.distortion.as_ref().map(|d| d.table(view.size, 16)),
                ..view.calibration(&name)
            })
            .collect()
    }
}

impl Lab {
    /// What is in the beam in a posture.
    ///
    /// # Errors
    /// A body cannot be meshed.
    pub fn beam(&self, knee: Knee, posture: &Posture) -> Result<biplane_phantom::Scene, SceneError> {
        use Material::{CobaltChrome, CorticalBone, SoftTissue, Titanium, TrabecularBone};
        let mut bodies = Vec::new();
        let at_rest = |pose: Pose, absorbers| PosedBody::at_rest(pose, absorbers);
        let metal = |body: Body, material| -> Result<PosedBody, SceneError> {
            let surface = Surface::Mesh(self.workshop.surface(body, FINEST)?);
            Ok(at_rest(posture.pose(body), vec![Absorber::new(surface, material, SoftTissue)]))
        };
        let bone = |body: Body, points: usize, scale: f64| -> Result<PosedBody, SceneError> {
            let scaled = |mesh: Arc<Mesh>| {
                Surface::Mesh(if scale == 1.0 { mesh } else { Arc::new((*mesh).clone().scaled(scale)) })
            };
            let outer = scaled(self.workshop.surface(body, points)?);
            let mut absorbers = vec![Absorber::new(outer, CorticalBone, SoftTissue)];
            if let Some(inner) = self.workshop.inner(body, COARSE)? {
                absorbers.push(Absorber::new(scaled(inner), TrabecularBone, CorticalBone));
            }
            let pose =
                if scale == 1.0 { posture.pose(body) } else { posture.pose_below_implant(body, scale) };
            Ok(at_rest(pose, absorbers))
        };
        match knee {
            Knee::Implants => {
                bodies.push(metal(Body::FemoralComponent, CobaltChrome)?);
                bodies.push(metal(Body::TibialTray, Titanium)?);
                bodies.push(bone(Body::DistalFemur, COARSE, BELOW_IMPLANT)?);
                bodies.push(bone(Body::ProximalTibia, COARSE, BELOW_IMPLANT)?);
            }
            Knee::Natural => {
                bodies.push(bone(Body::DistalFemur, FINEST, 1.0)?);
                bodies.push(bone(Body::ProximalTibia, FINEST, 1.0)?);
                bodies.push(bone(Body::Patella, COARSE, 1.0)?);
            }
        }
        let limb = Ellipsoid {
            centre: Point3::from(posture.knee.translation),
            semi_axes: LIMB_MM.into(),
            attenuation_per_mm: SoftTissue.attenuation_per_mm(),
        };
        Ok(biplane_phantom::Scene { bodies, tissue: vec![limb] })
    }

    /// Takes and segments the pictures of postures. Seeds of the noise follow from the bench's seed and a frame's place.
    ///
    /// # Errors
    /// A body is not in the beam, or a picture has no edges.
    pub fn record(
        &self,
        knee: Knee,
        postures: &[(String, Posture)],
        equipment: &Equipment,
    ) -> Result<Vec<Recorded>, SceneError> {
        // Made before the threads start, so that no two of them make the same mesh.
        self.beam(knee, &Posture::flexed(0.0))?;
        postures
            .par_iter()
            .enumerate()
            .map(|(number, (label, posture))| {
                let scene = self.beam(knee, posture)?;
                let (frames, curves) = expose(&scene, equipment, self.seed, number)?;
                Ok(Recorded { label: label.clone(), posture: *posture, frames, curves })
            })
            .collect()
    }

    /// A scene of one body in recorded pictures, with a mesh of `points` to be matched, claiming accuracy.
    ///
    /// # Errors
    /// The model is not coarser than what made the pictures.
    pub fn recorded_scene(
        &self,
        body: Body,
        points: usize,
        recorded: &[Recorded],
        calibrations: &[Calibration],
        params: MatchParams,
    ) -> Result<Scene, SceneError> {
        let frames: Frames =
            recorded.iter().map(|r| (r.label.clone(), r.posture.pose(body), r.curves.clone())).collect();
        let made = Made {
            origin: Origin::mesh(&*self.workshop.surface(body, FINEST)?),
            claim: Claim::Accuracy,
            params,
        };
        Scene::made(made, &*self.workshop.surface(body, points)?, calibrations, frames)
    }
}

/// Takes the pictures of a scene in all views, and segments them with the product's defaults.
///
/// # Errors
/// A body is not in the beam.
pub fn expose(
    scene: &biplane_phantom::Scene,
    equipment: &Equipment,
    seed: u64,
    number: usize,
) -> Result<(Vec<Frame>, Vec<Curves>), SceneError> {
    let (mut frames, mut segmented) = (Vec::new(), Vec::new());
    for (index, (view, exposure)) in equipment.views.iter().enumerate() {
        let seed = seed.wrapping_mul(1_000_003).wrapping_add((number * 8 + index) as u64);
        let frame = picture(scene, view, exposure, seed).map_err(|e| SceneError::Mesh(e.to_string()))?;
        segmented.push(curves(&frame, None, &SegmentParams::default())?);
        frames.push(frame);
    }
    Ok((frames, segmented))
}
