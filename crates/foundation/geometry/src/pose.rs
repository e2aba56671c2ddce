//! Rigid transforms with their frames in the type, poses, and the error of a pose.
//!
//! `Rigid<To, From>` maps coordinates of frame `From` to coordinates of frame `To`; only neighbours that match compose,
//! so a wrong product does not compile. A pose is `world_from_model`: `x_world = R x_model + t`.
//!
//! The thesis (Bingham 2006, Eqs. 3.1 and 3.2) rotates about a local origin `o` and then translates by `t`:
//! `x = R (m - o) + o + t`. Its rotation is given by Euler angles in the sequence Y-Z-X whose matrix has direction
//! cosines as rows, which as an active rotation is `Rx(-alpha) Rz(-gamma) Ry(-beta)`.

use std::marker::PhantomData;

use nalgebra::{Matrix3, Matrix4, Rotation3, UnitQuaternion};

use crate::{Point3, Vector3};

/// The laboratory frame: where both fluoroscopes stand, mm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum World {}
/// A body's own frame: the coordinates of its mesh file, mm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Model {}

/// A rotation followed by a translation (mm), from frame `From` to frame `To`.
pub struct Rigid<To, From> {
    rotation: UnitQuaternion<f64>,
    translation: Vector3,
    frames: PhantomData<(To, From)>,
}

/// Where a body is: `world_from_model`.
pub type Pose = Rigid<World, Model>;

impl<To, From> Clone for Rigid<To, From> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<To, From> Copy for Rigid<To, From> {}
impl<To, From> PartialEq for Rigid<To, From> {
    fn eq(&self, other: &Self) -> bool {
        self.rotation == other.rotation && self.translation == other.translation
    }
}
impl<To, From> std::fmt::Debug for Rigid<To, From> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (q, t) = (self.rotation.as_ref().coords, self.translation);
        write!(
            f,
            "Rigid {{ t: [{}, {}, {}] mm, q(wxyz): [{}, {}, {}, {}] }}",
            t.x, t.y, t.z, q.w, q.x, q.y, q.z
        )
    }
}

/// A small motion of a posed body: rotation vector (rad, laboratory axes) about a chosen point, then translation (mm).
///
/// Order in every 6-vector and 6x6 matrix of this program: translation x, y, z, then rotation x, y, z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Twist {
    /// mm, laboratory axes.
    pub translation: Vector3,
    /// rad, laboratory axes, about the point the twist is applied at.
    pub rotation: Vector3,
}

/// How far one pose is from another, as `docs/conventions.md` defines it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseError {
    /// Length of the displacement of the mesh's area centroid, mm.
    pub translation_mm: f64,
    /// Geodesic angle between the two rotations, rad.
    pub rotation_rad: f64,
}

impl<To, From> Rigid<To, From> {
    /// From a rotation and a translation in mm.
    pub fn new(rotation: UnitQuaternion<f64>, translation: Vector3) -> Self {
        Self { rotation, translation, frames: PhantomData }
    }

    /// The identity: both frames coincide.
    pub fn identity() -> Self {
        Self::new(UnitQuaternion::identity(), Vector3::zeros())
    }

