//! Mends what can be mended without a guess, and describes what cannot: the pieces of a mesh, its rims, its seams.
//!
//! In this order: vertices at the very same place become one; triangles without area are taken into their neighbours or dropped; of several triangles with the same
//! three corners the first stays; the two sides of a crack closer than 10^-6 of the box's diagonal become one (see [`super::weld`]);
//! the winding is made alike and outward (see [`super::winding`]); vertices of no triangle are dropped. Nothing is filled, cut or
//! moved otherwise: holes, T-junctions and edges of three triangles stay and are named. The order of vertices and triangles is the
//! file's.

use biplane_artifact::ModelMesh;
use biplane_geometry::{Mesh, MeshError, Point3, Topology, Vector3};

use super::edges::{Edge, Edges, Sets, runs_forward};
use super::weld::{Welder, near};
use super::winding::{Patch, Winding, area_vector, wind};

/// Open edges closer than this share of the box's diagonal are one: the rounding of 32-bit floats.
const NEAR: f64 = 1e-6;

/// What was mended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Repairs {
    /// Vertices at the very same place as an earlier one; corners of an STL file, which has no vertices, are not counted.
    pub same_vertices: usize,
    /// Vertices of open edges that were welded to one closer than 10^-6 of the diagonal.
    pub near_vertices: usize,
    /// Vertices of no triangle, left out.
    pub unused_vertices: usize,
    /// Triangles without area, left out.
    pub degenerate: usize,
    /// Triangles without area of three different corners, whose middle one was put into the side of the neighbour that lacked it: the surface
    /// stays what it is, and closed.
    pub needles: usize,
    /// Triangles with the same three corners as an earlier one, left out.
    pub duplicate: usize,
    /// Triangles that were wound against their neighbours, turned.
    pub rewound: usize,
    /// Patches that were inside out as a whole, turned.
    pub inverted: usize,
}

/// Triangles that hang together through edges.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// How many.
    pub triangles: usize,
    /// Smallest and largest corner of the box along the axes around it, mm.
    pub low_mm: [f64; 3],
    /// The other one.
    pub high_mm: [f64; 3],
    /// Area, mm^2.
    pub area_mm2: f64,
    /// Enclosed volume, mm^3; negative of a cavity, `None` of an open piece.
    pub volume_mm3: Option<f64>,
    /// Whether it is the wall of a cavity: it lies in another closed piece and faces inward.
    pub cavity: bool,
}

/// Edges that hang together: of one triangle (a rim), or of more than two (a seam).
#[derive(Debug, Clone, PartialEq)]
pub struct EdgeChain {
    /// How many.
    pub edges: usize,
    /// Their length, mm.
    pub length_mm: f64,
    /// Their middle, weighted by length, mm.
    pub centre_mm: [f64; 3],
    /// The piece they are of, by its place among the pieces.
    pub piece: usize,
}

/// A mesh with all that is known of it.
pub(super) struct Repaired {
    pub(super) mesh: ModelMesh,
    pub(super) topology: Topology,
    pub(super) repairs: Repairs,
    /// The largest area first.
    pub(super) pieces: Vec<Piece>,
    /// The longest first.
    pub(super) rims: Vec<EdgeChain>,
    pub(super) seams: Vec<EdgeChain>,
    /// Closed patches.
    pub(super) closed: usize,
    pub(super) closed_inverted: usize,
    pub(super) open_inverted: usize,
    pub(super) doubtful: usize,
    pub(super) cavities: usize,
    pub(super) cavities_unknown: bool,
}

