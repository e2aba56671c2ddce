//! Distance of the outline from the spline through the contour within its trusted range: the thesis's objective (Eqs. 3.4 to 3.6, listing A.2.1).
//!
//! The mean over the outline's points in each view, summed over the views; a view with fewer than two points counts [`NO_OUTLINE`]. The outline is
//! the thesis's own of a grid, so many points evenly along it, or the exact one of the rim, each point for the length that it stands for.
//! Neither direction nor robust weights: each curve attracts, and outline that the image does not show pulls the pose away.

use biplane_artifact::Curves;
use biplane_geometry::{Point2, Point3, Pose};
use biplane_optimiser::Row;
use biplane_outline::{GridOutline, Outline, RimMesh, Sampling};
use biplane_spline::{FootFinder, Piece, Spline};

use crate::motion::Eye;
use crate::{Body, NO_OUTLINE, Objective, Settings, Target};

/// Distances below it weigh as this one, px: the weight of a distance's square is its reciprocal.
const LEAST_PX: f64 = 1e-3;

/// The pieces of contour that curves are: splines through their points, trusted all along. Curves of fewer than two points (three of a closed one)
/// that differ are none.
pub fn pieces(curves: &Curves) -> Vec<Piece> {
    let spline = |curve: &biplane_geometry::Curve| {
        let points: Vec<Point2> = curve.points.iter().map(|p| p.position).collect();
        Spline::through(&points, curve.closed).ok()
    };
    curves.0.iter().filter_map(spline).map(Piece::whole).collect()
}

/// The objective.
#[derive(Debug)]
pub struct SplineDistance<'a> {
    source: Source<'a>,
    centroid: Point3,
    views: Vec<View>,
}

#[derive(Debug)]
enum Source<'a> {
    Grid { points: &'a [Point3], grid: usize, most: usize, outline: GridOutline },
    Rim { rim: &'a RimMesh, step_px: f64, outline: Outline },
}

#[derive(Debug)]
struct View {
    eye: Eye,
    contour: FootFinder,
    mm_per_px: f64,
}

impl<'a> SplineDistance<'a> {
    /// Of the thesis's outline.
    pub fn of_grid(body: &Body<'a>, targets: &[Target], settings: &Settings) -> Self {
        let (points, grid, most) = (body.mesh.vertices(), settings.grid, settings.outline_points.max(2));
        Self::new(Source::Grid { points, grid, most, outline: GridOutline::new() }, body, targets)
    }

    /// Of the exact outline.
    pub fn of_rim(body: &Body<'a>, targets: &[Target], settings: &Settings) -> Self {
        let step_px = settings.spacing_px;
        Self::new(Source::Rim { rim: body.rim, step_px, outline: Outline::new() }, body, targets)
    }

    fn new(source: Source<'a>, body: &Body<'a>, targets: &[Target]) -> Self {
        let view = |t: &Target| View {
            eye: Eye::new(&t.fluoroscope),
            contour: FootFinder::new(&pieces(&t.curves)),
            mm_per_px: t.mm_per_px,
        };
        Self { source, centroid: *body.rim.centroid(), views: targets.iter().map(view).collect() }
    }

    /// With these pieces of contour in each view, ideal px, in place of whole curves: a spline with the range of it that is trusted.
    #[must_use]
    pub fn with_pieces(mut self, pieces: &[Vec<Piece>]) -> Self {
        for (view, pieces) in self.views.iter_mut().zip(pieces) {
            view.contour = FootFinder::new(pieces);
        }
        self
    }

    fn evaluate(&mut self, pose: &Pose, mut rows: Option<&mut Vec<Row>>) -> f64 {
        let centre = pose.transform(&self.centroid);
        let mut sum = 0.0;
        for view in &self.views {
            let distance = match &mut self.source {
                Source::Grid { points, grid, most, outline } => {
                    let outline = outline.trace(points, pose, &view.eye.fluoroscope, *grid);
                    let chosen = outline.len().min(*most);
                    let feet =
                        (0..chosen).map(|k| view.contour.closest(&outline[k * outline.len() / chosen]));
                    mean(feet.map(|foot| foot.map(|f| (1.0, f.distance))))
                }
                Source::Rim { rim, step_px, outline } => {
                    outline.trace(rim, pose, &view.eye.fluoroscope, Sampling { step_px: *step_px });
                    let length = outline.length_px();
                    let rows = &mut rows;
                    mean(outline.points().iter().map(|p| {
                        let foot = view.contour.closest(&p.pixel)?;
                        if let Some(rows) = rows {
                            let size = foot.distance.max(LEAST_PX);
                            // Only the outline's motion across itself counts: along itself it slides.
                            let share = (p.pixel - foot.point).dot(&p.normal) / size;
                            let speed = view.eye.pixel_by_twist(&p.world, &p.normal, &centre);
                            rows.push(Row {
                                residual: foot.distance * view.mm_per_px,
                                weight: p.length_px / (length * size * view.mm_per_px),
                                derivative: speed * (share * view.mm_per_px),
                            });
                        }
                        Some((p.length_px, foot.distance))
                    }))
                }
            };
            sum += distance.map_or(NO_OUTLINE, |px| px * view.mm_per_px);
        }
        sum
    }
}

/// The mean of numbers with their weights; none of fewer than two, or if one is missing.
fn mean(weighed: impl Iterator<Item = Option<(f64, f64)>>) -> Option<f64> {
    let (mut count, mut weights, mut sum) = (0, 0.0, 0.0);
    for item in weighed {
        let (weight, value) = item?;
        count += 1;
        weights += weight;
        sum += weight * value;
    }
    (count >= 2 && weights > 0.0).then(|| sum / weights)
}

impl Objective for SplineDistance<'_> {
    fn value(&mut self, pose: &Pose) -> f64 {
        self.evaluate(pose, None)
    }

    fn linearise(&mut self, pose: &Pose, rows: &mut Vec<Row>) -> Option<f64> {
        matches!(self.source, Source::Rim { .. }).then(|| self.evaluate(pose, Some(rows)))
    }
}
