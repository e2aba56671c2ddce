//! Triangles that cross: cases made by hand, random pairs against another way to say it, and meshes that have none.

#![allow(clippy::unwrap_used)]

use biplane_geometry::{Mesh, Point3, Vector3};
use biplane_phantom::{Body, ball_mesh, mesh};
use biplane_surface::Surface;
use nalgebra::Rotation3;
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

fn crossings(points: &[[f64; 3]], triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let mesh = Mesh::new(points.iter().map(|p| Point3::from(*p)).collect(), triangles.to_vec()).unwrap();
    // However the corners are numbered and the triangles wound.
    let mut all = Vec::new();
    for turn in 0..9 {
        let mut turned = mesh.triangles().to_vec();
        turned[0].rotate_left(turn % 3);
        turned[1].rotate_left(turn / 3);
        all.push(turned.clone());
        turned[0].swap(0, 1);
        all.push(turned.clone());
        turned[1].swap(1, 2);
        all.push(turned);
    }
    let found =
        |t: Vec<[u32; 3]>| Surface::new(&Mesh::new(mesh.vertices().to_vec(), t).unwrap()).self_crossings(99);
    let first = found(mesh.triangles().to_vec());
    for turned in all {
        assert_eq!(found(turned), first);
    }
    first
}

const NONE: [[u32; 2]; 0] = [];
const FLOOR: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

fn with_floor(more: &[[f64; 3]]) -> Vec<[f64; 3]> {
    [FLOOR.as_slice(), more].concat()
}

