//! What single starts of either method came to, in the thesis's terms.

use std::collections::{BTreeMap, VecDeque};

use biplane_artifact::{Curves, Verdict};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Curve, EdgePoint, Point3, Pose, PoseError, Vector2, Vector3};
use biplane_optimisation::{BinghamParams, BinghamView, EdgeField, Evidence, assess, descend, match_body};
use biplane_outline::{Outline, RimMesh, Sampling};
use biplane_phantom::TrueFluoroscope;
use nalgebra::{Matrix6, Vector6};
use rayon::prelude::*;

use crate::{Cell, Column, Row, Scene, Spread};

/// A method that the tables compare.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// `method = "bingham2006"`, each start by itself.
    Thesis,
    /// The default.
    Default,
}

impl Method {
    /// Both, the thesis's first.
    pub const BOTH: [Self; 2] = [Self::Thesis, Self::Default];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Thesis => "bingham2006",
            Self::Default => "default",
        }
    }
}

/// One start.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// The frame's place in its scene.
    pub frame: usize,
    /// Where it ended.
    pub pose: Pose,
    /// Against the truth.
    pub error: PoseError,
    /// Differences of the thesis's six pose variables about the centroid from the truth's, mm and degrees.
    pub variables: [f64; 6],
    /// Displacement of the centroid, laboratory axes, mm.
    pub moved: Vector3,
    /// Rotation vector against the truth, laboratory axes, rad.
    pub turned: Vector3,
    /// Whether the method itself says that the start counts: a verdict "good", or converged.
    pub counts: bool,
    /// Steps, or calls of the objective.
    pub calls: u32,
    /// Time, s.
    pub seconds: f64,
    /// What the default says of its answer; none for the thesis's method.
    pub stated: Option<Stated>,
}

/// How well an answer fits, and how sure it is said to be.
#[derive(Debug, Clone)]
pub struct Stated {
    /// The verdict.
    pub verdict: Verdict,
    /// Root mean square residual of the outline, px: the larger view's.
    pub residual_px: f64,
    /// The same at the true pose.
    pub truth_residual_px: f64,
    /// Covariance, as [`biplane_artifact::Match`] defines it.
    pub covariance: Matrix6<f64>,
}

impl Outcome {
    /// Within 1 mm and 1 degree of the truth.
    pub fn right(&self) -> bool {
        self.error.translation_mm <= 1.0 && self.error.rotation_rad.to_degrees() <= 1.0
    }

    /// Squared error over the stated covariance: 6 on average where that is right.
    pub fn normalised_squared(&self) -> Option<f64> {
        let (m, t) = (self.moved, self.turned);
        let error = Vector6::new(m.x, m.y, m.z, t.x, t.y, t.z);
        self.stated.as_ref()?.covariance.try_inverse().map(|i| error.dot(&(i * error)))
    }

    fn of(
        scene: &Scene,
        frame: usize,
        pose: Pose,
        counts: bool,
        calls: u32,
        seconds: f64,
        stated: Option<Stated>,
    ) -> Self {
        let (centroid, truth) = (scene.rim.centroid(), &scene.frames[frame].reference);
        let of = |p: &Pose| p.to_thesis(centroid.coords);
        let ((angles, t), (true_angles, true_t)) = (of(&pose), of(truth));
        let half = std::f64::consts::PI;
        let variables = std::array::from_fn(|i| match i {
            0..3 => t[i] - true_t[i],
            _ => {
                let difference: f64 = angles[i - 3] - true_angles[i - 3];
                ((difference + half).rem_euclid(2.0 * half) - half).to_degrees()
            }
        });
        Self {
            frame,
            pose,
            error: pose.error_against(truth, centroid),
            variables,
            moved: pose.transform(centroid) - truth.transform(centroid),
            turned: (pose.rotation() * truth.rotation().inverse()).scaled_axis(),
            counts,
            calls,
            seconds,
            stated,
        }
    }
}

