//! A cubic spline of the plane: made through points, and evaluated.
//!
//! It is twice continuously differentiable. A closed one is periodic, over its seam too. An open one is *natural*: its second derivative
//! is zero at both ends. That is the limit of the smoothing spline for points without noise, so both kinds of fit meet, and it needs no
//! third point; a not-a-knot end would follow a curved end better (for points a pixel apart on a curve of 20 px radius a natural end is off
//! by less than 0.003 px, in the last two or three pixels alone), but takes up the noise of the last four points.

use biplane_geometry::{Point2, Vector2};

use crate::band::{Band, Factors};
use crate::cubic::Cubic;
use crate::knots::{Knots, PointsError};

/// Points nearer than this share of the mean distance count as one where the curve goes through them.
const SAME: f64 = 1e-9;

/// A cubic spline of the plane, its parameter `t` the cumulative chord length of the points it was made from, px, from 0.
///
/// Of a closed one `t` goes round: every number is taken modulo [`Spline::end`]. Of an open one `t` is held between its ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Spline {
    /// Parameters where one cubic ends and the next begins, the first 0, the last the end.
    knots: Vec<f64>,
    cubics: Vec<Cubic>,
    closed: bool,
    parameters: Vec<f64>,
}

impl Spline {
    /// Through the points. Neighbours that coincide (within 1e-9 of the mean distance) count as one.
    ///
    /// # Errors
    /// If a coordinate is not finite, or fewer than 2 points (3 of a closed curve) differ.
    pub fn through(points: &[Point2], closed: bool) -> Result<Self, PointsError> {
        Self::through_knots(&Knots::new(points, None, closed, SAME)?)
    }

    /// Through the points of knots.
    pub(crate) fn through_knots(knots: &Knots) -> Result<Self, PointsError> {
        let roughness = Roughness::of(knots);
        let mut factors = Factors::new();
        factors.factorise(&roughness.energy, 0.0, &roughness.energy).ok_or(PointsError::Unsolvable)?;
        let mut bends = Vec::new();
        roughness.differences(&knots.points, &mut bends);
        factors.solve(&mut bends);
        Ok(Self::assemble(knots, &knots.points, &roughness.all(&bends)))
    }

    /// From values and second derivatives at the knots.
    pub(crate) fn assemble(knots: &Knots, points: &[Vector2], bends: &[Vector2]) -> Self {
        let count = points.len();
        let mut at = vec![0.0];
        let mut t = 0.0;
        let cubic = |i: usize| {
            let h = knots.chords[i];
            let j = (i + 1) % count;
            let (from, to) = (bends[i] * (h * h), bends[j] * (h * h));
            Cubic([
                points[i],
                (points[j] - points[i]) - (from * 2.0 + to) / 6.0,
                from / 2.0,
                (to - from) / 6.0,
            ])
        };
        let cubics = (0..knots.chords.len()).map(cubic).collect();
        at.extend(knots.chords.iter().map(|h| {
            t += h;
            t
        }));
        let parameters = knots.knot_of.iter().map(|k| at[*k]).collect();
        Self { knots: at, cubics, closed: knots.closed, parameters }
    }

    /// Whether its end is its beginning.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Parameter of its end, px: the sum of the chords. Of a closed one it is the period.
    pub fn end(&self) -> f64 {
        self.knots[self.knots.len() - 1]
    }

    /// Parameter of each point that it was made from, in their order; points that were merged have the same one.
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// Number of its cubics.
    pub fn cubic_count(&self) -> usize {
        self.cubics.len()
    }

    /// `t` within the domain.
    pub(crate) fn wrapped(&self, t: f64) -> f64 {
        let end = self.end();
        if !self.closed {
            return t.clamp(0.0, end);
        }
        let t = t.rem_euclid(end);
        // The remainder of a tiny negative number rounds to the period itself.
        if t < end { t } else { 0.0 }
    }

    /// The cubic that a parameter within the domain lies in.
    pub(crate) fn cubic_at(&self, t: f64) -> usize {
        self.knots.partition_point(|k| *k <= t).clamp(1, self.cubics.len()) - 1
    }

    /// A cubic, where it begins and how long it is.
    pub(crate) fn cubic(&self, index: usize) -> (&Cubic, f64, f64) {
        let from = self.knots[index];
        (&self.cubics[index], from, self.knots[index + 1] - from)
    }

    fn locate(&self, t: f64) -> (&Cubic, f64, f64) {
        // What is not a number is as good as the start.
        let t = if t.is_finite() { self.wrapped(t) } else { 0.0 };
        let (cubic, from, length) = self.cubic(self.cubic_at(t));
        (cubic, (t - from) / length, length)
    }

