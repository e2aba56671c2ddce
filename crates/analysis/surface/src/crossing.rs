//! Whether two triangles cross, exactly.
//!
//! Two triangles cross where their common points make up a line with a length, along which the one passes from one side of the
//! other to the other side ([`Meeting::Cross`]), or an area, where they lie in one plane. Where an edge lies in the other
//! triangle's plane and within it, that hangs on the triangle on the other side of the edge ([`Meeting::Edge`]).
//!
//! For triangles without a common vertex the signs are those of Guigue and Devillers ("Fast and robust triangle-triangle
//! overlap test using orientation predicates", 2003). With one common vertex, they are wedges that begin in it.
//!
//! **Not seen:** surfaces that pass through each other exactly along edges of both.

use biplane_geometry::{Point3, Vector3};

use crate::predicates::{side_of_plane, turn};

/// A triangle: its corners and the numbers of its vertices.
pub(crate) type Triangle<'a> = (&'a [Point3; 3], &'a [u32; 3]);

/// How two triangles meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Meeting {
    /// Not at all, or they touch.
    Apart,
    /// They cross, or overlap in a plane.
    Cross,
    /// An edge of the first (false) or second (true) triangle lies in the other, whose side `side` its third corner is on; the
    /// edge begins at its corner `k`. They cross if the triangle beyond the edge is on the other side.
    Edge { of_second: bool, k: usize, side: i32 },
}

/// How two triangles meet. `shared` says whether equal numbers of vertices are the same vertex.
pub(crate) fn meeting(first: Triangle, second: Triangle, shared: bool) -> Meeting {
    let common = |a: usize| if shared { second.1.iter().position(|v| *v == first.1[a]) } else { None };
    let places = [common(0), common(1), common(2)];
    match places {
        [None, None, None] => apart(first.0, second.0),
        [Some(j), None, None] => one_vertex(first.0, 0, second.0, j),
        [None, Some(j), None] => one_vertex(first.0, 1, second.0, j),
        [None, None, Some(j)] => one_vertex(first.0, 2, second.0, j),
        [None, Some(i), Some(j)] => one_edge(first.0, 0, second.0, 3 - i - j),
        [Some(i), None, Some(j)] => one_edge(first.0, 1, second.0, 3 - i - j),
        [Some(i), Some(j), None] => one_edge(first.0, 2, second.0, 3 - i - j),
        [Some(_), Some(_), Some(_)] => Meeting::Cross,
    }
}

/// Two triangles with a common edge; `i` and `j` are their other corners. They overlap where one is folded onto the other.
fn one_edge(first: &[Point3; 3], i: usize, second: &[Point3; 3], j: usize) -> Meeting {
    let (a, b) = (&first[(i + 1) % 3], &first[(i + 2) % 3]);
    let along = b - a;
    let (u, v) = (first[i] - a, second[j] - a);
    // Both off the edge to the same side, as far as rounding can tell.
    let across = u.dot(&v) * along.norm_squared() - u.dot(&along) * v.dot(&along);
    if across < -1e-9 * u.norm() * v.norm() * along.norm_squared() {
        return Meeting::Apart;
    }
    if side_of_plane(&first[0], &first[1], &first[2], &second[j]) == 0 && overlap(first, second) {
        return Meeting::Cross;
    }
    Meeting::Apart
}

