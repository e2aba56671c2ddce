//! Blurred discs and half planes of known edge: where the edge points come out, and whether their stated standard deviation is true.
//!
//! A pixel's level is the share of it (a grid of 16 x 16 points) that the disc covers, blurred by a Gaussian on that grid.

#![allow(clippy::unwrap_used)]

use biplane_geometry::Point2;
use biplane_grey::Grey;
use biplane_segmentation::{SegmentParams, curves_of};
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};

/// Points of the grid in a pixel, each way.
const FINE: usize = 16;

/// A disc darker than its ground by 100 levels.
fn disc(centre: Point2, radius: f64, blur: f64, size: usize) -> Grey {
    let n = size * FINE;
    let fine = |i: usize| (i as f64 + 0.5) / FINE as f64 - 0.5;
    let samples = (0..n * n)
        .map(|k| {
            let inside = (fine(k % n) - centre.x).hypot(fine(k / n) - centre.y) < radius;
            if inside { 60.0 } else { 160.0 }
        })
        .collect();
    let blurred = Grey { width: n, height: n, samples }.smoothed(blur * FINE as f64);
    let mean = |x: usize, y: usize| {
        let rows = (0..FINE).flat_map(|j| {
            let start = (y * FINE + j) * n + x * FINE;
            &blurred.samples[start..start + FINE]
        });
        rows.sum::<f32>() / (FINE * FINE) as f32
    };
    let samples = (0..size * size).map(|k| mean(k % size, k / size)).collect();
    Grey { width: size, height: size, samples }
}

/// Errors of the radius of all points of the one curve there is.
fn errors(grey: &Grey, centre: Point2, radius: f64, params: &SegmentParams) -> Option<Vec<f64>> {
    let curves = curves_of(grey, None, params);
    let [curve] = curves.as_slice() else { return None };
    curve.closed.then(|| curve.points.iter().map(|p| (p.position - centre).norm() - radius).collect())
}

#[test]
fn discs_of_five_blurs_and_more_are_right_to_0_05_px() {
    // Found: with smoothing of 1 px at most 0.003 px (rms), 0.046 px for the smallest and sharpest disc.
    // The whole table is in docs/validation.md, by `cargo xtask validate --only edges`.
    for (radius, blur, smoothing_px, most) in [
        (2.0, 0.2, 0.0, 0.05),
        (3.0, 0.4, 0.0, 0.03),
        (5.0, 0.5, 0.5, 0.015),
        (10.0, 1.0, 1.0, 0.005),
        (20.0, 1.0, 2.0, 0.005),
        (40.0, 0.5, 1.0, 0.005),
        (40.0, 2.0, 1.0, 0.005),
    ] {
        let centre = Point2::new(radius + 12.3, radius + 11.9);
        let grey = disc(centre, radius, blur, 2 * radius as usize + 24);
        let rms = |correct_curved| {
            let params =
                SegmentParams { smoothing_px, correct_curved, min_points: 5, ..SegmentParams::default() };
            let errors = errors(&grey, centre, radius, &params).unwrap();
            (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
        };
        assert!(rms(true) < most, "radius {radius}, blur {blur}, smoothing {smoothing_px}: {}", rms(true));
        assert!(rms(false) > 2.0 * rms(true), "the correction does something: {}", rms(false));
    }
}

#[test]
fn stated_deviations_are_those_of_noise() {
    let mut random = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(5);
    for (sigma, smoothing_px, blur) in [(2.0, 1.0, 1.0), (6.0, 2.0, 1.0), (6.0, 1.0, 2.5), (15.0, 2.0, 1.0)] {
        let normal = Normal::new(0.0, sigma).unwrap();
        let (mut found, mut stated) = (0.0, 0.0);
        let thresholds =
            SegmentParams { high_threshold: 8.0, low_threshold: 5.0, ..SegmentParams::default() };
        let params = SegmentParams { smoothing_px, ..thresholds };
        let centre = Point2::new(60.2, 59.7);
        let clean = disc(centre, 40.0, blur, 120);
        for _ in 0..12 {
            let mut grey = clean.clone();
            grey.samples.iter_mut().for_each(|s| *s += normal.sample(&mut random) as f32);
            for p in curves_of(&grey, None, &params).iter().flat_map(|c| &c.points) {
                let error = (p.position - centre).norm() - 40.0;
                // What noise makes edges of elsewhere does not count.
                if error.abs() < 3.0 {
                    found += error * error;
                    stated += p.sigma_px * p.sigma_px;
                }
            }
        }
        let ratio = f64::sqrt(found / stated);
        println!(
            "noise {sigma}, smoothing {smoothing_px}, blur {blur}: rms error over what is stated {ratio:.3}"
        );
        assert!(
            (0.9..1.15).contains(&ratio),
            "noise {sigma}, smoothing {smoothing_px}, blur {blur}: {ratio}"
        );
    }
}
