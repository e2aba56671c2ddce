//! Sides of a slice's contours that cross each other, and which parts of the contours bound the bone then.
//!
//! Sides are binned in squares and tried against those they share a square with. Only proper crossings count: contours may touch
//! and share points. Inside is where the winding number of all contours together is not zero; between two crossings a contour
//! bounds the bone all along or not at all.

use crate::stack::Contour;

/// A straight part of a contour, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Side {
    pub from: [f64; 2],
    pub to: [f64; 2],
    /// Place of its contour in the slice's list.
    pub contour: u32,
}

/// Two sides that cross.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Crossing {
    /// Numbers of the sides in the list, the smaller first.
    pub sides: [usize; 2],
    /// How far along each, 0 to 1.
    pub at: [f64; 2],
}

/// Largest number of squares along an axis.
const MOST_SQUARES: f64 = 512.0;

/// The sides of all contours, one contour after the other.
pub(crate) fn sides(contours: &[Contour]) -> Vec<Side> {
    let of = |(n, contour): (usize, &Contour)| {
        let points = contour.points.clone();
        let count = points.len();
        (0..count).map(move |k| Side { from: points[k], to: points[(k + 1) % count], contour: n as u32 })
    };
    contours.iter().enumerate().flat_map(of).collect()
}

/// All pairs of sides that cross, ascending.
pub(crate) fn crossings(sides: &[Side]) -> Vec<Crossing> {
    let (mut low, mut high, mut length) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2], 0.0);
    for side in sides {
        for p in [side.from, side.to] {
            for a in 0..2 {
                low[a] = low[a].min(p[a]);
                high[a] = high[a].max(p[a]);
            }
        }
        length += (side.to[0] - side.from[0]).hypot(side.to[1] - side.from[1]);
    }
    let extent = (high[0] - low[0]).max(high[1] - low[1]);
    let square = (1.5 * length / sides.len().max(1) as f64).max(extent / MOST_SQUARES).max(f64::MIN_POSITIVE);
    let wide = ((high[0] - low[0]) / square) as usize + 1;
    let tall = ((high[1] - low[1]) / square) as usize + 1;
    let place = |v: f64, a: usize| ((v - low[a]) / square) as usize;
    let squares_of = |side: &Side| {
        let range = |a: usize, most: usize| {
            let (p, q) = (place(side.from[a], a), place(side.to[a], a));
            p.min(q)..=p.max(q).min(most - 1)
        };
        let (columns, rows) = (range(0, wide), range(1, tall));
        rows.flat_map(move |j| columns.clone().map(move |i| j * wide + i))
    };
    // Sides by squares: counted, then filled.
    let mut start = vec![0_u32; wide * tall + 1];
    for side in sides {
        for s in squares_of(side) {
            start[s + 1] += 1;
        }
    }
    for s in 1..start.len() {
        start[s] += start[s - 1];
    }
    let mut next = start.clone();
    let mut held = vec![0_u32; start.last().map_or(0, |n| *n as usize)];
    for (n, side) in sides.iter().enumerate() {
        for s in squares_of(side) {
            held[next[s] as usize] = n as u32;
            next[s] += 1;
        }
    }
    let mut found = Vec::new();
    for w in start.windows(2) {
        let in_square = &held[w[0] as usize..w[1] as usize];
        for (n, &a) in in_square.iter().enumerate() {
            for &b in &in_square[n + 1..] {
                if let Some(at) = meet(&sides[a as usize], &sides[b as usize]) {
                    found.push(Crossing { sides: [a as usize, b as usize], at });
                }
            }
        }
    }
    found.sort_by_key(|c| c.sides);
    found.dedup_by_key(|c| c.sides);
    found
}

/// Where two sides cross properly.
#[inline]
fn meet(a: &Side, b: &Side) -> Option<[f64; 2]> {
    let apart = (0..2).any(|k| {
        a.from[k].max(a.to[k]) < b.from[k].min(b.to[k]) || b.from[k].max(b.to[k]) < a.from[k].min(a.to[k])
    });
    if apart {
        return None;
    }
    let cross =
        |o: [f64; 2], p: [f64; 2], q: [f64; 2]| (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]);
    let (b_from, b_to) = (cross(a.from, a.to, b.from), cross(a.from, a.to, b.to));
    if b_from * b_to >= 0.0 {
        return None;
    }
    let (a_from, a_to) = (cross(b.from, b.to, a.from), cross(b.from, b.to, a.to));
    (a_from * a_to < 0.0).then(|| [a_from / (a_from - a_to), b_from / (b_from - b_to)])
}

