//! How a point of the posed body moves in the picture.

use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Point2, Point3, Vector2, Vector3};
use nalgebra::{Matrix3, Vector6};

/// A fluoroscope with the inverse of its matrix.
#[derive(Debug, Clone)]
pub(crate) struct Eye {
    pub fluoroscope: Fluoroscope,
    inverse: Matrix3<f64>,
}

impl Eye {
    /// A degenerate one sees all along no direction.
    pub fn new(fluoroscope: &Fluoroscope) -> Self {
        let inverse = fluoroscope.matrix().try_inverse().unwrap_or_else(Matrix3::zeros);
        Self { fluoroscope: fluoroscope.clone(), inverse }
    }

    /// The laboratory point at a pixel and a depth.
    pub fn point(&self, pixel: &Point2, depth: f64) -> Point3 {
        self.fluoroscope.source() + self.direction(pixel) * depth
    }

    /// From the source to an ideal pixel, per mm of depth; not of unit length.
    pub fn direction(&self, pixel: &Point2) -> Vector3 {
        self.inverse * Vector3::new(pixel.x, pixel.y, 1.0)
    }

    /// By what the point of a ray moves in space for a pixel along x and along y, per mm of depth.
    pub fn across(&self) -> [Vector3; 2] {
        [self.inverse.column(0).into(), self.inverse.column(1).into()]
    }

    /// Derivative of `along . pixel` of a point of the body by a twist about `centre`, px per mm and per rad; zero for a point that is not
    /// seen.
    pub fn pixel_by_twist(&self, world: &Point3, along: &Vector2, centre: &Point3) -> Vector6<f64> {
        let Some((_, by_point)) = self.fluoroscope.project_with_derivative(world) else {
            return Vector6::zeros();
        };
        by_twist(&(by_point.transpose() * along), world, centre)
    }
}

/// Derivative by a twist about `centre` of a quantity whose gradient by the place of a point of the body is given.
pub(crate) fn by_twist(gradient: &Vector3, at: &Point3, centre: &Point3) -> Vector6<f64> {
    let turn = (at - centre).cross(gradient);
    Vector6::new(gradient.x, gradient.y, gradient.z, turn.x, turn.y, turn.z)
}
