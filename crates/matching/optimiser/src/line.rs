//! The minimum along a line: a bracket by growing steps, then parabolas and golden sections (Brent, "Algorithms for minimization without
//! derivatives", 1973, chapter 5).

use nalgebra::Vector6;

use crate::asked::Asked;

/// The shorter part of a golden section.
const GOLDEN: f64 = 0.381_966_011_250_105;
/// Factor of steps while a bracket is sought.
const GROW: f64 = 2.0;
/// How finely the minimum is told, as a share of the first step: directions are many, and each is come back to.
const FINE: f64 = 0.05;

/// How far a line runs within the bounds from a point, backward (not positive) and forward.
fn range(asked: &Asked<'_>, at: &Vector6<f64>, along: &Vector6<f64>) -> (f64, f64) {
    let (mut back, mut forth) = (f64::NEG_INFINITY, f64::INFINITY);
    for i in 0..6 {
        if along[i] != 0.0 {
            let ends = [asked.search.low[i], asked.search.high[i]].map(|bound| (bound - at[i]) / along[i]);
            back = back.max(ends[0].min(ends[1]));
            forth = forth.min(ends[0].max(ends[1]));
        }
    }
    (back.min(0.0), forth.max(0.0))
}

/// The lowest point found along a line (`along` a unit vector) from `at`, whose value is given, with steps of `first` to begin with: how far
/// along, and the value. Never higher than at the beginning. `None` once the calls are used up.
pub(crate) fn minimum(
    asked: &mut Asked<'_>,
    at: &Vector6<f64>,
    value: f64,
    along: &Vector6<f64>,
    first: f64,
) -> Option<(f64, f64)> {
    let (back, forth) = range(asked, at, along);
    let tolerance = (FINE * first).max(asked.search.tolerance / 3.0);
    let there = |asked: &mut Asked<'_>, s: f64| asked.value(&asked.search.within(&(at + along * s)));
    // Downhill, by steps that grow, until the function rises.
    let mut low = (0.0, value);
    let mut ends = [0.0, 0.0];
    for (side, limit) in [forth, back].into_iter().enumerate() {
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let (mut step, mut to) = (first, 0.0);
        while to != limit {
            to = (low.0 + sign * step).clamp(back, forth);
            let found = there(asked, to)?;
            if found >= low.1 {
                break;
            }
            ends[1 - side] = low.0;
            low = (to, found);
            step *= GROW;
        }
        ends[side] = to;
        if low.0 * sign > 0.0 {
            break;
        }
    }
    let (mut a, mut b) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    // Brent: x the best, w and v those before it.
    let (mut x, mut w, mut v) = (low, low, low);
    let (mut step, mut before) = (0.0_f64, 0.0_f64);
    for _ in 0..60 {
        let middle = 0.5 * (a + b);
        if (x.0 - middle).abs() <= 2.0 * tolerance - 0.5 * (b - a) {
            break;
        }
        let r = (x.0 - w.0) * (x.1 - v.1);
        let q = (x.0 - v.0) * (x.1 - w.1);
        let (p, q) = ((x.0 - v.0) * q - (x.0 - w.0) * r, 2.0 * (q - r));
        let p = if q > 0.0 { -p } else { p };
        let q = q.abs();
        let parabola = q > 0.0 && p.abs() < (0.5 * q * before).abs() && x.0 + p / q > a && x.0 + p / q < b;
        if parabola {
            (before, step) = (step, p / q);
        } else {
            before = if x.0 < middle { b - x.0 } else { a - x.0 };
            step = GOLDEN * before;
        }
        let to = x.0 + if step.abs() >= tolerance { step } else { tolerance.copysign(step) };
        let u = (to, there(asked, to)?);
        if u.1 <= x.1 {
            if u.0 < x.0 {
                b = x.0
            } else {
                a = x.0
            }
            (v, w, x) = (w, x, u);
        } else {
            if u.0 < x.0 {
                a = u.0
            } else {
                b = u.0
            }
            if u.1 <= w.1 || w.0 == x.0 {
                (v, w) = (w, u);
            } else if u.1 <= v.1 || v.0 == x.0 || v.0 == w.0 {
                v = u;
            }
        }
    }
    Some(x)
}
