//! A kneecap.

use biplane_geometry::Point3;

use super::Bone;
use crate::Solid;
use crate::shapes::{ellipsoid, half_space, intersection, round_cone, union};

/// About 44 mm wide, 23 mm thick and 45 mm high, with two facets behind that meet in a ridge, and a blunt point below.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Patella;

impl Solid for Patella {
    fn value(&self, p: &Point3) -> f64 {
        let round = ellipsoid(p, [0.0, -1.0, 3.0], [23.0, 13.0, 20.0]);
        let point = round_cone(p, ([0.0, 0.0, -3.0], 11.0), ([1.0, 1.5, -17.5], 5.5));
        let whole = union(round, point, 10.0);
        // The lateral facet is the wider and flatter one.
        let lateral = half_space(p, [-3.0, -12.0, 0.0], [0.42, -1.0, 0.05]);
        let medial = half_space(p, [-3.0, -12.0, 0.0], [-0.6, -1.0, 0.05]);
        intersection(whole, intersection(lateral, medial, 3.0), 4.0)
    }

    fn bounds(&self) -> (Point3, Point3) {
        (Point3::new(-24.0, -15.0, -25.0), Point3::new(24.0, 14.0, 24.0))
    }
}

impl Bone for Patella {
    fn cortical_mm(&self, _: &Point3) -> f64 {
        1.2
    }
}