/// Two triangles with a common vertex, their corners `i` and `j`.
fn one_vertex(first: &[Point3; 3], i: usize, second: &[Point3; 3], j: usize) -> Meeting {
    let a = &first[i];
    let (b, c) = (&first[(i + 1) % 3], &first[(i + 2) % 3]);
    let (d, e) = (&second[(j + 1) % 3], &second[(j + 2) % 3]);
    // Most are neighbours in a fan: a plane through the vertex parts them.
    let way = |p: &Point3| (p - a).try_normalize(0.0).unwrap_or_else(Vector3::zeros);
    let (u, v, w, x) = (way(b), way(c), way(d), way(e));
    let unit = |p: Vector3| p.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
    let across = unit(u + v) - unit(w + x);
    let (near, far) = (across.dot(&u).min(across.dot(&v)), across.dot(&w).max(across.dot(&x)));
    if near > 1e-9 && far < -1e-9 {
        return Meeting::Apart;
    }
    let [d_side, e_side] = [d, e].map(|p| side_of_plane(a, b, c, p));
    if d_side == 0 && e_side == 0 {
        return if overlap(first, second) { Meeting::Cross } else { Meeting::Apart };
    }
    // A wedge's edge from the vertex towards `p`, in the plane of the wedge from the vertex to `q` and `r`: within it? By the
    // projection along the axis in which the plane is largest.
    if d_side == 0 || e_side == 0 {
        let (on, k, off) = if d_side == 0 { (d, j, e_side) } else { (e, (j + 2) % 3, d_side) };
        return if in_wedge(a, b, c, on) {
            Meeting::Edge { of_second: true, k, side: off }
        } else {
            Meeting::Apart
        };
    }
    let [b_side, c_side] = [b, c].map(|p| side_of_plane(a, d, e, p));
    if b_side == 0 || c_side == 0 {
        let (on, k, off) = if b_side == 0 { (b, i, c_side) } else { (c, (i + 2) % 3, b_side) };
        return if in_wedge(a, d, e, on) {
            Meeting::Edge { of_second: false, k, side: off }
        } else {
            Meeting::Apart
        };
    }
    if d_side == e_side || b_side == c_side {
        return Meeting::Apart;
    }
    // The line through d and e passes the plane of the first within its wedge: both of these have the sign of its passing.
    let passes = [side_of_plane(d, e, a, b), side_of_plane(d, e, c, a)];
    if passes == [e_side, e_side] { Meeting::Cross } else { Meeting::Apart }
}

/// Whether a point in the plane of `a, b, c` is within the wedge from `a` between `b` and `c`, its sides apart.
fn in_wedge(a: &Point3, b: &Point3, c: &Point3, p: &Point3) -> bool {
    let flat = flattening(&[*a, *b, *c]);
    let [a, b, c, p] = [a, b, c, p].map(flat);
    let whole = turn(a, b, c);
    whole != 0 && turn(a, b, p) == whole && turn(a, p, c) == whole
}

/// Two triangles without a common vertex.
fn apart(first: &[Point3; 3], second: &[Point3; 3]) -> Meeting {
    let sides = |of: &[Point3; 3], from: &[Point3; 3]| {
        [0, 1, 2].map(|k| side_of_plane(&from[0], &from[1], &from[2], &of[k]))
    };
    let clear = |s: &[i32; 3]| s.iter().all(|v| *v > 0) || s.iter().all(|v| *v < 0);
    // Flat parts of a surface are full of pairs in one plane: those that a line parts need no exact sign.
    if parted(first, second) || parted(second, first) {
        return Meeting::Apart;
    }
    let second_sides = sides(second, first);
    if clear(&second_sides) {
        return Meeting::Apart;
    }
    if second_sides == [0; 3] {
        return if overlap(first, second) { Meeting::Cross } else { Meeting::Apart };
    }
    let first_sides = sides(first, second);
    if clear(&first_sides) {
        return Meeting::Apart;
    }
    let straddles = |s: &[i32; 3]| s.contains(&1) && s.contains(&-1);
    if straddles(&first_sides) && straddles(&second_sides) {
        return if lines_overlap(first, &first_sides, second, &second_sides) {
            Meeting::Cross
        } else {
            Meeting::Apart
        };
    }
    // An edge in the other's plane: its two signs are zero.
    let edge_of = |s: &[i32; 3]| (0..3).find(|&k| s[k] == 0 && s[(k + 1) % 3] == 0);
    if let Some(k) = edge_of(&second_sides).filter(|k| within(first, &second[*k], &second[(k + 1) % 3])) {
        return Meeting::Edge { of_second: true, k, side: second_sides[(k + 2) % 3] };
    }
    if let Some(k) = edge_of(&first_sides).filter(|k| within(second, &first[*k], &first[(k + 1) % 3])) {
        return Meeting::Edge { of_second: false, k, side: first_sides[(k + 2) % 3] };
    }
    Meeting::Apart
}

