//! From the starts to an answer like that of any other method.

use biplane_artifact::{Curves, Match, Verdict};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Curve, EdgePoint, Point3, Pose};
use biplane_outline::{Outline, RimMesh, Sampling};

use super::{BinghamView, best, descend, spread};
use crate::answer::{Searched, answer, starts_tried};
use crate::{EdgeField, MatchError, MatchParams, View, assess, judge};

/// Least cosine between the outline's normal and the direction of an edge of the body's own contour: 45 degrees.
const OWN_COSINE: f64 = 0.71;

/// The part of a frame's curves that may be the contour of a body at `start`: what has an outline point within
/// [`MatchParams::search_px`] whose normal runs as the edge does, by the body's contrast. In recorded pixels, as the curves.
///
/// The thesis has a person choose it.
pub fn own_contour(
    curves: &Curves,
    mesh: &RimMesh,
    fluoroscope: &Fluoroscope,
    start: &Pose,
    params: &MatchParams,
) -> Curves {
    let search = params.search();
    let mut outline = Outline::new();
    outline.trace(mesh, start, fluoroscope, Sampling { step_px: 2.0 });
    let points = outline.points().iter().map(|p| EdgePoint {
        position: p.pixel,
        direction: p.normal * search.contrast,
        strength: 0.0,
        sigma_px: 0.0,
    });
    let outline = EdgeField::new(&Curves(vec![Curve { points: points.collect(), closed: false }]), None);
    let mut own = Vec::new();
    for curve in &curves.0 {
        let ideal = fluoroscope.distortion().map(|d| d.correct(curve));
        let ideal = ideal.as_ref().unwrap_or(curve);
        let kept: Vec<bool> = ideal
            .points
            .iter()
            .map(|p| outline.nearest(&p.position, &p.direction, search.search_px, OWN_COSINE).is_some())
            .collect();
        if kept.iter().all(|k| *k) {
            own.push(curve.clone());
            continue;
        }
        let mut from = 0;
        for run in kept.chunk_by(|a, b| a == b) {
            let to = from + run.len();
            if run[0] {
                own.push(Curve { points: curve.points[from..to].to_vec(), closed: false });
            }
            from = to;
        }
    }
    Curves(own)
}

/// Matches one body as the thesis does. `points` are those of its model (mm) and `contours` what is to be met, one a view in
/// the order of `views`; `mesh` and `views` serve to judge the pose found, as they do for the other methods.
///
/// # Errors
/// Only [`MatchError::Cancelled`], when `cancelled` says so between two starts.
pub fn match_bingham(
    points: &[Point3],
    contours: &[BinghamView],
    mesh: &RimMesh,
    (views, names): (&[View], &[String]),
    start: &Pose,
    params: &MatchParams,
    cancelled: impl Fn() -> bool,
) -> Result<Match, MatchError> {
    let (own, origin) = (&params.bingham2006, mesh.centroid());
    let mut descents = Vec::with_capacity(own.starts);
    for from in own.starts(start, origin) {
        if cancelled() {
            return Err(MatchError::Cancelled);
        }
        descents.push(descend(points, origin, contours, &from, own));
    }
    let Some(best) = best(&descents) else { return Err(MatchError::Cancelled) };
    let assessed = assess(mesh, views, &best.pose, &params.search());
    let (fits, mut verdict, mut reason) = judge(&assessed, names, &params.limits());
    let mut find = |what: String| {
        verdict = verdict.max(Verdict::Doubtful);
        reason = if reason.is_empty() { what } else { format!("{reason}; {what}") };
    };
    if !best.converged {
        find(format!("did not converge: {} calls from each of {} starts", own.calls, descents.len()));
    }
    if let Some(spread) = spread(&descents) {
        let sigma = |from: usize| spread[from..from + 3].iter().map(|v| v * v).sum::<f64>().sqrt();
        if sigma(0) > params.good_sigma_mm || sigma(3) > params.good_sigma_deg {
            let converged = descents.iter().filter(|d| d.converged).count();
            find(format!(
                "{converged} of {} starts converged, {:.2} mm and {:.2} deg apart (1 sigma)",
                descents.len(),
                sigma(0),
                sigma(3)
            ));
        }
    }
    let calls: usize = descents.iter().map(|d| d.calls).sum();
    let rested: Vec<Pose> = descents.iter().filter(|d| d.converged).map(|d| d.pose).collect();
    let searched = Searched {
        objective: best.objective,
        iterations: u32::try_from(calls).unwrap_or(u32::MAX),
        starts: starts_tried(descents.len(), &rested, origin),
        alternative: None,
    };
    Ok(answer(&assessed, (fits, verdict, reason), searched))
}
