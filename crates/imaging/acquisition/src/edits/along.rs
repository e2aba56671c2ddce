//! Points along chains of cubic Bezier curves.

use super::place::{Affine, Pair};

/// Distance of neighbouring points at most, px.
const STEP_PX: f64 = 1.0;
/// Distance of the points' polygon from the curve at most, px.
const TOLERANCE_PX: f64 = 0.01;

/// Cubics, each beginning where the one before ends.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Chain {
    pub(super) start: Pair,
    /// Two handles and the end of each.
    pub(super) cubics: Vec<[Pair; 3]>,
    pub(super) closed: bool,
}

impl Chain {
    pub(super) fn new(start: Pair) -> Self {
        Self { start, cubics: Vec::new(), closed: false }
    }

    /// Where it ends so far.
    pub(super) fn end(&self) -> Pair {
        self.cubics.last().map_or(self.start, |c| c[2])
    }

    pub(super) fn line_to(&mut self, to: Pair) {
        let from = self.end();
        let between = |t: f64| [0, 1].map(|i| from[i] + t * (to[i] - from[i]));
        self.cubics.push([between(1.0 / 3.0), between(2.0 / 3.0), to]);
    }

    /// A line to the start, where it is not there yet.
    pub(super) fn close(&mut self) {
        if self.end() != self.start {
            self.line_to(self.start);
        }
        self.closed = true;
    }

    pub(super) fn mapped(&self, map: &Affine) -> Self {
        Self {
            start: map.apply(self.start),
            cubics: self.cubics.iter().map(|c| c.map(|p| map.apply(p))).collect(),
            closed: self.closed,
        }
    }

    /// Whether both are drawn alike, to `tolerance`.
    pub(super) fn is_like(&self, other: &Self, tolerance: f64) -> bool {
        let near = |a: Pair, b: Pair| distance(a, b) <= tolerance;
        self.closed == other.closed
            && self.cubics.len() == other.cubics.len()
            && near(self.start, other.start)
            && self.cubics.iter().flatten().zip(other.cubics.iter().flatten()).all(|(a, b)| near(*a, *b))
    }

    /// Points along it, the nodes among them; `None` where there would be more than `most`, or where it leaves all numbers.
    pub(super) fn points(&self, most: usize) -> Option<Vec<Pair>> {
        let mut points = vec![self.start];
        if !self.start.iter().all(|v| v.is_finite()) {
            return None;
        }
        let mut from = self.start;
        for [first, second, to] in &self.cubics {
            let parts = parts(from, *first, *second, *to);
            if !parts.is_finite() || parts > most.saturating_sub(points.len()) as f64 {
                return None;
            }
            let count = parts as usize;
            for part in 1..=count {
                let t = part as f64 / count as f64;
                let next = if part == count { *to } else { at(from, *first, *second, *to, t) };
                if points.last() != Some(&next) {
                    points.push(next);
                }
            }
            from = *to;
        }
        if self.closed && points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        Some(points)
    }
}

/// How many equal parts of the parameter keep both bounds: speed is at most three times the longest leg, and a chord leaves
/// the curve by at most an eighth of the second derivative.
fn parts(p: Pair, q: Pair, r: Pair, s: Pair) -> f64 {
    let leg = distance(p, q).max(distance(q, r)).max(distance(r, s));
    let bend = |a: Pair, b: Pair, c: Pair| (a[0] - 2.0 * b[0] + c[0]).hypot(a[1] - 2.0 * b[1] + c[1]);
    let bend = bend(p, q, r).max(bend(q, r, s));
    // A NaN would be lost in a maximum.
    if !(leg + bend).is_finite() {
        return f64::NAN;
    }
    (3.0 * leg / STEP_PX).max((0.75 * bend / TOLERANCE_PX).sqrt()).ceil().max(1.0)
}

fn at(p: Pair, q: Pair, r: Pair, s: Pair, t: f64) -> Pair {
    let u = 1.0 - t;
    [0, 1].map(|i| u * u * u * p[i] + 3.0 * t * u * u * q[i] + 3.0 * t * t * u * r[i] + t * t * t * s[i])
}

pub(super) fn distance(a: Pair, b: Pair) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// A smooth chain through points, whose tangents are those of parabolas through three neighbours; `None` where fewer than two
/// points are apart.
pub(super) fn through(points: &[Pair], closed: bool) -> Option<Chain> {
    let mut points = points.to_vec();
    points.dedup_by(|a, b| distance(*a, *b) < 1e-9);
    if closed
        && points.len() > 2
        && points.first().zip(points.last()).is_some_and(|(a, b)| distance(*a, *b) < 1e-9)
    {
        points.pop();
    }
    let count = points.len();
    let closed = closed && count > 2;
    let start = *points.first().filter(|_| count > 1)?;
    let place = |i: usize, by: isize| {
        let at = i as isize + by;
        if closed {
            points.get(at.rem_euclid(count as isize) as usize)
        } else {
            usize::try_from(at).ok().and_then(|at| points.get(at))
        }
    };
    let tangent = |i: usize| {
        let slope = |a: &Pair, b: &Pair| [0, 1].map(|k| (b[k] - a[k]) / distance(*a, *b));
        match (place(i, -1), place(i, 0), place(i, 1)) {
            (Some(a), Some(b), Some(c)) => {
                let (before, after) = (distance(*a, *b), distance(*b, *c));
                let (left, right) = (slope(a, b), slope(b, c));
                [0, 1].map(|k| (after * left[k] + before * right[k]) / (before + after))
            }
            (Some(a), Some(b), None) | (None, Some(a), Some(b)) => slope(a, b),
            _ => [0.0; 2],
        }
    };
    let mut chain = Chain::new(start);
    chain.closed = closed;
    for i in 0..if closed { count } else { count - 1 } {
        let (Some(a), Some(b)) = (place(i, 0), place(i, 1)) else { continue };
        let third = distance(*a, *b) / 3.0;
        let (leave, arrive) = (tangent(i), tangent((i + 1) % count));
        chain.cubics.push([
            [0, 1].map(|k| a[k] + third * leave[k]),
            [0, 1].map(|k| b[k] - third * arrive[k]),
            *b,
        ]);
    }
    Some(chain)
}
