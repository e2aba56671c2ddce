//! What keeps a surface from being closed and two-manifold and free of crossings, each named with its slice.

use std::collections::BTreeMap;

use biplane_artifact::SurfaceFault;
use biplane_geometry::{Mesh, Point3};
use biplane_surface::{MeshCheck, Surface};

use crate::stack::Stack;

/// Pairs of triangles that cross are looked for up to this number.
const MOST_CROSSINGS: usize = 1000;

/// The faults, by slice and then by kind.
pub(crate) fn faults(mesh: &Mesh, check: &MeshCheck, stack: &Stack) -> Vec<SurfaceFault> {
    let vertex = |v: u32| mesh.vertices()[v as usize];
    let middle = |[a, b]: &[u32; 2]| nalgebra::center(&vertex(*a), &vertex(*b));
    let crossings = Surface::new(mesh).self_crossings(MOST_CROSSINGS);
    let of_triangle = |pair: &[u32; 2]| mesh.corners(pair[0] as usize)[0];
    let kinds: [(&str, Vec<Point3>); 5] = [
        ("open edges", check.open_edges.iter().map(middle).collect()),
        ("edges with more than two triangles", check.crowded_edges.iter().map(middle).collect()),
        (
            "edges whose triangles are wound against each other",
            check.inconsistent_edges.iter().map(middle).collect(),
        ),
        (
            "vertices in which the surface touches itself",
            check.pinched_vertices.iter().map(|v| vertex(*v)).collect(),
        ),
        ("pairs of triangles that cross each other", crossings.iter().map(of_triangle).collect()),
    ];
    let mut counted: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for (kind, (_, places)) in kinds.iter().enumerate() {
        for place in places {
            let slice = stack.slice_below(stack.height_mm(place));
            *counted.entry((slice, kind)).or_default() += 1;
        }
    }
    let fault = |((slice, kind), count): ((usize, usize), usize)| SurfaceFault {
        slice: Some(slice),
        what: format!("{count} {}", kinds[kind].0),
    };
    counted.into_iter().map(fault).collect()
}
