//! Searches of a surface against looking at every triangle, and against what is known of a ball.

#![allow(clippy::unwrap_used)]

use biplane_geometry::{Mesh, Point3, Vector3};
use biplane_phantom::{Body, ball_mesh, mesh};
use biplane_surface::{MeshCheck, Spread, Surface, distances, farthest, spread_points};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

fn any(random: &mut Xoshiro256PlusPlus, size: f64) -> Point3 {
    Point3::from(Vector3::from_fn(|_, _| random.random_range(-size..size)))
}

/// Triangles of all sizes that have nothing to do with each other.
fn soup(count: usize, random: &mut Xoshiro256PlusPlus) -> Mesh {
    let triangle = |_| {
        let (middle, size) = (any(random, 50.0), 10.0_f64.powf(random.random_range(-2.0..1.3)));
        [0; 3].map(|_| middle + any(random, size).coords)
    };
    Mesh::from_soup(&(0..count).map(triangle).collect::<Vec<_>>()).unwrap()
}

/// Distance from a triangle by its plane and its sides, written another way than in the code.
fn distance_from(place: &Point3, [a, b, c]: [Point3; 3]) -> f64 {
    let normal = (b - a).cross(&(c - a)).normalize();
    let height = (place - a).dot(&normal);
    let foot = place - normal * height;
    let inner = |p: Point3, q: Point3| (q - p).cross(&(foot - p)).dot(&normal) >= 0.0;
    if inner(a, b) && inner(b, c) && inner(c, a) {
        return height.abs();
    }
    let from_side = |p: Point3, q: Point3| {
        let t = ((place - p).dot(&(q - p)) / (q - p).norm_squared()).clamp(0.0, 1.0);
        (place - (p + (q - p) * t)).norm()
    };
    from_side(a, b).min(from_side(b, c)).min(from_side(c, a))
}

#[test]
fn closest_points_are_those_of_a_scan() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    for count in [1, 3, 5, 17, 400] {
        let mesh = soup(count, &mut random);
        let surface = Surface::new(&mesh);
        for round in 0..300 {
            let place = any(&mut random, if round % 3 == 0 { 3000.0 } else { 60.0 });
            let all = (0..mesh.triangles().len()).map(|t| distance_from(&place, mesh.corners(t)));
            let truth = all.fold(f64::INFINITY, f64::min);
            let found = surface.closest(&place);
            assert!((found.distance_mm - truth).abs() < 1e-9 * (1.0 + truth), "{found:?} {truth}");
            assert!(((place - found.at).norm() - truth).abs() < 1e-9 * (1.0 + truth));
            assert!(distance_from(&found.at, mesh.corners(found.triangle as usize)) < 1e-10);
            let near = surface.closest_near(&place, random.random_range(0..mesh.triangles().len() as u32));
            assert!((near.distance_mm - truth).abs() < 1e-9 * (1.0 + truth));
            assert_eq!(surface.closest_within(&place, truth * 0.999), None);
            assert_eq!(
                surface.closest_within(&place, truth * 1.001 + 1e-9).unwrap().distance_mm,
                found.distance_mm
            );
        }
    }
}

#[test]
fn odd_places_are_answered() {
    let surface = Surface::new(&ball_mesh(10.0, 300).unwrap());
    for place in [[1e300, 0.0, 0.0], [0.0, -1e30, 2.0], [1e19, 1e19, 1e19]] {
        let found = surface.closest(&Point3::from(place));
        assert!((found.at.coords.norm() - 10.0).abs() < 0.5, "{found:?}");
    }
    assert!(surface.closest(&Point3::new(f64::NAN, 0.0, 0.0)).distance_mm.is_nan());
    assert_eq!(surface.winding_number(&Point3::new(f64::NAN, 0.0, 0.0)), 0);
}

