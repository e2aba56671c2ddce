//! The closest point of several trusted pieces (thesis Eq. 3.4), to rounding and over all of them.
//!
//! Boxes in a tree lead to the cubics that can hold it; within a cubic all minima are looked at. A query needs no memory. Where several
//! points are equally near, the same one of them is given on every run.

use biplane_geometry::{Point2, Vector2};

use crate::cubic::Cubic;
use crate::{Piece, Spline};

/// Cubics of a leaf of the tree.
const LEAF: usize = 8;
/// Deeper than any tree whose nodes a `u32` counts.
const DEEPEST: usize = 32;

/// The point of a curve that is closest to a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foot {
    /// Number of the piece, from 0.
    pub piece: usize,
    /// Parameter of the piece's spline, px; of a closed spline within its period.
    pub t: f64,
    /// The point itself, px.
    pub point: Point2,
    /// Its distance from the place, px.
    pub distance: f64,
}

/// A cubic, or a part of one.
#[derive(Debug, Clone, Copy)]
struct Arc {
    cubic: Cubic,
    piece: usize,
    /// Parameter at its start.
    from: f64,
    /// Parameters from its start to its end.
    length: f64,
}

/// The straight line below an arc.
#[derive(Debug, Clone, Copy)]
struct Chord {
    from: Point2,
    along: Vector2,
    /// `along` by its square, so that a product gives the share of the way; zero for a chord without length.
    share: Vector2,
    /// No point of the arc is farther from the chord, px.
    bulge: f64,
}

/// A box around arcs.
#[derive(Debug, Clone, Copy)]
struct Node {
    low: Point2,
    high: Point2,
    /// First arc of a leaf; or the second child of another, whose first child comes right after it.
    link: u32,
    /// Number of arcs of a leaf, 0 of others.
    arcs: u32,
}

impl Chord {
    fn of(cubic: &Cubic) -> Self {
        let (from, to) = (Point2::from(cubic.at(0.0)), Point2::from(cubic.at(1.0)));
        let along = to - from;
        let square = along.norm_squared();
        // A chord that is shorter than rounding is a point.
        let share = if square > 1e-200 { along / square } else { Vector2::zeros() };
        // A little more than the bound, for rounding.
        let bulge = cubic.bulge() + 1e-12 * (from.coords.amax() + square.sqrt());
        Self { from, along, share, bulge }
    }

    fn distance(&self, place: &Point2) -> f64 {
        let off = place - self.from;
        (off - self.along * off.dot(&self.share).clamp(0.0, 1.0)).norm()
    }
}

impl Node {
    fn distance_squared(&self, place: &Point2) -> f64 {
        let x = (self.low.x - place.x).max(place.x - self.high.x).max(0.0);
        let y = (self.low.y - place.y).max(place.y - self.high.y).max(0.0);
        x * x + y * y
    }
}

/// Finds the closest point of pieces, within their trusted parts.
#[derive(Debug, Clone)]
pub struct FootFinder {
    arcs: Vec<Arc>,
    chords: Vec<Chord>,
    nodes: Vec<Node>,
}

/// What a search has found so far.
#[derive(Debug, Clone, Copy)]
struct Best {
    distance: f64,
    /// There is a point at most this far, px, if one is to be found at all.
    bound: f64,
    arc: usize,
    s: f64,
}

impl FootFinder {
    /// For pieces, within their trusted parts. Time and memory grow with the number of their cubics.
    pub fn new(pieces: &[Piece]) -> Self {
        let arcs = pieces.iter().enumerate().flat_map(|(number, piece)| {
            piece.stretches().map(move |(index, from, to)| {
                let (cubic, begin, length) = piece.spline().cubic(index);
                let whole = from <= 0.0 && to >= 1.0;
                let cubic = if whole { *cubic } else { cubic.between(from, to) };
                Arc { cubic, piece: number, from: begin + from * length, length: (to - from) * length }
            })
        });
        Self::of_arcs(arcs.collect())
    }

    /// For all of one spline.
    pub fn of(spline: &Spline) -> Self {
        let arc = |index| {
            let (cubic, from, length) = spline.cubic(index);
            Arc { cubic: *cubic, piece: 0, from, length }
        };
        Self::of_arcs((0..spline.cubic_count()).map(arc).collect())
    }

    /// For a chain of cubics; `t` counts them.
    pub(crate) fn of_cubics(cubics: &[Cubic]) -> Self {
        let arc = |(k, cubic): (usize, &Cubic)| Arc { cubic: *cubic, piece: 0, from: k as f64, length: 1.0 };
        Self::of_arcs(cubics.iter().enumerate().map(arc).collect())
    }

