//! Edges of one picture that are another body's: bodies of one frame know of each other.
//!
//! Where a body is known, its outline says which edges it makes. Those that lie on it, run as it does, and lie farther from the outline of
//! the body that is looked for, are taken out of the curves before that body is matched, so that the outline of a femur is not drawn to
//! the rim of a tray. Where two outlines cross or touch, the nearer one keeps the edge.
//!
//! **Guaranteed:** points are taken out, none is moved; a curve that is broken becomes several. **Not guaranteed:** that an edge that both
//! bodies make, where one outline runs along the other, is given to the right one.

use biplane_artifact::Curves;
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Curve, EdgePoint, Pose};
use biplane_outline::{Outline, RimMesh, Sampling};

use crate::EdgeField;
use crate::refine::MIN_COSINE;

/// Distance of outline samples, px.
const STEP_PX: f64 = 1.0;

/// The outline of a posed body as edges would show it.
fn outline_edges(
    (mesh, pose): (&RimMesh, &Pose),
    view: &Fluoroscope,
    contrast: f64,
    outline: &mut Outline,
) -> EdgeField {
    outline.trace(mesh, pose, view, Sampling { step_px: STEP_PX });
    let points = outline.points().iter().map(|p| EdgePoint {
        position: p.pixel,
        direction: p.normal * contrast,
        strength: 1.0,
        sigma_px: 0.0,
    });
    EdgeField::new(&Curves(vec![Curve { points: points.collect(), closed: false }]), None)
}

/// The curves of a picture without the points within `reach_px` of the outlines of `others`, but for those that `own` has nearer; and how
/// many were taken out. `contrast` is 1 for bodies darker than what is beside them, -1 for brighter ones.
pub(crate) fn without_claimed(
    curves: &Curves,
    view: &Fluoroscope,
    own: (&RimMesh, &Pose),
    others: &[(&RimMesh, Pose)],
    contrast: f64,
    reach_px: f64,
) -> (Curves, usize) {
    let mut outline = Outline::lean();
    let own = outline_edges(own, view, contrast, &mut outline);
    let others: Vec<EdgeField> =
        others.iter().map(|(mesh, pose)| outline_edges((mesh, pose), view, contrast, &mut outline)).collect();
    let (mut left, mut taken) = (Vec::new(), 0);
    for curve in &curves.0 {
        let corrected = view.distortion().map(|d| d.correct(curve));
        let seen = corrected.as_ref().unwrap_or(curve);
        let claimed: Vec<bool> = seen
            .points
            .iter()
            .map(|p| {
                let from = |field: &EdgeField, radius: f64| {
                    let nearest = field.nearest(&p.position, &p.direction, radius, MIN_COSINE);
                    nearest.map(|q| (q.position - p.position).norm())
                };
                let theirs = others.iter().filter_map(|field| from(field, reach_px)).min_by(f64::total_cmp);
                theirs.is_some_and(|theirs| from(&own, theirs).is_none())
            })
            .collect();
        let lost = claimed.iter().filter(|c| **c).count();
        taken += lost;
        if lost == 0 {
            left.push(curve.clone());
            continue;
        }
        for piece in curve.points.iter().zip(&claimed).collect::<Vec<_>>().split(|(_, claimed)| **claimed) {
            if !piece.is_empty() {
                left.push(Curve { points: piece.iter().map(|(p, _)| **p).collect(), closed: false });
            }
        }
    }
    (Curves(left), taken)
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_geometry::{Mesh, Point2, Point3, Vector2, Vector3};

    /// A box of 20 mm about the origin.
    fn cube() -> RimMesh {
        let corner = |k: usize| {
            let side = |bit: usize| if k >> bit & 1 == 1 { 10.0 } else { -10.0 };
            Point3::new(side(0), side(1), side(2))
        };
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        RimMesh::new(&Mesh::new((0..8).map(corner).collect(), triangles).unwrap())
    }

    fn view() -> Fluoroscope {
        let calibration = biplane_artifact::Calibration {
            view: "A".to_owned(),
            size: [512, 512],
            source: [0.0, 0.0, -1000.0],
            matrix: [[2000.0, 0.0, 256.0], [0.0, 2000.0, 256.0], [0.0, 0.0, 1.0]],
            distortion: None,
        };
        Fluoroscope::from(&calibration)
    }

    /// Edges of a posed body, as one picture shows them.
    fn edges(mesh: &RimMesh, pose: &Pose) -> Curve {
        let mut outline = Outline::lean();
        outline.trace(mesh, pose, &view(), Sampling { step_px: 1.0 });
        let point = |p: &biplane_outline::OutlinePoint| EdgePoint {
            position: p.pixel,
            direction: p.normal,
            strength: 1.0,
            sigma_px: 0.1,
        };
        Curve { points: outline.points().iter().map(point).collect(), closed: false }
    }

    #[test]
    fn edges_of_the_other_body_go_and_the_own_ones_stay() {
        let mesh = cube();
        let at = |x: f64| Pose::new(nalgebra::UnitQuaternion::identity(), Vector3::new(x, 3.0, 0.0));
        let (own, other) = (edges(&mesh, &at(0.0)), edges(&mesh, &at(24.0)));
        let stray = EdgePoint {
            position: Point2::new(5.0, 5.0),
            direction: Vector2::new(1.0, 0.0),
            strength: 1.0,
            sigma_px: 0.1,
        };
        let stray = Curve { points: vec![stray], closed: false };
        let curves = Curves(vec![own.clone(), other.clone(), stray.clone()]);
        // The own pose need not be right for that.
        let supposed = at(0.4);
        let others = [(&mesh, at(24.0))];
        let (left, taken) = without_claimed(&curves, &view(), (&mesh, &supposed), &others, 1.0, 1.5);
        assert_eq!(taken, other.points.len());
        assert_eq!(left, Curves(vec![own, stray]));
    }

    #[test]
    fn where_both_outlines_lie_on_an_edge_it_stays() {
        let mesh = cube();
        let at = |x: f64| Pose::new(nalgebra::UnitQuaternion::identity(), Vector3::new(x, 0.0, 0.0));
        let curves = Curves(vec![edges(&mesh, &at(0.0))]);
        let (left, taken) =
            without_claimed(&curves, &view(), (&mesh, &at(0.0)), &[(&mesh, at(0.01))], 1.0, 1.5);
        assert_eq!((left, taken), (curves, 0));
    }
}
