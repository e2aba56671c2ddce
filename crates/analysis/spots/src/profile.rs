//! What a spot looks like: an ellipse with a soft edge in light that falls off evenly, and the derivative by its parameters.
//!
//! At a pixel `x` the light is `(b0 + b . x) (1 + S (A + Q (1 - rho^2)))` with `rho = |M (x - c)|`, 1 on the ellipse, and
//! `S = Phi(k (1 - rho))`, the normal distribution's. Light is multiplied, not added, since that is what a hole or a bead
//! does to it: where it falls off (vignetting) a sum would move the centre towards the brighter side.
//! `Q` is the dome of a ball's shadow. Everything is even about `c` but the light, so what the profile does not describe
//! of an even spot does not move its centre.

use nalgebra::SVector;

/// Number of parameters.
pub(crate) const COUNT: usize = 11;
/// Parameters: centre x and y, M11, M12, M22, k, A, Q, b0, b1, b2.
pub(crate) type Parameters = SVector<f64, COUNT>;

/// The normal distribution and its density, the first to 2e-4 (a logistic function of a third-degree polynomial, as in
/// S. R. Bowling et al., A logistic approximation to the cumulative normal distribution, 2009), the second its exact derivative.
fn step(t: f64) -> (f64, f64) {
    if t.abs() > 6.0 {
        return (if t > 0.0 { 1.0 } else { 0.0 }, 0.0);
    }
    let s = 1.0 / (1.0 + (-t * (1.5976 + 0.070_56 * t * t)).exp());
    (s, s * (1.0 - s) * (1.5976 + 0.211_68 * t * t))
}

/// The light at a place.
#[cfg(test)]
pub(crate) fn light(p: &Parameters, x: f64, y: f64) -> f64 {
    let (dx, dy) = (x - p[0], y - p[1]);
    let (u, v) = (p[2] * dx + p[3] * dy, p[3] * dx + p[4] * dy);
    let rho2 = u * u + v * v;
    let (s, _) = step(p[5] * (1.0 - rho2.sqrt()));
    (p[8] + p[9] * x + p[10] * y) * (1.0 + s * (p[6] + p[7] * (1.0 - rho2)))
}

/// The light at a place, and its derivative by the parameters.
pub(crate) fn light_and_derivative(p: &Parameters, x: f64, y: f64) -> (f64, [f64; COUNT]) {
    let (dx, dy) = (x - p[0], y - p[1]);
    let (u, v) = (p[2] * dx + p[3] * dy, p[3] * dx + p[4] * dy);
    let rho2 = u * u + v * v + 1e-12;
    let rho = rho2.sqrt();
    let (s, density) = step(p[5] * (1.0 - rho));
    let dome = 1.0 - rho2;
    let depth = p[6] + p[7] * dome;
    let ground = p[8] + p[9] * x + p[10] * y;
    let gain = 1.0 + s * depth;
    let by_rho = ground * (-p[5] * density * depth - 2.0 * rho * s * p[7]);
    // d rho = (u du + v dv) / rho.
    let (u, v) = (by_rho * u / rho, by_rho * v / rho);
    let derivative = [
        -(u * p[2] + v * p[3]),
        -(u * p[3] + v * p[4]),
        u * dx,
        u * dy + v * dx,
        v * dy,
        ground * (1.0 - rho) * density * depth,
        ground * s,
        ground * s * dome,
        gain,
        gain * x,
        gain * y,
    ];
    (ground * gain, derivative)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_step_is_the_normal_distribution() {
        // Phi(0), Phi(1), Phi(-2) from a table.
        for (t, phi) in [(0.0, 0.5), (1.0, 0.841_344_7), (-2.0, 0.022_750_1)] {
            assert!((step(t).0 - phi).abs() < 2e-4);
        }
        assert!((step(0.0).1 - 0.398_9).abs() < 1e-3);
    }

    #[test]
    fn the_derivative_is_that_of_finite_differences() {
        let p = Parameters::from([0.1, -0.2, 1.1, 0.07, 0.9, 3.0, 1.5, -0.4, 60.0, 3.0, -2.0]);
        for i in 0..60 {
            let (x, y) = ((f64::from(i) * 0.7).sin() * 1.6, (f64::from(i) * 1.3).cos() * 1.6);
            let (value, derivative) = light_and_derivative(&p, x, y);
            assert!((value - light(&p, x, y)).abs() < 1e-6);
            for k in 0..COUNT {
                let h = 1e-6;
                let moved = |h: f64| {
                    let mut q = p;
                    q[k] += h;
                    light(&q, x, y)
                };
                let difference = (moved(h) - moved(-h)) / (2.0 * h);
                assert!((difference - derivative[k]).abs() < 1e-4, "{k} at {x}, {y}");
            }
        }
    }
}
