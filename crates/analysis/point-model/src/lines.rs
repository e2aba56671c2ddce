//! The lines of a surface that a model keeps: sharp edges and rims, and the corners in which they meet.
//!
//! An edge is sharp where its triangles' normals differ by more than an angle. Noise makes short ones: lines that end in the open
//! surface before they are long enough, and small loops, are dropped. Where two lines meet in a vertex and go straight on it may
//! move along them; where they turn by more than [`CORNER_DEG`], or one or more than two meet, it is a corner and stays. Short rims stay as a whole.

use biplane_geometry::Point3;
use biplane_surface::Surface;

use crate::half_edges::{HalfEdges, Hold, NONE, next, prev};

/// A line that turns by more than this in a vertex has a corner there, degrees.
const CORNER_DEG: f64 = 60.0;

/// Marks sharp edges and corners; lines that are kept only where they are at least `shortest_mm` long.
pub(crate) fn mark(mesh: &mut HalfEdges, sharper_than_deg: f64, shortest_mm: f64) {
    let least = sharper_than_deg.to_radians().cos();
    for half in 0..mesh.from.len() as u32 {
        let twin = mesh.twin[half as usize];
        if twin == NONE || half > twin {
            continue;
        }
        let (a, b) = (mesh.normal(half), mesh.normal(twin));
        let sharp = a.dot(&b) < least * a.norm() * b.norm();
        for h in [half, twin] {
            mesh.line[h as usize] = if sharp { 0 } else { NONE };
        }
    }
    // What is left of a branch may be too short in turn.
    for _ in 0..3 {
        if !drop_short(mesh, shortest_mm) {
            break;
        }
    }
    hold_small_rims(mesh, 3.0 * shortest_mm);
    let least = CORNER_DEG.to_radians().cos();
    let lines = Lines::of(mesh);
    for v in mesh.live() {
        let hold = match *lines.at(v) {
            [] => Hold::Free,
            [a, b] => {
                let here = mesh.at[v as usize];
                let [p, q] = [a, b].map(|h| mesh.at[other_end(mesh, h, v) as usize]);
                let (p, q) = (here - p, q - here);
                if p.dot(&q) >= least * p.norm() * q.norm() { Hold::Line } else { Hold::Corner }
            }
            _ => Hold::Corner,
        };
        if mesh.hold[v as usize] != Hold::Fixed {
            mesh.hold[v as usize] = hold;
        }
    }
}

/// Holds the vertices of rims that are shorter than a length: cracks and small holes, whose sides would cross if they moved.
fn hold_small_rims(mesh: &mut HalfEdges, shorter_than_mm: f64) {
    let mut passed = vec![false; mesh.from.len()];
    let mut rim = Vec::new();
    for first in 0..mesh.from.len() as u32 {
        if !mesh.is_live(first) || mesh.twin[first as usize] != NONE {
            continue;
        }
        rim.clear();
        let mut half = first;
        while !passed[half as usize] {
            passed[half as usize] = true;
            rim.push(half);
            // Round the end of this rim's edge, to the next edge without a twin.
            half = next(half);
            while mesh.twin[half as usize] != NONE {
                half = next(mesh.twin[half as usize]);
            }
        }
        if rim.iter().map(|h| mesh.length(*h)).sum::<f64>() < shorter_than_mm {
            for h in &rim {
                mesh.hold[mesh.from[*h as usize] as usize] = Hold::Fixed;
            }
        }
    }
}

/// Numbers the marked lines, each from corner to corner or a loop, and gives the segments of each.
pub(crate) fn numbered(mesh: &mut HalfEdges) -> Vec<Surface> {
    let lines = Lines::of(mesh);
    let mut numbered = vec![false; mesh.from.len()];
    let mut trees = Vec::new();
    let goes_on = |v: &u32| mesh.hold[*v as usize] == Hold::Line;
    let ends: Vec<u32> = mesh.live().filter(|v| !goes_on(v)).chain(mesh.live().filter(goes_on)).collect();
    for first in ends {
        for &begin in lines.at(first) {
            if numbered[begin as usize] {
                continue;
            }
            let (mut here, mut half) = (first, begin);
            let mut segments = Vec::new();
            while !numbered[half as usize] {
                numbered[half as usize] = true;
                for h in [half, mesh.twin[half as usize]].into_iter().filter(|h| *h != NONE) {
                    mesh.line[h as usize] = trees.len() as u32;
                }
                let there = other_end(mesh, half, here);
                segments.push([here, there]);
                here = there;
                if let ([a, b], Hold::Line) = (lines.at(here), mesh.hold[here as usize]) {
                    half = if *a == half { *b } else { *a };
                }
            }
            trees.extend(Surface::of_segments(&mesh.at, &segments));
        }
    }
    trees
}

