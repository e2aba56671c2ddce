//! A triangle mesh, and what can be said of it without a method.

use std::collections::HashMap;

use crate::{Point3, Vector3};

/// Triangles over shared vertices, in model coordinates, mm. Counter-clockwise seen from outside, where it is closed.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    vertices: Vec<Point3>,
    triangles: Vec<[u32; 3]>,
}

/// Why a set of triangles is not a mesh.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// No triangle with an area.
    #[error("no triangle with an area among {triangles}")]
    Empty {
        /// Triangles given.
        triangles: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} has a coordinate that is not a finite number")]
    NotFinite {
        /// Zero-based vertex.
        vertex: usize,
    },
    /// A triangle names a vertex that is not there.
    #[error("triangle {triangle} names vertex {vertex}, but there are {vertices}")]
    NoSuchVertex {
        /// Zero-based triangle.
        triangle: usize,
        /// The vertex it names.
        vertex: u32,
        /// How many there are.
        vertices: usize,
    },
}

/// How a mesh's triangles hang together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Topology {
    /// Edges with one triangle: the rims of holes.
    pub open_edges: usize,
    /// Edges with more than two triangles.
    pub non_manifold_edges: usize,
    /// Edges that both of their triangles run through in the same direction: neighbours wound against each other.
    pub inconsistent_edges: usize,
    /// Pieces connected through edges.
    pub bodies: usize,
}

