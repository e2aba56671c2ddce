//! A whole trial at once: the most probable motion, given the matches with their covariances and that accelerations are moderate.
//!
//! **Prior.** Centroid and rotation each move with a velocity that changes by white acceleration (an integrated Wiener process; Bar-Shalom et al.,
//! "Estimation with applications to tracking and navigation", 2001, 6.2.2). Its intensity is given, or the one under which the matches are most
//! probable.
//!
//! **Solution.** A Kalman filter forward and a Rauch, Tung and Striebel smoother backward, whose errors are twists about the centroid along the
//! laboratory's axes, so rotations are never angles of a sequence. A pass is linear in the frames.
//!
//! **Covariances.** What the calibration brings to every frame alike is no noise that smoothing could take out: it is taken out of each match's
//! covariance before, and put back after.
//!
//! **Guaranteed:** raw poses are not changed; frames without a match are bridged only if asked. **Not guaranteed:** a motion that truly stops within
//! a frame, a heel strike, is rounded off like noise.

use biplane_artifact::{PoseRecord, SmoothedPose, SmoothedTrial};
use biplane_geometry::{Point3, Pose, Vector3};
use nalgebra::{Matrix3, Matrix6, SMatrix, SVector, UnitQuaternion, Vector6};

type Matrix12 = SMatrix<f64, 12, 12>;
type Vector12 = SVector<f64, 12>;

/// A frame with a match.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// `world_from_model`.
    pub pose: Pose,
    /// Covariance about the centroid, without what the calibration brings.
    pub covariance: Matrix6<f64>,
    /// What the calibration brings.
    pub calibration: Matrix6<f64>,
}

/// Where a body is, and how it moves.
#[derive(Debug, Clone, Copy)]
struct State {
    centre: Vector3,
    rotation: UnitQuaternion<f64>,
    /// Of the centroid, and of turning along the laboratory's axes.
    velocity: [Vector3; 2],
}

impl State {
    /// What leads from another state to this one.
    fn from(&self, other: &Self) -> Vector12 {
        let turn = (self.rotation * other.rotation.inverse()).scaled_axis();
        let mut off = Vector12::zeros();
        off.fixed_rows_mut::<3>(0).copy_from(&(self.centre - other.centre));
        off.fixed_rows_mut::<3>(3).copy_from(&turn);
        off.fixed_rows_mut::<3>(6).copy_from(&(self.velocity[0] - other.velocity[0]));
        off.fixed_rows_mut::<3>(9).copy_from(&(self.velocity[1] - other.velocity[1]));
        off
    }

    fn moved(&self, by: &Vector12) -> Self {
        let part = |k: usize| Vector3::new(by[k], by[k + 1], by[k + 2]);
        let mut rotation = UnitQuaternion::from_scaled_axis(part(3)) * self.rotation;
        rotation.renormalize();
        Self {
            centre: self.centre + part(0),
            rotation,
            velocity: [self.velocity[0] + part(6), self.velocity[1] + part(9)],
        }
    }

    fn after(&self, time: f64) -> Self {
        let turn = UnitQuaternion::from_scaled_axis(self.velocity[1] * time);
        Self {
            centre: self.centre + self.velocity[0] * time,
            rotation: turn * self.rotation,
            velocity: self.velocity,
        }
    }

    fn pose(&self, pivot: &Point3) -> Pose {
        Pose::new(self.rotation, self.centre - self.rotation * pivot.coords)
    }
}

/// What one frame gives in the forward pass.
#[derive(Clone)]
struct Step {
    predicted: State,
    predicted_covariance: Matrix12,
    filtered: State,
    covariance: Matrix12,
    /// From the frame before.
    transition: Matrix12,
}

/// Sums over the innovations.
#[derive(Debug, Clone, Copy, Default)]
struct Innovations {
    log_likelihood: f64,
    squared: [f64; 2],
    count: f64,
}

/// How errors, of which turns are along the laboratory's axes, go on over a time.
fn transition(state: &State, time: f64) -> Matrix12 {
    let mut f = Matrix12::identity();
    let turned = UnitQuaternion::from_scaled_axis(state.velocity[1] * time).to_rotation_matrix();
    f.fixed_view_mut::<3, 3>(3, 3).copy_from(turned.matrix());
    f.fixed_view_mut::<3, 3>(0, 6).copy_from(&(Matrix3::identity() * time));
    f.fixed_view_mut::<3, 3>(3, 9).copy_from(&(Matrix3::identity() * time));
    f
}

