//! How near found spots are to the truth: the phantom's pictures of plates and bead frames, with distortion and all faults.

// Clippy lets `#[test]` functions unwrap, but not what they call.
#![allow(clippy::unwrap_used)]

use biplane_artifact::{Frame, Spots};
use biplane_geometry::Point2;
use biplane_phantom::{
    BeadFrame, BeadLayout, Exposure, IntensifierDistortion, Plate, PlatePlacement, PosedBody, Scene, biplane,
    picture,
};
use biplane_spots::{Look, SpotParams, SpotSettings, find_spots};

const SIZE: [usize; 2] = [1024, 1024];
/// Of [`Exposure::fluoroscopy`].
const BORDER_PX: f64 = 503.0;

fn found(frame: &Frame, look: Look) -> Spots {
    find_spots(frame, &SpotParams { look, settings: SpotSettings::default() }).unwrap()
}

fn distortion(s_shape_px: f64) -> IntensifierDistortion {
    IntensifierDistortion { pincushion_px: 12.0, s_shape_px, ..IntensifierDistortion::none(SIZE) }
}

/// The open beam is not white, and edges are drawn finely enough that the rays' places are no noise of their own.
fn exposure(distortion: IntensifierDistortion, samples_per_px: usize) -> Exposure {
    Exposure { distortion: Some(distortion), samples_per_px, brightness: 0.8, ..Exposure::fluoroscopy() }
}

/// What is to be seen of found spots.
#[derive(Debug, Default)]
struct Score {
    /// Whole ones in truth, and those of them that were found whole.
    whole: usize,
    found: usize,
    /// Whole ones found where nothing is.
    nowhere: usize,
    /// Root mean square distance from the truth, px.
    rms: f64,
    /// Mean error along x and y, px.
    mean: [f64; 2],
    /// Root mean square error over `sigma_px`.
    over_sigma: f64,
}

/// Compares with the places of whole spots in truth, and with those of all.
fn score(spots: &Spots, truth: &[Point2], radius_px: f64) -> Score {
    let middle = Point2::new(511.5, 511.5);
    let mut s = Score::default();
    for p in truth.iter().filter(|p| (*p - middle).norm() + radius_px + 3.0 < BORDER_PX) {
        s.whole += 1;
        let near = |q: &&biplane_artifact::Spot| (q.at_px[0] - p.x).hypot(q.at_px[1] - p.y) < 1.0;
        if let Some(spot) = spots.spots.iter().find(|q| near(q) && !q.cut) {
            let error = [spot.at_px[0] - p.x, spot.at_px[1] - p.y];
            let square = error[0] * error[0] + error[1] * error[1];
            s.found += 1;
            s.rms += square;
            s.over_sigma += square / 2.0 / spot.sigma_px.powi(2);
            s.mean = [s.mean[0] + error[0], s.mean[1] + error[1]];
        }
    }
    let n = s.found.max(1) as f64;
    s.rms = (s.rms / n).sqrt();
    s.over_sigma = (s.over_sigma / n).sqrt();
    s.mean = s.mean.map(|m| m / n);
    let is_there =
        |q: &biplane_artifact::Spot| truth.iter().any(|p| (q.at_px[0] - p.x).hypot(q.at_px[1] - p.y) < 2.0);
    s.nowhere = spots.spots.iter().filter(|q| !q.cut && !is_there(q)).count();
    println!("{s:?} border {:?}", spots.border);
    s
}

fn plate(seed: u64, samples_per_px: usize) -> (Frame, Vec<Point2>) {
    let [view, _] = biplane(90.0);
    let s = seed as f64;
    let place = PlatePlacement {
        turn_rad: 0.1 + 0.3 * s,
        shift_mm: [1.3 * s, -2.1],
        tilt_rad: [0.02 * s, -0.03],
        before_mm: 10.0,
    };
    let (pose, plate, bent) = (place.pose(&view), Plate::concentric(), distortion(6.0 - 8.0 * s));
    let body = PosedBody::at_rest(pose, plate.absorbers().unwrap());
    let scene = Scene { bodies: vec![body], ..Scene::default() };
    let frame = picture(&scene, &view, &exposure(bent, samples_per_px), seed).unwrap();
    (frame, plate.seen(&pose, &view, &bent).iter().map(|s| s.centroid).collect())
}

