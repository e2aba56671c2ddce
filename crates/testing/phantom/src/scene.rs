//! What stands between source and detector, and how it moves: the truth of a picture.

use std::sync::Arc;

use biplane_geometry::{Mesh, Point3, Pose, Twist, Vector3};

use crate::{Ball, Material};

/// A closed surface in a body's model frame.
#[derive(Debug, Clone)]
pub enum Surface {
    /// A closed mesh, counter-clockwise seen from outside; several pieces, also one inside another, are allowed.
    Mesh(Arc<Mesh>),
    /// A ball, exactly.
    Ball(Ball),
}

/// What a surface encloses.
#[derive(Debug, Clone)]
pub struct Absorber {
    /// The surface.
    pub surface: Surface,
    /// Attenuation inside the surface less the one just outside of it, 1/mm; it may be negative.
    pub attenuation_per_mm: f64,
}

impl Absorber {
    /// A surface with `inside` in it that stands in `outside`. A cortical shell is two: its outer surface with
    /// `CorticalBone` in `SoftTissue`, and its inner one with `TrabecularBone` in `CorticalBone`.
    pub fn new(surface: Surface, inside: Material, outside: Material) -> Self {
        Self { surface, attenuation_per_mm: inside.attenuation_per_mm() - outside.attenuation_per_mm() }
    }
}

/// A rigid body in the laboratory.
#[derive(Debug, Clone)]
pub struct PosedBody {
    /// Where it is in the middle of the exposure.
    pub pose: Pose,
    /// How it moves: mm/s and rad/s, laboratory axes, about `about`. It matters where the exposure takes time.
    pub velocity: Twist,
    /// The point of the body that moves with the velocity's translation, model frame, mm.
    pub about: Point3,
    /// What it is made of.
    pub absorbers: Vec<Absorber>,
}

impl PosedBody {
    /// A body at rest.
    pub fn at_rest(pose: Pose, absorbers: Vec<Absorber>) -> Self {
        let velocity = Twist { translation: Vector3::zeros(), rotation: Vector3::zeros() };
        Self { pose, velocity, about: Point3::origin(), absorbers }
    }

    /// Whether it moves.
    pub(crate) fn moves(&self) -> bool {
        self.velocity.translation != Vector3::zeros() || self.velocity.rotation != Vector3::zeros()
    }

    /// Its pose some time after the middle of the exposure, s.
    pub fn pose_at(&self, time_s: f64) -> Pose {
        let twist = Twist {
            translation: self.velocity.translation * time_s,
            rotation: self.velocity.rotation * time_s,
        };
        self.pose.moved(&twist, &self.pose.transform(&self.about))
    }
}

/// Smooth matter around the bodies, in the laboratory frame: a limb's soft tissue as an ellipsoid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipsoid {
    /// Its centre, mm.
    pub centre: Point3,
    /// Its semi-axes along the laboratory's axes, mm; an infinite one makes it a cylinder.
    pub semi_axes: Vector3,
    /// Its attenuation less that of air, 1/mm.
    pub attenuation_per_mm: f64,
}

impl Ellipsoid {
    /// Length of the part of the ray from `source` along `direction` that is inside, in lengths of `direction`.
    pub(crate) fn chord(&self, source: &Point3, direction: &Vector3) -> f64 {
        let start = (source - self.centre).component_div(&self.semi_axes);
        let along = direction.component_div(&self.semi_axes);
        let (a, b, c) = (along.norm_squared(), start.dot(&along), start.norm_squared() - 1.0);
        let discriminant = b * b - a * c;
        if discriminant <= 0.0 || a <= 0.0 || b >= 0.0 { 0.0 } else { 2.0 * discriminant.sqrt() / a }
    }
}

/// All that is in the beam.
#[derive(Debug, Clone, Default)]
pub struct Scene {
    /// Rigid bodies; what one of them stands in is up to its absorbers' attenuations.
    pub bodies: Vec<PosedBody>,
    /// Soft tissue. It is taken at the middle of each pixel, so its own outline is not antialiased.
    pub tissue: Vec<Ellipsoid>,
}
