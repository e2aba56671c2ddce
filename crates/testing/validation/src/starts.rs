//! Seeded start poses around a known one.

use biplane_geometry::{Point3, Pose, Twist, Vector3};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// How starts are drawn: exactly this far off, in directions drawn evenly over the sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StartOffset {
    /// Displacement of the body's centroid, mm.
    pub translation_mm: f64,
    /// Angle of the rotation about the centroid, degrees.
    pub rotation_deg: f64,
    /// Starts a frame.
    pub count: usize,
    /// Seed.
    pub seed: u64,
}

/// Starts from which pictures are matched: exactly 6 mm and 6 degrees off in random directions.
pub const STARTS: StartOffset = StartOffset { translation_mm: 6.0, rotation_deg: 6.0, count: 20, seed: 1 };

/// A direction drawn evenly over the sphere.
fn direction(random: &mut Xoshiro256PlusPlus) -> Vector3 {
    let z: f64 = random.random_range(-1.0..=1.0);
    let a: f64 = random.random_range(0.0..std::f64::consts::TAU);
    let r = (1.0 - z * z).sqrt();
    Vector3::new(r * a.cos(), r * a.sin(), z)
}

impl StartOffset {
    /// The start poses around a reference: depend on seed, frame and number alone.
    pub fn draw(&self, reference: &Pose, centroid: &Point3, frame: usize) -> Vec<Pose> {
        let mut random =
            Xoshiro256PlusPlus::seed_from_u64(self.seed.wrapping_mul(1_000_003).wrapping_add(frame as u64));
        (0..self.count)
            .map(|_| {
                let twist = Twist {
                    translation: direction(&mut random) * self.translation_mm,
                    rotation: direction(&mut random) * self.rotation_deg.to_radians(),
                };
                reference.moved(&twist, &reference.transform(centroid))
            })
            .collect()
    }
}

/// Offsets of the thesis's pose variables (Eq. 3.1): independent Gaussian numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GaussianOffset {
    /// Standard deviation, mm or degrees.
    pub sigma: f64,
    /// Drawn again beyond this, mm or degrees.
    pub cut: f64,
}

/// As the thesis draws starts.
pub const SET_A: GaussianOffset = GaussianOffset { sigma: 10.0, cut: 20.0 };
/// Twice as far, and not cut.
pub const SET_B: GaussianOffset = GaussianOffset { sigma: 20.0, cut: f64::INFINITY };

impl GaussianOffset {
    /// Start poses around a reference, in its variables about the local origin `origin`. They depend on seed and frame alone.
    pub fn draw(
        &self,
        reference: &Pose,
        origin: &Point3,
        seed: u64,
        frame: usize,
        count: usize,
    ) -> Vec<Pose> {
        let mut random =
            Xoshiro256PlusPlus::seed_from_u64(seed.wrapping_mul(7_368_787).wrapping_add(frame as u64));
        let mut offset = || loop {
            // Box and Muller (1958).
            let (u, v): (f64, f64) = (1.0 - random.random::<f64>(), random.random());
            let drawn = self.sigma * (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos();
            if drawn.abs() <= self.cut {
                break drawn;
            }
        };
        (0..count).map(|_| offset_by(reference, origin, &std::array::from_fn(|_| offset()))).collect()
    }
}

/// A pose whose thesis variables about `origin` are off a reference's by x, y, z (mm), alpha, beta, gamma (degrees).
pub fn offset_by(reference: &Pose, origin: &Point3, by: &[f64; 6]) -> Pose {
    let (angles, t) = reference.to_thesis(origin.coords);
    let [a, b, c] = std::array::from_fn(|i| angles[i] + by[i + 3].to_radians());
    Pose::from_thesis(a, b, c, t + Vector3::new(by[0], by[1], by[2]), origin.coords)
}

/// Start poses of [`SET_A`] about the centroid.
pub fn set_a(reference: &Pose, centroid: &Point3, seed: u64, frame: usize, count: usize) -> Vec<Pose> {
    SET_A.draw(reference, centroid, seed, frame, count)
}

/// Turns of [`turned`], degrees.
const TURNS_DEG: [f64; 7] = [180.0, 170.0, -170.0, 90.0, -90.0, 45.0, -45.0];

/// Start poses turned far away about six axes of the body through its centroid: where a nearly symmetric body has its
/// wrong basins.
pub fn turned(reference: &Pose, centroid: &Point3) -> Vec<Pose> {
    let axes = [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 1.0],
        [1.0, 0.0, 1.0],
    ];
    axes.iter()
        .flat_map(|axis| TURNS_DEG.map(|deg| Vector3::from(*axis).normalize() * deg.to_radians()))
        .map(|turn| {
            let axes = reference.rotation() * turn;
            let twist = Twist { translation: Vector3::zeros(), rotation: axes };
            reference.moved(&twist, &reference.transform(centroid))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_are_of_the_thesis_variables_and_as_wide_as_is_said() {
        let (truth, origin) = (
            Pose::from_thesis(0.3, -0.4, 0.2, Vector3::new(5.0, -7.0, 9.0), Vector3::zeros()),
            Point3::new(4.0, 2.0, -30.0),
        );
        let off = |pose: &Pose| -> [f64; 6] {
            let ((a, t), (b, u)) = (pose.to_thesis(origin.coords), truth.to_thesis(origin.coords));
            std::array::from_fn(|i| if i < 3 { t[i] - u[i] } else { (a[i - 3] - b[i - 3]).to_degrees() })
        };
        let by = [3.0, -2.0, 1.0, 12.0, -7.0, 5.0];
        let found = off(&offset_by(&truth, &origin, &by));
        assert!((0..6).all(|i| (found[i] - by[i]).abs() < 1e-9), "{found:?}");
        let all: Vec<f64> = SET_A.draw(&truth, &origin, 1, 0, 2_000).iter().flat_map(off).collect();
        assert!(all.iter().all(|v| v.abs() <= 20.0 + 1e-9));
        let deviation = (all.iter().map(|v| v * v).sum::<f64>() / all.len() as f64).sqrt();
        // A normal number that is cut at two standard deviations keeps 0.88 of one.
        assert!((deviation - 8.8).abs() < 0.15, "{deviation}");
        assert!(SET_B.draw(&truth, &origin, 1, 0, 200).iter().flat_map(off).any(|v| v.abs() > 40.0));
    }
}