/// Draws the start poses of a frame: from its true pose, the body's centroid, and the frame's place.
pub type Draw<'a> = &'a (dyn Fn(&Pose, &Point3, usize) -> Vec<Pose> + Sync);

/// Every start of every frame, by a method. The thesis's method sees the curves as they are: [`chosen`] for those of
/// pictures.
pub fn outcomes(scene: &Scene, method: Method, thesis: &BinghamParams, draw: Draw) -> Vec<Outcome> {
    let centroid = *scene.rim.centroid();
    let tasks: Vec<(usize, Pose)> = scene
        .frames
        .iter()
        .enumerate()
        .flat_map(|(k, f)| draw(&f.reference, &centroid, k).into_iter().map(move |start| (k, start)))
        .collect();
    let contours: Vec<Vec<BinghamView>> = match method {
        Method::Thesis => scene.frames.iter().map(|f| contours(scene, f)).collect(),
        Method::Default => Vec::new(),
    };
    let truth_residual_px: Vec<f64> = scene.frames.par_iter().map(|f| truth_residual_px(scene, f)).collect();
    tasks
        .into_par_iter()
        .filter_map(|(k, start)| {
            let begun = std::time::Instant::now();
            let (pose, counts, calls, stated) = match method {
                Method::Thesis => {
                    let found = descend(scene.mesh.vertices(), &centroid, &contours[k], &start, thesis);
                    (found.pose, found.converged, found.calls as u32, None)
                }
                Method::Default => {
                    let views = &scene.frames[k].views;
                    // Nothing cancels here, so every match gives an answer.
                    let found =
                        match_body(&scene.rim, views, &scene.names, &start, &scene.params, || false).ok()?;
                    let good = found.verdict == Verdict::Good;
                    (found.pose.into(), good, found.iterations, Some(found))
                }
            };
            let seconds = begun.elapsed().as_secs_f64();
            let stated = stated.map(|found| Stated {
                verdict: found.verdict,
                residual_px: found.views.iter().map(|v| v.rms_px).fold(0.0, f64::max),
                truth_residual_px: truth_residual_px[k],
                covariance: Matrix6::from_fn(|i, j| found.covariance[i][j]),
            });
            Some(Outcome::of(scene, k, pose, counts, calls, seconds, stated))
        })
        .collect()
}

fn truth_residual_px(scene: &Scene, frame: &crate::Posed) -> f64 {
    let assessed = assess(&scene.rim, &frame.views, &frame.reference, &scene.params.search());
    let rms = |e: &Evidence| (e.squared / e.matched_px.max(1e-9)).sqrt();
    assessed.evidence.iter().map(rms).fold(0.0, f64::max)
}

fn contours(scene: &Scene, frame: &crate::Posed) -> Vec<BinghamView> {
    let middle = frame.reference.transform(scene.rim.centroid());
    frame
        .views
        .iter()
        .zip(&frame.curves)
        .map(|(view, curves)| {
            // What a pixel is at the body.
            let depth = view.fluoroscope.project(&middle).map_or(1.0, |p| p.depth);
            let fluoroscope = view.fluoroscope.clone();
            let mm_per_px = fluoroscope.mm_per_px(depth);
            BinghamView::new(fluoroscope, curves, mm_per_px)
        })
        .collect()
}

/// How far from the true outline an edge may lie to be taken for the body's, px.
const CHOSEN_PX: f64 = 4.0;