#[test]
fn segments_are_triangles_without_width() {
    let points = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 3.0, 0.0]].map(Point3::from);
    let lines = Surface::of_segments(&points, &[[0, 1], [1, 2]]).unwrap();
    for (place, at) in [
        ([1.0, -1.0, 0.5], [1.0, 0.0, 0.0]),
        ([3.0, 1.5, 1.0], [2.0, 1.5, 0.0]),
        ([-4.0, 1.0, 0.0], [0.0; 3]),
        ([3.0, 9.0, 0.0], [2.0, 3.0, 0.0]),
    ] {
        assert!((lines.closest(&Point3::from(place)).at - Point3::from(at)).norm() < 1e-12);
    }
    assert!(Surface::of_segments(&points, &[]).is_none());
    assert!(Surface::of_segments(&points, &[[0, 3]]).is_none());
}

#[test]
fn inside_and_outside_are_those_of_solids() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
    for body in Body::ALL {
        let mesh = mesh(body.solid(), 4000).unwrap();
        let surface = Surface::new(&mesh);
        let (low, high) = body.solid().bounds();
        for _ in 0..3000 {
            let share = Vector3::from_fn(|_, _| random.random_range(-0.1..1.1));
            let place = low + (high - low).component_mul(&share);
            let distance = surface.signed_distance(&place);
            assert_eq!(surface.winding_number(&place), i32::from(distance < 0.0), "{} {place}", body.name());
            // The mesh lies within about 0.3 mm of the solid.
            let value = body.solid().value(&place);
            assert!(
                value.abs() < 0.5 || (value < 0.0) == (distance < 0.0),
                "{} {place} {value}",
                body.name()
            );
        }
    }
}

#[test]
fn distances_from_a_ball_are_those_of_its_mesh() {
    let surface = Surface::new(&ball_mesh(20.0, 10_000).unwrap());
    let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
    for _ in 0..2000 {
        let place = any(&mut random, 40.0);
        let off = surface.signed_distance(&place) - (place.coords.norm() - 20.0);
        // Chords of edges of 0.8 mm lie inside by up to 0.8^2 / 3 / 20 / 2.
        assert!((-1e-9..0.006).contains(&off), "{off}");
    }
    // At corners and on edges, where three faces have different signs.
    let mesh = ball_mesh(20.0, 12).unwrap();
    let surface = Surface::new(&mesh);
    for v in mesh.vertices() {
        assert!((surface.signed_distance(&(v * 1.01)) - 0.2).abs() < 1e-9);
        assert!(surface.signed_distance(&(v * 0.99)) < 0.0);
    }
}

/// Rays through corners and along edges and faces: the winding number is that of the place all the same.
#[test]
fn winding_numbers_are_right_beside_corners() {
    let at = |x: f64, y: f64, z: f64| Point3::new(x, y, z);
    let corner = |i: usize| at((i & 1) as f64 * 4.0, (i >> 1 & 1) as f64 * 4.0, (i >> 2) as f64 * 4.0);
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]).collect();
    let cube = Mesh::new((0..8).map(corner).collect(), triangles).unwrap();
    let surface = Surface::new(&cube);
    for x in [-3.0, -1.0, 1.0, 2.0, 3.0, 5.0] {
        for y in [-1.0, 0.0, 1.0, 2.0, 4.0, 5.0] {
            for z in [-1.0, 0.0, 1.0, 2.0, 4.0, 5.0] {
                let strictly = |c: f64| c > 0.0 && c < 4.0;
                let on = |c: f64| c == 0.0 || c == 4.0;
                let winding = surface.winding_number(&at(x, y, z));
                if strictly(x) && strictly(y) && strictly(z) {
                    assert_eq!(winding, 1);
                } else if !(strictly(x) && (on(y) || on(z))) {
                    assert_eq!(winding, 0, "{x} {y} {z}");
                }
                assert!((0..=1).contains(&winding));
            }
        }
    }
    assert_eq!(Surface::new(&cube.inverted()).winding_number(&at(1.0, 2.0, 2.0)), -1);
}

#[test]
fn points_are_spread_by_area() {
    let ball = ball_mesh(10.0, 2000).unwrap();
    let points = spread_points(&ball, 20_000);
    assert_eq!(points.len(), 20_000);
    let upper = points.iter().filter(|p| p.z > 6.0).count() as f64 / 20_000.0;
    assert!((upper - 0.2).abs() < 0.003, "a cap of height 4 of 20 has a fifth of the area, found {upper}");
    let off = Spread::of(&distances(&ball, &Surface::new(&ball_mesh(10.5, 20_000).unwrap()), 5000));
    assert!(off.median > 0.495 && off.worst < 0.53 && off.mean <= off.rms && off.p95 <= off.worst, "{off:?}");
}

