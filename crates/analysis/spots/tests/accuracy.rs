//! How near found spots are to the truth, on the phantom's pictures of plates and bead frames.

use biplane_artifact::{Frame, Spots};
use biplane_geometry::{Point2, Pose};
use biplane_phantom::*;
use biplane_spots::{Look, SpotParams, SpotSettings, find_spots};

fn params(look: Look) -> SpotParams {
    SpotParams { look, settings: SpotSettings::default() }
}

fn bent(size: [usize; 2], sign: f64) -> IntensifierDistortion {
    IntensifierDistortion { pincushion_px: 12.0, s_shape_px: 6.0 * sign, ..IntensifierDistortion::none(size) }
}

struct Score {
    truth: usize,
    found: usize,
    cut: usize,
    false_spots: usize,
    rms: f64,
    worst: f64,
    mean: [f64; 2],
    ratio: f64,
}

fn score(spots: &Spots, truth: &[Point2], whole: impl Fn(&Point2) -> bool) -> Score {
    let near = |p: &Point2| spots.spots.iter().find(|s| (s.at_px[0] - p.x).hypot(s.at_px[1] - p.y) < 2.0);
    let mut s = Score {
        truth: 0,
        found: 0,
        cut: 0,
        false_spots: 0,
        rms: 0.0,
        worst: 0.0,
        mean: [0.0; 2],
        ratio: 0.0,
    };
    let mut sum = 0.0;
    let mut normalised = 0.0;
    for p in truth.iter().filter(|p| whole(p)) {
        s.truth += 1;
        let Some(spot) = near(p) else {
            println!("missed {p:?}");
            continue;
        };
        if spot.cut {
            println!("cut {p:?} {spot:?}");
            s.cut += 1;
            continue;
        }
        s.found += 1;
        let d = [spot.at_px[0] - p.x, spot.at_px[1] - p.y];
        let e2 = d[0] * d[0] + d[1] * d[1];
        if e2.sqrt() > 0.1 {
            println!("far {d:?} {spot:?}");
        }
        sum += e2;
        normalised += e2 / 2.0 / spot.sigma_px.powi(2);
        s.worst = s.worst.max(e2.sqrt());
        s.mean[0] += d[0];
        s.mean[1] += d[1];
    }
    let n = s.found as f64;
    s.rms = (sum / n).sqrt();
    s.mean = s.mean.map(|m| m / n);
    s.ratio = (normalised / n).sqrt();
    s.false_spots = spots
        .spots
        .iter()
        .filter(|f| !f.cut && truth.iter().all(|p| (f.at_px[0] - p.x).hypot(f.at_px[1] - p.y) > 2.0))
        .inspect(|f| println!("false {f:?}"))
        .count();
    println!(
        "found {} of {} cut {} false {} rms {:.4} worst {:.4} mean {:.4} {:.4} err/sigma {:.3} border {:?}",
        s.found, s.truth, s.cut, s.false_spots, s.rms, s.worst, s.mean[0], s.mean[1], s.ratio, spots.border
    );
    s
}

fn within(border: f64, size: [usize; 2], margin: f64) -> impl Fn(&Point2) -> bool {
    let middle = Point2::new((size[0] as f64 - 1.0) / 2.0, (size[1] as f64 - 1.0) / 2.0);
    move |p| (p - middle).norm() + margin < border
}

fn plate_picture(
    plate: &Plate,
    place: &PlatePlacement,
    exposure: &Exposure,
    seed: u64,
) -> (Frame, Vec<Point2>) {
    let [view, _] = biplane(90.0);
    let pose = place.pose(&view);
    let d = bent(view.size, if seed.is_multiple_of(2) { 1.0 } else { -1.0 });
    let body = PosedBody::at_rest(pose, plate.absorbers().unwrap());
    let scene = Scene { bodies: vec![body], ..Scene::default() };
    let exposure = Exposure { distortion: Some(d), ..exposure.clone() };
    let frame = picture(&scene, &view, &exposure, seed).unwrap();
    let seen = plate.seen(&pose, &view, &d).iter().map(|s| s.centroid).collect();
    (frame, seen)
}

#[test]
fn holes_of_a_plate() {
    let plate = Plate::concentric();
    for seed in 0..3 {
        let place = PlatePlacement {
            turn_rad: 0.1 + 0.3 * seed as f64,
            shift_mm: [1.3 * seed as f64, -2.1],
            tilt_rad: [0.02 * seed as f64, -0.03],
            before_mm: 10.0,
        };
        let exposure = Exposure { brightness: 0.8, ..Exposure::fluoroscopy() };
        let (frame, truth) = plate_picture(&plate, &place, &exposure, seed);
        let spots = find_spots(&frame, &params(Look::Bright)).unwrap();
        let s = score(&spots, &truth, within(503.0, [1024, 1024], 7.0));
        assert!(s.rms < 0.03);
    }
}

#[test]
fn beads_of_a_frame() {
    for seed in 0..4_u64 {
        let views = biplane(90.0);
        let layout = if seed.is_multiple_of(2) { BeadLayout::large() } else { BeadLayout::small() };
        let beads = BeadFrame::drawn(&layout, &views, seed).unwrap();
        for view in &views {
            for brightness in [0.8] {
                let d = bent(view.size, 1.0);
                let exposure = Exposure { distortion: Some(d), brightness, ..Exposure::fluoroscopy() };
                let frame = picture(&beads.scene(), view, &exposure, seed).unwrap();
                let truth: Vec<Point2> = beads.seen(view, &d).iter().map(|s| s.shadow_recorded).collect();
                let spots = find_spots(&frame, &params(Look::Dark)).unwrap();
                print!("brightness {brightness}: ");
                score(&spots, &truth, within(503.0, [1024, 1024], 14.0));
            }
        }
    }
    let _ = Pose::identity();
}
