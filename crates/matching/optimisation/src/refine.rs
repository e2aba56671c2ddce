//! One descent: from a start pose to the nearest pose whose outline lies on edges.
//!
//! Each view has one nuisance parameter beside the six of the pose: its **inset**, by which the image's edges lie inside
//! the outline as a whole. At the rim of a smooth body the path of a ray starts from zero, so the steepest gradient lies
//! inside the true outline, and smoothing adds to it: 0.37 to 0.60 px on the example study (`A_inset_px` and `B_inset_px`
//! in its `results/poses.csv`). Left in the residuals, that bias turned the femoral component by 0.22 degrees in the median;
//! with the inset solved for it is 0.07 (`cargo xtask validate --only simulated`, with and without `inset_px = 0.0` under `[match]` in
//! `pipeline.toml`). The inset is eliminated from the normal equations, so a step stays 6 x 6.

use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Pose, Twist, Vector3};
use biplane_outline::{Outline, RimMesh, Sampling};
use nalgebra::{Matrix6, Vector6};

use crate::EdgeField;

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
    /// Residuals of about this size are never taken for outliers, px. Differences between mesh and body ([`LEAST_SCALE_PX`]), or
    /// what a calibration that is not sure makes of them.
    pub least_scale_px: f64,
}

/// Factor of the search radius from step to step.
const SHRINK: f64 = 0.75;
/// Least cosine between the outline's normal and an edge's direction: 45 degrees while searching, 25 at the end.
const MIN_COSINE: (f64, f64) = (0.71, 0.906);
/// Distance of outline samples, px: while searching, and at the end.
const SPACING_PX: (f64, f64) = (4.0, 1.0);
/// A descent whose last steps swing by no more than this, mm, because samples change their edge point, has come to rest too.
const SWING_MM: f64 = 0.01;
/// Largest step, mm of the centroid or of the surface by turning.
const LONGEST_STEP_MM: f64 = 12.0;
/// The robust weight's scale is never below this, px: below it are the differences between mesh and body.
pub(crate) const LEAST_SCALE_PX: f64 = 0.3;

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

/// Length along a contour over which residuals move together, px: they are differences between mesh and body, and edges
/// beside bone or cement that are off as a whole, not noise of single pixels. Two residuals nearer than this say the same
/// thing twice. 150 px gives a mean squared error over the stated covariance of 6.8 (femoral component) and 3.8 (tray) on
/// the simulated knee, where 6 would be right (`cargo xtask validate --only simulated`).
pub(crate) const CORRELATION_PX: f64 = 150.0;

/// One outline sample that found an edge.
pub(crate) struct Row {
    /// Along the outline's normal, px.
    pub(crate) residual: f64,
    /// Its derivative by the twist, px per mm and px per rad.
    pub(crate) derivative: Vector6<f64>,
    /// Size of a pixel at its depth.
    mm_per_px: f64,
    /// Length of the outline it stands for, px.
    pub(crate) length: f64,
}

/// Weighted normal equations of one step, in mm^2: sums over rows of weight, derivative and residual.
struct Normal {
    matrix: Matrix6<f64>,
    vector: Vector6<f64>,
    weight: f64,
    squared: f64,
    /// Square of the robust weight's scale, px^2.
    scale_squared: f64,
}

/// Buffers of a descent, used again from step to step.
#[derive(Default)]
pub(crate) struct Buffers {
    outline: Outline,
    rows: Vec<Row>,
    /// Rows of each view: where they end, and the view's inset.
    views: Vec<(usize, f64)>,
    sizes: Vec<f64>,
}

impl Buffers {
    /// The rows of each view with its inset.
    pub(crate) fn by_view(&self) -> impl Iterator<Item = (&[Row], f64)> {
        let starts = std::iter::once(0).chain(self.views.iter().map(|v| v.0));
        starts.zip(&self.views).map(|(start, &(end, inset))| (&self.rows[start..end], inset))
    }
}

