//! Start poses without a guess: a body's silhouettes over all rotations against the edges of a frame.
//!
//! Banks and Hodge (1996) and Hoff et al. (1998) keep a library of rendered silhouettes and look for the most alike. Here it is kept
//! in two forms ([`SilhouetteLibrary`]).
//!
//! **The body alone** ([`SilhouetteLibrary::isolated`]): the silhouette seen from any side, turned in any way, is the body's support
//! function along a circle of the sphere, so one table of 65,536 numbers holds them all, without an angle between one template and the
//! next. Tangent lines of a shadow make planes through the source, and the support function says for any rotation where the body must
//! be to touch them all: position and depth in closed form, in one view or many, exact for a cone of rays.
//!
//! **Among other edges** ([`SilhouetteLibrary::among`]): silhouettes as few points with normals, from directions 10 degrees apart, are
//! counted against edges of their direction at every place of every picture; what a view finds is held against the others depth by
//! depth, and the best settle on the nearest edges in a few steps.
//!
//! **Guaranteed:** the same candidates for the same curves; of those found, all that fit nearly as well as the best are given, so that
//! mirror basins can be compared. **Not guaranteed:** that the right one is the first, or found at all: a descent from each decides
//! ([`descend`]), and its verdict.

mod descend;
mod octahedron;
mod place;
mod search;
mod settle;
mod support;
mod tangent;
mod template;
mod vote;

use biplane_artifact::Curves;
use biplane_edge_field::EdgeField;
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Curve, EdgePoint, Mesh, Point2, Point3, Pose, Vector3};
use nalgebra::{Matrix3, UnitQuaternion};

pub use descend::descend;

use place::{Place, distinct};
use settle::settle;
use support::Support;
use tangent::{Tangent, hull, middle, tangents};
use template::Templates;
use vote::{EdgeMaps, vote};

/// A pose to start from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// The pose.
    pub pose: Pose,
    /// How far the shadows are from the body at this pose, mm: root mean square distance of tangent planes where the body is alone,
    /// else the mean distance of its silhouette's points from edges, none of which counts for more than 6 px of 1024.
    pub misfit_mm: f64,
}

/// All silhouettes of a body. Made once a mesh, used for every frame.
#[derive(Debug, Clone)]
pub struct SilhouetteLibrary {
    support: Support,
    templates: Templates,
    centroid: Point3,
    rotations: Vec<UnitQuaternion<f64>>,
}

/// Tangent lines around a shadow.
const TANGENTS: usize = 40;
/// Fewer tangent planes do not hold six numbers well.
const LEAST_TANGENTS: usize = 16;
/// A body is alone where this share of its tangents is left and the best pose touches them within this part of its radius.
const ALONE: (f64, f64) = (0.6, 0.01);
/// Settled ones that are nearer than this, rad and mm, are one.
const SAME: (f64, f64) = (0.08, 5.0);
/// What fits worse than this many times the best candidate, and this many mm more, is none.
const WORSE: (f64, f64) = (4.0, 0.5);

/// One view: its edges in ideal pixels, and their hull.
struct Seen<'a> {
    view: &'a Fluoroscope,
    edges: Vec<EdgePoint>,
    hull: Vec<Point2>,
}

impl<'a> Seen<'a> {
    fn of(&(view, curves): &(&'a Fluoroscope, &Curves)) -> Self {
        let mut edges = Vec::with_capacity(curves.point_count());
        for curve in &curves.0 {
            let corrected = view.distortion().map(|d| d.correct(curve));
            edges.extend_from_slice(&corrected.as_ref().unwrap_or(curve).points);
        }
        edges.retain(|e| e.position.coords.iter().chain(e.direction.iter()).all(|v| v.is_finite()));
        let hull = hull(edges.iter().map(|e| e.position).collect());
        Self { view, edges, hull }
    }
}

impl SilhouetteLibrary {
    /// Of a mesh.
    pub fn new(mesh: &Mesh) -> Self {
        let centroid = mesh.area_centroid();
        let support = Support::of(mesh, &centroid);
        let templates = Templates::of(mesh, &centroid, support.radius());
        Self { support, templates, centroid, rotations: search::rotations() }
    }

    /// At most `count` poses to start from, the likeliest first, for a body seen in `views` with these curves (recorded pixels);
    /// `contrast` is +1 for a body darker than what is around it, -1 for a brighter one.
    ///
    /// Whether the curves are the body's alone need not be said: where they are, they fit as nothing else does.
    pub fn starts(&self, views: &[(&Fluoroscope, &Curves)], contrast: f64, count: usize) -> Vec<Candidate> {
        let seen: Vec<Seen> = views.iter().map(Seen::of).collect();
        let (alone, share) = self.alone(&seen, contrast, count);
        let fits = |p: &Place| share >= ALONE.0 && p.misfit <= ALONE.1 * self.templates.radius;
        if alone.first().is_some_and(fits) {
            return self.candidates(&alone);
        }
        self.candidates(&self.voted(&seen, contrast, alone, count))
    }

