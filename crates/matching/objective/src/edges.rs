//! Distances of the image's edges from the model's outline, and of the outline from edges, with direction and robust weights.
//!
//! **Image to model.** Each edge point looks for the nearest point of the visible outline whose normal runs as the edge's direction does, by the
//! body's contrast. An edge that is missing from the image costs nothing, so missing contour does not pull the pose away; a wrong edge costs
//! no more than the robust function's scale. The derivative is exact: the nearest point may slide, but the distance does not change by that.
//!
//! **Symmetric.** The mean of this and of the outline's points to edges (as `method = "rim"` measures), which alone says that outline without any
//! edge is wrong.
//!
//! In the last stage the edges of a view may lie inside the outline as a whole, as X-ray edges do, by what makes the sum least
//! ([`Settings::inset_px`]).

use biplane_edge_field::EdgeField;
use biplane_geometry::{EdgePoint, Point2, Point3, Pose, Vector2};
use biplane_optimiser::Row;
use biplane_outline::{Outline, RimMesh, Sampling};
use nalgebra::Vector6;

use crate::kernel::{Kernel, Partner, Stage, settle};
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
    partners: Vec<Partner>,
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
            partners: Vec::new(),
        }
    }

    fn evaluate(&mut self, pose: &Pose, mut rows: Option<&mut Vec<Row>>) -> f64 {
        let Self { rim, views, settings, from_model, stage, outline, near, partners } = self;
        let centre = pose.transform(rim.centroid());
        let stage = Stage::of(settings, *stage);
        let mut sum = 0.0;
        for view in views.iter() {
            outline.trace(rim, pose, &view.eye.fluoroscope, Sampling { step_px: settings.spacing_px });
            if outline.points().len() < 2 || view.points.is_empty() {
                sum += NO_OUTLINE;
                continue;
            }
            let kernel = Kernel::new(stage.scale_px * view.mm_per_px);
            let with_rows = rows.is_some();
            let compare = Compare { view, outline, centre, stage, contrast: settings.contrast, with_rows };
            partners.clear();
            let mut alone = 0.0;
            if *from_model < 1.0 {
                near.fill(outline.points());
                alone += compare.image_to_model(near, 1.0 - *from_model, partners);
            }
            if *from_model > 0.0 {
                match compare.model_to_image(*from_model, partners) {
                    Some(share) => alone += share,
                    None => {
                        sum += NO_OUTLINE;
                        continue;
                    }
                }
            }
            sum += settle(kernel, partners, stage.inset_px * view.mm_per_px, rows.as_deref_mut());
            sum += alone * kernel.value(stage.reach_px * view.mm_per_px);
        }
        sum
    }
}

/// One view at one pose.
struct Compare<'v> {
    view: &'v View,
    outline: &'v Outline,
    centre: Point3,
    stage: Stage,
    contrast: f64,
    with_rows: bool,
}

impl Compare<'_> {
    fn speed(&self, world: &Point3, along: &Vector2) -> Vector6<f64> {
        if !self.with_rows {
            return Vector6::zeros();
        }
        self.view.eye.pixel_by_twist(world, along, &self.centre) * -self.view.mm_per_px
    }

    /// Adds the partners of edge points, which count `whole` together; the share of those without one.
    fn image_to_model(&self, near: &Near, whole: f64, partners: &mut Vec<Partner>) -> f64 {
        let (view, samples, stage) = (self.view, self.outline.points(), &self.stage);
        let share = whole / view.points.len() as f64;
        let mut alone = 0.0;
        for edge in &view.points {
            let normal = edge.direction * self.contrast;
            let Some(foot) = near.nearest(samples, &edge.position, &normal, stage.reach_px, stage.cosine)
            else {
                alone += share;
                continue;
            };
            let sample = &samples[foot.sample];
            let off = edge.position - foot.pixel;
            // Along the normal, with its sign; at the end of a piece of outline, along the way.
            let (px, along) = if foot.inside || foot.distance < 1e-9 {
                (off.dot(&sample.normal), sample.normal)
            } else {
                let outward = if off.dot(&sample.normal) < 0.0 { -1.0 } else { 1.0 };
                (outward * foot.distance, off * (outward / foot.distance))
            };
            let world = view.eye.point(&foot.pixel, sample.depth);
            let derivative = self.speed(&world, &along);
            partners.push(Partner { residual: px * view.mm_per_px, share, derivative });
        }
        alone
    }

    /// Adds the partners of the outline's points on the picture, which count `whole` together; the share of those without one, or `None` if none is
    /// on the picture.
    fn model_to_image(&self, whole: f64, partners: &mut Vec<Partner>) -> Option<f64> {
        let (view, stage) = (self.view, &self.stage);
        let first = partners.len();
        let (mut alone, mut length) = (0.0, 0.0);
        for p in self.outline.points() {
            // What lies beside the picture cannot have an edge.
            if !view.eye.fluoroscope.on_image(&p.pixel, 2.0) {
                continue;
            }
            length += p.length_px;
            let direction = p.normal * self.contrast;
            let Some(edge) = view.field.nearest(&p.pixel, &direction, stage.reach_px, stage.cosine) else {
                alone += p.length_px;
                continue;
            };
            // Where the outline's normal meets the edge's tangent, but no farther than the edge point itself.
            let across = edge.direction * self.contrast;
            let off = edge.position - p.pixel;
            let px = (across.dot(&off) / across.dot(&p.normal)).clamp(-off.norm(), off.norm());
            let derivative = self.speed(&p.world, &p.normal);
            partners.push(Partner { residual: px * view.mm_per_px, share: p.length_px, derivative });
        }
        let share = whole / length;
        partners[first..].iter_mut().for_each(|p| p.share *= share);
        (length > 0.0).then_some(alone * share)
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