/// Mends a mesh whose triangles name points that are there, all of them finite.
///
/// # Errors
/// No triangle with an area.
pub(super) fn repair(points: &[Point3], triangles: Vec<[u32; 3]>) -> Result<Repaired, MeshError> {
    let given = triangles.len();
    let mut repairs = Repairs::default();
    let (mut places, mut triangles) = weld_same(points, triangles, &mut repairs);
    take_in_needles(&places, &mut triangles, &mut repairs);
    drop_degenerate(&places, &mut triangles, &mut repairs);
    let mut edges = Edges::of(places.len(), &triangles);
    if drop_duplicates(&mut triangles, &edges, &mut repairs) {
        edges = Edges::of(places.len(), &triangles);
    }
    let (becomes, welded) = near(&places, &triangles, &edges, NEAR * diagonal(&places, &triangles));
    if welded > 0 {
        repairs.near_vertices = welded;
        triangles.iter_mut().flatten().for_each(|v| *v = becomes[*v as usize]);
        drop_degenerate(&places, &mut triangles, &mut repairs);
        edges = Edges::of(places.len(), &triangles);
        if drop_duplicates(&mut triangles, &edges, &mut repairs) {
            edges = Edges::of(places.len(), &triangles);
        }
    }
    if triangles.is_empty() {
        return Err(MeshError::Empty { triangles: given });
    }
    let winding = wind(&places, &mut triangles, &edges);
    let Parts { topology, pieces, rims, seams, doubtful } = parts(&places, &triangles, &edges, &winding);
    let Winding { patches, cavities_unknown, .. } = winding;
    let count = |f: fn(&Patch) -> bool| patches.iter().filter(|p| f(p)).count();
    repairs.rewound = patches.iter().map(|p| p.rewound).sum();
    repairs.inverted = count(|p| p.inverted);
    compact(&mut places, &mut triangles);
    Ok(Repaired {
        mesh: ModelMesh(Mesh::new(places, triangles)?),
        topology,
        repairs,
        pieces,
        rims,
        seams,
        closed: count(|p| p.closed),
        closed_inverted: count(|p| p.inverted && p.closed),
        open_inverted: count(|p| p.inverted && !p.closed),
        doubtful,
        cavities: count(|p| p.cavity),
        cavities_unknown,
    })
}

fn weld_same(
    points: &[Point3],
    mut triangles: Vec<[u32; 3]>,
    repairs: &mut Repairs,
) -> (Vec<Point3>, Vec<[u32; 3]>) {
    let mut used = vec![false; points.len()];
    triangles.iter().flatten().for_each(|v| used[*v as usize] = true);
    let mut welder = Welder::new(points.len());
    let becomes: Vec<u32> =
        points.iter().zip(&used).map(|(p, used)| if *used { welder.add(*p) } else { 0 }).collect();
    let places = welder.finish();
    repairs.unused_vertices = used.iter().filter(|u| !**u).count();
    repairs.same_vertices = points.len() - repairs.unused_vertices - places.len();
    triangles.iter_mut().flatten().for_each(|v| *v = becomes[*v as usize]);
    (places, triangles)
}

/// Takes in triangles whose corners `p, m, q` lie in a line, `m` in the middle: the neighbour `p, q, d` across their longest side becomes
/// `p, m, d` and `m, q, d`. Several of them behind each other take a round each.
fn take_in_needles(places: &[Point3], triangles: &mut Vec<[u32; 3]>, repairs: &mut Repairs) {
    const MOST_ROUNDS: usize = 16;
    let before = triangles.len();
    triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    repairs.degenerate += before - triangles.len();
    let flat = |t: &[u32; 3]| area_vector(places, t).norm() == 0.0;
    let mut needles: Vec<usize> = (0..triangles.len()).filter(|t| flat(&triangles[*t])).collect();
    for _ in 0..MOST_ROUNDS {
        if needles.is_empty() {
            return;
        }
        let edges = Edges::of(places.len(), triangles);
        // The other triangle across the longest side of each.
        let across = needles.iter().map(|&t| {
            let [a, b, c] = triangles[t];
            let length = |[p, q, _]: &[u32; 3]| (places[*p as usize] - places[*q as usize]).norm_squared();
            let ways = [[a, b, c], [b, c, a], [c, a, b]];
            let longest = ways.into_iter().fold(ways[0], |x, y| if length(&y) > length(&x) { y } else { x });
            (t, longest, edges.other(t, [longest[0], longest[1]]))
        });
        let across: Vec<_> = across.collect();
        let mut touched = vec![false; triangles.len()];
        for (t, [p, q, middle], neighbour) in across {
            let Some(n) = neighbour.filter(|n| !touched[*n] && !flat(&triangles[*n])) else {
                continue;
            };
            let with = |instead: u32| triangles[n].map(|v| if v == instead { middle } else { v });
            let (near, far) = (with(q), with(p));
            (triangles[n], triangles[t]) = (near, far);
            (touched[n], touched[t]) = (true, true);
            repairs.needles += 1;
        }
        let before = needles.len();
        needles.retain(|t| flat(&triangles[*t]));
        if needles.len() == before {
            return;
        }
    }
}

