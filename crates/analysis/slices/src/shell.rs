//! The outside of the cortical shell along a ray, by a model of what a scanner makes of it.
//!
//! Along a ray from the marrow outward the levels are `M`, then `D` for the thickness `t` of the shell, then `O` from the
//! outside `a` on. A voxel averages over its box, and a slice that is thick averages over a surface that leans: a step becomes
//! the sum of a box of the pixel's width and one of `thickness x lean`. A shell thinner than that does not get fully
//! dark, and where it is half dark is then not its outside; the model knows it, because `D` is known from elsewhere in the
//! bone. `a`, `t`, `M`, `D`, `O` are found by least squares (Gauss and Newton, damped), `D` held near what it is known to be.

use nalgebra::{SMatrix, SVector};

/// Numbers of the model.
const NUMBERS: usize = 5;
const ROUNDS: usize = 12;
/// Standard deviation of the shell's level about what it is known to be, as a share of its contrast.
const DARK_SPREAD: f64 = 0.1;
/// A shell counts at least this part of a pixel.
const THINNEST: f64 = 0.3;
/// An edge of less than this part of the contrast that it should have is none.
const LEAST_CONTRAST: f64 = 0.3;
/// Neighbouring samples of a ray share pixels: the standard deviation is this much more than if they did not.
const SHARED: f64 = 1.5;

/// Levels along a ray, at places from `first` on, `step` apart, mm; outward positive.
pub(crate) struct Profile<'a> {
    pub first: f64,
    pub step: f64,
    pub levels: &'a [f64],
}

/// What is known of a ray before it is looked at.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Known {
    /// Level of marrow here.
    pub marrow: f64,
    /// Level of the shell here.
    pub dark: f64,
    /// Level usual outside of the bone, here.
    pub outside: f64,
    /// Standard deviation of a voxel's level.
    pub noise: f64,
    /// Width of a pixel's box along the ray, interpolation included, mm.
    pub pixel: f64,
    /// Width over which a thick slice spreads the leaning surface, mm.
    pub lean: f64,
    /// Thickest shell, mm.
    pub shell: f64,
    /// How far from 0 the outside may be, mm.
    pub reach: f64,
}

/// Where the outside is, mm from the ray's origin, and its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Outside {
    pub at: f64,
    pub sigma: f64,
}

/// A step at 0 as the scanner shows it, and its slope.
fn step(s: f64, pixel: f64, lean: f64) -> (f64, f64) {
    let lean = lean.max(0.05 * pixel);
    let (far, near) = ((pixel + lean) / 2.0, (pixel - lean) / 2.0);
    let corners = [(s + far, 1.0), (s + near, -1.0), (s - near, -1.0), (s - far, 1.0)];
    let whole = pixel * lean;
    let value = corners.iter().map(|(x, w)| w * x.max(0.0).powi(2) / 2.0).sum::<f64>() / whole;
    let slope = corners.iter().map(|(x, w)| w * x.max(0.0)).sum::<f64>() / whole;
    (value, slope)
}

