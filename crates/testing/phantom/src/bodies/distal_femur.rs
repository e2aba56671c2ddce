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
        let medial_flare = round_cone(p, ([-1.0, 2.0, 20.0], 14.0), ([-18.0, -1.0, -20.0], 17.0));
        let lateral_flare = round_cone(p, ([1.0, 2.0, 16.0], 14.0), ([18.0, 0.0, -20.0], 16.5));
        let flare = union(union(medial_flare, lateral_flare, 14.0), shaft, 14.0);
        // Each condyle: a smaller round behind, a larger one below and before.
        let medial = union(
            capsule(p, [-24.0, -16.0, -26.0], [-19.0, -15.0, -26.0], 17.0),
            capsule(p, [-23.0, 2.0, -25.5], [-15.0, 3.0, -25.0], 20.5),
            12.0,
        );
        let lateral = union(
            capsule(p, [20.0, -14.0, -25.0], [24.0, -14.0, -25.0], 16.5),
            capsule(p, [15.0, 4.0, -24.5], [22.0, 3.0, -24.5], 20.5),
            12.0,
        );
        let trochlea = union(
            ellipsoid(p, [14.0, 9.0, -13.0], [13.0, 21.0, 22.0]),
            ellipsoid(p, [-13.0, 8.0, -16.0], [13.0, 19.0, 20.0]),
            14.0,
        );
        let epicondyles = ball(p, [-35.0, -4.0, -16.0], 6.0).min(ball(p, [34.0, -3.0, -16.0], 5.5));
        let ends = union(union(medial, lateral, 10.0), trochlea, 8.0);
        let whole = union(union(flare, ends, 10.0), epicondyles, 14.0);
        let groove = capsule(p, [1.0, 40.0, 6.0], [0.0, 33.0, -48.0], 13.0);
        let notch = capsule(p, [0.0, -36.0, -22.0], [0.0, 4.0, -57.0], 10.5);
        let carved = difference(difference(whole, groove, 7.0), notch, 7.0);
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
