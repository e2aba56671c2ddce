//! One descent: from a start pose to the nearest pose whose outline lies on edges.
//!
//! **Far.** A few samples of the outline and a few points of the edges look for each other, a turn counting as a distance; each pair
//! gives the distance from a point to the other's tangent. The same samples serve for several steps, held fixed to the body.
//! **Near.** The outline is traced anew until steps are short, and each sample's residual is where its normal crosses the nearest curve
//! of its direction.
//!
//! Each view has one nuisance parameter beside the six of the pose: its **inset**, by which the image's edges lie inside
//! the outline as a whole. At the rim of a smooth body the path of a ray starts from zero, so the steepest gradient lies
//! inside the true outline, and smoothing adds to it. Held at zero, the inset costs an X-rayed distal femur 0.16 mm and 0.62 degrees in the
//! median; solved for, 0.008 and 0.019; what differs from rim to rim is taken out afterwards ([`crate::take_out`]), 0.001 and 0.003
//! (`cargo xtask validate --only bias`). The inset is eliminated from the normal equations, so a step stays 6 x 6.

use biplane_edge_field::{Sparse, SparseEdges};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Point3, Pose, Twist, Vector2, Vector3};
use biplane_outline::{Outline, OutlinePoint, RimMesh, Sampling};
use nalgebra::{Matrix6, Vector6};

use crate::EdgeField;
use crate::noise::covariance;

/// One view of a body: its fluoroscope and the edges of its frame.
#[derive(Debug)]
pub struct View {
    /// The fluoroscope.
    pub fluoroscope: Fluoroscope,
    /// Edges in ideal pixels.
    pub edges: EdgeField,
}

/// How a descent searches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RefineParams {
    /// Search radius of the first step, px.
    pub search_px: f64,
    /// Search radius of the last steps, px.
    pub final_search_px: f64,
    /// +1 for a body darker than what is beside it, -1 for a brighter one.
    pub contrast: f64,
    /// Standard deviation that the inset is expected to have, px; 0 holds it at zero.
    pub inset_px: f64,
    /// A descent ends when the centroid moves by less than this, mm, and the surface by turning as little.
    pub still_mm: f64,
    /// Steps at most with the last search radius.
    pub most_steps: u32,
    /// Residuals of about this size are never taken for outliers, px. Differences between mesh and body, or
    /// what a calibration that is not sure makes of them.
    pub least_scale_px: f64,
}

/// Far: about how many samples of the outline a view has, at least so many px apart.
const FAR_SAMPLES: f64 = 48.0;
const FAR_SPACING_PX: f64 = 4.0;
/// Far: steps for one tracing of the outline, and tracings at most.
const FAR_STEPS: u32 = 3;
const FAR_TRACES: u32 = 8;
/// Far: search radius over the median distance of pairs at the last step, or over this share of itself while steps are long.
const FAR_REACH: f64 = 6.0;
const FAR_MOVED: f64 = 0.1;
/// Far: least cosine between an outline's normal and an edge's direction.
const FAR_COSINE: f64 = 0.3;
/// Far: edges that are longer than so many outlines are not the body's alone, and do not look for the outline in turn.
const FAR_CLUTTER: f64 = 2.0;
/// Far: with steps below this the near search takes over, mm.
const FAR_STILL_MM: f64 = 0.3;
/// Near: factor of the search radius from step to step, and where it begins over where it ends.
const SHRINK: f64 = 0.5;
const NEAR_FROM: f64 = 3.0;
/// Near: least cosine between the outline's normal and an edge's direction, 25 degrees.
pub(crate) const MIN_COSINE: f64 = 0.906;
/// Near: distance of outline samples, px.
const SPACING_PX: f64 = 2.0;
/// Near: the same while the radius is not the last.
const FIRST_SPACING_PX: f64 = 4.0;
/// Near: after a step below this the outline is not traced anew, its points are held fixed to the body, mm: they slide by its square
/// over the surface's radius of curvature.
const HELD_MM: f64 = 0.02;
/// A descent whose last steps swing by no more than this, mm, because samples change their edge point, has come to rest too.
const SWING_MM: f64 = 0.01;
/// Largest step, mm of the centroid or of the surface by turning.
const LONGEST_STEP_MM: f64 = 25.0;
/// The robust weight's scale is never below this, px: below it are the differences between mesh and body.
pub(crate) const LEAST_SCALE_PX: f64 = 0.3;
/// Noise of an inset seen along one correlation length, px.
const INSET_NOISE_PX: f64 = 0.3;
/// The robust weight's least scale while far, px.
const LEAST_FAR_SCALE_PX: f64 = 4.0;

