//! The six values of a joint and their covariance.
//!
//! With `R = R(e1, a) R(e2, b) R(e3, c)` the distal body turns against the proximal one at `a' e1 + b' e2 + c' e3`, so the derivative of the
//! angles by the two bodies' turns is the inverse of the matrix `[e1 e2 e3]`: exact, and without end where `e1` and `e3` are parallel. `H`, the
//! vector between the origins, moves with the twists of both.
//!
//! **Covariances.** A pose's own errors are independent of the other body's. What the calibration brings moves both bodies of a frame together:
//! its parts are taken as wholly correlated, by their symmetric square roots, so that it cancels in the joint as far as both bodies move alike.
//! Calibration errors that move the two differently are as small as the bodies are near each other, and are not in what is stated.

use biplane_artifact::{BodyAxes, Match, PoseRecord, Side};
use biplane_geometry::{Point3, Pose, Vector3};
use nalgebra::{Matrix3, Matrix6, SMatrix, Vector6};

use crate::convention::{Convention, unit};

/// A body's axes, in its model's coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Where they begin, mm.
    pub origin: Point3,
    /// Unit vectors along x, y and z, as columns.
    pub axes: Matrix3<f64>,
    /// The mesh's area centroid, which covariances of poses are about, mm.
    pub centroid: Point3,
}

impl Frame {
    /// The axes of a body; those of its model where it has none.
    pub fn new(axes: Option<&BodyAxes>, centroid: Point3) -> Self {
        let origin = axes.map_or(Point3::origin(), |a| Point3::from(a.origin_mm));
        let matrix = |a: &BodyAxes| Matrix3::from_columns(&a.axes.map(Vector3::from));
        Self { origin, axes: axes.map_or_else(Matrix3::identity, matrix), centroid }
    }
}

/// The values of a joint.
#[derive(Debug, Clone, PartialEq)]
pub struct JointValues {
    /// The distal body's axes in those of the proximal one.
    pub proximal_from_distal: PoseRecord,
    /// Three angles, rad, and three translations, mm, with the signs of the convention.
    pub values: [f64; 6],
    /// Their covariance; none at a gimbal's lock, or where a match does not say how sure it is.
    pub covariance: Option<Matrix6<f64>>,
}

/// Standard deviations from here on say that nothing is known.
const UNKNOWN: f64 = 1e100;
/// Axes with a smaller determinant do not tell three turns apart.
const LOCKED: f64 = 1e-6;

fn rows(of: &[[f64; 6]; 6]) -> Matrix6<f64> {
    Matrix6::from_fn(|i, j| of[i][j])
}

/// The symmetric square root of a covariance.
fn root(of: &Matrix6<f64>) -> Matrix6<f64> {
    let parts = of.symmetric_eigen();
    parts.eigenvectors
        * Matrix6::from_diagonal(&parts.eigenvalues.map(|v| v.max(0.0).sqrt()))
        * parts.eigenvectors.transpose()
}

/// The values of the joint between two bodies, each with its match and its axes.
pub fn joint_values(
    (proximal, of_proximal): (&Match, &Frame),
    (distal, of_distal): (&Match, &Frame),
    convention: Convention,
    side: Side,
) -> JointValues {
    let poses = [Pose::from(proximal.pose), Pose::from(distal.pose)];
    let frames = [of_proximal, of_distal];
    let turned = |k: usize| poses[k].rotation().to_rotation_matrix().into_inner() * frames[k].axes;
    let (first, second) = (turned(0), turned(1));
    let origins = [0, 1].map(|k: usize| poses[k].transform(&frames[k].origin));
    let between = origins[1] - origins[0];
    let relative = first.transpose() * second;
    let offset = first.transpose() * between;
    let rotation = nalgebra::UnitQuaternion::from_matrix(&relative);
    let sequence = convention.sequence();
    let angles = sequence.angles(&relative);
    // Axes of the turns in the laboratory: fixed to the proximal body, floating, fixed to the distal body.
    let e1 = first * unit(sequence.0[0]);
    let e2 = {
        let turn = nalgebra::Rotation3::from_axis_angle(
            &nalgebra::Unit::new_unchecked(unit(sequence.0[0])),
            angles[0],
        );
        first * (turn * unit(sequence.0[1]))
    };
    let e3 = second * unit(sequence.0[2]);
    let along: [Vector3; 3] = match convention {
        Convention::GroodSuntay => [e1, e2, e3],
        _ => [0, 1, 2].map(|k| first * unit(k)),
    };
    let signs = convention.signs(side);
    let values: [f64; 6] = std::array::from_fn(|k| {
        let value = if k < 3 { angles[k] } else { between.dot(&along[k - 3]) };
        // No minus zero.
        signs[k] * value + 0.0
    });
    let covariance = derivative(&poses, frames, [e1, e2, e3], &along, &between, &origins, convention)
        .and_then(|by_twists| {
            let signed = SMatrix::<f64, 6, 12>::from_fn(|i, j| signs[i] * by_twists[(i, j)]);
            total(&signed, proximal, distal)
        });
    let proximal_from_distal = PoseRecord::from(Pose::new(rotation, offset));
    JointValues { proximal_from_distal, values, covariance }
}

