//! One body seen from another, frame by frame: a check of poses that needs no truth.
//!
//! Two bodies of a joint are matched from different edges, so errors of one do not follow those of the other. In frames
//! that follow each other closely the position of one in the frame of the other changes smoothly, and what does not is
//! error. A third difference removes any motion of constant acceleration and multiplies independent noise by the root of
//! 1 + 9 + 9 + 1 = 20.

use biplane_geometry::{Point3, Pose, Vector3};

/// Where `centroid` (model, mm) of a body at `body` lies in the model frame of another body at `other`, mm.
pub fn seen_from(other: &Pose, body: &Pose, centroid: &Point3) -> Point3 {
    other.inverse().transform(&body.transform(centroid))
}

/// Standard deviation of the noise of a track of positions, mm, for each axis; `None` for fewer than four.
pub fn noise(track: &[Point3]) -> Option<Vector3> {
    let thirds: Vec<Vector3> =
        track.windows(4).map(|p| (p[3].coords - p[0].coords) - (p[2].coords - p[1].coords) * 3.0).collect();
    let squares: Vector3 = thirds.iter().map(|d| d.component_mul(d)).sum();
    (!thirds.is_empty()).then(|| (squares / (20.0 * thirds.len() as f64)).map(f64::sqrt))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};

    #[test]
    fn noise_is_found_under_a_motion_of_constant_acceleration() {
        let mut random = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(2);
        let track: Vec<Point3> = (0..4000)
            .map(|k| {
                let t = f64::from(k) * 0.01;
                // Evenly drawn over +-0.3 mm: standard deviation 0.3 / sqrt(3) = 0.173 mm.
                Point3::new(3.0 * t * t - t, 2.0 + t + random.random_range(-0.3..0.3), 0.0)
            })
            .collect();
        let found = noise(&track).unwrap();
        assert!(found.x < 1e-9 && found.z == 0.0);
        assert!((found.y - 0.173).abs() < 0.01, "{}", found.y);
        assert_eq!(noise(&track[..3]), None);
    }
}