/// What one view says of a pose. Residuals are those that the inset leaves.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Evidence {
    /// How far the edges lie inside the outline as a whole, px.
    pub inset_px: f64,
    /// Length of the outline, px.
    pub outline_px: f64,
    /// Length of the outline on the picture, px.
    pub in_image_px: f64,
    /// Length that found its edge within the final search radius, px.
    pub matched_px: f64,
    /// Sum over matched length of the squared residual, px^3.
    pub squared: f64,
    /// The same, mm^2 px.
    pub squared_mm: f64,
    /// Sum over matched length of `exp(-r^2 / 2)`, `r` in px: length that fits well.
    pub close_px: f64,
}

/// Where a descent ended.
#[derive(Debug, Clone)]
pub struct Refined {
    /// The pose.
    pub pose: Pose,
    /// One a view.
    pub evidence: Vec<Evidence>,
    /// Steps taken.
    pub steps: u32,
    /// Whether the last step was small enough.
    pub still: bool,
    /// Covariance of the pose as [`biplane_artifact::Match`] defines it; `None` where a motion is not held by anything.
    pub covariance: Option<Matrix6<f64>>,
}

impl Refined {
    /// Mean over the views of the share of the outline on the picture that fits well, 0 to 1: compares poses.
    pub fn score(&self) -> f64 {
        let share = |e: &Evidence| if e.in_image_px > 0.0 { e.close_px / e.in_image_px } else { 0.0 };
        self.evidence.iter().map(share).sum::<f64>() / self.evidence.len().max(1) as f64
    }
}

/// Length along a contour over which residuals are taken to move together where it is not measured, px: differences between mesh and
/// body, and edges beside bone or cement that are off as a whole. What is known of an inset beforehand counts as much as residuals along
/// it, and the disagreement of two views is stated with it. The pose's covariance measures it ([`crate::noise`]).
pub(crate) const CORRELATION_PX: f64 = 150.0;

/// One outline sample that found an edge.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    /// Along the outline's normal, px.
    pub(crate) residual: f64,
    /// Its derivative by the twist, px per mm and px per rad.
    pub(crate) derivative: Vector6<f64>,
    /// Number of its sample in the view.
    sample: u32,
    /// Size of a pixel at its depth.
    mm_per_px: f64,
    /// Length of the outline it stands for, px.
    pub(crate) length: f64,
}

impl Row {
    /// Its weight but for what is robust, in mm^2: the length that it stands for, by the square of a pixel's size.
    pub(crate) fn weight(&self) -> f64 {
        self.length * self.mm_per_px * self.mm_per_px
    }
}

/// Weighted normal equations of one step, in mm^2: sums over rows of weight, derivative and residual.
struct Normal {
    matrix: Matrix6<f64>,
    vector: Vector6<f64>,
    /// Square of the robust weight's scale, px^2.
    scale_squared: f64,
}

/// Buffers of a descent, used again from step to step.
pub(crate) struct Buffers {
    outline: Outline,
    rows: Vec<Row>,
    /// Rows of each view: where they end, and the view's inset.
    views: Vec<(usize, f64)>,
    sizes: Vec<f64>,
    evidence: Vec<Evidence>,
    /// Samples of the outline in each view; they move with the pose until it is traced anew.
    samples: Vec<Vec<OutlinePoint>>,
    sparse: SparseEdges,
}

impl Default for Buffers {
    fn default() -> Self {
        Self {
            outline: Outline::lean(),
            rows: Vec::new(),
            views: Vec::new(),
            sizes: Vec::new(),
            evidence: Vec::new(),
            samples: Vec::new(),
            sparse: SparseEdges::default(),
        }
    }
}

impl Buffers {
    /// The sample of a row.
    pub(crate) fn sample(&self, view: usize, row: &Row) -> &OutlinePoint {
        &self.samples[view][row.sample as usize]
    }

