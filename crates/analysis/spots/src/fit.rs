//! The fit of one spot's profile to the pixels around it: Levenberg-Marquardt with the exact derivative.

use nalgebra::SMatrix;

use crate::profile::{COUNT, Parameters, light_and_derivative};

/// Steps after which a profile must explain some of what is seen.
const HOPE: usize = 3;
/// Number of the dome in the parameters.
const DOME: usize = 7;
/// Share that a hopeless one leaves unexplained.
const HOPELESS: f64 = 0.5;

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

/// How hard a fit tries.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Effort {
    /// Most steps.
    pub steps: usize,
    /// A step of the centre that ends the fit, radii.
    pub small: f64,
    /// Weight of the dome's square, in squares of the light.
    pub flatness: f64,
}

impl Effort {
    /// A rough fit from far off, without a dome: a spot of some px with a deep dome looks nearly like a smaller or larger one without, so
    /// a fit that may have one can end there.
    pub const ROUGH: Self = Self { steps: 15, small: 0.01, flatness: 1.0 };
    /// All that the picture says.
    pub const FINE: Self = Self { steps: 30, small: 2e-4, flatness: 1e-6 };
}

/// Fits from a start; none where there are too few pixels, it leads nowhere, or after some steps most of what is seen is still not
/// explained.
pub(crate) fn fit(pixels: &[Pixel], start: &Parameters, effort: &Effort) -> Option<Fit> {
    let &Effort { steps, small, flatness } = effort;
    if pixels.len() < 2 * COUNT {
        return None;
    }
    let mean = pixels.iter().map(|px| px.value).sum::<f64>() / pixels.len() as f64;
    let spread: f64 = pixels.iter().map(|px| (px.value - mean).powi(2)).sum();
    let mut p = *start;
    let mut damping = 1e-3;
    let flatness = flatness * pixels.iter().map(|px| px.value * px.value).sum::<f64>();
    let mut here = Equations::at(pixels, &p, flatness);
    for k in 0..steps {
        let mut moved = None;
        while moved.is_none() && damping < 1e6 {
            let mut damped = here.normal;
            for i in 0..COUNT {
                damped[(i, i)] += damping * here.normal[(i, i)] + 1e-9;
            }
            let step = damped.cholesky()?.solve(&here.right);
            let next = p + step;
            let there = is_profile(&next).then(|| Equations::at(pixels, &next, flatness));
            if let Some(there) = there.filter(|e| e.squares <= here.squares) {
                moved = Some((next, step[0].hypot(step[1]), there));
                damping = (damping * 0.1).max(1e-7);
            } else {
                damping *= 10.0;
            }
        }
        let Some((next, shift, there)) = moved else { break };
        let gain = here.squares - there.squares;
        (p, here) = (next, there);
        if shift < small && gain <= 5.0 * small * here.squares {
            break;
        }
        if k >= HOPE && here.squares > HOPELESS * spread {
            return None;
        }
    }
    let mut regular = here.normal;
    for i in 0..COUNT {
        regular[(i, i)] += 1e-7 * here.normal[(i, i)] + 1e-9;
    }
    let inverse = regular.cholesky()?.inverse();
    Some(Fit { parameters: p, squares: here.squares, inverse })
}

/// What a step is made of: all pixels, and a preference for no dome.
struct Equations {
    /// `J' J`.
    normal: SMatrix<f64, COUNT, COUNT>,
    /// `J' residual`.
    right: Parameters,
    /// Sum of squared residuals, the preference's too.
    squares: f64,
}

impl Equations {
    /// With a weight on the square of the dome.
    fn at(pixels: &[Pixel], p: &Parameters, flatness: f64) -> Self {
        let mut lower = [[0.0_f64; COUNT]; COUNT];
        let mut right = [0.0_f64; COUNT];
        let mut squares = flatness * p[DOME] * p[DOME];
        right[DOME] = -flatness * p[DOME];
        lower[DOME][DOME] = flatness;
        for px in pixels {
            let (value, mut row) = light_and_derivative(p, px.x, px.y);
            row.iter_mut().for_each(|d| *d *= px.ground);
            let residual = px.value - px.ground * value;
            squares += residual * residual;
            for i in 0..COUNT {
                right[i] += row[i] * residual;
                for j in 0..=i {
                    lower[i][j] += row[i] * row[j];
                }
            }
        }
        let normal = SMatrix::from_fn(|i, j| if j <= i { lower[i][j] } else { lower[j][i] });
        Self { normal, right: right.into(), squares }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::light;

    #[test]
    fn a_profile_is_found_again_from_a_start_a_quarter_off() {
        let truth = Parameters::from([0.13, -0.21, 1.2, 0.05, 1.1, 3.0, 1.5, -0.2, 60.0, 2.0, -1.0]);
        let places =
            (-10..=10).flat_map(|y| (-10..=10).map(move |x| (f64::from(x) / 5.0, f64::from(y) / 5.0)));
        let pixels: Vec<Pixel> =
            places.map(|(x, y)| Pixel { x, y, value: light(&truth, x, y), ground: 1.0 }).collect();
        let start = Parameters::from([0.0, 0.0, 0.9, 0.0, 0.9, 2.5, 1.2, 0.0, 60.0, 0.0, 0.0]);
        let found = fit(&pixels, &start, &Effort { small: 1e-6, ..Effort::FINE }).unwrap();
        assert!((found.parameters - truth).norm() < 0.02, "{}", found.parameters);
        assert!((0..2).all(|k| (found.parameters[k] - truth[k]).abs() < 1e-3), "{}", found.parameters);
        assert!(fit(&pixels[..20], &start, &Effort { small: 1e-6, ..Effort::FINE }).is_none());
    }

    #[test]
    fn stripes_are_given_up() {
        let places =
            (-10..=10).flat_map(|y| (-10..=10).map(move |x| (f64::from(x) / 5.0, f64::from(y) / 5.0)));
        let pixels: Vec<Pixel> =
            places.map(|(x, y)| Pixel { x, y, value: 50.0 + 20.0 * (9.0 * x).sin(), ground: 1.0 }).collect();
        let start = Parameters::from([0.0, 0.0, 1.0, 0.0, 1.0, 2.5, 0.2, 0.0, 50.0, 0.0, 0.0]);
        assert!(fit(&pixels, &start, &Effort::ROUGH).is_none());
    }
}
