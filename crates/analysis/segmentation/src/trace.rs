//! The stage `edit`: what a person drew for one body's outline in one frame becomes curves that matching can use.
//!
//! Each drawn point takes direction, strength and standard deviation from the automatic edge it lies on, if it lies on one: a piece
//! that was left as it was is as exact as before. Elsewhere the frame's smoothed gradient across the drawn line says which side is
//! bright, averaged along it, and the standard deviation is that of a hand. **Guaranteed:** no drawn point is moved or left out, but
//! of a piece of a single point. **Not guaranteed:** the bright side where the picture shows no edge at all.

use biplane_artifact::{Curves, EditedContour, Frame};
use biplane_geometry::{Curve, EdgePoint, Point2, Vector2};
use biplane_grey::Grey;
use biplane_stage::{Context, Stage, inputs};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

inputs! {
    /// A frame and what a person drew in it for one body.
    pub struct TraceInputs {
        /// The frame.
        frame: Frame,
        /// Its automatic curves.
        curves: Curves,
        /// What was drawn.
        edit: EditedContour,
    }
}

/// How drawn contours are taken.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TraceParams {
    /// How well a hand places a line, px (1 sigma).
    #[schemars(range(min = 0.01, max = 10.0))]
    pub hand_sigma_px: f64,
    /// A drawn point this near to an automatic edge is that edge, px.
    #[schemars(range(min = 0.0, max = 5.0))]
    pub same_px: f64,
}

impl Default for TraceParams {
    fn default() -> Self {
        Self { hand_sigma_px: 0.5, same_px: 0.15 }
    }
}

/// Why a drawn contour gives no curves.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TraceError {
    /// A parameter out of range.
    #[error("[edit] {name} = {value}, expected {expected}")]
    Parameter {
        /// The key in pipeline.toml.
        name: &'static str,
        /// What it is.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
}

impl TraceParams {
    /// # Errors
    /// Names the first parameter that is out of its range.
    pub fn check(&self) -> Result<(), TraceError> {
        let bad = |name, value, expected| Err(TraceError::Parameter { name, value, expected });
        if !(0.01..=10.0).contains(&self.hand_sigma_px) {
            return bad("hand_sigma_px", self.hand_sigma_px, "0.01 to 10 px");
        }
        if !(0.0..=5.0).contains(&self.same_px) {
            return bad("same_px", self.same_px, "0 to 5 px");
        }
        Ok(())
    }
}

/// The stage `edit`.
#[derive(Debug, Clone, Copy)]
pub struct Trace;

impl Stage for Trace {
    const NAME: &'static str = "edit";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = TraceInputs;
    type Params = TraceParams;
    type Output = Curves;
    type Error = TraceError;

    fn run(inputs: &TraceInputs, params: &TraceParams, _: &Context) -> Result<Curves, TraceError> {
        params.check()?;
        Ok(traced(&inputs.frame, &inputs.curves, &inputs.edit, params))
    }
}

/// Smoothing of the frame whose gradient tells the bright side, px.
const SMOOTHING_PX: f64 = 2.0;
/// Points to each side over which the bright side is decided.
const AROUND: usize = 15;
/// Cosine between a drawn line and an automatic edge that are the same: 30 degrees.
const SAME_COURSE: f64 = 0.866;

/// The curves of what was drawn.
pub fn traced(frame: &Frame, automatic: &Curves, edit: &EditedContour, params: &TraceParams) -> Curves {
    let smooth = Grey::of(frame).smoothed(SMOOTHING_PX);
    let near = Near::new(automatic, params.same_px);
    let mut curves = Vec::new();
    for piece in &edit.pieces {
        let places: Vec<Point2> = piece.points.iter().map(|p| Point2::from(*p)).collect();
        let normals = normals(&places, piece.closed);
        if normals.is_empty() {
            continue;
        }
        let slopes: Vec<f64> =
            places.iter().zip(&normals).map(|(p, n)| slope_across(&smooth, p, n)).collect();
        let points = places.iter().zip(&normals).enumerate().map(|(i, (&position, normal))| {
            if let Some(edge) = near.on(&position, normal) {
                return EdgePoint { position, ..*edge };
            }
            let around = &slopes[i.saturating_sub(AROUND)..(i + AROUND + 1).min(slopes.len())];
            let bright = if around.iter().sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
            EdgePoint {
                position,
                direction: bright * normal,
                strength: slopes[i].abs(),
                sigma_px: params.hand_sigma_px,
            }
        });
        curves.push(Curve { points: points.collect(), closed: piece.closed });
    }
    Curves::rounded(curves)
}

