//! The six variables of a search: a twist about the body's centroid at the start, all in mm.

use biplane_geometry::{Point3, Pose, Twist, Vector3};
use biplane_optimiser::Row;
use nalgebra::{Matrix3, Vector6};

/// Poses about a start: translation (mm) and rotation vector times the body's radius of gyration (mm), laboratory axes. Zero is the start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variables {
    start: Pose,
    /// The centroid at the start, laboratory, mm.
    centre: Point3,
    /// mm per radian.
    arm: f64,
}

impl Variables {
    /// About `start`, for a body whose centroid (model, mm) and radius of gyration (mm) these are.
    pub fn new(start: &Pose, centroid: &Point3, radius_of_gyration: f64) -> Self {
        Self { start: *start, centre: start.transform(centroid), arm: radius_of_gyration.max(1e-3) }
    }

    /// mm per radian.
    pub fn arm_mm(&self) -> f64 {
        self.arm
    }

    fn turn(&self, at: &Vector6<f64>) -> Vector3 {
        Vector3::new(at[3], at[4], at[5]) / self.arm
    }

    /// The pose of the variables.
    pub fn pose(&self, at: &Vector6<f64>) -> Pose {
        let twist = Twist { translation: Vector3::new(at[0], at[1], at[2]), rotation: self.turn(at) };
        self.start.moved(&twist, &self.centre)
    }

    /// Turns derivatives by a twist about the centroid at the pose of `at` into derivatives by the variables.
    pub fn chain(&self, at: &Vector6<f64>, rows: &mut [Row]) {
        // exp(w + dw) = exp(J dw) exp(w), with J the left Jacobian of the rotation group.
        let w = self.turn(at);
        let angle = w.norm();
        let cross = w.cross_matrix();
        let (a, b) = if angle < 1e-4 {
            (0.5, 1.0 / 6.0)
        } else {
            ((1.0 - angle.cos()) / angle.powi(2), (angle - angle.sin()) / angle.powi(3))
        };
        let jacobian = (Matrix3::identity() + cross * a + cross * cross * b) / self.arm;
        for row in rows {
            let d = row.derivative;
            let turned = jacobian.transpose() * Vector3::new(d[3], d[4], d[5]);
            row.derivative = Vector6::new(d[0], d[1], d[2], turned.x, turned.y, turned.z);
        }
    }
}
