//! One fluoroscope by its nine numbers, and the place of a bead's shadow with its exact derivatives.
//!
//! Source `s`, middle of the detector `c`, rotation `R` whose columns are the directions of ideal `x`, of ideal `y`, and away
//! from the source; the size of a pixel is held. With `q = R'(X - s)` and `d = R'(c - s)` a point appears at
//! `middle + (q_xy d_z / q_z - d_xy) / pixel` (Eq. 3.3 of the thesis). The rays that touch a ball of radius `r` make a cone, and
//! the ellipse in which it meets the detector has its centre where `q_z` is replaced by `q_z - r^2 / q_z`: exact, from the
//! conic `(q.u)^2 = (|q|^2 - r^2) |u|^2` at `u_z = d_z`.
//!
//! In this crate pictures are always as seen from the source; those that are mirror images are turned round where they come in
//! and go out.

use biplane_geometry::{Point2, Point3, Vector3};
use nalgebra::{Matrix2x3, Matrix3, Rotation3, SMatrix};

/// Parameters of a view: source, middle of the detector, rotation about that middle.
pub(crate) const VIEW: usize = 9;

/// Where a source and a detector stand, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct View {
    pub source: Point3,
    pub centre: Point3,
    /// Laboratory from detector axes.
    pub rotation: Rotation3<f64>,
    pub pixel_mm: f64,
    /// Ideal pixel of the detector's middle.
    pub middle: Point2,
}

/// The centre of a shadow, and its derivatives.
pub(crate) struct Shadow {
    pub at: Point2,
    /// By source and middle (px/mm), and by the rotation about the middle along laboratory axes (px/rad).
    pub by_view: SMatrix<f64, 2, VIEW>,
    /// By the bead's place, px/mm.
    pub by_point: Matrix2x3<f64>,
}

impl View {
    /// Bead and detector's middle from the source, in detector axes; none unless the bead lies whole in front of the source.
    fn in_detector_axes(&self, point: &Point3, radius: f64) -> Option<(Vector3, Vector3)> {
        let q = self.rotation.inverse_transform_vector(&(point - self.source));
        let d = self.rotation.inverse_transform_vector(&(self.centre - self.source));
        (q.z > radius && d.z > 0.0).then_some((q, d))
    }

    /// Ideal pixel of the centre of a ball's shadow; none where the ball is not in front of the source. Of a point with
    /// radius 0.
    pub fn shadow(&self, point: &Point3, radius: f64) -> Option<Point2> {
        let (q, d) = self.in_detector_axes(point, radius)?;
        let scale = d.z / (q.z - radius * radius / q.z);
        Some(self.middle + (q.xy() * scale - d.xy()) / self.pixel_mm)
    }

    /// [`Self::shadow`] with its derivatives.
    pub fn shadow_with_derivatives(&self, point: &Point3, radius: f64) -> Option<Shadow> {
        let (q, d) = self.in_detector_axes(point, radius)?;
        let r2 = radius * radius;
        let depth = q.z - r2 / q.z;
        let scale = d.z / depth;
        let by_depth = -scale / depth * (1.0 + r2 / (q.z * q.z));
        let by_q = Matrix2x3::new(scale, 0.0, q.x * by_depth, 0.0, scale, q.y * by_depth) / self.pixel_mm;
        let by_d = Matrix2x3::new(-1.0, 0.0, q.x / depth, 0.0, -1.0, q.y / depth) / self.pixel_mm;
        let transposed = self.rotation.matrix().transpose();
        let (q_by_point, d_by_centre) = (by_q * transposed, by_d * transposed);
        // With R turned by a small w: R' exp(-w) v = R' (v + v x w).
        let arm = q_by_point * (point - self.source).cross_matrix()
            + d_by_centre * (self.centre - self.source).cross_matrix();
        // The rotation is about the detector's middle, which stays; so does the source.
        let mut by_view = SMatrix::<f64, 2, VIEW>::zeros();
        by_view.fixed_columns_mut::<3>(0).copy_from(&-(q_by_point + d_by_centre));
        by_view.fixed_columns_mut::<3>(3).copy_from(&d_by_centre);
        by_view.fixed_columns_mut::<3>(6).copy_from(&arm);
        Some(Shadow {
            at: self.middle + (q.xy() * scale - d.xy()) / self.pixel_mm,
            by_view,
            by_point: q_by_point,
        })
    }

    /// After a small step of the nine parameters.
    pub fn moved(&self, step: &[f64]) -> Self {
        let part = |i: usize| Vector3::from_fn(|k, _| step.get(i + k).copied().unwrap_or(0.0));
        let mut rotation = Rotation3::from_scaled_axis(part(6)) * self.rotation;
        rotation.renormalize();
        Self { source: self.source + part(0), centre: self.centre + part(3), rotation, ..*self }
    }

