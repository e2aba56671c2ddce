//! Plates of the phantom, recognised and fitted: the map against the true one, names against the true ones, and bad input.
//!
//! Spots are the phantom's true centroids with noise of 0.03 px a coordinate, in the order of the picture as the finder gives them.

// Clippy lets `#[test]` functions unwrap, but not what they call.
#![allow(clippy::unwrap_used, clippy::panic)]

use biplane_artifact::{
    Circle, PlateClick, PlateClicks, PlateFit, PlatePattern, PlateSpot, Spot, Spots, Verdict,
};
use biplane_distortion::{DistortionError, DistortionParams, Model, PatternError, RecogniseError, fit_plate};
use biplane_fluoroscope::Distortion;
use biplane_geometry::{Point2, Vector2};
use biplane_phantom::{
    IntensifierDistortion, Plate, PlatePlacement, SpotPattern, SpotRadii, TrueFluoroscope, biplane,
};
use rand::seq::SliceRandom;
use rand::{Rng, SeedableRng};
use rand_distr::StandardNormal;
use rand_xoshiro::Xoshiro256PlusPlus;

/// A scene of a plate and what spoils it.
#[derive(Clone)]
struct Scene {
    plate: Plate,
    placement: PlatePlacement,
    distortion: IntensifierDistortion,
    /// Spots that are none, anywhere.
    false_spots: usize,
    noise_px: f64,
    border_px: f64,
    /// Plate seen from its back: x of the picture is turned round.
    from_back: bool,
    seed: u64,
}

const SIZE: [usize; 2] = [1024, 1024];

fn equal() -> SpotRadii {
    SpotRadii { centre: 1.2, orientation: 1.2, others: 1.2 }
}

impl Scene {
    /// The thesis's plate before an intensifier of 12 px pincushion and 12 px S-shape, placed anyhow.
    fn new(plate: Plate, seed: u64) -> Self {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let placement = PlatePlacement {
            turn_rad: random.random_range(-3.1..3.1),
            shift_mm: [random.random_range(-8.0..8.0), random.random_range(-8.0..8.0)],
            ..PlatePlacement::on_detector()
        };
        let sign = if random.random_bool(0.5) { 1.0 } else { -1.0 };
        let distortion = IntensifierDistortion {
            pincushion_px: 12.0,
            s_shape_px: 12.0 * sign,
            ..IntensifierDistortion::none(SIZE)
        };
        Self {
            plate,
            placement,
            distortion,
            false_spots: 0,
            noise_px: 0.03,
            border_px: 503.0,
            from_back: false,
            seed,
        }
    }

    fn view() -> TrueFluoroscope {
        biplane(90.0)[0].clone()
    }

    /// The spots, and of each the number of its hole.
    fn spots(&self) -> (Spots, Vec<Option<usize>>) {
        let view = Self::view();
        let mut random = Xoshiro256PlusPlus::seed_from_u64(self.seed ^ 77);
        let middle = Point2::new(511.5, 511.5);
        let mut list: Vec<(Spot, Option<usize>)> = Vec::new();
        let mut add = |at: Point2, radius_px: f64, number: Option<usize>, random: &mut Xoshiro256PlusPlus| {
            let mut noise = || self.noise_px * random.sample::<f64, _>(StandardNormal);
            let mut at = at + Vector2::new(noise(), noise());
            if self.from_back {
                at.x = 1023.0 - at.x;
            }
            let from_rim = self.border_px - (at - middle).norm();
            if from_rim > -0.3 * radius_px {
                let spot = Spot {
                    at_px: at.coords.into(),
                    radius_px,
                    elongation: 1.0,
                    contrast: 60.0,
                    sigma_px: self.noise_px,
                    cut: from_rim < radius_px,
                };
                list.push((spot, number));
            }
        };
        for seen in self.plate.seen(&self.placement.pose(&view), &view, &self.distortion) {
            let radius = self.plate.spots[seen.number].radius_mm / view.pixel_mm;
            let radius = radius * (1.0 + 0.02 * random.sample::<f64, _>(StandardNormal));
            add(seen.centroid, radius, Some(seen.number), &mut random);
        }
        for _ in 0..self.false_spots {
            let at = Point2::new(random.random_range(30.0..990.0), random.random_range(30.0..990.0));
            let radius = random.random_range(2.0..7.0);
            add(at, radius, None, &mut random);
        }
        list.sort_by(|a, b| a.0.at_px[1].total_cmp(&b.0.at_px[1]));
        let border = self.border_px.is_finite().then_some(Circle {
            centre_px: middle.coords.into(),
            radius_px: self.border_px,
        });
        let (spots, numbers) = list.into_iter().unzip();
        (Spots { size: SIZE, spots, border, warnings: Vec::new() }, numbers)
    }

    fn list(&self) -> PlatePattern {
        let spots = &self.plate.spots;
        PlatePattern::List(
            spots
                .iter()
                .map(|s| PlateSpot { at_mm: s.centre.coords.into(), radius_mm: Some(s.radius_mm) })
                .collect(),
        )
    }

