//! The finite helical axis: the one line about which a body turned, and along which it slid, from one place to another.
//!
//! With `x' = R x + t`, `R` a turn by `theta` about the unit vector `n`: it slides `t . n` along the axis, which goes through
//! `(t - n (n . t) + cot(theta / 2) n x t) / 2`, the point of it that is nearest to the origin (Spoor and Veldpaus, "Rigid body motion calculated from
//! spatial co-ordinates of markers", 1980). Its place is as uncertain as the poses divided by `theta`, so below a least angle there is none.

use biplane_artifact::PoseRecord;
use biplane_geometry::{Pose, Vector3};

/// A turn about a line, and a slide along it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HelicalAxis {
    /// Unit vector, so that the turn is not negative.
    pub direction: [f64; 3],
    /// The point of the axis that is nearest to the origin, mm.
    pub point_mm: [f64; 3],
    /// By how much it turned, rad.
    pub angle_rad: f64,
    /// By how much it slid along the axis, mm.
    pub slide_mm: f64,
}

/// The axis of the motion from one relative pose to another (`x_proximal = R x_distal + t`), in the proximal body's axes; none below `least_rad`.
pub fn helical_axis(from: &PoseRecord, to: &PoseRecord, least_rad: f64) -> Option<HelicalAxis> {
    let (from, to) = (Pose::from(*from), Pose::from(*to));
    let rotation = to.rotation() * from.rotation().inverse();
    let moved: Vector3 = to.translation() - rotation * from.translation();
    let turn = rotation.scaled_axis();
    let angle = turn.norm();
    if angle.is_nan() || angle < least_rad.max(1e-9) {
        return None;
    }
    let n = turn / angle;
    let slide = n.dot(&moved);
    let point = (moved - n * slide + n.cross(&moved) / (angle / 2.0).tan()) / 2.0;
    Some(HelicalAxis { direction: n.into(), point_mm: point.into(), angle_rad: angle, slide_mm: slide })
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_geometry::Point3;
    use nalgebra::UnitQuaternion;

    #[test]
    fn a_screw_is_found_again() {
        let n = Vector3::new(1.0, -2.0, 0.5).normalize();
        let through = Vector3::new(3.0, 10.0, -7.0);
        let through = through - n * n.dot(&through);
        for angle in [0.05, 1.0, 3.1] {
            let turn = UnitQuaternion::from_scaled_axis(n * angle);
            let screw = |p: &Point3| Point3::from(turn * (p.coords - through) + through + n * 4.0);
            let from =
                Pose::new(UnitQuaternion::from_euler_angles(0.3, 0.2, -0.4), Vector3::new(20.0, -3.0, 8.0));
            let origin = screw(&Point3::from(from.translation()));
            let to = Pose::new(turn * from.rotation(), origin.coords);
            let found = helical_axis(&from.into(), &to.into(), 0.01).unwrap();
            assert!((Vector3::from(found.direction) - n).norm() < 1e-9);
            assert!((Vector3::from(found.point_mm) - through).norm() < 1e-7);
            assert!((found.angle_rad - angle).abs() < 1e-9 && (found.slide_mm - 4.0).abs() < 1e-9);
            assert_eq!(helical_axis(&from.into(), &to.into(), angle + 0.1), None);
        }
    }
}