/// Descends from `start`.
pub fn refine(mesh: &RimMesh, views: &[View], start: &Pose, params: &RefineParams) -> Refined {
    let mut buffers = Buffers::default();
    let mut pose = *start;
    let mut radius = params.search_px.max(params.final_search_px);
    let (mut steps, mut final_steps, mut still) = (0, 0, false);
    while final_steps < params.most_steps && !still {
        let last = radius <= params.final_search_px;
        collect(mesh, views, &pose, radius, last, params, &mut buffers);
        let normal = normal_equations(&mut buffers, radius, params);
        let Some(twist) = solve(&normal, mesh.radius_of_gyration()) else { break };
        let center = pose.transform(mesh.centroid());
        pose = pose.moved(&twist, &center);
        steps += 1;
        let size = twist.translation.norm().max(twist.rotation.norm() * mesh.radius_of_gyration());
        if last {
            final_steps += 1;
            still = size < params.still_mm || (final_steps == params.most_steps && size < SWING_MM);
        }
        radius = (radius * SHRINK).max(params.final_search_px);
    }
    finish(mesh, views, pose, steps, still, params, &mut buffers)
}

/// What the views say of a pose as it stands: no step is taken.
pub fn assess(mesh: &RimMesh, views: &[View], pose: &Pose, params: &RefineParams) -> Refined {
    finish(mesh, views, *pose, 0, true, params, &mut Buffers::default())
}

