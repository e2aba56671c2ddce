//! Surfaces of the labels of a real knee: against the voxels they are made of, and of the tibia against a third party's mesh.
//! Skipped, with a message, where the data is not there. `cargo test -p biplane-validation --test label_surface -- --nocapture`
//! shows the figures.

#![allow(clippy::unwrap_used)] // the helpers of tests are tests

use std::path::{Path, PathBuf};
use std::time::Instant;

use biplane_acquisition::meshes::{LengthUnit, read_mesh};
use biplane_acquisition::volumes::read_volume;
use biplane_artifact::Volume;
use biplane_geometry::{Mesh, Point3};
use biplane_label_surface::{LabelSurfaceParams, label_surface};
use biplane_stage::Context;
use biplane_surface::{MeshCheck, Spread, Surface, distances};

/// The folder of the real knee, if it is there.
fn knee() -> Option<PathBuf> {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(3)?;
    let path = workspace.parent()?.join("shared/data/real/knee-mri");
    if path.is_dir() {
        return Some(path);
    }
    println!("skipped: real/knee-mri is not there");
    None
}

/// Median, 95 % and worst.
fn said(spread: &Spread) -> String {
    format!("{:.3} / {:.3} / {:.3}", spread.median, spread.p95, spread.worst)
}

/// Midpoints of neighbouring voxels of which one has the label.
fn boundary(volume: &Volume, label: f32) -> Vec<Point3> {
    let [columns, rows] = [volume.columns, volume.rows];
    let at = |[i, j, k]: [usize; 3]| volume.slice(k).map(|s| s[j * columns + i] == label);
    let place = |[i, j, k]: [usize; 3]| Point3::from(volume.place_mm(i as f64, j as f64, k).unwrap());
    let mut points = Vec::new();
    for k in 0..volume.origins_mm.len() {
        for j in 0..rows {
            for i in 0..columns {
                for next in [[i + 1, j, k], [i, j + 1, k], [i, j, k + 1]] {
                    let there = next[0] < columns && next[1] < rows;
                    if there && at(next).is_some_and(|n| Some(n) != at([i, j, k])) {
                        points.push(nalgebra::center(&place([i, j, k]), &place(next)));
                    }
                }
            }
        }
    }
    points
}

fn from_points(points: &[Point3], to: &Surface) -> Spread {
    Spread::of(&points.iter().map(|p| to.closest(p).distance_mm).collect::<Vec<f64>>())
}

/// Both ways: points of either surface, and their distances from the other.
fn between(mesh: &Mesh, other: &Mesh) -> [Spread; 2] {
    let of = |from: &Mesh, to: &Mesh| Spread::of(&distances(from, &Surface::new(to), 40_000));
    [of(mesh, other), of(other, mesh)]
}

#[test]
fn the_bones_of_a_real_knee_are_smooth_and_where_their_labels_are() {
    let Some(folder) = knee() else { return };
    let volume = read_volume(folder.join("knee-labels.nrrd")).unwrap().volume;
    let reference = read_mesh(folder.join("tibia_mesh.vtk"), Some(LengthUnit::Millimetres)).unwrap().model.0;
    for (name, label) in [("femur", 5), ("tibia", 6), ("patella", 7), ("fibula", 8)] {
        let params = LabelSurfaceParams { label, ..LabelSurfaceParams::default() };
        let start = Instant::now();
        let made = label_surface(&volume, &params, &Context::new()).unwrap();
        let seconds = start.elapsed().as_secs_f64();
        let off = from_points(&boundary(&volume, label as f32), &Surface::new(&made.mesh));
        let report = &made.report;
        let change = 100.0 * (report.volume_mm3 / report.unsmoothed_volume_mm3 - 1.0);
        println!(
            "{name}: {} vertices in {seconds:.2} s; the label's boundary is {} mm off; volume {change:+.3} %, {:?}",
            made.mesh.vertices().len(),
            said(&off),
            report.warnings
        );
        assert!(MeshCheck::of(&made.mesh).is_closed_manifold());
        assert!(report.faults.is_empty() && change.abs() < 0.01, "{report:?}");
        // What is asked of a lofted tibia; measured: 0.079 to 0.083 and 0.27 to 0.30.
        assert!(off.median < 0.10 && off.p95 < 0.35, "{name}");
        if label == 6 {
            let [to, back] = between(&made.mesh, &reference);
            println!("tibia: {} mm from the third party's mesh, and back {}", said(&to), said(&back));
            // Measured: 0.034 and 0.365 both ways, where 0.365 is the cut end: the mesh ends a pixel before the volume.
            for spread in [to, back] {
                assert!(spread.median < 0.06 && spread.p95 < 0.45);
            }
        }
    }
}
