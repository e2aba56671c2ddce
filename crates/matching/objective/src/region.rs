//! What a picture's contours surround, on its rows; also where the contours are open.
//!
//! Each piece of contour is turned so that the dark side (or the bright one, as the contrast says) is to its left, and the winding number of all pieces
//! together about a pixel is summed: for closed contours a whole number. An open piece adds the share of a full turn that it is seen under, so that
//! several pieces around a body wind by nearly one inside it and nearly none outside, whatever gaps are left (the generalised winding number:
//! A. Jacobson, L. Kavan and O. Sorkine-Hornung, "Robust inside-outside segmentation using generalized winding numbers", 2013). The region is
//! where it is above a half, within the box of the pieces: its border follows the pieces, and crosses gaps about straight.
//!
//! **Not guaranteed:** anything sensible where more than about half of a contour is missing, or pieces of other bodies are among them.

use biplane_artifact::Curves;
use biplane_geometry::{Point2, Vector2};

/// The picture is looked at so finely in gaps, px along a row.
const STEP_PX: f64 = 2.0;

/// What contours surround.
#[derive(Debug, Clone)]
pub struct Region {
    /// Row, from and to, in the order of rows and of x.
    spans: Vec<(u32, [f64; 2])>,
    /// First span of each row, and their number at the end.
    start: Vec<u32>,
    /// Length of its border along the contours, px.
    length_px: f64,
}

/// A piece of contour with its dark side to the left where x is to the right and y up.
struct Piece {
    points: Vec<Point2>,
    closed: bool,
}

impl Piece {
    fn of(curve: &biplane_geometry::Curve, contrast: f64) -> Option<Self> {
        let finite = |p: &&biplane_geometry::EdgePoint| p.position.coords.iter().all(|v| v.is_finite());
        let kept: Vec<_> = curve.points.iter().filter(finite).collect();
        let mut points: Vec<Point2> = kept.iter().map(|p| p.position).collect();
        let right: f64 = kept
            .windows(2)
            .map(|w| {
                let along = w[1].position - w[0].position;
                Vector2::new(along.y, -along.x).dot(&(w[0].direction + w[1].direction)) * contrast
            })
            .sum();
        if right < 0.0 {
            points.reverse();
        }
        (points.len() > 1).then_some(Self { points, closed: curve.closed })
    }

    /// From point to point, the way back from the last to the first included.
    fn sides(&self) -> impl Iterator<Item = (Point2, Point2)> {
        let next = self.points.iter().cycle().skip(1);
        self.points.iter().zip(next).map(|(a, b)| (*a, *b))
    }

    fn length(&self) -> f64 {
        let count = self.points.len() - usize::from(!self.closed);
        self.sides().take(count).map(|(a, b)| (b - a).norm()).sum()
    }

    /// Share of a full turn under which the way back from its last to its first point is seen, which an open piece lacks.
    fn missing(&self, at: &Point2) -> f64 {
        if self.closed {
            return 0.0;
        }
        let ends =
            [self.points.last(), self.points.first()].map(|p| p.map_or_else(Vector2::zeros, |p| p - at));
        ends[0].perp(&ends[1]).atan2(ends[0].dot(&ends[1])) / std::f64::consts::TAU
    }
}

