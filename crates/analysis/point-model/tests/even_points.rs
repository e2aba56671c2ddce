//! Even sampling: numbers, evenness, surfaces that stay what they are, edges and rims that are kept.

#![allow(clippy::unwrap_used)]

mod meshes;

use biplane_geometry::{Mesh, Point3, Vector3};
use biplane_phantom::{Body, ball_mesh, mesh};
use biplane_point_model::{Deviation, Evenness, even_points, simplified};
use biplane_surface::{MeshCheck, Spread, Surface};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

#[test]
fn bodies_are_sampled_evenly_by_just_as_many_points_as_asked_for() {
    for body in Body::ALL {
        let original = mesh(body.solid(), 12_000).unwrap();
        let surface = Surface::new(&original);
        for points in [700, 3_500, 9_000] {
            let model = even_points(&original, points, 40.0).unwrap();
            let told = format!("{} {points}: {:?}", body.name(), Evenness::of(&model));
            assert_eq!(model.vertices().len(), points, "{told}");
            let check = MeshCheck::of(&model);
            assert!(check.is_closed_manifold() && check.pieces == 1, "{told}");
            assert!(surface.self_crossings(1).is_empty());
            assert_eq!(Surface::new(&model).self_crossings(1), [[0_u32; 2]; 0], "{told}");
            let off = model.vertices().iter().map(|v| surface.closest(v).distance_mm).fold(0.0, f64::max);
            assert!(off < 1e-9, "{told}, {off} mm off the surface");
            let evenness = Evenness::of(&model);
            assert_eq!(evenness.points, points);
            assert!(evenness.edge_variation < 0.13 && evenness.area_variation < 0.18, "{told}");
            assert!(evenness.one_percent_angle_deg > 33.0, "{told}");
            // Chords lie inside of what is convex by about the square of their length over eight radii.
            let lost = 1.0 - model.signed_volume() / original.signed_volume();
            assert!(lost.abs() < 70.0 / points as f64, "{told}, {lost} of the volume lost");
        }
    }
}

#[test]
fn a_coarse_mesh_gets_more_points_on_its_own_faces() {
    let coarse = ball_mesh(20.0, 162).unwrap();
    let fine = even_points(&coarse, 5_000, 40.0).unwrap();
    assert_eq!(fine.vertices().len(), 5_000);
    let apart = Deviation::between(&fine, &coarse, 1e-3);
    // Only where the coarse mesh has edges that are no lines.
    assert!(apart.silhouette_mm() < 0.15, "{apart:?}");
    assert!(Evenness::of(&fine).edge_variation < 0.12);
}

/// A box of 40 by 20 by 10 mm, each face cut into `cells` along its sides.
fn cuboid(cells: usize) -> Mesh {
    let size = [40.0, 20.0, 10.0];
    let mut soup = Vec::new();
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for end in [0.0, 1.0] {
            let at = |i: usize, j: usize| {
                let mut p = Point3::origin();
                p[axis] = end * size[axis];
                p[u] = size[u] * i as f64 / cells as f64;
                p[v] = size[v] * j as f64 / cells as f64;
                p
            };
            for (i, j) in (0..cells).flat_map(|i| (0..cells).map(move |j| (i, j))) {
                let mut quad = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                if end == 0.0 {
                    quad.swap(1, 3);
                }
                soup.push([quad[0], quad[1], quad[2]]);
                soup.push([quad[0], quad[2], quad[3]]);
            }
        }
    }
    Mesh::from_soup(&soup).unwrap()
}

#[test]
fn sharp_edges_and_corners_are_kept() {
    let original = cuboid(25);
    assert!(MeshCheck::of(&original).is_closed_manifold());
    for points in [400, 2_000, 6_000] {
        let even = even_points(&original, points, 40.0).unwrap();
        let simple = simplified(&original, points.min(3_000), 40.0).unwrap();
        // Simplified ones are drawn a little towards their vertices, so corners are rounded by microns.
        for (model, off_mm) in [(even, 1e-9), (simple, 0.02)] {
            assert!(MeshCheck::of(&model).is_closed_manifold());
            let lost = 8000.0 - model.signed_volume();
            assert!(lost.abs() < 140.0 * off_mm, "{lost} mm^3");
            for corner in cuboid(1).vertices() {
                let off = model.vertices().iter().map(|v| (v - corner).norm()).fold(f64::INFINITY, f64::min);
                assert!(off < off_mm, "{corner} {off}");
            }
        }
        // Where edges are not kept, points do not lie on them.
        let rounded = even_points(&original, points, 180.0).unwrap();
        assert!(rounded.signed_volume() < 8000.0 - 1.0);
    }
}