/// What white acceleration adds over a time.
fn noise(intensity: [f64; 2], time: f64) -> Matrix12 {
    let mut q = Matrix12::zeros();
    for k in 0..3 {
        for (part, density) in intensity.iter().enumerate() {
            let (place, speed) = (3 * part + k, 6 + 3 * part + k);
            q[(place, place)] = density * time.powi(3) / 3.0;
            q[(place, speed)] = density * time.powi(2) / 2.0;
            q[(speed, place)] = q[(place, speed)];
            q[(speed, speed)] = density * time;
        }
    }
    q
}

/// The forward pass from the first frame with a match; `None` where a covariance cannot be used.
fn forward(
    frames: &[(f64, Option<Measured>)],
    pivot: &Point3,
    intensity: [f64; 2],
) -> Option<(Vec<Step>, Innovations)> {
    let (first_at, first) = frames.iter().find_map(|(at, m)| Some((*at, (*m)?)))?;
    let known: Vec<(f64, Measured)> = frames.iter().filter_map(|(at, m)| Some((*at, (*m)?))).collect();
    // Unknown speed: as fast as the fastest step, many times over.
    let mut fastest = [1.0_f64, 0.1];
    for pair in known.windows(2) {
        let time = pair[1].0 - pair[0].0;
        let moved = pair[1].1.pose.error_against(&pair[0].1.pose, pivot);
        fastest = [fastest[0].max(moved.translation_mm / time), fastest[1].max(moved.rotation_rad / time)];
    }
    let mut state = State {
        centre: first.pose.transform(pivot).coords,
        rotation: first.pose.rotation(),
        velocity: [Vector3::zeros(); 2],
    };
    let mut covariance = Matrix12::zeros();
    covariance.fixed_view_mut::<6, 6>(0, 0).copy_from(&first.covariance);
    for k in 0..3 {
        covariance[(6 + k, 6 + k)] = (10.0 * fastest[0]).powi(2);
        covariance[(9 + k, 9 + k)] = (10.0 * fastest[1]).powi(2);
    }
    let mut sums = Innovations::default();
    let mut steps: Vec<Step> = Vec::with_capacity(frames.len());
    let mut last = first_at;
    for (at, measured) in frames {
        if *at < first_at {
            continue;
        }
        let begins = steps.is_empty();
        let time = at - last;
        let f = if begins { Matrix12::identity() } else { transition(&state, time) };
        let predicted = if begins { state } else { state.after(time) };
        let mut predicted_covariance =
            if begins { covariance } else { f * covariance * f.transpose() + noise(intensity, time) };
        predicted_covariance = (predicted_covariance + predicted_covariance.transpose()) * 0.5;
        (state, covariance) = (predicted, predicted_covariance);
        if let Some(measured) = measured.filter(|_| !begins) {
            let seen = State {
                centre: measured.pose.transform(pivot).coords,
                rotation: measured.pose.rotation(),
                ..state
            };
            let innovation: Vector6<f64> = seen.from(&state).fixed_rows::<6>(0).into();
            let spread: Matrix6<f64> = predicted_covariance.fixed_view::<6, 6>(0, 0) + measured.covariance;
            let factor = spread.cholesky()?;
            let gain = predicted_covariance.fixed_view::<12, 6>(0, 0) * factor.inverse();
            state = state.moved(&(gain * innovation));
            let mut left = Matrix12::identity();
            let taken = left.fixed_view::<12, 6>(0, 0) - gain;
            left.fixed_view_mut::<12, 6>(0, 0).copy_from(&taken);
            // Joseph's form stays a covariance whatever is rounded.
            covariance = left * predicted_covariance * left.transpose()
                + gain * measured.covariance * gain.transpose();
            let log_determinant: f64 = factor.l().diagonal().iter().map(|d| 2.0 * d.ln()).sum();
            sums.log_likelihood -= 0.5 * (log_determinant + innovation.dot(&factor.solve(&innovation)));
            for (k, squared) in sums.squared.iter_mut().enumerate() {
                let part = Vector3::from_fn(|i, _| innovation[3 * k + i]);
                let own: Matrix3<f64> = spread.fixed_view::<3, 3>(3 * k, 3 * k).into_owned();
                *squared += part.dot(&(own.try_inverse()? * part));
            }
            sums.count += 3.0;
        }
        if !state.centre.iter().all(|v| v.is_finite()) {
            return None;
        }
        steps.push(Step { predicted, predicted_covariance, filtered: state, covariance, transition: f });
        last = *at;
    }
    Some((steps, sums))
}

