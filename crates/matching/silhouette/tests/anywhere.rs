//! Poses drawn at random over all rotations, ideal outlines of the phantom's solids: truth that shares nothing with this crate.

// A test whose set-up fails has failed.
#![allow(clippy::unwrap_used)]

use biplane_artifact::Curves;
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Curve, EdgePoint, Mesh, Point2, Point3, Pose, Vector2, Vector3};
use biplane_phantom::{Body, TrueFluoroscope, biplane, ideal_outline, mesh};
use biplane_silhouette::{Candidate, SilhouetteLibrary};
use nalgebra::{Quaternion, UnitQuaternion};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// A rotation drawn evenly over all (Shoemake 1992), the centroid within 15 mm of the laboratory's origin along each axis.
fn random_pose(random: &mut Xoshiro256PlusPlus, centroid: &Point3) -> Pose {
    let [a, b, c]: [f64; 3] = std::array::from_fn(|_| random.random());
    let (b, c) = (std::f64::consts::TAU * b, std::f64::consts::TAU * c);
    let (r, s) = ((1.0 - a).sqrt(), a.sqrt());
    let q =
        UnitQuaternion::from_quaternion(Quaternion::new(s * c.cos(), r * b.sin(), r * b.cos(), s * c.sin()));
    let at = Vector3::from_fn(|_, _| random.random_range(-15.0..15.0));
    Pose::new(q, at - q * centroid.coords)
}

struct Bench {
    body: Body,
    mesh: Mesh,
    centroid: Point3,
    library: SilhouetteLibrary,
    views: [TrueFluoroscope; 2],
    fluoroscopes: [Fluoroscope; 2],
}

impl Bench {
    fn new(body: Body) -> Self {
        let mesh = mesh(body.solid(), 3500).unwrap();
        let views = biplane(90.0);
        Self {
            body,
            centroid: mesh.area_centroid(),
            library: SilhouetteLibrary::new(&mesh),
            mesh,
            fluoroscopes: views.each_ref().map(|v| Fluoroscope::from(&v.calibration("A"))),
            views,
        }
    }

    fn outlines(&self, pose: &Pose) -> [Curves; 2] {
        self.views.each_ref().map(|v| Curves(ideal_outline(self.body.solid(), pose, v, 1.0)))
    }

    /// The first `views` views.
    fn seen<'a>(&'a self, curves: &'a [Curves], views: usize) -> Vec<(&'a Fluoroscope, &'a Curves)> {
        self.fluoroscopes.iter().zip(curves).take(views).collect()
    }

    /// The place of the first candidate so near to the truth.
    fn place(&self, found: &[Candidate], truth: &Pose, degrees: f64, mm: f64) -> Option<usize> {
        found.iter().position(|c| {
            let error = c.pose.error_against(truth, &self.centroid);
            error.rotation_rad.to_degrees() < degrees && error.translation_mm < mm
        })
    }
}

#[test]
fn two_views_show_the_pose_at_first_and_one_view_among_few() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(11);
    for body in [Body::FemoralComponent, Body::TibialTray, Body::ProximalTibia] {
        let bench = Bench::new(body);
        for k in 0..6 {
            let truth = random_pose(&mut random, &bench.centroid);
            let curves = bench.outlines(&truth);
            let found = bench.library.starts(&bench.seen(&curves, 2), 1.0, 20);
            assert_eq!(bench.place(&found, &truth, 3.0, 1.0), Some(0), "{body:?} {k}: {found:?}");
            assert!(found[0].misfit_mm < 0.2, "{}", found[0].misfit_mm);
            let found = bench.library.starts(&bench.seen(&curves, 1), 1.0, 20);
            assert!(bench.place(&found, &truth, 8.0, 15.0).is_some(), "{body:?} {k}, one view: {found:?}");
        }
    }
}

/// Circles of many sizes all over a picture, half of them bright inside.
fn circles(random: &mut Xoshiro256PlusPlus, count: usize) -> Vec<Curve> {
    (0..count)
        .map(|k| {
            let mut at = |low: f64, high: f64| random.random_range(low..high);
            let (middle, radius) = (Point2::new(at(0.0, 1024.0), at(0.0, 1024.0)), at(10.0, 250.0));
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            let point = |j: usize| {
                let direction = Vector2::new((j as f64 / radius).cos(), (j as f64 / radius).sin());
                let position = middle + direction * radius;
                EdgePoint { position, direction: direction * sign, strength: 1.0, sigma_px: 0.1 }
            };
            Curve { points: (0..(4.0 * radius) as usize).map(point).collect(), closed: false }
        })
        .collect()
}

