//! Inside and outside of a surface.
//!
//! **Signed distance** takes its sign from the angle-weighted normal of the closest face, edge or vertex (Baerentzen and Aanaes,
//! "Signed distance computation using the angle weighted pseudonormal", 2005), which is right for a closed surface that does not
//! cross itself, and says for an open one on which side of its nearest part a place lies.
//!
//! **Winding number** counts signed crossings of a ray along x. A corner exactly beside the ray counts as below it and an edge
//! through it as passing on one side, for all triangles alike, so that every crossing of a closed surface counts once.

use biplane_geometry::{Point3, Vector3};

use crate::predicates::{side_of_plane, turn};
use crate::tree::{Child, STACK, Surface, child, cut};

impl Surface {
    /// Distance of a place from the surface, mm: negative inside of a surface that is wound outward.
    pub fn signed_distance(&self, place: &Point3) -> f64 {
        let closest = self.closest(place);
        let outward = self.normal_at(closest.triangle, &closest.at).dot(&(place - closest.at));
        if outward < 0.0 { -closest.distance_mm } else { closest.distance_mm }
    }

    /// The angle-weighted normal of the surface at a point of a triangle (not normalised): that of the face, or on its edges and
    /// corners the sum over all triangles there.
    pub fn normal_at(&self, triangle: u32, at: &Point3) -> Vector3 {
        let own = self.place(triangle);
        let corners = &self.corners[own as usize];
        if let Some(k) = (0..3).find(|&k| corners[k] == *at) {
            let vertex = self.vertices[own as usize][k];
            return self.fan(vertex).iter().map(|&t| self.weighted_normal(t, vertex)).sum();
        }
        // The coordinate of the point along the height over a side, as a share of the height.
        let normal = self.unit_normal(own);
        for k in 0..3 {
            let (a, b, c) = (corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]);
            let across = normal.cross(&(b - a));
            if across.dot(&(at - a)) <= 1e-12 * across.dot(&(c - a)) {
                let vertices = self.vertices[own as usize];
                let ends = [vertices[k], vertices[(k + 1) % 3]];
                let there = |t: &&u32| self.vertices[**t as usize].contains(&ends[1]);
                return self.fan(ends[0]).iter().filter(there).map(|&t| self.unit_normal(t)).sum();
            }
        }
        normal
    }

    fn unit_normal(&self, triangle: u32) -> Vector3 {
        let [a, b, c] = self.corners[triangle as usize];
        (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_else(Vector3::zeros)
    }

    /// The unit normal times the angle at a vertex.
    fn weighted_normal(&self, triangle: u32, vertex: u32) -> Vector3 {
        let corners = &self.corners[triangle as usize];
        let k = self.vertices[triangle as usize].iter().position(|&v| v == vertex).unwrap_or(0);
        let (u, v) = (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
        self.unit_normal(triangle) * u.cross(&v).norm().atan2(u.dot(&v))
    }

    /// How often the surface is wound about a place: 1 inside and 0 outside of a closed surface that is wound outward, more where
    /// closed parts overlap, without meaning where it is open. On the surface itself it is that of one of its sides.
    pub fn winding_number(&self, place: &Point3) -> i32 {
        let at = [cut(place.x), cut(place.y), cut(place.z)];
        let slack = (at[0].abs().max(at[1].abs()).max(at[2].abs())) * f32::EPSILON;
        let mut winding = 0;
        let mut stack = [0_u32; STACK];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            match child(stack[height]) {
                Child::Leaf(from, to) => {
                    winding += (from..to).map(|t| crossing(&self.corners[t as usize], place)).sum::<i32>();
                }
                Child::Node(number) => {
                    let node = &self.nodes[number as usize];
                    for k in 0..4 {
                        let beside = |axis: usize| {
                            node.low[axis][k] <= at[axis] + slack && at[axis] - slack <= node.high[axis][k]
                        };
                        if at[0] - slack <= node.high[0][k] && beside(1) && beside(2) {
                            stack[height] = node.child[k];
                            height += 1;
                        }
                    }
                }
            }
        }
        winding
    }

    /// Whether a place is inside of a closed surface: whether the surface is wound about it.
    pub fn contains(&self, place: &Point3) -> bool {
        self.winding_number(place) != 0
    }
}

/// 1 where the ray from a place along x leaves through the outer side of a triangle, -1 where it enters, 0 where it misses.
fn crossing(corners: &[Point3; 3], place: &Point3) -> i32 {
    let flat = |p: &Point3| [p.y, p.z];
    let above = corners.map(|c| c.z > place.z);
    let mut covers = 0;
    for k in 0..3 {
        let next = (k + 1) % 3;
        if above[k] == above[next] {
            continue;
        }
        // Both triangles of an edge look at it from its lower end.
        let (low, high) = if above[k] { (next, k) } else { (k, next) };
        if turn(flat(&corners[low]), flat(&corners[high]), flat(place)) > 0 {
            covers += if above[next] { 1 } else { -1 };
        }
    }
    if covers == 0 {
        return 0;
    }
    let [a, b, c] = corners;
    if side_of_plane(a, b, c, place) == -covers { covers } else { 0 }
}
