//! Points made ready to be the knots of a spline: checked, points that coincide merged, with the cumulative chord length as parameter.

use biplane_geometry::{Point2, Vector2};
use thiserror::Error;

/// Largest coordinate or standard deviation: squares and cubes of what is below stay far from overflow.
const LARGEST: f64 = 1e9;

/// Why no spline can be laid through or near points.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PointsError {
    /// Not enough points apart from each other.
    #[error(
        "{found} different points, but {} curve needs {needed}: add points, or leave it out",
        if *closed { "a closed" } else { "an open" }
    )]
    TooFew {
        /// Points that do not coincide with the one before.
        found: usize,
        /// Least number of them.
        needed: usize,
        /// Whether the last point is followed by the first.
        closed: bool,
    },
    /// A coordinate that no point can have.
    #[error(
        "point {index} (from 0) is at ({x}, {y}), but coordinates must be finite and at most 1e9 in size"
    )]
    NotAPlace {
        /// Number of the point, from 0.
        index: usize,
        /// Its coordinates.
        x: f64,
        /// Its coordinates.
        y: f64,
    },
    /// A standard deviation that cannot be one.
    #[error("point {index} (from 0) has the standard deviation {sigma}, but it must be from 0 to 1e9")]
    NotASigma {
        /// Number of the point, from 0.
        index: usize,
        /// Its standard deviation.
        sigma: f64,
    },
    /// As many standard deviations as points are needed.
    #[error("{points} points have {sigmas} standard deviations: give one for each")]
    Count {
        /// Number of points.
        points: usize,
        /// Number of standard deviations.
        sigmas: usize,
    },
    /// The equations have no solution in floating point.
    #[error(
        "the equations of the spline cannot be solved: the distances between points, or their standard deviations, differ too much"
    )]
    Unsolvable,
}

/// Knots of a spline to come.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Knots {
    pub points: Vec<Vector2>,
    /// Variance of each point across the curve, px^2.
    pub variances: Vec<f64>,
    /// From each point to the next; of a closed curve also from the last to the first.
    pub chords: Vec<f64>,
    pub closed: bool,
    /// Number of the knot that each given point became.
    pub knot_of: Vec<usize>,
}

impl Knots {
    /// Checks and merges: points nearer to the one before than `merge` times the mean distance become one, at their weighted mean.
    pub fn new(
        points: &[Point2],
        sigmas: Option<&[f64]>,
        closed: bool,
        merge: f64,
    ) -> Result<Self, PointsError> {
        let is_size = |v: f64| v.is_finite() && v.abs() <= LARGEST;
        if let Some(index) = points.iter().position(|p| !is_size(p.x) || !is_size(p.y)) {
            return Err(PointsError::NotAPlace { index, x: points[index].x, y: points[index].y });
        }
        if let Some(sigmas) = sigmas {
            if sigmas.len() != points.len() {
                return Err(PointsError::Count { points: points.len(), sigmas: sigmas.len() });
            }
            if let Some(index) = sigmas.iter().position(|s| !is_size(*s) || *s < 0.0) {
                return Err(PointsError::NotASigma { index, sigma: sigmas[index] });
            }
        }
        let length: f64 = points.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
        // The least normal distance keeps the reciprocals of chords finite.
        let least = (merge * length / points.len().max(1) as f64).max(1e-100);
        let variance = |i: usize| sigmas.map_or(0.0, |s| s[i] * s[i]);
        let mut knots = Self {
            points: Vec::with_capacity(points.len()),
            variances: Vec::with_capacity(points.len()),
            chords: Vec::with_capacity(points.len()),
            closed,
            knot_of: Vec::with_capacity(points.len()),
        };
        for (i, p) in points.iter().map(|p| &p.coords).enumerate() {
            match knots.points.last() {
                Some(before) if (p - before).norm() <= least => {
                    let last = knots.points.len() - 1;
                    knots.absorb(last, p, variance(i));
                }
                _ => {
                    knots.points.push(*p);
                    knots.variances.push(variance(i));
                }
            }
            knots.knot_of.push(knots.points.len() - 1);
        }
        if closed {
            knots.join_ends(least);
        }
        let found = knots.points.len();
        let needed = if closed { 3 } else { 2 };
        if found < needed {
            return Err(PointsError::TooFew { found, needed, closed });
        }
        knots.chords.extend(knots.points.windows(2).map(|w| (w[1] - w[0]).norm()));
        if closed {
            knots.chords.push((knots.points[0] - knots.points[found - 1]).norm());
        }
        // A merged point may have moved onto its neighbour.
        if knots.chords.iter().any(|c| *c <= 0.0) {
            return Err(PointsError::Unsolvable);
        }
        Ok(knots)
    }

    /// Makes one of a knot and a point at the same place.
    fn absorb(&mut self, knot: usize, point: &Vector2, variance: f64) {
        let (v, both) = (self.variances[knot], self.variances[knot] + variance);
        if both > 0.0 {
            let here = self.points[knot];
            self.points[knot] = here + (point - here) * (v / both);
            self.variances[knot] = v * (variance / both);
        }
    }

    /// Makes one of the first and the last knots of a closed curve while they coincide.
    fn join_ends(&mut self, least: f64) {
        while let (Some(last), true) = (self.points.last().copied(), self.points.len() > 1) {
            if (last - self.points[0]).norm() > least {
                return;
            }
            let variance = self.variances.pop().unwrap_or_default();
            self.points.pop();
            self.absorb(0, &last, variance);
            let gone = self.points.len();
            for knot in self.knot_of.iter_mut().rev().take_while(|k| **k == gone) {
                *knot = 0;
            }
        }
    }
}
