//! A real X-ray picture of a square grid of dots (discorpy's `dot_pattern_01.jpg`, 2560 x 2160, 8 bit), recognised and fitted without
//! help. The dots are found here by a plain threshold, so that this test is of recognition and fit alone.

// Clippy lets `#[test]` functions unwrap, but not what they call.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::path::Path;

use biplane_artifact::{PlateFit, PlatePattern, Spot, Spots, Verdict};
use biplane_distortion::{DistortionParams, Model, fit_plate};
use biplane_fluoroscope::Distortion;
use biplane_geometry::{Point2, Vector2};
use nalgebra::Matrix2;

/// Dark spots: connected pixels below 0.7 of the mean of 81 x 81 pixels around, weighted by how far they are below.
fn dark_spots(width: usize, height: usize, grey: &[u8]) -> Spots {
    let mut sums = vec![0_u64; (width + 1) * (height + 1)];
    for y in 0..height {
        let mut row = 0;
        for x in 0..width {
            row += u64::from(grey[y * width + x]);
            sums[(y + 1) * (width + 1) + x + 1] = sums[y * (width + 1) + x + 1] + row;
        }
    }
    let level = |x: usize, y: usize| {
        let (x0, x1) = (x.saturating_sub(40), (x + 41).min(width));
        let (y0, y1) = (y.saturating_sub(40), (y + 41).min(height));
        let at = |x: usize, y: usize| sums[y * (width + 1) + x] as f64;
        0.7 * (at(x1, y1) + at(x0, y0) - at(x0, y1) - at(x1, y0)) / ((x1 - x0) * (y1 - y0)) as f64
    };
    let below = |x: usize, y: usize| level(x, y) - f64::from(grey[y * width + x]);
    let mut seen = vec![false; grey.len()];
    let mut spots = Vec::new();
    for start in 0..grey.len() {
        let (mut stack, mut area, mut sum, mut weight, mut cut) =
            (vec![start], 0.0, Vector2::zeros(), 0.0, false);
        while let Some(i) = stack.pop() {
            let (x, y) = (i % width, i / width);
            // Only in the light: 20 grey levels of 255.
            if seen[i] || below(x, y) <= 0.0 || level(x, y) < 20.0 {
                continue;
            }
            seen[i] = true;
            area += 1.0;
            sum += Vector2::new(x as f64, y as f64) * below(x, y);
            weight += below(x, y);
            if x == 0 || y == 0 || x + 1 == width || y + 1 == height {
                cut = true;
                continue;
            }
            stack.extend([i - 1, i + 1, i - width, i + width]);
        }
        if (30.0..400.0).contains(&area) {
            let radius_px = f64::sqrt(area / std::f64::consts::PI);
            let at_px = (sum / weight).into();
            spots.push(Spot { at_px, radius_px, elongation: 1.0, contrast: 60.0, sigma_px: 0.05, cut });
        }
    }
    Spots { size: [width, height], spots, border: None, warnings: Vec::new() }
}

/// Root mean square distance of the dots of a row or column from its best line, px.
fn straightness(fit: &PlateFit, map: impl Fn(&Point2) -> Point2) -> f64 {
    let mut rows: BTreeMap<(usize, i64), Vec<Point2>> = BTreeMap::new();
    for m in fit.matched.iter().filter(|m| m.used) {
        for axis in 0..2 {
            let row = m.plate_mm[axis].round() as i64;
            rows.entry((axis, row)).or_default().push(map(&Point2::from(m.at_px)));
        }
    }
    let (mut sum, mut count) = (0.0, 0.0);
    for row in rows.values().filter(|row| row.len() >= 10) {
        let mean = row.iter().map(|p| p.coords).sum::<Vector2>() / row.len() as f64;
        let spread: Matrix2<f64> =
            row.iter().map(|p| (p.coords - mean) * (p.coords - mean).transpose()).sum();
        sum += spread.symmetric_eigenvalues().min().max(0.0);
        count += row.len() as f64;
    }
    f64::sqrt(sum / count)
}

#[test]
fn a_real_grid_is_found_without_help_and_its_lines_become_straight() {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data/real/grids/dot_pattern_01.jpg");
    if !path.exists() {
        println!("skipped: {} is not there", path.display());
        return;
    }
    let picture = image::open(&path).unwrap().to_luma8();
    let spots = dark_spots(picture.width() as usize, picture.height() as usize, picture.as_raw());
    let params = DistortionParams { model: Model::Best, ..DistortionParams::default() };
    let fit = fit_plate(&spots, &PlatePattern::Square { pitch_mm: 1.0 }, None, &params).unwrap();
    let used = fit.matched.iter().filter(|m| m.used).count();
    let score = fit.models.iter().find(|m| m.name == fit.model).unwrap();
    let map = Distortion::from(&fit.table);
    let [before, after] = [straightness(&fit, |p| *p), straightness(&fit, |p| map.ideal(p))];
    println!(
        "{used} of {} dots, {}: before {:.2} px, fitted {:.4}, held out {:.4}; lines {before:.3} before, {after:.4} after; {:?}",
        spots.spots.len(),
        fit.model,
        fit.before_rms_px,
        score.fitted_rms_px,
        score.held_out_rms_px,
        fit.warnings
    );
    // Some 100 columns and 70 rows of dots are in the light; the plain threshold takes dirt and the printed text for dots, too.
    assert!(used > 6000 && fit.strays_px.len() < 40, "{used} used, {} strays", fit.strays_px.len());
    assert!(score.held_out_rms_px < 0.1, "{score:?}");
    assert!(before > 3.0 && after < 0.03, "{before} and {after}");
    assert_eq!(fit.verdict, Verdict::Good, "{:?}", fit.warnings);
}
