//! The upper end of a shin bone.

use biplane_geometry::Point3;

use super::{Bone, thickening};
use crate::Solid;
use crate::shapes::{
    capsule, difference, ellipsoid, half_space, hypotenuse, intersection, plate, round_cone, union,
};

/// About 76 mm wide, 52 mm deep and 90 mm long: the plateau with the eminence, the tuberosity before, the shaft sawn off
/// below.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ProximalTibia;

impl Solid for ProximalTibia {
    fn value(&self, p: &Point3) -> f64 {
        // The plateau slopes down behind by 6 degrees: `along` and `up` turn with it.
        let (sine, cosine) = (0.1, 0.99_f64.sqrt());
        let (along, up) = (p.y * cosine - (p.z - 28.0) * sine, p.y * sine + (p.z - 28.0) * cosine);
        let lobes = union(
            hypotenuse(p.x + 14.0, along - 0.5) - 24.0,
            hypotenuse(p.x - 14.5, along + 1.0) - 22.5,
            14.0,
        );
        let kidney = difference(lobes, hypotenuse(p.x - 1.0, along + 31.0) - 10.0, 10.0);
        let plateau = plate(kidney, up, 8.0, 5.0);
        let medial = round_cone(p, ([-13.5, -0.5, 19.0], 22.0), ([-1.0, -2.0, -20.0], 13.0));
        let lateral = round_cone(p, ([14.5, -1.5, 19.0], 20.5), ([1.0, -2.0, -20.0], 13.0));
        let shaft = round_cone(p, ([0.0, -2.0, 0.0], 15.0), ([-2.0, -4.0, -80.0], 12.0));
        let crest = capsule(p, [2.0, 14.0, -2.0], [0.0, 5.0, -80.0], 5.0);
        let tuberosity = ellipsoid(p, [3.0, 17.0, -3.0], [8.0, 7.0, 15.0]);
        let eminence = union(
            ellipsoid(p, [-4.5, 0.0, 35.0], [4.0, 8.0, 9.0]),
            ellipsoid(p, [5.5, -1.0, 34.5], [4.0, 7.0, 8.5]),
            3.0,
        );
        let ends = union(union(medial, lateral, 12.0), plateau, 7.0);
        let whole = union(union(ends, union(shaft, crest, 12.0), 10.0), tuberosity, 9.0);
        let topped = union(whole, eminence, 3.0);
        intersection(topped, half_space(p, [0.0, 0.0, -50.0], [0.0, 0.0, -1.0]), 2.5)
    }

    fn bounds(&self) -> (Point3, Point3) {
        (Point3::new(-41.0, -29.0, -51.0), Point3::new(41.0, 29.0, 44.0))
    }
}

impl Bone for ProximalTibia {
    fn cortical_mm(&self, p: &Point3) -> f64 {
        thickening(-p.z, [-15.0, 45.0], [1.3, 4.0])
    }
}
