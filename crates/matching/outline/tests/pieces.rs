//! Shadows with holes and of several pieces, rims inside the shadow, and meshes that are no closed surface.

#![allow(clippy::unwrap_used)]

mod scene;

use std::f64::consts::{PI, TAU};

use biplane_geometry::{Mesh, Point2, Point3, Pose, Vector3};
use biplane_outline::{Outline, RimMesh, RimWithoutCutEnds};
use nalgebra::UnitQuaternion;

use scene::{ellipsoid, torus, traced, view};

/// Both kinds of rim.
fn rims(mesh: &Mesh) -> [(&'static str, RimMesh); 2] {
    [("flat", RimMesh::flat(mesh)), ("curved", RimMesh::new(mesh))]
}

/// Area inside by Green's theorem, px^2.
fn area(outline: &Outline) -> f64 {
    outline
        .points()
        .iter()
        .map(|p| p.normal.dot(&(p.pixel - Point2::new(511.5, 511.5))) * p.length_px / 2.0)
        .sum()
}

/// At the source's middle ray, turned by nothing, with the model's origin so far from the source, mm.
fn ahead(distance: f64) -> Pose {
    Pose::new(UnitQuaternion::identity(), view().source().coords + Vector3::new(0.0, 0.0, distance))
}

/// Several meshes as one.
fn together(parts: &[(&Mesh, Vector3)]) -> Mesh {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for (mesh, shift) in parts {
        let first = vertices.len() as u32;
        vertices.extend(mesh.vertices().iter().map(|v| v + shift));
        triangles.extend(mesh.triangles().iter().map(|t| t.map(|v| v + first)));
    }
    Mesh::new(vertices, triangles).unwrap()
}

/// A ring's outline along its axis: where rays touch a circle of radius 8 mm, its middle 30 mm off the axis: 3000 px times the tangent of
/// the middle's direction plus or minus that of the tangent.
#[test]
fn a_ring_has_an_outline_outside_and_one_round_its_hole() {
    let mesh = torus(30.0, 8.0, 240);
    let (middle, half) = ((30.0_f64 / 1000.0).atan(), (8.0 / 1000.0_f64.hypot(30.0)).asin());
    let [inner, outer] = [-half, half].map(|a| 3000.0 * (middle + a).tan());
    for (name, rim) in rims(&mesh) {
        let outline = traced(&rim, &ahead(1000.0), 0.5);
        let allowed = if name == "flat" { 0.03 } else { 1e-3 };
        let [mut of_hole, mut of_rest] = [0.0; 2];
        for p in outline.points() {
            let r = p.pixel - Point2::new(511.5, 511.5);
            // Away from the shadow is inward at the hole.
            let outward = p.normal.dot(&r) > 0.0;
            let expected = if outward { outer } else { inner };
            assert!((r.norm() - expected).abs() < allowed, "{name}: {} for {expected}", r.norm());
            *(if outward { &mut of_rest } else { &mut of_hole }) += p.length_px;
        }
        for (found, radius) in [(of_hole, inner), (of_rest, outer)] {
            assert!((found / (TAU * radius) - 1.0).abs() < 1e-3, "{name}: {found} px round {radius}");
        }
        assert!(outline.inner().is_empty());
        let expected = PI * (outer * outer - inner * inner);
        assert!((area(&outline) / expected - 1.0).abs() < 1e-3, "{name}");
    }
}

#[test]
fn two_bodies_have_an_outline_each_and_what_one_hides_is_kept_apart() {
    let ball = ellipsoid([20.0; 3], 24);
    let radius = |distance: f64| 3000.0 * (20.0_f64 / distance).asin().tan();
    let (near, far) = (radius(1000.0), radius(1100.0));
    for (behind, apart) in [(Vector3::new(60.0, 0.0, 100.0), true), (Vector3::new(0.0, 0.0, 100.0), false)] {
        for (name, rim) in rims(&together(&[(&ball, Vector3::zeros()), (&ball, behind)])) {
            let outline = traced(&rim, &ahead(1000.0), 0.5);
            let inner: f64 = outline.inner().iter().map(|p| p.length_px).sum();
            let close = |found: f64, expected: f64| (found / expected - 1.0).abs() < 0.01;
            if apart {
                assert!(close(outline.length_px(), TAU * (near + far)), "{name}: {}", outline.length_px());
                assert!(close(area(&outline), PI * (near * near + far * far)), "{name}");
                assert!(outline.inner().is_empty(), "{name}: {inner}");
            } else {
                // The one behind lies wholly in the shadow of the other: an X-ray shows its rim there.
                assert!(close(outline.length_px(), TAU * near), "{name}: {}", outline.length_px());
                assert!(close(inner, TAU * far), "{name}: {inner}");
                for p in outline.inner() {
                    let r = (p.pixel - Point2::new(511.5, 511.5)).norm();
                    assert!((r - far).abs() < 0.15, "{name}: {r} for {far}");
                    assert!(p.depth > 1050.0);
                }
            }
        }
    }
}

#[test]
fn what_is_at_or_behind_the_source_has_no_outline() {
    let ball = ellipsoid([20.0; 3], 12);
    for (name, rim) in rims(&ball) {
        for distance in [-1000.0, -30.0, 0.0, 10.0] {
            let outline = traced(&rim, &ahead(distance), 1.0);
            assert!(outline.points().is_empty() && outline.inner().is_empty(), "{name} at {distance}");
        }
        // The same buffers go on after that.
        let mut outline = traced(&rim, &ahead(-1000.0), 1.0);
        outline.trace(&rim, &ahead(1000.0), &view(), biplane_outline::Sampling { step_px: 1.0 });
        assert_eq!(outline.points(), traced(&rim, &ahead(1000.0), 1.0).points(), "{name}");
        assert!(outline.points().len() > 100);
    }
}

/// A square of so many mm about the axis, in the plane z = 0, as triangles of `cells` by `cells` cells; without those that `skip`.
fn plate(half: f64, cells: i32, skip: impl Fn(i32, i32) -> bool) -> Vec<[Point3; 3]> {
    let at = |i: i32, j: i32| {
        let of = |k: i32| half * (2.0 * f64::from(k) / f64::from(cells) - 1.0);
        Point3::new(of(i), of(j), 0.0)
    };
    let mut soup = Vec::new();
    for (i, j) in (0..cells * cells).map(|k| (k % cells, k / cells)).filter(|(i, j)| !skip(*i, *j)) {
        soup.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
        soup.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
    }
    soup
}

#[test]
fn an_open_sheet_with_a_hole_has_the_outline_of_both_whichever_way_it_faces() {
    // 60 mm wide, the middle 20 mm missing.
    let soup = plate(30.0, 6, |i, j| (2..4).contains(&i) && (2..4).contains(&j));
    let mesh = Mesh::from_soup(&soup).unwrap();
    for mesh in [mesh.clone(), mesh.inverted()] {
        for (name, rim) in rims(&mesh) {
            let outline = traced(&rim, &ahead(1000.0), 0.25);
            let (length, covered) = (3.0 * 4.0 * 80.0, 9.0 * (3600.0 - 400.0));
            assert!((outline.length_px() / length - 1.0).abs() < 1e-9, "{name}: {}", outline.length_px());
            assert!((area(&outline) / covered - 1.0).abs() < 1e-9, "{name}: {}", area(&outline));
            for p in outline.points() {
                assert!(p.normal.x.abs().max(p.normal.y.abs()) > 1.0 - 1e-9, "{name}");
            }
        }
    }
}

#[test]
fn where_three_faces_meet_or_one_is_wound_the_other_way_the_outline_is_that_of_the_union() {
    let square = |half: f64| (3.0 * 4.0 * 2.0 * half, 9.0 * 4.0 * half * half);
    // A fin that stands on two inner edges of the plate, seen from above: it has no outline of its own.
    let mut finned = plate(20.0, 4, |_, _| false);
    let corner = |y: f64, z: f64| Point3::new(0.0, y, z);
    for y in [-10.0, 0.0] {
        finned.push([corner(y, 0.0), corner(y + 10.0, 0.0), corner(y + 10.0, 15.0)]);
        finned.push([corner(y, 0.0), corner(y + 10.0, 15.0), corner(y, 15.0)]);
    }
    let finned = Mesh::from_soup(&finned).unwrap();
    assert!(finned.topology().non_manifold_edges > 0);
    let mut wound = plate(20.0, 4, |_, _| false);
    wound.iter_mut().skip(3).step_by(5).for_each(|t| t.swap(1, 2));
    let wound = Mesh::from_soup(&wound).unwrap();
    assert!(wound.topology().inconsistent_edges > 0);
    let (length, covered) = square(20.0);
    for (what, mesh) in [("fin", &finned), ("wound", &wound)] {
        for (name, rim) in rims(mesh) {
            let outline = traced(&rim, &ahead(1000.0), 0.25);
            assert!(
                (outline.length_px() / length - 1.0).abs() < 1e-6,
                "{what}, {name}: {}",
                outline.length_px()
            );
            assert!((area(&outline) / covered - 1.0).abs() < 1e-6, "{what}, {name}: {}", area(&outline));
        }
    }
    // Turned by 1.2 rad about y, the fin reaches beyond the plate on one side.
    let pose = Pose::new(UnitQuaternion::from_euler_angles(0.0, 1.2, 0.0), ahead(1000.0).translation());
    for (name, rim) in rims(&finned) {
        let outline = traced(&rim, &pose, 0.05);
        let covered = filled(&finned, &pose);
        assert!((area(&outline) / covered - 1.0).abs() < 2e-3, "{name}: {} for {covered}", area(&outline));
    }
}

/// Area under the projected triangles, by counting points of a grid of a quarter pixel, px^2.
fn filled(mesh: &Mesh, pose: &Pose) -> f64 {
    let corners: Vec<[Point2; 3]> = (0..mesh.triangles().len())
        .map(|t| mesh.corners(t).map(|p| view().project(&pose.transform(&p)).unwrap().pixel))
        .collect();
    let side = |a: &Point2, b: &Point2, q: &Point2| (b - a).perp(&(q - a));
    let mut count = 0_u32;
    for k in 0..1600 * 1600 {
        let q = Point2::new(311.5 + f64::from(k % 1600) / 4.0, 311.5 + f64::from(k / 1600) / 4.0);
        count += u32::from(corners.iter().any(|[a, b, c]| {
            let [u, v, w] = [side(a, b, &q), side(b, c, &q), side(c, a, &q)];
            (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0)
        }));
    }
    f64::from(count) / 16.0
}

/// A shaft along z from 0 to `length` mm, its radius 14 mm and less towards its other end, closed by a round end below and a flat one above.
fn shaft(length: f64) -> Mesh {
    let (sectors, rings) = (96, 40);
    let at = |i: i32, j: i32| {
        let turn = TAU * f64::from(j % sectors) / f64::from(sectors);
        let s = f64::from(i) / f64::from(rings);
        // Half of it the round end, its height 14 mm.
        let (radius, z) = if s < 0.5 {
            (14.0 * (PI * s).sin(), -14.0 * (PI * s).cos())
        } else {
            let t = 2.0 * s - 1.0;
            (14.0 - 4.0 * t + 2.5 * t * t, length * t)
        };
        Point3::new(radius * turn.cos(), radius * turn.sin(), z)
    };
    let mut soup = Vec::new();
    for j in 0..sectors {
        for i in 0..rings {
            soup.push([at(i, j), at(i + 1, j + 1), at(i + 1, j)]);
            soup.push([at(i, j), at(i, j + 1), at(i + 1, j + 1)]);
        }
        soup.push([at(rings, j), at(rings, j + 1), Point3::new(0.0, 0.0, length)]);
    }
    Mesh::from_soup(&soup).unwrap()
}

#[test]
fn the_end_at_which_a_shaft_was_cut_has_no_outline_and_the_rest_keeps_its_own() {
    let length = 60.0;
    let mesh = shaft(length);
    let (whole, cut) = (RimMesh::new(&mesh), RimWithoutCutEnds::new(&mesh).0);
    // The shaft lies across the ray, and then leans so that its end shows as an ellipse.
    for lean in [PI / 2.0, 1.2, 1.9] {
        let pose = Pose::new(UnitQuaternion::from_euler_angles(0.0, lean, 0.0), ahead(1000.0).translation());
        let height = |p: &biplane_outline::OutlinePoint| pose.inverse().transform(&p.world).z;
        let [kept, left] = [&whole, &cut].map(|rim| traced(rim, &pose, 0.5));
        let at_end = |outline: &Outline| {
            let points = outline.points().iter().chain(outline.inner());
            points.filter(|p| (height(p) - length).abs() < 1e-6).map(|p| p.length_px).sum::<f64>()
        };
        assert!(at_end(&kept) > 50.0 && at_end(&left) == 0.0, "{lean}: {} {}", at_end(&kept), at_end(&left));
        let elsewhere = |outline: &Outline| {
            outline.points().iter().filter(|p| (height(p) - length).abs() > 1e-6).copied().collect::<Vec<_>>()
        };
        assert!(elsewhere(&kept) == elsewhere(&left), "{lean}");
        assert!(left.length_px() > 300.0);
    }
}