/// The half-edges that stand for the marked edges at each vertex.
struct Lines {
    start: Vec<u32>,
    halves: Vec<u32>,
}

impl Lines {
    fn of(mesh: &HalfEdges) -> Self {
        let marked: Vec<u32> =
            (0..mesh.from.len() as u32).filter(|h| mesh.stands_for_edge(*h) && mesh.is_sharp(*h)).collect();
        let mut start = vec![0_u32; mesh.at.len() + 1];
        let ends = |h: u32| [mesh.from[h as usize], mesh.to(h)];
        for v in marked.iter().flat_map(|h| ends(*h)) {
            start[v as usize + 1] += 1;
        }
        for v in 1..start.len() {
            start[v] += start[v - 1];
        }
        let mut place = start.clone();
        let mut halves = vec![0; marked.len() * 2];
        for &h in &marked {
            for v in ends(h) {
                halves[place[v as usize] as usize] = h;
                place[v as usize] += 1;
            }
        }
        Self { start, halves }
    }

    fn at(&self, vertex: u32) -> &[u32] {
        &self.halves[self.start[vertex as usize] as usize..self.start[vertex as usize + 1] as usize]
    }
}

fn other_end(mesh: &HalfEdges, half: u32, end: u32) -> u32 {
    let from = mesh.from[half as usize];
    if from == end { mesh.to(half) } else { from }
}

/// Takes the mark from lines that are too short; whether there were any. Rims are kept.
fn drop_short(mesh: &mut HalfEdges, shortest_mm: f64) -> bool {
    let lines = Lines::of(mesh);
    let mut passed = vec![false; mesh.from.len()];
    let mut line = Vec::new();
    let mut dropped = Vec::new();
    // From the ends and branchings of lines first; what is left then are loops.
    let ends: Vec<u32> = mesh.live().filter(|v| !matches!(lines.at(*v).len(), 0 | 2)).collect();
    for first in ends.into_iter().chain(mesh.live().filter(|v| lines.at(*v).len() == 2)) {
        for &begin in lines.at(first) {
            if passed[begin as usize] {
                continue;
            }
            line.clear();
            let (mut here, mut half) = (first, begin);
            let mut rim = false;
            loop {
                passed[half as usize] = true;
                line.push(half);
                rim |= mesh.twin[half as usize] == NONE;
                here = other_end(mesh, half, here);
                let [a, b] = *lines.at(here) else { break };
                half = if a == half { b } else { a };
                if passed[half as usize] {
                    break;
                }
            }
            let dangles = lines.at(first).len() == 1 || lines.at(here).len() == 1;
            let length: f64 = line.iter().map(|h| mesh.length(*h)).sum();
            let enough = if dangles { shortest_mm } else { 0.0 }.max(if here == first {
                2.0 * shortest_mm
            } else {
                0.0
            });
            if !rim && length < enough {
                dropped.extend_from_slice(&line);
            }
        }
    }
    for half in &dropped {
        let twin = mesh.twin[*half as usize];
        mesh.line[*half as usize] = NONE;
        mesh.line[twin as usize] = NONE;
    }
    !dropped.is_empty()
}

/// Middle between the neighbours of a vertex along its line; none if it does not lie on one.
pub(crate) fn middle_along(mesh: &HalfEdges, vertex: u32) -> Option<Point3> {
    let mut ends = [NONE; 2];
    let mut count = 0;
    let mut meet = |end: u32| {
        if let Some(slot) = ends.get_mut(count) {
            *slot = end;
        }
        count += 1;
    };
    mesh.fan(vertex, |h| {
        if mesh.is_sharp(h) {
            meet(mesh.to(h));
        }
        if mesh.twin[prev(h) as usize] == NONE {
            meet(mesh.from[prev(h) as usize]);
        }
    });
    (count == 2).then(|| nalgebra::center(&mesh.at[ends[0] as usize], &mesh.at[ends[1] as usize]))
}
