//! Edges where a field crosses zero: the Laplacian of Gaussian, a threshold, the border of a grown region.
//!
//! - **Laplacian of Gaussian** (Marr and Hildreth 1980): zeros of the smoothed picture's second derivative.
//! - **Threshold**: where the smoothed picture crosses a level; without one, that which parts its grey levels best (Otsu 1979).
//! - **Region growing**: pixels that hang together with a seed and are like it; the border of their smoothed indicator.
//!
//! A pixel owns a crossing towards its neighbour along the axis that the edge crosses more steeply if its own value is nearer to
//! zero; between the two the field counts as linear. As with crests, the gradient's size decides by hysteresis what is an edge.

use biplane_geometry::{EdgePoint, Vector2};
use biplane_grey::Grey;

use crate::crest::{Field, Operator};
use crate::edges::{BORDER, CANDIDATE, EdgeMap, STRONG, keep_connected, point_at};
use crate::{Method, SegmentParams};

/// Smoothing of a grown region's indicator, px: it rounds its stairs of pixels off.
const REGION_SMOOTHING_PX: f64 = 1.0;

/// Finds the crossings of the field that the method names.
pub(crate) fn find(smooth: &Grey, params: &SegmentParams, wanted: impl Fn(u32) -> bool) -> EdgeMap {
    let (w, h) = (smooth.width, smooth.height);
    let field = match params.method {
        Method::Region => region(smooth, params),
        Method::Log => laplacian(smooth),
        _ => {
            let level = params.level.map_or_else(|| otsu(smooth), |l| l as f32);
            Grey { samples: smooth.samples.iter().map(|s| s - level).collect(), ..*smooth }
        }
    };
    let gradient = Field { smooth, operator: Operator::Isotropic };
    let [low, high] = params.thresholds(&gradient);
    // Which way an edge runs is the field's own matter where that is not the picture's level.
    let across =
        if params.method == Method::Region { Field { smooth: &field, ..gradient } } else { gradient };
    let mut marks = vec![0; w * h];
    for y in BORDER..h - BORDER {
        for x in BORDER..w - BORDER {
            let k = y * w + x;
            let size = f64::from(gradient.size_at(k)).sqrt();
            if size >= low && crossing(&field, across, k).is_some() {
                marks[k] = if size >= high { STRONG } else { CANDIDATE };
            }
        }
    }
    let pixels = keep_connected(w, marks, wanted);
    let noise = smooth.noise_before_smoothing(params.smoothing_px);
    let blur = (params.smoothing_px.powi(2) + 0.1).sqrt();
    let point = |&pixel: &u32| -> Option<EdgePoint> {
        let k = pixel as usize;
        let (direction, offset) = crossing(&field, across, k)?;
        let strength = f64::from(gradient.size_at(k)).sqrt().max(1e-6);
        let noise = noise.at(f64::from(smooth.samples[k]));
        let sigma_px = match params.method {
            // Smoothed noise over the gradient.
            Method::Threshold => noise / (2.0 * std::f64::consts::PI.sqrt() * blur) / strength,
            // As for a crest, whose place is a zero of a second derivative too.
            Method::Log => noise * (3.0 / (16.0 * std::f64::consts::PI)).sqrt() / blur / strength,
            // A border between whole pixels.
            _ => 0.3,
        };
        // Dark to bright, whichever side the field is positive on.
        let [gx, gy] = central(smooth, k);
        let sign = if direction.x * gx + direction.y * gy < 0.0 { -1.0 } else { 1.0 };
        Some(point_at([(k % w) as f64, (k / w) as f64], sign * offset, sign * direction, strength, sigma_px))
    };
    let placed: Vec<(u32, EdgePoint)> = pixels.iter().filter_map(|k| Some((*k, point(k)?))).collect();
    let (pixels, points): (Vec<u32>, _) = placed.into_iter().unzip();
    // A level is crossed inside a round outline as a crest is, the Laplacian's zero as far outside.
    let blur_squared = if params.method == Method::Log { -blur * blur } else { blur * blur };
    let blurs = vec![blur_squared; pixels.len()];
    EdgeMap { width: w, height: h, points, pixels, blurs, fit: 0.0 }
}

/// Central differences.
fn central(grey: &Grey, k: usize) -> [f64; 2] {
    let (w, s) = (grey.width, &grey.samples);
    [f64::from(s[k + 1] - s[k - 1]) / 2.0, f64::from(s[k + w] - s[k - w]) / 2.0]
}