/// Of each view's outline a third is missing in one piece, the rest is noisy, and four times as many other edges are about.
#[test]
fn a_body_is_found_among_other_edges_though_a_third_of_it_is_missing() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(12);
    for body in [Body::FemoralComponent, Body::TibialTray, Body::DistalFemur] {
        let bench = Bench::new(body);
        for k in 0..5 {
            let truth = random_pose(&mut random, &bench.centroid);
            let mut curves = bench.outlines(&truth);
            for view in &mut curves {
                for curve in &mut view.0 {
                    let length = curve.points.len();
                    curve.points.rotate_left(random.random_range(0..length));
                    curve.points.truncate(2 * length / 3);
                    for p in &mut curve.points {
                        p.position += p.direction * random.random_range(-1.0..1.0);
                    }
                }
                view.0.extend(circles(&mut random, 20));
            }
            let found = bench.library.starts(&bench.seen(&curves, 2), 1.0, 20);
            assert!(bench.place(&found, &truth, 4.0, 2.0).is_some_and(|p| p < 3), "{body:?} {k}: {found:?}");
        }
    }
}

#[test]
fn a_bright_body_is_found_by_its_edges_the_other_way_round() {
    let bench = Bench::new(Body::TibialTray);
    let truth = random_pose(&mut Xoshiro256PlusPlus::seed_from_u64(13), &bench.centroid);
    let mut curves = bench.outlines(&truth);
    curves.iter_mut().flat_map(|c| &mut c.0).flat_map(|c| &mut c.points).for_each(|p| p.direction *= -1.0);
    let seen = bench.seen(&curves, 2);
    assert!(bench.library.isolated(&seen, 1.0, 20).is_empty());
    for found in [bench.library.isolated(&seen, -1.0, 20), bench.library.among(&seen, -1.0, 20)] {
        assert_eq!(bench.place(&found, &truth, 3.0, 1.0), Some(0), "{found:?}");
    }
}

#[test]
fn the_same_candidates_come_again() {
    let bench = Bench::new(Body::DistalFemur);
    let truth = random_pose(&mut Xoshiro256PlusPlus::seed_from_u64(14), &bench.centroid);
    let curves = bench.outlines(&truth);
    let again = SilhouetteLibrary::new(&bench.mesh);
    let seen = bench.seen(&curves, 2);
    assert_eq!(bench.library.isolated(&seen, 1.0, 20), again.isolated(&seen, 1.0, 20));
    assert_eq!(bench.library.among(&seen, 1.0, 20), again.among(&seen, 1.0, 20));
}

#[test]
fn where_there_is_nothing_to_find_there_is_no_candidate_and_no_panic() {
    let bench = Bench::new(Body::TibialTray);
    let none = [Curves::default(), Curves::default()];
    assert!(bench.library.starts(&[], 1.0, 20).is_empty());
    assert!(bench.library.starts(&bench.seen(&none, 2), 1.0, 20).is_empty());
    let point = |x: f64, y: f64, dx: f64| EdgePoint {
        position: Point2::new(x, y),
        direction: Vector2::new(dx, 0.0),
        strength: 1.0,
        sigma_px: 0.1,
    };
    let odd = vec![
        vec![point(500.0, 500.0, 1.0)],
        vec![point(f64::NAN, 3.0, 1.0), point(1e300, -1e300, f64::INFINITY)],
        vec![point(1e9, 1e9, 1.0); 40],
        (0..300).map(|k| point(512.0, f64::from(k), 1.0)).collect(),
    ];
    for points in odd {
        let curves = [Curves(vec![Curve { points, closed: false }]), Curves::default()];
        let found = bench.library.starts(&bench.seen(&curves, 2), 1.0, 20);
        assert!(found.iter().all(|c| c.misfit_mm.is_finite() && c.pose.translation().norm().is_finite()));
    }
    assert!(bench.library.starts(&bench.seen(&none, 2), 1.0, 0).is_empty());
}
