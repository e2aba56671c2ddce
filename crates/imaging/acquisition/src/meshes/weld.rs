//! Vertices that are one: those at the very same place, and those of open edges that lie closer than rounding.
//!
//! **Exact.** A table of hashes with a fixed function, so that no run differs from another; vertices keep the order in which they came.
//!
//! **Near.** A closed surface has nothing to weld, so only vertices of open edges are looked at. One within the tolerance of an earlier
//! one becomes it, the nearest first, unless a triangle has both: no triangle is collapsed, and a surface cannot be eaten up from its rim. No
//! vertex moves farther than the tolerance.

use biplane_geometry::Point3;

use super::edges::Edges;

const NONE: u32 = u32::MAX;

/// Gathers places, each once.
pub(super) struct Welder {
    places: Vec<Point3>,
    /// Indices of places, at twice their number or more; a power of two.
    table: Vec<u32>,
}

impl Welder {
    pub(super) fn new(expected: usize) -> Self {
        let size = (2 * expected).next_power_of_two().max(16);
        Self { places: Vec::with_capacity(expected), table: vec![NONE; size] }
    }

    /// The index of a place.
    pub(super) fn add(&mut self, place: Point3) -> u32 {
        // Adding 0.0 makes -0.0 and 0.0 the same place.
        let place = Point3::from(place.coords.add_scalar(0.0));
        let slot = self.slot(&place);
        if self.table[slot] != NONE {
            return self.table[slot];
        }
        let index = self.places.len() as u32;
        self.table[slot] = index;
        self.places.push(place);
        if 2 * self.places.len() > self.table.len() {
            self.grow();
        }
        index
    }

    /// The places in the order in which they came.
    pub(super) fn finish(self) -> Vec<Point3> {
        self.places
    }

    fn slot(&self, place: &Point3) -> usize {
        let mask = self.table.len() - 1;
        let mut slot = hash(place) as usize & mask;
        while let Some(known) = self.places.get(self.table[slot] as usize) {
            if bits(known) == bits(place) {
                break;
            }
            slot = (slot + 1) & mask;
        }
        slot
    }

    fn grow(&mut self) {
        self.table = vec![NONE; 2 * self.table.len()];
        for i in 0..self.places.len() {
            let slot = self.slot(&self.places[i]);
            self.table[slot] = i as u32;
        }
    }
}

fn bits(place: &Point3) -> [u64; 3] {
    [place.x.to_bits(), place.y.to_bits(), place.z.to_bits()]
}

fn hash(place: &Point3) -> u64 {
    const ODD: u64 = 0x9e37_79b9_7f4a_7c15;
    let mixed = bits(place).iter().fold(0, |h: u64, b| (h.rotate_left(23) ^ b).wrapping_mul(ODD));
    (mixed ^ (mixed >> 32)).wrapping_mul(ODD) >> 20
}

/// For each vertex the one it becomes (itself, mostly), and how many become another. See the module's head.
pub(super) fn near(
    places: &[Point3],
    triangles: &[[u32; 3]],
    edges: &Edges,
    tolerance: f64,
) -> (Vec<u32>, usize) {
    let mut becomes: Vec<u32> = (0..places.len() as u32).collect();
    let mut open: Vec<u32> = edges.iter().filter(|e| e.halves.len() == 1).flat_map(|e| e.ends).collect();
    open.sort_unstable();
    open.dedup();
    if open.is_empty() || tolerance <= 0.0 {
        return (becomes, 0);
    }
    let around = around(places.len(), triangles, &open);
    let mut cells = Cells::new(open.len(), tolerance);
    let mut welded = 0;
    for (k, &v) in open.iter().enumerate() {
        let place = &places[v as usize];
        let mine = around.of(k);
        let shares_triangle = |other: u32| {
            mine.iter().any(|&t| triangles[t as usize].iter().any(|&c| becomes[c as usize] == other))
        };
        let nearest = cells.nearest(places, place, tolerance, shares_triangle);
        match nearest {
            Some(other) => {
                becomes[v as usize] = other;
                welded += 1;
            }
            None => cells.add(places, v),
        }
    }
    (becomes, welded)
}

