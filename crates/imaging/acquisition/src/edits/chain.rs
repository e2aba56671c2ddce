//! Chains of cubic Bezier curves: what paths, shapes and splines become before they are points.

use biplane_geometry::Point2;
use biplane_spline::{Bezier, FlattenError, flatten};

use super::place::{Affine, Pair};

/// Distance of neighbouring points at most, px.
const STEP_PX: f64 = 1.0;
/// Distance of the points' polygon from the curve at most, px.
const TOLERANCE_PX: f64 = 0.01;
/// What the end of a closed path may be off its start, in its own units: programs write eight digits, and add up relative steps.
const ROUNDING: f64 = 1e-4;

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

    /// Of curves of which each starts where the one before ends; `None` of none.
    pub(super) fn of(curves: &[Bezier], closed: bool) -> Option<Self> {
        let pair = |p: &Point2| [p.x, p.y];
        let start = pair(&curves.first()?[0]);
        Some(Self { start, cubics: curves.iter().map(|[_, a, b, c]| [a, b, c].map(pair)).collect(), closed })
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

    /// A line to the start, where it is not there yet but for rounding.
    pub(super) fn close(&mut self) {
        let start = self.start;
        match self.cubics.last_mut() {
            Some(last) if distance(last[2], start) <= ROUNDING => last[2] = start,
            _ => self.line_to(start),
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

    /// Points along it, the nodes among them.
    pub(super) fn points(&self) -> Result<Vec<Pair>, FlattenError> {
        let starts = std::iter::once(self.start).chain(self.cubics.iter().map(|c| c[2]));
        let curves: Vec<Bezier> = starts
            .zip(&self.cubics)
            .map(|(start, [a, b, c])| [start, *a, *b, *c].map(Point2::from))
            .collect();
        let points = flatten(&curves, STEP_PX, TOLERANCE_PX, self.closed)?;
        Ok(points.into_iter().map(|p| [p.x, p.y]).collect())
    }
}

pub(super) fn distance(a: Pair, b: Pair) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
