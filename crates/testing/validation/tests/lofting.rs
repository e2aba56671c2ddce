//! Bones of a real map of labels, lofted from their contours: against the boundary of the labels, against slices that were left out, and the
//! tibia against a third party's mesh. Skipped, with a message, where the data is not there.
//! `cargo test -p biplane-validation --test lofting -- --nocapture` shows the figures.
//!
//! The boundary of a label is taken in two ways. The **staircase** of the voxels' faces is what the labels say to the letter; half a voxel's
//! step is in it, so no smooth surface lies nearer to it than about a quarter of a voxel, and beside slices (0.70 mm) up to 0.35 mm off.
//! The **half level** is where the label, interpolated linearly between the voxels' centres, is one half. Limits are held against that.

#![allow(clippy::unwrap_used)] // the helpers of tests are tests

use std::path::{Path, PathBuf};
use std::time::Instant;

use biplane_acquisition::meshes::{LengthUnit, read_mesh};
use biplane_acquisition::volumes::read_volume;
use biplane_artifact::{BoneSurface, SliceContours, Volume};
use biplane_geometry::{Mesh, Point3};
use biplane_lofting::{LoftParams, loft, surface_of};
use biplane_slices::{SlicesParams, slice_contours};
use biplane_stage::Context;
use biplane_surface::{Spread, Surface, spread_points};
use nalgebra::{Matrix3, Vector3};

/// Points of a surface at which it is compared.
const SAMPLES: usize = 40_000;
/// What is nearer to the border of the volume than this counts as cut, mm.
const CUT_MM: f64 = 2.0;

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

/// A volume's voxels: places to columns, rows and slices, with fractions.
struct Voxels {
    voxel_from_mm: Matrix3<f64>,
    origin: Vector3<f64>,
    last: [f64; 3],
    sizes_mm: [f64; 3],
}

impl Voxels {
    fn of(volume: &Volume) -> Self {
        let origin = Vector3::from(volume.origins_mm[0]);
        let slice = Vector3::from(volume.origins_mm[1]) - origin;
        let steps = [volume.column_step_mm.into(), volume.row_step_mm.into(), slice];
        let count = [volume.columns, volume.rows, volume.origins_mm.len()];
        Self {
            voxel_from_mm: Matrix3::from_columns(&steps).try_inverse().unwrap(),
            origin,
            last: count.map(|n| n as f64 - 1.0),
            sizes_mm: steps.map(|s: Vector3<f64>| s.norm()),
        }
    }

    fn place(&self, at: &Point3) -> Vector3<f64> {
        self.voxel_from_mm * (at.coords - self.origin)
    }

    /// Whether a place is away from where the volume ends.
    fn uncut(&self, at: &Point3) -> bool {
        let place = self.place(at);
        (0..3).all(|a| {
            let margin = CUT_MM / self.sizes_mm[a];
            (margin..=self.last[a] - margin).contains(&place[a])
        })
    }
}

fn thinned(volume: &Volume, step: usize) -> Volume {
    let kept: Vec<usize> = (0..volume.origins_mm.len()).step_by(step).collect();
    Volume {
        origins_mm: kept.iter().map(|k| volume.origins_mm[*k]).collect(),
        samples: kept.iter().flat_map(|k| volume.slice(*k).unwrap().iter().copied()).collect(),
        ..volume.clone()
    }
}

fn contours(volume: &Volume, label: u32) -> SliceContours {
    let params = SlicesParams { label, ..SlicesParams::default() };
    slice_contours(volume, &params, &Context::new()).unwrap()
}

/// The faces between voxels that have the label and those that do not.
fn staircase(volume: &Volume, label: f32) -> Mesh {
    let [columns, rows, slices] = [volume.columns, volume.rows, volume.origins_mm.len()];
    let has = |[i, j, k]: [usize; 3]| volume.slice(k).unwrap()[j * columns + i] == label;
    let steps = [volume.column_step_mm.into(), volume.row_step_mm.into(), slice_step(volume)];
    let origin = Vector3::from(volume.origins_mm[0]);
    let place = |p: [f64; 3]| Point3::from(origin + steps[0] * p[0] + steps[1] * p[1] + steps[2] * p[2]);
    let mut soup = Vec::new();
    for k in 0..slices {
        for j in 0..rows {
            for i in 0..columns {
                let here = [i, j, k];
                for a in 0..3 {
                    let mut next = here;
                    next[a] += 1;
                    if next[a] == [columns, rows, slices][a] || has(here) == has(next) {
                        continue;
                    }
                    let corner = |s: f64, t: f64| {
                        let mut p = here.map(|v| v as f64);
                        p[a] += 0.5;
                        p[(a + 1) % 3] += s;
                        p[(a + 2) % 3] += t;
                        place(p)
                    };
                    let quad = [corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5), corner(-0.5, 0.5)];
                    soup.extend([[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]);
                }
            }
        }
    }
    Mesh::from_soup(&soup).unwrap()
}

