//! Labels as they come: cut off by the volume, in pieces, hollow, thin, noise; and what is refused.

#![allow(clippy::unwrap_used)] // the helpers of tests are tests

use biplane_artifact::{Artifact, BoneSurface, Volume};
use biplane_label_surface::{Keep, LabelSurfaceError, LabelSurfaceParams, label_surface};
use biplane_stage::Context;
use biplane_surface::MeshCheck;
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Voxels of 0.5 x 0.5 x 1 mm with label 7 where `inside`.
fn volume(size: [usize; 3], mut inside: impl FnMut([usize; 3]) -> bool) -> Volume {
    let mut samples = Vec::new();
    for k in 0..size[2] {
        for j in 0..size[1] {
            samples.extend((0..size[0]).map(|i| if inside([i, j, k]) { 7.0 } else { 2.0 }));
        }
    }
    Volume {
        columns: size[0],
        rows: size[1],
        column_step_mm: [0.5, 0.0, 0.0],
        row_step_mm: [0.0, 0.5, 0.0],
        origins_mm: (0..size[2]).map(|k| [0.0, 0.0, k as f64]).collect(),
        samples,
    }
}

fn params(smoothing_mm: f64, keep: Keep) -> LabelSurfaceParams {
    LabelSurfaceParams { label: 7, smoothing_mm, keep }
}

fn made(volume: &Volume, params: &LabelSurfaceParams) -> BoneSurface {
    let surface = label_surface(volume, params, &Context::new()).unwrap();
    let check = MeshCheck::of(&surface.mesh);
    assert!(check.is_closed_manifold() && check.signed_volume_mm3 > 0.0);
    assert_eq!(BoneSurface::decode(&surface.encode()).unwrap(), surface);
    surface
}

fn within(p: [usize; 3], low: [usize; 3], high: [usize; 3]) -> bool {
    (0..3).all(|a| (low[a]..high[a]).contains(&p[a]))
}

#[test]
fn a_label_cut_off_by_the_volume_has_a_flat_lid_there() {
    // A rod of 10 x 10 mm through all slices, of 20 mm.
    let rod = volume([40, 40, 20], |p| within(p, [10, 10, 0], [30, 30, 20]));
    let BoneSurface { mesh, report } = made(&rod, &params(0.8, Keep::Largest));
    assert!(report.warnings[0].contains("the first slice, the last slice of the volume"), "{report:?}");
    let (low, high) = mesh.bounding_box();
    // Half a slice beyond the first and the last centre.
    assert!((low.z + 0.5).abs() < 1e-4 && (high.z - 19.5).abs() < 1e-4, "{low} {high}");
    let lid = mesh.vertices().iter().filter(|v| (v.z - high.z).abs() < 1e-4).count();
    assert!(lid > 200, "{lid}");
    // The sides run straight into the lid: no neck, no bulge.
    let near = mesh.vertices().iter().filter(|v| v.z > 17.0);
    let widest = near.map(|v| (v.x - 9.75).abs()).fold(0.0, f64::max);
    assert!((widest - 5.0).abs() < 0.15, "{widest}");
    assert!((report.volume_mm3 / 2000.0 - 1.0).abs() < 1e-3 && report.unsmoothed_volume_mm3 == 2000.0);
    assert_eq!((report.slices, report.contours, report.faults.len()), (20, 0, 0));
    // Cut off on all sides: a box.
    let whole = made(&volume([8, 8, 8], |_| true), &params(0.5, Keep::All));
    assert_eq!(whole.report.warnings.len(), 1);
    assert!((whole.report.volume_mm3 / 128.0 - 1.0).abs() < 0.03, "{:?}", whole.report);
}

#[test]
fn pieces_are_left_out_or_kept_and_named_with_their_slices() {
    let labels = volume([40, 30, 20], |p| {
        let hollow = within(p, [8, 8, 8], [10, 10, 10]);
        (within(p, [4, 4, 4], [16, 16, 16]) && !hollow)
            || within(p, [24, 4, 2], [34, 14, 6])
            || p == [36, 26, 17]
    });
    let largest = made(&labels, &params(0.5, Keep::Largest));
    assert_eq!(largest.report.pieces, 1);
    let warnings = &largest.report.warnings;
    assert_eq!(
        warnings[0],
        "pieces beside the largest are left out: 400 voxels (100.00 mm^3) in slices 2 to 5, 1 voxel (0.25 mm^3) in slice 17"
    );
    assert_eq!(warnings[1], "hollows inside are filled: 8 voxels (2.00 mm^3) in slices 8 to 9");
    assert_eq!(largest.report.unsmoothed_volume_mm3, 1728.0 / 4.0);
    let all = made(&labels, &params(0.0, Keep::All));
    assert!(all.report.warnings[0].starts_with("the label is in 3 pieces: 1720 voxels"), "{:?}", all.report);
    assert!(all.report.pieces >= 3, "{:?}", all.report);
}