impl Region {
    /// What curves (ideal px) surround on a picture of so many columns and rows; `contrast` is +1 for a body darker than what is beside it. `None`
    /// if they surround nothing.
    pub fn new(curves: &Curves, size: [usize; 2], contrast: f64) -> Option<Self> {
        let pieces: Vec<Piece> = curves.0.iter().filter_map(|c| Piece::of(c, contrast)).collect();
        let rows = size[1];
        let (mut low, mut high) = (Vector2::repeat(f64::INFINITY), Vector2::repeat(f64::NEG_INFINITY));
        for p in pieces.iter().flat_map(|p| &p.points) {
            (low, high) = (low.inf(&p.coords), high.sup(&p.coords));
        }
        // Where sides, and ways back, cross rows: x, and +1 where they go to larger y.
        let mut crossings: Vec<Vec<(f64, i32)>> = vec![Vec::new(); rows];
        for piece in &pieces {
            for (from, to) in piece.sides() {
                let (low, high, sign) = if from.y <= to.y { (from, to, 1) } else { (to, from, -1) };
                let mut row = low.y.ceil().max(0.0);
                while row < high.y && row < rows as f64 {
                    let x = low.x + (row - low.y) * (high.x - low.x) / (high.y - low.y);
                    crossings[row as usize].push((x, sign));
                    row += 1.0;
                }
            }
        }
        let (mut spans, mut start) = (Vec::new(), vec![0]);
        for (row, crossings) in crossings.iter_mut().enumerate() {
            crossings.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
            if (low.y..=high.y).contains(&(row as f64)) {
                let limits = [low.x.max(-0.5), high.x.min(size[0] as f64 - 0.5)];
                spans_of_row(row, crossings, &pieces, limits, &mut spans);
            }
            start.push(spans.len() as u32);
        }
        let length_px: f64 = pieces.iter().map(Piece::length).sum();
        let area: f64 = spans.iter().map(|(_, [from, to])| to - from).sum();
        (area >= 1.0 && length_px > 0.0).then_some(Self { spans, start, length_px })
    }

    /// Row, and from where to where in x, px; in the order of rows and of x.
    pub fn spans(&self) -> &[(u32, [f64; 2])] {
        &self.spans
    }

    /// Length of the contours, px.
    pub fn length_px(&self) -> f64 {
        self.length_px
    }

    /// Whether a pixel is in it, by the nearest row.
    pub fn holds(&self, at: &Point2) -> bool {
        let row = at.y.round();
        if !(row >= 0.0 && row < self.start.len() as f64 - 1.0) {
            return false;
        }
        let row = row as usize;
        let spans = &self.spans[self.start[row] as usize..self.start[row + 1] as usize];
        spans.iter().any(|(_, [from, to])| *from <= at.x && at.x < *to)
    }
}

/// The spans of one row between two limits: between crossings the winding number changes by gaps alone, smoothly.
fn spans_of_row(
    row: usize,
    crossings: &[(f64, i32)],
    pieces: &[Piece],
    limits: [f64; 2],
    spans: &mut Vec<(u32, [f64; 2])>,
) {
    let open = pieces.iter().any(|p| !p.closed);
    // Sides going to larger y to the right of a pixel wind about it once, with x right and y up.
    let mut whole: i32 = crossings.iter().map(|c| c.1).sum();
    let mut begun: Option<f64> = None;
    let mut from = limits[0];
    for (stop, sign) in crossings.iter().copied().chain([(limits[1], 0)]) {
        let to = stop.max(limits[0]).min(limits[1]);
        let steps = if open { ((to - from) / STEP_PX).ceil().max(1.0) as usize } else { 1 };
        let winding = |x: f64| {
            let at = Point2::new(x, row as f64);
            f64::from(whole) - pieces.iter().map(|p| p.missing(&at)).sum::<f64>() - 0.5
        };
        if to > from {
            // Just within the interval, off its ends.
            let place = |k: usize| from + (to - from) * (k as f64 / steps as f64).clamp(1e-6, 1.0 - 1e-6);
            let mut before = winding(place(0));
            enter_or_leave(&mut begun, before > 0.0, from, row, spans);
            for k in 1..=steps {
                let now = winding(place(k));
                if (now > 0.0) != (before > 0.0) {
                    let share = before / (before - now);
                    let x = place(k - 1) + (place(k) - place(k - 1)) * share;
                    enter_or_leave(&mut begun, now > 0.0, x, row, spans);
                }
                before = now;
            }
            from = to;
        }
        whole -= sign;
    }
    enter_or_leave(&mut begun, false, from, row, spans);
}

fn enter_or_leave(
    begun: &mut Option<f64>,
    inside: bool,
    x: f64,
    row: usize,
    spans: &mut Vec<(u32, [f64; 2])>,
) {
    match (*begun, inside) {
        (None, true) => *begun = Some(x),
        (Some(from), false) => {
            if x > from {
                spans.push((row as u32, [from, x]));
            }
            *begun = None;
        }
        _ => {}
    }
}