    /// Unit vector away from the source, at a right angle to the detector.
    pub fn normal(&self) -> Vector3 {
        self.rotation * Vector3::z()
    }

    /// Distance of the source from the detector's plane, mm.
    pub fn source_to_detector_mm(&self) -> f64 {
        (self.centre - self.source).dot(&self.normal())
    }

    /// Distance of a point from the source along the detector's normal, mm.
    pub fn depth(&self, point: &Point3) -> f64 {
        (point - self.source).dot(&self.normal())
    }

    /// Radius of a ball's shadow, px, along its shorter axis nearly.
    pub fn shadow_radius_px(&self, point: &Point3, radius: f64) -> f64 {
        radius * self.source_to_detector_mm() / (self.depth(point) * self.pixel_mm)
    }

    /// `M` of `w (x, y, 1) = M (X - source)`, `w` the depth in mm.
    pub fn matrix(&self) -> Matrix3<f64> {
        let d = self.rotation.inverse_transform_vector(&(self.centre - self.source));
        let p = self.pixel_mm;
        let intrinsic = Matrix3::new(
            d.z / p,
            0.0,
            self.middle.x - d.x / p,
            0.0,
            d.z / p,
            self.middle.y - d.y / p,
            0.0,
            0.0,
            1.0,
        );
        intrinsic * self.rotation.matrix().transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_phantom::{Ball, TrueFluoroscope, area_centroid, shadow_outline};

    fn oblique() -> (TrueFluoroscope, View) {
        let rotation = Rotation3::from_euler_angles(-1.5, 0.07, 0.4);
        let truth = TrueFluoroscope {
            source: Point3::new(40.0, -620.0, 30.0),
            centre: Point3::new(-12.0, 480.0, 7.0),
            along_x: rotation * Vector3::x(),
            along_y: rotation * Vector3::y(),
            pixel_mm: 0.29,
            size: [900, 1024],
        };
        let view = View {
            source: truth.source,
            centre: truth.centre,
            rotation,
            pixel_mm: truth.pixel_mm,
            middle: Point2::new(449.5, 511.5),
        };
        assert!(view.source_to_detector_mm() > 0.0);
        (truth, view)
    }

    #[test]
    fn a_shadow_is_where_the_phantom_has_it() {
        let (truth, view) = oblique();
        for radius in [0.0, 1.5, 20.0] {
            let ball = Ball { centre: Point3::new(70.0, -120.0, 55.0), radius };
            let (projected, depth) = truth.project(&ball.centre).unwrap();
            let at = view.shadow(&ball.centre, radius).unwrap();
            assert!((view.depth(&ball.centre) - depth).abs() < 1e-9);
            if radius == 0.0 {
                assert!((at - projected).norm() < 1e-9);
                let h = view.matrix() * (ball.centre - view.source);
                assert!((h.xy() / h.z - projected.coords).norm() < 1e-9);
            } else {
                let outline = area_centroid(&shadow_outline(&truth, &ball).unwrap()).unwrap();
                // The phantom's polygon of 128 corners has its centroid within a thousandth of this shift.
                let shift = (outline - projected).norm();
                assert!((at - outline).norm() < 1e-3 * shift, "{at} {outline} {projected}");
            }
        }
        assert!(view.shadow(&Point3::new(40.0, -700.0, 30.0), 0.0).is_none());
    }

    #[test]
    fn derivatives_are_those_of_finite_differences() {
        let (_, view) = oblique();
        let (point, radius) = (Point3::new(70.0, -20.0, 55.0), 8.0);
        let shadow = view.shadow_with_derivatives(&point, radius).unwrap();
        assert!((shadow.at - view.shadow(&point, radius).unwrap()).norm() < 1e-12);
        for k in 0..VIEW {
            let h = if k < 6 { 1e-3 } else { 1e-6 };
            let at = |s: f64| {
                let mut step = [0.0; VIEW];
                step[k] = s * h;
                view.moved(&step).shadow(&point, radius).unwrap()
            };
            let numeric = (at(1.0) - at(-1.0)) / (2.0 * h);
            let exact = shadow.by_view.column(k);
            assert!((numeric - exact).norm() < 1e-6 * (1.0 + exact.norm()), "{k}: {numeric} {exact}");
        }
        for k in 0..3 {
            let at = |s: f64| {
                let mut p = point;
                p[k] += s * 1e-3;
                view.shadow(&p, radius).unwrap()
            };
            let numeric = (at(1.0) - at(-1.0)) / 2e-3;
            assert!((numeric - shadow.by_point.column(k)).norm() < 1e-6);
        }
    }
}
