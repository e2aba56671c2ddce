//! Vertices that are one: those at the very same place, and those of open edges that lie closer than rounding.
//!
//! **Exact.** A table of hashes with a fixed function, so that no run differs from another; vertices keep the order in which they came.
//!
//! **Near.** A closed surface has nothing to weld, so only open edges are looked at. A crack of rounding has two sides: open edges whose ends
//! lie within the tolerance of each other. Each edge longer than twice the tolerance is joined to the nearest such edge, end to end.
//! Two ends are not joined if a triangle would have both, or if one would move farther than the tolerance. So no triangle is collapsed,
//! and a surface cannot be eaten up from its rim.

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
    let becomes = || (0..places.len() as u32).collect();
    let ends = edges.iter().filter(|e| e.halves.len() == 1).map(|e| e.ends);
    let open: Vec<[u32; 2]> = ends
        .filter(|ends| {
            let [p, q] = ends.map(|v| places[v as usize]);
            (q - p).norm() > 2.0 * tolerance
        })
        .collect();
    if open.is_empty() || tolerance <= 0.0 {
        return (becomes(), 0);
    }
    let mut chosen: Vec<u32> = open.iter().flatten().copied().collect();
    chosen.sort_unstable();
    chosen.dedup();
    let around = around(places.len(), triangles, &chosen);
    let mut joined = Joined { places, triangles, around, becomes: becomes(), members: becomes(), tolerance };
    let middles: Vec<Point3> =
        open.iter().map(|e| nalgebra::center(&places[e[0] as usize], &places[e[1] as usize])).collect();
    let mut cells = Cells::new(open.len(), tolerance);
    let apart = |p: u32, q: u32| (places[p as usize] - places[q as usize]).norm();
    for (k, &[p, q]) in open.iter().enumerate() {
        // How far apart the ends are at most, and the ends of the other edge in the order in which they fit.
        let fit = |other: u32| {
            let [r, s] = open[other as usize];
            let ways = [(apart(p, r).max(apart(q, s)), [r, s]), (apart(p, s).max(apart(q, r)), [s, r])];
            if ways[1].0 < ways[0].0 { ways[1] } else { ways[0] }
        };
        if let Some((_, [r, s])) = cells.nearest(&middles[k], fit) {
            joined.join(p, r);
            joined.join(q, s);
        }
        cells.add(&middles[k], k as u32);
    }
    let welded = joined.becomes.iter().enumerate().filter(|(v, to)| *v != **to as usize).count();
    (joined.becomes, welded)
}

/// Vertices that are joined; each set is known by its first member, whose place it takes.
struct Joined<'a> {
    places: &'a [Point3],
    triangles: &'a [[u32; 3]],
    around: Around,
    becomes: Vec<u32>,
    /// The next member of the same set; the last one leads to the first.
    members: Vec<u32>,
    tolerance: f64,
}

impl Joined<'_> {
    fn join(&mut self, p: u32, q: u32) {
        let (p, q) = (self.becomes[p as usize], self.becomes[q as usize]);
        let (first, other) = (p.min(q), p.max(q));
        if first == other || !self.may_join(first, other) {
            return;
        }
        let mut member = other;
        loop {
            self.becomes[member as usize] = first;
            member = self.members[member as usize];
            if member == other {
                break;
            }
        }
        // Two rings that exchange their successors are one.
        self.members.swap(first as usize, other as usize);
    }

    /// Whether no member of the other set would move too far or is in a triangle with the first set.
    fn may_join(&self, first: u32, other: u32) -> bool {
        let mut member = other;
        for _ in 0..MOST_TOGETHER {
            let place = &self.places[member as usize];
            let around = self.around.of(member);
            let shared = || {
                around
                    .iter()
                    .any(|t| self.triangles[*t as usize].iter().any(|c| self.becomes[*c as usize] == first))
            };
            if (place - self.places[first as usize]).norm() > self.tolerance || shared() {
                return false;
            }
            member = self.members[member as usize];
            if member == other {
                return true;
            }
        }
        false
    }
}

/// Triangles around some vertices.
struct Around {
    /// For each vertex its place among those chosen.
    place: Vec<u32>,
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl Around {
    fn of(&self, vertex: u32) -> &[u32] {
        let k = self.place[vertex as usize] as usize;
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
    Around { place, starts, triangles: around }
}

/// Edges by the cube of space that their middle lies in, twice the tolerance a side.
struct Cells {
    tolerance: f64,
    /// First link of a chain for each hash of a cube; cubes may share one.
    heads: Vec<u32>,
    /// Edges and the next of the chain.
    links: Vec<(u32, u32)>,
}

/// Vertices of a set, and edges of a chain that are looked at: where more crowd within the tolerance, it is no rounding.
const MOST_TOGETHER: usize = 64;

impl Cells {
    fn new(expected: usize, tolerance: f64) -> Self {
        Self { tolerance, heads: vec![NONE; (2 * expected).next_power_of_two()], links: Vec::new() }
    }

    fn head(&self, place: Point3) -> usize {
        let cube = place.coords.map(|c| (c / (2.0 * self.tolerance)).floor() + 0.0);
        hash(&Point3::from(cube)) as usize & (self.heads.len() - 1)
    }

    fn add(&mut self, middle: &Point3, edge: u32) {
        let head = self.head(*middle);
        self.links.push((edge, self.heads[head]));
        self.heads[head] = (self.links.len() - 1) as u32;
    }

    /// Of the edges around a place the one that fits best, within the tolerance; of several the first one.
    fn nearest(&self, place: &Point3, fit: impl Fn(u32) -> (f64, [u32; 2])) -> Option<(f64, [u32; 2])> {
        let mut best: Option<(f64, u32, [u32; 2])> = None;
        // The cubes that hold the corners of a cube of the tolerance around the place.
        for corner in 0..8 {
            let off = [0, 1, 2].map(|i| if corner >> i & 1 == 0 { -self.tolerance } else { self.tolerance });
            let mut link = self.heads[self.head(place + nalgebra::Vector3::from(off))];
            for _ in 0..MOST_TOGETHER {
                let Some(&(edge, next)) = self.links.get(link as usize) else { break };
                let (apart, ends) = fit(edge);
                if apart <= self.tolerance && best.is_none_or(|(d, e, _)| (apart, edge) < (d, e)) {
                    best = Some((apart, edge, ends));
                }
                link = next;
            }
        }
        best.map(|(apart, _, ends)| (apart, ends))
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
