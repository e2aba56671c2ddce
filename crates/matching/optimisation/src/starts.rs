//! Start poses around a given one.

use biplane_geometry::{Point3, Pose, Twist, Vector3};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// A standard normal number (Box and Muller 1958).
pub(crate) fn normal(random: &mut Xoshiro256PlusPlus) -> f64 {
    let u: f64 = 1.0 - random.random::<f64>();
    let v: f64 = random.random();
    (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}

/// `count` poses around `pose`: each translation and rotation Gaussian, about the point `centroid` (model, mm).
pub(crate) fn around(
    pose: &Pose,
    centroid: &Point3,
    sigma_mm: f64,
    sigma_rad: f64,
    seed: u64,
    count: usize,
) -> Vec<Pose> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let center = pose.transform(centroid);
    (0..count)
        .map(|_| {
            let mut vector = |s: f64| {
                Vector3::new(s * normal(&mut random), s * normal(&mut random), s * normal(&mut random))
            };
            let twist = Twist { translation: vector(sigma_mm), rotation: vector(sigma_rad) };
            pose.moved(&twist, &center)
        })
        .collect()
}
