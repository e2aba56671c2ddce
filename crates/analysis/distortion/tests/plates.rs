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
        let border = self
            .border_px
            .is_finite()
            .then_some(Circle { centre_px: middle.coords.into(), radius_px: self.border_px });
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
                let seen =
                    if self.from_back { Point2::new(1023.0 - recorded.x, recorded.y) } else { recorded };
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
    let mean =
        |pick: fn(&(Point2, Point2)) -> Point2| pairs.iter().map(|p| pick(p).coords).sum::<Vector2>() / n;
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
            number(m.at_px)
                .is_none_or(|n| (scene.plate.spots[n].centre - Point2::from(m.plate_mm)).norm() > 1e-9)
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
        let false_spots = spots.spots.iter().zip(&numbers).filter(|(s, n)| !s.cut && n.is_none()).count();
        let strays = fit.strays_px.len();
        assert!(strays <= false_spots && strays + 1 >= false_spots, "{strays} of {false_spots} are strays");
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

/// Plates of both lattices, and how the pattern without end is called.
fn lattices() -> [(SpotPattern, PlatePattern); 2] {
    [
        (SpotPattern::Square { pitch_mm: 9.0, reach_mm: 230.0 }, PlatePattern::Square { pitch_mm: 9.0 }),
        (
            SpotPattern::Hexagonal { pitch_mm: 8.0, reach_mm: 230.0 },
            PlatePattern::Hexagonal { pitch_mm: 8.0 },
        ),
    ]
}

#[test]
fn lattices_are_indexed_at_any_turn_with_their_middle_out_of_the_picture() {
    for (spots, pattern) in lattices() {
        for seed in 20..26 {
            let plate = Plate::dotted(spots.spots(equal()));
            let mut scene = Scene::new(plate, seed);
            scene.placement.shift_mm = [60.0 - 9.0 * (seed - 20) as f64, -43.0];
            scene.plate.missing = (0..scene.plate.spots.len()).step_by(29).collect();
            scene.false_spots = 25;
            let (spots, numbers) = scene.spots();
            let fit = fit_plate(&spots, &pattern, None, &best()).unwrap();
            let true_spots = spots.spots.iter().zip(&numbers).filter(|(s, n)| !s.cut && n.is_some()).count();
            let used = fit.matched.iter().filter(|m| m.used).count();
            assert!(used as f64 >= 0.99 * true_spots as f64 && used <= true_spots, "{used} of {true_spots}");
            let error = scene.error_px(&fit);
            assert!(error < 0.05, "{error} px, seed {seed}");
            assert!((fit.pixel_mm - 315.0 / 1024.0).abs() < 0.005, "{}", fit.pixel_mm);
            assert_eq!(fit.verdict, Verdict::Good, "{:?}", fit.warnings);
            // Of the symmetries, the one that is turned least: half of 60 or 90 degrees.
            let [a, b] = fit.plate_from_ideal;
            assert!(f64::atan2(b[0], a[0]).abs() <= 45.5_f64.to_radians() && !fit.mirrored);
        }
    }
}

#[test]
fn a_list_without_marks_is_named_up_to_its_symmetry() {
    let scene = Scene::new(Plate::concentric(), 3);
    let (spots, _) = scene.spots();
    let fit = fit_plate(&spots, &scene.bare_list(), None, &best()).unwrap();
    assert!(scene.error_px(&fit) < 0.05, "{}", scene.error_px(&fit));
    let [a, b] = fit.plate_from_ideal;
    // Six turns by 60 degrees, from either side.
    assert!(f64::atan2(b[0], a[0]).abs() <= 30.5_f64.to_radians() && !fit.mirrored);
    assert!(fit.warnings.iter().any(|w| w.contains("in 12 ways")), "{:?}", fit.warnings);
    assert_eq!(fit.verdict, Verdict::Good);
}

