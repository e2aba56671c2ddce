//! Light that is not even around a spot: the shadow of a wall, which changes along one direction only.
//!
//! A bead behind the edge of an acrylic tube lies in a shadow with a kink, some 20 px wide, which no plane describes. Around the spot the
//! direction of the change is that of the gradient's spread (structure tensor); across it the light is a cubic spline, that may change
//! linearly along the wall, fitted to the pixels outside the spot and carried over into it. **Not guaranteed:** light that changes along
//! two directions; then the plane of the profile is all there is.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// Distance of the spline's knots, px: fine enough for a kink that is blurred by a pixel.
const KNOTS: f64 = 2.0;
/// Least pixels about a spot from which its light can be told.
const LEAST_PIXELS: usize = 60;

/// A pixel outside the spot: its place from the spot's middle, px, and grey level.
pub(crate) type Outside = [f64; 3];

/// Light that changes across one direction.
#[derive(Debug, Clone)]
pub(crate) struct Ridges {
    /// Unit vector across the ridges.
    across: [f64; 2],
    /// Place of the first knot across.
    first: f64,
    /// Knots of the light, and of its change along the ridges.
    knots: usize,
    reach: f64,
    coefficients: DVector<f64>,
}

/// Grey levels above the plane that fits pixels best; none where there are too few of them.
pub(crate) fn about_plane(outside: &[Outside]) -> Option<Vec<f64>> {
    if outside.len() < LEAST_PIXELS {
        return None;
    }
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for [x, y, value] in outside {
        let row = Vector3::new(1.0, *x, *y);
        normal += row * row.transpose();
        right += row * *value;
    }
    let plane = normal.cholesky()?.solve(&right);
    Some(outside.iter().map(|[x, y, value]| value - plane.dot(&Vector3::new(1.0, *x, *y))).collect())
}

/// Standard deviation of the light about a plane, grey levels; none where there are too few pixels.
pub(crate) fn unevenness(outside: &[Outside]) -> Option<f64> {
    let squares = about_plane(outside)?.iter().map(|r| r * r).sum::<f64>();
    Some((squares / (outside.len() - 3) as f64).sqrt())
}

