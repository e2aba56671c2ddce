//! How far two surfaces are apart, and how deep they are in each other.
//!
//! **Distance.** Both trees are gone down together, nearest pair of boxes first, and no pair is opened that is farther apart than the nearest pair
//! of triangles so far. Two triangles are nearest at a corner of one, or between an edge of each, unless they cross; crossing ones are
//! zero apart.
//!
//! **Depth.** Of surfaces that cross, or of which one holds the other: the largest distance of a vertex of one, inside the other, from the other's
//! surface. Between vertices a smooth body may be deeper by its sagitta.
//!
//! **Guaranteed:** the distance is that of the triangles to rounding of a few units in the last place of the coordinates. **Not guaranteed:**
//! a depth where a surface is not closed: inside has no meaning there, and it is not stated.

use biplane_geometry::{Point3, Rigid, Vector3};

use crate::closest::closest_of_triangle;
use crate::crossing::{Meeting, meeting};
use crate::tree::{Child, Span, Surface, child, ends};

/// Vertices that are tried to begin with.
const TRIED: usize = 512;

/// A pair of children with their boxes, and the square of the boxes' distance.
type Pair = (f64, u32, Span, u32, [[f64; 2]; 3]);

/// Where two surfaces are nearest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Apart {
    /// How far, mm; 0 where triangles cross.
    pub distance_mm: f64,
    /// The nearest points, of the first surface and of the second, both in the first one's coordinates, mm.
    pub at: [Point3; 2],
    /// Whether triangles cross.
    pub cross: bool,
}

/// A box of the second surface in the first one's coordinates: its middle and half its sides, turned.
struct Turned<'a, A, B> {
    move_b: &'a Rigid<A, B>,
    /// Sizes of the rotation's entries.
    sizes: [[f64; 3]; 3],
}

impl<A, B> Turned<'_, A, B> {
    /// The box along the first surface's axes that holds the box `span` of the second.
    fn span(&self, span: &Span) -> [[f64; 2]; 3] {
        let end = |axis: usize| [f64::from(span.low[axis]), f64::from(span.high[axis])];
        let ends: [[f64; 2]; 3] = [end(0), end(1), end(2)];
        let middle =
            self.move_b.transform(&Point3::from(Vector3::from_fn(|i, _| 0.5 * (ends[i][0] + ends[i][1]))));
        std::array::from_fn(|i| {
            let half: f64 = (0..3).map(|j| self.sizes[i][j] * 0.5 * (ends[j][1] - ends[j][0])).sum();
            let slack = 1e-9 * (middle[i].abs() + half);
            [middle[i] - half - slack, middle[i] + half + slack]
        })
    }
}

/// The longest side of a box.
fn size(of: &Span) -> f64 {
    (0..3).map(|i| f64::from(of.high[i]) - f64::from(of.low[i])).fold(0.0, f64::max)
}

/// The longest side of a box.
fn long(of: &[[f64; 2]; 3]) -> f64 {
    of.iter().map(|[low, high]| high - low).fold(0.0, f64::max)
}

/// Square of the distance of two boxes.
fn gap(a: &Span, b: &[[f64; 2]; 3]) -> f64 {
    (0..3).map(|i| (f64::from(a.low[i]) - b[i][1]).max(b[i][0] - f64::from(a.high[i])).max(0.0).powi(2)).sum()
}

/// The nearest points of two line segments (Ericson, "Real-time collision detection", 2005, 5.1.9).
fn segments([p, q]: [&Point3; 2], [r, s]: [&Point3; 2]) -> [Point3; 2] {
    let (d1, d2, off) = (q - p, s - r, p - r);
    let (a, e, f) = (d1.norm_squared(), d2.norm_squared(), d2.dot(&off));
    let c = d1.dot(&off);
    let within = |v: f64| if v.is_nan() { 0.0 } else { v.clamp(0.0, 1.0) };
    let (t1, t2) = if a <= 0.0 {
        (0.0, within(f / e))
    } else if e <= 0.0 {
        (within(-c / a), 0.0)
    } else {
        let b = d1.dot(&d2);
        let denominator = a * e - b * b;
        let t1 = if denominator > 0.0 { within((b * f - c * e) / denominator) } else { 0.0 };
        let t2 = (b * t1 + f) / e;
        if t2 < 0.0 {
            (within(-c / a), 0.0)
        } else if t2 > 1.0 {
            (within((b - c) / a), 1.0)
        } else {
            (t1, t2)
        }
    };
    [p + d1 * t1, r + d2 * t2]
}

/// The nearest points of two triangles that do not cross, with the square of their distance, if it is below `limit`.
fn triangles(a: &[Point3; 3], b: &[Point3; 3], limit: f64) -> Option<(f64, [Point3; 2])> {
    let mut best: Option<(f64, [Point3; 2])> = None;
    let mut most = limit;
    let mut keep = |pair: [Point3; 2]| {
        let square = (pair[0] - pair[1]).norm_squared();
        if square < most {
            most = square;
            best = Some((square, pair));
        }
    };
    for corner in a {
        keep([*corner, closest_of_triangle(corner, b)]);
    }
    for corner in b {
        keep([closest_of_triangle(corner, a), *corner]);
    }
    for i in 0..3 {
        for j in 0..3 {
            keep(segments([&a[i], &a[(i + 1) % 3]], [&b[j], &b[(j + 1) % 3]]));
        }
    }
    best
}

