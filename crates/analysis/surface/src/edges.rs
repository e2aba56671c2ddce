//! The edges of a mesh and the triangles at each of them.
//!
//! Half-edges go into one bucket a vertex, by the smaller of their ends, and are sorted within it: time in proportion to the
//! number of triangles, but for vertices at which very many meet, where it is `n log n`.

use biplane_geometry::Mesh;

/// The edges of a mesh, in the order in which the triangles name them first.
///
/// A half-edge `h` is side `h % 3` of triangle `h / 3`: from its corner of that number to the next.
#[derive(Debug, Clone)]
pub struct Edges {
    ends: Vec<[u32; 2]>,
    start: Vec<u32>,
    halves: Vec<u32>,
}

impl Edges {
    /// The edges of a mesh.
    pub fn of(mesh: &Mesh) -> Self {
        Self::of_triangles(mesh.triangles(), mesh.vertices().len())
    }

    /// The edges of triangles whose corners are below `vertices`; corners that are not are counted as the last vertex.
    pub fn of_triangles(triangles: &[[u32; 3]], vertices: usize) -> Self {
        let corners = triangles.as_flattened();
        let last = (vertices.max(1) - 1) as u32;
        let ends_of = |half: usize| {
            let next = if half % 3 == 2 { half - 2 } else { half + 1 };
            let (a, b) = (corners[half].min(last), corners[next].min(last));
            [a.min(b), a.max(b)]
        };
        let mut start = vec![0_u32; vertices.max(1) + 1];
        for half in 0..corners.len() {
            start[ends_of(half)[0] as usize + 1] += 1;
        }
        for v in 1..start.len() {
            start[v] += start[v - 1];
        }
        let mut place = start.clone();
        // The larger end above, the half-edge below: one number to sort by.
        let mut sorted = vec![0_u64; corners.len()];
        for half in 0..corners.len() {
            let [low, high] = ends_of(half);
            let slot = &mut place[low as usize];
            sorted[*slot as usize] = u64::from(high) << 32 | half as u64;
            *slot += 1;
        }
        let half_of = |key: u64| key as u32;
        // For the first half-edge of each edge, where its group is and how long.
        let mut group = vec![[0_u32; 2]; corners.len()];
        let mut count = 0;
        for v in 0..vertices.max(1) {
            let (from, to) = (start[v] as usize, start[v + 1] as usize);
            sorted[from..to].sort_unstable();
            let mut i = from;
            while i < to {
                let run = sorted[i..to].iter().take_while(|key| **key >> 32 == sorted[i] >> 32).count();
                group[half_of(sorted[i]) as usize] = [i as u32, run as u32];
                count += 1;
                i += run;
            }
        }
        let mut edges = Self {
            ends: Vec::with_capacity(count),
            start: Vec::with_capacity(count + 1),
            halves: Vec::with_capacity(corners.len()),
        };
        edges.start.push(0);
        for (half, &[from, run]) in group.iter().enumerate() {
            if run > 0 {
                edges.ends.push(ends_of(half));
                let keys = &sorted[from as usize..(from + run) as usize];
                edges.halves.extend(keys.iter().map(|key| half_of(*key)));
                edges.start.push(edges.halves.len() as u32);
            }
        }
        edges
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// Both ends of an edge, the smaller number first.
    pub fn ends(&self, edge: usize) -> [u32; 2] {
        self.ends[edge]
    }

    /// The half-edges of an edge, ascending.
    pub fn halves(&self, edge: usize) -> &[u32] {
        &self.halves[self.start[edge] as usize..self.start[edge + 1] as usize]
    }

    /// All edges: ends and half-edges.
    pub fn iter(&self) -> impl Iterator<Item = ([u32; 2], &[u32])> {
        (0..self.len()).map(|e| (self.ends[e], self.halves(e)))
    }
}
