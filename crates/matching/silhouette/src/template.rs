//! Silhouettes seen from directions all around the body, as few points with normals.

use biplane_artifact::Calibration;
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Mesh, Point3, Pose, Vector3};
use biplane_outline::{Outline, RimMesh, Sampling};
use nalgebra::{Matrix3, UnitQuaternion};

use crate::octahedron;
use crate::search::directions;

/// Points of a template.
pub(crate) const POINTS: usize = 48;
/// How many body radii away the body is looked at: as in a fluoroscope, roughly.
const AWAY: f64 = 15.0;

/// A point of a silhouette: its place beside the centroid's, mm, and where the normal away from the shadow points, in turns.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct TemplatePoint {
    pub place: [f32; 2],
    pub turn: f32,
    /// On the body about its centroid, model coordinates, mm.
    pub point: nalgebra::Vector3<f32>,
}

/// Silhouettes from all directions.
#[derive(Debug, Clone)]
pub(crate) struct Templates {
    /// `POINTS` for each direction; a direction from which there is no outline has none.
    points: Vec<Vec<TemplatePoint>>,
    /// The rotations that turn each direction to +z, away from the source.
    pub turned: Vec<UnitQuaternion<f64>>,
    /// Distance of the farthest vertex from the centroid, mm.
    pub radius: f64,
    /// The number of the nearest direction (model coordinates, away from the source) for each cell of an octahedral map.
    nearest: Vec<u32>,
}

/// Cells along a side of the map of nearest directions, 2 to 5 degrees wide.
const SIDE: usize = 64;

impl Templates {
    /// Of a mesh, about `centroid`.
    pub fn of(mesh: &Mesh, centroid: &Point3, radius: f64) -> Self {
        let rim = RimMesh::new(mesh);
        let away = AWAY * radius;
        // Looks along +z at the origin; a pixel is a millimetre there.
        let view = Fluoroscope::from(&Calibration {
            view: String::new(),
            size: [1, 1],
            source: [0.0, 0.0, -away],
            matrix: [[away, 0.0, 0.0], [0.0, away, 0.0], [0.0, 0.0, 1.0]],
            distortion: None,
        });
        let turned: Vec<UnitQuaternion<f64>> = directions().iter().map(|q| q.inverse()).collect();
        let mut outline = Outline::new();
        let points = turned
            .iter()
            .map(|q| {
                outline.trace(
                    &rim,
                    &Pose::new(*q, -(*q * centroid.coords)),
                    &view,
                    Sampling { step_px: 2.0 },
                );
                sampled(&outline, q)
            })
            .collect();
        let looks: Vec<Vector3> = turned.iter().map(|q| q.inverse() * Vector3::z()).collect();
        let nearest = octahedron::middles(SIDE).map(|m| {
            let dots = looks.iter().map(|l| l.dot(&m));
            (0_u32..).zip(dots).fold((0, f64::MIN), |a, b| if b.1 > a.1 { b } else { a }).0
        });
        Self { points, nearest: nearest.collect(), turned, radius }
    }

    /// The points seen from direction number `k`.
    pub fn points(&self, k: usize) -> &[TemplatePoint] {
        &self.points[k]
    }

    /// For a body turned by `local` in axes whose z leads away from the source: the points of the template from the nearest direction,
    /// and cosine and sine of its turn in the picture.
    pub fn of_rotation(&self, local: &Matrix3<f64>) -> (&[TemplatePoint], f64, f64) {
        let at = self.nearest[octahedron::cell(&local.row(2).transpose(), SIDE)] as usize;
        // `local` is nearly a turn about z of the template's rotation.
        let rest = local * self.turned[at].inverse().to_rotation_matrix().matrix();
        let (c, s) = (rest[(0, 0)] + rest[(1, 1)], rest[(1, 0)] - rest[(0, 1)]);
        let length = c.hypot(s).max(1e-12);
        (&self.points[at], c / length, s / length)
    }
}

/// `POINTS` points evenly along an outline.
fn sampled(outline: &Outline, turned: &UnitQuaternion<f64>) -> Vec<TemplatePoint> {
    let step = outline.length_px() / POINTS as f64;
    let (mut points, mut passed) = (Vec::with_capacity(POINTS), 0.0);
    for p in outline.points() {
        passed += p.length_px;
        if passed >= (points.len() as f64 + 0.5) * step && points.len() < POINTS {
            points.push(TemplatePoint {
                place: [p.pixel.x as f32, p.pixel.y as f32],
                // The centroid stands at the origin.
                point: (turned.inverse() * p.world.coords).cast(),
                turn: (p.normal.y.atan2(p.normal.x) / std::f64::consts::TAU) as f32,
            });
        }
    }
    points
}
