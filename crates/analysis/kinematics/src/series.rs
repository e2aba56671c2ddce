//! Values over the frames of a trial: angles without jumps of a whole turn, and values at even steps of one angle.

/// Takes whole turns out of an angle's steps from one known frame to the next, rad.
pub fn unwrap(values: &mut [Option<f64>]) {
    let whole = 2.0 * std::f64::consts::PI;
    let mut last: Option<f64> = None;
    for value in values.iter_mut().flatten() {
        if let Some(last) = last {
            *value -= whole * ((*value - last) / whole).round();
        }
        last = Some(*value);
    }
}

/// Where an angle passes a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// The step, in the unit of the angle.
    pub level: f64,
    /// Whether the angle grows.
    pub rising: bool,
    /// Number of the stroke, from 0: one begins where the angle turns round.
    pub stroke: usize,
    /// The frame before.
    pub before: usize,
    /// The frame after.
    pub after: usize,
    /// How far it is from the one to the other, 0 to 1.
    pub share: f64,
}

impl Crossing {
    /// A value there, straight between those of the two frames.
    pub fn value(&self, before: f64, after: f64) -> f64 {
        before + self.share * (after - before)
    }

    /// The standard deviation of such a value, from those of two frames that are independent.
    pub fn sigma(&self, before: f64, after: f64) -> f64 {
        ((1.0 - self.share) * before).hypot(self.share * after)
    }
}

/// Where `angle` passes multiples of `step`, in the order of frames; frames that are not known are passed over up to `gap` of them at a time. Nothing
/// is said beyond what was seen. A stroke ends where the angle turns back by more than half a step, so noise at the turn begins none.
pub fn by_angle(angle: &[Option<f64>], step: f64, gap: usize) -> Vec<Crossing> {
    if step.is_nan() || step <= 0.0 {
        return Vec::new();
    }
    let mut found: Vec<Crossing> = Vec::new();
    let (mut stroke, mut rising, mut extreme): (usize, Option<bool>, Option<f64>) = (0, None, None);
    let mut last: Option<(usize, f64)> = None;
    for (frame, value) in angle.iter().enumerate() {
        let Some(value) = value.filter(|v| v.is_finite()) else { continue };
        let before = last.replace((frame, value));
        let turned = extreme.get_or_insert(value);
        match rising {
            None if (value - *turned).abs() > step / 2.0 => {
                rising = Some(value > *turned);
                *turned = value;
            }
            Some(up) => {
                if (value > *turned) == up {
                    *turned = value;
                } else if (value - *turned).abs() > step / 2.0 {
                    rising = Some(!up);
                    stroke += 1;
                    *turned = value;
                }
            }
            None => {}
        }
        let Some((from, first)) = before.filter(|(from, _)| frame - from <= gap + 1) else { continue };
        let (low, high) = (first.min(value), first.max(value));
        // A level that a frame lies on belongs to the step that begins there.
        let mut levels: Vec<f64> = Vec::new();
        let mut number = (low / step).ceil();
        // Bounded: an angle passes a few levels from one frame to the next.
        while number * step <= high && levels.len() < 10_000 {
            let level = number * step;
            if level != value || (frame + 1 == angle.len() && level != first) {
                levels.push(level);
            }
            number += 1.0;
        }
        if value < first {
            levels.reverse();
        }
        found.extend(levels.into_iter().filter(|_| value != first).map(|level| Crossing {
            level,
            rising: value > first,
            stroke,
            before: from,
            after: frame,
            share: (level - first) / (value - first),
        }));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_turns_are_taken_out_also_over_a_gap() {
        let mut values = [Some(3.0), Some(-3.1), None, Some(3.1), Some(0.5)];
        unwrap(&mut values);
        let expected = [Some(3.0), Some(-3.1 + std::f64::consts::TAU), None, Some(3.1), Some(0.5)];
        assert_eq!(values, expected);
    }

    #[test]
    fn up_and_down_are_kept_apart_and_nothing_is_said_beyond_what_was_seen() {
        let angle = [1.0, 6.0, 11.0, 14.0, 8.0, 2.0].map(Some);
        let found = by_angle(&angle, 5.0, 0);
        let told: Vec<(f64, bool, usize, usize)> =
            found.iter().map(|c| (c.level, c.rising, c.stroke, c.before)).collect();
        assert_eq!(told, [(5.0, true, 0, 0), (10.0, true, 0, 1), (10.0, false, 1, 3), (5.0, false, 1, 4)]);
        assert!((found[0].share - 0.8).abs() < 1e-12);
        assert!((found[0].value(10.0, 20.0) - 18.0).abs() < 1e-12);
        assert!((found[0].sigma(1.0, 1.0) - 0.2f64.hypot(0.8)).abs() < 1e-12);
    }

    #[test]
    fn gaps_and_noise_at_the_turn_are_no_crossings() {
        let angle = [Some(1.0), None, Some(9.0)];
        assert!(by_angle(&angle, 5.0, 0).is_empty());
        assert_eq!(by_angle(&angle, 5.0, 1).len(), 1);
        let noisy = [0.0, 4.0, 8.0, 7.5, 8.2, 12.0].map(Some);
        assert!(by_angle(&noisy, 5.0, 0).iter().all(|c| c.stroke == 0));
        // A frame on a level is one crossing, also the last one.
        let exact = [0.0, 5.0, 10.0].map(Some);
        let levels: Vec<f64> = by_angle(&exact, 5.0, 0).iter().map(|c| c.level).collect();
        assert_eq!(levels, [0.0, 5.0, 10.0]);
        assert!(by_angle(&exact, f64::NAN, 0).is_empty() && by_angle(&[], 5.0, 0).is_empty());
    }
}
