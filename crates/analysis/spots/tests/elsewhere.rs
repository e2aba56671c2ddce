//! Pictures that this project did not make: another program's simulations with their truth, and a real dot grid.

// Clippy lets `#[test]` functions unwrap, but not what they call.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use biplane_artifact::{Frame, Spot, Spots};
use biplane_spots::{Look, SpotParams, SpotSettings, find_spots};

/// A file of the workplace's data; `None`, with a message, where it is not there.
fn data(path: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data").join(path);
    if !path.is_file() {
        println!("skipped: {path:?} is not there");
        return None;
    }
    Some(path)
}

fn found(path: &Path, look: Look) -> Spots {
    let grey = image::open(path).unwrap().into_luma8();
    let (width, height) = (grey.width() as usize, grey.height() as usize);
    let samples = grey.into_raw().into_iter().map(u16::from).collect();
    let frame = Frame { width, height, samples, bits: 8 };
    find_spots(&frame, &SpotParams { look, settings: SpotSettings::default() }).unwrap()
}

/// Rows of numbers of a CSV file with a header.
fn table(path: &Path) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(path).unwrap();
    text.lines().skip(1).map(|l| l.split(',').map(|v| v.parse().unwrap()).collect()).collect()
}

/// The ideal pixel of a recorded one, between the four samples of a table about it.
fn ideal(samples: &[Vec<f64>], at: [f64; 2]) -> Option<[f64; 2]> {
    let (first, step) = (samples[0][0], samples[1][0] - samples[0][0]);
    let columns = samples.iter().take_while(|s| s[1] == samples[0][1]).count();
    let [u, v] = at.map(|p| (p - first) / step);
    let (i, j) = (u.floor() as isize, v.floor() as isize);
    let (fx, fy) = (u - u.floor(), v - v.floor());
    let sample = |i: isize, j: isize| {
        let inside = i >= 0 && (i as usize) < columns && j >= 0;
        samples.get((j.max(0) as usize) * columns + i.max(0) as usize).filter(|_| inside)
    };
    let corners = [sample(i, j)?, sample(i + 1, j)?, sample(i, j + 1)?, sample(i + 1, j + 1)?];
    let weights = [(1.0 - fx) * (1.0 - fy), fx * (1.0 - fy), (1.0 - fx) * fy, fx * fy];
    Some([2, 3].map(|k| corners.iter().zip(weights).map(|(c, w)| c[k] * w).sum()))
}

#[test]
fn holes_of_a_plate_that_another_program_drew_lie_where_it_says() {
    for (study, view) in [("knee-implant", "A"), ("knee-natural", "B")] {
        let folder = format!("simulated/{study}");
        let Some(picture) = data(&format!("{folder}/calibration/plate_{view}.png")) else { return };
        let Some(truth) = data(&format!("{folder}/truth/plate_{view}.csv")) else { return };
        let Some(bent) = data(&format!("{folder}/truth/distortion_{view}.csv")) else { return };
        let (truth, bent) = (table(&truth), table(&bent));
        let spots = found(&picture, Look::Bright);
        // Of its truth.json: 315 mm over 1024 pixels about 511.5.
        let holes: Vec<[f64; 2]> =
            truth.iter().map(|h| [1, 2].map(|k| 511.5 + h[k] / (315.0 / 1024.0))).collect();
        let (mut squares, mut matched, mut all) = (0.0, 0, 0);
        for spot in spots.spots.iter().filter(|s| !s.cut) {
            let Some(at) = ideal(&bent, spot.at_px) else { continue };
            all += 1;
            let distance = |h: &[f64; 2]| (h[0] - at[0]).hypot(h[1] - at[1]);
            let least = holes.iter().map(distance).fold(f64::INFINITY, f64::min);
            if least < 1.0 {
                matched += 1;
                squares += least * least;
            }
        }
        let rms = f64::sqrt(squares / f64::from(matched));
        println!("{study} {view}: {matched} of {all} spots are holes, {rms:.4} px rms");
        assert!(matched > 550 && matched == all);
        // The table's samples are 24 px apart and straight lines between them are not the map.
        assert!(rms < 0.05, "{rms}");
    }
}

#[test]
fn two_beads_in_one_shadow_are_cut() {
    let Some(path) = data("simulated/knee-implant/calibration/beads_A.png") else { return };
    let spots = found(&path, Look::Dark);
    let near = |x: f64, y: f64| {
        let near = |s: &&Spot| (s.at_px[0] - x).hypot(s.at_px[1] - y) < 2.0;
        *spots.spots.iter().find(near).unwrap()
    };
    // Two beads, by eye; one on the border, by eye; the others whole.
    assert!(near(229.0, 388.8).cut);
    assert!(near(821.0, 131.6).cut);
    assert_eq!(spots.spots.iter().filter(|s| !s.cut).count(), 26);
}

#[test]
fn frames_of_a_knee_have_no_plate_in_them() {
    let Some(path) = data("simulated/knee-implant/frames/A/0003.png") else { return };
    for look in [Look::Bright, Look::Dark] {
        assert!(found(&path, look).spots.len() <= 2);
    }
}

#[test]
fn dots_of_a_real_grid_lie_evenly() {
    let Some(path) = data("real/grids/dot_pattern_01.jpg") else { return };
    let spots = found(&path, Look::Dark);
    let whole: Vec<&Spot> = spots.spots.iter().filter(|s| !s.cut).collect();
    assert_eq!(spots.border, None);
    // The distance of a dot from the mean of its four neighbours: the grid's bend is far smaller.
    let pitch = 26.0;
    let mut scatter: Vec<f64> = whole
        .iter()
        .filter_map(|s| {
            let to = |o: &&&Spot| [o.at_px[0] - s.at_px[0], o.at_px[1] - s.at_px[1]];
            let side = |x: f64, y: f64| {
                whole.iter().map(|o| to(&o)).find(|d| (d[0] - x * pitch).hypot(d[1] - y * pitch) < 5.0)
            };
            let sides = [side(1.0, 0.0)?, side(-1.0, 0.0)?, side(0.0, 1.0)?, side(0.0, -1.0)?];
            let mean = [0, 1].map(|k| sides.iter().map(|d| d[k]).sum::<f64>() / 4.0);
            Some(mean[0].hypot(mean[1]))
        })
        .collect();
    scatter.sort_by(f64::total_cmp);
    let quantile = |q: f64| scatter[(q * (scatter.len() - 1) as f64) as usize];
    println!(
        "{} dots, {} cut; of {} with four neighbours the distance from their mean is {:.3} px in the median, {:.3} px at 95 %",
        spots.spots.len(),
        spots.spots.len() - whole.len(),
        scatter.len(),
        quantile(0.5),
        quantile(0.95)
    );
    assert!(whole.len() > 6500, "{}", whole.len());
    assert!(quantile(0.5) < 0.1, "{}", quantile(0.5));
}