/// The pieces of `curves` that a person who knows the body would choose: near its outline at the true pose, running in
/// its direction. The thesis's method has no other way to tell one body's edges from another's.
pub fn chosen(curves: &Curves, view: &Fluoroscope, model: &RimMesh, truth: &Pose) -> Curves {
    let mut outline = Outline::new();
    outline.trace(model, truth, view, Sampling { step_px: 0.5 });
    let field = outline_field(&outline);
    let mut pieces = Vec::new();
    for curve in &curves.0 {
        let ideal = view.distortion().map(|d| d.correct(curve));
        let ideal = ideal.as_ref().map_or(&curve.points, |c| &c.points);
        let mut piece = Vec::new();
        for (recorded, ideal) in curve.points.iter().zip(ideal) {
            if field.nearest(&ideal.position, &ideal.direction, CHOSEN_PX, 0.9).is_some() {
                piece.push(*recorded);
            } else if !piece.is_empty() {
                pieces.push(Curve { points: std::mem::take(&mut piece), closed: false });
            }
        }
        if !piece.is_empty() {
            let closed = curve.closed && piece.len() == curve.points.len();
            pieces.push(Curve { points: piece, closed });
        }
    }
    pieces.retain(|c| c.points.len() > 3);
    Curves(pieces)
}

fn outline_field(outline: &Outline) -> EdgeField {
    EdgeField::new(&outline_curves(outline), None)
}

/// An outline of the product as curves in ideal pixels, linked into pieces where neighbouring samples follow each other.
pub fn outline_curves(outline: &Outline) -> Curves {
    let points: Vec<EdgePoint> = outline
        .points()
        .iter()
        .map(|p| EdgePoint { position: p.pixel, direction: p.normal, strength: 1.0, sigma_px: 0.01 })
        .collect();
    Curves(linked(points))
}

/// Greatest distance of samples that follow each other along an outline, px.
const FOLLOWS_PX: f64 = 2.0;

/// Follows samples of contours from one to the nearest in its tangent's direction.
fn linked(points: Vec<EdgePoint>) -> Vec<Curve> {
    let key = |v: f64| (v / FOLLOWS_PX).floor() as i64;
    let mut cells: BTreeMap<(i64, i64), Vec<usize>> = BTreeMap::new();
    for (i, p) in points.iter().enumerate() {
        cells.entry((key(p.position.x), key(p.position.y))).or_default().push(i);
    }
    let mut used = vec![false; points.len()];
    // The free sample nearest to one, ahead of it along its contour (`way` +1) or behind it.
    let next = |from: usize, way: f64, used: &[bool]| {
        let p = &points[from];
        let along = Vector2::new(-p.direction.y, p.direction.x) * way;
        let (x, y) = (key(p.position.x), key(p.position.y));
        let mut best: Option<(f64, usize)> = None;
        for cell in (-1..=1).flat_map(|i| (-1..=1).map(move |j| (x + i, y + j))) {
            for &other in cells.get(&cell).into_iter().flatten() {
                let to = points[other].position - p.position;
                let distance = to.norm();
                let ahead = to.dot(&along) >= 0.0 && points[other].direction.dot(&p.direction) > -0.2;
                if !used[other] && ahead && distance < FOLLOWS_PX && best.is_none_or(|b| distance < b.0) {
                    best = Some((distance, other));
                }
            }
        }
        best.map(|b| b.1)
    };
    let mut curves = Vec::new();
    for first in 0..points.len() {
        if used[first] {
            continue;
        }
        used[first] = true;
        let mut chain = VecDeque::from([first]);
        for way in [1.0, -1.0] {
            let mut at = first;
            while let Some(other) = next(at, way, &used) {
                used[other] = true;
                at = other;
                if way > 0.0 { chain.push_back(other) } else { chain.push_front(other) }
            }
        }
        let (a, b) = (&points[chain[0]], &points[chain[chain.len() - 1]]);
        let closed = chain.len() > 8 && (a.position - b.position).norm() < FOLLOWS_PX;
        curves.push(Curve { points: chain.into_iter().map(|i| points[i]).collect(), closed });
    }
    curves.retain(|c: &Curve| c.points.len() > 3);
    curves
}

/// The thesis's columns: errors of the six variables, and how the starts ended.
pub fn columns() -> Vec<Column> {
    let axes = ["Δx, mm", "Δy, mm", "Δz, mm", "Δα, °", "Δβ, °", "Δγ, °"];
    axes.iter()
        .map(|name| Column::at_most(name, 3))
        .chain([
            Column::at_least("starts that count", 0),
            Column::at_most("of them wrong", 0),
            Column::at_most("calls", 0),
            Column::at_most("ms a start", 0),
        ])
        .collect()
}

