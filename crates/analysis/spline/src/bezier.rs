//! Splines as chains of cubic Bezier curves, which drawing programs edit, and such chains as points.

use biplane_geometry::Point2;
use nalgebra::{Matrix2, Vector2};
use thiserror::Error;

use crate::cubic::Cubic;
use crate::{FootFinder, Piece};

/// Four control points; the curve starts at the first and ends at the last one.
pub type Bezier = [Point2; 4];

/// Most points that a chain becomes: a curve of a thousand pictures' width.
const MOST_POINTS: usize = 1_000_000;
/// Steps of the fit of one curve.
const STEPS: usize = 4;
/// Least and largest number of places where the distance of one curve is taken, one a px between them.
const PLACES: [f64; 2] = [16.0, 1000.0];
/// Least and largest length of a handle, in lengths of the curve.
const HANDLE: [f64; 2] = [0.03, 1.0];

/// A chain of Bezier curves along a piece.
#[derive(Debug, Clone, PartialEq)]
pub struct BezierFit {
    /// In order; each starts where the one before ends. Of a loop the last one ends where the first starts.
    pub curves: Vec<Bezier>,
    /// Largest distance of the chain from the spline that was found, at places about a pixel apart, px.
    pub error: f64,
}

/// Why a chain does not become points.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FlattenError {
    /// A coordinate that no point can have.
    #[error(
        "curve {index} (from 0) has a control point at ({x}, {y}), but coordinates must be finite and at most 1e9 in size"
    )]
    NotAPlace {
        /// Number of the curve.
        index: usize,
        /// Coordinates of the point.
        x: f64,
        /// Coordinates of the point.
        y: f64,
    },
    /// A limit that cannot be kept.
    #[error("points at most {step} px apart within {tolerance} px: both must be above 0")]
    Limits {
        /// Given distance of points.
        step: f64,
        /// Given tolerance.
        tolerance: f64,
    },
    /// More points than anything real has.
    #[error(
        "curve {index} (from 0) brings the chain to more than {most} points at most {step} px apart: is it drawn in the right unit?"
    )]
    TooLong {
        /// Number of the curve.
        index: usize,
        /// Most points.
        most: usize,
        /// Given distance of points.
        step: f64,
    },
}

impl Piece {
    /// The trusted part as it is: a Bezier curve for every cubic, exact.
    pub fn beziers(&self) -> Vec<Bezier> {
        self.stretches()
            .filter(|(_, from, to)| to > from)
            .map(|(index, from, to)| self.spline().cubic(index).0.between(from, to).controls())
            .collect()
    }

    /// The trusted part as few Bezier curves, for editing: each at most `longest` px long and, between nodes on the spline with its
    /// direction, within `tolerance` px of it. Where a long one is too far off it is halved, down to single cubics, which are exact.
    pub fn fewer_beziers(&self, longest: f64, tolerance: f64) -> BezierFit {
        let arcs: Vec<Cubic> = self
            .stretches()
            .filter(|(_, from, to)| to > from)
            .map(|(index, from, to)| self.spline().cubic(index).0.between(from, to))
            .collect();
        let mut lengths = vec![0.0];
        lengths.extend(arcs.iter().scan(0.0, |sum, a| {
            *sum += a.length(0.0, 1.0);
            Some(*sum)
        }));
        let mut fit = BezierFit { curves: Vec::new(), error: 0.0 };
        fit.add(&arcs, &lengths, longest, tolerance);
        fit
    }
}

impl BezierFit {
    /// Adds curves along some arcs, whose lengths up to each end are given.
    fn add(&mut self, arcs: &[Cubic], lengths: &[f64], longest: f64, tolerance: f64) {
        match arcs {
            [] => return,
            [one] => return self.curves.push(one.controls()),
            _ => {}
        }
        let length = lengths[arcs.len()] - lengths[0];
        let parts = (length / longest).ceil();
        if parts <= 1.0
            && let Some((curve, error)) = one_for(arcs, length, tolerance)
        {
            self.curves.push(curve);
            self.error = self.error.max(error);
            return;
        }
        // Half of the parts to either side, so that all become about as long.
        let share = if parts > 1.0 && parts.is_finite() { (0.5 * parts).floor() / parts } else { 0.5 };
        let wanted = lengths[0] + share * length;
        let cut = lengths.partition_point(|l| *l < wanted).clamp(1, arcs.len() - 1);
        self.add(&arcs[..cut], &lengths[..=cut], longest, tolerance);
        self.add(&arcs[cut..], &lengths[cut..], longest, tolerance);
    }
}

