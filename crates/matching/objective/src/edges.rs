//! Distances of the image's edges from the model's outline, and of the outline from edges, with direction and robust weights.
//!
//! **Image to model.** Each edge point looks for the nearest point of the visible outline whose normal runs as the edge's direction does, by the
//! body's contrast. An edge that is missing from the image costs nothing, so missing contour does not pull the pose away; a wrong edge costs
//! no more than the robust function's scale. The derivative is exact: the nearest point may slide, but the distance does not change by that.
//!
//! **Symmetric.** The mean of this and of the outline's points to edges (as `method = "rim"` measures), which alone says that outline without any
//! edge is wrong.
//!
//! **Not in it:** a bias of edges to one side of the outline; `method = "rim"` solves for it.

use biplane_edge_field::EdgeField;
use biplane_geometry::{EdgePoint, Point2, Point3, Pose};
use biplane_optimiser::Row;
use biplane_outline::{Outline, RimMesh, Sampling};

use crate::kernel::{Kernel, min_cosine, scale_px};
use crate::motion::Eye;
use crate::near::Near;
use crate::{Body, NO_OUTLINE, Objective, Settings, Target};

/// The objective.
#[derive(Debug)]
pub struct EdgeDistance<'a> {
    rim: &'a RimMesh,
    views: Vec<View>,
    settings: Settings,
    /// Share of the outline's points to edges, 0 to 1.
    from_model: f64,
    stage: usize,
    outline: Outline,
    near: Near,
}

#[derive(Debug)]
struct View {
    eye: Eye,
    /// Edge points about the spacing apart.
    points: Vec<EdgePoint>,
    field: EdgeField,
    mm_per_px: f64,
}

/// Points of curves, so many px apart along each.
pub(crate) fn thinned(target: &Target, spacing_px: f64) -> Vec<EdgePoint> {
    let mut kept = Vec::new();
    for curve in &target.curves.0 {
        let mut passed = f64::INFINITY;
        let mut last = None;
        for p in &curve.points {
            if !p.position.coords.iter().chain(p.direction.iter()).all(|v| v.is_finite()) {
                continue;
            }
            passed += last.map_or(0.0, |last: Point2| (p.position - last).norm());
            last = Some(p.position);
            if passed >= spacing_px {
                passed = 0.0;
                kept.push(*p);
            }
        }
    }
    kept
}

impl<'a> EdgeDistance<'a> {
    /// Of edges to outline, and with the share `from_model` (0 to 1) of outline to edges.
    pub fn new(body: &Body<'a>, targets: &[Target], settings: &Settings, from_model: f64) -> Self {
        let view = |t: &Target| View {
            eye: Eye::new(&t.fluoroscope),
            points: thinned(t, settings.spacing_px),
            field: EdgeField::new(&t.curves, None),
            mm_per_px: t.mm_per_px,
        };
        Self {
            rim: body.rim,
            views: targets.iter().map(view).collect(),
            settings: *settings,
            from_model,
            stage: settings.stages.max(1) - 1,
            outline: Outline::new(),
            near: Near::default(),
        }
    }

    fn evaluate(&mut self, pose: &Pose, mut rows: Option<&mut Vec<Row>>) -> f64 {
        let Self { rim, views, settings, from_model, stage, outline, near } = self;
        let centre = pose.transform(rim.centroid());
        let mut sum = 0.0;
        for view in views.iter() {
            let sampling = Sampling { step_px: settings.spacing_px };
            outline.trace(rim, pose, &view.eye.fluoroscope, sampling);
            if outline.points().len() < 2 || view.points.is_empty() {
                sum += NO_OUTLINE;
                continue;
            }
            let compare = Compare {
                view,
                outline,
                centre,
                kernel: Kernel::new(scale_px(settings, *stage) * view.mm_per_px),
                reach: settings.reach_px,
                cosine: min_cosine(settings, *stage),
                contrast: settings.contrast,
            };
            if *from_model < 1.0 {
                near.fill(outline.points());
                let share = 1.0 - *from_model;
                sum += share * compare.image_to_model(near, share, rows.as_deref_mut());
            }
            if *from_model > 0.0 {
                sum += *from_model * compare.model_to_image(*from_model, rows.as_deref_mut());
            }
        }
        sum
    }
}

/// One view at one pose.
struct Compare<'v> {
    view: &'v View,
    outline: &'v Outline,
    centre: Point3,
    kernel: Kernel,
    reach: f64,
    cosine: f64,
    contrast: f64,
}

impl Compare<'_> {
    /// What a point without a partner counts.
    fn alone(&self) -> f64 {
        self.kernel.value(self.reach * self.view.mm_per_px)
    }

    fn image_to_model(&self, near: &Near, share: f64, mut rows: Option<&mut Vec<Row>>) -> f64 {
        let (view, samples) = (self.view, self.outline.points());
        let each = 1.0 / view.points.len() as f64;
        let mut sum = 0.0;
        for edge in &view.points {
            let normal = edge.direction * self.contrast;
            let Some(foot) = near.nearest(samples, &edge.position, &normal, self.reach, self.cosine) else {
                sum += each * self.alone();
                continue;
            };
            let sample = &samples[foot.sample];
            let off = edge.position - foot.pixel;
            // Along the normal, with its sign; at the end of a piece of outline, along the way.
            let (px, along) = if foot.inside || foot.distance < 1e-9 {
                (off.dot(&sample.normal), sample.normal)
            } else {
                (foot.distance, off / foot.distance)
            };
            let residual = px * view.mm_per_px;
            sum += each * self.kernel.value(residual);
            if let Some(rows) = &mut rows {
                let world = view.eye.point(&foot.pixel, sample.depth);
                let speed = view.eye.pixel_by_twist(&world, &along, &self.centre);
                rows.push(Row {
                    residual,
                    weight: share * each * self.kernel.weight(residual),
                    derivative: speed * -view.mm_per_px,
                });
            }
        }
        sum
    }

    fn model_to_image(&self, share: f64, mut rows: Option<&mut Vec<Row>>) -> f64 {
        let view = self.view;
        let (mut sum, mut length) = (0.0, 0.0);
        let first = rows.as_deref().map_or(0, Vec::len);
        for p in self.outline.points() {
            // What lies beside the picture cannot have an edge.
            if !view.eye.fluoroscope.on_image(&p.pixel, 2.0) {
                continue;
            }
            length += p.length_px;
            let direction = p.normal * self.contrast;
            let Some(edge) = view.field.nearest(&p.pixel, &direction, self.reach, self.cosine) else {
                sum += p.length_px * self.alone();
                continue;
            };
            // Where the outline's normal meets the edge's tangent, but no farther than the edge point itself.
            let across = edge.direction * self.contrast;
            let off = edge.position - p.pixel;
            let px = (across.dot(&off) / across.dot(&p.normal)).clamp(-off.norm(), off.norm());
            let residual = px * view.mm_per_px;
            sum += p.length_px * self.kernel.value(residual);
            if let Some(rows) = &mut rows {
                let speed = view.eye.pixel_by_twist(&p.world, &p.normal, &self.centre);
                rows.push(Row {
                    residual,
                    weight: share * p.length_px * self.kernel.weight(residual),
                    derivative: speed * -view.mm_per_px,
                });
            }
        }
        if length <= 0.0 {
            return NO_OUTLINE;
        }
        for row in rows.into_iter().flat_map(|rows| rows.iter_mut().skip(first)) {
            row.weight /= length;
        }
        sum / length
    }
}

impl Objective for EdgeDistance<'_> {
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