fn slice_step(volume: &Volume) -> Vector3<f64> {
    Vector3::from(volume.origins_mm[1]) - Vector3::from(volume.origins_mm[0])
}

/// Where the label, 1 or 0 at the voxels' centres and linear in the six tetrahedra of each eight neighbours, is one half.
fn half_level(volume: &Volume, label: f32) -> Mesh {
    let [columns, rows, slices] = [volume.columns, volume.rows, volume.origins_mm.len()];
    let has = |[i, j, k]: [usize; 3]| volume.slice(k).unwrap()[j * columns + i] == label;
    let steps = [volume.column_step_mm.into(), volume.row_step_mm.into(), slice_step(volume)];
    let origin = Vector3::from(volume.origins_mm[0]);
    let mut soup = Vec::new();
    for k in 0..slices - 1 {
        for j in 0..rows - 1 {
            for i in 0..columns - 1 {
                let corner = |c: usize| [i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)];
                let inside: [bool; 8] = std::array::from_fn(|c| has(corner(c)));
                if inside.iter().all(|v| *v == inside[0]) {
                    continue;
                }
                let place = |c: usize| {
                    let [x, y, z] = corner(c).map(|v| v as f64);
                    origin + steps[0] * x + steps[1] * y + steps[2] * z
                };
                let middle = |a: usize, b: usize| Point3::from((place(a) + place(b)) / 2.0);
                for [a, b] in [[1, 3], [1, 5], [2, 3], [2, 6], [4, 5], [4, 6]] {
                    let corners = [0, a, b, 7];
                    let (ins, outs): (Vec<usize>, Vec<usize>) = corners.iter().partition(|c| inside[**c]);
                    match (&ins[..], &outs[..]) {
                        (&[p], &[q, r, s]) | (&[q, r, s], &[p]) => {
                            soup.push([middle(p, q), middle(p, r), middle(p, s)]);
                        }
                        (&[p, q], &[r, s]) => {
                            let quad = [middle(p, r), middle(p, s), middle(q, s), middle(q, r)];
                            soup.extend([[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]);
                        }
                        _ => {}
                    }
                }
            }
        }
    }
    Mesh::from_soup(&soup).unwrap()
}

/// Distances both ways, cut ends apart.
fn between(mesh: &Mesh, other: &Mesh, voxels: &Voxels) -> [Spread; 2] {
    let of = |from: &Mesh, to: &Mesh| {
        let to = Surface::new(to);
        let points = spread_points(from, SAMPLES);
        let uncut = points.iter().filter(|p| voxels.uncut(p));
        Spread::of(&uncut.map(|p| to.closest(p).distance_mm).collect::<Vec<f64>>())
    };
    [of(mesh, other), of(other, mesh)]
}

fn said([there, back]: &[Spread; 2]) -> String {
    let of = |s: &Spread| format!("{:.3} / {:.3} / {:.3}", s.median, s.p95, s.worst);
    format!("{} mm, back {} mm", of(there), of(back))
}

