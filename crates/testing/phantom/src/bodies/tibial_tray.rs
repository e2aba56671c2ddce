//! A tibial tray: a kidney-shaped plate on a stem with two fins.

use biplane_geometry::Point3;

use crate::Solid;
use crate::shapes::{difference, ellipsoid, half_space, hypotenuse, intersection, plate, round_cone, union};

/// A plate of about 74 x 48 x 5 mm on a stem of 40 mm. It is nearly its own mirror image: the medial side is larger by
/// 1.5 mm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TibialTray;

/// Height of the plate's middle.
const PLATE: f64 = 13.5;

/// A fin from the stem outwards and a little backwards, its lower edge rising to the side.
fn fin(p: &Point3) -> f64 {
    let x = p.x.abs();
    let (sine, cosine) = 18.0_f64.to_radians().sin_cos();
    let along = x * cosine - p.y * sine;
    let across = x * sine + p.y * cosine;
    let slope = half_space(&Point3::new(along, 0.0, p.z), [21.0, 0.0, 8.0], [1.0, 0.0, -0.9]);
    let blade = intersection(slope, (p.z - PLATE + 1.0).max(-along - 4.0), 2.0);
    plate(blade, across, 1.75, 1.2)
}

impl Solid for TibialTray {
    fn value(&self, p: &Point3) -> f64 {
        let flat = Point3::new(p.x, p.y, 0.0);
        let lobes = round_cone(&flat, ([-13.0, 0.5, 0.0], 24.5), ([13.5, 0.5, 0.0], 23.0));
        let front = ellipsoid(&flat, [0.0, 2.0, 0.0], [30.0, 24.5, 30.0]);
        let kidney = difference(union(lobes, front, 4.0), hypotenuse(p.x, p.y + 30.5) - 9.5, 10.0);
        let base = plate(kidney, p.z - PLATE, 2.5, 1.2);
        let stem = round_cone(p, ([0.0, 1.0, 18.0], 8.4), ([0.0, 1.0, -20.5], 6.0)).max(p.z - PLATE + 1.0);
        union(base, union(stem, fin(p), 3.0), 3.0)
    }

    fn bounds(&self) -> (Point3, Point3) {
        (Point3::new(-38.5, -25.0, -27.5), Point3::new(37.5, 27.5, 17.0))
    }
}