/// Intensities that are tried: decades around those of the motion's own second differences, finer from round to round.
const ROUNDS: [f64; 4] = [100.0, 10.0, 3.0, 1.4];

/// The intensities under which the matches are most probable.
fn most_probable(
    frames: &[(f64, Option<Measured>)],
    pivot: &Point3,
    given: [Option<f64>; 2],
) -> Option<[f64; 2]> {
    let known: Vec<(f64, Measured)> = frames.iter().filter_map(|(at, m)| Some((*at, (*m)?))).collect();
    let mut sums = [0.0; 2];
    let mut count = 0.0;
    for w in known.windows(3) {
        let [a, b, c] = [w[0], w[1], w[2]];
        let (first, second) = (b.0 - a.0, c.0 - b.0);
        let speed = |from: &(f64, Measured), to: &(f64, Measured), time: f64| {
            let moved = to.1.pose.transform(pivot) - from.1.pose.transform(pivot);
            let turned = (to.1.pose.rotation() * from.1.pose.rotation().inverse()).scaled_axis();
            [moved / time, turned / time]
        };
        let (before, after) = (speed(&a, &b, first), speed(&b, &c, second));
        let time = 0.5 * (first + second);
        for k in 0..2 {
            // White acceleration of density q changes a velocity by q t.
            sums[k] += (after[k] - before[k]).norm_squared() / (3.0 * time);
        }
        count += 1.0;
    }
    let start = |k: usize| given[k].unwrap_or(if count > 0.0 { (sums[k] / count).max(1e-12) } else { 1.0 });
    let mut best = [start(0), start(1)];
    let mut value = forward(frames, pivot, best)?.1.log_likelihood;
    for factor in ROUNDS {
        for k in (0..2).filter(|k| given[*k].is_none()) {
            for direction in [1.0 / factor, factor] {
                // On in one direction as long as it gets better.
                for _ in 0..8 {
                    let mut tried = best;
                    tried[k] *= direction;
                    let Some((_, found)) = forward(frames, pivot, tried) else { break };
                    if found.log_likelihood <= value {
                        break;
                    }
                    (best, value) = (tried, found.log_likelihood);
                }
            }
        }
    }
    Some(best)
}

/// Smooths the poses of a body; frames are in the order of their times, which grow. `intensity` of place (mm^2 / t^3) and of turning (rad^2 / t^3),
/// where it is given; `None` where fewer than three frames have a match, or a covariance cannot be used.
pub fn smooth(
    frames: &[(f64, Option<Measured>)],
    pivot: &Point3,
    intensity: [Option<f64>; 2],
    bridge: bool,
) -> Option<SmoothedTrial> {
    if frames.iter().filter(|f| f.1.is_some()).count() < 3 || frames.windows(2).any(|w| w[0].0 >= w[1].0) {
        return None;
    }
    let intensity = most_probable(frames, pivot, intensity)?;
    let (steps, sums) = forward(frames, pivot, intensity)?;
    let before = frames.len() - steps.len();
    let last_match = frames.iter().rposition(|f| f.1.is_some())?;
    let mut smoothed: Vec<(State, Matrix12)> = steps.iter().map(|s| (s.filtered, s.covariance)).collect();
    for k in (0..steps.len().saturating_sub(1)).rev() {
        let next = &steps[k + 1];
        let inverse = next.predicted_covariance.try_inverse()?;
        let gain = steps[k].covariance * next.transition.transpose() * inverse;
        let off = smoothed[k + 1].0.from(&next.predicted);
        let state = steps[k].filtered.moved(&(gain * off));
        let covariance =
            steps[k].covariance + gain * (smoothed[k + 1].1 - next.predicted_covariance) * gain.transpose();
        smoothed[k] = (state, (covariance + covariance.transpose()) * 0.5);
    }
    // The nearest match tells what the calibration brings to a bridged frame.
    let mut calibration = frames.iter().find_map(|f| f.1).map(|m| m.calibration)?;
    let mut moved_sums = [0.0; 2];
    let mut count = 0.0;
    let mut found: Vec<Option<SmoothedPose>> = vec![None; frames.len()];
    for (k, (state, covariance)) in smoothed.iter().enumerate() {
        let number = before + k;
        let measured = frames[number].1;
        calibration = measured.map_or(calibration, |m| m.calibration);
        if number > last_match || (measured.is_none() && !bridge) {
            continue;
        }
        let pose = state.pose(pivot);
        let own: Matrix6<f64> = covariance.fixed_view::<6, 6>(0, 0) + calibration;
        let moved = measured.map_or([0.0; 2], |m| {
            let off = pose.error_against(&m.pose, pivot);
            [off.translation_mm, off.rotation_rad]
        });
        if measured.is_some() {
            (0..2).for_each(|i| moved_sums[i] += moved[i] * moved[i]);
            count += 1.0;
        }
        found[number] = Some(SmoothedPose {
            pose: PoseRecord::from(pose),
            covariance: std::array::from_fn(|i| std::array::from_fn(|j| own[(i, j)])),
            measured: measured.is_some(),
            moved,
        });
    }
    Some(SmoothedTrial {
        frames: found,
        intensity,
        normalised_innovation: sums.squared.map(|s| s / sums.count.max(1.0)),
        moved: moved_sums.map(|s: f64| (s / f64::max(count, 1.0)).sqrt()),
    })
}