#[test]
fn a_grid_in_a_list_lies_so_that_its_rim_fits_and_its_marks_are_on_marks() {
    // A grid of 230 mm seen whole, so that shifted by a row it would lose one, and a larger one with two marks.
    for (reach_mm, shift) in [(115.0, 6.0), (250.0, 40.0)] {
        let marks = SpotRadii { centre: 2.1, orientation: 1.8, others: 1.2 };
        let pattern = SpotPattern::Square { pitch_mm: 10.0, reach_mm };
        let radii = if reach_mm > 200.0 { marks } else { equal() };
        let mut scene = Scene::new(Plate::dotted(pattern.spots(radii)), 5);
        scene.placement.turn_rad = if reach_mm > 200.0 { 2.6 } else { 0.4 };
        scene.placement.shift_mm = [shift, shift];
        let (spots, numbers) = scene.spots();
        let params = DistortionParams { min_covered_share: 0.3, ..best() };
        let fit = fit_plate(&spots, &scene.list(), None, &params).unwrap();
        assert_eq!(wrong_names(&scene, &spots, &numbers, &fit), 0, "reach {reach_mm}");
        assert_eq!(fit.strays_px.len(), 0);
    }
}

#[test]
fn a_plate_from_its_back_is_mirrored_where_that_shows() {
    // Two spots that the mirror image does not have, one of them large.
    let mut plate = Plate::concentric();
    plate.spots.push(biplane_phantom::Spot { centre: Point2::new(34.0, 24.5), radius_mm: 1.9 });
    plate.spots.push(biplane_phantom::Spot { centre: Point2::new(-55.0, 64.8), radius_mm: 1.25 });
    for from_back in [false, true] {
        let scene = Scene { from_back, ..Scene::new(plate.clone(), 9) };
        let (spots, numbers) = scene.spots();
        let fit = fit_plate(&spots, &scene.list(), None, &best()).unwrap();
        assert_eq!(fit.mirrored, from_back);
        assert_eq!(wrong_names(&scene, &spots, &numbers, &fit), 0);
        let [[a, b, _], [c, d, _]] = fit.plate_from_ideal;
        assert_eq!(a * d - b * c < 0.0, from_back);
        assert!(scene.error_px(&fit) < 0.05);
    }
}

fn click(spots: &Spots, numbers: &[Option<usize>], scene: &Scene, hole: usize, off_px: f64) -> PlateClick {
    let spot = numbers.iter().position(|n| *n == Some(hole)).unwrap();
    let [x, y] = spots.spots[spot].at_px;
    PlateClick { plate_mm: scene.plate.spots[hole].centre.coords.into(), at_px: [x + off_px, y - off_px] }
}

#[test]
fn a_persons_clicks_decide_which_hole_is_which() {
    let scene = Scene::new(Plate::concentric(), 31);
    let (spots, numbers) = scene.spots();
    let at = |hole, off| click(&spots, &numbers, &scene, hole, off);
    let clicks = PlateClicks(vec![at(30, 3.0), at(200, -4.0), at(77, 1.0)]);
    let fit = fit_plate(&spots, &scene.bare_list(), Some(&clicks), &best()).unwrap();
    assert_eq!(wrong_names(&scene, &spots, &numbers, &fit), 0);

    // In a lattice one click says where the origin is; two say more.
    for (spots_of, pattern) in lattices() {
        let scene = Scene::new(Plate::dotted(spots_of.spots(equal())), 33);
        let (spots, numbers) = scene.spots();
        let clicks: Vec<PlateClick> =
            [0, 8, 60].map(|hole| click(&spots, &numbers, &scene, hole, 2.0)).into();
        let fit = fit_plate(&spots, &pattern, Some(&PlateClicks(clicks.clone())), &best()).unwrap();
        // The phantom's coordinates are products of the same numbers, but for rounding.
        let wrong = fit.matched.iter().filter(|m| m.used).filter(|m| {
            let spot = spots.spots.iter().position(|s| s.at_px == m.at_px).unwrap();
            let truth = scene.plate.spots[numbers[spot].unwrap()].centre;
            (truth - Point2::from(m.plate_mm)).norm() > 1e-6
        });
        assert_eq!(wrong.count(), 0);
        let one = PlateClicks(clicks[..1].to_vec());
        let fit = fit_plate(&spots, &pattern, Some(&one), &best()).unwrap();
        let near = |m: &&biplane_artifact::MatchedSpot| Point2::from(m.plate_mm).coords.norm() < 1e-9;
        let [x, y] = fit.matched.iter().find(near).unwrap().at_px;
        assert!((Vector2::new(x, y) - Vector2::from(clicks[0].at_px)).norm() < 3.0);
    }
}

