//! One descent: from a start pose to the nearest pose whose outline lies on edges.

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
}

/// Factor of the search radius from step to step.
const SHRINK: f64 = 0.75;
/// Least cosine between the outline's normal and an edge's direction: 45 degrees while searching, 25 at the end.
const MIN_COSINE: (f64, f64) = (0.71, 0.906);
/// Distance of outline samples, px: while searching, and at the end.
const SPACING_PX: (f64, f64) = (4.0, 1.0);
/// Steps with the last search radius at most; most descents need five to ten.
const FINAL_STEPS: u32 = 30;
/// A descent ends when the centroid moves by less than this, mm, and the surface by turning as little.
const STILL_MM: f64 = 2e-4;
/// Largest step, mm of the centroid or of the surface by turning.
const LONGEST_STEP_MM: f64 = 12.0;
/// The robust weight's scale is never below this, px: below it are the differences between mesh and body.
const LEAST_SCALE_PX: f64 = 0.3;

/// What one view says of a pose.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Evidence {
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

/// Length along a contour over which residuals move together, px: smoothing of the image, noise of the mesh, and parts
/// of the outline that are off as a whole. Two residuals nearer than this say the same thing twice.
const CORRELATION_PX: f64 = 20.0;

/// Weighted normal equations of one step.
struct Normal {
    /// Sum of weight times row times row'.
    matrix: Matrix6<f64>,
    /// Sum of weight times row times residual.
    vector: Vector6<f64>,
    weight: f64,
    squared: f64,
}

/// Buffers of a descent, used again from step to step.
#[derive(Default)]
struct Buffers {
    outline: Outline,
    /// Residual in px, row, mm per px, weight (length in px).
    rows: Vec<(f64, Vector6<f64>, f64, f64)>,
    sizes: Vec<f64>,
}

/// Descends from `start`.
pub fn refine(mesh: &RimMesh, views: &[View], start: &Pose, params: &RefineParams) -> Refined {
    let mut buffers = Buffers::default();
    let mut pose = *start;
    let mut radius = params.search_px.max(params.final_search_px);
    let (mut steps, mut final_steps, mut still) = (0, 0, false);
    while final_steps < FINAL_STEPS && !still {
        let last = radius <= params.final_search_px;
        buffers.rows.clear();
        for view in views {
            collect(mesh, view, &pose, radius, last, params, &mut buffers);
        }
        let normal = normal_equations(&mut buffers, radius);
        let Some(twist) = solve(&normal, mesh.radius_of_gyration()) else { break };
        let center = pose.transform(mesh.centroid());
        pose = pose.moved(&twist, &center);
        steps += 1;
        let size = twist.translation.norm().max(twist.rotation.norm() * mesh.radius_of_gyration());
        if last {
            final_steps += 1;
            still = size < STILL_MM;
        }
        radius = (radius * SHRINK).max(params.final_search_px);
    }
    finish(mesh, views, pose, steps, still, params, &mut buffers)
}

/// Adds the residuals of one view; returns its evidence.
fn collect(
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
        let Some((_, derivative)) = view.fluoroscope.project_with_derivative(&point.world) else { continue };
        let gradient = derivative.transpose() * point.normal;
        let turn = (point.world - center).cross(&gradient);
        let row = Vector6::new(gradient.x, gradient.y, gradient.z, turn.x, turn.y, turn.z);
        let mm = view.fluoroscope.mm_per_px(point.depth);
        evidence.matched_px += length;
        evidence.squared += length * residual * residual;
        evidence.squared_mm += length * residual * residual * mm * mm;
        evidence.close_px += length * (-residual * residual / 2.0).exp();
        buffers.rows.push((residual, row, mm, length));
    }
    evidence
}

fn normal_equations(buffers: &mut Buffers, radius: f64) -> Normal {
    buffers.sizes.clear();
    buffers.sizes.extend(buffers.rows.iter().map(|r| r.0.abs()));
    let middle = buffers.sizes.len() / 2;
    let median = if buffers.sizes.is_empty() {
        0.0
    } else {
        *buffers.sizes.select_nth_unstable_by(middle, f64::total_cmp).1
    };
    // 1.4826 turns a median size into a standard deviation; residuals beyond about 2.5 of them lose their weight.
    let scale = (2.5 * 1.4826 * median).clamp(LEAST_SCALE_PX, (radius / 2.0).max(LEAST_SCALE_PX));
    let mut normal = Normal { matrix: Matrix6::zeros(), vector: Vector6::zeros(), weight: 0.0, squared: 0.0 };
    for (residual, row, mm, length) in &buffers.rows {
        let (s2, r2) = (scale * scale, residual * residual);
        let weight = length * mm * mm * (s2 / (s2 + r2)).powi(2);
        normal.matrix.syger(weight, row, row, 1.0);
        normal.vector += row * (weight * residual);
        normal.weight += weight;
        normal.squared += weight * r2;
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
    buffers.rows.clear();
    let evidence: Vec<Evidence> = views
        .iter()
        .map(|view| collect(mesh, view, &pose, params.final_search_px, true, params, buffers))
        .collect();
    let normal = normal_equations(buffers, params.final_search_px);
    // Six parameters were fitted to this many independent residuals.
    let independent: f64 = buffers.rows.iter().map(|r| r.3).sum::<f64>() / CORRELATION_PX;
    let variance = if normal.weight > 0.0 && independent > 7.0 {
        normal.squared / normal.weight * independent / (independent - 6.0)
    } else {
        f64::INFINITY
    };
    // Residuals within one correlation length are one observation: the sum of its rows' weights over the length.
    let mut spread = Matrix6::zeros();
    for (residual, row, mm, length) in &buffers.rows {
        let (s2, r2) = (LEAST_SCALE_PX * LEAST_SCALE_PX, residual * residual);
        let robust = (s2 / (s2 + r2)).powi(2);
        let weight = length * mm.powi(4) * robust * robust * CORRELATION_PX;
        spread.syger(weight, row, row, 1.0);
    }
    spread.fill_upper_triangle_with_lower_triangle();
    let covariance = normal
        .matrix
        .try_inverse()
        .map(|inverse| inverse * spread * inverse * variance)
        .filter(|c| c.iter().all(|v| v.is_finite()));
    Refined { pose, evidence, steps, still, covariance }
}
