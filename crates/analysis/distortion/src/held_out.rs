//! What a model is judged by: residuals of spots that it was not fitted to, never those of spots that it was.
//!
//! Of a polynomial the residual of a spot in a fit without it is exactly `r / (1 - h)`, where `r` is its residual in the fit with
//! all and `h` its leverage (the diagonal of the hat matrix). Of the local weighted mean each spot is held out in truth.

use biplane_artifact::ModelScore;
use biplane_geometry::{Point2, Vector2};

use crate::polynomial::Solved;

/// Residuals of a polynomial for spots held out one by one, and for a spot of no weight the residual as it is: where the map
/// takes it, less where it belongs.
pub(crate) fn of_polynomial(solved: &Solved, recorded: &[Point2], target: &[Point2]) -> Vec<Vector2> {
    let places = recorded.iter().zip(target).zip(&solved.leverage);
    // Where a spot alone determines a coefficient it says nothing of the map, so its residual has no bound.
    places.map(|((p, q), h)| (solved.polynomial.at(p).0 - q) / (1.0 - h).max(1e-9)).collect()
}

/// Root mean square length.
pub(crate) fn rms(residuals: impl Iterator<Item = Vector2>) -> f64 {
    let (sum, count) = residuals.fold((0.0, 0.0), |(s, n), r| (s + r.norm_squared(), n + 1.0));
    f64::sqrt(sum / f64::max(count, 1.0))
}

/// The length that a share of the residuals keeps.
pub(crate) fn quantile(residuals: &[Vector2], share: f64) -> f64 {
    let mut lengths: Vec<f64> = residuals.iter().map(|r| r.norm()).collect();
    let last = lengths.len().saturating_sub(1);
    if lengths.is_empty() {
        return 0.0;
    }
    *lengths.select_nth_unstable_by((share * last as f64).round() as usize, f64::total_cmp).1
}

/// How a model does by its residuals.
pub(crate) fn score(name: String, fitted: impl Iterator<Item = Vector2>, held_out: &[Vector2]) -> ModelScore {
    ModelScore {
        name,
        fitted_rms_px: rms(fitted),
        held_out_rms_px: rms(held_out.iter().copied()),
        held_out_p95_px: quantile(held_out, 0.95),
    }
}
