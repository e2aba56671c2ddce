//! Frames of beads before two fluoroscopes, what their owner knows of them, and how far the product's fluoroscopes are from the
//! true ones.

use biplane_artifact::{
    Bead, BeadList, Calibration, Detector, DistortionTable, Environment, Frame, Spots, ViewEnvironment,
};
use biplane_fluoroscope::{Distortion, Fluoroscope};
use biplane_geometry::{Point2, Point3, Vector3};
use biplane_phantom::{BeadFrame, BeadLayout, Exposure, IntensifierDistortion, TrueFluoroscope, picture};
use biplane_spots::{Look, SpotError, SpotParams, SpotSettings, find_spots};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use rand::Rng;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::SceneError;
use crate::bound::triangulated;
use crate::setups::aimed;

/// A frame of beads before two fluoroscopes.
#[derive(Debug, Clone)]
pub struct BeadScene {
    /// The fluoroscopes as they are.
    pub views: [TrueFluoroscope; 2],
    /// The beads.
    pub frame: BeadFrame,
}

/// Frames of beads that laboratories use, and where they stand.
#[derive(Debug, Clone, Copy)]
pub struct Stand {
    /// In tables.
    pub name: &'static str,
    /// The frame.
    pub layout: fn() -> BeadLayout,
    /// How far from the source it stands, as a share of the way to the detector.
    pub share: f64,
}

/// 30 beads in 150 mm midway, and in 100 mm nearer to the detector.
pub const STANDS: [Stand; 2] = [
    Stand { name: "150 mm, midway", layout: BeadLayout::large, share: 0.5 },
    Stand { name: "100 mm, at 0.7 of the way", layout: BeadLayout::small, share: 0.7 },
];

/// Views drawn until a frame's shadows fit into both.
const ATTEMPTS: usize = 50;

impl BeadScene {
    /// Fluoroscopes drawn, and a frame of beads whose shadows keep apart in them.
    ///
    /// # Errors
    /// No frame fits into any of many drawn fluoroscopes.
    pub fn drawn(stand: &Stand, chance: &mut Xoshiro256PlusPlus) -> Result<Self, SceneError> {
        let layout = (stand.layout)();
        let mut last = String::new();
        for _ in 0..ATTEMPTS {
            match Self::before(aimed(stand.share, chance), &layout, chance) {
                Ok(scene) => return Ok(scene),
                Err(error) => last = error.to_string(),
            }
        }
        Err(SceneError::Mesh(last))
    }

    /// A frame before given fluoroscopes.
    ///
    /// # Errors
    /// Its shadows do not fit.
    pub fn before(
        views: [TrueFluoroscope; 2],
        layout: &BeadLayout,
        chance: &mut Xoshiro256PlusPlus,
    ) -> Result<Self, SceneError> {
        let frame = BeadFrame::drawn(layout, &views, chance.random());
        Ok(Self { frame: frame.map_err(|e| SceneError::Mesh(e.to_string()))?, views })
    }

    /// The list of the beads as their owner has it.
    pub fn list(&self) -> BeadList {
        let smallest = self.frame.beads.iter().map(|b| b.radius).fold(f64::INFINITY, f64::min);
        let bead = |(index, ball): (usize, &biplane_phantom::Ball)| Bead {
            name: (index + 1).to_string(),
            at_mm: ball.centre.coords.into(),
            radius_mm: Some(ball.radius),
            mark: ball.radius > 1.2 * smallest,
        };
        BeadList(self.frame.beads.iter().enumerate().map(bead).collect())
    }

    /// A picture of each view.
    ///
    /// # Errors
    /// A bead is not in the beam.
    pub fn pictures(&self, exposures: [&Exposure; 2], seed: u64) -> Result<[Frame; 2], SceneError> {
        let scene = self.frame.scene();
        let taken = |view: usize| {
            picture(
                &scene,
                &self.views[view],
                exposures[view],
                seed.wrapping_mul(2).wrapping_add(view as u64),
            )
            .map_err(|e| SceneError::Mesh(e.to_string()))
        };
        Ok([taken(0)?, taken(1)?])
    }

    /// What is known of the detectors where pictures are not bent.
    pub fn detectors(&self) -> [Detector; 2] {
        [0, 1].map(|view| self.detector(view, self.views[view].pixel_mm, None))
    }

    /// What is known of a detector.
    pub fn detector(&self, view: usize, pixel_mm: f64, distortion: Option<DistortionTable>) -> Detector {
        Detector { view: name(view), size: self.views[view].size, pixel_mm, distortion }
    }

    /// Points spread evenly over a cylinder about the z axis, mm.
    pub fn points(
        radius_mm: f64,
        height_mm: f64,
        count: usize,
        chance: &mut Xoshiro256PlusPlus,
    ) -> Vec<Point3> {
        let mut point = || {
            let (r, angle) =
                (chance.random::<f64>().sqrt() * radius_mm, chance.random_range(0.0..std::f64::consts::TAU));
            Point3::new(r * angle.cos(), r * angle.sin(), height_mm * (chance.random::<f64>() - 0.5))
        };
        (0..count).map(|_| point()).collect()
    }
}

/// A view's name.
pub fn name(view: usize) -> String {
    ["A", "B"][view.min(1)].to_owned()
}

