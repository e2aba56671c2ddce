//! Discs with a step for an edge: how far smoothing shrinks them, and how true the stated standard deviations are.

use biplane_geometry::{Curve, Point2};
use biplane_grey::Grey;
use biplane_phantom::BlurredDisc;
use biplane_segmentation::{SegmentParams, curves_of};
use rand::Rng;
use rayon::prelude::*;

use super::rims;
use crate::faults::{normal, random};
use crate::{Cell, Column, Lab, Row, SceneError, Table};

/// Radii, px.
const RADII_PX: [f64; 7] = [2.0, 3.0, 5.0, 8.0, 12.0, 20.0, 40.0];
/// Blur of the picture and smoothing, px.
const BLURS_PX: [(f64, f64); 5] = [(0.2, 0.0), (0.5, 0.5), (1.0, 1.0), (1.0, 2.0), (2.5, 1.0)];
/// Levels of a disc and of its ground; a bright disc has them exchanged.
const LEVELS: [f64; 2] = [60.0, 160.0];
/// Radii in blurs from which on the correction is to hold.
pub const HOLDS_FROM: f64 = 5.0;

/// Blur of the picture, its pixels and the smoothing together, px.
pub fn total_blur_px(picture: f64, smoothing: f64) -> f64 {
    (picture * picture + 1.0 / 12.0 + smoothing * smoothing).sqrt()
}

/// A disc of these levels somewhere near the picture's middle.
struct Shown {
    grey: Grey,
    centre: Point2,
}

fn shown(
    disc: &BlurredDisc,
    radius: f64,
    margin: f64,
    [inside, outside]: [f64; 2],
    chance: &mut impl Rng,
) -> Shown {
    let size = (2.0 * (radius + margin)).ceil() as usize + 1;
    let middle = (size - 1) as f64 / 2.0;
    let centre =
        Point2::new(middle + chance.random_range(-0.5..0.5), middle + chance.random_range(-0.5..0.5));
    let covered = disc.picture(&centre, size);
    let samples = covered.iter().map(|c| (outside + (inside - outside) * c) as f32).collect();
    Shown { grey: Grey { width: size, height: size, samples }, centre }
}

/// Errors of the radius of all points, where the picture shows one closed curve.
fn errors(curves: &[Curve], centre: &Point2, radius: f64) -> Option<Vec<f64>> {
    let [curve] = curves else { return None };
    curve.closed.then(|| curve.points.iter().map(|p| (p.position - centre).norm() - radius).collect())
}