/// One curve along arcs of some length, and its largest distance from them; `None` where it is not within the tolerance.
///
/// Its ends and their directions are those of the arcs; the lengths of both handles make the squared distances least (Gauss-Newton, the
/// feet found anew at each step).
fn one_for(arcs: &[Cubic], length: f64, tolerance: f64) -> Option<(Bezier, f64)> {
    let (first, last) = (arcs.first()?, arcs.last()?);
    let (start, end) = (Point2::from(first.at(0.0)), Point2::from(last.at(1.0)));
    let (out, back) = (first.slope(0.0).try_normalize(0.0)?, -last.slope(1.0).try_normalize(0.0)?);
    let finder = FootFinder::of_cubics(arcs);
    let places = length.clamp(PLACES[0], PLACES[1]).ceil();
    let mut handles = Vector2::repeat(length / 3.0);
    for step in 0.. {
        let curve = [start, start + out * handles[0], end + back * handles[1], end];
        let cubic = Cubic::from_controls(&curve);
        let (mut normal, mut right, mut error) =
            (Matrix2::identity() * (1e-6 * places), Vector2::zeros(), 0.0_f64);
        for k in 1..places as u32 {
            let s = f64::from(k) / places;
            let at = Point2::from(cubic.at(s));
            let foot = finder.closest(&at)?;
            error = error.max(foot.distance);
            let Some(along) = cubic.slope(s).try_normalize(0.0) else { continue };
            let weights = [3.0 * (1.0 - s).powi(2) * s, 3.0 * (1.0 - s) * s * s];
            let row = Vector2::new(along.perp(&out) * weights[0], along.perp(&back) * weights[1]);
            normal += row * row.transpose();
            right += row * along.perp(&(at - foot.point));
        }
        if error <= 0.5 * tolerance || step == STEPS {
            return (error <= tolerance).then_some((curve, error));
        }
        handles -= normal.try_inverse()? * right;
        if !handles.iter().all(|h| (HANDLE[0] * length..HANDLE[1] * length).contains(h)) {
            return None;
        }
    }
    None
}

/// The points of a chain of curves: at most `step` px apart along it, and their straight lines within `tolerance` px of it. The ends of
/// every curve are among them; an end that is the next one's start is there once, and of a closed chain so is the start of the first.
///
/// # Errors
/// If a coordinate is not finite, a limit not above 0, or the chain too long for the step.
pub fn flatten(
    curves: &[Bezier],
    step: f64,
    tolerance: f64,
    closed: bool,
) -> Result<Vec<Point2>, FlattenError> {
    // Not a number is not above 0 either.
    if !(step > 0.0 && tolerance > 0.0) {
        return Err(FlattenError::Limits { step, tolerance });
    }
    let mut points: Vec<Point2> = Vec::new();
    for (index, curve) in curves.iter().enumerate() {
        if let Some(p) = curve.iter().find(|p| !p.iter().all(|v| v.is_finite() && v.abs() <= 1e9)) {
            return Err(FlattenError::NotAPlace { index, x: p.x, y: p.y });
        }
        let cubic = Cubic::from_controls(curve);
        // The speed is at most that of the fastest of its own control points.
        let speed = curve.windows(2).map(|w| 3.0 * (w[1] - w[0]).norm()).fold(0.0, f64::max);
        // `n` parts have an `n^2`-th of the bulge.
        let parts = (speed / step).max((cubic.bulge() / tolerance).sqrt()).ceil().max(1.0);
        if points.len() as f64 + parts > MOST_POINTS as f64 {
            return Err(FlattenError::TooLong { index, most: MOST_POINTS, step });
        }
        if points.last() != Some(&curve[0]) {
            points.push(curve[0]);
        }
        points.extend((1..parts as u32).map(|k| Point2::from(cubic.at(f64::from(k) / parts))));
        if speed > 0.0 {
            points.push(curve[3]);
        }
    }
    if closed && points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    Ok(points)
}