/// The beads of a picture.
///
/// # Errors
/// As the stage says.
pub fn beads_of(frame: &Frame) -> Result<Spots, SpotError> {
    find_spots(frame, &SpotParams { look: Look::Dark, settings: SpotSettings::default() })
}

/// A view that the product found, as what follows uses it.
pub fn fluoroscope(found: &ViewEnvironment, distortion: Option<&DistortionTable>) -> Fluoroscope {
    Fluoroscope::from(&calibration(found, distortion))
}

/// The same as a calibration.
pub fn calibration(found: &ViewEnvironment, distortion: Option<&DistortionTable>) -> Calibration {
    Calibration {
        view: found.view.clone(),
        size: found.size,
        source: found.source,
        matrix: found.matrix,
        distortion: distortion.cloned(),
    }
}

/// How far a view that was found is from the true one.
#[derive(Debug, Clone, Copy)]
pub struct ViewError {
    /// Source, mm.
    pub source: Vector3,
    /// Middle of the detector, mm.
    pub centre: Vector3,
    /// Rotation of the detector, rad, laboratory axes.
    pub turn: Vector3,
}

impl ViewError {
    /// Of a found view.
    pub fn of(found: &ViewEnvironment, truth: &TrueFluoroscope) -> Self {
        let axes = |x: Vector3, y: Vector3| Matrix3::from_columns(&[x, y, x.cross(&y)]);
        let found_axes = axes(Vector3::from(found.along_x), Vector3::from(found.along_y));
        let between = found_axes * axes(truth.along_x, truth.along_y).transpose();
        let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(between));
        Self {
            source: Point3::from(found.source) - truth.source,
            centre: Point3::from(found.centre) - truth.centre,
            turn: turn.scaled_axis(),
        }
    }
}

/// A true way from points to recorded pixels.
pub trait Recording {
    /// The recorded pixel of a point and its true depth over the true source's distance from the detector; `None` where it
    /// is not seen.
    fn recorded(&self, point: &Point3) -> Option<(Point2, f64)>;
    /// Side of an ideal pixel on the detector, mm.
    fn pixel_mm(&self) -> f64;
}

impl Recording for (&TrueFluoroscope, &IntensifierDistortion) {
    fn recorded(&self, point: &Point3) -> Option<(Point2, f64)> {
        let (ideal, depth) = self.0.project(point)?;
        Some((self.1.recorded(&ideal), depth / self.0.source_to_detector_mm()))
    }
    fn pixel_mm(&self) -> f64 {
        self.0.pixel_mm
    }
}

impl Recording for (&TrueFluoroscope, &Distortion) {
    fn recorded(&self, point: &Point3) -> Option<(Point2, f64)> {
        let (ideal, depth) = self.0.project(point)?;
        Some((self.1.recorded(&ideal)?, depth / self.0.source_to_detector_mm()))
    }
    fn pixel_mm(&self) -> f64 {
        self.0.pixel_mm
    }
}

/// How far points of the volume are from where calibrated views have them, though their recorded pixels are exact: errors of
/// calibration and distortion together, mm.
#[derive(Debug, Clone, Default)]
pub struct VolumeError {
    /// Distance of each point from its ray, a view each.
    pub projected: Vec<f64>,
    /// Distance of each point from its triangulation.
    pub triangulated: Vec<f64>,
}

impl VolumeError {
    /// Of views found, with their distortions, against the true ones.
    pub fn of<R: Recording>(found: &[Fluoroscope], truth: &[R], points: &[Point3]) -> Self {
        let mut error = Self::default();
        for point in points {
            let mut pixels = Vec::new();
            for (view, recording) in found.iter().zip(truth) {
                let Some((recorded, share)) = recording.recorded(point) else { continue };
                let ideal = view.distortion().map_or(recorded, |d| d.ideal(&recorded));
                if let Some(at) = view.project(point) {
                    error.projected.push((at.pixel - ideal).norm() * recording.pixel_mm() * share);
                }
                pixels.push(ideal);
            }
            if pixels.len() == found.len()
                && let Some(place) = triangulated(found, &pixels, point)
            {
                error.triangulated.push((place - point).norm());
            }
        }
        error
    }
}

/// Root mean square.
pub fn rms(values: impl IntoIterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in values {
        sum += value * value;
        count += 1.0;
    }
    (sum / count).sqrt()
}

/// How many used beads of an environment carry another bead's label: they are not where the true fluoroscope has their bead.
pub fn mislabelled(
    found: &Environment,
    scene: &BeadScene,
    distortions: [&IntensifierDistortion; 2],
) -> usize {
    const FAR_PX: f64 = 3.0;
    let of_view = |(index, view): (usize, &ViewEnvironment)| {
        let truth = (&scene.views[index], distortions[index]);
        let wrong = |b: &&biplane_artifact::SeenBead| {
            let at = scene.frame.beads.get(b.bead).and_then(|ball| truth.recorded(&ball.centre));
            b.used && at.is_none_or(|(at, _)| (Point2::from(b.at_px) - at).norm() > FAR_PX)
        };
        view.beads.iter().filter(wrong).count()
    };
    found.views.iter().enumerate().map(of_view).sum()
}
