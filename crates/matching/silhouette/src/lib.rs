//! Start poses without a guess: a body's silhouettes over all rotations against the shadows of a frame.
//!
//! Banks and Hodge (1996) and Hoff et al. (1998) keep a library of rendered silhouettes and look for the most alike. Here the
//! library is the body's support function over the sphere ([`SilhouetteLibrary`]): the silhouette seen from any side, turned in any
//! way, is the part of that function along a circle, so one table of 65,536 numbers holds them all, without an angle between one
//! template and the next. Tangent lines of a shadow make planes through the source, and the support function says for any rotation
//! where the body must be to touch them all: position and depth in closed form, in one view or many, exact for a cone of rays.
//!
//! **Guaranteed:** the same candidates for the same curves. **Not guaranteed:** that the right one is the first: what only
//! concavities tell apart is left to the match, which is tried from each.

mod search;
mod support;
mod tangent;

use biplane_artifact::Curves;
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Mesh, Point2, Point3, Pose, Vector3};
use nalgebra::{Matrix3, UnitQuaternion};

use support::Support;
use tangent::{Tangent, hull, middle, tangents};

/// A pose to start from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// The pose.
    pub pose: Pose,
    /// Root mean square distance of the shadows' tangent planes from the body at this pose, mm.
    pub misfit_mm: f64,
}

/// All silhouettes of a body. Made once a mesh, used for every frame.
#[derive(Debug, Clone)]
pub struct SilhouetteLibrary {
    support: Support,
    centroid: Point3,
    rotations: Vec<UnitQuaternion<f64>>,
}

/// Tangent lines around a shadow.
const TANGENTS: usize = 40;

impl SilhouetteLibrary {
    /// Of a mesh.
    pub fn new(mesh: &Mesh) -> Self {
        let centroid = mesh.area_centroid();
        Self { support: Support::of(mesh, &centroid), centroid, rotations: search::rotations() }
    }

    /// At most `count` poses of a body whose shadows have these curves (recorded pixels), the likeliest first.
    pub fn starts(&self, views: &[(&Fluoroscope, &Curves)], count: usize) -> Vec<Candidate> {
        let hulls: Vec<Vec<Point2>> =
            views.iter().map(|(view, curves)| hull(ideal_points(view, curves))).collect();
        let shadows: Vec<(&Fluoroscope, &[Point2])> =
            views.iter().zip(&hulls).map(|((view, _), hull)| (*view, hull.as_slice())).collect();
        self.of_shadows(&shadows, count)
    }

    /// The poses that fit one hull a view.
    fn of_shadows(&self, shadows: &[(&Fluoroscope, &[Point2])], count: usize) -> Vec<Candidate> {
        let planes: Vec<Tangent> =
            shadows.iter().flat_map(|(view, hull)| tangents(hull, view, TANGENTS)).collect();
        let Some(about) = self.near(shadows, &planes) else { return Vec::new() };
        search::search(&self.support, &planes, &about, &self.rotations, count)
            .into_iter()
            .map(|fit| Candidate {
                pose: Pose::new(fit.rotation, fit.centre.coords - fit.rotation * self.centroid.coords),
                misfit_mm: fit.misfit_mm,
            })
            .collect()
    }

    /// A point near the body: where the rays through the shadows' middles meet; for one view by the shadow's size.
    fn near(&self, shadows: &[(&Fluoroscope, &[Point2])], planes: &[Tangent]) -> Option<Point3> {
        let rays: Vec<(Point3, Vector3)> = shadows
            .iter()
            .filter_map(|(view, hull)| Some((*view.source(), view.ray(&middle(hull)?)?)))
            .collect();
        let (source, ray) = *rays.first()?;
        let (mut matrix, mut vector) = (Matrix3::zeros(), Vector3::zeros());
        for (source, ray) in &rays {
            let across = Matrix3::identity() - ray * ray.transpose();
            matrix += across;
            vector += across * source.coords;
        }
        if rays.len() > 1
            && let Some(inverse) = matrix.try_inverse()
        {
            return Some(Point3::from(inverse * vector));
        }
        // A plane that touches the body a distance away leans by the body's reach over that distance.
        let lean: f64 = planes.iter().map(|p| -p.normal.dot(&ray)).sum();
        let away = self.support.mean() * planes.len() as f64 / lean;
        away.is_finite().then(|| source + ray * away)
    }
}

/// The points of curves in ideal pixels.
fn ideal_points(view: &Fluoroscope, curves: &Curves) -> Vec<Point2> {
    let mut points = Vec::with_capacity(curves.point_count());
    for curve in &curves.0 {
        let corrected = view.distortion().map(|d| d.correct(curve));
        points.extend(corrected.as_ref().unwrap_or(curve).points.iter().map(|p| p.position));
    }
    points
}