    /// The rows of each view with its inset.
    pub(crate) fn by_view(&self) -> impl Iterator<Item = (&[Row], f64)> {
        let starts = std::iter::once(0).chain(self.views.iter().map(|v| v.0));
        starts.zip(&self.views).map(|(start, &(end, inset))| (&self.rows[start..end], inset))
    }
}

/// Descends from `start`.
pub fn refine(mesh: &RimMesh, views: &[View], start: &Pose, params: &RefineParams) -> Refined {
    refine_with(mesh, views, start, params, &mut Buffers::default())
}

/// [`refine`] with buffers that are used again.
pub(crate) fn refine_with(
    mesh: &RimMesh,
    views: &[View],
    start: &Pose,
    params: &RefineParams,
    buffers: &mut Buffers,
) -> Refined {
    let (pose, far_steps, close) = approach(mesh, views, start, params, buffers);
    let (pose, steps, still) = settle(mesh, views, pose, close, params, buffers);
    if !still {
        collect_anew(mesh, views, &pose, params, buffers);
    }
    finish(pose, far_steps + steps, still, params, buffers)
}

/// The far search; gives its pose, the steps taken, and whether it came to rest within the near search's reach.
fn approach(
    mesh: &RimMesh,
    views: &[View],
    start: &Pose,
    params: &RefineParams,
    buffers: &mut Buffers,
) -> (Pose, u32, bool) {
    let mut pose = *start;
    let mut radius = params.search_px;
    let mut steps = 0;
    let least = params.final_search_px * NEAR_FROM;
    if radius <= least {
        return (pose, steps, false);
    }
    let mut spacing = FAR_SPACING_PX;
    for _ in 0..FAR_TRACES {
        buffers.samples.resize_with(views.len(), Vec::new);
        let mut longest: f64 = 0.0;
        for (view, samples) in views.iter().zip(&mut buffers.samples) {
            buffers.outline.trace_thinned(mesh, &pose, &view.fluoroscope, Sampling { step_px: 1e9 }, spacing);
            longest = longest.max(buffers.outline.length_px());
            samples.clear();
            samples.extend_from_slice(buffers.outline.points());
        }
        spacing = (longest / FAR_SAMPLES).max(FAR_SPACING_PX);
        let (mut size, mut residual) = (f64::INFINITY, 0.0);
        for _ in 0..FAR_STEPS {
            let center = pose.transform(mesh.centroid());
            pair(views, &center, radius, params, buffers);
            buffers.sizes.clear();
            buffers.sizes.extend(buffers.rows.iter().map(|r| r.residual.abs()));
            residual = median(&mut buffers.sizes);
            let normal = normal_equations(buffers, radius, 0.0, LEAST_FAR_SCALE_PX);
            let Some(twist) = solve(&normal, mesh.radius_of_gyration()) else { return (pose, steps, false) };
            steps += 1;
            pose = hold(&pose, &twist, &center, buffers);
            size = twist.translation.norm().max(twist.rotation.norm() * mesh.radius_of_gyration());
            if size < FAR_STILL_MM {
                break;
            }
        }
        let still = size < FAR_STILL_MM;
        if still && radius <= least {
            return (pose, steps, true);
        }
        // As far as pairs are apart, and farther while they move.
        let reach = FAR_REACH * residual.max(if still { 0.0 } else { FAR_MOVED * radius });
        radius = radius.min(reach).max(least);
    }
    (pose, steps, false)
}

/// Moves a pose, and with it the samples of the outline.
fn hold(pose: &Pose, twist: &Twist, center: &Point3, buffers: &mut Buffers) -> Pose {
    let moved = pose.moved(twist, center);
    let turn = (moved.rotation() * pose.rotation().inverse()).to_rotation_matrix();
    for sample in buffers.samples.iter_mut().flatten() {
        sample.world = center + turn * (sample.world - center) + twist.translation;
    }
    moved
}

