//! Area that lies under the model's shadow or within the contour but not both, over the contour's length: about the mean distance of the two
//! outlines, mm (as S. Banks and W. Hodge judge template matches, "Accurate measurement of three-dimensional knee replacement kinematics using
//! single-plane fluoroscopy", 1996).
//!
//! It needs no partner for any point and sees any distance. Contours that are closed surround what they surround; open pieces do as [`Region`] says.
//! The gradient is exact: as the outline moves by `d` along its normal, the area grows by `d` times its length where it lies outside the
//! contour and shrinks by as much where it lies inside.

use biplane_edge_field::EdgeField;
use biplane_geometry::{Point3, Pose};
use biplane_optimiser::Row;
use biplane_outline::{Outline, RimMesh, Sampling};

use crate::motion::Eye;
use crate::shadow::Spans;
use crate::{Body, NO_OUTLINE, Objective, ObjectiveError, Region, Settings, Shadow, Target};

/// Distances below it weigh as this one, px: the weight of a distance's square is its reciprocal.
const LEAST_PX: f64 = 1e-2;

/// The objective.
#[derive(Debug)]
pub struct NonOverlap<'a> {
    shadow: Shadow,
    rim: &'a RimMesh,
    views: Vec<View>,
    step_px: f64,
    reach_px: f64,
    spans: Spans,
    outline: Outline,
}

#[derive(Debug)]
struct View {
    eye: Eye,
    region: Region,
    field: EdgeField,
    mm_per_px: f64,
}

impl<'a> NonOverlap<'a> {
    /// Of the contours of each view.
    ///
    /// # Errors
    /// [`ObjectiveError::NoArea`] for a view whose contours surround nothing.
    pub fn new(body: &Body<'a>, targets: &[Target], settings: &Settings) -> Result<Self, ObjectiveError> {
        let view = |(number, t): (usize, &Target)| {
            let region = Region::new(&t.curves, t.fluoroscope.size(), settings.contrast);
            Ok(View {
                eye: Eye::new(&t.fluoroscope),
                region: region.ok_or(ObjectiveError::NoArea(number + 1))?,
                field: EdgeField::new(&t.curves, None),
                mm_per_px: t.mm_per_px,
            })
        };
        Ok(Self {
            shadow: Shadow::new(body.mesh),
            rim: body.rim,
            views: targets.iter().enumerate().map(view).collect::<Result<_, _>>()?,
            step_px: settings.spacing_px,
            reach_px: settings.reach_px,
            spans: Spans::default(),
            outline: Outline::new(),
        })
    }

    fn evaluate(&mut self, pose: &Pose, mut rows: Option<&mut Vec<Row>>) -> f64 {
        let centre = pose.transform(self.rim.centroid());
        let mut sum = 0.0;
        for view in &self.views {
            let cast = self.shadow.cast(pose, &view.eye.fluoroscope, &mut self.spans);
            if cast.is_none() || self.spans.spans().is_empty() {
                sum += NO_OUTLINE;
                continue;
            }
            // An area over a length: mm for mm_per_px times px.
            let unit = view.mm_per_px / view.region.length_px();
            sum += unit * not_shared(self.spans.spans(), view.region.spans());
            if let Some(rows) = &mut rows {
                self.outline.trace(self.rim, pose, &view.eye.fluoroscope, Sampling { step_px: self.step_px });
                rows_of_outline(view, &self.outline, &centre, self.reach_px, rows);
            }
        }
        sum
    }
}

/// The outline's points, each with how far it lies outside the contour (negative inside).
fn rows_of_outline(view: &View, outline: &Outline, centre: &Point3, reach_px: f64, rows: &mut Vec<Row>) {
    for p in outline.points().iter().filter(|p| view.eye.fluoroscope.on_image(&p.pixel, 0.0)) {
        let sign = if view.region.holds(&p.pixel) { -1.0 } else { 1.0 };
        let nearest = view.field.nearest(&p.pixel, &p.normal, reach_px, -1.0);
        let px = nearest.map_or(reach_px, |e| (e.position - p.pixel).norm()).max(LEAST_PX);
        let speed = view.eye.pixel_by_twist(&p.world, &p.normal, centre);
        rows.push(Row {
            residual: sign * px * view.mm_per_px,
            weight: p.length_px / (view.region.length_px() * px * view.mm_per_px),
            derivative: speed * view.mm_per_px,
        });
    }
}

/// Total length of the spans that lie in one list alone.
fn not_shared(a: &[(u32, [f64; 2])], b: &[(u32, [f64; 2])]) -> f64 {
    let total = |spans: &[(u32, [f64; 2])]| spans.iter().map(|(_, [from, to])| to - from).sum::<f64>();
    let (mut i, mut j, mut shared) = (0, 0, 0.0);
    while let (Some((row_a, [from_a, to_a])), Some((row_b, [from_b, to_b]))) = (a.get(i), b.get(j)) {
        if row_a == row_b {
            shared += (to_a.min(*to_b) - from_a.max(*from_b)).max(0.0);
        }
        if (row_a, *to_a) < (row_b, *to_b) { i += 1 } else { j += 1 }
    }
    total(a) + total(b) - 2.0 * shared
}

impl Objective for NonOverlap<'_> {
    fn value(&mut self, pose: &Pose) -> f64 {
        self.evaluate(pose, None)
    }

    fn linearise(&mut self, pose: &Pose, rows: &mut Vec<Row>) -> Option<f64> {
        Some(self.evaluate(pose, Some(rows)))
    }
}
