//! The minimum of a function of one number that is costly and nearly a parabola: within some hundredths, which is enough for the width of
//! a smoother. Among several minima it is the one downhill from the start.

/// Steps of the parabola.
const REFINEMENTS: usize = 2;

/// Where a function is least within limits: downhill from a start in steps of 1, then along parabolas.
pub(crate) fn least(limits: [f64; 2], start: f64, mut of: impl FnMut(f64) -> f64) -> f64 {
    let mut here = (start, of(start));
    let mut after = (start + 1.0, of(start + 1.0));
    let mut before = (start - 1.0, f64::INFINITY);
    if after.1 < here.1 {
        while after.1 < here.1 && after.0 + 1.0 <= limits[1] {
            (before, here) = (here, after);
            let next = here.0 + 1.0;
            after = (next, of(next));
        }
    } else {
        before.1 = of(before.0);
        while before.1 < here.1 && before.0 - 1.0 >= limits[0] {
            (after, here) = (here, before);
            let next = here.0 - 1.0;
            before = (next, of(next));
        }
    }
    // At a limit.
    if let Some(end) = [before, after].into_iter().find(|e| e.1 < here.1) {
        return end.0;
    }
    for _ in 0..REFINEMENTS {
        let (left, right) = (here.0 - before.0, after.0 - here.0);
        let (fall, rise) = ((here.1 - before.1) / left, (after.1 - here.1) / right);
        let vertex = 0.5 * (before.0 + here.0) - 0.5 * fall * (left + right) / (rise - fall);
        // Neither flat nor next to what is known.
        if !(vertex > before.0 && vertex < after.0) || (vertex - here.0).abs() < 0.01 {
            break;
        }
        let new = (vertex, of(vertex));
        if new.1 < here.1 {
            (before, after) = if new.0 < here.0 { (before, here) } else { (here, after) };
            here = new;
        } else if new.0 < here.0 {
            before = new;
        } else {
            after = new;
        }
    }
    here.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_of_a_function_is_found_on_either_side_and_at_the_limits() {
        let find = |at: f64| least([-4.0, 9.0], 2.0, |x| (x - at).powi(2) + 0.1 * (x - at).powi(4));
        for at in [-2.3, 1.9, 2.0, 2.4, 6.7] {
            assert!((find(at) - at).abs() < 0.05, "{at}: {}", find(at));
        }
        assert_eq!((find(-20.0), find(30.0)), (-4.0, 9.0));
        // Where nothing can be computed it stays.
        assert_eq!(least([-4.0, 9.0], 2.0, |_| f64::NAN), 2.0);
    }
}
