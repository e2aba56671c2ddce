//! Which frames do not go with their neighbours: single ones, and runs that leave for another basin and come back.
//!
//! The step from one known frame to the next has a velocity, of the centroid and of turning. It is compared with all that lies between the median of
//! up to three steps before and that of three after: so a body may stop, or turn round, within a frame. What a step deviates by is usual up to `factor` times the median of all the trial's steps: a fast
//! motion has a large median. Where it deviates by more the trial breaks in two.
//!
//! Of the segments between breaks the chain with the most frames is kept whose members go on from each other in the same way, over what
//! lies between; frames outside it jump.
//!
//! **Guaranteed:** fewer than [`LEAST_FRAMES`] known frames, and a trial without a break, have no jump. **Not guaranteed:** that of two
//! halves of a trial the right one is kept: the longer one is.

use biplane_geometry::{Point3, Vector3};

use crate::motion::Timed;

/// With fewer known frames nothing can be said of what is usual.
pub(crate) const LEAST_FRAMES: usize = 6;
/// Steps on either side that a step is compared with.
const BESIDE: usize = 3;
/// Segments are joined over at most so many others.
const LOOK_BACK: usize = 40;

/// From where on a step is a jump.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JumpParams {
    /// Times what is usual in the trial.
    pub factor: f64,
    /// And at least this for one frame, mm.
    pub least_mm: f64,
    /// And at least this for one frame, rad.
    pub least_rad: f64,
}

/// What was found.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Jumps {
    /// Numbers of the frames that jump, in order.
    pub frames: Vec<usize>,
    /// What the trial's own motion deviates by over one frame, median, mm;
    pub usual_mm: f64,
    /// and rad.
    pub usual_rad: f64,
}

/// Median of each component.
fn median(mut values: Vec<Vector3>) -> Vector3 {
    Vector3::from_fn(|i, _| {
        values.sort_by(|a, b| a[i].total_cmp(&b[i]));
        let middle = values.len() / 2;
        match values.len() {
            0 => 0.0,
            n if n % 2 == 1 => values[middle][i],
            _ => 0.5 * (values[middle - 1][i] + values[middle][i]),
        }
    })
}

/// Velocity of the centroid (mm a frame) and of turning (rad a frame) from one pose to another.
fn velocity(from: &Timed, to: &Timed, pivot: &Point3) -> [Vector3; 2] {
    let frames = to.at - from.at;
    let moved = to.pose.transform(pivot) - from.pose.transform(pivot);
    let turned = (to.pose.rotation() * from.pose.rotation().inverse()).scaled_axis();
    [moved / frames, turned / frames]
}

/// By how many frames what is beside a step lies after it in the mean: at the ends of a trial its speed is compared with that of later or
/// earlier steps, and a body speeds up.
fn aside(before: usize, after: usize) -> f64 {
    let (before, after) = (before.min(BESIDE) as f64, after.min(BESIDE) as f64);
    let places = |n: f64| n * (n + 1.0) / 2.0;
    if before + after > 0.0 { (places(after) - places(before)).abs() / (before + after) } else { 0.0 }
}

/// By how much a step's velocity lies off all that is between what the steps before it and those after it do in the middle: a body that stops
/// or turns round within a frame or two, as in a landing, does not jump.
fn deviation(step: &[Vector3; 2], before: &[[Vector3; 2]], after: &[[Vector3; 2]]) -> [f64; 2] {
    let (before, after) = (&before[before.len().saturating_sub(BESIDE)..], &after[..after.len().min(BESIDE)]);
    [0, 1].map(|k| {
        let middle = |steps: &[[Vector3; 2]]| median(steps.iter().map(|v| v[k]).collect());
        let (from, to) = match (before.is_empty(), after.is_empty()) {
            (true, true) => (Vector3::zeros(), Vector3::zeros()),
            (true, false) => (middle(after), middle(after)),
            (false, true) => (middle(before), middle(before)),
            (false, false) => (middle(before), middle(after)),
        };
        let along = to - from;
        let length = along.norm_squared();
        let share = if length > 0.0 { ((step[k] - from).dot(&along) / length).clamp(0.0, 1.0) } else { 0.0 };
        (step[k] - from - along * share).norm()
    })
}

