//! Places that may be spots: maxima of the determinant of the Hessian over place and scale (T. Lindeberg, Feature detection
//! with automatic scale selection, 1998).
//!
//! A disc of radius `r` and contrast `c` answers most at the scale `sigma = r / sqrt(2)`, with a normalised root of the
//! determinant of `c / e`; edges, borders and slopes of light answer with next to nothing, since they curve one way only.
//! Scales go up by `sqrt(2)`; from a radius of some 4 px on in halved pictures. **Not guaranteed:** that each is a spot, nor
//! its radius to better than a quarter.

use std::f64::consts::{E, SQRT_2};

use crate::Look;
use crate::cells::Cells;
use biplane_grey::Grey;

/// A place that may be a spot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Candidate {
    /// Its middle, px.
    pub at: [f64; 2],
    /// About its radius, px.
    pub radius: f64,
    /// About its contrast, grey levels; positive.
    pub contrast: f64,
}

/// From the strongest on; none has its middle within another, stronger one, nor such a one within itself.
pub(crate) fn candidates(grey: &Grey, look: Look, radii: [f64; 2], least_contrast: f64) -> Vec<Candidate> {
    let mut found = Vec::new();
    let first = radii[0] / SQRT_2;
    let mut level = grey.smoothed(first);
    let mut step = 1.0; // Distance of the level's pixels in the picture's.
    let mut sigma = first;
    loop {
        maxima(&level, look, sigma, least_contrast, |[x, y], contrast| {
            found.push(Candidate { at: [x * step, y * step], radius: SQRT_2 * sigma * step, contrast });
        });
        // The next scale up is the first one beyond the largest radius.
        if sigma * step >= radii[1] / SQRT_2 || level.width.min(level.height) < 3 {
            break;
        }
        if sigma > 2.9 {
            (level, step, sigma) = (level.halved(), step * 2.0, sigma / 2.0);
        }
        // From sigma to sqrt(2) sigma.
        level = level.smoothed(sigma);
        sigma *= SQRT_2;
    }
    strongest(found, [grey.width, grey.height])
}

/// Calls `found` with the place and the contrast of each maximum of one scale.
fn maxima(level: &Grey, look: Look, sigma: f64, least_contrast: f64, mut found: impl FnMut([f64; 2], f64)) {
    let (w, h) = (level.width, level.height);
    if w < 3 || h < 3 {
        return;
    }
    let sign = match look {
        Look::Bright => -1.0_f32,
        Look::Dark => 1.0,
    };
    let to_contrast = sigma * sigma * E;
    let least = ((least_contrast / to_contrast).powi(2)) as f32;
    let mut determinant = vec![0.0_f32; w * h];
    for y in 1..h - 1 {
        let row = |y: usize| &level.samples[y * w..(y + 1) * w];
        let (above, here, below) = (row(y - 1), row(y), row(y + 1));
        let out = &mut determinant[y * w + 1..(y + 1) * w - 1];
        let triples = above.windows(3).zip(here.windows(3)).zip(below.windows(3));
        for (o, ((a, c), b)) in out.iter_mut().zip(triples) {
            let xx = c[0] - 2.0 * c[1] + c[2];
            let yy = a[1] - 2.0 * c[1] + b[1];
            let xy = 0.25 * (a[0] - a[2] - b[0] + b[2]);
            let d = xx * yy - xy * xy;
            *o = if (xx + yy) * sign > 0.0 { d } else { 0.0 };
        }
    }
    for y in 1..h - 1 {
        let row = |y: usize| &determinant[y * w..(y + 1) * w];
        let (above, here, below) = (row(y - 1), row(y), row(y + 1));
        for x in 1..w - 1 {
            let d = here[x];
            // The first of equal neighbours counts.
            if d > least
                && d > here[x - 1]
                && d >= here[x + 1]
                && above[x - 1..=x + 1].iter().all(|n| d > *n)
                && below[x - 1..=x + 1].iter().all(|n| d >= *n)
            {
                found([x as f64, y as f64], f64::from(d).sqrt() * to_contrast);
            }
        }
    }
}

/// Keeps the strongest of those that lie in each other.
fn strongest(mut found: Vec<Candidate>, size: [usize; 2]) -> Vec<Candidate> {
    found.sort_by(|a, b| b.contrast.total_cmp(&a.contrast));
    let mut cells = Cells::new(size);
    let mut kept: Vec<Candidate> = Vec::new();
    let mut largest = 0.0_f64;
    for c in found {
        let inside =
            |k: &Candidate| (k.at[0] - c.at[0]).hypot(k.at[1] - c.at[1]) < 0.9 * k.radius.max(c.radius);
        if !cells.near(c.at, c.radius.max(largest)).any(|k| inside(&kept[k])) {
            cells.add(c.at, kept.len());
            largest = largest.max(c.radius);
            kept.push(c);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(discs: &[[f64; 3]], contrast: f32) -> Grey {
        let (width, height) = (120, 90);
        let sample = |i: usize| {
            let (x, y) = ((i % width) as f64, (i / width) as f64);
            // A slope of light that no disc is.
            let inside = discs.iter().any(|d| (x - d[0]).hypot(y - d[1]) <= d[2]);
            100.0 + 0.3 * x as f32 + if inside { contrast } else { 0.0 }
        };
        Grey { width, height, samples: (0..width * height).map(sample).collect() }
    }

    #[test]
    fn discs_of_every_size_are_found_with_their_radius_and_contrast() {
        let discs = [[20.0, 20.0, 2.0], [40.0, 60.0, 6.0], [85.0, 45.0, 20.0]];
        // Corners of a large disc's rim answer too, with half of its contrast.
        let mut found = candidates(&picture(&discs, 50.0), Look::Bright, [1.5, 40.0], 35.0);
        found.sort_by(|a, b| a.at[0].total_cmp(&b.at[0]));
        assert_eq!(found.len(), 3, "{found:?}");
        for (d, c) in discs.iter().zip(&found) {
            assert!((d[0] - c.at[0]).hypot(d[1] - c.at[1]) <= 0.3 * d[2], "{c:?}");
            assert!((c.radius / d[2]).ln().abs() < 0.3, "{c:?}");
            assert!((c.contrast / 50.0).ln().abs() < 0.25, "{c:?}");
        }
        assert!(candidates(&picture(&discs, 50.0), Look::Dark, [1.5, 40.0], 35.0).is_empty());
    }
}