fn drop_degenerate(places: &[Point3], triangles: &mut Vec<[u32; 3]>, repairs: &mut Repairs) {
    let before = triangles.len();
    triangles.retain(|t| area_vector(places, t).norm() > 0.0);
    repairs.degenerate += before - triangles.len();
}

/// Drops every triangle with the corners of an earlier one; these share all their edges.
fn drop_duplicates(triangles: &mut Vec<[u32; 3]>, edges: &Edges, repairs: &mut Repairs) -> bool {
    let mut twice: Vec<usize> = Vec::new();
    let mut around: Vec<(u32, usize)> = Vec::new();
    for edge in edges.iter().filter(|e| e.halves.len() > 1) {
        around.clear();
        let third =
            |t: usize| triangles[t].iter().copied().find(|v| !edge.ends.contains(v)).unwrap_or(u32::MAX);
        around.extend(edge.halves.iter().map(|h| (third(h.triangle()), h.triangle())));
        around.sort_unstable();
        twice.extend(around.windows(2).filter(|w| w[0].0 == w[1].0).map(|w| w[1].1));
    }
    if twice.is_empty() {
        return false;
    }
    twice.sort_unstable();
    twice.dedup();
    repairs.duplicate += twice.len();
    let mut at = 0;
    let mut next = twice.iter().peekable();
    triangles.retain(|_| {
        let gone = next.next_if_eq(&&at).is_some();
        at += 1;
        !gone
    });
    true
}

/// Of the box around the vertices that are used.
fn diagonal(places: &[Point3], triangles: &[[u32; 3]]) -> f64 {
    let (mut low, mut high) = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
    for v in triangles.iter().flatten() {
        let place = &places[*v as usize].coords;
        (low, high) = (low.inf(place), high.sup(place));
    }
    if triangles.is_empty() { 0.0 } else { (high - low).norm() }
}

/// Drops vertices of no triangle.
fn compact(places: &mut Vec<Point3>, triangles: &mut [[u32; 3]]) {
    let mut number = vec![u32::MAX; places.len()];
    triangles.iter().flatten().for_each(|v| number[*v as usize] = 0);
    for (next, n) in number.iter_mut().filter(|n| **n == 0).enumerate() {
        *n = next as u32;
    }
    let mut kept = number.iter();
    places.retain(|_| kept.next().is_some_and(|n| *n != u32::MAX));
    triangles.iter_mut().flatten().for_each(|v| *v = number[*v as usize]);
}

struct Parts {
    topology: Topology,
    pieces: Vec<Piece>,
    rims: Vec<EdgeChain>,
    seams: Vec<EdgeChain>,
    /// Pieces of whose largest patch it is not told whether it is inside out.
    doubtful: usize,
}

