//! All rotations at once, then the best of them by Gauss and Newton.
//!
//! A tangent plane with normal `n` through the source `s` touches the body at rotation `R` and centroid `t` where
//!
//! `n . (s - t) = H(R' n)`.
//!
//! For a rotation this is linear in `t`, with the same normal matrix for every rotation: `t` is eliminated in closed form and
//! what is left of the residuals says how well the rotation fits. As the body turns by `w` about its centroid, `H(R' n)` changes by
//! `w . (R x) x n` with the vertex `x` that touches, so a step of Gauss and Newton needs no differences.

use biplane_geometry::{Point3, Pose, Twist, Vector3};
use nalgebra::{Matrix3, Matrix6, Rotation3, UnitQuaternion, Vector6};

use crate::place::{Place, distinct};
use crate::support::Support;
use crate::tangent::Tangent;

/// Spacing of the rotations, degrees.
const SPACING_DEG: f64 = 10.0;
/// Of the rotations so many of the best are looked at, so many of them that are apart are refined roughly, and so many of those to
/// the end.
const KEPT: [usize; 3] = [600, 80, 32];
/// With so many of the tangent planes rotations are scanned and refined roughly.
const ROUGH_TANGENTS: usize = 40;
/// How far apart seeds are, degrees.
const SEED_APART_DEG: f64 = 12.0;
/// Steps of a refinement, rough and to the end.
const STEPS: (usize, usize) = (4, 12);
/// Refined poses nearer than this, rad and mm, are one.
const APART: (f64, f64) = (0.07, 4.0);

/// Rotations that turn +z to directions spread evenly, on a spiral (Saff and Kuijlaars 1997).
pub(crate) fn directions() -> Vec<UnitQuaternion<f64>> {
    let count = (4.0 * std::f64::consts::PI / SPACING_DEG.to_radians().powi(2)).round() as usize;
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let turned = |k: usize| {
        let z = 1.0 - (2 * k + 1) as f64 / count as f64;
        let polar = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), z.acos());
        UnitQuaternion::from_axis_angle(&Vector3::z_axis(), golden * k as f64) * polar
    };
    (0..count).map(turned).collect()
}

/// Rotations spread evenly: directions, each with turns about it.
pub(crate) fn rotations() -> Vec<UnitQuaternion<f64>> {
    let turns = (360.0 / SPACING_DEG).round() as usize;
    let turned = |(k, direction): (usize, UnitQuaternion<f64>)| {
        (0..turns).map(move |j| {
            let about = std::f64::consts::TAU * (j as f64 + 0.5 * (k % 2) as f64) / turns as f64;
            direction * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), about)
        })
    };
    directions().into_iter().enumerate().flat_map(turned).collect()
}

/// How well every rotation fits: the mean squared residual, mm^2, its translation taken out. `about` is near the body.
fn scan(
    support: &Support,
    tangents: &[Tangent],
    about: &Point3,
    rotations: &[UnitQuaternion<f64>],
) -> Vec<f32> {
    let mut matrix = Matrix3::zeros();
    tangents.iter().for_each(|t| matrix.syger(1.0, &t.normal, &t.normal, 1.0));
    matrix.fill_upper_triangle_with_lower_triangle();
    let Some(inverse) = matrix.try_inverse() else { return Vec::new() };
    let inverse = inverse.cast::<f32>();
    let planes: Vec<(nalgebra::Vector3<f32>, f32)> =
        tangents.iter().map(|t| (t.normal.cast(), t.normal.dot(&(t.source - about)) as f32)).collect();
    let of = |rotation: &UnitQuaternion<f64>| {
        let r: Matrix3<f32> = rotation.inverse().to_rotation_matrix().matrix().cast();
        let (mut squared, mut pull) = (0.0_f32, nalgebra::Vector3::zeros());
        for (n, offset) in &planes {
            let m = r * n;
            let residual = offset - support.coarse(m.x, m.y, m.z);
            squared += residual * residual;
            pull += n * residual;
        }
        (squared - pull.dot(&(inverse * pull))).max(0.0) / planes.len() as f32
    };
    rotations.iter().map(of).collect()
}

