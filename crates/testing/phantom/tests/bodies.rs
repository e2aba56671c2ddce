//! The bodies, their meshes and their ideal outlines, against each other and against what they promise.

// A test whose set-up fails has failed.
#![allow(clippy::unwrap_used)]

use biplane_geometry::{Curve, Mesh, Point2, Point3, Pose, Topology, Vector3};
use biplane_phantom::{Body, Solid, TrueFluoroscope, biplane, gradient, ideal_outline, mesh};
use nalgebra::UnitQuaternion;
use rand::Rng;
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;

/// Every surface there is, with a name.
fn solids() -> Vec<(String, &'static dyn Solid)> {
    let outer = Body::ALL.iter().map(|b| (b.name().to_owned(), b.solid()));
    let inner = Body::ALL.iter().filter_map(|b| Some((format!("{}'s inside", b.name()), b.inner()?)));
    outer.chain(inner).collect()
}

/// A pose within the view, turned anyhow.
fn pose(random: &mut Xoshiro256PlusPlus) -> Pose {
    let mut angle = || random.random_range(-3.0..3.0);
    let rotation = UnitQuaternion::from_euler_angles(angle(), angle(), angle());
    Pose::new(rotation, Vector3::from_fn(|_, _| random.random_range(-20.0..20.0)))
}

/// Area within all curves, px^2; holes count against.
fn enclosed(curves: &[Curve]) -> f64 {
    let sides = |c: &Curve| -> f64 {
        let p: Vec<_> = c.points.iter().map(|p| p.position.coords).collect();
        (0..p.len()).map(|i| p[i].perp(&p[(i + 1) % p.len()]) / 2.0).sum()
    };
    curves.iter().map(sides).sum()
}

/// Area of a mesh's shadow, px^2: how many of the points of a grid, `per_px` on a pixel's side, a triangle covers.
fn covered(mesh: &Mesh, pose: &Pose, view: &TrueFluoroscope, per_px: f64) -> f64 {
    let seen: Vec<Point2> =
        mesh.vertices().iter().map(|v| view.project(&pose.transform(v)).unwrap().0 * per_px).collect();
    let least = seen.iter().fold([f64::INFINITY; 2], |l, p| [l[0].min(p.x), l[1].min(p.y)]);
    let most = seen.iter().fold([f64::NEG_INFINITY; 2], |m, p| [m[0].max(p.x), m[1].max(p.y)]);
    let (left, top) = (least[0].floor() as i64, least[1].floor() as i64);
    let (width, height) = ((most[0].ceil() as i64 - left + 1), (most[1].ceil() as i64 - top + 1));
    let mut grid = vec![false; (width * height) as usize];
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(|v| seen[v as usize]);
        let turn = (b - a).perp(&(c - a)).signum();
        let low = a.coords.inf(&b.coords).inf(&c.coords).map(|v| v.ceil() as i64);
        let high = a.coords.sup(&b.coords).sup(&c.coords).map(|v| v.floor() as i64);
        for (x, y) in (low.y..=high.y).flat_map(|y| (low.x..=high.x).map(move |x| (x, y))) {
            let p = Point2::new(x as f64, y as f64);
            if [(a, b), (b, c), (c, a)].iter().all(|(from, to)| (to - from).perp(&(p - from)) * turn >= 0.0) {
                grid[((y - top) * width + x - left) as usize] = true;
            }
        }
    }
    grid.iter().filter(|c| **c).count() as f64 / (per_px * per_px)
}