fn parts(places: &[Point3], triangles: &[[u32; 3]], edges: &Edges, winding: &Winding) -> Parts {
    let Winding { patch_of, patches, .. } = winding;
    let mut joined = Sets::new(patches.len());
    let (mut open, mut many) = (Vec::new(), Vec::new());
    let mut inconsistent = 0;
    for edge in edges.iter() {
        match edge.halves {
            [_] => open.push(edge),
            [p, q] => {
                let [p, q] = [p, q].map(|h| runs_forward(&triangles[h.triangle()], edge.ends));
                inconsistent += usize::from(p == q);
            }
            all => {
                all.windows(2)
                    .for_each(|w| joined.join(patch_of[w[0].triangle()], patch_of[w[1].triangle()]));
                many.push(edge);
            }
        }
    }
    // A piece is one patch, or several that meet at edges of many triangles.
    let first: Vec<usize> = (0..patches.len()).map(|k| joined.first(k as u32) as usize).collect();
    let mut pieces: Vec<(usize, Piece)> = Vec::new();
    let mut largest: Vec<usize> = Vec::new();
    let mut place_of = vec![0; patches.len()];
    for (k, patch) in patches.iter().enumerate() {
        let volume = patch.closed.then_some(patch.volume);
        if first[k] == k {
            place_of[k] = pieces.len();
            largest.push(k);
            let (low_mm, high_mm) = (patch.low.into(), patch.high.into());
            let (area_mm2, cavity) = (patch.area, patch.cavity);
            pieces.push((k, Piece { triangles: 0, low_mm, high_mm, area_mm2, volume_mm3: volume, cavity }));
        } else {
            let place = place_of[first[k]];
            if patch.area > patches[largest[place]].area {
                largest[place] = k;
            }
            let (_, piece) = &mut pieces[place];
            piece.low_mm = [0, 1, 2].map(|i| piece.low_mm[i].min(patch.low[i]));
            piece.high_mm = [0, 1, 2].map(|i| piece.high_mm[i].max(patch.high[i]));
            piece.area_mm2 += patch.area;
            piece.volume_mm3 = piece.volume_mm3.zip(volume).map(|(a, b)| a + b);
            piece.cavity &= patch.cavity;
        }
    }
    for k in patch_of {
        pieces[place_of[first[*k as usize]]].1.triangles += 1;
    }
    pieces.sort_by(|(_, a), (_, b)| b.area_mm2.total_cmp(&a.area_mm2));
    for (place, (k, _)) in pieces.iter().enumerate() {
        place_of[*k] = place;
    }
    let piece_of = |t: usize| place_of[first[patch_of[t] as usize]];
    let topology = Topology {
        open_edges: open.len(),
        non_manifold_edges: many.len(),
        inconsistent_edges: inconsistent,
        bodies: pieces.len(),
    };
    Parts {
        topology,
        rims: chains(places, &open, piece_of),
        seams: chains(places, &many, piece_of),
        doubtful: largest.iter().filter(|k| patches[**k].doubtful).count(),
        pieces: pieces.into_iter().map(|(_, piece)| piece).collect(),
    }
}

/// Edges of one kind that hang together at vertices, the longest chain first.
fn chains(places: &[Point3], edges: &[Edge<'_>], piece_of: impl Fn(usize) -> usize) -> Vec<EdgeChain> {
    if edges.is_empty() {
        return Vec::new();
    }
    let mut sets = Sets::new(places.len());
    edges.iter().for_each(|e| sets.join(e.ends[0], e.ends[1]));
    let mut chain_of = vec![usize::MAX; places.len()];
    let mut chains: Vec<EdgeChain> = Vec::new();
    for edge in edges {
        let slot = &mut chain_of[sets.first(edge.ends[0]) as usize];
        if *slot == usize::MAX {
            *slot = chains.len();
            let piece = edge.halves.first().map_or(0, |h| piece_of(h.triangle()));
            chains.push(EdgeChain { edges: 0, length_mm: 0.0, centre_mm: [0.0; 3], piece });
        }
        let chain = &mut chains[*slot];
        let [p, q] = edge.ends.map(|v| places[v as usize]);
        let length = (q - p).norm();
        chain.edges += 1;
        chain.length_mm += length;
        for i in 0..3 {
            chain.centre_mm[i] += length * (p[i] + q[i]) / 2.0;
        }
    }
    for chain in &mut chains {
        chain.centre_mm = chain.centre_mm.map(|c| c / chain.length_mm);
    }
    chains.sort_by(|a, b| b.length_mm.total_cmp(&a.length_mm));
    chains
}