/// A pose after a small error, for tests and for drawing from a covariance.
#[cfg(test)]
fn off_by(pose: &Pose, twist: &Vector6<f64>, pivot: &Point3) -> Pose {
    let twist = biplane_geometry::Twist {
        translation: twist.fixed_rows::<3>(0).into(),
        rotation: twist.fixed_rows::<3>(3).into(),
    };
    pose.moved(&twist, &pose.transform(pivot))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::StdRng;
    use rand::{Rng, SeedableRng};
    use rand_distr::StandardNormal;

    const PIVOT: Vector3 = Vector3::new(4.0, -30.0, 9.0);

    /// A gait-like motion, 100 frames a second.
    fn truth(k: usize) -> Pose {
        let t = k as f64 / 100.0;
        let turn = UnitQuaternion::from_scaled_axis(Vector3::z() * (0.5 * (4.0 * t).sin()))
            * UnitQuaternion::from_scaled_axis(Vector3::new(
                0.1 * (6.0 * t).cos(),
                0.08 * (5.0 * t).sin(),
                0.0,
            ));
        let centre = Vector3::new(40.0 * (3.0 * t).sin(), 15.0 * (4.0 * t).cos(), 8.0 * (5.0 * t).sin());
        Pose::new(turn, centre - turn * PIVOT)
    }

    fn covariance() -> Matrix6<f64> {
        let sigma = Vector6::new(0.05, 0.08, 0.12, 0.002, 0.003, 0.0015);
        let mut c = Matrix6::from_diagonal(&sigma.map(|s| s * s));
        c[(0, 5)] = 0.4 * sigma[0] * sigma[5];
        c[(5, 0)] = c[(0, 5)];
        c
    }

    fn noisy(count: usize, rng: &mut StdRng) -> Vec<(f64, Option<Measured>)> {
        let half = covariance().cholesky().unwrap().l();
        (0..count)
            .map(|k| {
                let draw = half * Vector6::from_fn(|_, _| rng.sample::<f64, _>(StandardNormal));
                let pose = off_by(&truth(k), &draw, &Point3::from(PIVOT));
                let measured = Measured { pose, covariance: covariance(), calibration: Matrix6::zeros() };
                (k as f64 / 100.0, Some(measured))
            })
            .collect()
    }

    #[test]
    fn errors_fall_and_intervals_still_hold_the_truth() {
        let mut rng = StdRng::seed_from_u64(21);
        let pivot = Point3::from(PIVOT);
        let (mut raw, mut after, mut held, mut all) = ([0.0; 2], [0.0; 2], 0, 0);
        for _ in 0..20 {
            let frames = noisy(150, &mut rng);
            let found = smooth(&frames, &pivot, [None; 2], false).unwrap();
            for (k, ((_, measured), smooth)) in frames.iter().zip(&found.frames).enumerate() {
                let (smooth, truth) = (smooth.unwrap(), truth(k));
                let before = measured.unwrap().pose.error_against(&truth, &pivot);
                let pose = Pose::from(smooth.pose);
                let now = pose.error_against(&truth, &pivot);
                raw = [raw[0] + before.translation_mm.powi(2), raw[1] + before.rotation_rad.powi(2)];
                after = [after[0] + now.translation_mm.powi(2), after[1] + now.rotation_rad.powi(2)];
                let off = pose.transform(&pivot) - truth.transform(&pivot);
                let turn = (pose.rotation() * truth.rotation().inverse()).scaled_axis();
                for i in 0..6 {
                    let error = if i < 3 { off[i] } else { turn[i - 3] };
                    held += usize::from(error.abs() <= 1.96 * smooth.covariance[i][i].sqrt());
                    all += 1;
                }
            }
            assert!(
                found.normalised_innovation.iter().all(|n| (0.8..1.25).contains(n)),
                "{:?}",
                found.normalised_innovation
            );
        }
        let share = [0, 1].map(|k| (after[k] / raw[k]).sqrt());
        let coverage = held as f64 / all as f64;
        println!(
            "error left: {:.2} of place, {:.2} of turning; 95 % intervals hold {:.3}",
            share[0], share[1], coverage
        );
        assert!(share.iter().all(|s| *s < 0.6), "{share:?}");
        // A gait is smoother than white acceleration, so intervals are rather too wide than too narrow.
        assert!((0.93..0.985).contains(&coverage), "{coverage}");
    }

    #[test]
    fn gaps_are_bridged_only_if_asked_and_are_less_sure() {
        let mut rng = StdRng::seed_from_u64(22);
        let mut frames = noisy(60, &mut rng);
        for frame in &mut frames[20..26] {
            frame.1 = None;
        }
        let pivot = Point3::from(PIVOT);
        assert!(smooth(&frames, &pivot, [None; 2], false).unwrap().frames[22].is_none());
        let found = smooth(&frames, &pivot, [None; 2], true).unwrap();
        let (inside, outside) = (found.frames[22].unwrap(), found.frames[40].unwrap());
        assert!(!inside.measured && outside.measured);
        assert!(inside.covariance[0][0] > 2.0 * outside.covariance[0][0]);
        let off = Pose::from(inside.pose).error_against(&truth(22), &pivot);
        assert!(off.translation_mm < 4.0 * inside.covariance[0][0].sqrt().max(0.1), "{off:?}");
        // Nothing is said before the first match or after the last one.
        frames[0].1 = None;
        frames[59].1 = None;
        let found = smooth(&frames, &pivot, [None; 2], true).unwrap();
        assert!(found.frames[0].is_none() && found.frames[59].is_none());
    }

    #[test]
    fn what_the_calibration_brings_stays_whatever_is_smoothed() {
        let mut rng = StdRng::seed_from_u64(23);
        let mut frames = noisy(50, &mut rng);
        let common = Matrix6::from_diagonal(&Vector6::new(0.3, 0.3, 0.3, 0.01, 0.01, 0.01).map(|s| s * s));
        let pivot = Point3::from(PIVOT);
        let without = smooth(&frames, &pivot, [Some(1e5), Some(10.0)], false).unwrap();
        for frame in &mut frames {
            frame.1.as_mut().unwrap().calibration = common;
        }
        let with = smooth(&frames, &pivot, [Some(1e5), Some(10.0)], false).unwrap();
        let (a, b) = (without.frames[25].unwrap(), with.frames[25].unwrap());
        assert_eq!(a.pose, b.pose);
        assert!((b.covariance[0][0] - a.covariance[0][0] - 0.09).abs() < 1e-9);
    }

    #[test]
    fn few_frames_and_times_that_do_not_grow_are_not_smoothed() {
        let mut rng = StdRng::seed_from_u64(24);
        let pivot = Point3::from(PIVOT);
        let frames = noisy(2, &mut rng);
        assert!(smooth(&frames, &pivot, [None; 2], false).is_none());
        let mut frames = noisy(10, &mut rng);
        frames[5].0 = frames[4].0;
        assert!(smooth(&frames, &pivot, [None; 2], false).is_none());
        let mut frames = noisy(10, &mut rng);
        frames[5].1.as_mut().unwrap().covariance = Matrix6::from_element(f64::NAN);
        assert!(smooth(&frames, &pivot, [None; 2], false).is_none());
    }
}