#[test]
fn values_are_bounds_of_the_distance_and_boxes_hold_the_bodies() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    for (name, solid) in solids() {
        let (low, high) = solid.bounds();
        let mut point = |margin: f64| {
            Point3::from(Vector3::from_fn(|i, _| random.random_range(low[i] - margin..high[i] + margin)))
        };
        for k in 0..200_000 {
            let p = point(60.0);
            // Near neighbours too: the function may jump by little over a short way.
            let q = if k % 2 == 0 { point(60.0) } else { p + (point(0.0) - point(0.0)) * 1e-4 };
            let change = (solid.value(&p) - solid.value(&q)).abs();
            assert!(change <= (p - q).norm() * (1.0 + 1e-9) + 1e-12, "{name} between {p} and {q}");
        }
        for _ in 0..50_000 {
            let mut p = point(0.0);
            let axis = any_axis(&p);
            p[axis] = if p[axis] > (low[axis] + high[axis]) / 2.0 { high[axis] } else { low[axis] };
            assert!(solid.value(&p) > 0.0, "{name} reaches out of its box at {p}");
        }
    }
}

/// An axis that depends on nothing but the point.
fn any_axis(p: &Point3) -> usize {
    ((p.x + p.y + p.z) * 1e3).rem_euclid(3.0) as usize
}

#[test]
fn meshes_are_closed_even_and_on_the_surface() {
    let closed = Topology { open_edges: 0, non_manifold_edges: 0, inconsistent_edges: 0, bodies: 1 };
    for (name, solid) in solids() {
        for points in [3_500, 15_000, 36_000] {
            let mesh = mesh(solid, points).unwrap_or_else(|e| panic!("{name} of {points}: {e}"));
            let found = mesh.vertices().len() as f64;
            assert!((found / points as f64 - 1.0).abs() < 0.02, "{name}: {found} points for {points}");
            assert_eq!(mesh.topology(), closed, "{name} of {points}");
            let off = mesh.vertices().iter().map(|v| solid.value(v).abs()).fold(0.0, f64::max);
            assert!(off < 1e-6, "{name} of {points}: a vertex is {off} mm off");
            // Outward, and no triangle folded over: its normal is along the gradient, but for slivers over sharp rims.
            let against = (0..mesh.triangles().len())
                .filter(|&t| {
                    let [a, b, c] = mesh.corners(t);
                    let middle = Point3::from((a.coords + b.coords + c.coords) / 3.0);
                    mesh.area_vector(t).dot(&gradient(solid, &middle)) <= 0.0
                })
                .count();
            assert!(
                against * 2_000 <= mesh.triangles().len(),
                "{name} of {points}: {against} triangles inward"
            );
            let lengths: Vec<f64> = (0..mesh.triangles().len())
                .flat_map(|t| {
                    let [a, b, c] = mesh.corners(t);
                    [(b - a).norm(), (c - b).norm(), (a - c).norm()]
                })
                .collect();
            let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
            let spread =
                (lengths.iter().map(|l| (l - mean).powi(2)).sum::<f64>() / lengths.len() as f64).sqrt();
            let longest = lengths.iter().copied().fold(0.0, f64::max);
            println!(
                "{name} {points}: spacing {mean:.3} mm, varies by {:.3}, longest {longest:.3}",
                spread / mean
            );
            assert!(spread / mean < 0.13, "{name} of {points}: spacing varies by {}", spread / mean);
            assert!(longest < 2.5 * mean, "{name} of {points}: {longest} mm against {mean}");
        }
    }
}

#[test]
fn a_bones_shell_is_as_thick_as_cortical_bone() {
    for body in Body::ALL {
        let Some(inner) = body.inner() else { continue };
        // 1.2 to 4.5 mm by place, as `cortical_mm` says; the value is a bound, so the true shell is thicker near blends.
        for v in mesh(inner, 3_500).unwrap().vertices() {
            let depth = -body.solid().value(v);
            assert!((1.19..4.51).contains(&depth), "{}: shell of {depth} mm at {v}", body.name());
        }
    }
}

#[test]
fn the_tray_is_nearly_its_own_mirror_image() {
    let tray = Body::TibialTray.solid();
    let mesh = mesh(tray, 3_500).unwrap();
    let off: Vec<f64> =
        mesh.vertices().iter().map(|v| tray.value(&Point3::new(-v.x, v.y, v.z)).abs()).collect();
    let largest = off.iter().copied().fold(0.0, f64::max);
    assert!((0.9..2.1).contains(&largest), "{largest} mm between the tray and its mirror image");
}