    /// The point at `t`, px.
    pub fn point(&self, t: f64) -> Point2 {
        let (cubic, s, _) = self.locate(t);
        Point2::from(cubic.at(s))
    }

    /// First derivative by `t`: along the curve, its size about 1.
    pub fn derivative(&self, t: f64) -> Vector2 {
        let (cubic, s, length) = self.locate(t);
        cubic.slope(s) / length
    }

    /// Second derivative by `t`, 1/px.
    pub fn second_derivative(&self, t: f64) -> Vector2 {
        let (cubic, s, length) = self.locate(t);
        cubic.bend(s) / (length * length)
    }

    /// Unit normal: the direction of travel turned by a quarter from x towards y (in a picture: to the right hand of who travels). `None`
    /// where the curve stands still.
    pub fn normal(&self, t: f64) -> Option<Vector2> {
        let along = self.derivative(t).try_normalize(0.0)?;
        Some(Vector2::new(-along.y, along.x))
    }

    /// Curvature, 1/px: positive where it turns from x towards y, to the side of the normal. `None` where the curve stands still.
    pub fn curvature(&self, t: f64) -> Option<f64> {
        let (v, a) = (self.derivative(t), self.second_derivative(t));
        let speed = v.norm();
        (speed > 0.0).then(|| v.perp(&a) / speed.powi(3))
    }
}

/// What the bending of a spline costs: `R` and `Q` of C. H. Reinsch (Smoothing by spline functions, 1967). The unknowns are the second
/// derivatives at the knots; of an open spline those of both ends are zero and no unknowns.
#[derive(Debug)]
pub(crate) struct Roughness<'a> {
    knots: &'a Knots,
    /// Reciprocals of the chords.
    steepness: Vec<f64>,
    /// `R`: the integral of the square of the second derivative.
    pub energy: Band,
}

impl<'a> Roughness<'a> {
    pub fn of(knots: &'a Knots) -> Self {
        let unknowns = if knots.closed { knots.points.len() } else { knots.points.len() - 2 };
        let steepness = knots.chords.iter().map(|h| 1.0 / h).collect();
        let mut roughness = Self { knots, steepness, energy: Band::zeros(unknowns, knots.closed) };
        let count = knots.points.len();
        for (k, h) in knots.chords.iter().enumerate() {
            let (i, j) = (roughness.unknown(k), roughness.unknown((k + 1) % count));
            for at in [i, j].into_iter().flatten() {
                roughness.energy.add(at, at, h / 3.0);
            }
            if let (Some(i), Some(j)) = (i, j) {
                roughness.energy.add(i, j, h / 6.0);
            }
        }
        roughness
    }

    /// Number of the unknown of a knot.
    fn unknown(&self, knot: usize) -> Option<usize> {
        if self.knots.closed {
            return Some(knot);
        }
        knot.checked_sub(1).filter(|k| k + 2 < self.knots.points.len())
    }

    /// Row `knot` of `Q`: the unknowns whose differences the knot's value is part of, and by what factor.
    pub fn row(&self, knot: usize) -> [(Option<usize>, f64); 3] {
        let count = self.knots.points.len();
        let before = if knot > 0 { Some(knot - 1) } else { self.knots.closed.then_some(count - 1) };
        let after = (self.knots.closed || knot + 1 < count).then_some((knot + 1) % count);
        let left = before.map_or(0.0, |b| self.steepness[b]);
        let right = after.map_or(0.0, |_| self.steepness[knot]);
        [
            (before.and_then(|b| self.unknown(b)), left),
            (self.unknown(knot), -(left + right)),
            (after.and_then(|a| self.unknown(a)), right),
        ]
    }

    /// `Q' y`: differences of the slopes of the chords at the knots that are unknowns.
    pub fn differences(&self, y: &[Vector2], into: &mut Vec<[f64; 2]>) {
        let count = y.len();
        let slope = |k: usize| (y[(k + 1) % count] - y[k]) * self.steepness[k];
        let first = usize::from(!self.knots.closed);
        let mut before = if self.knots.closed { slope(count - 1) } else { slope(0) };
        let one = |k: usize| {
            let after = slope(k);
            let difference = after - before;
            before = after;
            [difference.x, difference.y]
        };
        into.clear();
        into.extend((first..count - first).map(one));
    }

    /// Second derivatives at all knots.
    pub fn all(&self, unknowns: &[[f64; 2]]) -> Vec<Vector2> {
        let inner = unknowns.iter().map(|u| Vector2::new(u[0], u[1]));
        let end = (!self.knots.closed).then(Vector2::zeros);
        end.into_iter().chain(inner).chain(end).collect()
    }
}
