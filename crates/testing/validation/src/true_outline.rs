//! How far edges lie from an outline that is known.

use biplane_artifact::Curves;
use biplane_geometry::{Curve, Point2, Vector2};
use biplane_optimisation::EdgeField;

/// Points of a true outline, so dense that the nearest one's normal measures distances: 0.25 px apart on a circle of 20 px, to 4e-4 px.
pub struct TrueOutline(EdgeField);

impl TrueOutline {
    /// From its curves, with normals out of the body.
    pub fn new(curves: Vec<Curve>) -> Self {
        Self(EdgeField::new(&Curves(curves), None))
    }

    /// How far outside the outline a pixel lies, px, negative inside; none beyond `reach_px`.
    pub fn outside_px(&self, pixel: &Point2, reach_px: f64) -> Option<f64> {
        // All directions count.
        let nearest = self.0.nearest(pixel, &Vector2::x(), reach_px, -2.0)?;
        Some((pixel - nearest.position).dot(&nearest.direction))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_geometry::EdgePoint;

    #[test]
    fn distances_from_a_circle_are_signed() {
        let point = |k: u16| {
            let (sine, cosine) = (f64::from(k) / 80.0).sin_cos();
            let direction = Vector2::new(cosine, sine);
            EdgePoint { position: Point2::from(20.0 * direction), direction, strength: 1.0, sigma_px: 0.01 }
        };
        let circle = TrueOutline::new(vec![Curve { points: (0..503).map(point).collect(), closed: true }]);
        for (radius, angle) in [(21.3_f64, 0.123_f64), (18.4, 3.456), (20.0, 5.0)] {
            let pixel = Point2::new(radius * angle.cos(), radius * angle.sin());
            let found = circle.outside_px(&pixel, 4.0).unwrap();
            assert!((found - (radius - 20.0)).abs() < 4e-4, "{found}");
        }
        assert_eq!(circle.outside_px(&Point2::new(30.0, 0.0), 4.0), None);
    }
}
