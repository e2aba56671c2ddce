//! How long lofting takes on one core, as a ratio to the limit of 100 ms for 300 slices of 400 points, checks apart:
//! `cargo bench -p biplane-lofting`.

use std::time::Instant;

use biplane_artifact::{ContourSlice, SliceContour, SliceContours, SlicePoint};
use biplane_lofting::{LoftParams, Method, loft, surface_of};

const LIMIT_S: f64 = 0.1;
const SLICES: usize = 300;
const POINTS: usize = 400;

/// The least time of many, s.
fn least<T>(rounds: usize, mut of: impl FnMut() -> T) -> f64 {
    let once = |_| {
        let start = Instant::now();
        std::hint::black_box(of());
        start.elapsed().as_secs_f64()
    };
    (0..rounds).map(once).fold(f64::INFINITY, f64::min)
}

/// A wavy ring about a centre, px of 0.4 mm.
fn ring(centre: [f64; 2], radii: [f64; 2], count: usize) -> SliceContour {
    let point = |k: usize| {
        let a = std::f64::consts::TAU * k as f64 / count as f64;
        let r = 1.0 + 0.05 * (3.0 * a).sin() + 0.02 * (7.0 * a).cos();
        SlicePoint {
            i: centre[0] + radii[0] * r * a.cos(),
            j: centre[1] + radii[1] * r * a.sin(),
            sigma_mm: 0.05,
        }
    };
    SliceContour { points: (0..count).map(point).collect() }
}

fn stack(contours: impl Fn(f64) -> Vec<SliceContour>) -> SliceContours {
    let slice = |k: usize| ContourSlice {
        origin_mm: [0.0, 0.0, 0.4 * k as f64],
        contours: contours(k as f64 / SLICES as f64),
        flags: Vec::new(),
        edited: false,
    };
    SliceContours {
        columns: 512,
        rows: 512,
        column_step_mm: [0.4, 0.0, 0.0],
        row_step_mm: [0.0, 0.4, 0.0],
        slices: (0..SLICES).map(slice).collect(),
        warnings: Vec::new(),
    }
}

fn main() {
    // A shaft of about 28 to 36 mm.
    let tube = stack(|t| vec![ring([250.0 + 30.0 * t, 250.0], [38.0 + 7.0 * (6.0 * t).sin(), 36.0], POINTS)]);
    // A femur from below: two condyles that begin, join, and become a shaft.
    let knee = stack(|t| {
        let grown = (t / 0.15).min(1.0).sqrt();
        match t {
            t if t < 0.003 => Vec::new(),
            t if t < 0.25 => [190.0, 310.0]
                .map(|x| ring([x, 250.0], [55.0 * grown.max(0.1), 70.0 * grown.max(0.1)], POINTS / 2))
                .to_vec(),
            t => {
                let narrow = ((t - 0.25) / 0.4).min(1.0);
                vec![ring([250.0, 250.0 + 20.0 * t], [115.0 - 75.0 * narrow, 70.0 - 32.0 * narrow], POINTS)]
            }
        }
    });
    println!("{SLICES} slices of {POINTS} points; limit {:.0} ms", LIMIT_S * 1e3);
    for (name, contours) in [("tube", &tube), ("knee", &knee)] {
        for method in [Method::Distance, Method::Diagonal] {
            let params = LoftParams { method, ..LoftParams::default() };
            let time = least(15, || surface_of(contours, &params));
            let checked = least(3, || loft(contours, &params));
            let Ok(surface) = loft(contours, &params) else { continue };
            println!(
                "{:8.1} ms = {:.2} of the limit: {name}, {method:?}; {} triangles; with checks {:.0} ms, {} faults",
                time * 1e3,
                time / LIMIT_S,
                surface.mesh.triangles().len(),
                checked * 1e3,
                surface.report.faults.len()
            );
        }
    }
}
