//! What a laboratory would have of a frame of beads: detectors, spots with noise, the list.

// Each test file uses a part of it.
#![allow(dead_code)]

use biplane_artifact::{Bead, BeadClicks, BeadList, Detector, Environment, Spot, Spots};
use biplane_environment::{EnvironmentError, EnvironmentParams, find_environment};
use biplane_geometry::Point2;
use biplane_phantom::{BeadFrame, BeadLayout, IntensifierDistortion, TrueFluoroscope, biplane};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Standard deviation of a coordinate, px.
pub const NOISE_PX: f64 = 0.1;

/// True fluoroscopes, and what they see.
#[derive(Clone)]
pub struct Scene {
    pub fluoroscopes: Vec<TrueFluoroscope>,
    pub detectors: Vec<Detector>,
    pub spots: Vec<Spots>,
    pub list: BeadList,
    pub clicks: Option<BeadClicks>,
}

impl Scene {
    /// Two fluoroscopes whose frame stands at `share` of the way from source to detector; noise of [`NOISE_PX`] on the shadows' centres.
    pub fn drawn(layout: &BeadLayout, share: f64, angle_deg: f64, seed: u64) -> Self {
        let mut scene = Self::exact(layout, share, angle_deg, seed);
        scene.add_noise(NOISE_PX, seed);
        scene
    }

    /// The same without noise.
    pub fn exact(layout: &BeadLayout, share: f64, angle_deg: f64, seed: u64) -> Self {
        let views = fluoroscopes(angle_deg, share);
        let frame = BeadFrame::drawn(layout, &views, seed).unwrap();
        let bead = |(i, b): (usize, &biplane_phantom::Ball)| Bead {
            name: (i + 1).to_string(),
            at_mm: b.centre.coords.into(),
            radius_mm: Some(b.radius),
            mark: b.radius == layout.large_radius_mm,
        };
        let list = BeadList(frame.beads.iter().enumerate().map(bead).collect());
        let spots = views.iter().map(|v| exact_spots(&frame, v)).collect();
        let detector = |(name, v): (&str, &TrueFluoroscope)| Detector {
            view: name.to_owned(),
            size: v.size,
            pixel_mm: v.pixel_mm,
            distortion: None,
        };
        let detectors = ["A", "B"].into_iter().zip(&views).map(detector).collect();
        Self { fluoroscopes: views, detectors, spots, list, clicks: None }
    }

    /// Moves every spot at random.
    pub fn add_noise(&mut self, sigma: f64, seed: u64) {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed ^ 0x5eed);
        let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
        for spot in self.spots.iter_mut().flat_map(|s| &mut s.spots) {
            spot.at_px = spot.at_px.map(|v| v + sigma * normal());
        }
    }

    pub fn find(&self, params: &EnvironmentParams) -> Result<Environment, EnvironmentError> {
        let detectors: Vec<&Detector> = self.detectors.iter().collect();
        let spots: Vec<&Spots> = self.spots.iter().collect();
        find_environment(&detectors, &spots, &self.list, self.clicks.as_ref(), params)
    }
}

/// The phantom's pair, moved along their axes so that the laboratory's origin is at `share` of the way from source to detector.
pub fn fluoroscopes(angle_deg: f64, share: f64) -> Vec<TrueFluoroscope> {
    let moved = |v: TrueFluoroscope| {
        let by = v.normal() * ((0.5 - share) * v.source_to_detector_mm());
        TrueFluoroscope { source: v.source + by, centre: v.centre + by, ..v }
    };
    biplane(angle_deg).map(moved).to_vec()
}

/// Shadows of a frame as a finder would give them, from top to bottom.
pub fn exact_spots(frame: &BeadFrame, view: &TrueFluoroscope) -> Spots {
    let seen = frame.seen(view, &IntensifierDistortion::none(view.size));
    let mut spots: Vec<Spot> = seen.iter().map(|b| spot(b.shadow, b.radius_px)).collect();
    spots.sort_by(|a, b| a.at_px[1].total_cmp(&b.at_px[1]));
    Spots { size: view.size, spots, border: None, warnings: Vec::new() }
}

pub fn spot(at: Point2, radius_px: f64) -> Spot {
    Spot { at_px: at.into(), radius_px, elongation: 1.0, contrast: 100.0, sigma_px: 0.01, cut: false }
}
