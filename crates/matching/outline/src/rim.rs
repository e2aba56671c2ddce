//! A mesh laid out for finding its rim: face planes, and the faces beside each edge.

use biplane_geometry::{Mesh, Point3};
use biplane_surface::{Edges, Surface};

/// A mesh with the adjacency that the rim needs. Made once a mesh, used for every pose.
#[derive(Debug, Clone)]
pub struct RimMesh {
    pub(crate) vertices: Vec<Point3>,
    pub(crate) planes: Planes,
    /// Edges with two faces that run through it in opposite directions: its ends, and of the faces the one that runs from the
    /// first end to the second (left) and the one that runs back (right).
    pub(crate) ends: Vec<[u32; 2]>,
    pub(crate) sides: Vec<[u32; 2]>,
    /// All other edges: the surface ends there, or more than two faces meet.
    pub(crate) odd_edges: Vec<OddEdge>,
    surface: Surface,
    centroid: Point3,
    radius_of_gyration: f64,
}

/// Planes of the faces, a list for each number, so that a loop over all of them streams: `normal . x - offset` is positive on the
/// outer side; not normalised.
#[derive(Debug, Clone)]
pub(crate) struct Planes {
    normals: [Vec<f64>; 3],
    offsets: Vec<f64>,
}

impl Planes {
    fn of(mesh: &Mesh) -> Self {
        let count = mesh.triangles().len();
        let list = || Vec::with_capacity(count);
        let mut planes = Self { normals: [list(), list(), list()], offsets: list() };
        for t in 0..count {
            let normal = mesh.area_vector(t);
            planes.normals.iter_mut().zip(normal.iter()).for_each(|(list, n)| list.push(*n));
            planes.offsets.push(normal.dot(&mesh.corners(t)[0].coords));
        }
        planes
    }

    /// For each face whether a point is on its outer side.
    pub fn face(&self, point: &Point3, facing: &mut Vec<bool>) {
        let [x, y, z] = &self.normals;
        facing.clear();
        let normals = x.iter().zip(y).zip(z);
        facing.extend(
            normals
                .zip(&self.offsets)
                .map(|(((x, y), z), offset)| x * point.x + y * point.y + z * point.z > *offset),
        );
    }
}

/// An edge with any number of faces, each with +1 if it runs from `ends[0]` to `ends[1]`, else -1.
#[derive(Debug, Clone)]
pub(crate) struct OddEdge {
    pub ends: [u32; 2],
    pub faces: Vec<(u32, i32)>,
}

impl RimMesh {
    /// Builds the adjacency. The order of edges depends on the mesh alone: as its triangles name them.
    pub fn new(mesh: &Mesh) -> Self {
        let corners = mesh.triangles().as_flattened();
        let all = Edges::of(mesh);
        let (mut ends, mut sides) = (Vec::with_capacity(all.len()), Vec::with_capacity(all.len()));
        let mut odd_edges = Vec::new();
        for (edge, halves) in all.iter() {
            let runs_along = |half: u32| corners[half as usize] == edge[0];
            match *halves {
                [a, b] if runs_along(a) != runs_along(b) => {
                    let (left, right) = if runs_along(a) { (a, b) } else { (b, a) };
                    ends.push(edge);
                    sides.push([left / 3, right / 3]);
                }
                _ => {
                    let face = |half: &u32| (half / 3, if runs_along(*half) { 1 } else { -1 });
                    odd_edges.push(OddEdge { ends: edge, faces: halves.iter().map(face).collect() });
                }
            }
        }
        Self {
            vertices: mesh.vertices().to_vec(),
            planes: Planes::of(mesh),
            ends,
            sides,
            odd_edges,
            surface: Surface::new(mesh),
            centroid: mesh.area_centroid(),
            radius_of_gyration: mesh.radius_of_gyration(),
        }
    }

    /// The mesh's triangles, for searches in space.
    pub fn surface(&self) -> &Surface {
        &self.surface
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use rand::{Rng, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;

    /// Triangles among few vertices, so that edges have one, two or many faces, wound in any way.
    fn tangle(random: &mut Xoshiro256PlusPlus) -> Mesh {
        let vertices: Vec<Point3> =
            (0..40).map(|_| Point3::from([0; 3].map(|_| random.random_range(-50.0..50.0)))).collect();
        let mut triangles = Vec::new();
        while triangles.len() < 150 {
            let t = [0; 3].map(|_| random.random_range(0..40_u32));
            if t[0] != t[1] && t[1] != t[2] && t[2] != t[0] {
                triangles.push(t);
            }
        }
        Mesh::new(vertices, triangles).unwrap()
    }

    /// The order of edges decides the order of an outline's points, and so the bytes of matches.
    #[test]
    fn edges_come_as_the_triangles_name_them_with_all_their_faces() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(8);
        for _ in 0..20 {
            let mesh = tangle(&mut random);
            let mut faces: BTreeMap<[u32; 2], Vec<(u32, i32)>> = BTreeMap::new();
            let mut order = Vec::new();
            for (face, t) in mesh.triangles().iter().enumerate() {
                for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                    let ends = [a.min(b), a.max(b)];
                    let at = faces.entry(ends).or_default();
                    if at.is_empty() {
                        order.push(ends);
                    }
                    at.push((face as u32, if a < b { 1 } else { -1 }));
                }
            }
            let rim = RimMesh::new(&mesh);
            let (mut plain, mut odd) = (rim.ends.iter().zip(&rim.sides), rim.odd_edges.iter());
            for ends in order {
                match faces[&ends][..] {
                    [(left, 1), (right, -1)] | [(right, -1), (left, 1)] => {
                        assert_eq!(plain.next(), Some((&ends, &[left, right])));
                    }
                    _ => {
                        let edge = odd.next().unwrap();
                        assert_eq!((edge.ends, &edge.faces), (ends, &faces[&ends]));
                    }
                }
            }
            assert!(plain.next().is_none() && odd.next().is_none());
        }
    }

    #[test]
    fn faces_look_at_what_is_on_the_outer_side_of_their_planes() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(9);
        let mesh = tangle(&mut random);
        let rim = RimMesh::new(&mesh);
        let mut facing = vec![true; 3];
        for _ in 0..200 {
            let point = Point3::from([0; 3].map(|_| random.random_range(-90.0..90.0)));
            rim.planes.face(&point, &mut facing);
            // To the bit, also for corners, which lie in their planes.
            for (place, t) in [(point, 0), (mesh.corners(7)[0], 7)] {
                rim.planes.face(&place, &mut facing);
                assert_eq!(facing.len(), mesh.triangles().len());
                let normal = mesh.area_vector(t);
                assert_eq!(facing[t], normal.dot(&place.coords) > normal.dot(&mesh.corners(t)[0].coords));
            }
        }
    }
}
