//! Cut ends are found where a body is cut, and nowhere else.

#![allow(clippy::unwrap_used)]

use biplane_geometry::{Mesh, Point3, Vector3};
use biplane_phantom::{Body, mesh};
use biplane_surface::cut_ends;

/// A mesh below the plane `z = height`, closed there by a fan; the mesh must meet the plane in one loop.
fn cut_at(whole: &Mesh, height: f64) -> Mesh {
    let mut vertices = whole.vertices().to_vec();
    let (mut kept, mut rim) = (Vec::new(), Vec::new());
    let below = |p: &Point3| p.z < height;
    for corners in whole.triangles() {
        let points = corners.map(|v| whole.vertices()[v as usize]);
        let inside = points.iter().filter(|p| below(p)).count();
        if inside == 3 {
            kept.push(*corners);
            continue;
        }
        if inside == 0 {
            continue;
        }
        // The polygon of the triangle below the plane; its crossing runs from `out` to `back`.
        let (mut polygon, mut crossing) = (Vec::new(), [0_u32; 2]);
        for k in 0..3 {
            let (a, b) = (points[k], points[(k + 1) % 3]);
            if below(&a) {
                polygon.push(corners[k]);
            }
            if below(&a) != below(&b) {
                let enters = below(&b);
                // The same bits for both triangles of the edge.
                let (a, b) = if below(&a) { (a, b) } else { (b, a) };
                let s = (height - a.z) / (b.z - a.z);
                vertices.push(Point3::new(a.x + s * (b.x - a.x), a.y + s * (b.y - a.y), height));
                let new = (vertices.len() - 1) as u32;
                crossing[usize::from(enters)] = new;
                polygon.push(new);
            }
        }
        kept.extend((1..polygon.len() - 1).map(|k| [polygon[0], polygon[k], polygon[k + 1]]));
        rim.push(crossing);
    }
    let middle: Vector3 =
        rim.iter().map(|[a, _]| vertices[*a as usize].coords).sum::<Vector3>() / rim.len() as f64;
    vertices.push(Point3::from(middle));
    let centre = (vertices.len() - 1) as u32;
    kept.extend(rim.iter().map(|[out, back]| [centre, *back, *out]));
    // The corners that cuts made twice become one.
    let soup: Vec<[Point3; 3]> = kept.iter().map(|t| t.map(|v| vertices[v as usize])).collect();
    Mesh::from_soup(&soup).unwrap()
}

fn area(mesh: &Mesh, of: &[bool]) -> f64 {
    (0..of.len()).filter(|t| of[*t]).map(|t| mesh.area_vector(t).norm()).sum()
}

#[test]
fn a_cut_bone_has_its_lid_and_nothing_else() {
    let whole = mesh(Body::DistalFemur.solid(), 6000).unwrap();
    let heights: Vec<f64> = whole.vertices().iter().map(|v| v.z).collect();
    let (low, high) = heights.iter().fold((f64::MAX, f64::MIN), |(l, h), z| (l.min(*z), h.max(*z)));
    let height = low + 0.8 * (high - low);
    let cut = cut_at(&whole, height);
    let found = cut_ends(&cut);
    let at_height = |t: usize| cut.corners(t).iter().all(|p| (p.z - height).abs() < 1e-9);
    let lid: Vec<bool> = (0..found.len()).map(at_height).collect();
    assert!(lid.iter().filter(|l| **l).count() > 20, "the test has a lid");
    let own: Vec<bool> = found.iter().zip(&lid).map(|(f, l)| *f && *l).collect();
    assert!(area(&cut, &own) > 0.999 * area(&cut, &lid), "{} of {}", area(&cut, &own), area(&cut, &lid));
    let others: Vec<bool> = found.iter().zip(&lid).map(|(f, l)| *f && !*l).collect();
    assert!(area(&cut, &others) < 1e-3 * area(&cut, &lid), "{} mm2 beside the lid", area(&cut, &others));
}

#[test]
fn round_bodies_have_none_and_a_ball_cut_in_half_has_one() {
    let ball = |rings: usize| {
        let sectors = 2 * rings;
        let at = |i: usize, j: usize| {
            let (a, b) = (
                std::f64::consts::PI * i as f64 / rings as f64,
                std::f64::consts::TAU * (j % sectors) as f64 / sectors as f64,
            );
            if i == 0 || i == rings {
                Point3::new(0.0, 0.0, 40.0 * a.cos())
            } else {
                Point3::new(40.0 * a.sin() * b.cos(), 40.0 * a.sin() * b.sin(), 40.0 * a.cos())
            }
        };
        let mut soup = Vec::new();
        for i in 0..rings {
            for j in 0..sectors {
                soup.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
                soup.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
        Mesh::from_soup(&soup).unwrap()
    };
    for rings in [20, 60] {
        let whole = ball(rings);
        assert_eq!(area(&whole, &cut_ends(&whole)), 0.0, "{rings}");
        let half = cut_at(&whole, 0.5);
        let share = area(&half, &cut_ends(&half)) / (std::f64::consts::PI * 40.0 * 40.0);
        assert!((share - 1.0).abs() < 0.03, "{rings}: {share}");
    }
}

#[test]
fn a_flat_face_inside_the_bodys_reach_is_none() {
    // An L: the inner faces of its corner are flat and large, and the body reaches beyond their planes.
    let outline = [[0.0, 0.0], [60.0, 0.0], [60.0, 20.0], [20.0, 20.0], [20.0, 60.0], [0.0, 60.0]];
    let at = |k: usize, z: f64| Point3::new(outline[k % 6][0], outline[k % 6][1], z);
    let mut soup = Vec::new();
    for k in 0..6 {
        soup.push([at(k, 0.0), at(k + 1, 0.0), at(k + 1, 30.0)]);
        soup.push([at(k, 0.0), at(k + 1, 30.0), at(k, 30.0)]);
    }
    for [a, b, c] in [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]] {
        soup.push([at(a, 30.0), at(b, 30.0), at(c, 30.0)]);
        soup.push([at(a, 0.0), at(c, 0.0), at(b, 0.0)]);
    }
    let mesh = Mesh::from_soup(&soup).unwrap();
    let found = cut_ends(&mesh);
    for (t, found) in found.iter().enumerate() {
        let inner = mesh.corners(t).iter().all(|p| p.x == 20.0 && p.y >= 20.0)
            || mesh.corners(t).iter().all(|p| p.y == 20.0 && p.x >= 20.0);
        assert_eq!(*found, !inner, "{:?}", mesh.corners(t));
    }
}