/// Derivative of the values (without signs) by the twists of the two bodies; none at a lock.
fn derivative(
    poses: &[Pose; 2],
    frames: [&Frame; 2],
    [e1, e2, e3]: [Vector3; 3],
    along: &[Vector3; 3],
    between: &Vector3,
    origins: &[Point3; 2],
    convention: Convention,
) -> Option<SMatrix<f64, 6, 12>> {
    let axes = Matrix3::from_columns(&[e1, e2, e3]);
    let turns = axes.try_inverse().filter(|_| axes.determinant().abs() > LOCKED)?;
    let mut by = SMatrix::<f64, 6, 12>::zeros();
    // Turns: those of the distal body less those of the proximal one.
    by.fixed_view_mut::<3, 3>(0, 3).copy_from(&-turns);
    by.fixed_view_mut::<3, 3>(0, 9).copy_from(&turns);
    for (k, axis) in along.iter().enumerate() {
        let row = 3 + k;
        // H = o2 - o1; an origin moves by the translation and by the turn about the centroid.
        for (body, sign) in [(0, -1.0), (1, 1.0)] {
            let arm = origins[body] - poses[body].transform(&frames[body].centroid);
            for j in 0..3 {
                by[(row, 6 * body + j)] += sign * axis[j];
                // (w x arm) . axis = w . (arm x axis)
                by[(row, 6 * body + 3 + j)] += sign * arm.cross(axis)[j];
            }
        }
        // The axis turns with the body it is fixed to: H . (w x axis) = w . (axis x H).
        let mut fixed = |body: usize, swing: &Vector3| {
            for j in 0..3 {
                by[(row, 6 * body + 3 + j)] += swing[j];
            }
        };
        match (convention, k) {
            (Convention::GroodSuntay, 1) => {
                // e2 = n / |n|, n = e3 x e1, and n' = (w2 x e3) x e1 + e3 x (w1 x e1).
                let n = e3.cross(&e1);
                let across = (between - e2 * e2.dot(between)) / n.norm();
                // across . ((w x e3) x e1) = w . (e3 x (e1 x across)), across . (e3 x (w x e1)) = w . (e1 x (across x e3)).
                fixed(1, &e3.cross(&e1.cross(&across)));
                fixed(0, &e1.cross(&across.cross(&e3)));
            }
            (Convention::GroodSuntay, 2) => fixed(1, &axis.cross(between)),
            _ => fixed(0, &axis.cross(between)),
        }
    }
    Some(by)
}

/// Covariance of the values from those of both matches.
fn total(by: &SMatrix<f64, 6, 12>, proximal: &Match, distal: &Match) -> Option<Matrix6<f64>> {
    let mut sum = Matrix6::zeros();
    let mut common = Matrix6::zeros();
    for (body, of) in [proximal, distal].into_iter().enumerate() {
        let by = by.fixed_view::<6, 6>(0, 6 * body).into_owned();
        let whole = rows(&of.covariance);
        if whole.iter().any(|v| !v.is_finite() || v.abs() > UNKNOWN) {
            return None;
        }
        let calibration = of.calibration_covariance.as_ref().map_or_else(Matrix6::zeros, rows);
        sum += by * (whole - calibration) * by.transpose();
        common += by * root(&calibration);
    }
    let total = sum + common * common.transpose();
    // What is left of rounding.
    Some((total + total.transpose()) * 0.5)
}

