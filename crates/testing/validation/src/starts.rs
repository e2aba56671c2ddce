//! Matches from many seeded starts around the reference.

use biplane_artifact::{Match, Verdict};
use biplane_geometry::{Point3, Pose, PoseError, Twist, Vector3};
use biplane_optimisation::{Evidence, assess, match_body};
use nalgebra::{Matrix6, Vector6};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use rayon::prelude::*;

use crate::Scene;
use crate::scene::Posed;

/// How starts are drawn: exactly this far off, in directions drawn evenly over the sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StartOffset {
    /// Displacement of the body's centroid, mm.
    pub translation_mm: f64,
    /// Angle of the rotation about the centroid, degrees.
    pub rotation_deg: f64,
    /// Starts a frame.
    pub count: usize,
    /// Seed.
    pub seed: u64,
}

/// One match and its error.
#[derive(Debug, Clone)]
pub struct Attempt {
    /// The frame.
    pub frame: String,
    /// Which start.
    pub start: usize,
    /// The answer.
    pub answer: Match,
    /// Against the reference.
    pub error: PoseError,
    /// Rotation vector (rad) and displacement of the centroid (mm) of the answer against the reference, laboratory axes.
    pub difference: (Vector3, Vector3),
    /// Mean target registration error over the vertices, mm.
    pub mean_target_mm: f64,
    /// Squared error over the stated covariance: 6 on average where the covariance is right.
    pub normalised_squared: f64,
    /// Time of the match, s.
    pub seconds: f64,
    /// Root mean square residual of the outline at the reference pose, px: the larger view's.
    pub reference_rms_px: f64,
}

impl Attempt {
    /// What the verdict says.
    pub fn verdict(&self) -> Verdict {
        self.answer.verdict
    }
}

/// A direction drawn evenly over the sphere.
fn direction(random: &mut Xoshiro256PlusPlus) -> Vector3 {
    let z: f64 = random.random_range(-1.0..=1.0);
    let a: f64 = random.random_range(0.0..std::f64::consts::TAU);
    let r = (1.0 - z * z).sqrt();
    Vector3::new(r * a.cos(), r * a.sin(), z)
}

impl StartOffset {
    /// The start poses around a reference: depend on seed, frame and number alone.
    pub fn draw(&self, reference: &Pose, centroid: &Point3, frame: usize) -> Vec<Pose> {
        let mut random =
            Xoshiro256PlusPlus::seed_from_u64(self.seed.wrapping_mul(1_000_003).wrapping_add(frame as u64));
        (0..self.count)
            .map(|_| {
                let twist = Twist {
                    translation: direction(&mut random) * self.translation_mm,
                    rotation: direction(&mut random) * self.rotation_deg.to_radians(),
                };
                reference.moved(&twist, &reference.transform(centroid))
            })
            .collect()
    }
}

/// Offsets of [`set_a`]: standard deviation and cut, mm or degrees.
const SET_A: (f64, f64) = (10.0, 20.0);

/// Start poses as the thesis draws them: each of the six pose variables (Eq. 3.1, about the centroid) off by a Gaussian
/// number of standard deviation 10 mm or degrees, drawn again beyond 20. They depend on seed and frame alone.
pub fn set_a(reference: &Pose, centroid: &Point3, seed: u64, frame: usize, count: usize) -> Vec<Pose> {
    let mut random =
        Xoshiro256PlusPlus::seed_from_u64(seed.wrapping_mul(7_368_787).wrapping_add(frame as u64));
    let mut offset = || loop {
        // Box and Muller (1958).
        let (u, v): (f64, f64) = (1.0 - random.random::<f64>(), random.random());
        let drawn = SET_A.0 * (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos();
        if drawn.abs() <= SET_A.1 {
            break drawn;
        }
    };
    let (angles, t) = reference.to_thesis(centroid.coords);
    (0..count)
        .map(|_| {
            let moved = t + Vector3::from_fn(|_, _| offset());
            let [a, b, c] = angles.map(|angle| angle + offset().to_radians());
            Pose::from_thesis(a, b, c, moved, centroid.coords)
        })
        .collect()
}

/// Turns of [`turned`], degrees.
const TURNS_DEG: [f64; 7] = [180.0, 170.0, -170.0, 90.0, -90.0, 45.0, -45.0];

/// Start poses turned far away about six axes of the body through its centroid: where a nearly symmetric body has its
/// wrong basins.
pub fn turned(reference: &Pose, centroid: &Point3) -> Vec<Pose> {
    let axes = [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 1.0],
        [1.0, 0.0, 1.0],
    ];
    axes.iter()
        .flat_map(|axis| TURNS_DEG.map(|deg| Vector3::from(*axis).normalize() * deg.to_radians()))
        .map(|turn| {
            let axes = reference.rotation() * turn;
            let twist = Twist { translation: Vector3::zeros(), rotation: axes };
            reference.moved(&twist, &reference.transform(centroid))
        })
        .collect()
}

/// Matches every frame of `scene` from the starts that `draw` gives for a reference, the body's centroid and the frame's
/// place.
pub fn attempts(scene: &Scene, draw: impl Fn(&Pose, &Point3, usize) -> Vec<Pose> + Sync) -> Vec<Attempt> {
    let (centroid, params) = (*scene.rim.centroid(), &scene.params);
    scene
        .frames
        .par_iter()
        .enumerate()
        .flat_map_iter(|(index, posed)| {
            let Posed { label, reference, views, .. } = posed;
            draw(reference, &centroid, index).into_iter().enumerate().filter_map(move |(start, from)| {
                // Nothing cancels here, so every match gives an answer.
                let begun = std::time::Instant::now();
                let answer = match_body(&scene.rim, views, &scene.names, &from, params, || false).ok()?;
                let seconds = begun.elapsed().as_secs_f64();
                let pose = Pose::from(answer.pose);
                let assessed = assess(&scene.rim, views, reference, &params.search());
                let rms = |e: &Evidence| (e.squared / e.matched_px.max(1e-9)).sqrt();
                let turn = (pose.rotation() * reference.rotation().inverse()).scaled_axis();
                let moved = pose.transform(&centroid) - reference.transform(&centroid);
                let error = Vector6::new(moved.x, moved.y, moved.z, turn.x, turn.y, turn.z);
                let covariance = Matrix6::from_fn(|i, j| answer.covariance[i][j]);
                Some(Attempt {
                    frame: label.clone(),
                    start,
                    error: pose.error_against(reference, &centroid),
                    difference: (turn, moved),
                    normalised_squared: covariance
                        .try_inverse()
                        .map_or(f64::NAN, |i| error.dot(&(i * error))),
                    reference_rms_px: assessed.evidence.iter().map(rms).fold(0.0, f64::max),
                    mean_target_mm: pose.mean_target_error_mm(reference, scene.mesh.vertices()),
                    seconds,
                    answer,
                })
            })
        })
        .collect()
}
