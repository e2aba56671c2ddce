//! The thesis's objective: mean distance of the grid outline's points from the contour, summed over the views (Eqs. 3.1 to
//! 3.6 and listing A.2.1, `FINDPOSE.m`).
//!
//! The variables are the thesis's six: translation `t` in mm and the Euler angles in degrees, about the local origin `o`.
//!
//! **Millimetres.** The thesis measures on the intensifier. A calibration holds no distance of the intensifier from the
//! source (it trades against the size of a pixel), so distances are those in ideal pixels times one constant a view,
//! [`BinghamView::mm_per_px`]: the size of a pixel on the intensifier where that is known, or of a pixel at the body's depth.
//! It is constant over a search; a constant common to the views moves no minimum.

use biplane_artifact::Curves;
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Point3, Pose, Vector3};
use biplane_outline::GridOutline;
use nalgebra::Vector6;

use super::Contour;

/// What a view counts, mm, whose outline has fewer than two points (listing A.2.1, lines 134 to 143).
const NO_OUTLINE: f64 = 100.0;

/// One view of a body: its fluoroscope and the contour of its frame.
#[derive(Debug, Clone)]
pub struct BinghamView {
    /// The fluoroscope.
    pub fluoroscope: Fluoroscope,
    /// The contour to be met, ideal pixels.
    pub contour: Contour,
    /// What a pixel of distance counts, mm.
    pub mm_per_px: f64,
}

impl BinghamView {
    /// From the curves of a frame, in recorded pixels. They ought to be those of the body alone, as a person chooses them
    /// in the thesis: every other curve attracts the outline too.
    pub fn new(fluoroscope: Fluoroscope, curves: &Curves, mm_per_px: f64) -> Self {
        let contour = Contour::new(curves, fluoroscope.distortion());
        Self { fluoroscope, contour, mm_per_px }
    }
}

/// The thesis's variables of a pose, `(x, y, z, alpha, beta, gamma)`, mm and degrees, about the origin `o` (model, mm).
pub(super) fn variables(pose: &Pose, origin: &Point3) -> Vector6<f64> {
    let (angles, t) = pose.to_thesis(origin.coords);
    let [alpha, beta, gamma] = angles.map(f64::to_degrees);
    Vector6::new(t.x, t.y, t.z, alpha, beta, gamma)
}

/// The pose of the thesis's variables.
pub(super) fn pose(variables: &Vector6<f64>, origin: &Point3) -> Pose {
    let v = variables;
    let angle = |i: usize| v[i].to_radians();
    Pose::from_thesis(angle(3), angle(4), angle(5), Vector3::new(v[0], v[1], v[2]), origin.coords)
}

/// The objective of one body in some views, with buffers that are used again.
pub(super) struct Objective<'a> {
    pub points: &'a [Point3],
    pub origin: &'a Point3,
    pub views: &'a [BinghamView],
    pub grid: usize,
    pub outline_points: usize,
    pub outline: GridOutline,
}

impl Objective<'_> {
    /// Its value, mm.
    pub fn at(&mut self, at: &Vector6<f64>) -> f64 {
        let pose = pose(at, self.origin);
        let mut sum = 0.0;
        for view in self.views {
            let outline = self.outline.trace(self.points, &pose, &view.fluoroscope, self.grid);
            if outline.len() < 2 || view.contour.is_empty() {
                sum += NO_OUTLINE;
                continue;
            }
            // So many points evenly along the contour.
            let chosen = outline.len().min(self.outline_points);
            let (mut distance, mut near) = (0.0, 0);
            for k in 0..chosen {
                distance += view.contour.distance_px(&outline[k * outline.len() / chosen], &mut near);
            }
            sum += view.mm_per_px * distance / chosen as f64;
        }
        sum
    }
}