/// Triangles around some vertices.
struct Around {
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl Around {
    fn of(&self, k: usize) -> &[u32] {
        &self.triangles[self.starts[k] as usize..self.starts[k + 1] as usize]
    }
}

fn around(vertices: usize, triangles: &[[u32; 3]], chosen: &[u32]) -> Around {
    let mut place = vec![NONE; vertices];
    for (k, &v) in chosen.iter().enumerate() {
        place[v as usize] = k as u32;
    }
    let corners = || {
        let all = triangles.iter().enumerate().flat_map(|(t, c)| c.iter().map(move |&v| (t as u32, v)));
        all.map(|(t, v)| (t, place[v as usize])).filter(|(_, k)| *k != NONE)
    };
    let mut starts = vec![0_u32; chosen.len() + 1];
    for (_, k) in corners() {
        starts[k as usize + 1] += 1;
    }
    let mut sum = 0;
    for start in &mut starts {
        sum += *start;
        *start = sum;
    }
    let mut next = starts.clone();
    let mut around = vec![0; sum as usize];
    for (t, k) in corners() {
        around[next[k as usize] as usize] = t;
        next[k as usize] += 1;
    }
    Around { starts, triangles: around }
}

/// Vertices by the cube of space that they lie in, twice the tolerance a side.
struct Cells {
    side: f64,
    /// First vertex of a chain for each hash of a cube; cubes may share one.
    heads: Vec<u32>,
    /// Vertices and the next of the chain.
    links: Vec<(u32, u32)>,
}

/// Vertices of a chain that are looked at: where more crowd within the tolerance, it is no rounding.
const MOST_IN_CHAIN: usize = 64;

impl Cells {
    fn new(expected: usize, tolerance: f64) -> Self {
        Self {
            side: 2.0 * tolerance,
            heads: vec![NONE; (2 * expected).next_power_of_two()],
            links: Vec::new(),
        }
    }

    fn head(&self, cube: [f64; 3]) -> usize {
        hash(&Point3::from(cube.map(|c| c + 0.0))) as usize & (self.heads.len() - 1)
    }

    fn add(&mut self, places: &[Point3], v: u32) {
        let head = self.head(places[v as usize].coords.map(|c| (c / self.side).floor()).into());
        self.links.push((v, self.heads[head]));
        self.heads[head] = (self.links.len() - 1) as u32;
    }

    /// The nearest vertex within the tolerance, the first one added of several, that may be taken.
    fn nearest(
        &self,
        places: &[Point3],
        place: &Point3,
        tolerance: f64,
        barred: impl Fn(u32) -> bool,
    ) -> Option<u32> {
        let mut best: Option<(f64, u32)> = None;
        // The cubes that hold the corners of a cube of the tolerance around the place.
        for corner in 0..8 {
            let cube = [0, 1, 2].map(|axis| {
                let off = if corner >> axis & 1 == 0 { -tolerance } else { tolerance };
                ((place[axis] + off) / self.side).floor()
            });
            let mut link = self.heads[self.head(cube)];
            for _ in 0..MOST_IN_CHAIN {
                let Some(&(v, next)) = self.links.get(link as usize) else { break };
                let apart = (places[v as usize] - place).norm();
                if apart <= tolerance && best.is_none_or(|(d, b)| (apart, v) < (d, b)) && !barred(v) {
                    best = Some((apart, v));
                }
                link = next;
            }
        }
        best.map(|(_, v)| v)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_place_is_one_vertex_whatever_the_sign_of_zero() {
        let mut welder = Welder::new(0);
        let at = |i: u32| Point3::new(f64::from(i % 1000), -0.0, f64::from(i % 7));
        let indices: Vec<u32> = (0..21_000).map(|i| welder.add(at(i))).collect();
        assert_eq!(indices[..7000], indices[7000..14_000]);
        assert_eq!(welder.add(Point3::new(0.0, 0.0, 0.0)), 0);
        assert_eq!(welder.finish().len(), 7000);
    }

    #[test]
    fn near_vertices_of_a_crack_are_welded_and_those_of_one_triangle_are_not() {
        // Two triangles with a crack between them, and a thin one whose short side is below the tolerance.
        let places = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0], // one
            [1.0, 1.0, 0.0],
            [1e-7, 1.0, 0.0],
            [1.0, 1e-7, 0.0], // its neighbour
            [5.0, 0.0, 0.0],
            [5.0, 1e-7, 0.0],
            [6.0, 0.0, 0.0], // thin
        ]
        .map(Point3::from);
        let triangles = [[0, 1, 2], [3, 4, 5], [6, 7, 8]];
        let edges = Edges::of(9, &triangles);
        let (becomes, welded) = near(&places, &triangles, &edges, 1e-6);
        assert_eq!((becomes, welded), (vec![0, 1, 2, 3, 2, 1, 6, 7, 8], 2));
        let (becomes, welded) = near(&places, &triangles, &edges, 1e-8);
        assert_eq!((becomes, welded), ((0..9).collect(), 0));
    }
}
