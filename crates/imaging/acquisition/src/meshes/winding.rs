//! Which way round the triangles of a mesh are: patch by patch, neighbours alike, closed patches outward.
//!
//! A **patch** is what hangs together through edges of exactly two triangles. Across such an edge the winding is carried on from
//! triangle to triangle; within a patch the larger area decides. A patch is **closed** if every edge of it has, of that patch, as many
//! triangles one way as the other; so two closed bodies that touch along an edge are two closed patches. The volume of a closed patch has
//! to be positive, or negative where it lies in an odd number of other closed patches: a cavity.
//!
//! Of an **open** patch the sign of the volume says something where little is missing: `|sum of area vectors| / area`, 0 for a
//! closed surface, 0.2 for a box without a lid, 0.5 for a half sphere, 1 for a flat sheet. Below [`NEARLY_CLOSED`] such a patch is
//! wound by its volume, which is taken as if each missing part were closed towards the middle of the rims. Above, it is left as it was. A surface on
//! which the winding carried on contradicts itself (a Möbius strip) is left too.

use biplane_geometry::{Point3, Vector3};

use super::edges::{Edges, runs_forward};
use super::nesting::{Closed, depths};

/// Share of a patch's area that its opening may have for its volume to say how it is wound.
const NEARLY_CLOSED: f64 = 0.25;
const NONE: u32 = u32::MAX;

/// What hangs together through edges of two triangles.
#[derive(Debug, Clone)]
pub(super) struct Patch {
    /// Whether its winding can be carried on without contradiction.
    pub(super) orientable: bool,
    pub(super) closed: bool,
    /// Whether it lies in an odd number of other closed patches.
    pub(super) cavity: bool,
    /// Triangles that were wound against the others.
    pub(super) rewound: usize,
    /// Whether all of it was inside out.
    pub(super) inverted: bool,
    /// Whether it is open and its volume does not tell, or tells the contrary.
    pub(super) doubtful: bool,
    /// Of the box around it.
    pub(super) low: Point3,
    pub(super) high: Point3,
    pub(super) area: f64,
    /// Enclosed, in the winding that it was given; without meaning where it is open.
    pub(super) volume: f64,
}

/// What was made of the winding.
pub(super) struct Winding {
    /// The patch of each triangle.
    pub(super) patch_of: Vec<u32>,
    pub(super) patches: Vec<Patch>,
    /// Whether there were too many closed patches to look for cavities.
    pub(super) cavities_unknown: bool,
}

/// Winds all triangles. Vertices without a triangle do not count.
pub(super) fn wind(places: &[Point3], triangles: &mut [[u32; 3]], edges: &Edges) -> Winding {
    let (patch_of, mut flip, mut patches) = carried_on(places, triangles, edges);
    let members = Members::of(&patch_of, patches.len());
    for (k, patch) in patches.iter_mut().enumerate() {
        let area_of = |t: &u32| area_vector(places, &triangles[*t as usize]).norm();
        let own = members.of_patch(k);
        if patch.orientable {
            let against: f64 = own.iter().filter(|t| flip[**t as usize]).map(area_of).sum();
            if 2.0 * against > patch.area {
                own.iter().for_each(|t| flip[*t as usize] ^= true);
            }
            patch.rewound = own.iter().filter(|t| flip[**t as usize]).count();
        } else {
            own.iter().for_each(|t| flip[*t as usize] = false);
        }
    }
    turn(triangles, &flip);
    let middles = close(places, triangles, edges, &patch_of, &mut patches);
    for (k, patch) in patches.iter_mut().enumerate() {
        patch.volume =
            members.of_patch(k).iter().map(|t| volume(places, &triangles[*t as usize], &middles[k])).sum();
    }
    let closed: Vec<usize> = (0..patches.len()).filter(|k| patches[*k].closed).collect();
    let surfaces: Vec<Closed<'_>> = closed
        .iter()
        .map(|&k| Closed { triangles: members.of_patch(k), low: patches[k].low, high: patches[k].high })
        .collect();
    let found =
        if closed.len() > 1 { depths(places, triangles, &surfaces) } else { Some(vec![0; closed.len()]) };
    let cavities_unknown = found.is_none();
    for (k, depth) in closed.iter().zip(found.unwrap_or_default()) {
        patches[*k].cavity = depth % 2 == 1;
    }
    for (k, patch) in patches.iter_mut().enumerate() {
        let own = members.of_patch(k);
        let inside_out = patch.volume != 0.0 && (patch.volume < 0.0) != patch.cavity;
        let opening = || {
            let sum: Vector3 = own.iter().map(|t| area_vector(places, &triangles[*t as usize])).sum();
            sum.norm() / patch.area
        };
        if patch.orientable && inside_out && (patch.closed || opening() < NEARLY_CLOSED) {
            patch.inverted = true;
            patch.volume = -patch.volume;
        } else {
            patch.doubtful = !patch.closed && inside_out;
        }
    }
    let flip: Vec<bool> = patch_of.iter().map(|k| patches[*k as usize].inverted).collect();
    turn(triangles, &flip);
    Winding { patch_of, patches, cavities_unknown }
}

fn turn(triangles: &mut [[u32; 3]], flip: &[bool]) {
    for (t, _) in triangles.iter_mut().zip(flip).filter(|(_, flip)| **flip) {
        t.swap(1, 2);
    }
}