#[test]
fn spreads_are_ranks() {
    let values: Vec<f64> = (1..=100).rev().map(f64::from).collect();
    let spread = Spread::of(&values);
    assert_eq!((spread.median, spread.p95, spread.worst, spread.mean), (50.0, 95.0, 100.0, 50.5));
    assert_eq!(Spread::of(&[]), Spread::default());
    assert_eq!(Spread::of(&[7.0]).median, 7.0);
}

/// The farthest point of one ball from another that is shifted and larger; and of coarse meshes from fine ones, against dense samples.
#[test]
fn farthest_is_between_its_bounds() {
    let (a, b) = (ball_mesh(10.0, 9000).unwrap(), ball_mesh(12.0, 9000).unwrap());
    let found = farthest(&a, &Surface::new(&b), 1e-3);
    assert!(
        found.at_most_mm - found.at_least_mm <= 1e-3 && (found.at_least_mm - 2.0).abs() < 0.01,
        "{found:?}"
    );
    for body in [Body::Patella, Body::TibialTray, Body::FemoralComponent] {
        let fine = mesh(body.solid(), 20_000).unwrap();
        let coarse = mesh(body.solid(), 2_000).unwrap();
        for (from, to) in [(&fine, &coarse), (&coarse, &fine)] {
            let surface = Surface::new(to);
            let found = farthest(from, &surface, 1e-3);
            assert!(found.at_most_mm - found.at_least_mm <= 1e-3, "{found:?}");
            let sampled = Spread::of(&distances(from, &surface, 100_000));
            assert!(sampled.worst <= found.at_most_mm + 1e-9, "{sampled:?} {found:?}");
            assert!(sampled.worst > found.at_least_mm * 0.7, "{sampled:?} {found:?}");
            assert!((surface.closest(&found.at).distance_mm - found.at_least_mm).abs() < 1e-9);
        }
    }
}

#[test]
fn faults_of_a_mesh_are_found_where_they_are() {
    let ball = ball_mesh(10.0, 400).unwrap();
    let whole = MeshCheck::of(&ball);
    assert!(whole.is_closed_manifold());
    assert_eq!(whole.pieces, 1);
    assert!((whole.signed_volume_mm3 - ball.signed_volume()).abs() < 1e-9);
    // One triangle left out, one turned round, one added on an edge, and a second ball that hangs on a vertex.
    let (vertices, triangles) = (ball.vertices().to_vec(), ball.triangles().to_vec());
    let check = |vertices: &[Point3], triangles: &[[u32; 3]]| {
        MeshCheck::of(&Mesh::new(vertices.to_vec(), triangles.to_vec()).unwrap())
    };
    let edges_of = |t: [u32; 3]| {
        let mut edges = [0, 1, 2].map(|k| [t[k].min(t[(k + 1) % 3]), t[k].max(t[(k + 1) % 3])]).to_vec();
        edges.sort_unstable();
        edges
    };
    let open = check(&vertices, &triangles[1..]);
    assert_eq!(open.open_edges, edges_of(triangles[0]));
    assert!(!open.is_closed_manifold() && open.is_manifold());
    let mut turned = triangles.clone();
    turned[7].swap(0, 1);
    assert_eq!(check(&vertices, &turned).inconsistent_edges, edges_of(triangles[7]));
    let mut winged = (vertices.clone(), triangles.clone());
    winged.0.push(Point3::new(0.0, 0.0, 30.0));
    let [a, b, _] = triangles[3];
    winged.1.push([a, b, vertices.len() as u32]);
    let check_winged = check(&winged.0, &winged.1);
    assert_eq!(check_winged.crowded_edges, [[a.min(b), a.max(b)]]);
    assert_eq!(check_winged.open_edges.len(), 2);
    let count = vertices.len() as u32;
    let mut two = (vertices.clone(), triangles.clone());
    two.0.extend(vertices.iter().map(|v| v + Vector3::new(50.0, 0.0, 0.0)));
    two.1.extend(triangles.iter().map(|t| t.map(|v| v + count)));
    let apart = check(&two.0, &two.1);
    assert!(apart.is_closed_manifold() && apart.pieces == 2);
    assert_eq!(apart.piece_of[triangles.len() - 1..=triangles.len()], [0, 1]);
    for t in &mut two.1 {
        *t = t.map(|v| if v == count + 5 { 5 } else { v });
    }
    let pinched = check(&two.0, &two.1);
    assert_eq!(pinched.pinched_vertices, [5]);
    assert!(pinched.open_edges.is_empty() && pinched.pieces == 2 && !pinched.is_closed_manifold());
}