/// The outside of the shell near a ray's origin; none where there is no edge.
pub(crate) fn outside(profile: &Profile<'_>, known: &Known) -> Option<Outside> {
    let contrast = known.outside - known.dark;
    let place = |n: usize| profile.first + n as f64 * profile.step;
    // Inward from the origin, past the darkest part, to where marrow begins.
    let bright = (known.dark + known.marrow).max(known.outside + known.marrow) / 2.0;
    let origin = (-profile.first / profile.step).round().max(0.0) as usize;
    let mut thickness = known.shell;
    let mut dark_seen = false;
    for n in (0..=origin.min(profile.levels.len().checked_sub(1)?)).rev() {
        dark_seen |= profile.levels[n] < known.dark + contrast / 2.0;
        let passed = dark_seen || place(n) < -(known.pixel + known.lean) / 2.0;
        if passed && profile.levels[n] > bright {
            thickness = (-place(n)).max(THINNEST * known.pixel);
            break;
        }
    }
    let solid = thickness >= known.shell;
    let margin = (known.pixel + known.lean) / 2.0;
    let from = -thickness - if solid { 0.0 } else { margin + known.pixel };
    let to = known.reach.min(1.5 * known.pixel) + margin;
    let used: Vec<(f64, f64)> = (0..profile.levels.len())
        .map(|n| (place(n), profile.levels[n]))
        .filter(|(s, _)| (from..=to).contains(s))
        .collect();
    if used.len() <= NUMBERS {
        return None;
    }
    let mut x = SVector::<f64, NUMBERS>::from([0.0, thickness, known.marrow, known.dark, known.outside]);
    let prior_weight = (known.noise / (DARK_SPREAD * contrast)).powi(2);
    let model = |x: &SVector<f64, NUMBERS>| {
        let mut normal = SMatrix::<f64, NUMBERS, NUMBERS>::zeros();
        let mut gradient = SVector::<f64, NUMBERS>::zeros();
        let mut squares = 0.0;
        let (a, t, m, d, o) = (x[0], x[1], x[2], x[3], x[4]);
        for &(s, level) in &used {
            let (out, out_slope) = step(s - a, known.pixel, known.lean);
            let (inn, inn_slope) = if solid { (1.0, 0.0) } else { step(s - a + t, known.pixel, known.lean) };
            let off = level - (m * (1.0 - inn) + d * (inn - out) + o * out);
            let row = SVector::<f64, NUMBERS>::from([
                (m - d) * inn_slope - (o - d) * out_slope,
                (d - m) * inn_slope,
                1.0 - inn,
                inn - out,
                out,
            ]);
            normal += row * row.transpose();
            gradient += row * off;
            squares += off * off;
        }
        let off = known.dark - d;
        normal[(3, 3)] += prior_weight;
        gradient[3] += prior_weight * off;
        squares += prior_weight * off * off;
        (normal, gradient, squares)
    };
    let (mut normal, mut gradient, mut squares) = model(&x);
    let mut damping = 1e-3;
    for _ in 0..ROUNDS {
        let mut damped = normal;
        for n in 0..NUMBERS {
            damped[(n, n)] = normal[(n, n)] * (1.0 + damping) + 1e-9;
        }
        let change = damped.cholesky()?.solve(&gradient);
        let mut tried = x + change;
        tried[1] = tried[1].max(THINNEST * known.pixel);
        let (n, g, s) = model(&tried);
        if s < squares {
            let done = squares - s < 1e-6 * squares;
            (x, normal, gradient, squares, damping) = (tried, n, g, s, damping / 5.0);
            if done {
                break;
            }
        } else {
            damping *= 8.0;
        }
    }
    let found = x[4] - x[3];
    if !(x[0].abs() <= known.reach && found >= LEAST_CONTRAST * contrast) {
        return None;
    }
    // A little of the marrow's level, where a solid shell leaves it free.
    for n in 0..NUMBERS {
        normal[(n, n)] += 1e-6 * (1.0 + normal[(n, n)]);
    }
    let variance = normal.cholesky()?.inverse()[(0, 0)];
    let spread = (squares / (used.len() - NUMBERS + 1) as f64).max(known.noise * known.noise);
    let sigma = SHARED * (variance * spread).sqrt();
    (sigma.is_finite() && x[0].is_finite()).then_some(Outside { at: x[0], sigma })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_one_far_off_and_half_at_its_place() {
        for (pixel, lean) in [(1.0, 0.0), (1.0, 1.0), (0.5, 4.0)] {
            assert!(step(-3.0, pixel, lean).0.abs() < 1e-12 && (step(3.0, pixel, lean).0 - 1.0).abs() < 1e-9);
            assert!((step(0.0, pixel, lean).0 - 0.5).abs() < 1e-9);
            let slope = (step(0.201, pixel, lean).0 - step(0.199, pixel, lean).0) / 0.002;
            assert!((step(0.2, pixel, lean).1 - slope).abs() < 1e-6);
        }
    }

    /// The mean of marrow 1800, shell 300 and 1000 outside over a box, by counting.
    fn counted(s: f64, width: f64, thickness: f64) -> f64 {
        let parts = 2000;
        (0..parts)
            .map(|n| {
                let at = s + width * ((f64::from(n) + 0.5) / f64::from(parts) - 0.5) - 0.13;
                if at > 0.0 {
                    1000.0
                } else if at > -thickness {
                    300.0
                } else {
                    1800.0
                }
            })
            .sum::<f64>()
            / f64::from(parts)
    }

    #[test]
    fn a_shell_too_thin_to_get_dark_is_found_where_it_is() {
        for thickness in [0.6, 0.9, 1.5, 4.0] {
            let levels: Vec<f64> =
                (0..40).map(|n| counted(-6.0 + 0.25 * f64::from(n), 1.2, thickness)).collect();
            let profile = Profile { first: -6.0, step: 0.25, levels: &levels };
            let known = Known {
                marrow: 1750.0,
                dark: 300.0,
                outside: 1000.0,
                noise: 20.0,
                pixel: 0.05,
                lean: 1.2,
                shell: 5.0,
                reach: 1.5,
            };
            let found = outside(&profile, &known).unwrap();
            assert!((found.at - 0.13).abs() < 0.03, "{thickness}: {found:?}");
        }
    }
}
