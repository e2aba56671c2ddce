//! What keeps a mesh from being a closed, oriented two-manifold, with the places.

use biplane_geometry::Mesh;

use crate::Edges;

/// The faults of a mesh, and its sizes. Edges are pairs of vertices, the smaller number first, in ascending order.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshCheck {
    /// Edges with one triangle: the rims of holes.
    pub open_edges: Vec<[u32; 2]>,
    /// Edges with more than two triangles.
    pub crowded_edges: Vec<[u32; 2]>,
    /// Edges that both of their triangles run through in the same direction.
    pub inconsistent_edges: Vec<[u32; 2]>,
    /// Vertices in which fans of triangles touch that share no edge there.
    pub pinched_vertices: Vec<u32>,
    /// For each triangle the number of its piece: pieces hang together through edges and count from 0 in the order of their
    /// first triangles.
    pub piece_of: Vec<u32>,
    /// How many pieces there are.
    pub pieces: usize,
    /// Enclosed volume, mm^3: negative where a closed mesh is wound inside out, without meaning where it is open.
    pub signed_volume_mm3: f64,
    /// Surface area, mm^2.
    pub area_mm2: f64,
}

impl MeshCheck {
    /// Looks at all edges and vertices of a mesh, in time nearly proportional to their number.
    pub fn of(mesh: &Mesh) -> Self {
        let corners = mesh.triangles().as_flattened();
        let next = |half: u32| if half % 3 == 2 { half - 2 } else { half + 1 };
        // A corner has the number of the half-edge that begins in it.
        let mut fans = Groups::new(corners.len());
        let mut bodies = Groups::new(corners.len() / 3);
        let (mut open_edges, mut crowded_edges, mut inconsistent_edges) =
            (Vec::new(), Vec::new(), Vec::new());
        for (ends, halves) in Edges::of(mesh).iter() {
            match *halves {
                [_] => open_edges.push(ends),
                [a, b] if corners[a as usize] == corners[b as usize] => inconsistent_edges.push(ends),
                [_, _] => {}
                _ => crowded_edges.push(ends),
            }
            for pair in halves.windows(2) {
                bodies.join(pair[0] / 3, pair[1] / 3);
                for end in ends {
                    let corner = |half: u32| if corners[half as usize] == end { half } else { next(half) };
                    fans.join(corner(pair[0]), corner(pair[1]));
                }
            }
        }
        let mut fans_at = vec![0_u32; mesh.vertices().len()];
        for corner in 0..corners.len() as u32 {
            if fans.first(corner) == corner {
                fans_at[corners[corner as usize] as usize] += 1;
            }
        }
        let mut piece_of = vec![0; corners.len() / 3];
        let mut pieces = 0;
        for t in 0..piece_of.len() as u32 {
            let first = bodies.first(t);
            // The first triangle of a group is its smallest, so it has its number already.
            piece_of[t as usize] = if first == t { pieces } else { piece_of[first as usize] };
            pieces += u32::from(first == t);
        }
        for edges in [&mut open_edges, &mut crowded_edges, &mut inconsistent_edges] {
            edges.sort_unstable();
        }
        Self {
            open_edges,
            crowded_edges,
            inconsistent_edges,
            pinched_vertices: (0..fans_at.len() as u32).filter(|v| fans_at[*v as usize] > 1).collect(),
            piece_of,
            pieces: pieces as usize,
            signed_volume_mm3: mesh.signed_volume(),
            area_mm2: mesh.area(),
        }
    }

    /// Whether every edge has two triangles, wound alike, and every vertex one fan.
    pub fn is_closed_manifold(&self) -> bool {
        self.open_edges.is_empty() && self.is_manifold()
    }

    /// Whether no edge has more than two triangles, all are wound alike, and every vertex has one fan; it may have rims.
    pub fn is_manifold(&self) -> bool {
        self.crowded_edges.is_empty()
            && self.inconsistent_edges.is_empty()
            && self.pinched_vertices.is_empty()
    }
}

/// Sets that are joined two by two; each is known by its smallest member.
struct Groups(Vec<u32>);

impl Groups {
    fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    fn first(&mut self, mut member: u32) -> u32 {
        while self.0[member as usize] != member {
            let above = self.0[self.0[member as usize] as usize];
            self.0[member as usize] = above;
            member = above;
        }
        member
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.first(a), self.first(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}