/// Unit normals of a drawn line at its points, from the points on both sides of each; none where all points are one.
fn normals(places: &[Point2], closed: bool) -> Vec<Vector2> {
    let n = places.len();
    if n < 2 {
        return Vec::new();
    }
    let mut last = None;
    let mut found: Vec<Option<Vector2>> = (0..n)
        .map(|i| {
            let (before, after) = if closed {
                ((i + n - 1) % n, (i + 1) % n)
            } else {
                (i.saturating_sub(1), (i + 1).min(n - 1))
            };
            let along = (places[after] - places[before]).try_normalize(1e-9);
            last = along.or(last);
            last.map(|t| Vector2::new(-t.y, t.x))
        })
        .collect();
    // Points before the first course take it too.
    let Some(first) = found.iter().flatten().next().copied() else { return Vec::new() };
    found.iter_mut().map_while(|f| Some(f.take().unwrap_or(first))).collect()
}

/// Rise of the picture along `normal`, grey levels per px.
fn slope_across(smooth: &Grey, p: &Point2, normal: &Vector2) -> f64 {
    let at = |s: f64| smooth.at(p.x + s * normal.x, p.y + s * normal.y);
    (at(1.0) - at(-1.0)) / 2.0
}

/// Automatic edge points by pixel.
struct Near<'a> {
    cells: Vec<((i64, i64), &'a EdgePoint)>,
    reach: f64,
}

impl<'a> Near<'a> {
    fn new(curves: &'a Curves, reach: f64) -> Self {
        let points = curves.0.iter().flat_map(|c| &c.points);
        let mut cells: Vec<_> = points.map(|p| (cell(&p.position), p)).collect();
        cells.sort_by_key(|c| c.0);
        Self { cells, reach }
    }

    /// The automatic edge that a drawn line lies on here: the nearest point within a pixel and a half whose own line passes
    /// within reach.
    fn on(&self, at: &Point2, normal: &Vector2) -> Option<&'a EdgePoint> {
        let (row, column) = cell(at);
        let mut best = None;
        let mut least = 1.5;
        for j in row - 2..=row + 2 {
            let from = self.cells.partition_point(|c| c.0 < (j, column - 2));
            for (place, edge) in &self.cells[from..] {
                if *place > (j, column + 2) {
                    break;
                }
                let apart = at - edge.position;
                let same = edge.direction.dot(normal).abs() >= SAME_COURSE
                    && edge.direction.dot(&apart).abs() <= self.reach;
                if same && apart.norm() < least {
                    least = apart.norm();
                    best = Some(*edge);
                }
            }
        }
        best
    }
}

fn cell(p: &Point2) -> (i64, i64) {
    (p.y.floor() as i64, p.x.floor() as i64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{SegmentParams, curves};
    use biplane_artifact::EditedPiece;

    /// Dark above row 20, bright below.
    fn frame() -> Frame {
        let samples = (0..64 * 48).map(|k| if k / 64 < 20 { 50 } else { 180 }).collect();
        Frame { width: 64, height: 48, samples, bits: 8 }
    }

    fn drawn(y: f64, backwards: bool) -> EditedContour {
        let mut points: Vec<[f64; 2]> = (10..50).map(|x| [f64::from(x), y]).collect();
        if backwards {
            points.reverse();
        }
        EditedContour { pieces: vec![EditedPiece { name: "p".to_owned(), points, closed: false }] }
    }

    #[test]
    fn what_lies_on_an_edge_is_that_edge_and_the_rest_is_a_hands() {
        let frame = frame();
        let automatic = curves(&frame, None, &SegmentParams::default()).unwrap();
        for backwards in [false, true] {
            for (y, sigma) in [(19.52, automatic.0[0].points[20].sigma_px), (23.0, 0.5)] {
                let edit = drawn(y, backwards);
                let found = traced(&frame, &automatic, &edit, &TraceParams::default());
                assert_eq!(found.0.len(), 1);
                for (p, drawn) in found.0[0].points.iter().zip(&edit.pieces[0].points) {
                    assert!((p.position - Point2::from(*drawn)).norm() < 1e-5, "no point is moved");
                    assert!((p.direction - Vector2::new(0.0, 1.0)).norm() < 0.02, "dark to bright");
                    assert!((p.sigma_px - sigma).abs() < 1e-6, "{} at {y}", p.sigma_px);
                }
            }
        }
    }

    #[test]
    fn pieces_without_a_course_are_left_out() {
        let piece = |points: Vec<[f64; 2]>, closed| EditedPiece { name: String::new(), points, closed };
        let edit = EditedContour {
            pieces: vec![
                piece(vec![], false),
                piece(vec![[3.0, 4.0]], true),
                piece(vec![[3.0, 4.0]; 5], true),
                piece(vec![[-500.0, 4.0], [-500.0, 4.0], [-400.0, 1e9]], false),
            ],
        };
        let found = traced(&frame(), &Curves::default(), &edit, &TraceParams::default());
        assert_eq!(found.0.len(), 1, "the last one has a course, if far from the picture");
        assert!(found.0[0].points.iter().all(|p| p.direction.norm() > 0.99));
    }
}
