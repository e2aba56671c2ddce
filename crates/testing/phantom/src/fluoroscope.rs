//! A fluoroscope as it truly is: a source, and a flat detector with its axes (Eq. 3.3, in coordinates of the detector).
//!
//! A laboratory point `X` is seen where the ray from the source through it meets the detector; the detector's point
//! `centre + a along_x + b along_y` has the ideal pixel `((width - 1) / 2 + a / pixel_mm, (height - 1) / 2 + b / pixel_mm)`,
//! with the centre of the first pixel at (0, 0).

use biplane_artifact::Calibration;
use biplane_geometry::{Point2, Point3, Vector3};
use nalgebra::{Matrix3, Rotation3};

/// One fluoroscope without faults of its picture.
#[derive(Debug, Clone, PartialEq)]
pub struct TrueFluoroscope {
    /// The X-ray source, laboratory frame, mm.
    pub source: Point3,
    /// Middle of the detector, mm.
    pub centre: Point3,
    /// Unit vector along which pixel numbers `x` grow.
    pub along_x: Vector3,
    /// Unit vector along which pixel numbers `y` grow, at a right angle to `along_x`.
    pub along_y: Vector3,
    /// Side of a pixel on the detector, mm.
    pub pixel_mm: f64,
    /// Columns and rows.
    pub size: [usize; 2],
}

impl TrueFluoroscope {
    /// Unit normal of the detector, away from the source.
    pub fn normal(&self) -> Vector3 {
        let n = self.along_x.cross(&self.along_y);
        n * (self.centre - self.source).dot(&n).signum()
    }

    /// Distance of the source from the detector's plane, mm.
    pub fn source_to_detector_mm(&self) -> f64 {
        (self.centre - self.source).dot(&self.normal())
    }

    fn middle_px(&self) -> [f64; 2] {
        self.size.map(|n| (n as f64 - 1.0) / 2.0)
    }

    /// Ideal pixel and depth (mm, along the detector's normal) of a laboratory point; `None` at or behind the source's plane.
    pub fn project(&self, point: &Point3) -> Option<(Point2, f64)> {
        let ray = point - self.source;
        let depth = ray.dot(&self.normal());
        if depth <= 0.0 {
            return None;
        }
        let on_detector = self.source + ray * (self.source_to_detector_mm() / depth) - self.centre;
        let [mx, my] = self.middle_px();
        let pixel = Point2::new(
            mx + on_detector.dot(&self.along_x) / self.pixel_mm,
            my + on_detector.dot(&self.along_y) / self.pixel_mm,
        );
        Some((pixel, depth))
    }

    /// The point of the detector at an ideal pixel, mm.
    pub fn detector_point(&self, pixel: &Point2) -> Point3 {
        let [mx, my] = self.middle_px();
        self.centre
            + self.along_x * ((pixel.x - mx) * self.pixel_mm)
            + self.along_y * ((pixel.y - my) * self.pixel_mm)
    }

    /// Unit direction from the source to an ideal pixel.
    pub fn ray(&self, pixel: &Point2) -> Vector3 {
        (self.detector_point(pixel) - self.source).normalize()
    }

    /// The same in the product's terms, for a view called `view`; without distortion.
    pub fn calibration(&self, view: &str) -> Calibration {
        let [mx, my] = self.middle_px();
        let (normal, along) = (self.normal(), self.centre - self.source);
        let length = self.source_to_detector_mm();
        // Depth w = ray . n; x = mx + (ray . along_x length / w - along . along_x) / pixel, and so on.
        let row = |axis: &Vector3, middle: f64| {
            axis * (length / self.pixel_mm) + normal * (middle - along.dot(axis) / self.pixel_mm)
        };
        let (x, y) = (row(&self.along_x, mx), row(&self.along_y, my));
        let matrix = Matrix3::from_rows(&[x.transpose(), y.transpose(), normal.transpose()]);
        Calibration {
            view: view.to_owned(),
            size: self.size,
            source: self.source.coords.into(),
            matrix: std::array::from_fn(|i| std::array::from_fn(|j| matrix[(i, j)])),
            distortion: None,
        }
    }
}

/// Two fluoroscopes that look at the laboratory's origin from directions `angle_deg` apart in the plane z = 0, as in the
/// thesis: 1000 mm from source to intensifier, the origin midway, 1024 x 1024 pixels over 315 x 315 mm. The first looks
/// along +y, `y` of both pictures runs along -z.
pub fn biplane(angle_deg: f64) -> [TrueFluoroscope; 2] {
    [0.0, -angle_deg.to_radians()].map(|turn| {
        let about_z = Rotation3::from_axis_angle(&Vector3::z_axis(), turn);
        let at = |v: Vector3| Point3::from(about_z * v);
        TrueFluoroscope {
            source: at(Vector3::new(0.0, -500.0, 0.0)),
            centre: at(Vector3::new(0.0, 500.0, 0.0)),
            along_x: about_z * Vector3::x(),
            along_y: -Vector3::z(),
            pixel_mm: 315.0 / 1024.0,
            size: [1024, 1024],
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn projection_calibration_and_rays_agree() {
        let turn = Rotation3::from_euler_angles(0.02, -0.03, 0.4);
        let oblique = TrueFluoroscope {
            source: Point3::new(40.0, -620.0, 30.0),
            centre: Point3::new(-12.0, 480.0, 7.0),
            along_x: turn * Vector3::x(),
            along_y: turn * -Vector3::z(),
            pixel_mm: 0.29,
            size: [900, 1024],
        };
        for f in biplane(70.0).into_iter().chain([oblique]) {
            let c = f.calibration("A");
            for k in 0..50 {
                let s = f64::from(k);
                let p = Point3::new(60.0 * s.sin(), 50.0 * (2.0 * s).cos(), 40.0 * (3.0 * s).sin());
                let (pixel, depth) = f.project(&p).unwrap();
                let h = nalgebra::Matrix3::from_row_slice(&c.matrix.concat())
                    * (p.coords - Vector3::from(c.source));
                assert_relative_eq!(h.z, depth, epsilon = 1e-9);
                assert_relative_eq!(Point2::new(h.x / h.z, h.y / h.z), pixel, epsilon = 1e-9);
                let ray = f.ray(&pixel);
                assert!(ray.cross(&(p - f.source)).norm() < 1e-9);
            }
        }
    }

    #[test]
    fn views_stand_as_the_angle_says() {
        let [a, b] = biplane(90.0);
        assert_relative_eq!(b.source, Point3::new(-500.0, 0.0, 0.0), epsilon = 1e-9);
        assert_relative_eq!(a.normal(), Vector3::y(), epsilon = 1e-12);
        assert_relative_eq!(b.normal(), Vector3::x(), epsilon = 1e-12);
        assert_relative_eq!(a.source_to_detector_mm(), 1000.0);
    }
}
