//! A few steps towards the nearest edges, with a template's points held fixed to the body.
//!
//! A rim point that is held fixed to the body has the contour's normal speed, and one from a direction `d` beside the ray lies only
//! `R d^2 / 2` inside the contour of a surface of radius `R`: 0.1 mm for 30 mm and 5 degrees. So the points of the nearest template
//! stand for the silhouette, and no mesh is looked at.

use biplane_edge_field::EdgeField;
use biplane_geometry::{Point3, Pose, Twist, Vector3};
use nalgebra::{Matrix6, Vector6};

use crate::place::Place;
use crate::template::Templates;
use crate::vote::{EdgeMaps, Laid, Local};

/// Search radii of the steps, as parts of a cell of the masks.
const RADII: [f64; 10] = [1.6, 1.4, 1.2, 1.0, 0.8, 0.6, 0.5, 0.4, 0.4, 0.4];
/// Least cosine between a silhouette's normal and an edge's direction.
const MIN_COSINE: f64 = 0.8;
/// Longest step, mm of the centroid or of a point at the body's radius.
const LONGEST_MM: f64 = 10.0;

/// Settles a place; its misfit is then the mean distance of the silhouette from edges, mm, none of which counts for more than the last
/// search radius. `fields` are the views' edges in ideal pixels.
pub(crate) fn settle(maps: &[EdgeMaps], fields: &[EdgeField], templates: &Templates, place: &Place) -> Place {
    let mut pose = place.pose();
    for radius in RADII {
        let Some(twist) = step(maps, fields, templates, &pose, radius).0 else { break };
        pose = pose.moved(&twist, &Point3::from(pose.translation()));
    }
    Place::of(&pose, step(maps, fields, templates, &pose, RADII[RADII.len() - 1]).1)
}

/// The step from a pose, and its misfit there.
fn step(
    maps: &[EdgeMaps],
    fields: &[EdgeField],
    templates: &Templates,
    pose: &Pose,
    radius: f64,
) -> (Option<Twist>, f64) {
    let turned = pose.rotation().to_rotation_matrix();
    let centre = Point3::from(pose.translation());
    let (mut matrix, mut vector) = (Matrix6::<f64>::zeros(), Vector6::zeros());
    let (mut misfit, mut count) = (0.0, 0.0_f64);
    for (map, field) in maps.iter().zip(fields) {
        let Some(local) = Local::of(map.view, &centre) else { continue };
        let (points, c, s) = templates.of_rotation(&(local.frame.transpose() * turned.matrix()));
        let laid = Laid::new(&local, c, s, map.contrast());
        let reach = radius * map.cell_px();
        let mm_per_px = map.view.mm_per_px((centre - map.view.source()).norm());
        for p in points {
            let arm: Vector3 = turned * p.point.cast::<f64>();
            let Some((seen, by_point)) = map.view.project_with_derivative(&(centre + arm)) else { continue };
            if !map.view.on_image(&seen.pixel, 1.0) {
                continue;
            }
            let (sin, cos) = (std::f64::consts::TAU * f64::from(laid.turn(p))).sin_cos();
            let direction = biplane_geometry::Vector2::new(cos, sin);
            let found = field.nearest(&seen.pixel, &direction, reach, MIN_COSINE).map(|edge| {
                edge.direction.dot(&(edge.position - seen.pixel)) / edge.direction.dot(&direction)
            });
            count += 1.0;
            let Some(residual) = found.filter(|r| r.abs() <= reach) else {
                misfit += reach * mm_per_px;
                continue;
            };
            misfit += residual.abs() * mm_per_px;
            let gradient = by_point.transpose() * direction;
            let turn = arm.cross(&gradient);
            let row = Vector6::new(gradient.x, gradient.y, gradient.z, turn.x, turn.y, turn.z);
            // Geman and McClure's weight; all views count in mm.
            let scale = reach * reach / 4.0;
            let weight = (scale / (scale + residual * residual)).powi(2) * mm_per_px * mm_per_px;
            matrix.syger(weight, &row, &row, 1.0);
            vector += row * (weight * residual);
        }
    }
    // Too little of the body is on the pictures to say anything.
    let misfit = if count > 0.0 { misfit / count } else { f64::INFINITY };
    matrix.fill_upper_triangle_with_lower_triangle();
    let arm = templates.radius.max(1e-3);
    let damping = 1e-3 * (matrix.fixed_view::<3, 3>(0, 0).trace() / 3.0);
    for k in 0..6 {
        matrix[(k, k)] += if k < 3 { damping } else { damping * arm * arm };
    }
    let solved = matrix.cholesky().map(|m| m.solve(&vector));
    let twist = solved.filter(|t| t.iter().all(|v| v.is_finite())).map(|t| {
        let (moved, turned) = (Vector3::new(t[0], t[1], t[2]), Vector3::new(t[3], t[4], t[5]));
        let shorten = (LONGEST_MM / moved.norm().max(turned.norm() * arm).max(1e-12)).min(1.0);
        Twist { translation: moved * shorten, rotation: turned * shorten }
    });
    (twist, misfit)
}
