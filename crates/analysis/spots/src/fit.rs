//! The fit of one spot's profile to the pixels around it: Levenberg-Marquardt with the exact derivative.

use nalgebra::SMatrix;

use crate::profile::{COUNT, Parameters, light, light_and_derivative};

/// Most steps of a fit.
const STEPS: usize = 30;
/// A step of the centre that ends a fit, radii.
const SMALL: f64 = 2e-4;

/// A pixel of a spot's window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pixel {
    /// Place, in radii from the window's middle.
    pub x: f64,
    /// The same along y.
    pub y: f64,
    /// Grey level.
    pub value: f64,
    /// Light that is not the profile's own, by which it is multiplied; 1 for none.
    pub ground: f64,
}

/// A fitted profile.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Fit {
    pub parameters: Parameters,
    /// Sum of squared residuals, grey levels.
    pub squares: f64,
    /// Inverse of the normal matrix.
    pub inverse: SMatrix<f64, COUNT, COUNT>,
}

/// Whether parameters are those of a profile: an ellipse that is neither tiny nor huge nor flat, with an edge.
fn is_profile(p: &Parameters) -> bool {
    let determinant = p[2] * p[4] - p[3] * p[3];
    p[2] > 0.0 && determinant > 0.04 && determinant < 25.0 && (p[2] + p[4]).powi(2) < 20.0 * determinant
        && (0.4..40.0).contains(&p[5])
        // The centre stays in its window.
        && p[0].hypot(p[1]) < 1.0
}

fn squares(pixels: &[Pixel], p: &Parameters) -> f64 {
    pixels.iter().map(|px| (px.value - px.ground * light(p, px.x, px.y)).powi(2)).sum()
}

/// Fits from a start; none where there are too few pixels or it leads nowhere.
pub(crate) fn fit(pixels: &[Pixel], start: &Parameters, steps: usize) -> Option<Fit> {
    if pixels.len() < 2 * COUNT {
        return None;
    }
    let mut p = *start;
    let mut damping = 1e-3;
    let mut best = squares(pixels, &p);
    for _ in 0..steps.min(STEPS) {
        let (normal, right) = normal_equations(pixels, &p);
        let mut moved = None;
        while moved.is_none() && damping < 1e6 {
            let mut damped = normal;
            for i in 0..COUNT {
                damped[(i, i)] += damping * normal[(i, i)] + 1e-9;
            }
            let step = damped.cholesky()?.solve(&right);
            let next = p + step;
            let after = if is_profile(&next) { squares(pixels, &next) } else { f64::INFINITY };
            if after <= best {
                moved = Some((next, step[0].hypot(step[1]), after));
                damping = (damping * 0.1).max(1e-7);
            } else {
                damping *= 10.0;
            }
        }
        let Some((next, shift, after)) = moved else { break };
        let gain = best - after;
        (p, best) = (next, after);
        if shift < SMALL && gain <= 1e-3 * best {
            break;
        }
    }
    let (normal, _) = normal_equations(pixels, &p);
    let mut regular = normal;
    for i in 0..COUNT {
        regular[(i, i)] += 1e-7 * normal[(i, i)] + 1e-9;
    }
    let inverse = regular.cholesky()?.inverse();
    Some(Fit { parameters: p, squares: best, inverse })
}

/// `J' J` and `J' residual`.
fn normal_equations(pixels: &[Pixel], p: &Parameters) -> (SMatrix<f64, COUNT, COUNT>, Parameters) {
    let mut lower = [[0.0_f64; COUNT]; COUNT];
    let mut right = [0.0_f64; COUNT];
    for px in pixels {
        let (value, mut row) = light_and_derivative(p, px.x, px.y);
        row.iter_mut().for_each(|d| *d *= px.ground);
        let residual = px.value - px.ground * value;
        for i in 0..COUNT {
            right[i] += row[i] * residual;
            for j in 0..=i {
                lower[i][j] += row[i] * row[j];
            }
        }
    }
    (SMatrix::from_fn(|i, j| if j <= i { lower[i][j] } else { lower[j][i] }), right.into())
}
