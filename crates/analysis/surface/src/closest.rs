//! The point of a surface that is closest to a place.
//!
//! The tree is gone down nearest box first, and no box is opened that is farther than the best point so far. The closest point
//! of a triangle is found by the region in which the place lies (Ericson, "Real-time collision detection", 2005, 5.1.5).

use biplane_geometry::{Point3, Vector3};

use crate::tree::{Child, STACK, Surface, child, cut};

/// A point of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Closest {
    /// The point, mm.
    pub at: Point3,
    /// The triangle of the mesh that it lies on; of several at the same distance always the same one.
    pub triangle: u32,
    /// How far it is from the place asked for, mm, not negative.
    pub distance_mm: f64,
}

/// The best so far: square of the distance, point, triangle in the order of the leaves.
#[derive(Clone, Copy)]
pub(crate) struct Best {
    pub square: f64,
    pub at: Point3,
    pub triangle: u32,
}

impl Surface {
    /// The closest point. For a place with a coordinate that is not a number some point of the surface, at a distance that is
    /// no number.
    pub fn closest(&self, place: &Point3) -> Closest {
        self.closest_near(place, 0)
    }

    /// The same as [`Self::closest`], sooner if it lies on or near the triangle `near`; of points at the same distance it may be
    /// another one.
    pub fn closest_near(&self, place: &Point3, near: u32) -> Closest {
        let start = self.place(near);
        let at = closest_of_triangle(place, &self.corners[start as usize]);
        let best = Best { square: (place - at).norm_squared(), at, triangle: start };
        self.closest_of(self.search(place, best))
    }

    /// The closest point, if it is nearer than `limit` mm.
    pub fn closest_within(&self, place: &Point3, limit: f64) -> Option<Closest> {
        let none = Best { square: limit.max(0.0).powi(2), at: *place, triangle: u32::MAX };
        let best = self.search(place, none);
        (best.triangle != u32::MAX).then(|| self.closest_of(best))
    }

    fn closest_of(&self, best: Best) -> Closest {
        let triangle = self.numbers.get(best.triangle as usize).copied().unwrap_or(0);
        Closest { at: best.at, triangle, distance_mm: best.square.sqrt() }
    }

    pub(crate) fn search(&self, place: &Point3, mut best: Best) -> Best {
        let at = [cut(place.x), cut(place.y), cut(place.z)];
        // What single precision may take away from the distance to a box: rounding of the place, then of the arithmetic.
        let slack = (at[0].abs().max(at[1].abs()).max(at[2].abs())) * f32::EPSILON;
        let limit = |square: f64| (square * (1.0 + 1e-6)) as f32 * (1.0 + 1e-6);
        let mut most = limit(best.square);
        // Squared distance above, code of the child below: sorted as numbers they are sorted by distance.
        let mut stack = [0_u64; STACK];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let entry = stack[height];
            if f32::from_bits((entry >> 32) as u32) > most {
                continue;
            }
            match child(entry as u32) {
                Child::Leaf(from, to) => {
                    for t in from..to {
                        let point = closest_of_triangle(place, &self.corners[t as usize]);
                        let square = (place - point).norm_squared();
                        if square < best.square {
                            best = Best { square, at: point, triangle: t };
                            most = limit(square);
                        }
                    }
                }
                Child::Node(number) => {
                    let node = &self.nodes[number as usize];
                    let mut square = [0.0_f32; 4];
                    for ((low, high), at) in node.low.iter().zip(&node.high).zip(at) {
                        for ((s, low), high) in square.iter_mut().zip(low).zip(high) {
                            let (below, above) = (low - at, at - high);
                            let off = if below > above { below } else { above } - slack;
                            let off = if off > 0.0 { off } else { 0.0 };
                            *s += off * off;
                        }
                    }
                    let mut near = [0_u64; 4];
                    let mut count = 0;
                    for (s, code) in square.iter().zip(node.child) {
                        if *s <= most && *s < f32::INFINITY {
                            near[count] = u64::from(s.to_bits()) << 32 | u64::from(code);
                            count += 1;
                        }
                    }
                    // Farthest first, so that the nearest is on top.
                    for i in 1..count {
                        let mut j = i;
                        while j > 0 && near[j - 1] < near[j] {
                            near.swap(j - 1, j);
                            j -= 1;
                        }
                    }
                    stack[height..height + count].copy_from_slice(&near[..count]);
                    height += count;
                }
            }
        }
        best
    }
}

/// The point of a triangle that is closest to a place; the triangle may have no width.
#[inline]
pub(crate) fn closest_of_triangle(p: &Point3, [a, b, c]: &[Point3; 3]) -> Point3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return *a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return *b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return along(a, &ab, d1, d1 - d3);
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return *c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return along(a, &ac, d2, d2 - d6);
    }
    let va = d3 * d6 - d5 * d4;
    let (from_b, from_c) = (d4 - d3, d5 - d6);
    if va <= 0.0 && from_b >= 0.0 && from_c >= 0.0 {
        return along(b, &(c - b), from_b, from_b + from_c);
    }
    let sum = va + vb + vc;
    a + ab * (vb / sum) + ac * (vc / sum)
}

fn along(from: &Point3, way: &Vector3, part: f64, whole: f64) -> Point3 {
    from + way * if whole > 0.0 { part / whole } else { 0.0 }
}