#[test]
fn a_thin_bridge_that_smoothing_takes_away_is_told_of() {
    let labels = volume([60, 20, 20], |p| {
        within(p, [4, 4, 4], [18, 16, 16])
            || within(p, [30, 5, 5], [42, 15, 15])
            || within(p, [18, 9, 9], [30, 10, 10])
    });
    let surface = made(&labels, &params(1.5, Keep::Largest));
    assert_eq!(surface.report.pieces, 1);
    let told = surface.report.warnings.iter().any(|w| w.contains("falls into 2 pieces"));
    assert!(told, "{:?}", surface.report.warnings);
}

#[test]
fn noise_of_any_kind_is_closed_and_two_manifold() {
    let mut generator = Xoshiro256PlusPlus::seed_from_u64(3);
    let mut faults = 0;
    for share in [0.05, 0.3, 0.5, 0.7, 0.95] {
        for smoothing_mm in [0.0, 0.4, 1.0] {
            for keep in [Keep::Largest, Keep::All] {
                let noise = volume([18, 17, 12], |_| generator.random::<f64>() < share);
                match label_surface(&noise, &params(smoothing_mm, keep), &Context::new()) {
                    Ok(surface) => {
                        assert!(MeshCheck::of(&surface.mesh).is_closed_manifold());
                        faults += surface.report.faults.len();
                        // Crossings are looked for, and nothing else is wrong.
                        assert!(surface.report.faults.iter().all(|f| f.what.contains("cross")));
                    }
                    Err(error) => assert!(matches!(error, LabelSurfaceError::Vanished { .. }), "{error}"),
                }
            }
        }
    }
    println!("{faults} slices with crossings in thirty volumes of noise");
}

#[test]
fn small_labels_are_a_surface_or_a_clear_error() {
    for size in [[1, 1, 1], [3, 1, 1], [1, 1, 5], [2, 3, 1]] {
        let surface = made(&volume(size, |_| true), &params(0.0, Keep::Largest));
        println!("{size:?}: {} vertices, {:?}", surface.mesh.vertices().len(), surface.report);
    }
    let voxel = volume([21, 21, 21], |p| p == [10, 10, 10]);
    let error = label_surface(&voxel, &params(2.0, Keep::Largest), &Context::new()).unwrap_err();
    assert!(error.to_string().contains("(1 voxels) when it is smoothed by 2 mm"), "{error}");
}

#[test]
fn what_is_wrong_is_refused_with_what_to_do() {
    let run =
        |v: &Volume, p: &LabelSurfaceParams| label_surface(v, p, &Context::new()).unwrap_err().to_string();
    let good = volume([4, 4, 4], |p| p == [1, 1, 1]);
    let one = params(0.5, Keep::All);
    let cases = [
        (run(&good, &LabelSurfaceParams::default()), "label = 0"),
        (run(&good, &params(f64::NAN, Keep::All)), "smoothing_mm = NaN, expected 0 to 10 mm"),
        (run(&good, &LabelSurfaceParams { label: 3, ..one.clone() }), "the volume has the labels 2, 7"),
        (run(&Volume { columns: 5, ..good.clone() }, &one), "with 64 samples"),
        (run(&Volume { row_step_mm: [0.5, 0.1, 0.0], ..good.clone() }, &one), "at right angles"),
        (run(&Volume { row_step_mm: [f64::NAN, 0.1, 0.0], ..good.clone() }, &one), "at right angles"),
        (run(&Volume { origins_mm: vec![[0.0; 3]; 4], ..good.clone() }, &one), "slice 1 does not lie behind"),
        (run(&Volume { origins_mm: vec![[f64::NAN; 3]; 4], ..good.clone() }, &one), "does not lie behind"),
    ];
    for (error, part) in cases {
        assert!(error.contains(part), "{part} not in {error}");
    }
    let context = Context::new();
    context.cancel();
    assert_eq!(label_surface(&good, &one, &context), Err(LabelSurfaceError::Cancelled));
}
