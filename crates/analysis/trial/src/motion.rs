//! Where a body is at a time between, before or after known poses.
//!
//! **Between** known poses: the polynomial through up to two on either side (Lagrange), of the centroid's place and of the rotation vector
//! from the nearest pose. **Beyond** them: at constant velocity from the last two, no farther than these are apart for each frame of the gap;
//! from one alone, where it was.
//!
//! **How far off** a prediction may be is stated as a multiple of the second difference of the motion over one frame (`spread`): a straight line
//! through poses at `t0` and `t1` errs at `t` by `|a (t - t0) (t - t1)| / 2` under the acceleration `a`. The cubic errs by less where the motion is smooth.

use biplane_geometry::{Point3, Pose, Vector3};
use nalgebra::UnitQuaternion;

/// A pose and when it was taken, in frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timed {
    /// When, in frames.
    pub at: f64,
    /// `world_from_model`.
    pub pose: Pose,
}

/// Where known poses say a body is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Predicted {
    /// `world_from_model`.
    pub pose: Pose,
    /// How far off it may be, in second differences of the motion over one frame; at least a half.
    pub spread: f64,
}

/// Where a body is at `at`, by `known` poses in the order of their times; `pivot` is the middle of the body (model, mm). `None` if nothing is
/// known, or times do not grow.
pub fn predict(known: &[Timed], at: f64, pivot: &Point3) -> Option<Predicted> {
    if known.windows(2).any(|w| w[0].at >= w[1].at) || !at.is_finite() {
        return None;
    }
    let after = known.partition_point(|k| k.at <= at);
    if let Some(exact) = after.checked_sub(1).and_then(|k| known.get(k)).filter(|k| k.at == at) {
        return Some(Predicted { pose: exact.pose, spread: 0.5 });
    }
    let used = match (after, known.len() - after) {
        (0, 0) => return None,
        (0, _) => &known[..known.len().min(2)],
        (_, 0) => &known[known.len().saturating_sub(2)..],
        _ => &known[after.saturating_sub(2)..known.len().min(after + 2)],
    };
    let inside = used[0].at < at && at < used[used.len() - 1].at;
    let nearest = used.iter().min_by(|a, b| (a.at - at).abs().total_cmp(&(b.at - at).abs()))?;
    let weights: Vec<f64> = if inside {
        let weight = |i: usize| {
            let others = used.iter().enumerate().filter(|(j, _)| *j != i);
            others.map(|(_, o)| (at - o.at) / (used[i].at - o.at)).product()
        };
        (0..used.len()).map(weight).collect()
    } else if let [a, b] = used {
        let t = (at - a.at) / (b.at - a.at);
        vec![1.0 - t, t]
    } else {
        vec![1.0]
    };
    let mut centre = Vector3::zeros();
    let mut turn = Vector3::zeros();
    for (weight, known) in weights.iter().zip(used) {
        centre += known.pose.transform(pivot).coords * *weight;
        turn += (known.pose.rotation() * nearest.pose.rotation().inverse()).scaled_axis() * *weight;
    }
    let rotation = UnitQuaternion::from_scaled_axis(turn) * nearest.pose.rotation();
    let pose = Pose::new(rotation, centre - rotation * pivot.coords);
    // A straight line through the two that it lies between or beyond.
    let mut apart: Vec<f64> = used.iter().map(|k| (k.at - at).abs()).collect();
    apart.sort_by(f64::total_cmp);
    let spread = match apart[..] {
        // Nothing is known of its speed: it may be that of a body that has just begun to move.
        [only] => 0.5 * only * (only + 1.0),
        [first, second, ..] => 0.5 * first * second,
        [] => return None,
    };
    let finite = pose.translation().iter().all(|v| v.is_finite());
    finite.then_some(Predicted { pose, spread: spread.max(0.5) })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A body that runs along a parabola and turns about two axes.
    fn moving(at: f64) -> Pose {
        let rotation = UnitQuaternion::from_euler_angles(0.02 * at, 3.0 + 0.03 * at, -0.01 * at);
        let centre = Vector3::new(0.5 * at, 10.0 - 0.02 * at * at, 0.3 * at);
        Pose::new(rotation, centre - rotation * PIVOT)
    }

    const PIVOT: Vector3 = Vector3::new(3.0, -40.0, 12.0);

    fn known(times: &[f64]) -> Vec<Timed> {
        times.iter().map(|at| Timed { at: *at, pose: moving(*at) }).collect()
    }

    fn off(times: &[f64], at: f64) -> (f64, f64, f64) {
        let pivot = Point3::from(PIVOT);
        let found = predict(&known(times), at, &pivot).unwrap();
        let error = found.pose.error_against(&moving(at), &pivot);
        (error.translation_mm, error.rotation_rad, found.spread)
    }

    #[test]
    fn between_four_poses_a_smooth_motion_is_met() {
        let (mm, rad, spread) = off(&[0.0, 1.0, 3.0, 4.0], 2.0);
        assert!(mm < 1e-9 && rad < 1e-5, "a parabola is no effort: {mm} {rad}");
        assert_eq!(spread, 0.5);
        let (mm, rad, spread) = off(&[0.0, 10.0], 3.0);
        assert!((mm - 0.02 * 21.0).abs() < 1e-9 && rad < 1e-2, "a straight line: {mm} {rad}");
        assert_eq!(spread, 10.5);
    }

    #[test]
    fn errors_stay_within_the_spread_of_the_second_difference() {
        // Second difference over one frame: 0.04 mm.
        for (times, at) in [
            (&[4.0, 5.0][..], 6.0),
            (&[4.0, 5.0], 8.0),
            (&[9.0, 10.0], 7.0),
            (&[2.0, 4.0, 8.0], 6.0),
            (&[2.0, 8.0, 9.0], 5.0),
        ] {
            let (mm, _, spread) = off(times, at);
            assert!(mm <= 0.04 * spread + 1e-9, "{times:?} {at}: {mm} {spread}");
        }
    }

    #[test]
    fn one_pose_stays_where_it_is_and_a_known_time_is_itself() {
        let pivot = Point3::from(PIVOT);
        assert_eq!(
            predict(&known(&[5.0]), 7.0, &pivot).unwrap().pose.translation(),
            moving(5.0).translation()
        );
        assert_eq!(predict(&known(&[5.0, 6.0]), 6.0, &pivot).unwrap().pose, moving(6.0));
        assert_eq!(predict(&[], 1.0, &pivot), None);
        assert_eq!(predict(&known(&[2.0, 2.0]), 1.0, &pivot), None, "two poses at one time");
        assert_eq!(predict(&known(&[1.0, 2.0]), f64::NAN, &pivot), None);
    }
}
