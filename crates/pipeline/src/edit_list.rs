//! `biplane edits`: the files of `edits/`, whether they are used, and how far they moved the outlines.

use biplane_artifact::{Curves, EditedContour, EditedPiece};
use biplane_geometry::{Curve, Point2};
use biplane_stage::{Context, Store, StoreError};

use crate::calibrate::Calibrated;
use crate::edits::Drawn;
use crate::prepare::{InputErrors, Job, Prepared};
use crate::slices;
use crate::steps::{ItemError, Steps, read_stored};
use crate::study::Study;
use crate::summary::aligned;

/// A drawn point farther from every automatic curve has no automatic edge, px.
const NO_EDGE_PX: f64 = 3.0;

/// Why there is no list.
#[derive(Debug, thiserror::Error)]
pub enum EditListError {
    /// Inputs that everything hangs on are wrong.
    #[error(transparent)]
    Inputs(#[from] InputErrors),
    /// The store cannot be used.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// The list as text, and whether every file can be used or is known not to be an edit.
///
/// # Errors
/// See [`EditListError`].
pub fn list(study: Study) -> Result<(String, bool), EditListError> {
    let prepared = Prepared::of(study)?;
    let store = Store::open(&prepared.study.hidden())?;
    let context = Context::new();
    let calibrated = Calibrated::default();
    let steps =
        Steps { prepared: &prepared, calibrated: &calibrated, models: &[], store: &store, context: &context };
    let (mut rows, mut faults) = (Vec::new(), Vec::new());
    for job in &prepared.jobs {
        for slot in
            (0..job.pictures.len()).filter(|slot| job.edits.get(*slot).is_some_and(|files| !files.is_empty()))
        {
            match steps.drawn(job, slot) {
                Ok(None) => {}
                Ok(Some(drawn)) => rows.extend(rows_of(&steps, job, slot, &drawn)),
                Err(ItemError::Failed(message)) => faults.push(message),
                Err(error @ ItemError::Cancelled) => faults.push(error.to_string()),
            }
        }
    }
    let (of_slices, unusable) = slices::list::list(&prepared, &store, &context);
    rows.extend(of_slices);
    faults.extend(unusable);
    let strays = prepared
        .stray_edits
        .iter()
        .map(|(path, why)| format!("{} is not used: {why}", prepared.study.relative(path)));
    let strays: Vec<String> = strays.collect();
    if let Err(error) = prepared.index.save(false) {
        tracing::debug!("the index of inputs was not written: {error}");
    }
    let mut text = String::new();
    if rows.is_empty() && faults.is_empty() && strays.is_empty() {
        text += "no edited contours: `biplane edit TRIAL FRAME VIEW` writes a drawing into edits/\n";
    } else if !rows.is_empty() {
        let header = ["file", "body", "used", "median px", "largest px", "no edge px", ""];
        text += &aligned(&header, rows.into_iter(), &[3, 4, 5]);
        text += "\nmedian, largest: how far what was drawn is from the nearest automatic edge; no edge: how much of it is farther than 3 px \
                 from any.\n";
    }
    for (title, list) in [("Cannot be used", &faults), ("Not used", &strays)] {
        if !list.is_empty() {
            text += &format!("\n{title} ({}):\n  {}\n", list.len(), list.join("\n  "));
        }
    }
    Ok((text, faults.is_empty() && strays.is_empty()))
}

fn rows_of(steps: &Steps<'_>, job: &Job, slot: usize, drawn: &Drawn) -> Vec<Vec<String>> {
    let study = &steps.prepared.study;
    let curves =
        steps.explain_segment(job, slot).ok().and_then(|(_, stored)| read_stored(steps.store, &stored?).ok());
    let row = |body: &crate::edits::DrawnBody| {
        let moved =
            curves.as_ref().filter(|_| body.touched).and_then(|curves| Moved::of(&body.contour, curves));
        let number =
            |n: fn(&Moved) -> f64| moved.as_ref().map_or_else(|| "-".to_owned(), |m| format!("{:.2}", n(m)));
        let remark = match (body.touched, body.contour.pieces.is_empty()) {
            (false, _) => "not edited yet: it is as it was written",
            (true, true) => "nothing of it is trusted in this picture",
            (true, false) if drawn.picture_changed => "the picture has changed since",
            (true, false) if curves.is_none() => "`biplane run` finds how far it moved",
            (true, false) => "",
        };
        vec![
            drawn.file.clone(),
            study.bodies[job.bodies[body.place].0].name.clone(),
            if body.touched { "yes" } else { "no" }.to_owned(),
            number(|m| m.median),
            number(|m| m.largest),
            number(|m| m.without),
            remark.to_owned(),
        ]
    };
    if drawn.bodies.is_empty() {
        let dash = || "-".to_owned();
        return vec![vec![
            drawn.file.clone(),
            dash(),
            "no".to_owned(),
            dash(),
            dash(),
            dash(),
            "it has no layer of a body".to_owned(),
        ]];
    }
    drawn.bodies.iter().map(row).collect()
}

/// How far an edit is from the automatic curves, px.
struct Moved {
    median: f64,
    largest: f64,
    without: f64,
}

impl Moved {
    fn of(edit: &EditedContour, curves: &Curves) -> Option<Self> {
        let mut without = 0.0;
        let mut far = Vec::new();
        for EditedPiece { points, .. } in &edit.pieces {
            for (i, [x, y]) in points.iter().enumerate() {
                let at = Point2::new(*x, *y);
                let distance =
                    curves.0.iter().map(|curve| to_curve(&at, curve)).fold(f64::INFINITY, f64::min);
                if distance > NO_EDGE_PX {
                    let next = points.get(i + 1).map_or(0.0, |[a, b]| (a - x).hypot(b - y));
                    without += next;
                }
                far.push(distance);
            }
        }
        far.sort_by(f64::total_cmp);
        Some(Self { median: *far.get(far.len() / 2)?, largest: *far.last()?, without })
    }
}

/// From a place to the polygon of a curve, px.
fn to_curve(at: &Point2, curve: &Curve) -> f64 {
    let points = &curve.points;
    let seam = points.last().zip(points.first()).filter(|_| curve.closed);
    let sides = points.windows(2).map(|w| (&w[0], &w[1])).chain(seam);
    let to_side = |(a, b): (&biplane_geometry::EdgePoint, &biplane_geometry::EdgePoint)| {
        let along = b.position - a.position;
        let share = (at - a.position).dot(&along) / along.norm_squared();
        let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
        (a.position + share * along - at).norm()
    };
    sides.map(to_side).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_geometry::{EdgePoint, Vector2};

    #[test]
    fn what_was_drawn_is_measured_against_the_nearest_edge() {
        let point = |x: f64| EdgePoint {
            position: Point2::new(x, 0.0),
            direction: Vector2::y(),
            strength: 1.0,
            sigma_px: 0.1,
        };
        let curves = Curves(vec![Curve { points: vec![point(0.0), point(10.0)], closed: false }]);
        let points = (0..=20).map(|i| [f64::from(i), 0.5]).collect();
        let edit = EditedContour { pieces: vec![EditedPiece { name: "a".into(), points, closed: false }] };
        let moved = Moved::of(&edit, &curves).unwrap();
        // Eleven of 21 points are above the edge; those from x = 13 on are more than 3 px away: 7 px of the line.
        assert_eq!(moved.median, 0.5);
        assert!((moved.largest - 10.0_f64.hypot(0.5)).abs() < 1e-12);
        assert_eq!(moved.without, 7.0);
        assert!(Moved::of(&EditedContour { pieces: vec![] }, &curves).is_none());
    }
}
