//! How far the farthest point of one surface is from another: the one-sided Hausdorff distance, between two bounds.
//!
//! The distance from one triangle of the other surface is a convex function of the place, so over a triangle it is largest in a
//! corner, and the distance from the whole surface is nowhere larger than that. So every triangle has an upper bound: the least,
//! over some triangles of the other surface that are near it, of its corners' largest distance from it. Where the bound is more
//! than the tolerance above the largest distance met so far, the triangle is cut at the middle of its longest side, and both
//! halves are looked at again.
//!
//! **Guaranteed:** the farthest point is at least `at_least_mm` and at most `at_most_mm` away, but for rounding (1e-12 of the
//! coordinates); the two differ by at most the tolerance, unless more than [`MOST_CUTS`] cuts were needed.

use biplane_geometry::{Mesh, Point3};

use crate::Surface;
use crate::closest::closest_of_triangle;

/// Cuts, after which the bound is given as it is.
pub const MOST_CUTS: usize = 4_000_000;

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

/// A corner: where, how far from the other surface, and on which of its triangles the closest point lies.
#[derive(Clone, Copy)]
struct Corner {
    at: Point3,
    distance: f64,
    near: u32,
}

/// How far the farthest point of `from` is from `to`.
pub fn farthest(from: &Mesh, to: &Surface, tolerance_mm: f64) -> Farthest {
    let mut near = 0;
    let mut corner = |at: Point3, hint: Option<u32>| {
        let closest = to.closest_near(&at, hint.unwrap_or(near));
        near = closest.triangle;
        Corner { at, distance: closest.distance_mm, near }
    };
    let mut corners: Vec<Option<Corner>> = vec![None; from.vertices().len()];
    let mut found = Farthest { at_least_mm: 0.0, at_most_mm: 0.0, at: from.corners(0)[0] };
    let meet = |found: &mut Farthest, c: &Corner| {
        if c.distance > found.at_least_mm {
            (found.at_least_mm, found.at) = (c.distance, c.at);
        }
    };
    for &v in from.triangles().as_flattened() {
        if corners[v as usize].is_none() {
            let c = corner(from.vertices()[v as usize], None);
            meet(&mut found, &c);
            corners[v as usize] = Some(c);
        }
    }
    let mut waiting: Vec<[Corner; 3]> = Vec::new();
    let mut cuts = 0;
    for vertices in from.triangles() {
        let [Some(a), Some(b), Some(c)] = vertices.map(|v| corners[v as usize]) else { continue };
        waiting.push([a, b, c]);
        while let Some(triangle) = waiting.pop() {
            let most = upper_bound(&triangle, to);
            if most <= found.at_least_mm + tolerance_mm || cuts >= MOST_CUTS {
                found.at_most_mm = found.at_most_mm.max(most);
                continue;
            }
            cuts += 1;
            let side = |k: usize| (triangle[k].at - triangle[(k + 1) % 3].at).norm_squared();
            let longest = (0..3).fold(0, |best, k| if side(k) > side(best) { k } else { best });
            let [p, q, r] = [0, 1, 2].map(|k| triangle[(longest + k) % 3]);
            let middle = corner(nalgebra::center(&p.at, &q.at), Some(p.near));
            meet(&mut found, &middle);
            waiting.push([p, middle, r]);
            waiting.push([middle, q, r]);
        }
    }
    found.at_most_mm = found.at_most_mm.max(found.at_least_mm);
    found
}

/// No point of the triangle is farther from the surface than this.
fn upper_bound(triangle: &[Corner; 3], to: &Surface) -> f64 {
    let size = |k: usize| (triangle[k].at - triangle[(k + 1) % 3].at).norm();
    let sides = [size(0), size(1), size(2)];
    // A place is at most this much farther than the corner that is nearest to it.
    let lipschitz =
        (0..3).map(|k| triangle[k].distance + sides[k].max(sides[(k + 2) % 3])).fold(f64::INFINITY, f64::min);
    let from_one = |near: u32| {
        let other = to.corners(near);
        let off = |c: &Corner| (c.at - closest_of_triangle(&c.at, &other)).norm();
        triangle.iter().map(off).fold(0.0, f64::max)
    };
    triangle.iter().map(|c| from_one(c.near)).fold(lipschitz, f64::min)
}
