//! How far the farthest point of one surface is from another: the one-sided Hausdorff distance, between two bounds.
//!
//! Every triangle has an upper bound: that of the surface below it (`overlay.rs`) or, where that has none, the least distance of
//! a corner and a side together. The triangle with the largest bound is cut at the middle of its longest side, again and again,
//! until no bound is more than the tolerance above the largest distance met so far.
//!
//! **Guaranteed:** the farthest point is at least `at_least_mm` and at most `at_most_mm` away, but for rounding (1e-12 of the
//! coordinates); the two differ by at most the tolerance, unless more than `MOST_CUTS` cuts were needed.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use biplane_geometry::{Mesh, Point3};

use crate::Surface;
use crate::overlay::Overlay;

/// Cuts, after which the bound is given as it is.
const MOST_CUTS: usize = 4_000_000;

/// Bounds of the largest distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Farthest {
    /// The distance of the farthest point that was looked at, mm.
    pub at_least_mm: f64,
    /// No point of the surface is farther, mm.
    pub at_most_mm: f64,
    /// The farthest point that was looked at.
    pub at: Point3,
}

/// How far the farthest point of `from` is from `to`.
pub fn farthest(from: &Mesh, to: &Surface, tolerance_mm: f64) -> Farthest {
    let found = Farthest { at_least_mm: -1.0, at_most_mm: 0.0, at: from.corners(0)[0] };
    let mut search = Search {
        to,
        tolerance_mm,
        found,
        waiting: BinaryHeap::new(),
        triangles: Vec::new(),
        overlay: Overlay::new(to),
    };
    let mut corners: Vec<Option<Corner>> = vec![None; from.vertices().len()];
    let mut near = 0;
    for &v in from.triangles().as_flattened() {
        let corner = &mut corners[v as usize];
        near = corner.get_or_insert_with(|| search.look(from.vertices()[v as usize], near)).near;
    }
    let whole =
        |t: &[u32; 3]| Some([corners[t[0] as usize]?, corners[t[1] as usize]?, corners[t[2] as usize]?]);
    let triangles: Vec<[Corner; 3]> = from.triangles().iter().filter_map(whole).collect();
    // Vertices may all lie on the other surface, and triangles be farthest from it in their middles: to know that first saves cuts.
    let below: Vec<u32> = triangles.iter().map(|t| search.look_at_middle(t)).collect();
    for (triangle, below) in triangles.into_iter().zip(below) {
        search.wait(triangle, below);
    }
    while let Some(Waiting { most, number }) = search.waiting.pop() {
        if most <= search.enough() || search.triangles.len() >= MOST_CUTS {
            search.found.at_most_mm = search.found.at_most_mm.max(most);
            break;
        }
        let triangle = search.triangles[number as usize];
        let side = |k: usize| (triangle[k].at - triangle[(k + 1) % 3].at).norm_squared();
        let longest = (0..3).fold(0, |best, k| if side(k) > side(best) { k } else { best });
        let [p, q, r] = [0, 1, 2].map(|k| triangle[(longest + k) % 3]);
        let middle = search.look(nalgebra::center(&p.at, &q.at), p.near);
        for half in [[p, middle, r], [middle, q, r]] {
            let below = search.look_at_middle(&half);
            search.wait(half, below);
        }
    }
    search.found.at_most_mm = search.found.at_most_mm.max(search.found.at_least_mm);
    search.found
}

/// A corner: where, how far from the other surface, and on which of its triangles the closest point lies.
#[derive(Clone, Copy)]
struct Corner {
    at: Point3,
    distance: f64,
    near: u32,
}

/// A triangle that may have to be cut; that with the largest bound is first, of equal ones that which came first.
struct Waiting {
    most: f64,
    number: u32,
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        self.most.total_cmp(&other.most).then(other.number.cmp(&self.number))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Waiting {}

struct Search<'a> {
    to: &'a Surface,
    tolerance_mm: f64,
    found: Farthest,
    waiting: BinaryHeap<Waiting>,
    /// Triangles that waited so far.
    triangles: Vec<[Corner; 3]>,
    overlay: Overlay,
}

impl Search<'_> {
    /// A bound up to which nothing need be cut.
    fn enough(&self) -> f64 {
        self.found.at_least_mm + self.tolerance_mm
    }

    fn look(&mut self, at: Point3, near: u32) -> Corner {
        let closest = self.to.closest_near(&at, near);
        if closest.distance_mm > self.found.at_least_mm {
            (self.found.at_least_mm, self.found.at) = (closest.distance_mm, at);
        }
        Corner { at, distance: closest.distance_mm, near: closest.triangle }
    }

    /// The triangle of the other surface that is closest to the middle of one.
    fn look_at_middle(&mut self, [a, b, c]: &[Corner; 3]) -> u32 {
        self.look(Point3::from((a.at.coords + b.at.coords + c.at.coords) / 3.0), a.near).near
    }

    /// Keeps a triangle if it may have a point that is too far; `below` is the other surface's triangle below its middle.
    fn wait(&mut self, triangle: [Corner; 3], below: u32) {
        let most = self.upper_bound(&triangle, below);
        if most <= self.enough() {
            self.found.at_most_mm = self.found.at_most_mm.max(most);
        } else {
            self.waiting.push(Waiting { most, number: self.triangles.len() as u32 });
            self.triangles.push(triangle);
        }
    }

    /// No point of the triangle is farther from the surface than this; not the best bound, where a quick one is good enough.
    fn upper_bound(&mut self, triangle: &[Corner; 3], below: u32) -> f64 {
        let side = |k: usize| (triangle[k].at - triangle[(k + 1) % 3].at).norm();
        let sides = [side(0), side(1), side(2)];
        // A place is at most that much farther than a corner as it lies from that corner.
        let from_corner = |k: usize| triangle[k].distance + sides[k].max(sides[(k + 2) % 3]);
        let most = from_corner(0).min(from_corner(1)).min(from_corner(2));
        if most <= self.enough() {
            return most;
        }
        let below = self.overlay.upper_bound(self.to, &triangle.map(|c| c.at), below);
        below.map_or(most, |below| below.min(most))
    }
}
