//! Contours of the phantom's stacks against its solids: maps of labels, and MRI with all that spoils it.

// Clippy lets `#[test]` functions unwrap, but not what they call.
#![allow(clippy::unwrap_used, clippy::panic)]

use biplane_artifact::{SliceContours, Volume};
use biplane_geometry::{Model, Point3, Rigid};
use biplane_phantom::{
    Ball, Body, MriFaults, MriScene, ScannedBone, Scanner, SliceGrid, Solid, TissueLevels, gradient,
};
use biplane_slices::{Method, SlicesParams, slice_contours};
use biplane_stage::Context;

fn volume(grid: &SliceGrid, samples: Vec<f32>) -> Volume {
    let step = |a: usize| (grid.axes[a] * grid.spacing_mm[a]).into();
    Volume {
        columns: grid.size[0],
        rows: grid.size[1],
        column_step_mm: step(0),
        row_step_mm: step(1),
        origins_mm: (0..grid.size[2]).map(|k| grid.position([0.0, 0.0, k as f64]).coords.into()).collect(),
        samples,
    }
}

/// Signed distance of every contour point from a solid, mm.
fn distances(
    contours: &SliceContours,
    solid: &dyn Solid,
    scanner_from_model: &Rigid<Scanner, Model>,
) -> Vec<f64> {
    let model_from_scanner = scanner_from_model.inverse();
    let mut found = Vec::new();
    for (k, slice) in contours.slices.iter().enumerate() {
        for c in 0..slice.contours.len() {
            for p in contours.points_mm(k, c) {
                let at = model_from_scanner.transform(&Point3::from(p));
                found.push(solid.value(&at) / gradient(solid, &at).norm().max(0.1));
            }
        }
    }
    found
}

struct Figures {
    mean: f64,
    rms: f64,
    median: f64,
    most: f64,
    worst: f64,
}

fn figures(signed: &[f64]) -> Figures {
    let n = signed.len() as f64;
    let mut sizes: Vec<f64> = signed.iter().map(|d| d.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let at = |share: f64| sizes[((n - 1.0) * share) as usize];
    Figures {
        mean: signed.iter().sum::<f64>() / n,
        rms: (signed.iter().map(|d| d * d).sum::<f64>() / n).sqrt(),
        median: at(0.5),
        most: at(0.95),
        worst: at(1.0),
    }
}

fn told(name: &str, f: &Figures) {
    let Figures { mean, rms, median, most, worst } = f;
    println!(
        "{name}: mean {mean:+.3}, rms {rms:.3}, median {median:.3}, 95 % {most:.3}, worst {worst:.3} mm"
    );
}

fn of_labels(solid: &dyn Solid, grid: &SliceGrid, smoothing_px: f64) -> SliceContours {
    let filled = grid.filled(solid, &Rigid::identity()).unwrap();
    let samples = filled.into_iter().map(|f| if f >= 0.5 { 5.0 } else { 0.0 }).collect();
    let params = SlicesParams { label: 5, smoothing_px, ..SlicesParams::default() };
    slice_contours(&volume(grid, samples), &params, &Context::new()).unwrap()
}

#[test]
fn labels_are_followed_to_a_fraction_of_a_voxel() {
    let ball = Ball { centre: Point3::new(1.13, -2.31, 0.57), radius: 20.0 };
    for (name, solid, pixel, slice) in [
        ("ball", &ball as &dyn Solid, 0.5, 0.5),
        ("ball", &ball, 0.365, 0.7),
        ("ball", &ball, 0.625, 4.0),
        ("femur", Body::DistalFemur.solid(), 0.5, 1.0),
        ("tibia", Body::ProximalTibia.solid(), 0.365, 0.7),
    ] {
        for smoothing in [0.5, 0.7, 1.0, 1.5] {
            let grid = SliceGrid::covering(solid.bounds(), 5.0, 0, pixel, slice);
            let contours = of_labels(solid, &grid, smoothing);
            let f = figures(&distances(&contours, solid, &Rigid::identity()));
            told(&format!("labels of a {name}, {pixel} x {slice} mm, smoothing {smoothing}"), &f);
        }
    }
}

fn mri(body: Body, across: usize, pixel: f64, slice: f64, faults: &MriFaults) -> (SliceContours, Vec<f64>) {
    let pose = Rigid::identity();
    let (outer, inner) = (body.solid(), body.inner().unwrap());
    let bone = ScannedBone { outer, inner, cartilage: None, scanner_from_model: pose, label: 1 };
    let scene = MriScene { bones: vec![bone], limb: None, levels: TissueLevels::default() };
    let grid = SliceGrid::covering(outer.bounds(), 8.0, across, pixel, slice);
    let stack = scene.scan(&grid, faults).unwrap();
    let samples = stack.samples.iter().map(|&s| f32::from(s)).collect();
    let seed = match body {
        Body::DistalFemur => [0.0, 0.0, -10.0],
        _ => [0.0, 0.0, 20.0],
    };
    let params = SlicesParams { method: Method::Bone, seed_mm: Some(seed), ..SlicesParams::default() };
    let start = std::time::Instant::now();
    let contours = slice_contours(&volume(&grid, samples), &params, &Context::new()).unwrap();
    println!("{:?} {:?}", grid.size, start.elapsed());
    for w in &contours.warnings {
        println!("{w}");
    }
    for (k, s) in contours.slices.iter().enumerate().filter(|s| !s.1.flags.is_empty()) {
        println!("slice {k}: {:?}", s.flags);
    }
    let off = distances(&contours, outer, &pose);
    if let Ok(folder) = std::env::var("SLICES_OUT") {
        use biplane_artifact::Artifact;
        let name = format!("{folder}/{}_{across}_{slice}_{}", body.name(), faults.bits);
        std::fs::write(format!("{name}.json"), contours.encode()).unwrap();
        let raw: Vec<u8> = stack.samples.iter().flat_map(|s| s.to_le_bytes()).collect();
        std::fs::write(format!("{name}.raw"), raw).unwrap();
        let text: Vec<String> = off.iter().map(|d| format!("{d:.3}")).collect();
        std::fs::write(format!("{name}.off"), text.join(" ")).unwrap();
    }
    (contours, off)
}

#[test]
fn bones_are_found_from_a_seed() {
    for (body, across, pixel, slice) in [
        (Body::DistalFemur, 0, 0.5, 1.0),
        (Body::DistalFemur, 2, 0.5, 1.0),
        (Body::ProximalTibia, 0, 0.5, 1.0),
        (Body::DistalFemur, 0, 0.625, 3.0),
    ] {
        for (name, faults) in [("clean", MriFaults::none()), ("usual", MriFaults::usual(5))] {
            let (_, off) = mri(body, across, pixel, slice, &faults);
            told(&format!("{} across {across}, {pixel} x {slice} mm, {name}", body.name()), &figures(&off));
        }
    }
}
