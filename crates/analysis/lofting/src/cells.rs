//! Which triangles a cell has: marching cubes (Lorensen and Cline 1987) from a table made by rule.
//!
//! On each face of a cell every run of inside corners is cut off by a segment of its own; two inside corners across a diagonal are
//! so parted. The rule looks at the face alone, so both cells of a face agree. The segments chain into loops through the cut
//! edges; a loop is filled by triangles none of whose inner sides lies in a face of the cell. So triangles of neighbouring cells
//! meet in the segments of their common face and nowhere else, each segment in exactly two, wound alike: the surface is a closed
//! oriented two-manifold whatever the corners. That loops of one cell do not cross either is tested.

/// Corner `c` of a cell lies at `(c & 1, c >> 1 & 1, c >> 2)`. The corners of each edge, the lower one first.
pub(crate) const EDGES: [[u8; 2]; 12] =
    [[0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7]];

/// The corners of each face, counter-clockwise seen from outside the cell.
const FACES: [[u8; 4]; 6] =
    [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];

/// The triangles of all 256 cells, as edges of the cell, wound outward. Bit `c` of a case: corner `c` is inside.
#[derive(Debug, Clone)]
pub(crate) struct Cases {
    triangles: Vec<[u8; 3]>,
    start: [u16; 257],
}

impl Cases {
    pub fn new() -> Self {
        let mut cases = Self { triangles: Vec::with_capacity(1024), start: [0; 257] };
        for case in 0..=255_u8 {
            for ring in loops(case) {
                // Every loop has such triangles, see the tests.
                cases.triangles.extend(fill(&ring).map_or(Vec::new(), |f| f.1));
            }
            cases.start[usize::from(case) + 1] = cases.triangles.len() as u16;
        }
        cases
    }

    /// The triangles of a case.
    #[inline]
    pub fn of(&self, case: u8) -> &[[u8; 3]] {
        let case = usize::from(case);
        &self.triangles[usize::from(self.start[case])..usize::from(self.start[case + 1])]
    }
}

/// The edge between two corners.
fn edge(a: u8, b: u8) -> u8 {
    EDGES.iter().position(|e| *e == [a.min(b), a.max(b)]).unwrap_or(0) as u8
}

/// Whether two edges lie in one face.
fn share_face(a: u8, b: u8) -> bool {
    let [p, q] = [a, b].map(|e| EDGES[usize::from(e)]);
    FACES.iter().any(|face| p.iter().chain(&q).all(|c| face.contains(c)))
}

/// The loops of cut edges of a case.
fn loops(case: u8) -> Vec<Vec<u8>> {
    let inside = |c: u8| case >> c & 1 == 1;
    let mut next = [None; 12];
    for face in FACES {
        for k in 0..4 {
            // A run of inside corners begins at corner k; the segment goes from where the face's round enters it to where it leaves.
            if inside(face[k]) && !inside(face[(k + 3) % 4]) {
                let last = (k..k + 4).find(|m| !inside(face[(m + 1) % 4])).unwrap_or(k);
                let leaving = edge(face[last % 4], face[(last + 1) % 4]);
                next[usize::from(edge(face[(k + 3) % 4], face[k]))] = Some(leaving);
            }
        }
    }
    let mut found = Vec::new();
    for first in 0..12_u8 {
        let mut ring = Vec::new();
        let mut at = first;
        while let Some(to) = next[usize::from(at)].take() {
            ring.push(at);
            at = to;
        }
        if !ring.is_empty() {
            found.push(ring);
        }
    }
    found
}

/// The triangles of a loop: without a diagonal in a face, and of such the ones whose diagonals are shortest where all edges are cut in
/// their middle. (Some others of the longest loops cross themselves where edges are cut near their ends.)
fn fill(ring: &[u8]) -> Option<(u32, Vec<[u8; 3]>)> {
    let last = ring.len() - 1;
    if last < 2 {
        return Some((0, Vec::new()));
    }
    // The triangle on the loop's last side, and what is left of the loop on both sides of it.
    let with = |k: usize| {
        let diagonal = |a: usize, b: usize| match b - a {
            1 => Some(0),
            _ => (!share_face(ring[a], ring[b])).then(|| square(ring[a], ring[b])),
        };
        let length = diagonal(0, k)? + diagonal(k, last)?;
        let (before, after) = (fill(&ring[..=k])?, fill(&ring[k..])?);
        let triangles = [vec![[ring[0], ring[k], ring[last]]], before.1, after.1].concat();
        Some((length + before.0 + after.0, triangles))
    };
    (1..last).filter_map(with).reduce(|a, b| if b.0 < a.0 { b } else { a })
}

