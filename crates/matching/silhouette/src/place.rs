//! Where a body may be, and which of many such places are one.

use biplane_geometry::{Point3, Pose};
use nalgebra::UnitQuaternion;

/// A pose of the centroid, and how badly it fits.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    pub rotation: UnitQuaternion<f64>,
    /// Where the body's centroid is, mm.
    pub centre: Point3,
    /// Smaller is better; what it measures, who makes it says.
    pub misfit: f64,
}

impl Place {
    /// Of a pose of a body whose model's origin is its centroid.
    pub fn of(pose: &Pose, misfit: f64) -> Self {
        Self { rotation: pose.rotation(), centre: Point3::from(pose.translation()), misfit }
    }

    /// The pose of a body whose model's origin is its centroid.
    pub fn pose(&self) -> Pose {
        Pose::new(self.rotation, self.centre.coords)
    }
}

/// The best `count` places, the best first, none nearer to a better one than `apart`: rad, and mm of the centroid.
pub(crate) fn distinct(mut places: Vec<Place>, apart: (f64, f64), count: usize) -> Vec<Place> {
    places.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
    let mut kept: Vec<Place> = Vec::new();
    for place in places {
        let far = |k: &Place| {
            k.rotation.angle_to(&place.rotation) > apart.0 || (k.centre - place.centre).norm() > apart.1
        };
        if kept.len() == count {
            break;
        }
        if kept.iter().all(far) {
            kept.push(place);
        }
    }
    kept
}