/// A row of such a table: errors of the starts that count and are right, shares of all.
pub fn row(label: &str, outcomes: &[&Outcome]) -> Row {
    let counted: Vec<&&Outcome> = outcomes.iter().filter(|o| o.counts).collect();
    let right: Vec<&&&Outcome> = counted.iter().filter(|o| o.right()).collect();
    let mut cells: Vec<Cell> = (0..6)
        .map(|i| Cell::Spread(Spread::of(&right.iter().map(|o| o.variables[i]).collect::<Vec<_>>())))
        .collect();
    cells.push(Cell::Share(counted.len(), outcomes.len()));
    cells.push(Cell::Number((counted.len() - right.len()) as f64));
    let mean = |f: &dyn Fn(&Outcome) -> f64| {
        outcomes.iter().map(|o| f(o)).sum::<f64>() / outcomes.len().max(1) as f64
    };
    cells.push(Cell::Number(mean(&|o| f64::from(o.calls))));
    cells.push(Cell::Number(mean(&|o| 1e3 * o.seconds)));
    Row::ours(label, cells)
}

/// A row of the thesis in the same columns.
pub fn thesis_row(label: &str, errors: &crate::thesis::Errors, calls: &str, time: &str) -> Row {
    let mut cells: Vec<Cell> = errors.iter().map(|s| Cell::Spread(*s)).collect();
    cells.extend([Cell::text("-"), Cell::text("-"), Cell::text(calls), Cell::text(time)]);
    Row { label: label.to_owned(), ours: false, cells }
}

/// Length of the root mean square errors of three of the six: position (0) or rotation (3).
pub fn rms_length(spreads: &[Spread], from: usize) -> f64 {
    spreads[from..from + 3].iter().map(|s| s.rms * s.rms).sum::<f64>().sqrt()
}

/// Errors of the six variables of those that count and are right.
pub fn errors(outcomes: &[&Outcome]) -> Vec<Spread> {
    let right: Vec<&&Outcome> = outcomes.iter().filter(|o| o.counts && o.right()).collect();
    (0..6).map(|i| Spread::of(&right.iter().map(|o| o.variables[i]).collect::<Vec<_>>())).collect()
}

/// Signed errors in plane and out of plane of a view: of position (mm), then of rotation (degrees); in plane is across the
/// view's axis, of a rotation about it.
pub fn by_plane(outcomes: &[&Outcome], view: &TrueFluoroscope) -> [Vec<f64>; 4] {
    let (out, across) = ([view.normal()], [view.along_x, view.along_y]);
    let along = |v: fn(&Outcome) -> Vector3, axes: &[Vector3], scale: f64| -> Vec<f64> {
        outcomes.iter().flat_map(|o| axes.iter().map(move |a| v(o).dot(a) * scale)).collect()
    };
    let degrees = 1_f64.to_degrees();
    [
        along(|o| o.moved, &across, 1.0),
        along(|o| o.moved, &out, 1.0),
        along(|o| o.turned, &out, degrees),
        along(|o| o.turned, &across, degrees),
    ]
}

/// Columns of Tables 5.1 and 5.2.
pub fn compared_columns() -> Vec<Column> {
    let mut columns: Vec<Column> = ["in plane, mm", "in plane, °", "out of plane, mm", "out of plane, °"]
        .iter()
        .map(|name| Column::at_most(name, 3))
        .collect();
    columns.push(Column::at_most("algorithm", 0));
    columns
}

/// The published rows of Table 5.1 or 5.2.
pub fn compared_rows(published: &[crate::thesis::Compared]) -> Vec<Row> {
    published
        .iter()
        .map(|(author, cells, algorithm)| {
            let cells: Vec<&str> = cells.iter().copied().chain([*algorithm]).collect();
            Row::published(*author, &cells)
        })
        .collect()
}