/// Which of the frames of a trial, `None` where nothing is known, do not go with the others. `pivot` is the middle of the body (model, mm).
pub fn jumps(frames: &[Option<Timed>], pivot: &Point3, params: &JumpParams) -> Jumps {
    let known: Vec<(usize, Timed)> =
        frames.iter().enumerate().filter_map(|(i, f)| Some((i, (*f)?))).collect();
    let ordered = known.windows(2).all(|w| w[0].1.at < w[1].1.at);
    if known.len() < LEAST_FRAMES || !ordered {
        return Jumps::default();
    }
    let steps: Vec<[Vector3; 2]> = known.windows(2).map(|w| velocity(&w[0].1, &w[1].1, pivot)).collect();
    let deviations: Vec<[f64; 2]> =
        (0..steps.len()).map(|k| deviation(&steps[k], &steps[..k], &steps[k + 1..])).collect();
    let usual = [0, 1].map(|i| {
        let mut all: Vec<f64> = deviations.iter().map(|d| d[i]).collect();
        all.sort_by(f64::total_cmp);
        all[all.len() / 2]
    });
    let least = [params.least_mm, params.least_rad];
    // Velocities that differ by so much a frame; over a gap a body may speed up and slow down.
    let limit = |i: usize, frames: f64| (params.factor * usual[i] * frames).max(least[i] / frames);
    let apart = |k: usize| known[k + 1].1.at - known[k].1.at;
    let breaks = (0..steps.len())
        .filter(|k| {
            let aside = aside(*k, steps.len() - 1 - k);
            (0..2).any(|i| deviations[*k][i] > (1.0 + aside) * limit(i, apart(*k).max(1.0)))
        })
        .collect::<Vec<_>>();
    let mut result = Jumps { frames: Vec::new(), usual_mm: usual[0], usual_rad: usual[1] };
    if breaks.is_empty() {
        return result;
    }
    // Segments of known frames, first and last.
    let firsts = std::iter::once(0).chain(breaks.iter().map(|k| k + 1));
    let lasts = breaks.iter().copied().chain(std::iter::once(known.len() - 1));
    let segments: Vec<[usize; 2]> = firsts.zip(lasts).map(|(first, last)| [first, last]).collect();
    let goes_on = |a: [usize; 2], b: [usize; 2]| {
        let (from, to) = (&known[a[1]].1, &known[b[0]].1);
        let step = velocity(from, to, pivot);
        let (before, after) = (&steps[a[0]..a[1]], &steps[b[0]..b[1]]);
        let off = deviation(&step, before, after);
        let frames = (to.at - from.at).max(1.0);
        let aside = aside(before.len(), after.len());
        (0..2).all(|i| off[i] <= (1.0 + aside) * limit(i, frames))
    };
    // The chain with the most frames that ends with each segment.
    let size = |s: [usize; 2]| s[1] - s[0] + 1;
    let mut best: Vec<(usize, Option<usize>)> = Vec::with_capacity(segments.len());
    for (k, segment) in segments.iter().enumerate() {
        let mut chain = (size(*segment), None);
        for before in (k.saturating_sub(LOOK_BACK)..k).rev() {
            let frames = best[before].0 + size(*segment);
            if frames > chain.0 && goes_on(segments[before], *segment) {
                chain = (frames, Some(before));
            }
        }
        best.push(chain);
    }
    let mut kept = vec![false; segments.len()];
    let mut at = (0..best.len()).rev().max_by_key(|k| best[*k].0);
    while let Some(k) = at {
        kept[k] = true;
        at = best[k].1;
    }
    let out = segments.iter().zip(&kept).filter(|(_, kept)| !**kept);
    result.frames = out.flat_map(|(s, _)| s[0]..=s[1]).map(|k| known[k].0).collect();
    result
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_geometry::{Pose, Twist};
    use nalgebra::UnitQuaternion;
    use rand::rngs::StdRng;
    use rand::{Rng, SeedableRng};

    const PARAMS: JumpParams = JumpParams { factor: 8.0, least_mm: 1.0, least_rad: 0.035 };

    /// A motion of a joint: flexion through up to 115 degrees and back in 25 frames or more, with smaller swings about the other axes, a path of
    /// some centimetres, and noise of matched poses.
    fn trial(rng: &mut StdRng, count: usize) -> Vec<Option<Timed>> {
        let waves: Vec<[f64; 3]> = (0..6)
            .map(|axis| {
                let size = [20.0, 10.0, 10.0, 1.0, 0.15, 0.15][axis] * rng.random_range(0.2..1.0);
                let times = (count as f64 / 25.0).min(4.0);
                [size, rng.random_range(0.5..1.0) * times, rng.random_range(0.0..6.3)]
            })
            .collect();
        let mut noise = |sigma: f64| sigma * (0..12).map(|_| rng.random::<f64>() - 0.5).sum::<f64>();
        (0..count)
            .map(|k| {
                let phase = std::f64::consts::TAU * k as f64 / count as f64;
                let value = |axis: usize| {
                    let [size, times, start] = waves[axis];
                    size * (times * phase + start).sin()
                };
                let twist = Twist {
                    translation: Vector3::new(value(0), value(1), value(2))
                        + Vector3::from_fn(|_, _| noise(0.02)),
                    rotation: Vector3::from_fn(|_, _| noise(0.0005)),
                };
                let turned = UnitQuaternion::from_scaled_axis(Vector3::x() * value(3))
                    * UnitQuaternion::from_scaled_axis(Vector3::new(0.0, value(4), value(5)));
                let pose = Pose::new(turned, Vector3::zeros()).moved(&twist, &Point3::origin());
                Some(Timed { at: k as f64, pose })
            })
            .collect()
    }

    fn found(frames: &[Option<Timed>]) -> Vec<usize> {
        jumps(frames, &Point3::new(2.0, 3.0, -4.0), &PARAMS).frames
    }

    #[test]
    fn a_thousand_smooth_motions_have_hardly_a_jump() {
        let mut rng = StdRng::seed_from_u64(11);
        let (mut frames, mut all) = (0, 0);
        for _ in 0..1000 {
            let count = rng.random_range(40..200);
            let mut trial = trial(&mut rng, count);
            // Some frames failed.
            for frame in &mut trial {
                if rng.random::<f64>() < 0.05 {
                    *frame = None;
                }
            }
            frames += found(&trial).len();
            all += trial.len();
        }
        println!("{frames} of {all} frames are false alarms");
        assert!((frames as f64) < 1e-4 * all as f64, "{frames} of {all}");
    }

    #[test]
    fn flips_are_found_with_where_they_begin_and_end() {
        let mut rng = StdRng::seed_from_u64(12);
        let (mut seen, mut wrong) = (0, 0);
        for _ in 0..1000 {
            let count = rng.random_range(40..200);
            let mut trial = trial(&mut rng, count);
            let length = rng.random_range(1..8);
            let first = rng.random_range(1..count - length - 1);
            let flip = Twist {
                translation: Vector3::new(1.0, -0.5, 2.0),
                rotation: Vector3::y() * rng.random_range(0.1..0.4),
            };
            for frame in trial[first..first + length].iter_mut().flatten() {
                frame.pose = frame.pose.moved(&flip, &Point3::origin());
            }
            let found = found(&trial);
            if found == (first..first + length).collect::<Vec<_>>() {
                seen += 1;
            } else if found.iter().any(|k| !(first..first + length).contains(k)) {
                wrong += 1;
            }
        }
        println!("{seen} of 1000 flips found exactly, {wrong} with a frame too many");
        assert!(seen >= 950 && wrong <= 20, "{seen} {wrong}");
    }

    #[test]
    fn a_landing_is_no_jump() {
        let mut rng = StdRng::seed_from_u64(14);
        for (speed, over) in [(2.0, 0), (5.0, 0), (10.0, 1), (20.0, 3), (20.0, 5)] {
            let mut flagged = 0;
            for _ in 0..200 {
                let (mut at, mut velocity) = (0.0, speed);
                let frames: Vec<Option<Timed>> = (0..60)
                    .map(|k| {
                        let mut noise =
                            |sigma: f64| sigma * (0..12).map(|_| rng.random::<f64>() - 0.5).sum::<f64>();
                        let place = Vector3::new(at + noise(0.02), noise(0.02), noise(0.02));
                        let turn = Vector3::from_fn(|_, _| noise(0.0005));
                        if k >= 30 {
                            velocity = f64::max(velocity - speed / (f64::from(over) + 1.0), 0.0);
                        }
                        at += velocity;
                        Some(Timed {
                            at: f64::from(k),
                            pose: Pose::new(UnitQuaternion::from_scaled_axis(turn), place),
                        })
                    })
                    .collect();
                flagged += usize::from(!jumps(&frames, &Point3::origin(), &PARAMS).frames.is_empty());
            }
            println!(
                "{speed} mm a frame stopped over {over} frames: {flagged} of 200 trials with a flagged frame"
            );
            assert_eq!(flagged, 0, "{speed} mm a frame, over {over}");
        }
    }

    #[test]
    fn few_frames_and_frames_in_disorder_say_nothing() {
        let mut rng = StdRng::seed_from_u64(13);
        let few = trial(&mut rng, 5);
        assert_eq!(jumps(&few, &Point3::origin(), &PARAMS), Jumps::default());
        let mut same = trial(&mut rng, 20);
        same[7] = same[6];
        assert_eq!(jumps(&same, &Point3::origin(), &PARAMS), Jumps::default());
        assert_eq!(jumps(&[None; 30], &Point3::origin(), &PARAMS), Jumps::default());
    }
}