/// Near: samples of the outline in all views.
fn trace(mesh: &RimMesh, views: &[View], pose: &Pose, last: bool, buffers: &mut Buffers) {
    let step = if last { SPACING_PX } else { FIRST_SPACING_PX };
    buffers.samples.resize_with(views.len(), Vec::new);
    for (view, samples) in views.iter().zip(&mut buffers.samples) {
        // Many short parts of the rim: one sample stands for all that were passed since the last one.
        let (sampling, spacing) = (Sampling { step_px: step }, 0.5 * step);
        buffers.outline.trace_thinned(mesh, pose, &view.fluoroscope, sampling, spacing);
        samples.clear();
        samples.extend_from_slice(buffers.outline.points());
    }
}

/// Far: fills the rows with pairs of samples and edges, each from one to the other's tangent.
fn pair(views: &[View], center: &Point3, radius: f64, params: &RefineParams, buffers: &mut Buffers) {
    let Buffers { samples, sparse, rows, views: ends, .. } = buffers;
    rows.clear();
    ends.clear();
    let turn_px = radius;
    let most = radius * radius;
    for (view, samples) in views.iter().zip(samples.iter_mut()) {
        let edges = view.edges.sparse();
        sparse.clear();
        let mut length = 0.0;
        for sample in samples.iter_mut() {
            length += sample.length_px;
            let Some(seen) = view.fluoroscope.project(&sample.world) else { continue };
            (sample.pixel, sample.depth) = (seen.pixel, seen.depth);
            let own = Sparse { position: seen.pixel, direction: sample.normal * params.contrast };
            sparse.push(own);
            let Some((edge, _)) = edges.nearest(&own, turn_px) else { continue };
            let apart = edge.position - own.position;
            if apart.norm_squared() > most || edge.direction.dot(&own.direction) < FAR_COSINE {
                continue;
            }
            let across = edge.direction * params.contrast;
            rows.extend(row(view, (0, sample), center, &across, across.dot(&apart), sample.length_px));
        }
        if view.edges.length_px() <= FAR_CLUTTER * length {
            let share = length / edges.points().len().max(1) as f64;
            for edge in edges.points() {
                let Some(number) = sparse.nearest_number(edge, turn_px) else { continue };
                // Samples behind the source are in neither list; with any, numbers would not be theirs.
                let Some(sample) = samples.get(number).filter(|_| sparse.points().len() == samples.len())
                else {
                    continue;
                };
                let apart = edge.position - sample.pixel;
                if apart.norm_squared() > most
                    || edge.direction.dot(&sample.normal) * params.contrast < FAR_COSINE
                {
                    continue;
                }
                let across = sample.normal;
                rows.extend(row(view, (0, sample), center, &across, across.dot(&apart), share));
            }
        }
        ends.push((rows.len(), 0.0));
    }
}

/// The row of a sample that should move by `residual` px along `across`.
#[inline]
fn row(
    view: &View,
    (number, sample): (u32, &OutlinePoint),
    center: &Point3,
    across: &Vector2,
    residual: f64,
    length: f64,
) -> Option<Row> {
    let (_, by_point) = view.fluoroscope.project_with_derivative(&sample.world)?;
    let gradient = by_point.transpose() * across;
    let turn = (sample.world - center).cross(&gradient);
    Some(Row {
        residual,
        derivative: Vector6::new(gradient.x, gradient.y, gradient.z, turn.x, turn.y, turn.z),
        sample: number,
        mm_per_px: view.fluoroscope.mm_per_px(sample.depth),
        length,
    })
}

/// The near search, from a pose that is `close` or within its first radius; gives its pose, the steps taken and whether it came to rest.
fn settle(
    mesh: &RimMesh,
    views: &[View],
    mut pose: Pose,
    close: bool,
    params: &RefineParams,
    buffers: &mut Buffers,
) -> (Pose, u32, bool) {
    let mut radius = params.final_search_px * if close { 1.0 } else { NEAR_FROM };
    let (mut steps, mut final_steps, mut still) = (0, 0, false);
    let mut held = false;
    while final_steps < params.most_steps && !still {
        let last = radius <= params.final_search_px;
        if !held {
            trace(mesh, views, &pose, last, buffers);
        }
        collect(mesh, views, &pose, radius, last, params, buffers);
        let normal = normal_equations(buffers, radius, params.inset_px, params.least_scale_px);
        let Some(twist) = solve(&normal, mesh.radius_of_gyration()) else { break };
        pose = hold(&pose, &twist, &pose.transform(mesh.centroid()), buffers);
        steps += 1;
        let size = twist.translation.norm().max(twist.rotation.norm() * mesh.radius_of_gyration());
        if last {
            final_steps += 1;
            still = size < params.still_mm || (final_steps == params.most_steps && size < SWING_MM);
            held = size < HELD_MM && !held;
        }
        // A small step means that all within the smaller radius is known already.
        let shrink = if size < 0.1 { 0.0 } else { SHRINK };
        radius = (radius * shrink).max(params.final_search_px);
    }
    (pose, steps, still)
}