/// The crossing that pixel `k` owns: the unit normal of the edge, and how far along it the crossing lies, px.
fn crossing(field: &Grey, across: Field<'_>, k: usize) -> Option<(Vector2, f64)> {
    let here = field.samples[k];
    let [mut gx, mut gy] = across.gradient_at(k).map(f64::from);
    let step = if gy.abs() > gx.abs() { field.width } else { 1 };
    let size = gx.hypot(gy);
    if size < 1e-9 {
        return None;
    }
    (gx, gy) = (gx / size, gy / size);
    let axis = if step == 1 { gx } else { gy };
    let along = |there: f32| f64::from(here) / (f64::from(here) - f64::from(there));
    let owns = |there: f32, earlier: bool| {
        let opposite = (here < 0.0) != (there < 0.0);
        // Of two pixels as near, the earlier one owns the crossing.
        opposite && (here.abs() < there.abs() || (here.abs() == there.abs() && earlier))
    };
    let (before, after) = (field.samples[k - step], field.samples[k + step]);
    let offset = if owns(after, true) {
        along(after)
    } else if owns(before, false) {
        -along(before)
    } else {
        return None;
    };
    Some((Vector2::new(gx, gy), offset * axis))
}

/// The Laplacian, by the mask whose error does not depend on direction.
fn laplacian(smooth: &Grey) -> Grey {
    let (w, h, s) = (smooth.width, smooth.height, &smooth.samples);
    let mut samples = vec![0.0; w * h];
    for y in 1..h - 1 {
        for x in 1..w - 1 {
            let k = y * w + x;
            let sides = s[k - 1] + s[k + 1] + s[k - w] + s[k + w];
            let corners = s[k - w - 1] + s[k - w + 1] + s[k + w - 1] + s[k + w + 1];
            samples[k] = (4.0 * sides + corners - 20.0 * s[k]) / 6.0;
        }
    }
    Grey { width: w, height: h, samples }
}

/// The level that parts the grey levels into two classes of least variance (Otsu 1979).
fn otsu(grey: &Grey) -> f32 {
    let mut counts = [0_u32; 256];
    for s in &grey.samples {
        counts[s.clamp(0.0, 255.0) as usize] += 1;
    }
    let total: f64 = counts.iter().map(|c| f64::from(*c)).sum();
    let sum: f64 = counts.iter().enumerate().map(|(i, c)| i as f64 * f64::from(*c)).sum();
    let (mut below, mut sum_below) = (0.0, 0.0);
    let mut best = (0.0, 127.5);
    for (i, count) in counts.iter().enumerate() {
        below += f64::from(*count);
        sum_below += i as f64 * f64::from(*count);
        if below <= 0.0 || below >= total {
            continue;
        }
        let apart = sum_below / below - (sum - sum_below) / (total - below);
        let between = below * (total - below) * apart * apart;
        if between > best.0 {
            best = (between, i as f64 + 1.0);
        }
    }
    best.1 as f32
}

/// The smoothed indicator of what grew from the seeds, less a half.
fn region(smooth: &Grey, params: &SegmentParams) -> Grey {
    let (w, h) = (smooth.width, smooth.height);
    let mut inside = vec![0.0_f32; w * h];
    for [x, y] in &params.seeds_px {
        let (x, y) = (x.round(), y.round());
        if !(x >= 0.0 && y >= 0.0 && x < w as f64 && y < h as f64) {
            continue;
        }
        let seed = y as usize * w + x as usize;
        let level = smooth.samples[seed];
        let alike = |k: usize| f64::from((smooth.samples[k] - level).abs()) <= params.tolerance;
        let mut todo = vec![seed];
        while let Some(k) = todo.pop() {
            if inside[k] != 0.0 || !alike(k) {
                continue;
            }
            inside[k] = 1.0;
            let (x, y) = (k % w, k / w);
            todo.extend((x > 0).then(|| k - 1));
            todo.extend((x + 1 < w).then(|| k + 1));
            todo.extend((y > 0).then(|| k - w));
            todo.extend((y + 1 < h).then(|| k + w));
        }
    }
    let mut indicator = Grey { width: w, height: h, samples: inside }.smoothed(REGION_SMOOTHING_PX);
    indicator.samples.iter_mut().for_each(|s| *s -= 0.5);
    indicator
}