#[test]
fn triangles_without_a_common_vertex() {
    let two = [[0, 1, 2], [3, 4, 5]];
    let pair = |more: [[f64; 3]; 3]| crossings(&with_floor(&more), &two);
    assert_eq!(
        pair([[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 9.0, 1.0]]),
        [[0, 1]],
        "an edge through the face"
    );
    assert_eq!(
        pair([[-1.0, 1.0, -1.0], [-1.0, 1.0, 1.0], [9.0, 1.0, 1.0]]),
        [[0, 1]],
        "wider than the other"
    );
    assert_eq!(pair([[5.0, 5.0, -1.0], [5.0, 5.0, 1.0], [9.0, 9.0, 1.0]]), NONE, "beside it");
    assert_eq!(pair([[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [2.0, 1.0, 1.0]]), NONE, "touches with a corner");
    assert_eq!(pair([[1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [1.0, 1.0, 1.0]]), NONE, "stands on it with an edge");
    assert_eq!(
        pair([[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [2.0, 1.0, -1.0]]),
        [[0, 1]],
        "a corner in it, through it"
    );
    assert_eq!(pair([[2.0, 2.0, -1.0], [2.0, 2.0, 1.0], [3.0, 3.0, 0.0]]), NONE, "edge against edge");
    assert_eq!(pair([[1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [1.0, 2.0, 0.0]]), [[0, 1]], "lies in it");
    assert_eq!(pair([[4.0, 4.0, 0.0], [4.0, 0.5, 0.0], [0.5, 4.0, 0.0]]), NONE, "lies beside it");
    assert_eq!(pair([[4.0, 4.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]), NONE, "beside it, unwelded");
    assert_eq!(pair(FLOOR), [[0, 1]], "twice the same");
    assert_eq!(pair([[1.0, 1.0, 1e-300], [2.0, 1.0, 1e-300], [1.0, 2.0, 1e-300]]), NONE, "a hair above it");
}

#[test]
fn triangles_with_a_common_vertex() {
    let two = [[0, 1, 2], [0, 3, 4]];
    let pair = |more: [[f64; 3]; 2]| crossings(&with_floor(&more), &two);
    assert_eq!(pair([[1.0, 1.0, 1.0], [1.0, 1.0, -1.0]]), [[0, 1]], "through it from the common vertex");
    assert_eq!(pair([[9.0, 9.0, 1.0], [9.0, 9.0, -1.0]]), [[0, 1]], "the other's far side passes beyond");
    assert_eq!(pair([[-1.0, -1.0, 1.0], [-1.0, -1.0, -1.0]]), NONE, "on the other side of the vertex");
    assert_eq!(pair([[1.0, -1.0, 1.0], [1.0, -1.0, -1.0]]), NONE, "beside the wedge");
    assert_eq!(pair([[1.0, 1.0, 1.0], [1.0, 2.0, 1.0]]), NONE, "above");
    assert_eq!(pair([[1.0, 1.0, 0.0], [1.0, 1.0, 1.0]]), NONE, "stands on it");
    assert_eq!(pair([[1.0, 3.0, 0.0], [3.0, 1.0, 0.0]]), [[0, 1]], "lies in it");
    assert_eq!(pair([[0.0, 2.0, 0.0], [-2.0, 2.0, 0.0]]), NONE, "beside it in the plane");
    assert_eq!(pair([[0.0, 2.0, 0.0], [2.0, 2.0, 0.0]]), [[0, 1]], "along its side, over it");
    assert_eq!(pair([[-2.0, 0.0, 0.0], [0.0, -2.0, 0.0]]), NONE, "opposite in the plane");
}

#[test]
fn triangles_with_a_common_edge() {
    let two = [[0, 1, 2], [1, 0, 3]];
    let pair = |third: [f64; 3]| crossings(&with_floor(&[third]), &two);
    assert_eq!(pair([1.0, -3.0, 0.0]), NONE, "flat");
    assert_eq!(pair([1.0, 3.0, 0.0]), [[0, 1]], "folded over");
    assert_eq!(pair([-9.0, 0.1, 0.0]), [[0, 1]], "folded over, aslant");
    assert_eq!(pair([1.0, 3.0, 1e-9]), NONE, "nearly folded over");
    assert_eq!(pair([1.0, 0.0, 2.0]), NONE, "upright");
    assert_eq!(crossings(&with_floor(&[]), &[[0, 1, 2], [2, 1, 0]]), [[0, 1]], "both sides of one triangle");
}

/// Two walls that together pass through the floor along a common edge which lies in it: neither does alone.
#[test]
fn a_surface_that_passes_through_along_an_edge_is_found() {
    let walls = |low: [f64; 3]| with_floor(&[[1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [1.5, 1.0, 1.0], low]);
    let triangles = [[0, 1, 2], [3, 4, 5], [4, 3, 6]];
    assert_eq!(crossings(&walls([1.5, 1.0, -1.0]), &triangles), [[0, 1], [0, 2]]);
    assert_eq!(crossings(&walls([1.5, 2.0, 1.0]), &triangles), NONE, "a valley that touches");
    let from_vertex = |low: [f64; 3]| with_floor(&[[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], low]);
    let triangles = [[0, 1, 2], [0, 3, 4], [3, 0, 5]];
    assert_eq!(crossings(&from_vertex([1.0, 1.0, -1.0]), &triangles), [[0, 1], [0, 2]]);
    assert_eq!(crossings(&from_vertex([1.0, 2.0, 1.0]), &triangles), NONE);
}

/// Whether an edge of one passes through the inner of the other, in plain floating point; none where it is not clear.
fn pierces(first: &[Point3; 3], second: &[Point3; 3]) -> Option<bool> {
    let volume = |a: &Point3, b: &Point3, c: &Point3, d: &Point3| (d - a).dot(&(b - a).cross(&(c - a)));
    let mut any = false;
    for (t, o) in [(first, second), (second, first)] {
        for k in 0..3 {
            let (p, q) = (&o[k], &o[(k + 1) % 3]);
            let (from, to) = (volume(&t[0], &t[1], &t[2], p), volume(&t[0], &t[1], &t[2], q));
            let around = [0, 1, 2].map(|i| volume(p, q, &t[i], &t[(i + 1) % 3]));
            if [from, to].iter().chain(&around).any(|v| v.abs() < 1e-12) {
                return None;
            }
            let inside = around.iter().all(|v| *v > 0.0) || around.iter().all(|v| *v < 0.0);
            any |= (from > 0.0) != (to > 0.0) && inside;
        }
    }
    Some(any)
}

#[test]
fn random_pairs_cross_where_an_edge_of_one_passes_through_the_other() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
    let mut counts = [0; 2];
    for _ in 0..20_000 {
        let mut any = || Point3::from(Vector3::from_fn(|_, _| random.random_range(-1.0..1.0)));
        let (first, second) = ([any(), any(), any()], [any(), any(), any()]);
        let Some(truth) = pierces(&first, &second) else { continue };
        let vertices = [first, second].as_flattened().to_vec();
        let mesh = Mesh::new(vertices, vec![[0, 1, 2], [3, 4, 5]]).unwrap();
        assert_eq!(!Surface::new(&mesh).self_crossings(9).is_empty(), truth, "{first:?} {second:?}");
        let alone = |t: [Point3; 3]| Surface::new(&Mesh::from_soup(&[t]).unwrap());
        assert_eq!(!alone(first).crossings_with(&alone(second), 9).is_empty(), truth);
        counts[usize::from(truth)] += 1;
        // The same with a common vertex: then the opposite side of one passes through the other, or the other way round.
        let second = [first[0], second[1], second[2]];
        let mesh =
            Mesh::new(vec![first[0], first[1], first[2], second[1], second[2]], vec![[0, 1, 2], [3, 4, 0]])
                .unwrap();
        let volume = |a: &Point3, b: &Point3, c: &Point3, d: &Point3| (d - a).dot(&(b - a).cross(&(c - a)));
        let through = |t: &[Point3; 3], o: &[Point3; 3]| {
            let [a, b, c] = t;
            let (from, to) = (volume(a, b, c, &o[1]), volume(a, b, c, &o[2]));
            let around = [(a, b), (b, c), (c, a)].map(|(p, q)| volume(&o[1], &o[2], p, q));
            (from > 0.0) != (to > 0.0) && (around.iter().all(|v| *v > 0.0) || around.iter().all(|v| *v < 0.0))
        };
        let truth = through(&first, &second) || through(&second, &first);
        assert_eq!(!Surface::new(&mesh).self_crossings(9).is_empty(), truth, "{first:?} {second:?}");
    }
    assert!(counts[0] > 1000 && counts[1] > 1000, "{counts:?}");
}

#[test]
fn meshes_of_solids_have_no_crossings() {
    for body in Body::ALL {
        for points in [800, 6000] {
            let mesh = mesh(body.solid(), points).unwrap();
            assert_eq!(Surface::new(&mesh).self_crossings(10), NONE, "{} {points}", body.name());
        }
    }
    // A solid's faces, flat and cut into many triangles in one plane.
    let side = 30_u32;
    let at = |i: u32, j: u32| Point3::new(f64::from(i) * 0.1, f64::from(j) * 0.1, 0.3);
    let vertices = (0..=side).flat_map(|i| (0..=side).map(move |j| at(i, j))).collect();
    let cell = |i: u32, j: u32| {
        let v = |i: u32, j: u32| i * (side + 1) + j;
        [[v(i, j), v(i + 1, j), v(i + 1, j + 1)], [v(i, j), v(i + 1, j + 1), v(i, j + 1)]]
    };
    let triangles = (0..side).flat_map(|i| (0..side).flat_map(move |j| cell(i, j))).collect();
    assert_eq!(Surface::new(&Mesh::new(vertices, triangles).unwrap()).self_crossings(10), NONE);
}

/// Two balls that overlap: their crossing triangles are those of a scan of all pairs, and lie along a circle.
#[test]
fn overlapping_balls_cross_along_a_circle() {
    let ball = ball_mesh(10.0, 1000).unwrap();
    let shift = Vector3::new(12.0, 0.1, 0.2);
    let turn = Rotation3::from_euler_angles(0.3, 0.5, 0.7);
    let place = |v: &Point3| turn * v * 0.97 + shift;
    let moved = Mesh::new(ball.vertices().iter().map(place).collect(), ball.triangles().to_vec()).unwrap();
    let found = Surface::new(&ball).crossings_with(&Surface::new(&moved), usize::MAX);
    let mut truth = Vec::new();
    for a in 0..ball.triangles().len() {
        for b in 0..moved.triangles().len() {
            if pierces(&ball.corners(a), &moved.corners(b)).unwrap_or(false) {
                truth.push([a as u32, b as u32]);
            }
        }
    }
    assert_eq!(found, truth);
    assert!(found.len() > 100);
    for [a, _] in &found {
        let middle = nalgebra::center(&ball.corners(*a as usize)[0], &ball.corners(*a as usize)[1]);
        assert!((middle.coords.dot(&shift.normalize()) - shift.norm() / 2.0).abs() < 2.0);
    }
    let mut both = ball.vertices().to_vec();
    both.extend(moved.vertices());
    let count = ball.vertices().len() as u32;
    let mut triangles = ball.triangles().to_vec();
    triangles.extend(ball.triangles().iter().map(|t| t.map(|v| v + count)));
    let one = Surface::new(&Mesh::new(both, triangles).unwrap());
    let all = one.self_crossings(usize::MAX);
    assert_eq!(all, truth.iter().map(|[a, b]| [*a, b + ball.triangles().len() as u32]).collect::<Vec<_>>());
    assert_eq!(one.self_crossings(5).len(), 5);
}