/// Square of the distance between the middles of two edges, in half sides of the cell.
fn square(a: u8, b: u8) -> u32 {
    let middle =
        |e: u8, axis: u8| EDGES[usize::from(e)].iter().map(|c| u32::from(c >> axis & 1)).sum::<u32>();
    (0..3).map(|axis| middle(a, axis).abs_diff(middle(b, axis)).pow(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_geometry::{Mesh, Point3};
    use biplane_surface::{MeshCheck, Surface};
    use rand::{Rng, SeedableRng};
    use std::collections::HashMap;

    #[test]
    fn every_case_is_filled_and_its_rim_is_the_segments_of_its_faces() {
        let cases = Cases::new();
        for case in 0..=255_u8 {
            let rings = loops(case);
            let wanted: usize = rings.iter().map(|r| r.len() - 2).sum();
            assert_eq!(cases.of(case).len(), wanted, "case {case}: {rings:?}");
            let mut sides = HashMap::new();
            for t in cases.of(case) {
                for k in 0..3 {
                    *sides.entry((t[k], t[(k + 1) % 3])).or_insert(0) += 1;
                }
            }
            let rim: usize = rings.iter().map(Vec::len).sum();
            let open = sides.keys().filter(|(a, b)| !sides.contains_key(&(*b, *a))).count();
            assert!(sides.values().all(|n| *n == 1) && open == rim, "case {case}");
            let cut = EDGES.iter().filter(|[a, b]| (case >> a & 1) != (case >> b & 1)).count();
            assert_eq!(rim, cut, "case {case}: each cut edge is in one loop once");
        }
    }

    /// Each pair of cells side by side, each of the three ways: one closed when all around is outside.
    #[test]
    fn neighbours_agree_in_every_case() {
        let cases = Cases::new();
        // The segments that a case leaves open in a face, as pairs of places on the face's edges, independent of the cell.
        let rim = |case: u8, axis: usize, side: u8| {
            let mut found = Vec::new();
            let triangles = cases.of(case);
            for t in triangles {
                for k in 0..3 {
                    let (a, b) = (t[k], t[(k + 1) % 3]);
                    let back = triangles.iter().any(|u| (0..3).any(|m| (u[m], u[(m + 1) % 3]) == (b, a)));
                    let on = |e: u8| EDGES[usize::from(e)].iter().all(|c| c >> axis & 1 == side);
                    if !back && on(a) && on(b) {
                        let place = |e: u8| EDGES[usize::from(e)].map(|c| c & !(1 << axis));
                        found.push(if side == 1 { (place(a), place(b)) } else { (place(b), place(a)) });
                    }
                }
            }
            found.sort_unstable();
            found
        };
        for axis in 0..3_usize {
            for case in 0..=255_u8 {
                for other in 0..=255_u8 {
                    let shared = |c: u8| {
                        let low = c & !(1 << axis);
                        (case >> (low | 1 << axis) & 1) == (other >> low & 1)
                    };
                    if (0..8).all(shared) {
                        assert_eq!(
                            rim(case, axis, 1),
                            rim(other, axis, 0),
                            "{case} beside {other} along {axis}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn noise_has_a_closed_surface_without_crossings() {
        let cases = Cases::new();
        let mut random = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(5);
        // Every case with cuts near the ends, where triangles get close to each other.
        for round in 0..60 {
            for case in 1..255_u8 {
                let cut = |_| {
                    let t: f64 = random.random();
                    match round % 3 {
                        0 => t,
                        1 => [1e-3, 0.999][usize::from(t > 0.5)],
                        _ => [1e-3, 0.5, 0.999][(t * 3.0) as usize],
                    }
                };
                let cuts: Vec<f64> = (0..12).map(cut).collect();
                let corner = |c: u8| [c & 1, c >> 1 & 1, c >> 2].map(f64::from);
                let vertices = (0..12)
                    .map(|e| {
                        let [p, q] = EDGES[e].map(corner);
                        Point3::from(std::array::from_fn::<f64, 3, _>(|a| p[a] + (q[a] - p[a]) * cuts[e]))
                    })
                    .collect();
                let triangles = cases.of(case).iter().map(|t| t.map(u32::from)).collect();
                let mesh = Mesh::new(vertices, triangles).unwrap();
                let crossing = Surface::new(&mesh).self_crossings(9);
                assert!(crossing.is_empty(), "case {case}: {crossing:?} of {:?}", cases.of(case));
                assert!(MeshCheck::of(&mesh).is_manifold());
            }
        }
    }
}
