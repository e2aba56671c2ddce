//! Area and length of the flat rim's outline against those of the shadow of all triangles, scanned line by line.
//!
//! The scan knows nothing of rims: along each line of the picture the stretches under every single triangle are united. Area is the sum
//! of the united stretches; length follows from the number of their ends by Crofton's formula, `L = 1/2 integral n(theta, p) dp dtheta`.

#![allow(clippy::unwrap_used)]

mod scene;

use biplane_geometry::{Mesh, Point2, Pose};
use biplane_outline::RimMesh;
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use scene::{random_pose, real, stl, traced, view, workspace};

/// Directions of the lines.
const DIRECTIONS: u32 = 8;
/// Distance of the lines, px.
const APART: f64 = 0.5;
/// Where a shadow is so thin or ragged that this is too coarse, both outlines are looked at that many times as finely.
const FINER: f64 = 5.0;
/// A part of the rim is outline or not as a whole, and this long at most, px: what is half covered is the error of area and length.
const STEP_PX: f64 = 0.02;
/// Stretches nearer than this are one: triangles that share an edge meet up to rounding, px.
const ROUNDING: f64 = 1e-7;

/// Area (px^2) and length (px) of the outline of what the triangles cover.
fn scanned(mesh: &Mesh, pose: &Pose, apart: f64, random: &mut Xoshiro256PlusPlus) -> (f64, f64) {
    let view = view();
    let pixels: Vec<Point2> =
        mesh.vertices().iter().map(|v| view.project(&pose.transform(v)).unwrap().pixel).collect();
    let first: f64 = random.random_range(0.0..1.0);
    let (mut area, mut ends) = (0.0, 0_usize);
    for direction in 0..DIRECTIONS {
        let (sin, cos) =
            ((f64::from(direction) + first) * std::f64::consts::PI / f64::from(DIRECTIONS)).sin_cos();
        let turned: Vec<Point2> =
            pixels.iter().map(|p| Point2::new(cos * p.x + sin * p.y, cos * p.y - sin * p.x)).collect();
        let low =
            turned.iter().fold(f64::INFINITY, |l, p| l.min(p.y)) - apart * random.random_range(0.0..1.0);
        let mut stretches: Vec<Vec<[f64; 2]>> = Vec::new();
        for t in mesh.triangles() {
            let corners = t.map(|v| turned[v as usize]);
            let rows = corners.map(|p| (p.y - low) / apart);
            let from = rows.iter().fold(f64::INFINITY, |a, b| a.min(*b)).ceil() as usize;
            let to = rows.iter().fold(0.0_f64, |a, b| a.max(*b)).floor() as usize;
            for row in from..=to {
                let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
                let r = row as f64;
                for k in 0..3 {
                    let l = (k + 1) % 3;
                    if (rows[k] <= r) != (rows[l] <= r) {
                        // From the same end for both triangles of an edge.
                        let (a, b) = if rows[k] < rows[l] { (k, l) } else { (l, k) };
                        let s = (r - rows[a]) / (rows[b] - rows[a]);
                        let x = corners[a].x + s * (corners[b].x - corners[a].x);
                        (left, right) = (left.min(x), right.max(x));
                    }
                }
                if left <= right {
                    if stretches.len() <= row {
                        stretches.resize(row + 1, Vec::new());
                    }
                    stretches[row].push([left, right]);
                }
            }
        }
        for row in &mut stretches {
            row.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
            let mut reached = f64::NEG_INFINITY;
            for [left, right] in row {
                if *left > reached + ROUNDING {
                    ends += 2;
                    reached = *left;
                }
                area += (*right - reached).max(0.0) * apart;
                reached = reached.max(*right);
            }
        }
    }
    let per = f64::from(DIRECTIONS);
    (area / per, ends as f64 * apart * std::f64::consts::PI / (2.0 * per))
}

/// Relative errors of the outline's area and length at a pose.
fn errors(
    mesh: &Mesh,
    rim: &RimMesh,
    pose: &Pose,
    finer: f64,
    random: &mut Xoshiro256PlusPlus,
) -> (f64, f64) {
    let outline = traced(rim, pose, STEP_PX / finer);
    let middle = view().project(&pose.transform(rim.centroid())).unwrap().pixel;
    let area: f64 =
        outline.points().iter().map(|p| p.normal.dot(&(p.pixel - middle)) * p.length_px / 2.0).sum();
    let (scanned_area, length) = scanned(mesh, pose, APART / finer, random);
    ((area / scanned_area - 1.0).abs(), (outline.length_px() / length - 1.0).abs())
}

/// Greatest errors that are allowed, of area and of length: what sampling and scanning leave.
const RIGHT: (f64, f64) = (1e-3, 1e-2);

fn right(errors: (f64, f64)) -> bool {
    errors.0 < RIGHT.0 && errors.1 < RIGHT.1
}

fn check(name: &str, mesh: &Mesh, poses: usize) {
    let rim = RimMesh::flat(mesh);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(7);
    let (mut worst, mut again) = ((0.0_f64, 0.0_f64), 0);
    for _ in 0..poses {
        let pose = random_pose(&mut random, &mesh.area_centroid());
        let mut found = errors(mesh, &rim, &pose, 1.0, &mut random);
        if !right(found) {
            again += 1;
            found = errors(mesh, &rim, &pose, FINER, &mut random);
        }
        assert!(right(found), "{name}: {:.2e}, {:.2e} at {pose:?}", found.0, found.1);
        worst = (worst.0.max(found.0), worst.1.max(found.1));
    }
    println!(
        "{name}: {poses} poses, {again} looked at finely; area within {:.2e}, length within {:.2e}",
        worst.0, worst.1
    );
}

#[test]
fn area_and_length_are_those_of_the_shadow() {
    for name in ["implant_3500", "bone_3500"] {
        check(name, &stl(&workspace().join(format!("fixtures/scene/{name}.stl")), 1.0), 30);
    }
}

/// Folder, file and unit (mm) of the real implants.
const IMPLANTS: [(&str, &str, f64); 5] = [
    ("implant-meshes", "femoral-component-decimated.stl", 1000.0),
    ("implant-meshes", "tibial-insert-decimated.stl", 1000.0),
    ("implant-meshes", "tibial-tray-decimated.stl", 1000.0),
    ("knee-implant-biplane", "femur0.stl", 1.0),
    ("knee-implant-biplane", "tibia0.stl", 1.0),
];

fn check_implants(poses: usize) {
    for (folder, file, mm) in IMPLANTS {
        if let Some(folder) = real(folder) {
            check(file, &stl(&folder.join(file), mm), poses);
        }
    }
}

#[test]
fn so_they_are_of_real_implants() {
    check_implants(3);
}

#[test]
#[ignore = "takes minutes: cargo test -p biplane-outline --test silhouette -- --ignored --nocapture"]
fn so_they_are_of_real_implants_at_a_thousand_poses() {
    check_implants(200);
}