#[test]
fn all_holes_of_a_plate_are_found_to_hundredths_of_a_pixel() {
    for seed in 0..2 {
        let (frame, truth) = plate(seed, 64);
        let spots = found(&frame, Look::Bright);
        let s = score(&spots, &truth, 4.5);
        assert!(s.whole > 600 && s.found as f64 >= 0.99 * s.whole as f64, "{s:?}");
        assert_eq!(s.nowhere, 0);
        assert!(s.rms < 0.02, "{s:?}");
        assert!(s.mean.iter().all(|m| m.abs() < 0.002), "{s:?}");
        assert!((0.8..1.4).contains(&s.over_sigma), "{s:?}");
        let border = spots.border.unwrap();
        assert!((border.radius_px - BORDER_PX).abs() < 0.2, "{border:?}");
        assert!(border.centre_px.iter().all(|c| (c - 511.5).abs() < 0.2), "{border:?}");
        assert!(spots.warnings.is_empty(), "{:?}", spots.warnings);
    }
}

#[test]
fn holes_at_the_border_are_cut() {
    let (frame, truth) = plate(0, 8);
    let spots = found(&frame, Look::Bright);
    let middle = Point2::new(511.5, 511.5);
    let mut cut = 0;
    for p in truth.iter().filter(|p| (*p - middle).norm() + 3.0 > BORDER_PX) {
        for s in spots.spots.iter().filter(|s| (s.at_px[0] - p.x).hypot(s.at_px[1] - p.y) < 4.0) {
            assert!(s.cut, "{s:?}");
            cut += 1;
        }
    }
    assert!(cut > 0, "no hole lies on the border, so the test shows nothing");
}

#[test]
fn beads_are_found_to_hundredths_of_a_pixel_behind_the_walls_of_the_tube_too() {
    let views = biplane(90.0);
    for (seed, layout) in [(0, BeadLayout::large()), (1, BeadLayout::small())] {
        let beads = BeadFrame::drawn(&layout, &views, seed).unwrap();
        for view in &views {
            let bent = distortion(-6.0);
            let frame = picture(&beads.scene(), view, &exposure(bent, 64), seed).unwrap();
            let truth: Vec<Point2> = beads.seen(view, &bent).iter().map(|s| s.shadow_recorded).collect();
            let s = score(&found(&frame, Look::Dark), &truth, 12.0);
            // One may be flagged where a wall's shadow lies on it.
            assert!(s.whole >= 28 && s.found + 1 >= s.whole, "{s:?}");
            assert_eq!(s.nowhere, 0);
            assert!(s.rms < 0.03, "{s:?}");
        }
    }
}

#[test]
fn white_light_is_warned_of() {
    let views = biplane(90.0);
    let beads = BeadFrame::drawn(&BeadLayout::large(), &views, 0).unwrap();
    let white = Exposure { brightness: 4.5, ..exposure(distortion(6.0), 8) };
    let spots = found(&picture(&beads.scene(), &views[0], &white, 0).unwrap(), Look::Dark);
    assert!(spots.warnings.iter().any(|w| w.contains("top of the scale")), "{:?}", spots.warnings);
}

/// A disc of exact area in each pixel's square, by 16 x 16 samples, in light that falls off.
#[test]
fn centres_do_not_depend_on_where_in_a_pixel_they_lie() {
    for (radius, contrast, look) in
        [(2.5, 60.0, Look::Bright), (4.0, -90.0, Look::Dark), (11.0, -90.0, Look::Dark)]
    {
        for k in 0..12 {
            let at = [24.0 + f64::from(k) / 12.0, 24.0 + f64::from(k * 5 % 12) / 12.0];
            let sample = |i: usize| {
                let (x, y) = ((i % 50) as f64, (i / 50) as f64);
                let fine = |n: usize| (n as f64 + 0.5) / 16.0 - 0.5;
                let inside = (0..256)
                    .filter(|n| (x + fine(n % 16) - at[0]).hypot(y + fine(n / 16) - at[1]) < radius)
                    .count();
                let light = 1.0 + 0.002 * (x - 24.0) - 0.001 * (y - 24.0);
                (light * (140.0 + contrast * inside as f64 / 256.0) / 255.0 * 65_535.0) as u16
            };
            let frame = Frame { width: 50, height: 50, samples: (0..2500).map(sample).collect(), bits: 16 };
            let spots = found(&frame, look).spots;
            assert_eq!(spots.len(), 1, "{radius} at {at:?}: {spots:?}");
            let error = (spots[0].at_px[0] - at[0]).hypot(spots[0].at_px[1] - at[1]);
            // Without any blur pixels are too coarse for an edge; a spot of 2.5 px has few of them.
            assert!(error < 0.02, "radius {radius} at {at:?}: {error}");
            assert!((spots[0].radius_px / radius - 1.0).abs() < 0.05, "{spots:?}");
        }
    }
}