#[test]
fn two_surfaces_are_as_far_apart_as_all_their_pairs_say() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(31);
    for round in 0..200 {
        let (a, b) = (soup(30, &mut random), soup(25, &mut random));
        let off = any(&mut random, if round % 2 == 0 { 30.0 } else { 8.0 });
        let turn = nalgebra::UnitQuaternion::from_scaled_axis(any(&mut random, 3.0).coords);
        let place = biplane_geometry::Pose::new(turn, off.coords);
        let found = Surface::new(&a).apart(&Surface::new(&b), &place);
        assert!(((found.at[0] - found.at[1]).norm() - found.distance_mm).abs() < 1e-9 || found.cross);
        // Each triangle of the one finely sampled, from the other: from above, and near.
        let moved =
            Mesh::new(b.vertices().iter().map(|v| place.transform(v)).collect(), b.triangles().to_vec());
        let moved = moved.unwrap();
        let crossing = !Surface::new(&a).crossings_with(&Surface::new(&moved), 1).is_empty();
        assert_eq!(found.cross, crossing, "round {round}");
        // Where they do not cross, they are nearest at an edge of one: all edges in steps.
        let edges = |from: &Mesh, to: &Mesh| {
            let to = Surface::new(to);
            let mut least = f64::INFINITY;
            for t in from.triangles() {
                for k in 0..3 {
                    let [p, q] = [t[k], t[(k + 1) % 3]].map(|v| from.vertices()[v as usize]);
                    for step in 0..=200 {
                        let at = p + (q - p) * (f64::from(step) / 200.0);
                        least = to.closest(&at).distance_mm.min(least);
                    }
                }
            }
            least
        };
        let least = edges(&a, &moved).min(edges(&moved, &a));
        assert!(found.distance_mm <= least + 1e-9, "round {round}: {} {least}", found.distance_mm);
        if !crossing {
            assert!(least - found.distance_mm < 0.1, "round {round}: {} {least}", found.distance_mm);
            // The points that are named lie on the surfaces.
            assert!(Surface::new(&a).closest(&found.at[0]).distance_mm < 1e-9);
            assert!(Surface::new(&moved).closest(&found.at[1]).distance_mm < 1e-9);
        }
    }
}

#[test]
fn balls_are_apart_and_deep_as_their_radii_say() {
    use biplane_geometry::{Pose, Vector3};
    let ball = |radius: f64| biplane_phantom::ball_mesh(radius, 8_000).unwrap();
    let (a, b) = (ball(20.0), ball(10.0));
    let (first, second) = (Surface::new(&a), Surface::new(&b));
    for along in [Vector3::x(), Vector3::new(1.0, 2.0, -0.5).normalize()] {
        for gap in [5.0, 0.1, -0.5, -3.0] {
            let place = Pose::new(nalgebra::UnitQuaternion::from_scaled_axis(along), along * (30.0 + gap));
            let found = first.apart(&second, &place);
            let depth = first.depth(b.vertices().iter().map(|v| place.transform(v)));
            if gap > 0.0 {
                assert!((found.distance_mm - gap).abs() < 0.03, "{gap}: {}", found.distance_mm);
                assert_eq!(depth, 0.0);
            } else {
                assert!(found.cross && (depth + gap).abs() < 0.05, "{gap}: {depth}");
            }
        }
    }
}
