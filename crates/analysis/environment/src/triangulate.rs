//! Points in space from their places in several views, with what their errors are.

use biplane_geometry::{Point2, Point3, Vector2, Vector3};
use nalgebra::Matrix3;

use crate::adjust::{Observation, Rules, minimise};
use crate::estimate::Estimate;
use crate::view::View;

/// The place of a ball whose shadows are at these ideal pixels, by least reprojection error; none with fewer than two views or
/// where their rays are parallel.
pub(crate) fn triangulate(seen: &[(View, Point2)], radius: f64) -> Option<Point3> {
    if seen.len() < 2 {
        return None;
    }
    // Nearest to all rays, then Gauss-Newton.
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (view, at) in seen {
        let on_detector = (at - view.middle) * view.pixel_mm;
        let to = view.centre - view.source + view.rotation * on_detector.push(0.0);
        let direction = to.try_normalize(0.0)?;
        let across = Matrix3::identity() - direction * direction.transpose();
        normal += across;
        right += across * view.source.coords;
    }
    let mut place = Point3::from(normal.cholesky()?.solve(&right));
    for _ in 0..10 {
        let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for (view, at) in seen {
            let shadow = view.shadow_with_derivatives(&place, radius)?;
            let residual: Vector2 = at - shadow.at;
            normal += shadow.by_point.transpose() * shadow.by_point;
            right += shadow.by_point.transpose() * residual;
        }
        let step = normal.cholesky()?.solve(&right);
        place += step;
        if step.norm() < 1e-10 {
            break;
        }
    }
    place.iter().all(|v| v.is_finite()).then_some(place)
}

/// A bead found from calibrations made without it.
pub(crate) struct LeftOut {
    pub set: usize,
    pub bead: usize,
    /// Found less listed, mm, in the frame of the beads.
    pub error: Vector3,
}

/// Every bead that `seen` has in at least two views of a set, found after all views and frames are fitted anew without any of its shadows.
pub(crate) fn leave_one_out(estimate: &Estimate, seen: &[Observation], beads: usize) -> Vec<LeftOut> {
    let mut out = Vec::new();
    for bead in 0..beads {
        let own: Vec<&Observation> = seen.iter().filter(|o| o.bead == bead).collect();
        let sets: Vec<usize> = (0..estimate.at.frames.len())
            .filter(|set| own.iter().filter(|o| o.set == *set).count() >= 2)
            .collect();
        if sets.is_empty() {
            continue;
        }
        let others: Vec<Observation> =
            estimate.observations.iter().filter(|o| o.bead != bead).copied().collect();
        let without = if others.len() == estimate.observations.len() {
            estimate.at.clone()
        } else {
            match minimise(&estimate.at, &others, &Rules::default()) {
                Some(fit) => fit.at,
                None => continue,
            }
        };
        for set in sets {
            let shadows: Vec<(View, Point2)> =
                own.iter().filter(|o| o.set == set).map(|o| (without.views[o.view], o.at)).collect();
            let (radius, listed) = (own[0].radius, own[0].point);
            if let Some(place) = triangulate(&shadows, radius) {
                let in_frame = without.frames[set].inverse().transform(&place);
                out.push(LeftOut { set, bead, error: in_frame - listed });
            }
        }
    }
    out.sort_by_key(|l| (l.set, l.bead));
    out
}
