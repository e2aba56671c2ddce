//! What a laboratory's equipment makes of the radiation: everything that spoils a picture, apart from its truth.
//!
//! In the order of the light's way: the transmission (bent, and blurred by motion) times the field of the tube (heel);
//! blur of the focal spot; scatter; quantum noise; blur of the detector; vignetting and the round border; gain, black level
//! and noise of the electronics; grey levels. Quantum noise is thus blurred with the picture, as an intensifier does it.
//!
//! **Guaranteed:** the same inputs and seed give the same bytes. **Not guaranteed:** lag, veiling glare with an
//! intensifier's own shape, automatic brightness, beam hardening.

use biplane_artifact::Frame;
use biplane_geometry::Vector2;
use rand::{Rng, SeedableRng};
use rand_distr::{Distribution, Poisson, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::{IntensifierDistortion, PictureError, Scene, Transmission, TrueFluoroscope, blur};

/// How a picture is taken.
#[derive(Debug, Clone, PartialEq)]
pub struct Exposure {
    /// Rays through each pixel, rounded up to a power of two, 1 to 256.
    pub samples_per_px: usize,
    /// How long the picture is exposed, s: how far moving bodies smear.
    pub time_s: f64,
    /// Moments of the exposure that are drawn where bodies move, rounded up to a power of two. They share the rays of a
    /// pixel, so there are at most half as many; a smear of many px needs about one a px.
    pub moments: usize,
    /// How the intensifier bends the picture.
    pub distortion: Option<IntensifierDistortion>,
    /// Heel effect: relative gain of intensity from the picture's middle to its rim (half the shorter side) along x and y.
    pub heel: Vector2,
    /// Side of the focal spot, mm. It blurs like a Gaussian of the same variance, at the mean depth of the bodies.
    pub focal_spot_mm: f64,
    /// Scattered radiation over the primary one that it comes from.
    pub scatter: f64,
    /// Standard deviation of how far scatter spreads, px; at least some 20.
    pub scatter_px: f64,
    /// Photons to a pixel in the open beam at the picture's middle; infinite for no quantum noise.
    pub photons_per_px: f64,
    /// Standard deviation of the detector's blur, px.
    pub detector_blur_px: f64,
    /// Relative loss of brightness at the rim, growing with the square of the distance from the middle.
    pub vignetting: f64,
    /// Radius of the round border about the picture's middle, px; infinite for none. Its edge is a pixel wide.
    pub border_px: f64,
    /// Grey of the primary radiation of the open beam at the picture's middle, as a share of the full scale; above 1 it
    /// saturates.
    pub brightness: f64,
    /// Grey without any radiation, as a share of the full scale.
    pub black_level: f64,
    /// Standard deviation of the electronics' noise, as a share of the full scale.
    pub electronic_noise: f64,
    /// Bits of a grey level, 1 to 16.
    pub bits: u32,
}

impl Default for Exposure {
    fn default() -> Self {
        Self::ideal()
    }
}

impl Exposure {
    /// No faults: no time, no blur, no noise, 16 bits.
    pub fn ideal() -> Self {
        Self {
            samples_per_px: 16,
            time_s: 0.0,
            moments: 1,
            distortion: None,
            heel: Vector2::zeros(),
            focal_spot_mm: 0.0,
            scatter: 0.0,
            scatter_px: 100.0,
            photons_per_px: f64::INFINITY,
            detector_blur_px: 0.0,
            vignetting: 0.0,
            border_px: f64::INFINITY,
            brightness: 1.0,
            black_level: 0.0,
            electronic_noise: 0.0,
            bits: 16,
        }
    }

    /// A pulsed fluoroscope with an intensifier of 1024 pixels and 8 bits, without distortion: a knee of 120 mm is grey,
    /// metal dark but not black, the open beam saturated, and noise about one grey level, as in the in-vivo pictures that
    /// this project measures with.
    pub fn fluoroscopy() -> Self {
        Self {
            samples_per_px: 8,
            time_s: 0.008,
            moments: 4,
            heel: Vector2::new(0.0, 0.08),
            focal_spot_mm: 0.6,
            scatter: 0.1,
            scatter_px: 200.0,
            photons_per_px: 10_000.0,
            detector_blur_px: 1.0,
            vignetting: 0.15,
            border_px: 503.0,
            brightness: 4.5,
            black_level: 0.08,
            electronic_noise: 0.002,
            bits: 8,
            ..Self::ideal()
        }
    }

    /// What the detector makes of a transmission: the same seed gives the same noise.
    pub fn record(&self, transmission: &Transmission, seed: u64) -> Frame {
        let [width, height] = transmission.size;
        let middle = Vector2::new(width as f64 - 1.0, height as f64 - 1.0) / 2.0;
        let rim = width.min(height) as f64 / 2.0;
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);

        let mut light = transmission.values.clone();
        if self.heel != Vector2::zeros() {
            let heel = self.heel / rim;
            for (y, row) in light.chunks_exact_mut(width).enumerate() {
                let of_row = 1.0 + heel.y * (y as f64 - middle.y) - heel.x * middle.x;
                for (x, value) in row.iter_mut().enumerate() {
                    *value *= (of_row + heel.x * x as f64).max(0.0) as f32;
                }
            }
        }
        // A square spot of side s has the variance s^2 / 12 along each axis.
        let spot_px = self.focal_spot_mm * transmission.spot_px_per_mm / 12.0_f64.sqrt();
        blur::gaussian(&mut light, width, spot_px);
        if self.scatter > 0.0 {
            let scattered = blur::broad(&light, width, self.scatter_px);
            for (value, s) in light.iter_mut().zip(scattered) {
                *value += self.scatter as f32 * s;
            }
        }
        if self.photons_per_px.is_finite() && self.photons_per_px > 0.0 {
            for value in &mut light {
                *value = counted(f64::from(*value) * self.photons_per_px, &mut random) as f32
                    / self.photons_per_px as f32;
            }
        }
        blur::gaussian(&mut light, width, self.detector_blur_px);

        let bits = self.bits.clamp(1, 16);
        let full = f64::from((1_u32 << bits) - 1);
        let (gain, black) = ((self.brightness * full) as f32, (self.black_level * full) as f32);
        let noise = (self.electronic_noise * full) as f32;
        let mut samples = Vec::with_capacity(light.len());
        for (y, row) in light.chunks_exact(width).enumerate() {
            let dy2 = (y as f64 - middle.y).powi(2);
            for (x, value) in row.iter().enumerate() {
                let r2 = (x as f64 - middle.x).powi(2) + dy2;
                let inside = (self.border_px + 0.5 - r2.sqrt()).clamp(0.0, 1.0);
                let seen = (inside * (1.0 - self.vignetting * r2 / (rim * rim)).max(0.0)) as f32;
                let mut grey = black + gain * seen * value;
                if noise > 0.0 {
                    grey += noise * random.sample::<f32, _>(StandardNormal);
                }
                // A float that is too large, negative or not a number becomes the nearest grey level, or 0.
                samples.push((grey + 0.5).min(full as f32) as u16);
            }
        }
        Frame { width, height, samples, bits }
    }
}

/// How many photons come where `mean` are expected.
fn counted(mean: f64, random: &mut Xoshiro256PlusPlus) -> f64 {
    // No photons are expected where the mean is 0, of which no distribution is made.
    Poisson::new(mean).map_or(0.0, |p| p.sample(random))
}

/// Takes a picture of a scene.
///
/// # Errors
/// As [`Transmission::of_scene`].
pub fn picture(
    scene: &Scene,
    view: &TrueFluoroscope,
    exposure: &Exposure,
    seed: u64,
) -> Result<Frame, PictureError> {
    Ok(exposure.record(&Transmission::of_scene(scene, view, exposure)?, seed))
}
