//! Solids given by a function of space: negative inside, zero on the surface, positive outside.

use biplane_geometry::{Point3, Vector3};

/// A solid body in its model frame.
pub trait Solid: Sync {
    /// Negative inside, positive outside, mm. Its size is at most the distance to the surface (so that a ray can step by
    /// it), and near the surface it is smooth but for edges.
    fn value(&self, point: &Point3) -> f64;

    /// Smallest and largest corner of a box along the model's axes that holds the solid, mm.
    fn bounds(&self) -> (Point3, Point3);
}

/// Step of [`gradient`], mm: its error is the third derivative times 1e-7 mm^2 / 6.
const STEP_MM: f64 = 3e-4;

/// Gradient of the function at a point, by central differences.
pub fn gradient(solid: &dyn Solid, point: &Point3) -> Vector3 {
    Vector3::from_fn(|axis, _| {
        let mut step = Vector3::zeros();
        step[axis] = STEP_MM;
        (solid.value(&(point + step)) - solid.value(&(point - step))) / (2.0 * STEP_MM)
    })
}

/// A ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Its centre, mm.
    pub centre: Point3,
    /// Its radius, mm.
    pub radius: f64,
}

impl Solid for Ball {
    fn value(&self, point: &Point3) -> f64 {
        (point - self.centre).norm() - self.radius
    }

    fn bounds(&self) -> (Point3, Point3) {
        let r = Vector3::repeat(self.radius);
        (self.centre - r, self.centre + r)
    }
}