/// Voxels of slices that have the label, that are inside the surface, and both.
fn overlap(volume: &Volume, label: f32, mesh: &Mesh, slices: impl Iterator<Item = usize>) -> [u64; 3] {
    let voxels = Voxels::of(volume);
    let places: Vec<Vector3<f64>> = mesh.vertices().iter().map(|v| voxels.place(v)).collect();
    let mut counts = [0; 3];
    for k in slices {
        // Off the plane by so little that no vertex lies in it.
        let height = k as f64 + 1.234e-7;
        let mut crossings = vec![Vec::new(); volume.rows];
        for triangle in mesh.triangles() {
            let corners = triangle.map(|v| places[v as usize]);
            let ends: Vec<[f64; 2]> = (0..3)
                .map(|n| (corners[n], corners[(n + 1) % 3]))
                .filter(|(p, q)| (p.z < height) != (q.z < height))
                .map(|(p, q)| {
                    let t = (height - p.z) / (q.z - p.z);
                    [p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)]
                })
                .collect();
            let &[p, q] = &ends[..] else { continue };
            let (low, high) = (p[1].min(q[1]), p[1].max(q[1]));
            let [from, to] = [low, high].map(|v| (v.ceil().max(0.0) as usize).min(volume.rows));
            for (j, row) in crossings[from..to].iter_mut().enumerate() {
                row.push(p[0] + ((from + j) as f64 - p[1]) / (q[1] - p[1]) * (q[0] - p[0]));
            }
        }
        for (j, row) in crossings.iter_mut().enumerate() {
            row.sort_by(f64::total_cmp);
            for i in 0..volume.columns {
                let inside = row.partition_point(|x| *x <= i as f64) % 2 == 1;
                let has = volume.slice(k).unwrap()[j * volume.columns + i] == label;
                counts[0] += u64::from(has);
                counts[1] += u64::from(inside);
                counts[2] += u64::from(has && inside);
            }
        }
    }
    counts
}

fn dice([a, b, both]: [u64; 3]) -> f64 {
    2.0 * both as f64 / (a + b) as f64
}

/// Lofted; it has no faults.
fn good(name: &str, contours: &SliceContours, params: &LoftParams) -> BoneSurface {
    let surface = loft(contours, params).unwrap();
    let start = Instant::now();
    surface_of(contours, params).unwrap();
    let report = &surface.report;
    println!(
        "{name}: {} slices, {} contours, {} triangles, {:.0} ms, {} pieces, {:.0} mm^3, faults {:?}, warnings {:?}",
        report.slices,
        report.contours,
        surface.mesh.triangles().len(),
        start.elapsed().as_secs_f64() * 1e3,
        report.pieces,
        report.volume_mm3,
        report.faults,
        report.warnings
    );
    assert!(report.faults.is_empty(), "{name}: {:?}", report.faults);
    surface
}

#[test]
fn bones_of_a_real_map_of_labels() {
    let Some(folder) = knee() else { return };
    let volume = read_volume(folder.join("knee-labels.nrrd")).unwrap().volume;
    let voxels = Voxels::of(&volume);
    let params = LoftParams::default();
    for (name, label) in [("tibia", 6_u32), ("femur", 5), ("patella", 7), ("fibula", 8)] {
        let surface = good(name, &contours(&volume, label), &params);
        let half = between(&surface.mesh, &half_level(&volume, label as f32), &voxels);
        let stairs = between(&surface.mesh, &staircase(&volume, label as f32), &voxels);
        println!("  half level: {}", said(&half));
        println!("  staircase: {}", said(&stairs));
        for spread in half {
            assert!(spread.median <= 0.10 && spread.p95 <= 0.35, "{name}: {spread:?}");
        }
        if label == 6 {
            let path = folder.join("tibia_mesh.vtk");
            let other = read_mesh(path, Some(LengthUnit::Millimetres)).unwrap().model.0;
            let third = between(&surface.mesh, &other, &voxels);
            println!("  third party: {}", said(&third));
            for spread in third {
                assert!(spread.median <= 0.25 && spread.p95 <= 0.45, "{spread:?}");
            }
        }
        for (step, least) in [(2, 0.97), (4, 0.93), (6, 0.0)] {
            let thin = thinned(&volume, step);
            let surface = good(&format!("{name}, every {step}."), &contours(&thin, label), &params);
            let of_slice = |k: usize| volume.slice(k).unwrap().contains(&(label as f32));
            let kept: Vec<usize> =
                (0..volume.origins_mm.len()).step_by(step).filter(|k| of_slice(*k)).collect();
            let (first, last) = (kept[0], kept[kept.len() - 1]);
            let omitted = |from: usize, to: usize| (from..to).filter(move |k| k % step != 0);
            let inner = dice(overlap(&volume, label as f32, &surface.mesh, omitted(first, last)));
            let all =
                dice(overlap(&volume, label as f32, &surface.mesh, omitted(0, volume.origins_mm.len())));
            let half = between(&surface.mesh, &half_level(&volume, label as f32), &voxels);
            println!(
                "  omitted slices: Dice {inner:.4}, with the ends {all:.4}; half level: {}",
                said(&half)
            );
            assert!(inner >= least, "{name}, every {step}.: {inner}");
        }
    }
}