impl Surface {
    /// How far `other` is from this surface where it stands at `place` (from its coordinates to this surface's).
    pub fn apart<A, B>(&self, other: &Surface, place: &Rigid<A, B>) -> Apart {
        let rotation = place.rotation().to_rotation_matrix();
        let sizes = std::array::from_fn(|i| std::array::from_fn(|j| rotation.matrix()[(i, j)].abs()));
        let turned = Turned { move_b: place, sizes };
        // Some pair to begin with: of vertices all over, the one with the nearest neighbour.
        let first = place.transform(&other.corners[0][0]);
        let start = self.closest(&first);
        let mut found = Apart { distance_mm: start.distance_mm, at: [start.at, first], cross: false };
        for corners in other.corners.iter().step_by((other.corners.len() / TRIED).max(1)) {
            let corner = place.transform(&corners[0]);
            if let Some(nearer) = self.closest_within(&corner, found.distance_mm) {
                found = Apart { distance_mm: nearer.distance_mm, at: [nearer.at, corner], cross: false };
            }
        }
        let mut square = found.distance_mm * found.distance_mm;
        let whole = Span { low: [f32::NEG_INFINITY; 3], high: [f32::INFINITY; 3] };
        let everything = [[f64::NEG_INFINITY, f64::INFINITY]; 3];
        let mut stack: Vec<Pair> = vec![(0.0, 0, whole, 0, everything)];
        let mut next: Vec<Pair> = Vec::with_capacity(16);
        while let Some((gap_squared, a, a_span, b, b_span)) = stack.pop() {
            if gap_squared >= square {
                continue;
            }
            next.clear();
            match (child(a), child(b)) {
                (Child::Leaf(from, to), Child::Leaf(from_b, to_b)) => {
                    for t in from_b..to_b {
                        let moved = other.corners[t as usize].map(|corner| place.transform(&corner));
                        let box_of_moved = corner_box(&moved);
                        for own in &self.corners[from as usize..to as usize] {
                            if gap_of_boxes(&corner_box(own), &box_of_moved) > square {
                                continue;
                            }
                            if crosses(own, &moved) {
                                let [p, q] = crossing_point(own, &moved);
                                return Apart { distance_mm: 0.0, at: [p, q], cross: true };
                            }
                            if let Some((nearer, at)) = triangles(own, &moved, square) {
                                square = nearer;
                                found = Apart { distance_mm: nearer.sqrt(), at, cross: false };
                            }
                        }
                    }
                }
                // The larger box is opened; a leaf cannot be.
                (Child::Node(own), theirs)
                    if matches!(theirs, Child::Leaf(..)) || size(&a_span) > long(&b_span) =>
                {
                    self.open(own, |code, span| next.push((gap(&span, &b_span), code, span, b, b_span)));
                }
                (_, Child::Node(theirs)) => other.open(theirs, |code, span| {
                    let span = turned.span(&span);
                    next.push((gap(&a_span, &span), a, a_span, code, span));
                }),
                (Child::Node(_), Child::Leaf(..)) => {}
            }
            // Farthest first, so that the nearest is on top.
            next.retain(|n| n.0 < square);
            next.sort_by(|a, b| b.0.total_cmp(&a.0));
            stack.append(&mut next);
        }
        found
    }

    /// The children of a node with their boxes.
    fn open(&self, node: u32, mut with: impl FnMut(u32, Span)) {
        let node = &self.nodes[node as usize];
        for (k, code) in node.child.iter().enumerate() {
            let span = node.span(k);
            if span.low[0] <= span.high[0] {
                with(*code, span);
            }
        }
    }

    /// The largest distance from this surface, mm, of those of `places` (this surface's coordinates) that lie inside it; 0 if none does.
    /// The surface must be closed.
    pub fn depth(&self, places: impl Iterator<Item = Point3>) -> f64 {
        let inside = |place: &Point3| self.contains(place);
        places.filter(inside).map(|place| self.closest(&place).distance_mm).fold(0.0, f64::max)
    }
}

/// The box of a triangle.
fn corner_box([a, b, c]: &[Point3; 3]) -> [[f64; 2]; 3] {
    std::array::from_fn(|i| {
        let (low, high) = ends(a[i], b[i], c[i]);
        [low, high]
    })
}

/// Square of the distance of two boxes.
fn gap_of_boxes(a: &[[f64; 2]; 3], b: &[[f64; 2]; 3]) -> f64 {
    let apart = |i: usize| (a[i][0] - b[i][1]).max(b[i][0] - a[i][1]).max(0.0);
    (0..3).map(|i| apart(i) * apart(i)).sum()
}

/// Whether two triangles cross.
fn crosses(a: &[Point3; 3], b: &[Point3; 3]) -> bool {
    gap_of_boxes(&corner_box(a), &corner_box(b)) <= 0.0
        && meeting((a, &[0, 1, 2]), (b, &[3, 4, 5]), false) != Meeting::Apart
}

/// A place where two triangles that cross meet: the middle of where their edges go through the other one, or of the nearest corners.
fn crossing_point(a: &[Point3; 3], b: &[Point3; 3]) -> [Point3; 2] {
    triangles(a, b, f64::INFINITY).map_or([a[0], b[0]], |(_, at)| at)
}