/// Fills the rows of all views.
pub(crate) fn collect(
    mesh: &RimMesh,
    views: &[View],
    pose: &Pose,
    radius: f64,
    last: bool,
    params: &RefineParams,
    buffers: &mut Buffers,
) -> Vec<Evidence> {
    buffers.rows.clear();
    buffers.views.clear();
    let mut evidence = Vec::with_capacity(views.len());
    for view in views {
        evidence.push(collect_view(mesh, view, pose, radius, last, params, buffers));
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
    evidence
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
    mesh: &RimMesh,
    view: &View,
    pose: &Pose,
    radius: f64,
    last: bool,
    params: &RefineParams,
    buffers: &mut Buffers,
) -> Evidence {
    let pick = |pair: (f64, f64)| if last { pair.1 } else { pair.0 };
    let (spacing, min_cosine) = (pick(SPACING_PX), pick(MIN_COSINE));
    buffers.outline.trace(mesh, pose, &view.fluoroscope, Sampling { step_px: spacing });
    let center = pose.transform(mesh.centroid());
    let mut evidence = Evidence::default();
    let mut passed = 0.0;
    for point in buffers.outline.points() {
        evidence.outline_px += point.length_px;
        // Many short rim edges: one sample stands for all that were passed since the last one.
        passed += point.length_px;
        if passed < 0.99 * spacing {
            continue;
        }
        let length = std::mem::take(&mut passed);
        if !view.fluoroscope.on_image(&point.pixel, 2.0) {
            continue;
        }
        evidence.in_image_px += length;
        let direction = point.normal * params.contrast;
        let Some(edge) = view.edges.nearest(&point.pixel, &direction, radius, min_cosine) else { continue };
        // Where the outline's normal meets the edge's tangent.
        let across = edge.direction * params.contrast;
        let residual = across.dot(&(edge.position - point.pixel)) / across.dot(&point.normal);
        if residual.abs() > radius {
            continue;
        }
        let Some((_, by_point)) = view.fluoroscope.project_with_derivative(&point.world) else { continue };
        let gradient = by_point.transpose() * point.normal;
        let turn = (point.world - center).cross(&gradient);
        evidence.matched_px += length;
        buffers.rows.push(Row {
            residual,
            derivative: Vector6::new(gradient.x, gradient.y, gradient.z, turn.x, turn.y, turn.z),
            mm_per_px: view.fluoroscope.mm_per_px(point.depth),
            length,
        });
    }
    evidence
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

fn normal_equations(buffers: &mut Buffers, radius: f64, params: &RefineParams) -> Normal {
    let inset_px = params.inset_px;
    let scale_squared = robust_scale_squared(buffers, radius, params.least_scale_px);
    let mut normal = Normal {
        matrix: Matrix6::zeros(),
        vector: Vector6::zeros(),
        weight: 0.0,
        squared: 0.0,
        scale_squared,
    };
    for (rows, inset) in buffers.by_view() {
        // Sums over the view of weight, weight times residual, weight times derivative: its inset's row.
        let (mut sum, mut sum_residual, mut sum_derivative) = (0.0, 0.0, Vector6::zeros());
        let mut prior = 0.0;
        for row in rows {
            let left = row.residual - inset;
            let mm2 = row.mm_per_px * row.mm_per_px;
            let weight = row.length * mm2 * robust_weight(normal.scale_squared, left);
            normal.matrix.syger(weight, &row.derivative, &row.derivative, 1.0);
            normal.vector += row.derivative * (weight * row.residual);
            normal.weight += weight;
            normal.squared += weight * left * left;
            sum += weight;
            sum_residual += weight * row.residual;
            sum_derivative += row.derivative * weight;
            prior = mm2;
        }
        if inset_px > 0.0 && sum > 0.0 {
            // What is known of the inset beforehand counts as much as one correlation length of residuals would.
            let known = CORRELATION_PX * prior * (LEAST_SCALE_PX / inset_px).powi(2);
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

fn finish(
    mesh: &RimMesh,
    views: &[View],
    pose: Pose,
    steps: u32,
    still: bool,
    params: &RefineParams,
    buffers: &mut Buffers,
) -> Refined {
    let mut evidence = collect(mesh, views, &pose, params.final_search_px, true, params, buffers);
    let normal = normal_equations(buffers, params.final_search_px, params);
    for ((rows, inset), evidence) in buffers.by_view().zip(&mut evidence) {
        evidence.inset_px = -inset;
        for row in rows {
            let squared = (row.residual - inset).powi(2);
            evidence.squared += row.length * squared;
            evidence.squared_mm += row.length * squared * row.mm_per_px * row.mm_per_px;
            evidence.close_px += row.length * (-squared / 2.0).exp();
        }
    }
    let covariance = covariance(&normal, buffers);
    Refined { pose, evidence, steps, still, covariance }
}

/// Covariance of the pose from the residuals: a sandwich in which residuals within one correlation length are one
/// observation. The inset's own uncertainty is in the normal matrix already.
fn covariance(normal: &Normal, buffers: &Buffers) -> Option<Matrix6<f64>> {
    // Six of the pose and one inset a view were fitted to the samples.
    let (samples, fitted) = (buffers.rows.len() as f64, 6.0 + buffers.views.len() as f64);
    if normal.weight <= 0.0 || samples <= fitted {
        return None;
    }
    let variance = normal.squared / normal.weight * samples / (samples - fitted);
    let mut spread = Matrix6::zeros();
    for (rows, inset) in buffers.by_view() {
        let (mut sum, mut mean) = (0.0, Vector6::zeros());
        for row in rows {
            let weight = row.length * robust_weight(normal.scale_squared, row.residual - inset);
            mean += row.derivative * weight;
            sum += weight;
        }
        if sum > 0.0 {
            mean /= sum;
        }
        for row in rows {
            let robust = robust_weight(normal.scale_squared, row.residual - inset);
            let weight = row.length * row.mm_per_px.powi(4) * robust * robust * CORRELATION_PX;
            let own = row.derivative - mean;
            spread.syger(weight, &own, &own, 1.0);
        }
    }
    spread.fill_upper_triangle_with_lower_triangle();
    let inverse = normal.matrix.try_inverse()?;
    Some(inverse * spread * inverse * variance).filter(|c| c.iter().all(|v| v.is_finite()))
}
