//! How a pixel moves as its fluoroscope does: the derivative by the nine parameters of a calibration's covariance.
//!
//! The ray from the source `v` to a point `X` meets the detector's plane at `P = v + (X - v) l / w` (Eq. 3.3 of the thesis), `w` the
//! point's depth and `l` the detector's. With `A = (M_xy - p M_z) / l`, which turns a motion in that plane into one of the pixel `p`
//! and ignores motion along the ray, a small motion of the
//!
//! * source by `dv` moves the pixel by `(1 - l / w) A dv`: the ray turns about the point;
//! * detector by `dc` moves it by `-A dc`;
//! * detector about its middle `c` by the rotation vector `r` moves it by `A (P - c) x r`.
//!
//! Exact for any `M`: mirrored pictures, pixels that are not square, principal points anywhere. A matrix does not say how far the detector
//! is, only how far in pixels; so `l` is an argument.

use biplane_artifact::CalibrationUncertainty;
use biplane_geometry::{Point3, Vector3};
use nalgebra::{Matrix2x3, SMatrix};

use crate::Fluoroscope;

/// Parameters of a view: source, middle of the detector, rotation about that middle.
const VIEW: usize = CalibrationUncertainty::PARAMETERS;

impl Fluoroscope {
    /// Distance of the source from the detector's plane, mm, if a pixel has this side on it (of pixels that are not square the
    /// geometric mean), mm.
    pub fn source_to_detector_mm(&self, pixel_mm: f64) -> f64 {
        self.focal_px() * pixel_mm
    }

    /// Derivative of the ideal pixel of a laboratory point (mm) by the nine parameters of [`CalibrationUncertainty`], px/mm and
    /// px/rad, for a detector this far from the source, mm. `None` where the point is not in front of the source, and for a degenerate calibration.
    pub fn pixel_by_placement(
        &self,
        point: &Point3,
        source_to_detector_mm: f64,
    ) -> Option<SMatrix<f64, 2, VIEW>> {
        let length = source_to_detector_mm;
        let projection = self.project(point)?;
        let (pixel, matrix) = (projection.pixel, self.matrix());
        let by_plane = Matrix2x3::from_rows(&[
            matrix.row(0) - matrix.row(2) * pixel.x,
            matrix.row(1) - matrix.row(2) * pixel.y,
        ]) / length;
        let enlarged = length / projection.depth;
        let seen = (point - self.source()) * enlarged;
        let [x, y] = self.size().map(|n| (n as f64 - 1.0) / 2.0);
        let middle = matrix.try_inverse()? * Vector3::new(x, y, 1.0) * length;
        let mut all = SMatrix::<f64, 2, VIEW>::zeros();
        all.fixed_columns_mut::<3>(0).copy_from(&(by_plane * (1.0 - enlarged)));
        all.fixed_columns_mut::<3>(3).copy_from(&-by_plane);
        all.fixed_columns_mut::<3>(6).copy_from(&(by_plane * (seen - middle).cross_matrix()));
        Some(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_artifact::Calibration;
    use biplane_geometry::Point2;
    use nalgebra::{Matrix3, Rotation3};

    /// A source and a detector with its axes, projected by its definition: where the ray meets the plane.
    #[derive(Clone)]
    struct Placed {
        source: Point3,
        centre: Point3,
        axes: Matrix3<f64>,
        pixel_mm: [f64; 2],
    }

    impl Placed {
        fn pixel(&self, point: &Point3) -> Point2 {
            let normal = self.axes.column(2);
            let ray = point - self.source;
            let met = self.source + ray * ((self.centre - self.source).dot(&normal) / ray.dot(&normal));
            let on = self.axes.transpose() * (met - self.centre);
            Point2::new(449.5 + on.x / self.pixel_mm[0], 511.5 + on.y / self.pixel_mm[1])
        }

        fn length(&self) -> f64 {
            (self.centre - self.source).dot(&self.axes.column(2))
        }

        fn fluoroscope(&self) -> Fluoroscope {
            let d = self.axes.transpose() * (self.centre - self.source);
            let [px, py] = self.pixel_mm;
            let inner =
                Matrix3::new(d.z / px, 0.0, 449.5 - d.x / px, 0.0, d.z / py, 511.5 - d.y / py, 0.0, 0.0, 1.0);
            let m = inner * self.axes.transpose();
            Fluoroscope::from(&Calibration {
                view: "A".to_owned(),
                size: [900, 1024],
                source: self.source.coords.into(),
                matrix: std::array::from_fn(|i| std::array::from_fn(|j| m[(i, j)])),
                distortion: None,
            })
        }

        fn moved(&self, parameter: usize, by: f64) -> Self {
            let mut other = self.clone();
            let along = Vector3::from_fn(|i, _| if i == parameter % 3 { by } else { 0.0 });
            match parameter / 3 {
                0 => other.source += along,
                1 => other.centre += along,
                _ => other.axes = Rotation3::from_scaled_axis(along).matrix() * self.axes,
            }
            other
        }
    }

    fn placed(mirrored: bool, pixel_mm: [f64; 2]) -> Placed {
        let mut axes = *Rotation3::from_euler_angles(-1.5, 0.07, 0.4).matrix();
        if mirrored {
            axes.column_mut(0).neg_mut();
        }
        let (source, centre) = (Point3::new(40.0, -620.0, 30.0), Point3::new(-12.0, 480.0, 7.0));
        assert!((centre - source).dot(&axes.column(2)) > 0.0);
        Placed { source, centre, axes, pixel_mm }
    }

    #[test]
    fn the_derivative_by_the_placement_is_that_of_finite_differences() {
        let point = Point3::new(70.0, -20.0, 55.0);
        for truth in [placed(false, [0.29, 0.29]), placed(true, [0.29, 0.29]), placed(false, [0.29, 0.31])] {
            let fluoroscope = truth.fluoroscope();
            let pixel = fluoroscope.project(&point).unwrap().pixel;
            assert!((pixel - truth.pixel(&point)).norm() < 1e-9);
            let exact = fluoroscope.pixel_by_placement(&point, truth.length()).unwrap();
            for parameter in 0..VIEW {
                let step = if parameter < 6 { 1e-3 } else { 1e-6 };
                let at = |by: f64| truth.moved(parameter, by).pixel(&point);
                let numeric = (at(step) - at(-step)) / (2.0 * step);
                let own = exact.column(parameter);
                assert!((numeric - own).norm() < 1e-6 * (1.0 + own.norm()), "{parameter}: {numeric} {own}");
            }
        }
    }

    #[test]
    fn the_side_of_a_pixel_tells_how_far_the_detector_is_and_what_lies_behind_has_no_derivative() {
        let truth = placed(false, [0.29, 0.29]);
        let fluoroscope = truth.fluoroscope();
        assert!((fluoroscope.source_to_detector_mm(0.29) - truth.length()).abs() < 1e-9);
        let behind = truth.source - Vector3::y();
        assert!(fluoroscope.pixel_by_placement(&behind, 1000.0).is_none());
    }
}
