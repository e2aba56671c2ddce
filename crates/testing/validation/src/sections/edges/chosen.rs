//! Edges that the stage `contour` takes for a body's, held against the body's true outline.

use biplane_artifact::{Contour, Curves, Match, ModelMesh};
use biplane_contour::{ContourInputs, ContourOf, ContourParams};
use biplane_geometry::{EdgePoint, Point3, Pose};
use biplane_optimisation::{MatchParams, match_body};
use biplane_phantom::{Body, IntensifierDistortion, Solid, ideal_outline};
use biplane_stage::{Context, Hashed, Stage};
use rayon::prelude::*;

use crate::knee::Posture;
use crate::pictures::{Equipment, Knee, Recorded};
use crate::sections::SectionError;
use crate::sections::end_to_end::equipment;
use crate::true_outline::TrueOutline;
use crate::{Cell, Column, Distribution, Lab, Row, STARTS, SceneError, StartOffset, Table};

/// Points of the models.
const POINTS: usize = 15_000;
/// A chosen edge that lies farther from the body's true outline, after the inset of them all, is wrong, px.
const WRONG_PX: f64 = 1.5;
/// How far from an outline an edge is looked for, px: beyond the reach of the choice.
const REACH_PX: f64 = 12.0;
/// Distance of the points of true outlines, px.
const STEP_PX: f64 = 0.5;
/// How far off a displaced pose is, mm and degrees.
const DISPLACED: f64 = 0.5;
/// At which pose edges are chosen.
const POSES: [&str; 3] = ["at the true pose", "where the match ended", "0.5 mm and 0.5° off"];

