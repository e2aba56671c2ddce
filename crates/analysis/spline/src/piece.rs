//! The part of a spline that can be trusted.

use thiserror::Error;

use crate::Spline;

/// A spline with its trusted part, from `t0` to `t1` (thesis 2.2.2: "starting and ending values ... to determine the valid limits").
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    spline: Spline,
    from: f64,
    to: f64,
}

/// Why there is no such part.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PieceError {
    /// The limits are not within the spline, or the wrong way round.
    #[error(
        "the trusted part runs from {from} to {to}, but this {} spline has parameters from 0 to {end}: {}",
        if *closed { "closed" } else { "open" },
        if *closed { "start within them and go at most once round" } else { "give two of them, the smaller first" }
    )]
    Outside {
        /// Given start.
        from: f64,
        /// Given end.
        to: f64,
        /// Largest parameter of the spline.
        end: f64,
        /// Whether it is periodic.
        closed: bool,
    },
    /// The spline was not made from that many points.
    #[error(
        "the trusted part is to run from point {first} to point {last} (from 0), but the spline has {count} points"
    )]
    NoSuchPoint {
        /// Its first point.
        first: usize,
        /// Its last point.
        last: usize,
        /// Points that the spline was made from.
        count: usize,
    },
}

impl Piece {
    /// All of a spline; of a closed one, once round.
    pub fn whole(spline: Spline) -> Self {
        let to = spline.end();
        Self { spline, from: 0.0, to }
    }

    /// From parameter `from` to `to`, px. Of a closed spline `to` may lie before `from`, or beyond the period: the part then runs through
    /// the seam.
    ///
    /// # Errors
    /// If there is no such part.
    pub fn new(spline: Spline, from: f64, to: f64) -> Result<Self, PieceError> {
        let (end, closed) = (spline.end(), spline.is_closed());
        let through_seam = closed && to < from && to >= 0.0;
        let last = if through_seam { to + end } else { to };
        let within = (0.0..=end).contains(&from) && last >= from;
        let short = if closed { last <= from + end } else { last <= end };
        if within && short {
            Ok(Self { spline, from, to: last })
        } else {
            Err(PieceError::Outside { from, to, end, closed })
        }
    }

    /// From the first to the last of some of the points that the spline was made from, counted from 0. Of a closed spline the last may lie
    /// before the first: the part then runs through the seam.
    ///
    /// # Errors
    /// If there is no such part.
    pub fn between_points(spline: Spline, first: usize, last: usize) -> Result<Self, PieceError> {
        let parameters = spline.parameters();
        let (Some(from), Some(to)) = (parameters.get(first).copied(), parameters.get(last).copied()) else {
            return Err(PieceError::NoSuchPoint { first, last, count: parameters.len() });
        };
        Self::new(spline, from, to)
    }

    /// The spline.
    pub fn spline(&self) -> &Spline {
        &self.spline
    }

    /// Where the trusted part begins and ends, px; of a closed spline the end may lie beyond the period.
    pub fn trusted(&self) -> [f64; 2] {
        [self.from, self.to]
    }

    /// Whether the trusted part is a loop.
    pub fn is_loop(&self) -> bool {
        self.spline.is_closed() && self.to - self.from >= self.spline.end()
    }

    /// The cubics of the trusted part in order: number, and the share of it from and to (0 to 1). At least one.
    pub(crate) fn stretches(&self) -> impl Iterator<Item = (usize, f64, f64)> {
        let (spline, end) = (&self.spline, self.spline.end());
        let count = spline.cubic_count();
        let first = spline.cubic_at(self.from.min(end));
        // A loop comes back to the cubic that it began in.
        (first..=first + count).map_while(move |k| {
            let (_, begin, length) = spline.cubic(k % count);
            let begin = begin + if k >= count { end } else { 0.0 };
            let (from, to) = ((self.from - begin) / length, (self.to - begin) / length);
            let open = spline.is_closed() || k < count;
            (open && (k == first || to > 0.0)).then_some((
                k % count,
                from.clamp(0.0, 1.0),
                to.clamp(0.0, 1.0),
            ))
        })
    }
}
