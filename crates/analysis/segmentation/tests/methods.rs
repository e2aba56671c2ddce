//! Every detector on one soft disc of known radius, and what limits where edges count: thresholds by share, region, parameters.

#![allow(clippy::unwrap_used)]

use biplane_artifact::Frame;
use biplane_geometry::{Point2, Vector2};
use biplane_segmentation::{Method, SegmentError, SegmentParams, curves, edges_of};

const CENTRE: [f64; 2] = [63.3, 64.1];
const RADIUS: f64 = 30.0;

/// A disc of level 60 on a ground of level 160; its edge is soft over about a pixel, half way at `RADIUS`.
fn disc() -> Frame {
    let level = |k: usize| {
        let outside = ((k % 128) as f64 - CENTRE[0]).hypot((k / 128) as f64 - CENTRE[1]) - RADIUS;
        (60.0 + 100.0 / (1.0 + (-2.4 * outside).exp())).round() as u16
    };
    Frame { width: 128, height: 128, samples: (0..128 * 128).map(level).collect(), bits: 8 }
}

#[test]
fn every_method_finds_the_disc_dark_inside() {
    // Px from the true radius in the mean: a grown region ends between whole pixels, and its level is that of its tolerance.
    for (method, most) in [
        (Method::Canny, 0.03),
        (Method::Sobel, 0.05),
        (Method::Prewitt, 0.05),
        (Method::Roberts, 0.05),
        (Method::Log, 0.05),
        (Method::Threshold, 0.05),
        (Method::Region, 0.6),
    ] {
        // Half way between the disc's level and the ground's.
        let (level, tolerance) = (Some(110.0), 50.0);
        let params =
            SegmentParams { method, seeds_px: vec![CENTRE], tolerance, level, ..SegmentParams::default() };
        let found = curves(&disc(), None, &params).unwrap();
        let points: Vec<_> = found.0.iter().flat_map(|c| &c.points).collect();
        assert!(points.len() > 150, "{method:?}: {} points", points.len());
        let centre = Point2::from(CENTRE);
        let errors = points.iter().map(|p| (p.position - centre).norm() - RADIUS);
        let mean = errors.sum::<f64>() / points.len() as f64;
        assert!(mean.abs() < most, "{method:?}: {mean} px");
        for p in points {
            let radial: Vector2 = (p.position - centre).normalize();
            assert!(p.direction.dot(&radial) > 0.9, "{method:?}: dark to bright is outwards");
            assert!(p.strength > 5.0 && p.sigma_px > 0.0);
        }
    }
}

#[test]
fn a_level_of_its_own_moves_a_threshold_and_otsu_finds_the_middle() {
    let radius = |level| {
        let params = SegmentParams { method: Method::Threshold, level, ..SegmentParams::default() };
        let found = curves(&disc(), None, &params).unwrap();
        let points = &found.0[0].points;
        points.iter().map(|p| (p.position - Point2::from(CENTRE)).norm()).sum::<f64>() / points.len() as f64
    };
    assert!((radius(None) - radius(Some(110.0))).abs() < 0.3);
    assert!(radius(Some(90.0)) < radius(Some(110.0)) - 0.2);
    assert!(radius(Some(130.0)) > radius(Some(110.0)) + 0.2);
}

#[test]
fn a_larger_share_of_pixels_has_more_edges() {
    // Noise that is the same on every machine, so that thresholds have something to choose from.
    let mut frame = disc();
    for (k, s) in frame.samples.iter_mut().enumerate() {
        *s += (k.wrapping_mul(2_654_435_761) >> 7) as u16 % 12;
    }
    let count = |share| {
        let params = SegmentParams {
            high_share: Some(share),
            low_share: Some(2.0 * share),
            ..SegmentParams::default()
        };
        edges_of(&frame, None, &params).points.len()
    };
    let (few, some, many) = (count(0.002), count(0.1), count(0.2));
    assert!(few > 20 && few < some && some < many, "{few} {some} {many}");
}

#[test]
fn edges_count_in_the_region_and_where_the_mask_is_not_black() {
    let region = [40.0, 20.0, 128.0, 64.0];
    let params = SegmentParams { region_px: Some(region), ..SegmentParams::default() };
    let within = edges_of(&disc(), None, &params);
    assert!(within.points.len() > 30);
    // A pixel counts, not the point that it owns.
    assert!(within.pixels.iter().all(|p| (40..128).contains(&(p % 128)) && (20..=64).contains(&(p / 128))));
    let mask = Frame { samples: (0..128 * 128).map(|k| u16::from(k % 128 >= 64)).collect(), ..disc() };
    let masked = edges_of(&disc(), Some(&mask), &SegmentParams::default());
    assert!(masked.points.len() > 60 && masked.pixels.iter().all(|p| p % 128 >= 64));
    let other = Frame { width: 64, height: 256, ..disc() };
    let error = curves(&disc(), Some(&other), &SegmentParams::default()).unwrap_err();
    assert_eq!(error, SegmentError::Mask { mask: [64, 256], frame: [128, 128] });
}

#[test]
fn parameters_out_of_range_are_named() {
    let refused = |params: SegmentParams| params.check().unwrap_err().to_string();
    let default = SegmentParams::default;
    for (params, says) in [
        (SegmentParams { smoothing_px: f64::NAN, ..default() }, "smoothing_px = NaN"),
        (SegmentParams { low_threshold: -1.0, ..default() }, "low_threshold = -1"),
        (SegmentParams { high_threshold: 0.5, ..default() }, "high_threshold = 0.5"),
        (SegmentParams { high_share: Some(1.5), ..default() }, "high_share = 1.5"),
        (SegmentParams { high_share: Some(0.2), low_share: Some(0.1), ..default() }, "low_share = 0.1"),
        (SegmentParams { bridge_px: 99.0, ..default() }, "bridge_px = 99"),
        (SegmentParams { level: Some(300.0), ..default() }, "level = 300"),
        (SegmentParams { tolerance: f64::INFINITY, ..default() }, "tolerance = inf"),
        (SegmentParams { region_px: Some([9.0, 0.0, 3.0, 5.0]), ..default() }, "region_px = [9.0, 0.0"),
        (SegmentParams { method: Method::Region, ..default() }, "without seeds_px"),
    ] {
        let message = refused(params);
        assert!(message.contains(says), "{message}");
    }
    assert_eq!(default().check(), Ok(()));
}