    fn of_arcs(arcs: Vec<Arc>) -> Self {
        let chords: Vec<Chord> = arcs.iter().map(|a| Chord::of(&a.cubic)).collect();
        let mut finder = Self { nodes: Vec::with_capacity(arcs.len()), arcs, chords };
        if !finder.arcs.is_empty() {
            finder.build(0, finder.arcs.len());
        }
        finder
    }

    /// Adds the tree of some arcs, its root first.
    fn build(&mut self, from: usize, to: usize) -> usize {
        let here = self.nodes.len();
        let node = Node {
            low: Point2::new(f64::INFINITY, f64::INFINITY),
            high: Point2::new(f64::NEG_INFINITY, f64::NEG_INFINITY),
            link: from as u32,
            arcs: (to - from) as u32,
        };
        self.nodes.push(node);
        if to - from <= LEAF {
            for chord in &self.chords[from..to] {
                let node = &mut self.nodes[here];
                let margin = Vector2::repeat(chord.bulge);
                let ends = [chord.from, chord.from + chord.along];
                node.low = node.low.inf(&(ends[0].inf(&ends[1]) - margin));
                node.high = node.high.sup(&(ends[0].sup(&ends[1]) + margin));
            }
            return here;
        }
        let middle = from + (to - from).div_ceil(2);
        let first = self.build(from, middle);
        let second = self.build(middle, to);
        let (low, high) = (
            self.nodes[first].low.inf(&self.nodes[second].low),
            self.nodes[first].high.sup(&self.nodes[second].high),
        );
        self.nodes[here] = Node { low, high, link: second as u32, arcs: 0 };
        here
    }

    /// The closest point; `None` if there are no pieces, or the place is not finite.
    pub fn closest(&self, place: &Point2) -> Option<Foot> {
        self.closest_within(place, f64::INFINITY)
    }

    /// The closest point if it is nearer than `reach`, px: the quicker the smaller that is.
    pub fn closest_within(&self, place: &Point2, reach: f64) -> Option<Foot> {
        self.search(place, Best { distance: reach, bound: reach, arc: usize::MAX, s: 0.0 })
    }

    fn search(&self, place: &Point2, mut best: Best) -> Option<Foot> {
        if !(place.x.is_finite() && place.y.is_finite()) {
            return None;
        }
        let mut stack = [(0_u32, 0.0); DEEPEST];
        let mut height = usize::from(!self.nodes.is_empty());
        while height > 0 {
            height -= 1;
            let (mut at, square) = stack[height];
            if square > best.bound * best.bound {
                continue;
            }
            loop {
                let node = &self.nodes[at as usize];
                if node.arcs > 0 {
                    let from = node.link as usize;
                    self.look(from, from + node.arcs as usize, place, &mut best);
                    break;
                }
                let (first, second) = (at + 1, node.link);
                let one = self.nodes[first as usize].distance_squared(place);
                let two = self.nodes[second as usize].distance_squared(place);
                let (near, far) =
                    if two < one { ((second, two), (first, one)) } else { ((first, one), (second, two)) };
                let most = best.bound * best.bound;
                if far.1 <= most && height < DEEPEST {
                    stack[height] = far;
                    height += 1;
                }
                if near.1 > most {
                    break;
                }
                at = near.0;
            }
        }
        let arc = self.arcs.get(best.arc)?;
        Some(Foot {
            piece: arc.piece,
            t: arc.from + best.s * arc.length,
            point: Point2::from(arc.cubic.at(best.s)),
            distance: best.distance,
        })
    }

    /// Looks for a nearer point on the arcs of a leaf, first at their chords: few arcs are left then.
    fn look(&self, from: usize, to: usize, place: &Point2, best: &mut Best) {
        let mut distances = [0.0; LEAF];
        for (chord, distance) in self.chords[from..to].iter().zip(&mut distances) {
            *distance = chord.distance(place);
            best.bound = best.bound.min(*distance + chord.bulge);
        }
        for (arc, distance) in (from..to).zip(distances) {
            if distance - self.chords[arc].bulge <= best.bound {
                let (s, square) = self.arcs[arc].cubic.nearest(place);
                let distance = square.sqrt();
                if distance < best.distance {
                    *best = Best { distance, bound: best.bound.min(distance), arc, s };
                }
            }
        }
    }
}