/// A ball whose cap is cut off: the rim stays a circle in its plane, and the surface stays open.
#[test]
fn rims_of_open_meshes_are_kept() {
    let ball = ball_mesh(20.0, 9_000).unwrap();
    let below = |t: &[u32; 3]| t.iter().all(|v| ball.vertices()[*v as usize].z < 9.0);
    let kept: Vec<[u32; 3]> = ball.triangles().iter().copied().filter(below).collect();
    let open = Mesh::new(ball.vertices().to_vec(), kept).unwrap();
    let rim_of = |m: &Mesh| MeshCheck::of(m).open_edges;
    let rim = Surface::of_segments(open.vertices(), &rim_of(&open)).unwrap();
    for model in [even_points(&open, 3_000, 40.0).unwrap(), simplified(&open, 3_000, 40.0).unwrap()] {
        let check = MeshCheck::of(&model);
        assert!(check.is_manifold() && check.pieces == 1);
        let edges = rim_of(&model);
        let off: Vec<f64> =
            edges.iter().flatten().map(|v| rim.closest(&model.vertices()[*v as usize]).distance_mm).collect();
        let off = Spread::of(&off);
        assert!(edges.len() > 60 && off.worst < 0.1, "{} {off:?}", edges.len());
        let length = |m: &Mesh| {
            let side = |e: &[u32; 2]| (m.vertices()[e[0] as usize] - m.vertices()[e[1] as usize]).norm();
            rim_of(m).iter().map(side).sum::<f64>()
        };
        // The rim of whole triangles is a zigzag, which longer edges cut short.
        assert!(length(&model) > 0.75 * length(&open), "{} {}", length(&model), length(&open));
    }
}

/// Two closed pieces and an open one stay three pieces.
#[test]
fn pieces_stay_apart() {
    let ball = ball_mesh(10.0, 2_000).unwrap();
    let mut vertices = ball.vertices().to_vec();
    let mut triangles = ball.triangles().to_vec();
    for (k, shift) in [30.0, 20.4].into_iter().enumerate() {
        let first = vertices.len() as u32;
        vertices.extend(ball.vertices().iter().map(|v| v + Vector3::new(0.0, shift * k as f64, shift)));
        let skip = k * 100;
        triangles.extend(ball.triangles()[skip..].iter().map(|t| t.map(|v| v + first)));
    }
    let three = Mesh::new(vertices, triangles).unwrap();
    for model in [even_points(&three, 2_500, 40.0).unwrap(), simplified(&three, 2_500, 40.0).unwrap()] {
        let check = MeshCheck::of(&model);
        assert_eq!((model.vertices().len(), check.pieces), (2_500, 3));
        assert!(check.is_manifold() && !check.open_edges.is_empty());
    }
}

#[test]
fn no_mesh_makes_it_panic_and_results_repeat() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(11);
    for round in 0..20 {
        let count = random.random_range(3..60_u32);
        let size = 10.0_f64.powi(random.random_range(-3..4));
        // Few different coordinates: triangles without width, in one plane, on top of each other.
        let steps = if round % 2 == 0 { 2.0 } else { 1e6 };
        let coordinate = |r: f64| (r * steps).round() / steps * size;
        let vertices =
            (0..count).map(|_| Point3::from([0; 3].map(|_| coordinate(random.random())))).collect();
        let triangles = (0..count * 2).map(|_| [0; 3].map(|_| random.random_range(0..count))).collect();
        let Ok(tangle) = Mesh::new(vertices, triangles) else { continue };
        for points in [200, 700] {
            let model = even_points(&tangle, points, 40.0);
            assert_eq!(model, even_points(&tangle, points, 40.0));
            let few = simplified(&tangle, points / 50, 40.0);
            assert_eq!(few, simplified(&tangle, points / 50, 40.0));
        }
    }
}

/// Real meshes and those of the example studies: closed ones stay closed, faulty ones keep their faults, none crosses itself that did
/// not before.
#[test]
fn real_meshes_go_through() {
    let folder = "../shared/data/real";
    let files = [
        (format!("{folder}/implant-meshes/femoral-component-decimated.stl"), 1000.0),
        (format!("{folder}/implant-meshes/tibial-tray-decimated.stl"), 1000.0),
        (format!("{folder}/implant-meshes/patella.stl"), 1000.0),
        (format!("{folder}/knee-implant-biplane/femur0.stl"), 1.0),
        (format!("{folder}/knee-implant-biplane/tibia0.stl"), 1.0),
        ("fixtures/knee/models/tray_15000.stl".to_owned(), 1.0),
        ("fixtures/knee-natural/models/femur_15000.stl".to_owned(), 1.0),
    ];
    for (path, factor) in files {
        let Some(original) = meshes::stl(&path, factor) else { continue };
        let before = MeshCheck::of(&original);
        let crossed = Surface::new(&original).self_crossings(1_000).len();
        let size = original.bounding_box();
        let size = (size.1 - size.0).norm();
        for points in [3_500, 15_000] {
            if points > 3_500 && !path.ends_with("femur0.stl") {
                continue;
            }
            for (how, model) in [
                ("even", even_points(&original, points, 40.0)),
                ("simplified", simplified(&original, points.min(original.vertices().len()), 40.0)),
            ] {
                let model = model.unwrap();
                let after = MeshCheck::of(&model);
                let told = format!("{path}, {how} {points}: {:?}", Evenness::of(&model));
                assert_eq!(
                    model.vertices().len(),
                    if how == "even" { points } else { points.min(original.vertices().len()) }
                );
                assert_eq!(after.is_closed_manifold(), before.is_closed_manifold(), "{told}");
                assert_eq!(
                    (after.pieces, after.open_edges.len()),
                    (before.pieces, before.open_edges.len()),
                    "{told}"
                );
                let crosses = Surface::new(&model).self_crossings(1_000).len();
                assert!(crossed > 0 || crosses == 0, "{told}: {crosses} crossings");
                let apart = Deviation::between(&model, &original, size * 1e-4);
                assert!(apart.silhouette_mm() < 0.03 * size, "{told} {apart:?}");
            }
        }
    }
}
