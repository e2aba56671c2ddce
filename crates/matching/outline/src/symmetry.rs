//! Where else a body looks nearly alike: bodies that are nearly their own mirror image, or nearly the same after half a turn.
//!
//! A shadow does not change where a body is mirrored along the ray (nearly so for a source that is far). So of a body that is its own mirror image in a
//! plane with the normal `n`, the pose `R` and the proper rotation `D R M` have the same shadow, `M = 1 - 2 n n'` mirroring the body and `D = 1 - 2 d d'` the
//! shadow along the view's ray `d`: the mirror basin of one view. Half a turn `C` that leaves the body alike makes `R C` in all views.
//!
//! Which of them nearly hold is found once a mesh, about its principal axes: by how far its points come to lie from its surface.
//!
//! **Not guaranteed:** symmetries about other axes than the principal ones are not seen.

use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Mesh, Point3, Pose, Vector3};
use biplane_surface::Surface;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};

/// A body is taken for nearly symmetric if its points come to lie this near its surface, root mean square over that of their distances from the
/// centroid. Of the phantom's bodies the tray and the proximal tibia do.
const NEARLY: f64 = 0.045;
/// A body whose points spread so nearly alike in all directions, least over most, has no principal axes: a ball looks the same from everywhere.
const ROUND: f64 = 0.98;
/// Points that are tried.
const TRIED: usize = 400;
/// Rotations nearer than this to the pose itself are in its own basin, rad.
const OWN_BASIN: f64 = 0.05;

/// What leaves a body nearly as it is.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Symmetry {
    /// Mirroring in the plane through the centroid with this normal (model).
    Mirror(Vector3),
    /// Half a turn about this axis through the centroid (model).
    HalfTurn(Vector3),
}

/// The near symmetries of a mesh.
#[derive(Debug, Clone, Default)]
pub(crate) struct NearSymmetries {
    found: Vec<Symmetry>,
}

impl NearSymmetries {
    /// Of a mesh.
    pub(crate) fn of(mesh: &Mesh, surface: &Surface) -> Self {
        let centroid = mesh.area_centroid();
        let vertices = mesh.vertices();
        let mut spread = Matrix3::zeros();
        for v in vertices {
            let off = v - centroid;
            spread += off * off.transpose();
        }
        let parts = spread.symmetric_eigen();
        if parts.eigenvalues.min() > ROUND * parts.eigenvalues.max() {
            return Self::default();
        }
        let axes = parts.eigenvectors;
        let size = (spread.trace() / vertices.len().max(1) as f64).sqrt();
        let step = (vertices.len() / TRIED).max(1);
        let moved = |by: &Matrix3<f64>| {
            let mut sum = 0.0;
            let mut count = 0.0;
            for v in vertices.iter().step_by(step) {
                let there = centroid + by * (v - centroid);
                sum += surface.closest(&there).distance_mm.powi(2);
                count += 1.0;
            }
            (sum / f64::max(count, 1.0)).sqrt()
        };
        let mut found = Vec::new();
        for k in 0..3 {
            let axis: Vector3 = axes.column(k).into_owned();
            let mirror = Matrix3::identity() - axis * axis.transpose() * 2.0;
            if moved(&mirror) < NEARLY * size {
                found.push(Symmetry::Mirror(axis));
            }
            if moved(&-mirror) < NEARLY * size {
                found.push(Symmetry::HalfTurn(axis));
            }
        }
        Self { found }
    }

    /// Other poses that look nearly alike in one of the views, or in all, with the centroid (model, mm) where it is.
    pub(crate) fn others<'a>(
        &self,
        pose: &Pose,
        centroid: &Point3,
        views: impl Iterator<Item = &'a Fluoroscope>,
    ) -> Vec<Pose> {
        if self.found.is_empty() {
            return Vec::new();
        }
        let views: Vec<&Fluoroscope> = views.collect();
        let at = pose.transform(centroid);
        let own = pose.rotation().to_rotation_matrix().into_inner();
        let mut rotations: Vec<Matrix3<f64>> = Vec::new();
        for symmetry in &self.found {
            match symmetry {
                Symmetry::HalfTurn(axis) => {
                    rotations.push(own * (axis * axis.transpose() * 2.0 - Matrix3::identity()));
                }
                Symmetry::Mirror(normal) => {
                    let mirror = Matrix3::identity() - normal * normal.transpose() * 2.0;
                    for view in &views {
                        let ray = (at - view.source()).normalize();
                        rotations.push((Matrix3::identity() - ray * ray.transpose() * 2.0) * own * mirror);
                    }
                }
            }
        }
        let turned =
            |r: Matrix3<f64>| UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(r));
        rotations
            .into_iter()
            .map(turned)
            .filter(|r| r.angle_to(&pose.rotation()) > OWN_BASIN)
            .map(|r| Pose::new(r, at.coords - r * centroid.coords))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_phantom::{Body, mesh};

    fn kinds(mesh: &Mesh) -> (usize, usize) {
        let found = NearSymmetries::of(mesh, &Surface::new(mesh)).found;
        let mirrors = found.iter().filter(|s| matches!(s, Symmetry::Mirror(_))).count();
        (mirrors, found.len() - mirrors)
    }

    #[test]
    fn a_tray_is_nearly_its_mirror_image_and_other_bodies_are_not() {
        let found = Body::ALL.map(|body| (body.name(), kinds(&mesh(body.solid(), 4000).unwrap())));
        let none = ["femoral-component", "distal-femur", "patella"].map(|name| (name, (0, 0)));
        assert!(none.iter().all(|n| found.contains(n)), "{found:?}");
        assert!(found.contains(&("tibial-tray", (1, 0))), "{found:?}");
    }

    #[test]
    fn others_have_the_same_shadow_in_their_view() {
        // A box: three mirrors, three half turns.
        let corner = |k: usize| {
            let side = |bit: usize, half: f64| if k >> bit & 1 == 1 { half } else { -half };
            Point3::new(side(0, 25.0), side(1, 15.0), side(2, 8.0))
        };
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        let cuboid = Mesh::new((0..8).map(corner).collect(), triangles).unwrap();
        assert_eq!(kinds(&cuboid), (3, 3));
        let calibration = biplane_artifact::Calibration {
            view: "A".to_owned(),
            size: [512, 512],
            source: [0.0, 0.0, -100_000.0],
            matrix: [[2e5, 0.0, 256.0], [0.0, 2e5, 256.0], [0.0, 0.0, 1.0]],
            distortion: None,
        };
        let view = Fluoroscope::from(&calibration);
        let pose = Pose::new(UnitQuaternion::from_euler_angles(0.3, 0.5, 0.2), Vector3::new(3.0, -4.0, 10.0));
        let others = NearSymmetries::of(&cuboid, &Surface::new(&cuboid)).others(
            &pose,
            &Point3::origin(),
            std::iter::once(&view),
        );
        assert_eq!(others.len(), 6);
        let shadow = |pose: &Pose| {
            let mut places: Vec<[i64; 2]> = cuboid
                .vertices()
                .iter()
                .map(|v| {
                    let at = pose.transform(v);
                    // Hundredths of a millimetre across the ray.
                    [(at.x * 100.0).round() as i64, (at.y * 100.0).round() as i64]
                })
                .collect();
            places.sort_unstable();
            places
        };
        for other in &others {
            let (a, b) = (shadow(&pose), shadow(other));
            let near = a.iter().zip(&b).all(|(a, b)| (a[0] - b[0]).abs() <= 2 && (a[1] - b[1]).abs() <= 2);
            assert!(near, "{a:?}\n{b:?}");
        }
    }
}