    /// From a 4x4 matrix whose last row is `0 0 0 1`; `None` where the upper 3x3 is not a rotation within `1e-4`.
    ///
    /// The nearest rotation is taken, so matrices printed with a few decimals are accepted.
    pub fn from_matrix(matrix: &Matrix4<f64>) -> Option<Self> {
        let r: Matrix3<f64> = matrix.fixed_view::<3, 3>(0, 0).into_owned();
        let orthogonal = (r * r.transpose() - Matrix3::identity()).abs().max() < 1e-4;
        let affine = (matrix[(3, 0)].abs() + matrix[(3, 1)].abs() + matrix[(3, 2)].abs()) < 1e-9
            && (matrix[(3, 3)] - 1.0).abs() < 1e-9;
        if !orthogonal || r.determinant() < 0.0 || !affine {
            return None;
        }
        let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_eps(
            &r,
            1e-15,
            100,
            Rotation3::from_matrix_unchecked(r),
        ));
        Some(Self::new(rotation, Vector3::new(matrix[(0, 3)], matrix[(1, 3)], matrix[(2, 3)])))
    }

    /// The 4x4 matrix.
    pub fn matrix(&self) -> Matrix4<f64> {
        let mut m = Matrix4::identity();
        m.fixed_view_mut::<3, 3>(0, 0).copy_from(self.rotation.to_rotation_matrix().matrix());
        m.fixed_view_mut::<3, 1>(0, 3).copy_from(&self.translation);
        m
    }

    /// The rotation.
    pub fn rotation(&self) -> UnitQuaternion<f64> {
        self.rotation
    }

    /// The translation of the `From` frame's origin, mm.
    pub fn translation(&self) -> Vector3 {
        self.translation
    }

    /// The other way round.
    pub fn inverse(&self) -> Rigid<From, To> {
        let r = self.rotation.inverse();
        Rigid::new(r, -(r * self.translation))
    }

    /// A point of frame `From`, in coordinates of frame `To`, mm.
    pub fn transform(&self, point: &Point3) -> Point3 {
        self.rotation * point + self.translation
    }
}

impl<A, B, C> std::ops::Mul<Rigid<B, C>> for Rigid<A, B> {
    type Output = Rigid<A, C>;
    fn mul(self, right: Rigid<B, C>) -> Rigid<A, C> {
        Rigid::new(self.rotation * right.rotation, self.rotation * right.translation + self.translation)
    }
}

