//! Pairs of triangles that cross, within a surface and between two.
//!
//! Both trees are gone down together, by pairs of boxes that meet; pairs of triangles whose own boxes meet are decided exactly
//! (`crossing.rs`).

use biplane_geometry::Point3;

use crate::crossing::{Meeting, meeting};
use crate::predicates::side_of_plane;
use crate::tree::{Child, Span, Surface, child, ends};

impl Surface {
    /// Pairs of triangles that cross or overlap, the smaller number first, ascending; once there are `limit` of them the search
    /// ends. Neighbours that are folded onto each other count, triangles that only touch do not.
    pub fn self_crossings(&self, limit: usize) -> Vec<[u32; 2]> {
        let mut pairs = Pairs { first: self, second: self, same: true, limit, found: Vec::new() };
        pairs.search();
        for pair in &mut pairs.found {
            pair.sort_unstable();
        }
        pairs.found.sort_unstable();
        pairs.found
    }

    /// Pairs of a triangle of this surface and one of another that cross or overlap, ascending; once there are `limit` of them
    /// the search ends.
    pub fn crossings_with(&self, other: &Surface, limit: usize) -> Vec<[u32; 2]> {
        let mut pairs = Pairs { first: self, second: other, same: false, limit, found: Vec::new() };
        pairs.search();
        pairs.found.sort_unstable();
        pairs.found
    }
}

struct Pairs<'a> {
    first: &'a Surface,
    second: &'a Surface,
    same: bool,
    limit: usize,
    found: Vec<[u32; 2]>,
}

impl Pairs<'_> {
    fn search(&mut self) {
        // Codes of children whose boxes meet, with their boxes.
        let whole = Span { low: [f32::NEG_INFINITY; 3], high: [f32::INFINITY; 3] };
        let mut stack = vec![((0, whole), (0, whole))];
        while let Some(((a, a_span), (b, b_span))) = stack.pop() {
            if self.found.len() >= self.limit {
                return;
            }
            let same = self.same && a == b;
            match (child(a), child(b)) {
                (Child::Leaf(a, a_end), Child::Leaf(b, b_end)) => self.leaves([a, a_end], [b, b_end], same),
                (Child::Node(a), Child::Node(b)) => {
                    let (first, second) = (&self.first.nodes[a as usize], &self.second.nodes[b as usize]);
                    for i in 0..4 {
                        let span = first.span(i);
                        let meets = second.meets(&span);
                        let from = if same { i } else { 0 };
                        for j in (from..4).filter(|j| meets[*j]) {
                            stack.push(((first.child[i], span), (second.child[j], second.span(j))));
                        }
                    }
                }
                (Child::Node(number), Child::Leaf(..)) => {
                    let node = &self.first.nodes[number as usize];
                    let meets = node.meets(&b_span);
                    for i in (0..4).filter(|i| meets[*i]) {
                        stack.push(((node.child[i], node.span(i)), (b, b_span)));
                    }
                }
                (Child::Leaf(..), Child::Node(number)) => {
                    let node = &self.second.nodes[number as usize];
                    let meets = node.meets(&a_span);
                    for j in (0..4).filter(|j| meets[*j]) {
                        stack.push(((a, a_span), (node.child[j], node.span(j))));
                    }
                }
            }
        }
    }

    fn leaves(&mut self, [a, a_end]: [u32; 2], [b, b_end]: [u32; 2], same: bool) {
        for i in a..a_end {
            let box_of_first = box_of(&self.first.corners[i as usize]);
            for j in (if same { i + 1 } else { b })..b_end {
                let box_of_second = box_of(&self.second.corners[j as usize]);
                let meets = box_of_first.iter().zip(&box_of_second).all(|(a, b)| (a.0 <= b.1) & (b.0 <= a.1));
                if meets && self.cross(i, j) {
                    if self.found.len() >= self.limit {
                        return;
                    }
                    self.found.push([self.first.numbers[i as usize], self.second.numbers[j as usize]]);
                }
            }
        }
    }

    fn cross(&self, i: u32, j: u32) -> bool {
        let triangle = |s: &'_ Surface, t: u32| (s.corners[t as usize], s.vertices[t as usize]);
        let (first, second) = (triangle(self.first, i), triangle(self.second, j));
        match meeting((&first.0, &first.1), (&second.0, &second.1), self.same) {
            Meeting::Apart => false,
            Meeting::Cross => true,
            Meeting::Edge { of_second, k, side } => {
                // Whether the surface passes through: its triangle beyond the edge is on the other side.
                let (surface, own, own_number, other) = if of_second {
                    (self.second, second.1, j, first.0)
                } else {
                    (self.first, first.1, i, second.0)
                };
                let ends = [own[k], own[(k + 1) % 3]];
                surface.across(own_number, ends).is_some_and(|beyond| {
                    let third = surface.vertices[beyond as usize].iter().position(|v| !ends.contains(v));
                    let [a, b, c] = &other;
                    third.is_some_and(|t| {
                        side_of_plane(a, b, c, &surface.corners[beyond as usize][t]) == -side
                    })
                })
            }
        }
    }
}

/// The least and the largest coordinate of a triangle along each axis.
fn box_of([a, b, c]: &[Point3; 3]) -> [(f64, f64); 3] {
    [0, 1, 2].map(|axis| ends(a[axis], b[axis], c[axis]))
}