    /// The same without radii: no marks.
    fn bare_list(&self) -> PlatePattern {
        let PlatePattern::List(mut spots) = self.list() else { unreachable!() };
        spots.iter_mut().for_each(|s| s.radius_mm = None);
        PlatePattern::List(spots)
    }

    /// Root mean square difference of the map from the true one on a dense grid within 95 % of the border's radius, up to the
    /// similarity that the plate leaves free, px.
    fn error_px(&self, fit: &PlateFit) -> f64 {
        let map = Distortion::from(&fit.table);
        let middle = Point2::new(511.5, 511.5);
        let reach = 0.95 * self.border_px.min(512.0);
        let mut pairs = Vec::new();
        for k in 0..128 * 128 {
            let recorded = Point2::new(f64::from(k % 128) * 8.0 + 3.0, f64::from(k / 128) * 8.0 + 3.0);
            if (recorded - middle).norm() <= reach {
                let seen = if self.from_back { Point2::new(1023.0 - recorded.x, recorded.y) } else { recorded };
                let mut truth = self.distortion.ideal(&seen);
                if self.from_back {
                    truth.x = 1023.0 - truth.x;
                }
                pairs.push((map.ideal(&recorded), truth));
            }
        }
        after_similarity(&pairs)
    }
}

/// Root mean square distance of pairs after the similarity of least squares, px. With complex numbers: `q = s p + t`.
fn after_similarity(pairs: &[(Point2, Point2)]) -> f64 {
    let n = pairs.len() as f64;
    let mean = |pick: fn(&(Point2, Point2)) -> Point2| {
        pairs.iter().map(|p| pick(p).coords).sum::<Vector2>() / n
    };
    let (from, to) = (mean(|p| p.0), mean(|p| p.1));
    let (mut re, mut im, mut square) = (0.0, 0.0, 0.0);
    for (p, q) in pairs {
        let (a, b) = (p.coords - from, q.coords - to);
        re += a.dot(&b);
        im += a.perp(&b);
        square += a.norm_squared();
    }
    let (re, im) = (re / square, im / square);
    let sum: f64 = pairs
        .iter()
        .map(|(p, q)| {
            let a = p.coords - from;
            (to + Vector2::new(re * a.x - im * a.y, im * a.x + re * a.y) - q.coords).norm_squared()
        })
        .sum();
    (sum / n).sqrt()
}

fn best() -> DistortionParams {
    DistortionParams { model: Model::Best, ..DistortionParams::default() }
}

/// Matched spots whose hole is another one than the truth says; `same` tells whether two plate places count as the same.
fn wrong_names(scene: &Scene, spots: &Spots, numbers: &[Option<usize>], fit: &PlateFit) -> usize {
    let number = |at: [f64; 2]| spots.spots.iter().position(|s| s.at_px == at).and_then(|i| numbers[i]);
    fit.matched
        .iter()
        .filter(|m| m.used)
        .filter(|m| {
            number(m.at_px).is_none_or(|n| {
                (scene.plate.spots[n].centre - Point2::from(m.plate_mm)).norm() > 1e-9
            })
        })
        .count()
}

#[test]
fn the_thesiss_plate_is_named_by_its_marks_at_any_turn() {
    for seed in 0..12 {
        let mut scene = Scene::new(Plate::concentric(), seed);
        scene.plate.missing = vec![5, 17 + seed as usize * 13, 300];
        scene.false_spots = 10;
        let (spots, numbers) = scene.spots();
        let fit = fit_plate(&spots, &scene.list(), None, &best()).unwrap();
        assert_eq!(wrong_names(&scene, &spots, &numbers, &fit), 0, "seed {seed}");
        assert!(!fit.mirrored);
        let whole = spots.spots.iter().zip(&numbers).filter(|(s, n)| !s.cut && n.is_some()).count();
        let used = fit.matched.iter().filter(|m| m.used).count();
        assert!(used as f64 >= 0.99 * whole as f64, "{used} of {whole} are used");
        assert!((8..=12).contains(&(fit.strays_px.len())), "{} strays", fit.strays_px.len());
        assert_eq!(fit.missing_px.len(), 3, "{:?}", fit.missing_px);
        let error = scene.error_px(&fit);
        // The goal of the project: 0.05 px rms against the true map.
        assert!(error < 0.05, "{error} px, seed {seed}");
        // The plate's place and turn in the ideal picture.
        let [a, b] = fit.plate_from_ideal;
        let turn = f64::atan2(b[0], a[0]) + scene.placement.turn_rad;
        assert!(turn.sin().abs() < 0.01 && turn.cos() > 0.0, "{turn}");
        assert!((fit.pixel_mm - 315.0 / 1024.0).abs() < 0.005, "{}", fit.pixel_mm);
        assert_eq!(fit.verdict, Verdict::Good, "{:?}", fit.warnings);
        assert_eq!(fit.warnings, Vec::<String>::new());
        assert!(fit.round_trip_px < 0.01 && fit.before_rms_px > 2.0);
    }
}