/// Winding number of all sides together about a place.
pub(crate) fn winding(sides: &[Side], [x, y]: [f64; 2]) -> i32 {
    sides.iter().map(|s| turn(s.from, s.to, x, y)).sum()
}

/// What a side adds to the winding number: +1 where it passes upwards on the right of the place.
#[inline]
pub(crate) fn turn(p: [f64; 2], q: [f64; 2], x: f64, y: f64) -> i32 {
    if (p[1] <= y) == (q[1] <= y) {
        return 0;
    }
    let at = p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0]);
    if at <= x {
        0
    } else if q[1] > p[1] {
        1
    } else {
        -1
    }
}

/// The parts of the sides that part inside from outside.
pub(crate) fn bounding(sides: &[Side], crossings: &[Crossing]) -> Vec<Side> {
    // Cuts of each side, ascending along it.
    let mut cuts: Vec<(usize, f64)> =
        crossings.iter().flat_map(|c| [0, 1].map(|k| (c.sides[k], c.at[k]))).collect();
    cuts.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut kept = Vec::with_capacity(sides.len());
    let mut next_cut = 0;
    // Whether the stretch since the last cut, or since the contour began, bounds; none where that is not known yet.
    let mut bounds: Option<bool> = None;
    let mut contour = u32::MAX;
    for (n, side) in sides.iter().enumerate() {
        if side.contour != contour {
            contour = side.contour;
            bounds = None;
        }
        let mut from = 0.0;
        loop {
            let to = match cuts.get(next_cut) {
                Some(&(of, at)) if of == n => at,
                _ => 1.0,
            };
            let on = |t: f64| [0, 1].map(|a| side.from[a] + (side.to[a] - side.from[a]) * t);
            let part = Side { from: on(from), to: on(to), contour };
            let bounding = *bounds.get_or_insert_with(|| parts_inside_from_outside(sides, &part));
            if bounding && to > from {
                kept.push(part);
            }
            if to == 1.0 && !matches!(cuts.get(next_cut), Some(&(of, _)) if of == n) {
                break;
            }
            next_cut += 1;
            from = to;
            bounds = None;
        }
    }
    kept
}

fn parts_inside_from_outside(sides: &[Side], part: &Side) -> bool {
    let (dx, dy) = (part.to[0] - part.from[0], part.to[1] - part.from[1]);
    let middle = [(part.from[0] + part.to[0]) / 2.0, (part.from[1] + part.to[1]) / 2.0];
    // Far enough off the side to be told from it, near enough to meet nothing else.
    let off = 1e-4;
    let left = winding(sides, [middle[0] - off * dy, middle[1] + off * dx]);
    let right = winding(sides, [middle[0] + off * dy, middle[1] - off * dx]);
    (left == 0) != (right == 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contour(points: &[[f64; 2]]) -> Vec<Side> {
        let count = points.len();
        (0..count).map(|k| Side { from: points[k], to: points[(k + 1) % count], contour: 0 }).collect()
    }

    #[test]
    fn a_figure_eight_crosses_once_and_a_square_never() {
        let square = contour(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]);
        assert!(crossings(&square).is_empty());
        assert_eq!(bounding(&square, &[]), square);
        let eight = contour(&[[0.0, 0.0], [4.0, 4.0], [4.0, 0.0], [0.0, 4.0]]);
        let found = crossings(&eight);
        assert_eq!(found, [Crossing { sides: [0, 2], at: [0.5, 0.5] }]);
        // Both lobes are inside; all of it bounds, in six parts.
        assert_eq!(bounding(&eight, &found).len(), 6);
    }

    #[test]
    fn of_overlapping_squares_the_hull_is_kept() {
        let mut sides = contour(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]);
        let other = contour(&[[2.0, 2.0], [6.0, 2.0], [6.0, 6.0], [2.0, 6.0]]);
        sides.extend(other.into_iter().map(|s| Side { contour: 1, ..s }));
        let kept = bounding(&sides, &crossings(&sides));
        let length: f64 = kept.iter().map(|s| (s.to[0] - s.from[0]).hypot(s.to[1] - s.from[1])).sum();
        assert_eq!(length, 32.0 - 8.0);
        assert_eq!(winding(&sides, [3.0, 3.0]), 2);
    }
}