/// Four cubic B-splines at a place between knots, 0 to 1.
fn cubic(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [
        s * s * s / 6.0,
        (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0,
        (4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0,
        t * t * t / 6.0,
    ]
}

impl Ridges {
    /// Fits the light within `reach` of the spot's middle along both axes; `gradients` are those of the picture at pixels whose neighbours
    /// are outside the spot too. None where there is no one direction.
    pub fn fitted(outside: &[Outside], gradients: &[[f64; 2]], reach: f64) -> Option<Self> {
        let across = direction(gradients)?;
        // The window is a square, so its corners lie farther out.
        let reach = reach * (across[0].abs() + across[1].abs()) + 1e-6;
        let intervals = (2.0 * reach / KNOTS).ceil() as usize;
        let knots = intervals + 3;
        let mut ridges = Self {
            across,
            first: -0.5 * KNOTS * intervals as f64,
            knots,
            reach,
            coefficients: DVector::zeros(2 * knots),
        };
        let mut normal = DMatrix::<f64>::zeros(2 * knots, 2 * knots);
        let mut right = DVector::<f64>::zeros(2 * knots);
        for [x, y, value] in outside {
            let (first, weights, along) = ridges.basis(*x, *y);
            let row: [f64; 8] = std::array::from_fn(|i| weights[i % 4] * if i < 4 { 1.0 } else { along });
            let place = |i: usize| first + i % 4 + if i < 4 { 0 } else { knots };
            for i in 0..8 {
                right[place(i)] += row[i] * value;
                for j in 0..8 {
                    normal[(place(i), place(j))] += row[i] * row[j];
                }
            }
        }
        // Where no pixel tells, the spline is straight and changes little along the ridges.
        let weight = 1e-3 * outside.len() as f64 / intervals as f64;
        for k in 1..knots - 1 {
            for (offset, weight) in [(0, weight), (knots, 10.0 * weight)] {
                let at = [k - 1, k, k + 1].map(|i| i + offset);
                let row = [1.0, -2.0, 1.0];
                for i in 0..3 {
                    for j in 0..3 {
                        normal[(at[i], at[j])] += weight * row[i] * row[j];
                    }
                }
            }
        }
        for k in 0..knots {
            normal[(knots + k, knots + k)] += 10.0 * weight;
        }
        ridges.coefficients = normal.cholesky()?.solve(&right);
        Some(ridges)
    }

    /// First knot, weights of four, and the place along the ridges in reaches.
    fn basis(&self, x: f64, y: f64) -> (usize, [f64; 4], f64) {
        let [cx, cy] = self.across;
        let t = ((x * cx + y * cy - self.first) / KNOTS).clamp(0.0, (self.knots - 3) as f64 - 1e-9);
        (t as usize, cubic(t - t.floor()), (y * cx - x * cy) / self.reach)
    }

    /// The light at a place from the spot's middle, grey levels.
    pub fn light(&self, x: f64, y: f64) -> f64 {
        let (first, weights, along) = self.basis(x, y);
        let c = &self.coefficients;
        (0..4).map(|i| weights[i] * (c[first + i] + along * c[self.knots + first + i])).sum()
    }

    /// Standard deviation of the light about this one, grey levels.
    pub fn unevenness(&self, outside: &[Outside]) -> f64 {
        let squares = outside.iter().map(|[x, y, value]| (value - self.light(*x, *y)).powi(2)).sum::<f64>();
        (squares / (outside.len() as f64 - 2.0 * self.knots as f64).max(1.0)).sqrt()
    }
}

/// The direction in which gradients differ from their mean; none where they do not.
fn direction(gradients: &[[f64; 2]]) -> Option<[f64; 2]> {
    let n = gradients.len() as f64;
    if gradients.len() < LEAST_PIXELS {
        return None;
    }
    let mean = [0, 1].map(|a| gradients.iter().map(|g| g[a]).sum::<f64>() / n);
    let moment =
        |a: usize, b: usize| gradients.iter().map(|g| (g[a] - mean[a]) * (g[b] - mean[b])).sum::<f64>() / n;
    let (xx, xy, yy) = (moment(0, 0), moment(0, 1), moment(1, 1));
    let (sin, cos) = (0.5 * (2.0 * xy).atan2(xx - yy)).sin_cos();
    Some([cos, sin])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slanted_kink_is_carried_into_the_spot() {
        let (sin, cos) = 0.3_f64.sin_cos();
        let light = |x: f64, y: f64| 150.0 + 3.0 * (x * cos + y * sin - 2.3).hypot(1.5) + 0.2 * y;
        let places = (-24..=24).flat_map(|y| (-24..=24).map(move |x| (f64::from(x), f64::from(y))));
        let places: Vec<(f64, f64)> = places.filter(|(x, y)| x.hypot(*y) > 13.0).collect();
        let outside: Vec<Outside> = places.iter().map(|&(x, y)| [x, y, light(x, y)]).collect();
        let slope = |x: f64, y: f64| {
            [(light(x + 1.0, y) - light(x - 1.0, y)) / 2.0, (light(x, y + 1.0) - light(x, y - 1.0)) / 2.0]
        };
        let gradients: Vec<[f64; 2]> = places.iter().map(|&(x, y)| slope(x, y)).collect();
        assert!(unevenness(&outside).unwrap() > 10.0);
        let ridges = Ridges::fitted(&outside, &gradients, 24.0).unwrap();
        assert!(ridges.unevenness(&outside) < 0.5, "{}", ridges.unevenness(&outside));
        for (x, y) in [(0.0, 0.0), (5.0, -6.0), (-4.0, 8.0), (2.3, 0.0)] {
            assert!((ridges.light(x, y) - light(x, y)).abs() < 1.0, "{x} {y}");
        }
    }

    #[test]
    fn too_few_pixels_tell_nothing() {
        assert_eq!(unevenness(&[[1.0, 2.0, 3.0]; 5]), None);
        assert!(Ridges::fitted(&[[1.0, 2.0, 3.0]; 5], &[[0.0; 2]; 5], 10.0).is_none());
    }
}