/// What the views say of a pose as it stands: no step is taken.
pub fn assess(mesh: &RimMesh, views: &[View], pose: &Pose, params: &RefineParams) -> Refined {
    let mut buffers = Buffers::default();
    collect_anew(mesh, views, pose, params, &mut buffers);
    finish(*pose, 0, true, params, &mut buffers)
}

/// Near: traces the outline and fills the rows of all views and what they say, but for residuals.
pub(crate) fn collect_anew(
    mesh: &RimMesh,
    views: &[View],
    pose: &Pose,
    params: &RefineParams,
    buffers: &mut Buffers,
) {
    trace(mesh, views, pose, true, buffers);
    collect(mesh, views, pose, params.final_search_px, true, params, buffers);
}

/// Near: fills the rows of all views from the samples that there are.
fn collect(
    mesh: &RimMesh,
    views: &[View],
    pose: &Pose,
    radius: f64,
    last: bool,
    params: &RefineParams,
    buffers: &mut Buffers,
) {
    buffers.rows.clear();
    buffers.views.clear();
    buffers.evidence.clear();
    let center = pose.transform(mesh.centroid());
    for (number, view) in views.iter().enumerate() {
        let evidence =
            collect_view(view, &mut buffers.samples[number], &center, radius, params, &mut buffers.rows);
        buffers.evidence.push(evidence);
        // While searching, a residual common to all of a view is motion; only at the end is it inset.
        let from = buffers.views.last().map_or(0, |v| v.0);
        let inset = if last && params.inset_px > 0.0 {
            buffers.sizes.clear();
            buffers.sizes.extend(buffers.rows[from..].iter().map(|r| r.residual));
            median(&mut buffers.sizes).clamp(-2.0 * params.inset_px, 2.0 * params.inset_px)
        } else {
            0.0
        };
        buffers.views.push((buffers.rows.len(), inset));
    }
}

