//! A fluoroscope in the terms of cameras, which most formats speak in: focal lengths and principal point in px, three axes.
//!
//! `M = K R`: the third row of `M` is the unit normal away from the source, since `w` is a depth in mm. So
//! `K = [fx s cx; 0 fy cy; 0 0 1]` and the rows of `R` are the directions in which columns and rows grow and the normal.

use biplane_artifact::{Calibration, DistortionTable};
use nalgebra::{Matrix3, Point3, Vector3};

use super::CalibratedView;

/// A fluoroscope as a camera; pixels have the centre of the first one at (0, 0).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Camera {
    /// `fx`, `fy`, px.
    pub(crate) focal: [f64; 2],
    /// `s`, px.
    pub(crate) skew: f64,
    /// `cx`, `cy`, px.
    pub(crate) principal: [f64; 2],
    /// Rows: unit vectors along which columns grow, rows grow, and depth grows, in the laboratory.
    pub(crate) axes: Matrix3<f64>,
    /// The source, mm.
    pub(crate) source: Vector3<f64>,
}

impl Camera {
    /// Takes a projection apart.
    pub(crate) fn of(calibration: &Calibration) -> Self {
        let row = |i: usize| Vector3::from(calibration.matrix[i]);
        let normal = row(2);
        let (cx, cy) = (row(0).dot(&normal), row(1).dot(&normal));
        let y = row(1) - normal * cy;
        let fy = y.norm();
        let along_y = y / fy;
        let x = row(0) - normal * cx;
        let skew = x.dot(&along_y);
        let x = x - along_y * skew;
        let fx = x.norm();
        let axes = Matrix3::from_rows(&[x / fx, along_y, normal].map(|v| v.transpose()));
        Self { focal: [fx, fy], skew, principal: [cx, cy], axes, source: calibration.source.into() }
    }

    /// And puts it together.
    pub(crate) fn calibration(
        &self,
        view: &str,
        size: [usize; 2],
        distortion: Option<DistortionTable>,
    ) -> Calibration {
        let [fx, fy] = self.focal;
        let [cx, cy] = self.principal;
        let m = Matrix3::new(fx, self.skew, cx, 0.0, fy, cy, 0.0, 0.0, 1.0) * self.axes;
        Calibration {
            view: view.to_owned(),
            size,
            source: self.source.into(),
            matrix: [0, 1, 2].map(|i| [m[(i, 0)], m[(i, 1)], m[(i, 2)]]),
            distortion,
        }
    }

    /// Whether the picture is as seen from behind the detector.
    pub(crate) fn is_mirrored(&self) -> bool {
        self.axes.determinant() < 0.0
    }

    /// The one focal length of formats that have no other, px.
    pub(crate) fn mean_focal(&self) -> f64 {
        (self.focal[0] + self.focal[1]) / 2.0
    }

    /// Direction of the ray to a pixel, with a depth of 1 mm.
    pub(crate) fn ray(&self, pixel: [f64; 2]) -> Vector3<f64> {
        let y = (pixel[1] - self.principal[1]) / self.focal[1];
        let x = (pixel[0] - self.principal[0] - self.skew * y) / self.focal[0];
        self.axes.transpose() * Vector3::new(x, y, 1.0)
    }

    /// Where a point appears, px.
    pub(crate) fn project(&self, point: &Point3<f64>) -> [f64; 2] {
        let p = self.axes * (point.coords - self.source);
        let (x, y) = (p.x / p.z, p.y / p.z);
        [self.focal[0] * x + self.skew * y + self.principal[0], self.focal[1] * y + self.principal[1]]
    }
}

/// A rigid motion of the laboratory that a format makes, since it has another world: `x_file = R (x - origin)`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NewWorld {
    pub(crate) rotation: Matrix3<f64>,
    pub(crate) origin: Vector3<f64>,
}

impl NewWorld {
    /// The laboratory's frame stays.
    pub(crate) fn same() -> Self {
        Self { rotation: Matrix3::identity(), origin: Vector3::zeros() }
    }
}

/// Pixels along each side, and depths, at which two projections are compared.
const SAMPLES: usize = 5;
/// Depth of the farthest ones, mm, where the distance of the detector is not known.
const USUAL_DEPTH_MM: f64 = 1000.0;

/// Largest distance, px, between the projections of two views over their picture and the second half of their depth.
pub(crate) fn largest_difference(of: &CalibratedView, written: &CalibratedView, world: &NewWorld) -> f64 {
    let (a, b) = (Camera::of(&of.calibration), Camera::of(&written.calibration));
    let far = of.source_to_detector_mm().unwrap_or(USUAL_DEPTH_MM);
    let mut worst: f64 = 0.0;
    let steps = || (0..SAMPLES).map(|i| i as f64 / (SAMPLES - 1) as f64);
    for across in steps() {
        for down in steps() {
            let size = of.calibration.size.map(|n| n as f64 - 1.0);
            let pixel = [across * size[0], down * size[1]];
            for depth in steps().map(|s| far * (0.5 + 0.5 * s)) {
                let point = a.source + a.ray(pixel) * depth;
                let in_file = Point3::from(world.rotation * (point - world.origin));
                let at = b.project(&in_file);
                let difference = (at[0] - pixel[0]).hypot(at[1] - pixel[1]);
                if difference.is_nan() {
                    return f64::INFINITY;
                }
                worst = worst.max(difference);
            }
        }
    }
    worst
}

/// `U V'` of the singular value decomposition of a matrix that is nearly a rotation; how far it was from one.
pub(crate) fn nearest_rotation(r: Matrix3<f64>) -> (Matrix3<f64>, f64) {
    let off = (r * r.transpose() - Matrix3::identity()).abs().max();
    let svd = r.svd(true, true);
    match (svd.u, svd.v_t) {
        (Some(u), Some(v_t)) => (u * v_t, off),
        _ => (r, off),
    }
}