    /// At most `count` poses for curves that are the body's alone, or nearly all of it in each view; parts may be missing.
    pub fn isolated(&self, views: &[(&Fluoroscope, &Curves)], contrast: f64, count: usize) -> Vec<Candidate> {
        let seen: Vec<Seen> = views.iter().map(Seen::of).collect();
        self.candidates(&self.alone(&seen, contrast, count).0)
    }

    /// At most `count` poses for curves of everything in the pictures.
    pub fn among(&self, views: &[(&Fluoroscope, &Curves)], contrast: f64, count: usize) -> Vec<Candidate> {
        let seen: Vec<Seen> = views.iter().map(Seen::of).collect();
        self.candidates(&self.voted(&seen, contrast, Vec::new(), count))
    }

    /// The body's area centroid, model coordinates, mm.
    pub fn centroid(&self) -> &Point3 {
        &self.centroid
    }

    fn candidates(&self, places: &[Place]) -> Vec<Candidate> {
        let most = places.first().map_or(0.0, |p| WORSE.0 * p.misfit + WORSE.1);
        let pose = |p: &Place| Pose::new(p.rotation, p.centre.coords - p.rotation * self.centroid.coords);
        let likely = places.iter().filter(|p| p.misfit <= most);
        likely.map(|p| Candidate { pose: pose(p), misfit_mm: p.misfit }).collect()
    }

    /// Poses that fit the hulls of all edges, and the share of tangents that were left to fit.
    fn alone(&self, seen: &[Seen], contrast: f64, count: usize) -> (Vec<Place>, f64) {
        let planes: Vec<Tangent> =
            seen.iter().flat_map(|s| tangents(&s.edges, &s.hull, s.view, contrast, TANGENTS)).collect();
        let share = planes.len() as f64 / (TANGENTS * seen.len().max(1)) as f64;
        let near = if planes.len() < LEAST_TANGENTS { None } else { self.near(seen, &planes) };
        let fits = near.map(|about| search::search(&self.support, &planes, &about, &self.rotations, count));
        (fits.unwrap_or_default(), share)
    }

    /// Poses that most silhouette points vote for, settled, and `further` ones with them.
    fn voted(&self, seen: &[Seen], contrast: f64, further: Vec<Place>, count: usize) -> Vec<Place> {
        let maps: Vec<EdgeMaps> = seen.iter().map(|s| EdgeMaps::new(s.view, &s.edges, contrast)).collect();
        let middle = |s: &Seen| Point2::from(s.view.size().map(|n| n as f64 / 2.0));
        let rays: Vec<(Point3, Vector3)> =
            seen.iter().filter_map(|s| Some((*s.view.source(), s.view.ray(&middle(s))?))).collect();
        let mut found = vote(&maps, &self.templates, meeting(&rays).as_ref());
        found.extend(further);
        let field =
            |s: &Seen| EdgeField::new(&Curves(vec![Curve { points: s.edges.clone(), closed: false }]), None);
        let fields: Vec<EdgeField> = seen.iter().map(field).collect();
        let settled = found.iter().map(|p| settle(&maps, &fields, &self.templates, p)).collect();
        distinct(settled, SAME, count)
    }

    /// A point near the body: where the rays through the shadows' middles meet; for one view by the shadow's size.
    fn near(&self, seen: &[Seen], planes: &[Tangent]) -> Option<Point3> {
        let rays: Vec<(Point3, Vector3)> =
            seen.iter().filter_map(|s| Some((*s.view.source(), s.view.ray(&middle(&s.hull)?)?))).collect();
        if let Some(point) = meeting(&rays) {
            return Some(point);
        }
        let (source, ray) = rays.first()?;
        // A plane that touches the body a distance away leans by the body's reach over that distance.
        let lean: f64 = planes.iter().map(|p| -p.normal.dot(ray)).sum();
        let away = self.support.mean() * planes.len() as f64 / lean;
        away.is_finite().then(|| source + ray * away)
    }
}

/// Where rays come nearest to each other; `None` for one alone.
fn meeting(rays: &[(Point3, Vector3)]) -> Option<Point3> {
    let (mut matrix, mut vector) = (Matrix3::zeros(), Vector3::zeros());
    for (source, ray) in rays {
        let across = Matrix3::identity() - ray * ray.transpose();
        matrix += across;
        vector += across * source.coords;
    }
    let inverse = if rays.len() > 1 { matrix.try_inverse() } else { None };
    Some(Point3::from(inverse? * vector))
}