/// Whether a plane through a side of the first triangle, upright on it, has the second clearly on its outer side.
fn parted(first: &[Point3; 3], second: &[Point3; 3]) -> bool {
    let normal = (first[1] - first[0]).cross(&(first[2] - first[0]));
    (0..3).any(|k| {
        let outward = (first[(k + 1) % 3] - first[k]).cross(&normal);
        let margin = 1e-9 * outward.norm() * (second[0] - first[k]).norm();
        second.iter().all(|p| outward.dot(&(p - first[k])) > margin)
    })
}

/// Whether the stretches, in which two triangles that straddle each other's planes meet the line of both planes, overlap.
fn lines_overlap(
    first: &[Point3; 3],
    first_sides: &[i32; 3],
    second: &[Point3; 3],
    second_sides: &[i32; 3],
) -> bool {
    // The corner that is alone on its side comes first, and the winding of the other is turned so that it is on its upper side.
    let alone = |s: &[i32; 3]| {
        (0..3).find(|&k| s[k] != 0 && s[(k + 1) % 3] != s[k] && s[(k + 2) % 3] != s[k]).unwrap_or(0)
    };
    let (i, j) = (alone(first_sides), alone(second_sides));
    let [p1, mut q1, mut r1] = [0, 1, 2].map(|k| &first[(i + k) % 3]);
    let [p2, mut q2, mut r2] = [0, 1, 2].map(|k| &second[(j + k) % 3]);
    if first_sides[i] < 0 {
        std::mem::swap(&mut q2, &mut r2);
    }
    if second_sides[j] < 0 {
        std::mem::swap(&mut q1, &mut r1);
    }
    side_of_plane(p1, q1, p2, q2) < 0 && side_of_plane(p1, r1, r2, p2) < 0
}

/// Whether a segment in the plane of a triangle has a stretch within it, its sides apart.
fn within(triangle: &[Point3; 3], from: &Point3, to: &Point3) -> bool {
    let flat = flattening(triangle);
    let (mut corners, from, to) = ([0, 1, 2].map(|k| flat(&triangle[k])), flat(from), flat(to));
    match turn(corners[0], corners[1], corners[2]) {
        0 => return false,
        1 => {}
        _ => corners.swap(1, 2),
    }
    // Convex sets without common inner points have a side of the triangle, or the segment's line, between them.
    let beside = |k: usize| [from, to].iter().all(|p| turn(corners[k], corners[(k + 1) % 3], *p) <= 0);
    let sides = corners.map(|c| turn(from, to, c));
    !(0..3).any(beside) && sides.contains(&1) && sides.contains(&-1)
}

/// Whether two triangles in one plane have an area in common: no side of either has the other on its outer side.
fn overlap(first: &[Point3; 3], second: &[Point3; 3]) -> bool {
    let flat = flattening(first);
    let [first, second] = [first, second].map(|t| [0, 1, 2].map(|k| flat(&t[k])));
    let counter_clockwise = |t: [[f64; 2]; 3]| match turn(t[0], t[1], t[2]) {
        0 => None,
        1 => Some(t),
        _ => Some([t[0], t[2], t[1]]),
    };
    let (Some(first), Some(second)) = (counter_clockwise(first), counter_clockwise(second)) else {
        return false;
    };
    let parts = |t: &[[f64; 2]; 3], other: &[[f64; 2]; 3]| {
        (0..3).any(|k| other.iter().all(|p| turn(t[k], t[(k + 1) % 3], *p) <= 0))
    };
    !parts(&first, &second) && !parts(&second, &first)
}

/// Leaves out the axis along which a triangle's normal is largest.
fn flattening(triangle: &[Point3; 3]) -> impl Fn(&Point3) -> [f64; 2] + use<> {
    let normal = (triangle[1] - triangle[0]).cross(&(triangle[2] - triangle[0]));
    let axis = normal.iamax();
    move |p: &Point3| [p[(axis + 1) % 3], p[(axis + 2) % 3]]
}