impl Mesh {
    /// Checks the indices and coordinates, drops triangles without area.
    ///
    /// # Errors
    /// A coordinate that is not finite, an index out of range, or no triangle left.
    pub fn new(vertices: Vec<Point3>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        if let Some(vertex) = vertices.iter().position(|v| !v.coords.iter().all(|c| c.is_finite())) {
            return Err(MeshError::NotFinite { vertex });
        }
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= vertices.len()) {
                return Err(MeshError::NoSuchVertex { triangle, vertex, vertices: vertices.len() });
            }
        }
        let given = triangles.len();
        let mut mesh = Self { vertices, triangles };
        let kept: Vec<[u32; 3]> =
            (0..given).filter(|&t| mesh.area_vector(t).norm() > 0.0).map(|t| mesh.triangles[t]).collect();
        if kept.is_empty() {
            return Err(MeshError::Empty { triangles: given });
        }
        mesh.triangles = kept;
        Ok(mesh)
    }

    /// From triangles that do not share vertices (STL): corners with the very same coordinates become one vertex.
    ///
    /// # Errors
    /// As [`Mesh::new`].
    pub fn from_soup(corners: &[[Point3; 3]]) -> Result<Self, MeshError> {
        let mut seen: HashMap<[u64; 3], u32> = HashMap::with_capacity(corners.len());
        let mut vertices = Vec::with_capacity(corners.len() / 2 + 3);
        let mut triangles = Vec::with_capacity(corners.len());
        for triangle in corners {
            // Adding 0.0 makes -0.0 and 0.0 the same corner.
            triangles.push(triangle.map(|p| {
                let key = [(p.x + 0.0).to_bits(), (p.y + 0.0).to_bits(), (p.z + 0.0).to_bits()];
                *seen.entry(key).or_insert_with(|| {
                    vertices.push(p);
                    (vertices.len() - 1) as u32
                })
            }));
        }
        Self::new(vertices, triangles)
    }

    /// Vertices, mm.
    pub fn vertices(&self) -> &[Point3] {
        &self.vertices
    }

    /// Vertex indices of the triangles.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The three corners of a triangle, mm.
    pub fn corners(&self, triangle: usize) -> [Point3; 3] {
        self.triangles[triangle].map(|v| self.vertices[v as usize])
    }

    /// Half the cross product of two sides: area in mm^2 times the outward normal.
    pub fn area_vector(&self, triangle: usize) -> Vector3 {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(&(c - a)) / 2.0
    }

    /// Surface area, mm^2.
    pub fn area(&self) -> f64 {
        (0..self.triangles.len()).map(|t| self.area_vector(t).norm()).sum()
    }

    /// Centroid of the surface, weighted by area, mm: the point at which a pose's translation error is taken.
    pub fn area_centroid(&self) -> Point3 {
        let mut sum = Vector3::zeros();
        let mut area = 0.0;
        for t in 0..self.triangles.len() {
            let [a, b, c] = self.corners(t);
            let w = self.area_vector(t).norm();
            sum += (a.coords + b.coords + c.coords) * (w / 3.0);
            area += w;
        }
        Point3::from(sum / area)
    }

    /// Enclosed volume, mm^3: negative where a closed mesh is wound inside out, without meaning where it is open.
    pub fn signed_volume(&self) -> f64 {
        let o = self.area_centroid();
        (0..self.triangles.len())
            .map(|t| {
                let [a, b, c] = self.corners(t);
                (a - o).cross(&(b - o)).dot(&(c - o)) / 6.0
            })
            .sum()
    }

    /// Smallest and largest corner of the box along the axes that holds the mesh, mm.
    pub fn bounding_box(&self) -> (Point3, Point3) {
        let mut low = self.vertices[self.triangles[0][0] as usize];
        let mut high = low;
        for &v in self.triangles.iter().flatten() {
            let p = &self.vertices[v as usize];
            low = Point3::from(low.coords.inf(&p.coords));
            high = Point3::from(high.coords.sup(&p.coords));
        }
        (low, high)
    }

    /// Root mean square distance of the surface from its area centroid, mm: the arm by which a rotation is worth a
    /// translation.
    pub fn radius_of_gyration(&self) -> f64 {
        let o = self.area_centroid();
        let (mut sum, mut area) = (0.0, 0.0);
        for t in 0..self.triangles.len() {
            let w = self.area_vector(t).norm();
            sum += w * self.corners(t).iter().map(|p| (p - o).norm_squared()).sum::<f64>() / 3.0;
            area += w;
        }
        (sum / area).sqrt()
    }

    /// The same mesh wound the other way.
    pub fn inverted(mut self) -> Self {
        for t in &mut self.triangles {
            t.swap(1, 2);
        }
        self
    }

    /// The same mesh, all coordinates multiplied (to change the unit).
    pub fn scaled(mut self, factor: f64) -> Self {
        for v in &mut self.vertices {
            *v *= factor;
        }
        self
    }

    /// Counts what keeps the mesh from being a closed, oriented, two-manifold surface.
    pub fn topology(&self) -> Topology {
        let mut edges: HashMap<(u32, u32), (u32, i32, u32)> =
            HashMap::with_capacity(self.triangles.len() * 2);
        let mut parent: Vec<u32> = (0..self.triangles.len() as u32).collect();
        fn root(parent: &mut [u32], mut i: u32) -> u32 {
            while parent[i as usize] != i {
                parent[i as usize] = parent[parent[i as usize] as usize];
                i = parent[i as usize];
            }
            i
        }
        for (t, corners) in self.triangles.iter().enumerate() {
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                let entry = edges.entry((a.min(b), a.max(b))).or_insert((0, 0, t as u32));
                entry.0 += 1;
                entry.1 += if a < b { 1 } else { -1 };
                let (r, s) = (root(&mut parent, entry.2), root(&mut parent, t as u32));
                parent[r.max(s) as usize] = r.min(s);
            }
        }
        let bodies = (0..parent.len() as u32).filter(|&t| root(&mut parent, t) == t).count();
        let count = |f: fn(&(u32, i32, u32)) -> bool| edges.values().filter(|e| f(e)).count();
        Topology {
            open_edges: count(|e| e.0 == 1),
            non_manifold_edges: count(|e| e.0 > 2),
            inconsistent_edges: count(|e| e.0 == 2 && e.1 != 0),
            bodies,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// A box with its corner at `low`, 12 triangles wound outward.
    fn cuboid(low: [f64; 3], size: [f64; 3]) -> Vec<[Point3; 3]> {
        let v = |i: usize| {
            Point3::new(
                low[0] + size[0] * (i & 1) as f64,
                low[1] + size[1] * ((i >> 1) & 1) as f64,
                low[2] + size[2] * ((i >> 2) & 1) as f64,
            )
        };
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
            .iter()
            .flat_map(|q| [[v(q[0]), v(q[1]), v(q[2])], [v(q[0]), v(q[2]), v(q[3])]])
            .collect()
    }

    #[test]
    fn a_box_is_closed_and_its_sizes_are_right() {
        let mesh = Mesh::from_soup(&cuboid([1.0, 2.0, 3.0], [2.0, 4.0, 6.0])).unwrap();
        assert_eq!(mesh.vertices().len(), 8);
        assert_relative_eq!(mesh.signed_volume(), 48.0, epsilon = 1e-9);
        assert_relative_eq!(mesh.area(), 88.0, epsilon = 1e-9);
        assert_relative_eq!(mesh.area_centroid(), Point3::new(2.0, 4.0, 6.0), epsilon = 1e-9);
        let closed = Topology { open_edges: 0, non_manifold_edges: 0, inconsistent_edges: 0, bodies: 1 };
        assert_eq!(mesh.topology(), closed);
        assert!(mesh.clone().inverted().signed_volume() < 0.0);
    }

    #[test]
    fn holes_bodies_and_wrong_winding_are_counted() {
        let mut soup = cuboid([0.0; 3], [1.0; 3]);
        soup.extend(cuboid([5.0; 3], [1.0; 3]));
        soup.pop();
        soup[0].swap(1, 2);
        let t = Mesh::from_soup(&soup).unwrap().topology();
        assert_eq!((t.open_edges, t.bodies, t.inconsistent_edges), (3, 2, 3));
    }

    #[test]
    fn nan_and_nothing_are_refused() {
        let p = Point3::new(0.0, 0.0, f64::NAN);
        let o = Point3::origin();
        assert_eq!(Mesh::from_soup(&[[o, p, p]]), Err(MeshError::NotFinite { vertex: 1 }));
        assert_eq!(Mesh::from_soup(&[[o, o, o]]), Err(MeshError::Empty { triangles: 1 }));
        assert_eq!(Mesh::from_soup(&[]), Err(MeshError::Empty { triangles: 0 }));
    }
}
