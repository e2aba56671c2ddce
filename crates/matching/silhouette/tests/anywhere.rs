#![allow(clippy::unwrap_used)]

//! Poses drawn at random over all rotations, ideal outlines of the phantom's solids: truth that shares nothing with this crate.

use biplane_artifact::Curves;
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Point3, Pose, Vector3};
use biplane_phantom::{Body, biplane, ideal_outline, mesh};
use biplane_silhouette::SilhouetteLibrary;
use nalgebra::{Quaternion, UnitQuaternion};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// A rotation drawn evenly over all (Shoemake 1992), the centroid within 15 mm of the laboratory's origin.
fn random_pose(random: &mut Xoshiro256PlusPlus, centroid: &Point3) -> Pose {
    let [a, b, c]: [f64; 3] = std::array::from_fn(|_| random.random());
    let (b, c) = (std::f64::consts::TAU * b, std::f64::consts::TAU * c);
    let (r, s) = ((1.0 - a).sqrt(), a.sqrt());
    let q =
        UnitQuaternion::from_quaternion(Quaternion::new(s * c.cos(), r * b.sin(), r * b.cos(), s * c.sin()));
    let at = Vector3::from_fn(|_, _| random.random_range(-15.0..15.0));
    Pose::new(q, at - q * centroid.coords)
}

/// Of so many poses, the place of the first candidate within 10 degrees and 5 mm; `None` where there is none.
fn places(body: Body, poses: usize, count: usize) -> Vec<Option<usize>> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(11);
    let mesh = mesh(body.solid(), 3500).unwrap();
    let centroid = mesh.area_centroid();
    let library = SilhouetteLibrary::new(&mesh);
    let views = biplane(90.0);
    let fluoroscopes = views.each_ref().map(|v| Fluoroscope::from(&v.calibration("A")));
    (0..poses)
        .map(|_| {
            let truth = random_pose(&mut random, &centroid);
            let curves = views.each_ref().map(|v| Curves(ideal_outline(body.solid(), &truth, v, 1.0)));
            let seen: Vec<_> = fluoroscopes.iter().zip(&curves).collect();
            let found = library.starts(&seen, 1.0, count);
            found.iter().position(|c| {
                let error = c.pose.error_against(&truth, &centroid);
                error.rotation_rad.to_degrees() < 10.0 && error.translation_mm < 5.0
            })
        })
        .collect()
}

#[test]
fn two_views_show_the_pose_among_few() {
    for body in Body::ALL {
        let places = places(body, 60, 20);
        let within = |n: usize| places.iter().filter(|p| p.is_some_and(|p| p < n)).count();
        println!(
            "{body:?}: first {} first 3 {} first 10 {} first 20 {}",
            within(1),
            within(3),
            within(10),
            within(20)
        );
        assert!(within(20) >= 59, "{body:?}: {places:?}");
    }
}
