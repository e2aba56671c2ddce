//! Flat ends of a mesh: where a volume cuts a bone off, its model has a flat lid that the body in the pictures does not have.
//!
//! A cut end is a patch of triangles that hang together in one plane, hold a good part of the surface, and have all of the mesh on their
//! inner side: the plane of a volume's first or last slice cannot have bone beyond it. **Not told apart:** a lid and a flat face that a body
//! truly has, such as the upper face of a tray; so it is for those to ask who know that a mesh was cut.

use biplane_geometry::{Mesh, Vector3};

use crate::Edges;

/// Farthest that a corner of a patch lies from its plane, and the mesh beyond it, mm: what evening out the points of a lid leaves.
const OFF_MM: f64 = 0.05;
/// Least cosine between a triangle's normal and that of its patch: 2 degrees. Smooth bone curves by that within a few triangles.
const STRAIGHT: f64 = 0.9994;
/// Least share of the whole surface that a cut end has; the lid over a shaft has several times that, a flat spot of bone less.
const LEAST_SHARE: f64 = 0.005;

/// Which triangles of a mesh are those of a cut end.
pub fn cut_ends(mesh: &Mesh) -> Vec<bool> {
    let count = mesh.triangles().len();
    let area: Vec<Vector3> = (0..count).map(|t| mesh.area_vector(t)).collect();
    let least = LEAST_SHARE * area.iter().map(Vector3::norm).sum::<f64>();
    let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); count];
    for (_, halves) in Edges::of(mesh).iter() {
        if let &[a, b] = halves {
            neighbours[(a / 3) as usize].push(b / 3);
            neighbours[(b / 3) as usize].push(a / 3);
        }
    }
    let (mut seen, mut cut) = (vec![false; count], vec![false; count]);
    for seed in 0..count {
        if seen[seed] {
            continue;
        }
        let patch = grown(mesh, seed, &area, &neighbours);
        let sum: Vector3 = patch.iter().map(|t| area[*t as usize]).sum();
        if sum.norm() < least {
            // Another seed may see farther from here: only the seed itself is done with.
            seen[seed] = true;
            continue;
        }
        patch.iter().for_each(|t| seen[*t as usize] = true);
        let normal = sum.normalize();
        let height = |v: u32| normal.dot(&mesh.vertices()[v as usize].coords);
        let corners = || patch.iter().flat_map(|t| mesh.triangles()[*t as usize]);
        let low = corners().map(height).fold(f64::INFINITY, f64::min);
        if mesh.triangles().iter().flatten().all(|v| height(*v) <= low + 2.0 * OFF_MM) {
            patch.iter().for_each(|t| cut[*t as usize] = true);
        }
    }
    cut
}

/// The triangles around `seed` that lie in its plane.
fn grown(mesh: &Mesh, seed: usize, area: &[Vector3], neighbours: &[Vec<u32>]) -> Vec<u32> {
    let (normal, at) = (area[seed].normalize(), mesh.corners(seed)[0]);
    let flat = |t: usize| {
        area[t].dot(&normal) >= STRAIGHT * area[t].norm()
            && mesh.corners(t).iter().all(|p| (p - at).dot(&normal).abs() <= OFF_MM)
    };
    let mut patch = vec![seed as u32];
    let mut taken = std::collections::BTreeSet::from([seed as u32]);
    let mut next = 0;
    while let Some(&t) = patch.get(next) {
        next += 1;
        for &other in &neighbours[t as usize] {
            if flat(other as usize) && taken.insert(other) {
                patch.push(other);
            }
        }
    }
    patch
}
