//! A disc with a step for its edge, blurred by a Gaussian: the picture that a detector of edges is held against.
//!
//! The weight of a Gaussian about a point `p` that falls into a region is an integral over the region's border alone (Gauss's theorem with the
//! field `v (1 - exp(-v^2 / 2 s^2)) / (2 pi v^2)`, whose divergence is the Gaussian):
//! `(1 / 2 pi) integral of (1 - exp(-u^2 / 2 s^2)) / u^2 (q - p).n dl`, `u = |q - p|`. Round a circle the midpoint rule with steps of half a blur is
//! exact to rounding.
//!
//! **Guaranteed:** a pixel is the mean over its square, to 1e-3 of the step for blurs of 0.2 px and more. **Not guaranteed:** anything for sharper ones.

use biplane_geometry::Point2;

/// A blurred disc.
#[derive(Debug, Clone)]
pub struct BlurredDisc {
    radius: f64,
    blur: f64,
    /// Share of the disc in the Gaussian, by distance from `radius - REACH * blur` outwards in steps of `blur / STEPS`.
    profile: Vec<f64>,
}

/// Blurs from the edge beyond which nothing is seen of it: 6e-12.
const REACH: f64 = 7.0;
/// Steps of the profile to a blur: between them it is straight, to 1e-5.
const STEPS: f64 = 64.0;
/// Points at which a pixel is sampled, each way.
const SAMPLES: usize = 8;

impl BlurredDisc {
    /// A disc of `radius` px blurred by a Gaussian of `blur` px, both positive.
    pub fn new(radius: f64, blur: f64) -> Self {
        let count = (4.0 * std::f64::consts::PI * radius / blur).ceil().max(16.0);
        let share = |r: f64| {
            let sum: f64 = (0..count as usize)
                .map(|k| {
                    let (sine, cosine) = (std::f64::consts::TAU * (k as f64 + 0.5) / count).sin_cos();
                    let (x, y) = (radius * cosine - r, radius * sine);
                    let squared = (x * x + y * y).max(1e-12);
                    -(-squared / (2.0 * blur * blur)).exp_m1() / squared * (x * cosine + y * sine)
                })
                .sum();
            sum * radius / count
        };
        let steps = (2.0 * REACH * STEPS) as usize + 1;
        let at = |k: usize| (radius + (k as f64 / STEPS - REACH) * blur).max(0.0);
        Self { radius, blur, profile: (0..=steps).map(|k| share(at(k))).collect() }
    }

    /// Share of the Gaussian about a point that falls into the disc, at a distance from its centre, px: 0 to 1.
    fn share(&self, distance: f64) -> f64 {
        let place = ((distance - self.radius) / self.blur + REACH) * STEPS;
        if place < 0.0 {
            return 1.0;
        }
        match self.profile.get(place as usize..place as usize + 2) {
            Some([a, b]) => a + (b - a) * place.fract(),
            _ => 0.0,
        }
    }

    /// How much of each pixel of a square picture of `size` px is the disc, 0 to 1, row by row.
    pub fn picture(&self, centre: &Point2, size: usize) -> Vec<f64> {
        let offset = |k: usize| (k as f64 + 0.5) / SAMPLES as f64 - 0.5;
        let pixel = |k: usize| {
            let (x, y) = ((k % size) as f64 - centre.x, (k / size) as f64 - centre.y);
            if ((x * x + y * y).sqrt() - self.radius).abs() > REACH * self.blur + 1.0 {
                return self.share((x * x + y * y).sqrt());
            }
            let samples = (0..SAMPLES * SAMPLES).map(|s| {
                let (x, y) = (x + offset(s % SAMPLES), y + offset(s / SAMPLES));
                self.share((x * x + y * y).sqrt())
            });
            samples.sum::<f64>() / (SAMPLES * SAMPLES) as f64
        };
        (0..size * size).map(pixel).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_middle_of_a_disc_is_as_dark_as_its_integral_says() {
        // The share of a Gaussian within R of its middle is 1 - exp(-R^2 / 2 s^2).
        for (radius, blur) in [(2.0, 1.0), (3.0, 2.5), (5.0, 1.0)] {
            let expected = 1.0 - f64::exp(-radius * radius / (2.0 * blur * blur));
            assert_relative_eq!(BlurredDisc::new(radius, blur).share(0.0), expected, epsilon = 1e-5);
        }
    }

    #[test]
    fn a_picture_holds_the_area_of_the_disc() {
        for (radius, blur) in [(2.0, 0.2), (6.0, 0.5), (9.0, 2.0)] {
            let sum: f64 = BlurredDisc::new(radius, blur).picture(&Point2::new(32.3, 30.8), 64).iter().sum();
            assert_relative_eq!(sum, std::f64::consts::PI * radius * radius, max_relative = 1e-4);
        }
    }

    #[test]
    fn it_is_what_the_sum_over_a_fine_grid_is() {
        let (radius, blur, fine) = (3.0, 0.8, 0.01);
        let steps = (2.0 * radius / fine) as usize;
        for r in [0.0, 1.5, 2.9, 3.4, 5.0] {
            let mut sum = 0.0;
            for k in 0..steps * steps {
                let at = |k: usize| (k as f64 + 0.5) * fine - radius;
                let (x, y) = (at(k % steps), at(k / steps));
                if x * x + y * y < radius * radius {
                    sum += (-((x - r).powi(2) + y * y) / (2.0 * blur * blur)).exp();
                }
            }
            let expected = sum * fine * fine / (std::f64::consts::TAU * blur * blur);
            assert_relative_eq!(BlurredDisc::new(radius, blur).share(r), expected, epsilon = 2e-4);
        }
    }
}