/// A solid of another size.
struct Scaled(&'static dyn Solid, f64);

impl Solid for Scaled {
    fn value(&self, point: &Point3) -> f64 {
        self.1 * self.0.value(&(point / self.1))
    }

    fn bounds(&self) -> (Point3, Point3) {
        let (low, high) = self.0.bounds();
        (low * self.1, high * self.1)
    }
}

/// What one contour came to, px of length.
#[derive(Debug, Clone, Copy, Default)]
struct Judged {
    chosen: f64,
    wrong: f64,
    /// Of the wrong ones, those on another body's outline.
    anothers: f64,
    outline: f64,
    found: f64,
    unclear: f64,
    flagged: bool,
}

/// Holds a contour against the outlines of all bodies of its picture; `own` is the place of its body's.
fn held(
    contour: &Contour,
    curves: &Curves,
    distortion: Option<&IntensifierDistortion>,
    outlines: &[TrueOutline],
    own: usize,
) -> Judged {
    // Ideal pixel, and the length that the point stands for.
    let mut points = Vec::new();
    for piece in &contour.pieces {
        let all = &curves.0[piece.curve].points;
        let count = if piece.last >= piece.first {
            piece.last - piece.first + 1
        } else {
            piece.last + all.len() - piece.first + 1
        };
        let at = |k: usize| &all[(piece.first + k) % all.len()];
        let ideal = |p: &EdgePoint| distortion.map_or(p.position, |d| d.ideal(&p.position));
        points.extend((1..count).map(|k| (ideal(at(k)), (at(k).position - at(k - 1).position).norm())));
    }
    let mut insets: Vec<f64> =
        points.iter().filter_map(|(p, _)| outlines[own].outside_px(p, REACH_PX)).collect();
    insets.sort_by(f64::total_cmp);
    let inset = insets.get(insets.len() / 2).copied().unwrap_or(0.0);
    let mut judged = Judged {
        outline: contour.outline_px,
        found: contour.found_px,
        unclear: contour.unclear_px,
        flagged: !contour.flags.is_empty(),
        ..Judged::default()
    };
    let near = |outline: &TrueOutline, p, inset: f64| {
        outline.outside_px(p, REACH_PX).is_some_and(|d| (d - inset).abs() <= WRONG_PX)
    };
    for (point, length) in &points {
        judged.chosen += length;
        if !near(&outlines[own], point, inset) {
            judged.wrong += length;
            if outlines.iter().enumerate().any(|(k, o)| k != own && near(o, point, 0.0)) {
                judged.anothers += length;
            }
        }
    }
    judged
}

/// The outlines of all that is in the pictures of a frame, in each view, those of the bodies that are sought first.
fn outlines(knee: Knee, recorded: &Recorded, equipment: &Equipment) -> Vec<Vec<TrueOutline>> {
    let shadows = knee.shadows(&recorded.posture);
    let of_view = |view| {
        let outline = |(body, scale, pose): &(Body, f64, Pose)| {
            TrueOutline::new(ideal_outline(&Scaled(body.solid(), *scale), pose, view, STEP_PX))
        };
        shadows.iter().map(outline).collect()
    };
    equipment.views.iter().map(|(view, _)| of_view(view)).collect()
}

/// The contours of a body at each of [`POSES`], in each view of a frame.
fn of_body(
    lab: &Lab,
    body: Body,
    place: usize,
    recorded: &Recorded,
    equipment: &Equipment,
    outlines: &[Vec<TrueOutline>],
    number: usize,
) -> Result<[Vec<Judged>; 3], SceneError> {
    let calibrations = equipment.calibrations();
    let one = std::slice::from_ref(recorded);
    let scene = lab.recorded_scene(body, POINTS, one, &calibrations, MatchParams::default())?;
    let truth = recorded.posture.pose(body);
    let off = |offset: StartOffset| {
        let offset = StartOffset { count: 1, seed: lab.seed, ..offset };
        offset.draw(&truth, scene.rim.centroid(), number).first().copied().unwrap_or(truth)
    };
    let displaced = off(StartOffset { translation_mm: DISPLACED, rotation_deg: DISPLACED, ..STARTS });
    let views = &scene.frames[0].views;
    let mut judged = [const { Vec::new() }; 3];
    // Nothing cancels here, so every match gives an answer.
    let Ok(found) = match_body(&scene.rim, views, &scene.names, &off(STARTS), &scene.params, || false) else {
        return Ok(judged);
    };
    let poses: [Pose; 3] = [truth, found.pose.into(), displaced];
    let model = Hashed::new(ModelMesh(scene.mesh.clone()));
    let context = Context::new();
    for (((_, exposure), outlines), (calibration, curves)) in
        equipment.views.iter().zip(outlines).zip(calibrations.into_iter().zip(&recorded.curves))
    {
        let mut inputs = ContourInputs {
            curves: Hashed::new(curves.clone()),
            calibration: Hashed::new(calibration),
            model: model.clone(),
            matched: Hashed::new(found.clone()),
        };
        for (all, pose) in judged.iter_mut().zip(&poses) {
            inputs.matched = Hashed::new(Match { pose: (*pose).into(), ..found.clone() });
            let contour = ContourOf::run(&inputs, &ContourParams::default(), &context)
                .map_err(|e| SceneError::Mesh(e.to_string()))?;
            all.push(held(&contour, curves, exposure.distortion.as_ref(), outlines, place));
        }
    }
    Ok(judged)
}

fn row(label: String, all: &[Judged]) -> Row {
    let percent = |part: f64, whole: f64| 100.0 * part / whole.max(1e-9);
    let wrong = Distribution::of(all.iter().map(|j| percent(j.wrong, j.chosen)).collect());
    let sum = |f: fn(&Judged) -> f64| all.iter().map(f).sum::<f64>();
    let number = Cell::Number;
    Row::ours(
        label,
        vec![
            number(wrong.median),
            number(wrong.p95),
            number(wrong.worst),
            number(percent(sum(|j| j.wrong), sum(|j| j.chosen))),
            number(percent(sum(|j| j.anothers), sum(|j| j.chosen))),
            number(percent(sum(|j| j.found), sum(|j| j.outline))),
            number(percent(sum(|j| j.unclear), sum(|j| j.outline))),
            Cell::Share(all.iter().filter(|j| j.flagged).count(), all.len()),
        ],
    )
}

/// The table, and over how many frames of how many setups it is.
pub fn table(lab: &Lab) -> Result<(Table, usize), SectionError> {
    let (setups, frames) = (lab.count(2, 1), lab.count(3, 1));
    let mut rows = Vec::new();
    // Meshes of the bodies take half the time of a quick run.
    let knees: &[Knee] = if lab.full() { &[Knee::Implants, Knee::Natural] } else { &[Knee::Natural] };
    for &knee in knees {
        let mut found: [[Vec<Judged>; 3]; 2] = Default::default();
        for setup in 0..setups {
            let equipment = equipment(lab, setup);
            let postures: Vec<_> = (0..frames)
                .map(|k| (format!("{setup}/{k}"), Posture::random(lab.seed + 5, setup * frames + k)))
                .collect();
            let recorded = lab.record(knee, &postures, &equipment)?;
            let of_frame = |(k, one): (usize, &Recorded)| {
                let outlines = outlines(knee, one, &equipment);
                let number = setup * frames + k;
                let of_body = |place: usize| {
                    let body = knee.bodies()[place];
                    of_body(lab, body, place, one, &equipment, &outlines, 10 * number + place)
                };
                Ok([of_body(0)?, of_body(1)?])
            };
            let of_frames =
                recorded.par_iter().enumerate().map(of_frame).collect::<Result<Vec<_>, SceneError>>()?;
            for bodies in of_frames {
                for (all, one) in found.iter_mut().flatten().zip(bodies.into_iter().flatten()) {
                    all.extend(one);
                }
            }
        }
        for (body, found) in knee.bodies().iter().zip(&found) {
            for (pose, all) in POSES.iter().zip(found) {
                rows.push(row(format!("{}, {pose}", body.name().replace('-', " ")), all));
            }
        }
    }
    let table = Table {
        id: "edges-chosen".to_owned(),
        heading: "contours of a body, each in one picture".to_owned(),
        columns: vec![
            Column::at_most("wrong, median, %", 1),
            Column::at_most("95 %", 1),
            Column::at_most("worst", 1),
            Column::at_most("wrong of all, %", 2),
            Column::at_most("of another body, %", 2),
            Column::at_least("outline found, %", 1),
            Column::at_most("unclear, %", 1),
            Column::at_most("flagged", 0),
        ],
        rows,
    };
    Ok((table, setups * frames))
}
