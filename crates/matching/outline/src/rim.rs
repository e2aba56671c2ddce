//! A mesh laid out for finding its rim: face planes, and the faces beside each edge.

use std::collections::HashMap;

use biplane_geometry::{Mesh, Point3, Vector3};

/// A mesh with the adjacency that the rim needs. Made once a mesh, used for every pose.
#[derive(Debug, Clone)]
pub struct RimMesh {
    pub(crate) vertices: Vec<Point3>,
    /// Plane of each face: `normal . x - offset` is positive on the outer side; not normalised.
    pub(crate) planes: Vec<(Vector3, f64)>,
    /// Edges with two faces that run through it in opposite directions.
    pub(crate) edges: Vec<Edge>,
    /// All other edges: the surface ends there, or more than two faces meet.
    pub(crate) odd_edges: Vec<OddEdge>,
    centroid: Point3,
    radius_of_gyration: f64,
}

/// An edge from `ends[0]` to `ends[1]`; `left` runs through it in that direction, `right` in the other.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Edge {
    pub ends: [u32; 2],
    pub left: u32,
    pub right: u32,
}

/// An edge with any number of faces, each with +1 if it runs from `ends[0]` to `ends[1]`, else -1.
#[derive(Debug, Clone)]
pub(crate) struct OddEdge {
    pub ends: [u32; 2],
    pub faces: Vec<(u32, i32)>,
}

impl RimMesh {
    /// Builds the adjacency. The order of edges depends on the mesh alone.
    pub fn new(mesh: &Mesh) -> Self {
        let planes = (0..mesh.triangles().len())
            .map(|t| {
                let normal = mesh.area_vector(t);
                (normal, normal.dot(&mesh.corners(t)[0].coords))
            })
            .collect();
        let mut index: HashMap<(u32, u32), usize> = HashMap::with_capacity(mesh.triangles().len() * 2);
        let mut all: Vec<OddEdge> = Vec::with_capacity(mesh.triangles().len() * 3 / 2 + 3);
        for (face, corners) in mesh.triangles().iter().enumerate() {
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                let ends = [a.min(b), a.max(b)];
                let slot = *index.entry((ends[0], ends[1])).or_insert_with(|| {
                    all.push(OddEdge { ends, faces: Vec::with_capacity(2) });
                    all.len() - 1
                });
                all[slot].faces.push((face as u32, if a < b { 1 } else { -1 }));
            }
        }
        let (mut edges, mut odd_edges) = (Vec::with_capacity(all.len()), Vec::new());
        for edge in all {
            match edge.faces[..] {
                [(left, 1), (right, -1)] | [(right, -1), (left, 1)] => {
                    edges.push(Edge { ends: edge.ends, left, right });
                }
                _ => odd_edges.push(edge),
            }
        }
        Self {
            vertices: mesh.vertices().to_vec(),
            planes,
            edges,
            odd_edges,
            centroid: mesh.area_centroid(),
            radius_of_gyration: mesh.radius_of_gyration(),
        }
    }

    /// The mesh's area centroid, model coordinates, mm.
    pub fn centroid(&self) -> &Point3 {
        &self.centroid
    }

    /// Root mean square distance of the surface from its centroid, mm.
    pub fn radius_of_gyration(&self) -> f64 {
        self.radius_of_gyration
    }
}