/// The patch of each triangle, whether it is wound against the first one of its patch, and the patches.
fn carried_on(places: &[Point3], triangles: &[[u32; 3]], edges: &Edges) -> (Vec<u32>, Vec<bool>, Vec<Patch>) {
    // The triangle across each side, where there is exactly one, and whether it is wound alike.
    let mut across: Vec<Option<(u32, bool)>> = vec![None; 3 * triangles.len()];
    for edge in edges.iter() {
        if let [p, q] = edge.halves {
            // Neighbours wound alike run through their edge in opposite directions.
            let alike = [p, q].map(|h| runs_forward(&triangles[h.triangle()], edge.ends));
            let alike = alike[0] != alike[1];
            across[p.id()] = Some((q.triangle() as u32, alike));
            across[q.id()] = Some((p.triangle() as u32, alike));
        }
    }
    let mut patch_of = vec![NONE; triangles.len()];
    let mut flip = vec![false; triangles.len()];
    let mut patches = Vec::new();
    let mut stack: Vec<usize> = Vec::new();
    for first in 0..triangles.len() {
        if patch_of[first] != NONE {
            continue;
        }
        let number = patches.len() as u32;
        let from = places[triangles[first][0] as usize];
        let mut patch = Patch {
            orientable: true,
            closed: true,
            cavity: false,
            rewound: 0,
            inverted: false,
            doubtful: false,
            low: from,
            high: from,
            area: 0.0,
            volume: 0.0,
        };
        patch_of[first] = number;
        stack.push(first);
        while let Some(t) = stack.pop() {
            patch.area += area_vector(places, &triangles[t]).norm();
            for v in triangles[t] {
                let place = &places[v as usize].coords;
                patch.low = Point3::from(patch.low.coords.inf(place));
                patch.high = Point3::from(patch.high.coords.sup(place));
            }
            for (neighbour, alike) in across[3 * t..3 * t + 3].iter().flatten() {
                let neighbour = *neighbour as usize;
                let wanted = flip[t] == *alike;
                if patch_of[neighbour] == NONE {
                    patch_of[neighbour] = number;
                    flip[neighbour] = wanted;
                    stack.push(neighbour);
                } else if flip[neighbour] != wanted {
                    patch.orientable = false;
                }
            }
        }
        patches.push(patch);
    }
    (patch_of, flip, patches)
}

/// Says which patches are closed; gives for each a middle for its volume: that of its rims, or any place of a closed one.
fn close(
    places: &[Point3],
    triangles: &[[u32; 3]],
    edges: &Edges,
    patch_of: &[u32],
    patches: &mut [Patch],
) -> Vec<Point3> {
    let mut rims: Vec<(Vector3, f64)> = vec![(Vector3::zeros(), 0.0); patches.len()];
    let mut sums: Vec<(u32, i32)> = Vec::new();
    for edge in edges.iter().filter(|e| e.halves.len() != 2) {
        sums.clear();
        for half in edge.halves {
            let way = if runs_forward(&triangles[half.triangle()], edge.ends) { 1 } else { -1 };
            sums.push((patch_of[half.triangle()], way));
        }
        sums.sort_unstable();
        let [p, q] = edge.ends.map(|v| places[v as usize].coords);
        for of_one in sums.chunk_by(|a, b| a.0 == b.0) {
            if of_one.iter().map(|(_, way)| way).sum::<i32>() != 0 {
                let k = of_one[0].0 as usize;
                let length = (q - p).norm();
                patches[k].closed = false;
                rims[k].0 += (p + q) * (length / 2.0);
                rims[k].1 += length;
            }
        }
    }
    for patch in patches.iter_mut() {
        patch.closed &= patch.orientable;
    }
    let middle = |((sum, length), patch): (&(Vector3, f64), &Patch)| {
        if *length > 0.0 { Point3::from(sum / *length) } else { nalgebra::center(&patch.low, &patch.high) }
    };
    rims.iter().zip(patches.iter()).map(middle).collect()
}

/// Half the cross product of two sides.
pub(super) fn area_vector(places: &[Point3], triangle: &[u32; 3]) -> Vector3 {
    let [a, b, c] = triangle.map(|v| places[v as usize]);
    (b - a).cross(&(c - a)) / 2.0
}

/// Signed volume of a triangle's pyramid over a place.
fn volume(places: &[Point3], triangle: &[u32; 3], over: &Point3) -> f64 {
    let [a, b, c] = triangle.map(|v| places[v as usize] - over);
    a.cross(&b).dot(&c) / 6.0
}

/// Triangles sorted by patch.
struct Members {
    starts: Vec<u32>,
    sorted: Vec<u32>,
}

impl Members {
    fn of(patch_of: &[u32], patches: usize) -> Self {
        let mut starts = vec![0_u32; patches + 1];
        patch_of.iter().for_each(|k| starts[*k as usize + 1] += 1);
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        let mut next = starts.clone();
        let mut sorted = vec![0; patch_of.len()];
        for (t, k) in patch_of.iter().enumerate() {
            sorted[next[*k as usize] as usize] = t as u32;
            next[*k as usize] += 1;
        }
        Self { starts, sorted }
    }

    fn of_patch(&self, k: usize) -> &[u32] {
        &self.sorted[self.starts[k] as usize..self.starts[k + 1] as usize]
    }
}
