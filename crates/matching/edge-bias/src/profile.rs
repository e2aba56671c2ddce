//! Where the blurred shadow of a body is steepest beside its rim.
//!
//! At the depth `d` inside the rim the light is `exp(-mu L(d))`, `L` the chord. Blurred by a Gaussian of `s` its slope is
//! `g(x) = sum_j w_j exp(-(x - d_j)^2 / 2 s^2)` over lumps `w_j` of light that is lost between one depth and the next. Where `g` is
//! largest the edge is found; Newton's method on its logarithm.

use crate::chords::{Chords, NODES, STEP};

/// Newton steps at most.
const STEPS: usize = 25;
/// The fit's own error is never larger than this, px.
const MOST_FIT_PX: f64 = 0.2;

/// Depth of a lump of light, px, how much it is, and the square of its own width, px^2.
#[derive(Debug, Clone, Copy)]
struct Lump {
    depth: f64,
    fall: f64,
    variance: f64,
}

/// What a rim takes from the light, by depth.
#[derive(Debug)]
pub(crate) struct Profile([Lump; NODES]);

impl Profile {
    /// Between two depths the chord is straight in the root of the depth, and what falls there is put in its own middle.
    pub(crate) fn of(chords: &Chords, attenuation_per_mm: f64) -> Self {
        let (mut before, mut light, mut u) = (0.0, 1.0, 0.0);
        Self(chords.0.map(|length| {
            let here = attenuation_per_mm * length;
            let (a, left) = (here - before, (-here).exp());
            // First and second moment of exp(-a t) over 0 to 1.
            let (first, second) = if a.abs() < 1e-3 {
                (0.5 - a / 12.0, 1.0 / 3.0 - a / 12.0)
            } else {
                let e = a.exp_m1();
                (1.0 / a - 1.0 / e, 2.0 / (a * a) - (1.0 + 2.0 / a) / e)
            };
            let depth = u * u + 2.0 * u * STEP * first + STEP * STEP * second;
            let variance = (STEP * (2.0 * u + STEP)).powi(2) / 12.0;
            let lump = Lump { depth, fall: light - left, variance };
            (before, light, u) = (here, left, u + STEP);
            lump
        }))
    }

    /// Derivatives by px of the logarithm of the blurred slope, first to third. `widths` are one over the lumps' blurred widths.
    fn slope(&self, widths: &[f64; NODES], at: f64) -> Option<[f64; 3]> {
        let mut sums = [0.0; 4];
        for (lump, width) in self.0.iter().zip(widths) {
            let z = (at - lump.depth) * width;
            let g = lump.fall * width * (-0.5 * z * z).exp();
            sums[0] += g;
            sums[1] -= g * z * width;
            sums[2] += g * (z * z - 1.0) * width * width;
            sums[3] += g * z * (3.0 - z * z) * width.powi(3);
        }
        if sums[0] <= 1e-12 {
            return None;
        }
        let [a, b, c] = [1, 2, 3].map(|k| sums[k] / sums[0]);
        Some([a, b - a * a, c - 3.0 * a * b + 2.0 * a * a * a])
    }

    /// The crest of the slope nearest to `from`, px inside the rim, and the error of the parabola that is laid through the logarithm of
    /// the gradient at three pixels around it, px; none where there is no crest.
    pub(crate) fn crest(&self, blur_px: f64, from: f64) -> Option<(f64, f64)> {
        let widths = self.0.map(|l| 1.0 / (blur_px * blur_px + l.variance).sqrt());
        let mut at = from;
        for _ in 0..STEPS {
            let [first, second, third] = self.slope(&widths, at)?;
            // Uphill where it is no hill yet.
            let hill = second < -0.05 / (blur_px * blur_px);
            let step = if hill { -first / second } else { first.signum() * blur_px };
            let step = step.clamp(-0.4 * blur_px, 0.4 * blur_px);
            at = (at + step).clamp(-2.0 * blur_px, 4.0 * blur_px);
            if step.abs() < 1e-6 {
                // The offset from pixels anywhere beside the crest, on average: a sixth of the third derivative less a 24th, over
                // the second.
                return Some((at, (-third / (8.0 * second)).clamp(-MOST_FIT_PX, MOST_FIT_PX)));
            }
        }
        None
    }

    /// Where the edge is found, px inside the rim.
    pub(crate) fn inset_px(&self, blur_px: f64, from: f64) -> Option<f64> {
        self.crest(blur_px, from).map(|(at, fit)| at + fit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Slope of `exp(-k sqrt(d))`, `d` in blurs, blurred, at `x`: over the root of the depth it is smooth.
    fn slope(k: f64, x: f64) -> f64 {
        let n = 4000;
        let (end, mut sum) = (4.0, 0.0);
        for i in 0..n {
            let u = (f64::from(i) + 0.5) * end / f64::from(n);
            sum += k * (-k * u - (x - u * u).powi(2) / 2.0).exp();
        }
        sum * end / f64::from(n)
    }

    /// Its crest by a search that knows no derivative.
    fn crest(k: f64) -> f64 {
        let (mut low, mut high) = (-1.0, 1.5);
        for _ in 0..50 {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if slope(k, a) < slope(k, b) { low = a } else { high = b }
        }
        (low + high) / 2.0
    }

    #[test]
    fn a_smooth_rims_crest_is_that_of_the_simulated_profile_to_1e_4_blurs() {
        let mut before = f64::INFINITY;
        for k in [1e-3, 0.03, 0.1, 0.3, 0.6, 1.0, 1.7, 3.0, 6.0, 12.0, 30.0] {
            let expected = crest(k);
            for blur_px in [1.2, 1.65, 2.5] {
                // k = mu sqrt(8 r s).
                let (mm_per_px, radius_mm): (f64, f64) = (0.15, 7.0);
                let mu = k / (8.0 * radius_mm * blur_px * mm_per_px).sqrt();
                let profile = Profile::of(&Chords::of_radius(radius_mm, mm_per_px), mu);
                let (found, _) = profile.crest(blur_px, 0.4 * blur_px).unwrap();
                let error = found / blur_px - expected;
                assert!(error.abs() < 1e-4, "{k} {blur_px}: {error}");
            }
            assert!(expected < before, "a stronger rim is found farther out");
            before = expected;
        }
        // The largest value of a parabolic cylinder function, and an exponential's mean of the square.
        assert!((crest(1e-3) - 0.765).abs() < 1e-3);
        assert!((crest(30.0) - 2.0 / 900.0).abs() < 1e-4);
    }

    #[test]
    fn the_parabola_through_three_pixels_is_off_by_what_is_said() {
        for (k, blur_px) in [(0.05, 1.65), (0.3, 1.65), (1.0, 1.65), (3.0, 1.65), (0.3, 1.35)] {
            let mu = k / (8.0 * 7.0 * blur_px * 0.15_f64).sqrt();
            let (at, fit) = Profile::of(&Chords::of_radius(7.0, 0.15), mu).crest(blur_px, 0.5).unwrap();
            let log = |x: f64| slope(k, x / blur_px).ln();
            let mut sum = 0.0;
            for phase in 0..16 {
                let pixel = at + (f64::from(phase) + 0.5) / 16.0 - 0.5;
                let [a, b, c] = [-1.0, 0.0, 1.0].map(|o| log(pixel + o));
                sum += pixel + 0.5 * (a - c) / (a - 2.0 * b + c);
            }
            let error = sum / 16.0 - (at + fit);
            assert!(error.abs() < 0.003, "{k} {blur_px}: {error}, of {fit}");
        }
    }
}