fn median(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Adds the rows of one view; returns its evidence, lengths only.
fn collect_view(
    view: &View,
    samples: &mut [OutlinePoint],
    center: &Point3,
    radius: f64,
    params: &RefineParams,
    rows: &mut Vec<Row>,
) -> Evidence {
    let mut evidence = Evidence::default();
    for (number, point) in samples.iter_mut().enumerate() {
        let Some(seen) = view.fluoroscope.project(&point.world) else { continue };
        (point.pixel, point.depth) = (seen.pixel, seen.depth);
        evidence.outline_px += point.length_px;
        if !view.fluoroscope.on_image(&point.pixel, 2.0) {
            continue;
        }
        evidence.in_image_px += point.length_px;
        let direction = point.normal * params.contrast;
        let Some(residual) = view.edges.crossing(&point.pixel, &point.normal, &direction, radius, MIN_COSINE)
        else {
            continue;
        };
        let own = (number as u32, &*point);
        let Some(row) = row(view, own, center, &point.normal, residual, point.length_px) else { continue };
        evidence.matched_px += point.length_px;
        rows.push(row);
    }
    evidence
}

/// Derivative by the residual of the residual times its [`robust_weight`]: negative for outliers, which give way.
pub(crate) fn robust_slope(scale_squared: f64, residual: f64) -> f64 {
    let squared = residual * residual;
    scale_squared * scale_squared * (scale_squared - 3.0 * squared) / (scale_squared + squared).powi(3)
}

/// Geman and McClure's weight of a residual.
pub(crate) fn robust_weight(scale_squared: f64, residual: f64) -> f64 {
    (scale_squared / (scale_squared + residual * residual)).powi(2)
}

/// Square of the robust weight's scale, px^2.
pub(crate) fn robust_scale_squared(buffers: &mut Buffers, radius: f64, least: f64) -> f64 {
    let mut sizes = std::mem::take(&mut buffers.sizes);
    sizes.clear();
    for (rows, inset) in buffers.by_view() {
        sizes.extend(rows.iter().map(|r| (r.residual - inset).abs()));
    }
    // 1.4826 turns a median size into a standard deviation; residuals beyond about 2.5 of them lose their weight.
    let scale = (2.5 * 1.4826 * median(&mut sizes)).clamp(least, (radius / 2.0).max(least));
    buffers.sizes = sizes;
    scale * scale
}

fn normal_equations(buffers: &mut Buffers, radius: f64, inset_px: f64, least_scale: f64) -> Normal {
    let scale_squared = robust_scale_squared(buffers, radius, least_scale);
    let mut normal = Normal { matrix: Matrix6::zeros(), vector: Vector6::zeros(), scale_squared };
    for (rows, inset) in buffers.by_view() {
        // Sums over the view of weight, weight times residual, weight times derivative: its inset's row.
        let (mut sum, mut sum_residual, mut sum_derivative) = (0.0, 0.0, Vector6::zeros());
        let mut prior = 0.0;
        for row in rows {
            let left = row.residual - inset;
            let mm2 = row.mm_per_px * row.mm_per_px;
            let weight = row.weight() * robust_weight(normal.scale_squared, left);
            normal.matrix.syger(weight, &row.derivative, &row.derivative, 1.0);
            normal.vector += row.derivative * (weight * row.residual);
            sum += weight;
            sum_residual += weight * row.residual;
            sum_derivative += row.derivative * weight;
            prior = mm2;
        }
        if inset_px > 0.0 && sum > 0.0 {
            // What is known of the inset beforehand counts as much as one correlation length of residuals would.
            let known = CORRELATION_PX * prior * (INSET_NOISE_PX / inset_px).powi(2);
            normal.matrix.syger(-1.0 / (sum + known), &sum_derivative, &sum_derivative, 1.0);
            normal.vector -= sum_derivative * (sum_residual / (sum + known));
        }
    }
    normal.matrix.fill_upper_triangle_with_lower_triangle();
    normal
}

/// The damped step; rotations are scaled by the body's radius of gyration so that all six are mm.
fn solve(normal: &Normal, arm: f64) -> Option<Twist> {
    let arm = arm.max(1e-3);
    let scale = Vector6::new(1.0, 1.0, 1.0, 1.0 / arm, 1.0 / arm, 1.0 / arm);
    let mut matrix = normal.matrix;
    for i in 0..6 {
        for j in 0..6 {
            matrix[(i, j)] *= scale[i] * scale[j];
        }
    }
    let damping = 1e-4 * (matrix.trace() / 6.0);
    if damping.is_nan() || damping <= 0.0 {
        return None;
    }
    for i in 0..6 {
        matrix[(i, i)] += damping;
    }
    let step = matrix.cholesky()?.solve(&normal.vector.component_mul(&scale));
    let (moved, turned) = (Vector3::new(step[0], step[1], step[2]), Vector3::new(step[3], step[4], step[5]));
    let shorten = (LONGEST_STEP_MM / moved.norm().max(turned.norm()).max(1e-12)).min(1.0);
    Some(Twist { translation: moved * shorten, rotation: turned * (shorten / arm) })
}

/// The answer from the rows as they are.
fn finish(pose: Pose, steps: u32, still: bool, params: &RefineParams, buffers: &mut Buffers) -> Refined {
    let normal = normal_equations(buffers, params.final_search_px, params.inset_px, params.least_scale_px);
    let mut evidence = buffers.evidence.clone();
    for ((rows, inset), evidence) in buffers.by_view().zip(&mut evidence) {
        evidence.inset_px = -inset;
        for row in rows {
            let squared = (row.residual - inset).powi(2);
            evidence.squared += row.length * squared;
            evidence.squared_mm += row.length * squared * row.mm_per_px * row.mm_per_px;
            evidence.close_px += row.length * (-squared / 2.0).exp();
        }
    }
    let covariance = covariance(&normal.matrix, normal.scale_squared, buffers);
    Refined { pose, evidence, steps, still, covariance }
}