impl JointValues {
    /// Standard deviations of the values, where they are known.
    pub fn sigmas(&self) -> Option<Vector6<f64>> {
        self.covariance.map(|c| c.diagonal().map(|v| v.max(0.0).sqrt()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_artifact::{StartsTried, Verdict};
    use biplane_geometry::Twist;
    use nalgebra::UnitQuaternion;
    use rand::rngs::StdRng;
    use rand::{Rng, SeedableRng};
    use rand_distr::StandardNormal;

    fn matched(pose: Pose, covariance: Matrix6<f64>, calibration: Option<Matrix6<f64>>) -> Match {
        let rows = |m: Matrix6<f64>| std::array::from_fn(|i| std::array::from_fn(|j| m[(i, j)]));
        Match {
            pose: pose.into(),
            verdict: Verdict::Good,
            reason: String::new(),
            views: vec![],
            objective: 0.1,
            covariance: rows(covariance),
            calibration_covariance: calibration.map(rows),
            interval_95: [0.0; 6],
            starts: StartsTried { tried: 1, converged: 1, spread: None },
            alternative: None,
            iterations: 1,
        }
    }

    fn knee(flexion: f64, varus: f64, internal: f64, tibia: [f64; 3], side: Side) -> [f64; 6] {
        // A right-handed leg in the laboratory: x anterior, y up, z right; the femur stands still.
        let side_sign = if side == Side::Left { -1.0 } else { 1.0 };
        let about = |axis: Vector3, angle: f64| UnitQuaternion::from_scaled_axis(axis * angle);
        // The foot goes back: the tibia turns about -z. It goes to the middle: for a right knee to -z, about +x. Toes in: about +y.
        let turn = about(-Vector3::z(), flexion)
            * about(Vector3::x() * side_sign, varus)
            * about(Vector3::y() * side_sign, internal);
        let frame = Frame { origin: Point3::origin(), axes: Matrix3::identity(), centroid: Point3::origin() };
        let still = matched(Pose::identity(), Matrix6::identity() * 1e-4, None);
        let moved = matched(Pose::new(turn, Vector3::from(tibia)), Matrix6::identity() * 1e-4, None);
        joint_values((&still, &frame), (&moved, &frame), Convention::GroodSuntay, side).values
    }

    #[test]
    fn each_clinical_motion_has_its_name_and_sign_on_both_sides() {
        for side in [Side::Right, Side::Left] {
            let lateral = if side == Side::Left { -1.0 } else { 1.0 };
            let found = knee(0.5, 0.1, 0.2, [0.0; 3], side);
            for (a, b) in found.iter().zip([0.5, 0.1, 0.2, 0.0, 0.0, 0.0]) {
                assert!((a - b).abs() < 1e-12, "{side:?} {found:?}");
            }
            // Straight: outwards 2, forward 3, 4 away from the femur.
            let found = knee(0.0, 0.0, 0.0, [3.0, -4.0, 2.0 * lateral], side);
            assert_eq!(found[3..], [2.0, 3.0, 4.0], "{side:?}");
            // The bare foot of a flexed knee: what is distal along the tibia is distraction.
            let found = knee(1.5, 0.0, 0.0, [-40.0 * 1.5f64.sin(), -40.0 * 1.5f64.cos(), 0.0], side);
            assert!((found[5] - 40.0).abs() < 1e-9 && found[4].abs() < 1e-9, "{found:?}");
        }
    }

    /// Any pose.
    fn any(rng: &mut StdRng, turn: f64) -> Pose {
        let mut v = |size: f64| Vector3::from_fn(|_, _| size * rng.random_range(-1.0..1.0));
        Pose::new(UnitQuaternion::from_scaled_axis(v(turn)), v(80.0))
    }

    fn any_frame(rng: &mut StdRng) -> Frame {
        let pose = any(rng, 3.0);
        Frame {
            origin: Point3::from(pose.translation() * 0.5),
            axes: pose.rotation().to_rotation_matrix().into_inner(),
            centroid: Point3::from(any(rng, 1.0).translation() * 0.3),
        }
    }

    #[test]
    fn derivatives_are_those_of_finite_differences() {
        let mut rng = StdRng::seed_from_u64(5);
        for convention in [Convention::GroodSuntay, Convention::Xyz, Convention::Zxz, Convention::Yxz] {
            for _ in 0..50 {
                let frames = [any_frame(&mut rng), any_frame(&mut rng)];
                let poses = [any(&mut rng, 3.0), any(&mut rng, 3.0)];
                let values = |poses: &[Pose; 2]| {
                    let of = |k: usize| matched(poses[k], Matrix6::identity(), None);
                    joint_values((&of(0), &frames[0]), (&of(1), &frames[1]), convention, Side::Left).values
                };
                let mut by = SMatrix::<f64, 6, 12>::zeros();
                let step = 1e-6;
                for k in 0..12 {
                    let moved = |sign: f64| {
                        let mut twist = Twist { translation: Vector3::zeros(), rotation: Vector3::zeros() };
                        let part = if k % 6 < 3 { &mut twist.translation } else { &mut twist.rotation };
                        part[k % 3] = sign * step;
                        let mut poses = poses;
                        let body = k / 6;
                        poses[body] =
                            poses[body].moved(&twist, &poses[body].transform(&frames[body].centroid));
                        values(&poses)
                    };
                    let (high, low) = (moved(1.0), moved(-1.0));
                    for i in 0..6 {
                        by[(i, k)] = (high[i] - low[i]) / (2.0 * step);
                    }
                }
                let covariances: [Matrix6<f64>; 2] = std::array::from_fn(|_| {
                    let half = Matrix6::from_fn(|_, _| rng.random_range(-0.1..0.1));
                    half * half.transpose()
                });
                let expected = by.fixed_view::<6, 6>(0, 0)
                    * covariances[0]
                    * by.fixed_view::<6, 6>(0, 0).transpose()
                    + by.fixed_view::<6, 6>(0, 6) * covariances[1] * by.fixed_view::<6, 6>(0, 6).transpose();
                let of = |k: usize| matched(poses[k], covariances[k], None);
                let found = joint_values((&of(0), &frames[0]), (&of(1), &frames[1]), convention, Side::Left);
                let found = found.covariance.unwrap();
                let size = expected.abs().max();
                assert!((found - expected).abs().max() < 1e-4 * size, "{convention:?}\n{found}\n{expected}");
            }
        }
    }

    #[test]
    fn the_stated_spread_is_that_of_poses_drawn_from_their_covariances() {
        let mut rng = StdRng::seed_from_u64(6);
        let frames = [any_frame(&mut rng), any_frame(&mut rng)];
        let poses = [any(&mut rng, 1.0), any(&mut rng, 1.0)];
        let half = Matrix6::from_fn(|i, _| rng.random_range(-0.02..0.02) * if i < 3 { 1.0 } else { 0.02 });
        let own = half * half.transpose() + Matrix6::identity() * 1e-8;
        let draw_from = own.cholesky().unwrap().l();
        let values = |poses: [Pose; 2]| {
            let of = |k: usize| matched(poses[k], own, None);
            joint_values((&of(0), &frames[0]), (&of(1), &frames[1]), Convention::GroodSuntay, Side::Right)
        };
        let truth = values(poses);
        let stated = truth.covariance.unwrap();
        let count = 20_000;
        let mut sum = Matrix6::zeros();
        for _ in 0..count {
            let mut moved = poses;
            for (pose, frame) in moved.iter_mut().zip(&frames) {
                let draw = draw_from * Vector6::from_fn(|_, _| rng.sample::<f64, _>(StandardNormal));
                let twist = Twist {
                    translation: draw.fixed_rows::<3>(0).into(),
                    rotation: draw.fixed_rows::<3>(3).into(),
                };
                *pose = pose.moved(&twist, &pose.transform(&frame.centroid));
            }
            let off = Vector6::from(values(moved).values) - Vector6::from(truth.values);
            sum += off * off.transpose() / f64::from(count);
        }
        for i in 0..6 {
            let ratio = (sum[(i, i)] / stated[(i, i)]).sqrt();
            assert!((ratio - 1.0).abs() < 0.03, "value {i}: {ratio}");
        }
    }

    #[test]
    fn what_the_calibration_moves_alike_cancels_in_the_joint() {
        let mut rng = StdRng::seed_from_u64(7);
        let frame = Frame { origin: Point3::origin(), axes: Matrix3::identity(), centroid: Point3::origin() };
        let pose = any(&mut rng, 0.5);
        let noise = Matrix6::identity() * 1e-6;
        let calibration = Matrix6::from_diagonal(&Vector6::new(0.04, 0.09, 0.01, 1e-6, 1e-6, 1e-6));
        let of = |pose| matched(pose, noise + calibration, Some(calibration));
        let sure = |pose| matched(pose, noise, None);
        let values = |a: Match, b: Match| {
            let found = joint_values((&a, &frame), (&b, &frame), Convention::GroodSuntay, Side::Right);
            found.sigmas().unwrap()
        };
        let (with, without) = (values(of(pose), of(pose)), values(sure(pose), sure(pose)));
        assert!((with - without).abs().max() < 1e-9, "bodies at one place: {with} {without}");
    }

    #[test]
    fn a_lock_and_unknown_covariances_state_no_spread() {
        let frame = Frame { origin: Point3::origin(), axes: Matrix3::identity(), centroid: Point3::origin() };
        let at = |turn: f64, size: f64| {
            let pose = Pose::new(UnitQuaternion::from_scaled_axis(Vector3::x() * turn), Vector3::zeros());
            matched(pose, Matrix6::identity() * size, None)
        };
        let of = |distal: Match| {
            joint_values((&at(0.0, 1.0), &frame), (&distal, &frame), Convention::GroodSuntay, Side::Right)
                .covariance
        };
        assert!(of(at(0.3, 1.0)).is_some());
        assert!(of(at(std::f64::consts::FRAC_PI_2, 1.0)).is_none());
        assert!(of(at(0.3, f64::MAX)).is_none());
    }
}