#[test]
fn every_outline_point_is_where_a_ray_just_touches() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
    for body in Body::ALL {
        let solid = body.solid();
        for view in biplane(70.0) {
            let pose = pose(&mut random);
            let to_model = pose.inverse();
            let curves = ideal_outline(solid, &pose, &view, 0.5);
            let points: Vec<_> = curves.iter().flat_map(|c| &c.points).collect();
            for p in points.iter().step_by(17) {
                let source = to_model.transform(&view.source);
                let along = (to_model.transform(&view.detector_point(&p.position)) - source).normalize();
                let value = |s: f64| solid.value(&(source + along * s));
                // Samples through the body, then thirds around the lowest one.
                let lowest = |from: f64, to: f64, n: usize| {
                    let at = |i: usize| from + (to - from) * i as f64 / n as f64;
                    at((0..=n).min_by(|a, b| value(at(*a)).total_cmp(&value(at(*b)))).unwrap())
                };
                let mut at = lowest(350.0, 650.0, 6_000);
                for round in 0..12 {
                    let reach = 0.06 / f64::powi(3.0, round);
                    at = lowest(at - reach, at + reach, 8);
                }
                assert!(value(at).abs() < 1e-6, "{}: {} mm at {:?}", body.name(), value(at), p.position);
                let out = p.position + p.direction * 1e-3;
                let out = (to_model.transform(&view.detector_point(&out)) - source).normalize();
                assert!(solid.value(&(source + out * at)) > 0.0, "{}: normal into the shadow", body.name());
            }
            for curve in &curves {
                let n = curve.points.len();
                let gaps =
                    (0..n).map(|i| (curve.points[(i + 1) % n].position - curve.points[i].position).norm());
                let wide = gaps.filter(|g| *g > 0.75).count();
                assert!(wide * 50 <= n, "{}: {wide} of {n} gaps wider than 0.75 px", body.name());
            }
        }
    }
}

#[test]
fn outlines_enclose_the_shadow_of_a_fine_mesh() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
    for body in Body::ALL {
        let mesh = mesh(body.solid(), 200_000).unwrap();
        for view in biplane(70.0) {
            let pose = pose(&mut random);
            let ideal = enclosed(&ideal_outline(body.solid(), &pose, &view, 0.5));
            let shadow = covered(&mesh, &pose, &view, 4.0);
            let off = shadow / ideal - 1.0;
            println!("{}: {ideal:.2} px^2, its mesh's shadow {:.4} % off", body.name(), 100.0 * off);
            assert!(off.abs() < 5e-4, "{}: {ideal} px^2 enclosed, mesh {shadow}", body.name());
        }
    }
}

#[test]
fn the_shadow_of_a_mesh_falls_short_by_the_square_of_its_spacing() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(4);
    for body in Body::ALL {
        let [view, _] = biplane(70.0);
        let poses: Vec<Pose> = (0..3).map(|_| pose(&mut random)).collect();
        let ideal: f64 = poses.iter().map(|p| enclosed(&ideal_outline(body.solid(), p, &view, 0.25))).sum();
        let short = [3_500, 15_000, 36_000].map(|points| {
            let mesh = mesh(body.solid(), points).unwrap();
            ideal - poses.iter().map(|p| covered(&mesh, p, &view, 6.0)).sum::<f64>()
        });
        println!("{}: short by {short:?} of {ideal} px^2", body.name());
        // The square of the spacing goes with one over the number of points: 10.3 times from the first to the last.
        let ratio = short[0] / short[2] * 3_500.0 / 36_000.0;
        assert!(short[0] > short[1] && short[1] > short[2] && short[2] > 0.0, "{}: {short:?}", body.name());
        assert!((0.7..1.4).contains(&ratio), "{}: {ratio} of what the spacing says", body.name());
    }
}