impl Pose {
    /// From the thesis's six numbers (Eqs. 3.1, 3.2): angles in rad, translation `t` and local origin `o` in mm.
    pub fn from_thesis(alpha: f64, beta: f64, gamma: f64, translation: Vector3, origin: Vector3) -> Self {
        let rotation = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), -alpha)
            * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), -gamma)
            * UnitQuaternion::from_axis_angle(&Vector3::y_axis(), -beta);
        Self::new(rotation, origin + translation - rotation * origin)
    }

    /// The thesis's six numbers: `[alpha, beta, gamma]` in rad and its `t` in mm about the local origin `o` (mm).
    ///
    /// At `gamma = +-90` degrees alpha and beta are not unique; alpha is then 0.
    pub fn to_thesis(&self, origin: Vector3) -> ([f64; 3], Vector3) {
        let m = self.rotation.to_rotation_matrix();
        let m = m.matrix();
        // Eq. 3.2: m01 = sin(gamma), m00 = cb cg, m02 = -sb cg, m11 = ca cg, m21 = -sa cg.
        let gamma = m[(0, 1)].clamp(-1.0, 1.0).asin();
        let (alpha, beta) = if gamma.cos() > 1e-9 {
            ((-m[(2, 1)]).atan2(m[(1, 1)]), (-m[(0, 2)]).atan2(m[(0, 0)]))
        } else {
            (0.0, m[(2, 0)].atan2(m[(2, 2)]))
        };
        ([alpha, beta, gamma], self.translation - origin + self.rotation * origin)
    }

    /// The pose after a small motion: rotation about the laboratory point `center`, then translation.
    pub fn moved(&self, twist: &Twist, center: &Point3) -> Self {
        let turn = UnitQuaternion::from_scaled_axis(twist.rotation);
        let translation = turn * (self.translation - center.coords) + center.coords + twist.translation;
        let mut rotation = turn * self.rotation;
        rotation.renormalize();
        Self::new(rotation, translation)
    }

    /// Error of this pose against `reference`; `centroid` is the mesh's area centroid in model coordinates, mm.
    pub fn error_against(&self, reference: &Pose, centroid: &Point3) -> PoseError {
        PoseError {
            translation_mm: (self.transform(centroid) - reference.transform(centroid)).norm(),
            rotation_rad: self.rotation.angle_to(&reference.rotation),
        }
    }

    /// Mean target registration error over the mesh's vertices (model coordinates), mm.
    pub fn mean_target_error_mm(&self, reference: &Pose, vertices: &[Point3]) -> f64 {
        let sum: f64 = vertices.iter().map(|v| (self.transform(v) - reference.transform(v)).norm()).sum();
        sum / vertices.len().max(1) as f64
    }

    /// Between two poses: the fraction `s` of the way, straight for the point `centroid` (model, mm), turning evenly.
    pub fn between(&self, other: &Pose, s: f64, centroid: &Point3) -> Pose {
        let rotation = self.rotation.try_slerp(&other.rotation, s, 1e-9).unwrap_or(if s < 0.5 {
            self.rotation
        } else {
            other.rotation
        });
        let at = self.transform(centroid).coords.lerp(&other.transform(centroid).coords, s);
        Pose::new(rotation, at - rotation * centroid.coords)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn frames_compose_and_invert() {
        let a: Pose =
            Rigid::new(UnitQuaternion::from_euler_angles(0.3, -0.2, 1.1), Vector3::new(1.0, 2.0, 3.0));
        let p = Point3::new(4.0, -5.0, 6.0);
        assert_relative_eq!(a.inverse().transform(&a.transform(&p)), p, epsilon = 1e-12);
        let unit: Rigid<Model, Model> = a.inverse() * a;
        assert_relative_eq!(unit.matrix(), Matrix4::identity(), epsilon = 1e-12);
    }

    #[test]
    fn thesis_matrix_is_equation_3_2_with_its_misprint_mended() {
        let (a, b, g) = (0.4_f64, -0.7_f64, 0.25_f64);
        let ((sa, ca), (sb, cb), (sg, cg)) = (a.sin_cos(), b.sin_cos(), g.sin_cos());
        let expected = Matrix3::new(
            cb * cg,
            sg,
            -sb * cg,
            -ca * cb * sg + sa * sb,
            ca * cg,
            ca * sb * sg + sa * cb,
            sa * cb * sg + ca * sb,
            -sa * cg,
            -sa * sb * sg + ca * cb,
        );
        let o = Vector3::new(3.0, -8.0, 2.0);
        let t = Vector3::new(10.0, 20.0, -30.0);
        let pose = Pose::from_thesis(a, b, g, t, o);
        assert_relative_eq!(*pose.rotation().to_rotation_matrix().matrix(), expected, epsilon = 1e-12);
        // Eq. 3.1: the local origin moves by exactly t.
        assert_relative_eq!(pose.transform(&Point3::from(o)).coords, o + t, epsilon = 1e-12);
        let ([a2, b2, g2], t2) = pose.to_thesis(o);
        assert_relative_eq!(Vector3::new(a2, b2, g2), Vector3::new(a, b, g), epsilon = 1e-12);
        assert_relative_eq!(t2, t, epsilon = 1e-12);
    }

    #[test]
    fn error_is_taken_at_the_centroid() {
        let centroid = Point3::new(0.0, 0.0, 100.0);
        let reference = Pose::identity();
        // A turn of 0.3 degrees about the centroid moves the origin by half a millimetre, and is no translation error.
        let turn =
            Twist { translation: Vector3::zeros(), rotation: Vector3::new(0.3_f64.to_radians(), 0.0, 0.0) };
        let error = reference.moved(&turn, &centroid).error_against(&reference, &centroid);
        assert!(error.translation_mm < 1e-12);
        assert_relative_eq!(error.rotation_rad, 0.3_f64.to_radians(), epsilon = 1e-12);
        assert!(reference.moved(&turn, &centroid).translation().norm() > 0.5);
    }

    #[test]
    fn reads_a_matrix_of_nine_decimals_and_refuses_a_mirror() {
        let q = UnitQuaternion::from_euler_angles(0.3, -0.2, 1.1);
        let pose = Pose::new(q, Vector3::new(1.0, 2.0, 3.0));
        let rounded = pose.matrix().map(|v| (v * 1e9).round() / 1e9);
        let read = Pose::from_matrix(&rounded).unwrap();
        assert!(read.rotation().angle_to(&q) < 1e-8);
        let mut mirror = pose.matrix();
        mirror.column_mut(0).neg_mut();
        assert!(Pose::from_matrix(&mirror).is_none());
    }
}