fn rms(errors: &[f64]) -> f64 {
    (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
}

fn mean(errors: &[f64]) -> f64 {
    errors.iter().sum::<f64>() / errors.len() as f64
}

fn worst(errors: &[f64]) -> f64 {
    errors.iter().fold(0.0, |most, e| e.abs().max(most))
}

/// Errors of the radius before and after the correction of curved edges.
pub fn shrinkage(lab: &Lab) -> Table {
    let count = lab.count(12, 2);
    let cases: Vec<(f64, f64, f64)> =
        BLURS_PX.iter().flat_map(|&(b, s)| RADII_PX.map(|radius| (radius, b, s))).collect();
    let measured = |(number, &(radius, blur, smoothing_px)): (usize, &(f64, f64, f64))| {
        let mut chance = random(lab.seed, 90, number);
        let disc = BlurredDisc::new(radius, blur);
        let total = total_blur_px(blur, smoothing_px);
        let (mut all, mut found) = ([Vec::new(), Vec::new()], 0);
        for k in 0..2 * count {
            let levels = if k % 2 == 0 { LEVELS } else { [LEVELS[1], LEVELS[0]] };
            let shown = shown(&disc, radius, 6.0 * total + 4.0, levels, &mut chance);
            let of = |correct_curved| {
                let params =
                    SegmentParams { smoothing_px, correct_curved, min_points: 5, ..SegmentParams::default() };
                errors(&curves_of(&shown.grey, None, &params), &shown.centre, radius)
            };
            if let (Some(before), Some(after)) = (of(false), of(true)) {
                found += 1;
                all[0].extend(before);
                all[1].extend(after);
            }
        }
        let ratio = format!("{:.1}", radius / total);
        let mark = |text: String| if radius < HOLDS_FROM * total { format!("*{text}*") } else { text };
        let mut cells = vec![Cell::text(mark(ratio))];
        cells.extend(match all.iter().any(Vec::is_empty) {
            true => [const { Cell::Text(String::new()) }; 4],
            false => {
                let [before, after] = &all;
                [mean(before), mean(after), rms(after), worst(after)].map(Cell::Number)
            }
        });
        cells.push(Cell::Share(found, 2 * count));
        Row::ours(format!("{radius} px, blur {total:.2} px ({blur}, smoothing {smoothing_px})"), cells)
    };
    Table {
        id: "edges-discs".to_owned(),
        heading: "radius; total blur (picture, smoothing)".to_owned(),
        columns: vec![
            Column::at_most("radius / blur", 1),
            Column::at_most("uncorrected, mean, px", 3),
            Column::at_most("corrected, mean, px", 3),
            Column::at_most("corrected, rms, px", 3),
            Column::at_most("corrected, worst, px", 3),
            Column::at_least("discs found", 0),
        ],
        rows: cases.par_iter().enumerate().map(measured).collect(),
    }
}

/// Noise of single pixels, levels; the picture's blur and smoothing, px; and whether the noise is blurred with the picture.
const NOISY: [(f64, f64, f64, bool); 6] = [
    (2.0, 1.0, 1.0, false),
    (6.0, 1.0, 1.0, false),
    (6.0, 1.0, 2.0, false),
    (6.0, 2.5, 1.0, false),
    (15.0, 1.0, 2.0, false),
    (6.0, 1.0, 1.0, true),
];
/// Radius of noisy discs, px.
const NOISY_RADIUS_PX: f64 = 40.0;
/// An edge farther from the disc's is one of noise, px.
const NOISE_PX: f64 = 3.0;

/// Errors of the edges of noisy discs, and what they are stated to be.
fn noisy(
    lab: &Lab,
    number: usize,
    (sigma, blur, smoothing_px, blurred): (f64, f64, f64, bool),
) -> Vec<(f64, f64)> {
    let mut chance = random(lab.seed, 91, number);
    let disc = BlurredDisc::new(NOISY_RADIUS_PX, blur);
    let params =
        SegmentParams { smoothing_px, high_threshold: 8.0, low_threshold: 5.0, ..SegmentParams::default() };
    let mut errors = Vec::new();
    for _ in 0..lab.count(30, 6) {
        let Shown { mut grey, centre } = shown(&disc, NOISY_RADIUS_PX, 20.0, LEVELS, &mut chance);
        let samples = (0..grey.samples.len()).map(|_| (sigma * normal(&mut chance)) as f32).collect();
        let mut noise = Grey { width: grey.width, height: grey.height, samples };
        if blurred {
            noise = noise.smoothed(blur);
        }
        grey.samples.iter_mut().zip(&noise.samples).for_each(|(level, n)| *level += n);
        let curves = curves_of(&grey, None, &params);
        let points = curves.iter().flat_map(|c| &c.points);
        errors.extend(points.map(|p| ((p.position - centre).norm() - NOISY_RADIUS_PX, p.sigma_px)));
    }
    errors.retain(|(error, _)| error.abs() < NOISE_PX);
    errors
}

/// Root mean square errors of noisy edges beside the stated standard deviations.
pub fn stated(lab: &Lab) -> Result<Table, SceneError> {
    let row = |label: String, errors: &[(f64, f64)]| {
        let [found, stated]: [Vec<f64>; 2] =
            [errors.iter().map(|e| e.0).collect(), errors.iter().map(|e| e.1).collect()];
        let (found, stated) = (rms(&found), rms(&stated));
        Row::ours(label, vec![Cell::Number(found), Cell::Number(stated), Cell::Number(found / stated)])
    };
    let mut rows: Vec<Row> = NOISY
        .par_iter()
        .enumerate()
        .map(|(number, case)| {
            let (sigma, blur, smoothing, blurred) = case;
            let kind = if *blurred { "blurred with the picture" } else { "of single pixels" };
            let label =
                format!("disc; noise of {sigma} levels, {kind}; blur {blur} px, smoothing {smoothing} px");
            row(label, &noisy(lab, number, *case))
        })
        .collect();
    for smoothing_px in [1.0, 2.0] {
        let errors = rims::noisy(lab.count(20, 4), smoothing_px, lab.seed)?;
        rows.push(row(format!("ball of bone, fluoroscope; smoothing {smoothing_px} px"), &errors));
    }
    Ok(Table {
        id: "edges-stated".to_owned(),
        heading: "noisy pictures".to_owned(),
        columns: vec![
            Column::at_most("error, rms, px", 3),
            Column::at_most("stated, rms, px", 3),
            Column::within("error / stated", 2),
        ],
        rows,
    })
}