#[test]
fn clicks_that_cannot_be_are_named() {
    let scene = Scene::new(Plate::concentric(), 31);
    let (spots, numbers) = scene.spots();
    let fails =
        |clicks: Vec<PlateClick>| match fit_plate(&spots, &scene.list(), Some(&PlateClicks(clicks)), &best())
        {
            Err(DistortionError::Recognise(error)) => error,
            other => panic!("{other:?}"),
        };
    let good = [30, 200, 77].map(|hole| click(&spots, &numbers, &scene, hole, 1.0));
    let beside = PlateClick { at_px: [25.0, 30.0], ..good[1] };
    let error = fails(vec![good[0], beside]);
    assert!(matches!(error, RecogniseError::ClickOffSpots { click: 2, .. }), "{error}");
    let off_plate = PlateClick { plate_mm: [3.0, 4.0], ..good[2] };
    let error = fails(vec![good[0], good[1], off_plate]);
    assert!(matches!(error, RecogniseError::ClickOffPlate { click: 3, .. }), "{error}");
    let wrong = PlateClick { plate_mm: good[1].plate_mm, ..good[2] };
    let error = fails(vec![good[0], good[1], wrong]);
    assert!(matches!(error, RecogniseError::Contradictory { click: 3, found_mm: Some(_), .. }), "{error}");
    assert!(error.to_string().starts_with("click 3 says that the spot at ("), "{error}");
}

#[test]
fn another_picture_is_no_plate() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(4);
    let mut spots = Scene::new(Plate::concentric(), 1).spots().0;
    for spot in &mut spots.spots {
        spot.at_px = [random.random_range(10.0..1010.0), random.random_range(10.0..1010.0)];
    }
    let scene = Scene::new(Plate::concentric(), 1);
    for pattern in [scene.list(), scene.bare_list(), lattices()[0].1.clone(), lattices()[1].1.clone()] {
        let error = fit_plate(&spots, &pattern, None, &best()).unwrap_err();
        let DistortionError::Recognise(RecogniseError::NoPlate { named, spots, .. }) = error else {
            panic!("{error}")
        };
        assert!(named < spots);
    }
    // A plate of the other kind.
    let square = Scene::new(Plate::dotted(lattices()[0].0.spots(equal())), 2);
    let error = fit_plate(&square.spots().0, &scene.list(), None, &best()).unwrap_err();
    assert!(matches!(error, DistortionError::Recognise(RecogniseError::NoPlate { .. })), "{error}");
}

#[test]
fn doubtful_plates_say_why() {
    let says = |scene: &Scene, pattern: &PlatePattern, part: &str| {
        let fit = fit_plate(&scene.spots().0, pattern, None, &best()).unwrap();
        assert_eq!(fit.verdict, Verdict::Doubtful, "{:?}", fit.warnings);
        assert!(fit.warnings.iter().any(|w| w.contains(part)), "{:?}", fit.warnings);
    };
    let plain = Scene::new(Plate::concentric(), 40);
    let mut tilted = plain.clone();
    tilted.placement.tilt_rad = [3.0_f64.to_radians(), 0.0];
    says(&tilted, &plain.list(), "tilted by 3.");
    let mut noisy = plain.clone();
    noisy.noise_px = 0.5;
    says(&noisy, &plain.list(), "held-out residual");
    let mut dirty = plain.clone();
    dirty.false_spots = 120;
    says(&dirty, &plain.list(), "belong to no hole");
    let mut holey = plain.clone();
    holey.plate.missing = (0..721).step_by(6).skip(1).collect();
    says(&holey, &plain.list(), "were not found");
    // Half of the picture.
    let mut half = plain.clone();
    half.plate.missing = (2..721).filter(|i| half.plate.spots[*i].centre.x < -20.0).collect();
    says(&half, &plain.list(), "of the picture, less than min_covered_share");
}