/// Gauss and Newton from a pose of the centroid.
fn refine(support: &Support, tangents: &[Tangent], start: &Pose, steps: usize) -> Option<Place> {
    let mut pose = *start;
    let mut misfit = f64::INFINITY;
    for step in 0..=steps {
        let r: Rotation3<f64> = pose.rotation().to_rotation_matrix();
        let (mut matrix, mut vector, mut squared) = (Matrix6::zeros(), Vector6::zeros(), 0.0);
        let centre = Point3::from(pose.translation());
        for t in tangents {
            let touching = r * support.farthest(&(r.inverse() * t.normal));
            let residual = t.normal.dot(&(t.source - centre - touching));
            let turn = touching.cross(&t.normal);
            let row = Vector6::new(t.normal.x, t.normal.y, t.normal.z, turn.x, turn.y, turn.z);
            matrix.syger(1.0, &row, &row, 1.0);
            vector += row * residual;
            squared += residual * residual;
        }
        matrix.fill_upper_triangle_with_lower_triangle();
        let now = (squared / tangents.len() as f64).sqrt();
        let settled = (misfit - now).abs() < 1e-3 * now;
        misfit = now;
        if step == steps || settled {
            break;
        }
        // The rotation's damping, mm^2: it holds what turns the body and moves no tangent plane.
        let damping = 1e-3 * matrix.fixed_view::<3, 3>(3, 3).trace() / 3.0;
        (3..6).for_each(|k| matrix[(k, k)] += damping);
        let solved = matrix.cholesky()?.solve(&vector);
        let rotation: Vector3 = solved.fixed_rows::<3>(3).into_owned();
        let shorten = (0.35 / rotation.norm().max(1e-12)).min(1.0);
        let twist =
            Twist { translation: solved.fixed_rows::<3>(0).into_owned(), rotation: rotation * shorten };
        pose = pose.moved(&twist, &centre);
    }
    let place = Place::of(&pose, misfit);
    (misfit.is_finite() && place.centre.coords.iter().all(|v| v.is_finite())).then_some(place)
}

/// The poses at which the tangent planes touch the body best, the best first, none near a better one; a misfit is the root mean square
/// distance of the planes from the body, mm. `about` is near the body.
pub(crate) fn search(
    support: &Support,
    tangents: &[Tangent],
    about: &Point3,
    rotations: &[UnitQuaternion<f64>],
    count: usize,
) -> Vec<Place> {
    let rough: Vec<Tangent> =
        tangents.iter().step_by(tangents.len().div_ceil(ROUGH_TANGENTS).max(1)).copied().collect();
    let misfits = scan(support, &rough, about, rotations);
    let mut order: Vec<u32> = (0..misfits.len() as u32).collect();
    let by = |a: &u32, b: &u32| misfits[*a as usize].total_cmp(&misfits[*b as usize]).then(a.cmp(b));
    if order.len() > KEPT[0] {
        order.select_nth_unstable_by(KEPT[0], by);
        order.truncate(KEPT[0]);
    }
    order.sort_unstable_by(by);
    // The angle between two rotations is twice the arc of their quaternions' dot product.
    let least = (SEED_APART_DEG.to_radians() / 2.0).cos();
    let mut seeds: Vec<UnitQuaternion<f64>> = Vec::new();
    for k in order {
        let q = rotations[k as usize];
        if seeds.len() < KEPT[1] && seeds.iter().all(|s| s.coords.dot(&q.coords).abs() < least) {
            seeds.push(q);
        }
    }
    let roughly =
        seeds.into_iter().filter_map(|q| refine(support, &rough, &Pose::new(q, about.coords), STEPS.0));
    let best = distinct(roughly.collect(), APART, KEPT[2]);
    let fully = best.iter().filter_map(|p| refine(support, tangents, &p.pose(), STEPS.1));
    distinct(fully.collect(), APART, count)
}
