//! The lower end of a thigh bone.

use biplane_geometry::Point3;

use super::{Bone, thickening};
use crate::Solid;
use crate::shapes::{ball, capsule, difference, ellipsoid, half_space, intersection, round_cone, union};

/// About 80 mm wide, 64 mm deep and 100 mm long: a shaft sawn off above, its flare, two condyles with the groove for the
/// kneecap before and the notch between them behind, and the epicondyles at the sides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DistalFemur;

impl Solid for DistalFemur {
    fn value(&self, p: &Point3) -> f64 {
        let shaft = round_cone(p, ([2.0, 4.0, 90.0], 14.0), ([0.0, 2.0, 5.0], 15.5));
        let medial_flare = round_cone(p, ([-1.0, 2.0, 22.0], 14.0), ([-20.0, -2.0, -22.0], 17.5));
        let lateral_flare = round_cone(p, ([1.0, 2.0, 18.0], 14.0), ([20.0, -1.0, -22.0], 17.0));
        let flare = union(union(medial_flare, lateral_flare, 14.0), shaft, 14.0);
        // Each condyle: a smaller round behind, a larger one below and before.
        let medial = union(
            capsule(p, [-26.0, -16.0, -27.0], [-21.0, -15.0, -27.0], 18.5),
            capsule(p, [-26.0, 0.0, -27.0], [-19.0, 2.0, -26.5], 21.0),
            12.0,
        );
        let lateral = union(
            capsule(p, [21.0, -14.0, -26.5], [27.0, -14.0, -26.0], 17.5),
            capsule(p, [18.0, 4.0, -25.5], [26.0, 1.0, -25.5], 21.0),
            12.0,
        );
        let trochlea = union(
            ellipsoid(p, [15.0, 10.0, -14.0], [14.0, 19.0, 22.0]),
            ellipsoid(p, [-15.0, 9.0, -17.0], [13.0, 17.0, 19.0]),
            6.0,
        );
        let epicondyles = ball(p, [-37.0, -5.0, -18.0], 6.0).min(ball(p, [37.0, -4.0, -18.0], 5.5));
        let ends = union(union(medial, lateral, 8.0), trochlea, 8.0);
        let whole = union(union(flare, ends, 10.0), epicondyles, 12.0);
        let groove = capsule(p, [1.0, 33.0, 8.0], [0.0, 20.0, -52.0], 9.0);
        let notch = capsule(p, [0.0, -34.0, -22.0], [0.0, 4.0, -54.0], 10.5);
        let carved = difference(difference(whole, groove, 14.0), notch, 8.0);
        intersection(carved, half_space(p, [0.0, 0.0, 52.0], [0.0, 0.0, 1.0]), 2.5)
    }

    fn bounds(&self) -> (Point3, Point3) {
        (Point3::new(-48.0, -38.0, -50.5), Point3::new(50.0, 32.0, 53.0))
    }
}

impl Bone for DistalFemur {
    fn cortical_mm(&self, p: &Point3) -> f64 {
        thickening(p.z, [-15.0, 50.0], [1.3, 4.5])
    }
}
