//! How much points scatter across their curve, told by the points alone.

use biplane_geometry::Vector2;

use crate::knots::Knots;

/// Fewest points whose own differences tell their noise.
const FEWEST: usize = 16;
/// Median of the square of a standard normal number.
const MEDIAN: f64 = 0.4549;

/// Square of the factor by which points scatter across the curve more than stated: from the cubic through four points, whose third
/// difference is noise alone where the curve is smooth. The points are `apart` places from each other, so that they share no noise. The
/// median over all of them, so corners and stray points count for little. 1 where there are too few.
pub(crate) fn noise_factor(knots: &Knots, apart: usize) -> f64 {
    let count = knots.points.len();
    let reach = apart.saturating_mul(3);
    if count < FEWEST.saturating_add(reach) {
        return 1.0;
    }
    let mut t = vec![0.0];
    for k in 0..count + reach {
        t.push(t[k] + knots.chords[k % knots.chords.len()]);
    }
    let windows = if knots.closed { count } else { count - reach };
    let mut sizes = Vec::with_capacity(windows);
    for first in 0..windows {
        let at: [usize; 4] = std::array::from_fn(|k| first + k * apart);
        let point = |k: usize| knots.points[at[k] % count];
        let (mut sum, mut variance) = (Vector2::zeros(), 0.0);
        for j in 0..4 {
            let others = (0..4).filter(|k| *k != j).map(|k| t[at[j]] - t[at[k]]);
            let c = 1.0 / others.product::<f64>();
            sum += (point(j) - point(0)) * c;
            variance += c * c * knots.variances[at[j] % count];
        }
        let along = point(3) - point(0);
        let (square, across) = (along.norm_squared(), along.perp(&sum));
        if variance > 0.0 && square > 0.0 {
            sizes.push(across * across / (square * variance));
        }
    }
    if sizes.len() < FEWEST {
        return 1.0;
    }
    let middle = sizes.len() / 2;
    let factor = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1 / MEDIAN;
    if factor.is_finite() { factor } else { 1.0 }
}
