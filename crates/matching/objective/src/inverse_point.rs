//! Iterative inverse point: rays from the source through the image's edge points against the signed distances of the surface (S. Lavallee and
//! R. Szeliski, "Recovering the position and orientation of free-form objects from image contours using 3D distance maps", 1995).
//!
//! Where the pose is right each ray of an outline touches the surface, so its least signed distance is zero: positive for a ray that passes by, negative
//! for one that goes through. No outline of the model is found at all; a view costs what its edge points cost, whatever the mesh. The
//! derivative is exact: where along the ray the least distance lies may move, but the distance does not change by that.
//!
//! In the last stage an edge counts only if its direction is that of the distance's growth in the picture, by the body's contrast.
//! **Not guaranteed:** sense in thin parts. Within a sheet the deepest place of a ray is half-way through, and residuals of rays that go far in say
//! little of how far.

use std::sync::Arc;

use biplane_geometry::{EdgePoint, Point3, Pose, Vector2, Vector3};
use biplane_optimiser::Row;
use nalgebra::Vector6;

use crate::edges::thinned;
use crate::kernel::{Kernel, Partner, Stage, settle};
use crate::motion::{Eye, by_twist};
use crate::{Body, DistanceField, NO_OUTLINE, Objective, Settings, Target};

/// Steps by which the least distance along a ray is narrowed down at most.
const ROUNDS: usize = 12;

/// The objective.
#[derive(Debug)]
pub struct InversePoint {
    field: Arc<DistanceField>,
    centroid: Point3,
    views: Vec<View>,
    settings: Settings,
    stage: usize,
    partners: Vec<Partner>,
}

#[derive(Debug)]
struct View {
    eye: Eye,
    /// Edge points and the directions of their rays, laboratory, unit.
    rays: Vec<(EdgePoint, Vector3)>,
    mm_per_px: f64,
}

/// Where a ray comes closest to the surface, or is deepest in it.
struct Closest {
    /// Model, mm.
    at: Point3,
    distance: f64,
    gradient: Vector3,
}

impl InversePoint {
    /// Of the edges of each view; makes the body's field if it has none.
    pub fn new(body: &Body<'_>, targets: &[Target], settings: &Settings) -> Self {
        let view = |t: &Target| {
            let eye = Eye::new(&t.fluoroscope);
            let ray = |p: EdgePoint| Some((p, eye.direction(&p.position).try_normalize(0.0)?));
            View {
                rays: thinned(t, settings.spacing_px).into_iter().filter_map(ray).collect(),
                eye,
                mm_per_px: t.mm_per_px,
            }
        };
        Self {
            field: body.field.clone().unwrap_or_else(|| Arc::new(DistanceField::new(body.mesh))),
            centroid: *body.rim.centroid(),
            views: targets.iter().map(view).collect(),
            settings: *settings,
            stage: settings.stages.max(1) - 1,
            partners: Vec::new(),
        }
    }

    fn evaluate(&mut self, pose: &Pose, mut rows: Option<&mut Vec<Row>>) -> f64 {
        let centre = pose.transform(&self.centroid);
        let back = pose.inverse();
        let rotation = pose.rotation().to_rotation_matrix();
        let (middle, reach) = self.field.ball();
        let stage = Stage::of(&self.settings, self.stage);
        let mut sum = 0.0;
        for view in &self.views {
            if view.rays.is_empty() {
                sum += NO_OUTLINE;
                continue;
            }
            let share = 1.0 / view.rays.len() as f64;
            let kernel = Kernel::new(stage.scale_px * view.mm_per_px);
            let reach_mm = stage.reach_px * view.mm_per_px;
            self.partners.clear();
            let mut alone = 0.0;
            let source = back.transform(view.eye.fluoroscope.source());
            let across = view.eye.across();
            for (edge, direction) in &view.rays {
                let ray = rotation.inverse() * direction;
                let middle_s = (middle - source).dot(&ray);
                let ends = [(middle_s - reach).max(0.0), middle_s + reach];
                let Some(found) = closest(&self.field, &source, &ray, ends, reach_mm) else {
                    alone += share;
                    continue;
                };
                let gradient = rotation * found.gradient;
                let growth = Vector2::new(across[0].dot(&gradient), across[1].dot(&gradient));
                let along = growth.dot(&edge.direction) * self.settings.contrast;
                // Far off, the nearest part of a body is often another one than the edge is of.
                let against = stage.last && along < stage.cosine * growth.norm();
                if against {
                    alone += share;
                    continue;
                }
                let derivative = match rows {
                    // The body moves, the ray stays.
                    Some(_) => -by_twist(&gradient, &pose.transform(&found.at), &centre),
                    None => Vector6::zeros(),
                };
                self.partners.push(Partner { residual: found.distance, share, derivative });
            }
            sum += settle(kernel, &self.partners, stage.inset_px * view.mm_per_px, rows.as_deref_mut());
            sum += alone * kernel.value(reach_mm);
        }
        sum
    }
}

/// The least distance along a ray (unit, model) between two places on it; `None` where it is farther from zero than `reach`.
fn closest(
    field: &DistanceField,
    source: &Point3,
    ray: &Vector3,
    [from, to]: [f64; 2],
    reach: f64,
) -> Option<Closest> {
    let place = |s: f64| source + ray * s;
    // A distance falls by no more than the way, so what is far from the surface is passed quickly.
    let step = 1.5 * field.cell_mm();
    let (mut best, mut least) = (from, f64::INFINITY);
    let mut s = from;
    while s <= to {
        let distance = field.linear(&place(s));
        if distance < least {
            (best, least) = (s, distance);
        }
        s += (distance - least).max(step);
    }
    // Between places of the first look the distance differs by no more than the way.
    if least.abs() > reach + step {
        return None;
    }
    let look = |s: f64| {
        let (distance, gradient) = field.cubic(&place(s));
        (Closest { at: place(s), distance, gradient }, gradient.dot(ray))
    };
    let within = |found: Closest| (found.distance.abs() <= reach).then_some(found);
    // The derivative changes its sign between the places beside: secants that keep to both sides (Illinois).
    let (mut a, mut b) = (best - step, best + step);
    let (mut slope_a, mut slope_b) = (look(a).1, look(b).1);
    let mut found = look(best);
    if slope_a >= 0.0 || slope_b <= 0.0 {
        return within(found.0);
    }
    // +1 where the last place was on the side of `b`, -1 on that of `a`.
    let mut side = 0;
    for _ in 0..ROUNDS {
        let s = (a * slope_b - b * slope_a) / (slope_b - slope_a);
        found = look(s);
        let slope = found.1;
        if slope.abs() < 1e-6 {
            break;
        }
        if slope < 0.0 {
            (a, slope_a) = (s, slope);
            slope_b *= if side == -1 { 0.5 } else { 1.0 };
            side = -1;
        } else {
            (b, slope_b) = (s, slope);
            slope_a *= if side == 1 { 0.5 } else { 1.0 };
            side = 1;
        }
    }
    within(found.0)
}

impl Objective for InversePoint {
    fn value(&mut self, pose: &Pose) -> f64 {
        self.evaluate(pose, None)
    }

    fn linearise(&mut self, pose: &Pose, rows: &mut Vec<Row>) -> Option<f64> {
        Some(self.evaluate(pose, Some(rows)))
    }

    fn stages(&self) -> usize {
        self.settings.stages.max(1)
    }

    fn enter(&mut self, stage: usize) {
        self.stage = stage;
    }
}
