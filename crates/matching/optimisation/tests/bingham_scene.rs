//! The thesis's own method on the scene of another program (`fixtures/scene`; the whole of it, with outlines of the meshes
//! themselves, is not part of the project).

// A test whose set-up fails has failed.
#![allow(clippy::unwrap_used)]

mod scene;

use std::path::Path;

use biplane_fluoroscope::Fluoroscope;
use biplane_optimisation::{BinghamParams, BinghamView, Descent, descend};
use scene::{mesh, numbers, of_thesis, posed, workspace};
use serde_json::Value;

/// One start and what came of it.
struct Single {
    found: Descent,
    mm: f64,
    deg: f64,
}

impl Single {
    fn right(&self) -> bool {
        self.mm < 1.0 && self.deg < 1.0
    }
}

/// Offsets of the starts: Gaussian, sigma 10 mm and degrees cut at 20, or sigma 20 not cut.
const SETS: [&str; 2] = ["A_truncated_gauss_sigma10_clip20", "B_gauss_sigma20"];

/// The scene's starts of a set at each of `poses`: a mesh of 15,000 points against the outline of the mesh of `outline`.
fn singles(
    folder: &Path,
    body: &str,
    outline: &str,
    set: &str,
    poses: std::ops::Range<usize>,
) -> Vec<Single> {
    let scene: Value = serde_json::from_slice(&std::fs::read(folder.join("scene.json")).unwrap()).unwrap();
    let mesh = mesh(&folder.join(format!("{body}_15000.stl")));
    let centroid = mesh.area_centroid();
    let offsets = scene["start_offsets"][set].as_array().unwrap();
    let mut all = Vec::new();
    for number in poses {
        let posed = posed(folder, &scene, body, outline, number);
        let views: Vec<BinghamView> = posed
            .views
            .iter()
            .map(|(calibration, curves, pixel)| {
                BinghamView::new(Fluoroscope::from(calibration), curves, *pixel)
            })
            .collect();
        for offset in offsets {
            let offset = numbers::<6>(offset);
            let start = of_thesis(&std::array::from_fn(|i| posed.truth[i] + offset[i]));
            let params = BinghamParams::default();
            let found = descend(mesh.vertices(), &centroid, &views, &start, &params);
            let error = found.pose.error_against(&posed.pose, &centroid);
            all.push(Single { found, mm: error.translation_mm, deg: error.rotation_rad.to_degrees() });
        }
    }
    all
}

/// Median translation, mm, and rotation, degrees, of the right ones.
fn medians(all: &[Single]) -> (f64, f64) {
    let median = |of: fn(&Single) -> f64| {
        let mut sorted: Vec<f64> = all.iter().filter(|s| s.right()).map(of).collect();
        sorted.sort_by(f64::total_cmp);
        sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
    };
    (median(|s| s.mm), median(|s| s.deg))
}

/// The outline is that of a mesh of 36,000 points. It printed 10 right, 0.005 mm, 0.006 degrees.
#[test]
fn ten_starts_of_the_thesis_find_a_bone_from_ideal_outlines() {
    let folder = workspace().join("fixtures/scene");
    let all = singles(&folder, "bone", "36000", SETS[0], 0..1);
    let (mm, deg) = medians(&all);
    let right = all.iter().filter(|s| s.right()).count();
    let calls: usize = all.iter().map(|s| s.found.calls).sum();
    println!("right {right} of {}, {mm:.4} mm, {deg:.4} degrees, {calls} calls", all.len());
    assert!(right >= 9, "{right} of {} starts right", all.len());
    assert!(mm < 0.05 && deg < 0.1, "{mm} mm, {deg} degrees");
    assert!(all.iter().all(|s| s.found.calls <= 800 && s.found.converged == (s.found.calls < 800)));
}

/// Measures what the table of `src/bingham.rs` has for the settings as they are, and set B beside it.
#[test]
#[ignore = "a measurement of a minute"]
fn measure_forty_starts_a_body() {
    let folder = workspace().join("../shared/data/simulated/scene");
    if !folder.join("scene.json").exists() {
        println!("skipped: {} is not there", folder.display());
        return;
    }
    for (set, body) in SETS.iter().flat_map(|s| ["bone", "implant"].map(|b| (s, b))) {
        let clock = std::time::Instant::now();
        let all = singles(&folder, body, "15000", set, 0..4);
        let ms = clock.elapsed().as_secs_f64() * 1e3;
        let (mm, deg) = medians(&all);
        let right = all.iter().filter(|s| s.right()).count();
        let converged = all.iter().filter(|s| s.found.converged).count();
        let calls: usize = all.iter().map(|s| s.found.calls).sum();
        println!(
            "{set} {body}: right {right} of {}, converged {converged}, {mm:.4} mm, {deg:.4} degrees, {:.0} calls, \
             {:.2} ms a call",
            all.len(),
            calls as f64 / all.len() as f64,
            ms / calls as f64
        );
    }
}
