//! The part of a piece that is to be trusted: between its two marks, and within the picture.

use biplane_artifact::EditedPiece;

use super::chain::distance;
use super::place::Pair;

/// Pieces shorter than this, px, are slips of the hand: a click without a drag.
const SHORTEST_PX: f64 = 2.0;

/// Points in order, and whether the last is followed by the first.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Line {
    pub(super) points: Vec<Pair>,
    pub(super) closed: bool,
}

impl Line {
    /// How far a place is from it, and the closest point: number of the side, how far along it (0 to 1), and where.
    pub(super) fn closest(&self, to: Pair) -> Option<(f64, Spot)> {
        let next = self.points.iter().cycle().skip(1);
        let sides = if self.closed { self.points.len() } else { self.points.len().saturating_sub(1) };
        let spots = self.points.iter().zip(next).take(sides).enumerate().map(|(side, (a, b))| {
            let along = [b[0] - a[0], b[1] - a[1]];
            let square = along[0] * along[0] + along[1] * along[1];
            let share = ((to[0] - a[0]) * along[0] + (to[1] - a[1]) * along[1]) / square;
            let share = if square > 0.0 { share.clamp(0.0, 1.0) } else { 0.0 };
            let at = [a[0] + share * along[0], a[1] + share * along[1]];
            (distance(at, to), Spot { side, share, at })
        });
        spots.min_by(|(a, _), (b, _)| a.total_cmp(b))
    }

    /// From `from` to `to`, each the end where it is missing. On an open line in either order; on a closed one forward from the
    /// first to the second, and all of it where either is missing.
    pub(super) fn between(self, from: Option<Spot>, to: Option<Spot>) -> Self {
        let last = self.points.len().saturating_sub(1);
        let (from, to) = match (from, to) {
            (None, None) => return self,
            (Some(from), Some(to)) => (from, to),
            _ if self.closed => return self,
            (from, to) => {
                let end = |side: usize, share: f64, at: usize| {
                    self.points.get(at).map(|p| Spot { side, share, at: *p })
                };
                match (from.or_else(|| end(0, 0.0, 0)), to.or_else(|| end(last, 0.0, last))) {
                    (Some(from), Some(to)) => (from, to),
                    _ => return self,
                }
            }
        };
        let behind = (to.side, to.share) < (from.side, from.share);
        let (from, to) = if behind && !self.closed { (to, from) } else { (from, to) };
        let count = self.points.len();
        let sides = if behind && self.closed { to.side + count - from.side } else { to.side - from.side };
        let mut points = vec![from.at];
        points.extend((1..=sides).filter_map(|i| self.points.get((from.side + i) % count)).copied());
        points.push(to.at);
        points.dedup_by(|a, b| distance(*a, *b) < 1e-9);
        Self { points, closed: false }
    }

    /// The stretches of it that are in a picture of this size, to its outer edge.
    pub(super) fn within(self, size: [usize; 2]) -> Vec<Self> {
        let inside = |p: &Pair| [0, 1].iter().all(|&i| p[i] >= -0.5 && p[i] <= size[i] as f64 - 0.5);
        let Some(outside) = self.points.iter().position(|p| !inside(p)) else { return vec![self] };
        let mut points = self.points;
        if self.closed {
            // Begun outside, no stretch runs through the seam.
            points.rotate_left(outside);
        }
        let runs = points.split(|p| !inside(p)).filter(|run| !run.is_empty());
        runs.map(|run| Self { points: run.to_vec(), closed: false }).collect()
    }

    fn length(&self) -> f64 {
        let open = self.points.windows(2).map(|w| distance(w[0], w[1])).sum::<f64>();
        match (self.closed, self.points.first(), self.points.last()) {
            (true, Some(first), Some(last)) => open + distance(*first, *last),
            _ => open,
        }
    }

    /// As an artifact, unless it is a slip of the hand.
    pub(super) fn piece(self, name: &str) -> Option<EditedPiece> {
        let long = self.points.len() > 1 && self.length() >= SHORTEST_PX;
        long.then(|| EditedPiece { name: name.to_owned(), points: self.points, closed: self.closed })
    }
}

/// A place on a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spot {
    side: usize,
    share: f64,
    at: Pair,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(closed: bool) -> Line {
        let points = if closed {
            vec![[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]
        } else {
            vec![[0.0, 0.0], [4.0, 0.0], [8.0, 0.0]]
        };
        Line { points, closed }
    }

    fn spot(closed: bool, at: Pair) -> Option<Spot> {
        line(closed).closest(at).map(|(_, spot)| spot)
    }

    #[test]
    fn the_part_between_two_marks_in_either_order() {
        let expected = vec![[1.0, 0.0], [4.0, 0.0], [6.0, 0.0]];
        let (from, to) = (spot(false, [1.0, 3.0]), spot(false, [6.0, -1.0]));
        assert_eq!(line(false).between(from, to).points, expected);
        assert_eq!(line(false).between(to, from).points, expected);
        assert_eq!(line(false).between(to, None).points, [[6.0, 0.0], [8.0, 0.0]]);
        assert_eq!(line(false).between(None, from).points, [[0.0, 0.0], [1.0, 0.0]]);
        assert_eq!(line(false).between(from, spot(false, [3.0, 0.0])).points, [[1.0, 0.0], [3.0, 0.0]]);
    }

    #[test]
    fn on_a_closed_line_forward_through_the_seam() {
        let (from, to) = (spot(true, [2.0, -1.0]), spot(true, [5.0, 3.0]));
        assert_eq!(line(true).between(from, to).points, [[2.0, 0.0], [4.0, 0.0], [4.0, 3.0]]);
        let round = line(true).between(to, from);
        assert_eq!(round.points, [[4.0, 3.0], [4.0, 4.0], [0.0, 4.0], [0.0, 0.0], [2.0, 0.0]]);
        assert!(!round.closed);
    }

    #[test]
    fn a_picture_cuts_a_line_into_stretches() {
        let parts = line(true).within([3, 10]);
        assert_eq!(parts, [Line { points: vec![[0.0, 4.0], [0.0, 0.0]], closed: false }]);
        assert_eq!(line(true).within([9, 9]), [line(true)]);
        assert!(line(false).within([3, 10]).into_iter().all(|stretch| stretch.piece("a dot").is_none()));
    }
}
