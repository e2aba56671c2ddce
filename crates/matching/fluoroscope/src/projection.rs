//! Projection of laboratory points into one view, with its exact derivative (Eq. 3.3).

use biplane_artifact::Calibration;
use biplane_geometry::{Point2, Point3, Vector3};
use nalgebra::{Matrix2x3, Matrix3};

use crate::Distortion;

/// One fluoroscope, ready for use.
#[derive(Debug, Clone)]
pub struct Fluoroscope {
    source: Point3,
    matrix: Matrix3<f64>,
    size: [usize; 2],
    focal_px: f64,
    distortion: Option<Distortion>,
}

/// Where a point appears, and how deep it lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Projection {
    /// Ideal pixel.
    pub pixel: Point2,
    /// Distance from the source along the detector's normal, mm.
    pub depth: f64,
}

impl From<&Calibration> for Fluoroscope {
    fn from(c: &Calibration) -> Self {
        let [r0, r1, r2] = c.matrix;
        let matrix = Matrix3::from_row_slice(&[r0, r1, r2].concat());
        // With rows scaled so that w is in mm, the third row is the unit normal and the focal lengths in pixels are the
        // lengths of the other rows' parts across it.
        let n = matrix.row(2).transpose();
        let across = |i: usize| matrix.row(i).transpose().cross(&n).norm() / n.norm_squared();
        Self {
            source: Point3::from(c.source),
            matrix,
            size: c.size,
            focal_px: (across(0) * across(1)).sqrt(),
            distortion: c.distortion.as_ref().map(Distortion::from),
        }
    }
}

impl Fluoroscope {
    /// The X-ray source, mm, laboratory frame.
    pub fn source(&self) -> &Point3 {
        &self.source
    }

    /// Columns and rows of its images.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// The map between recorded and ideal pixels, if the pictures are not corrected.
    pub fn distortion(&self) -> Option<&Distortion> {
        self.distortion.as_ref()
    }

    /// `M` of `w (x, y, 1) = M (X - source)`.
    pub fn matrix(&self) -> &Matrix3<f64> {
        &self.matrix
    }

    /// Whether a triangle that is counter-clockwise seen from the source is so in (x, y) pixel numbers too; in a picture
    /// with y down it is not.
    pub fn keeps_orientation(&self) -> bool {
        self.matrix.determinant() < 0.0
    }

    /// Distance of the source from the detector in pixels; the geometric mean where pixels are not square.
    pub(crate) fn focal_px(&self) -> f64 {
        self.focal_px
    }

    /// Size of one pixel in a plane at `depth` mm, mm.
    pub fn mm_per_px(&self, depth: f64) -> f64 {
        depth / self.focal_px
    }

    /// The ideal pixel of a laboratory point; `None` at or behind the source's plane.
    pub fn project(&self, point: &Point3) -> Option<Projection> {
        let h = self.matrix * (point - self.source);
        (h.z > 0.0).then(|| Projection { pixel: Point2::new(h.x / h.z, h.y / h.z), depth: h.z })
    }

    /// [`Self::project`], and the derivative of the pixel by the point's three coordinates, px per mm.
    pub fn project_with_derivative(&self, point: &Point3) -> Option<(Projection, Matrix2x3<f64>)> {
        let p = self.project(point)?;
        let m = &self.matrix;
        let derivative =
            Matrix2x3::from_rows(&[m.row(0) - m.row(2) * p.pixel.x, m.row(1) - m.row(2) * p.pixel.y])
                / p.depth;
        Some((p, derivative))
    }

    /// Unit direction from the source through an ideal pixel; `None` for a degenerate calibration.
    pub fn ray(&self, pixel: &Point2) -> Option<Vector3> {
        let direction = self.matrix.try_inverse()? * Vector3::new(pixel.x, pixel.y, 1.0);
        direction.try_normalize(0.0)
    }

    /// Whether an ideal pixel lies on the recorded picture, at least `margin` px from its border.
    pub fn on_image(&self, ideal: &Point2, margin: f64) -> bool {
        let p = match &self.distortion {
            None => *ideal,
            Some(d) => match d.recorded(ideal) {
                Some(p) => p,
                None => return false,
            },
        };
        let inside = |v: f64, n: usize| v >= margin && v <= n as f64 - 1.0 - margin;
        inside(p.x, self.size[0]) && inside(p.y, self.size[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fluoroscope() -> Fluoroscope {
        // An oblique view: K [R | t] with different focal lengths and a principal point off the middle.
        let k = Matrix3::new(4576.8, 0.0, 395.3, 0.0, 4601.7, 588.4, 0.0, 0.0, 1.0);
        let r = nalgebra::Rotation3::from_euler_angles(0.3, -0.8, 1.2);
        let m = k * r.matrix();
        let row = |i: usize| [m[(i, 0)], m[(i, 1)], m[(i, 2)]];
        Fluoroscope::from(&Calibration {
            view: "A".to_owned(),
            size: [1024, 1024],
            source: [-900.0, 500.0, 80.0],
            matrix: [row(0), row(1), row(2)],
            distortion: None,
        })
    }

    /// A point 1300 mm in front of the source, a little off the axis.
    fn point(f: &Fluoroscope) -> Point3 {
        f.source() + f.ray(&Point2::new(600.0, 450.0)).unwrap() * 1300.0
    }

    #[test]
    fn a_ray_projects_back_to_its_pixel() {
        let f = fluoroscope();
        let p = f.project(&point(&f)).unwrap();
        assert!((p.pixel - Point2::new(600.0, 450.0)).norm() < 1e-9);
        assert!(f.project(&(f.source() - (point(&f) - f.source()))).is_none());
        assert!((f.mm_per_px(4589.2) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn derivative_is_that_of_finite_differences() {
        let f = fluoroscope();
        let x = point(&f);
        let (_, d) = f.project_with_derivative(&x).unwrap();
        for axis in 0..3 {
            let mut step = Vector3::zeros();
            step[axis] = 1e-3;
            let plus = f.project(&(x + step)).unwrap().pixel;
            let minus = f.project(&(x - step)).unwrap().pixel;
            let numeric = (plus - minus) / 2e-3;
            assert!((numeric - d.column(axis)).norm() < 1e-6, "axis {axis}: {numeric} {}", d.column(axis));
        }
    }
}