#[test]
fn bad_input_is_an_error_that_names_it() {
    let scene = Scene::new(Plate::concentric(), 50);
    let (spots, _) = scene.spots();
    let fails = |spots: &Spots, pattern: &PlatePattern, params: &DistortionParams| {
        fit_plate(spots, pattern, None, params).unwrap_err()
    };
    let pitch = PlatePattern::Square { pitch_mm: 0.0 };
    let error = fails(&spots, &pitch, &best());
    assert!(matches!(error, DistortionError::Recognise(RecogniseError::Pattern(PatternError::Pitch { .. }))));
    let PlatePattern::List(mut list) = scene.list() else { unreachable!() };
    list[7].at_mm = list[3].at_mm;
    let error = fails(&spots, &PlatePattern::List(list.clone()), &best());
    assert!(error.to_string().contains("spots 3 and 7"), "{error}");
    list[7].at_mm = [f64::NAN, 0.0];
    let error = fails(&spots, &PlatePattern::List(list), &best());
    assert!(error.to_string().contains("spot 7"), "{error}");

    let few = Spots { spots: spots.spots[300..312].to_vec(), ..spots.clone() };
    let none = Spots { spots: Vec::new(), ..spots.clone() };
    for spots in [&few, &none] {
        for pattern in [scene.list(), PlatePattern::Square { pitch_mm: 3.0 }] {
            fails(spots, &pattern, &DistortionParams::default());
        }
    }
    let mut nowhere = spots.clone();
    nowhere.spots[5].at_px[1] = f64::INFINITY;
    let error = fails(&nowhere, &scene.list(), &best());
    assert!(matches!(error, DistortionError::Recognise(RecogniseError::Spot { spot: 5, .. })), "{error}");
    let huge = Spots { size: [1024, usize::MAX], ..spots.clone() };
    assert!(matches!(fails(&huge, &scene.list(), &best()), DistortionError::Size { .. }));
    let mut same = spots.clone();
    same.spots.iter_mut().for_each(|s| s.at_px = [512.0, 512.0]);
    fails(&same, &scene.list(), &best());
    fails(&same, &PlatePattern::Hexagonal { pitch_mm: 3.0 }, &best());

    // Twelve holes do not make 21 coefficients.
    let mut sparse =
        Scene::new(Plate::dotted(SpotPattern::Square { pitch_mm: 75.0, reach_mm: 150.0 }.spots(equal())), 51);
    sparse.placement = PlatePlacement::on_detector();
    let pattern = PlatePattern::Square { pitch_mm: 75.0 };
    let of_degree_5 = DistortionParams { model: Model::Polynomial, ..DistortionParams::default() };
    let error = fails(&sparse.spots().0, &pattern, &of_degree_5);
    assert!(matches!(error, DistortionError::Fit(_)), "{error}");

    let params = DistortionParams { min_matched_share: 2.0, ..best() };
    let error = fails(&spots, &scene.list(), &params);
    assert_eq!(error.to_string(), "[distortion] min_matched_share = 2, expected a share of 0 to 1");
}

#[test]
fn the_size_of_an_ideal_pixel_can_be_held() {
    let scene = Scene::new(Plate::concentric(), 60);
    let params = DistortionParams { pixel_mm: Some(0.25), ..best() };
    let fit = fit_plate(&scene.spots().0, &scene.list(), None, &params).unwrap();
    assert!((fit.pixel_mm - 0.25).abs() < 1e-12);
    let [[a, _, _], [c, _, _]] = fit.plate_from_ideal;
    assert!((a.hypot(c) - 0.25).abs() < 1e-12);
    // A matched hole goes by the table and the similarity to its place on the plate.
    let map = Distortion::from(&fit.table);
    let hole = fit.matched.iter().find(|m| m.used).unwrap();
    let ideal = map.ideal(&Point2::from(hole.at_px));
    let on_plate = fit.plate_from_ideal.map(|[a, b, c]| a * ideal.x + b * ideal.y + c);
    assert!((Vector2::from(on_plate) - Vector2::from(hole.plate_mm)).norm() < 0.05);
}

#[test]
fn the_order_of_spots_changes_nothing_but_rounding() {
    let mut scene = Scene::new(Plate::concentric(), 70);
    scene.false_spots = 15;
    let (spots, _) = scene.spots();
    let fit = fit_plate(&spots, &scene.list(), None, &best()).unwrap();
    assert_eq!(fit, fit_plate(&spots, &scene.list(), None, &best()).unwrap());
    let mut shuffled = spots.clone();
    shuffled.spots.shuffle(&mut Xoshiro256PlusPlus::seed_from_u64(1));
    let other = fit_plate(&shuffled, &scene.list(), None, &best()).unwrap();
    let sorted = |fit: &PlateFit| {
        let mut names: Vec<_> =
            fit.matched.iter().map(|m| (m.at_px[1].to_bits(), m.plate_mm[0].to_bits())).collect();
        names.sort_unstable();
        names
    };
    assert_eq!(sorted(&fit), sorted(&other));
}
