//! The phantom knee that the tables are measured on: which body stands where, and meshes of it made once.
//!
//! Laboratory frame: z up, the joint line at the origin, where both fluoroscopes look. The whole knee is turned about z,
//! so that neither view is one along an axis of a body.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use biplane_geometry::{Mesh, Point3, Pose, Twist, Vector3};
use biplane_phantom::{Body, mesh};
use nalgebra::{Rotation3, UnitQuaternion};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::SceneError;

/// Points of the meshes that pictures are made of.
pub const FINEST: usize = 200_000;

/// Height of the femoral component's lowest point in extension, and of the tray's highest, mm: an insert of 9 mm.
const JOINT_MM: (f64, f64) = (8.0, -1.0);
/// How far the bones' joint surfaces are from the joint line, mm: cartilage.
const CARTILAGE_MM: f64 = 2.5;
/// Thickness of the tray's plate, and of the femoral component, mm.
const TRAY_MM: f64 = 5.0;
const METAL_MM: f64 = 9.0;
/// Radius of the condyles' back, mm: the femur turns about its axis, so that it rolls on the tibia at about one height.
const CONDYLE_MM: f64 = 23.0;
/// The part of the flexion by which the shin leans; the thigh leans by the rest.
const SHIN: f64 = 0.35;
/// How the knee is turned about z, degrees.
const TURNED_DEG: f64 = 25.0;

/// Where the knee is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Posture {
    /// Flexion, degrees.
    pub flexion_deg: f64,
    /// Of the whole knee about the laboratory's origin.
    pub knee: Twist,
    /// Of the femur against the tibia, about its own origin, beside the flexion.
    pub femur: Twist,
}

impl Posture {
    /// A knee that is only flexed.
    pub fn flexed(flexion_deg: f64) -> Self {
        let none = Twist { translation: Vector3::zeros(), rotation: Vector3::zeros() };
        Self { flexion_deg, knee: none, femur: none }
    }

    /// The knee moved by so much, mm.
    pub fn moved(mut self, by: Vector3) -> Self {
        self.knee.translation += by;
        self
    }

    /// Drawn at random: flexion 0 to 110 degrees, the knee moved by up to 10 mm and turned by up to 30 degrees about z and
    /// 8 about the other axes, the femur by up to 2 mm and 5 degrees against the tibia.
    pub fn random(seed: u64, number: usize) -> Self {
        let mut random =
            Xoshiro256PlusPlus::seed_from_u64(seed.wrapping_mul(92_821).wrapping_add(number as u64));
        let flexion_deg = random.random_range(0.0..110.0);
        let mut within = |x: f64, y: f64, z: f64| {
            Vector3::new(
                random.random_range(-x..=x),
                random.random_range(-y..=y),
                random.random_range(-z..=z),
            )
        };
        let degrees = 1_f64.to_radians();
        let knee =
            Twist { translation: within(10.0, 10.0, 10.0), rotation: within(8.0, 8.0, 30.0) * degrees };
        let femur = Twist { translation: within(2.0, 2.0, 2.0), rotation: within(5.0, 5.0, 5.0) * degrees };
        Self { flexion_deg, knee, femur }
    }

    /// `world_from_model` of a body.
    pub fn pose(&self, body: Body) -> Pose {
        let (low, high) = body.solid().bounds();
        let height = match body {
            Body::FemoralComponent => JOINT_MM.0 - low.z,
            Body::DistalFemur => CARTILAGE_MM - low.z,
            Body::TibialTray => JOINT_MM.1 - high.z,
            Body::ProximalTibia => -CARTILAGE_MM - high.z,
            Body::Patella => 30.0,
        };
        let lowest = if body == Body::DistalFemur { CARTILAGE_MM } else { JOINT_MM.0 };
        self.placed(body, height, Point3::new(0.0, low.y + CONDYLE_MM, lowest + CONDYLE_MM))
    }

    /// `world_from_model` of a bone below an implant, whose mesh is `scale` times its real size: the femur's joint surface
    /// inside the component, the tibia's below the tray.
    pub fn pose_below_implant(&self, bone: Body, scale: f64) -> Pose {
        let (low, high) = bone.solid().bounds();
        let height = match bone {
            Body::ProximalTibia => JOINT_MM.1 - TRAY_MM - scale * high.z,
            _ => JOINT_MM.0 + METAL_MM - scale * low.z,
        };
        let back = Body::FemoralComponent.solid().bounds().0.y;
        self.placed(bone, height, Point3::new(0.0, back + CONDYLE_MM, JOINT_MM.0 + CONDYLE_MM))
    }

    /// A body so high, flexed about `hinge` if it belongs to the femur.
    fn placed(&self, body: Body, height: f64, hinge: Point3) -> Pose {
        let femur = matches!(body, Body::FemoralComponent | Body::DistalFemur);
        // Held by its tendon, the patella stays before the joint while the femur turns behind it.
        let forward = if body == Body::Patella { 52.0 } else { 0.0 };
        let mut pose = Pose::new(UnitQuaternion::identity(), Vector3::new(0.0, forward, height));
        if femur {
            let flexion = Vector3::new(self.flexion_deg.to_radians(), 0.0, 0.0);
            pose = pose.moved(&Twist { translation: Vector3::zeros(), rotation: flexion }, &hinge);
            pose = pose.moved(&self.femur, &hinge);
        }
        // In a lunge the shin leans forward as the knee bends.
        let lean = Vector3::new(-SHIN * self.flexion_deg.to_radians(), 0.0, 0.0);
        pose = pose.moved(&Twist { translation: Vector3::zeros(), rotation: lean }, &Point3::origin());
        let about_z = Rotation3::from_axis_angle(&Vector3::z_axis(), TURNED_DEG.to_radians());
        let turned = Twist { translation: Vector3::zeros(), rotation: about_z.scaled_axis() };
        pose.moved(&turned, &Point3::origin()).moved(&self.knee, &Point3::origin())
    }
}

/// Meshes of the phantom's bodies, each made once.
#[derive(Debug, Default)]
pub struct Workshop {
    meshes: Mutex<BTreeMap<(Body, bool, usize), Arc<Mesh>>>,
}

impl Workshop {
    /// The surface of a body with so many points.
    ///
    /// # Errors
    /// It cannot be meshed.
    pub fn surface(&self, body: Body, points: usize) -> Result<Arc<Mesh>, SceneError> {
        self.made(body, false, points)
    }

    /// The inside of a bone's cortical shell with so many points; `None` for metal.
    ///
    /// # Errors
    /// It cannot be meshed.
    pub fn inner(&self, body: Body, points: usize) -> Result<Option<Arc<Mesh>>, SceneError> {
        body.inner().map(|_| self.made(body, true, points)).transpose()
    }

    fn made(&self, body: Body, inner: bool, points: usize) -> Result<Arc<Mesh>, SceneError> {
        let key = (body, inner, points);
        // A lock that a panic left behind holds whole meshes all the same.
        if let Some(found) = self.meshes.lock().unwrap_or_else(PoisonError::into_inner).get(&key) {
            return Ok(found.clone());
        }
        let solid = if inner { body.inner().unwrap_or_else(|| body.solid()) } else { body.solid() };
        let made = mesh(solid, points).map_err(|e| SceneError::Mesh(format!("{}: {e}", body.name())))?;
        let made = Arc::new(made);
        self.meshes.lock().unwrap_or_else(PoisonError::into_inner).insert(key, made.clone());
        Ok(made)
    }
}
