//! The curved rim of an ellipsoid's mesh against the conic that the ellipsoid truly has for an outline, and how both rims move.

#![allow(clippy::unwrap_used)]

mod scene;

use biplane_geometry::{Point2, Point3, Pose, Twist, Vector2, Vector3};
use biplane_outline::{Outline, OutlinePoint, RimMesh};
use nalgebra::Matrix3;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use scene::{ellipsoid, random_pose, stl, traced, view, workspace};

const AXES: [f64; 3] = [40.0, 30.0, 22.0];

/// The conic of an ellipsoid's outline: the dual quadric seen by the fluoroscope, `C* = M (R D R' - c c') M'`, inverted.
fn conic(pose: &Pose) -> Matrix3<f64> {
    let view = view();
    let rotation = pose.rotation().to_rotation_matrix().into_inner();
    let squares = Matrix3::from_diagonal(&Vector3::from(AXES.map(|a| a * a)));
    let c = pose.translation() - view.source().coords;
    let dual = view.matrix()
        * (rotation * squares * rotation.transpose() - c * c.transpose())
        * view.matrix().transpose();
    let conic = dual.try_inverse().unwrap();
    // Positive outside.
    let centre = view.project(&Point3::from(pose.translation())).unwrap().pixel;
    let h = Vector3::new(centre.x, centre.y, 1.0);
    if h.dot(&(conic * h)) > 0.0 { -conic } else { conic }
}

/// How far outside the conic a pixel lies, px: to first order, as Sampson's distance, which is enough below 0.1 px.
fn outside(conic: &Matrix3<f64>, pixel: &Point2) -> f64 {
    let h = Vector3::new(pixel.x, pixel.y, 1.0);
    let g = conic * h;
    h.dot(&g) / (2.0 * g.xy().norm())
}

/// Over 30 poses, how far outside the truth the outline lies, px: the mean, and the root mean square.
fn bias(rim: &RimMesh) -> (f64, f64) {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
    let (mut length, mut sum, mut squares) = (0.0, 0.0, 0.0);
    for _ in 0..30 {
        let pose = random_pose(&mut random, &Point3::origin());
        let conic = conic(&pose);
        for p in traced(rim, &pose, 0.5).points() {
            let off = outside(&conic, &p.pixel);
            length += p.length_px;
            sum += p.length_px * off;
            squares += p.length_px * off * off;
        }
    }
    (sum / length, (squares / length).sqrt())
}

#[test]
fn the_curved_rim_is_free_of_the_bias_of_triangles() {
    let mut coarser: Option<[(f64, f64); 2]> = None;
    for parts in [6, 12, 24, 48] {
        let mesh = ellipsoid(AXES, parts);
        let [flat, curved] = [RimMesh::flat(&mesh), RimMesh::new(&mesh)].map(|rim| bias(&rim));
        let points = mesh.vertices().len();
        println!("{points} points: bias and rms, px: flat {flat:?}, curved {curved:?}");
        // Triangles lie inside.
        assert!(flat.0 < 0.0);
        assert!(curved.0.abs() < flat.0.abs() / 40.0 && curved.1 < flat.1 / 20.0, "{points} points");
        if let Some([flat_before, curved_before]) = coarser {
            let order = |coarse: f64, fine: f64| (coarse / fine).abs().log2();
            let (square, mean, rms) = (
                order(flat_before.0, flat.0),
                order(curved_before.0, curved.0),
                order(curved_before.1, curved.1),
            );
            println!("    orders in the edges' length: flat {square:.2}, curved {mean:.2}, its rms {rms:.2}");
            assert!((square - 2.0).abs() < 0.05, "{square}");
            assert!(mean > 3.3 && rms > 3.1, "{mean} {rms}");
        }
        coarser = Some([flat, curved]);
    }
}

/// Small motions, mm.
const H_MM: f64 = 1e-3;

/// Where a traced outline crosses the line through `at` along `normal`: how far along it, px.
fn crossing(outline: &[OutlinePoint], at: &Point2, normal: &Vector2) -> Option<f64> {
    let along = |q: &OutlinePoint| {
        let s = q.normal.dot(&(q.pixel - at)) / q.normal.dot(normal);
        // Of points whose own piece the line meets.
        let off = (at + normal * s - q.pixel).norm();
        (q.normal.dot(normal) > 0.5 && off <= 0.5 * q.length_px).then_some(s)
    };
    outline.iter().filter_map(along).min_by(|a, b| a.abs().total_cmp(&b.abs()))
}

/// What the outline does under small motions, against what points held fixed to the body do: the differences, px per mm (of a
/// point 30 mm from the centre where the body turns), ascending, and how many points could not be compared.
fn differences(rim: &RimMesh, pose: &Pose) -> (Vec<f64>, usize) {
    let (view, step) = (view(), 0.5);
    let centre = pose.transform(rim.centroid());
    let still = traced(rim, pose, step);
    let (mut found, mut missed) = (Vec::new(), 0);
    for axis in 0..6 {
        let twist = |h: f64| {
            let mut both = [Vector3::zeros(); 2];
            // A turn moves what is 30 mm from the centre by as much as a shift does.
            both[axis / 3][axis % 3] = if axis < 3 { h } else { h / 30.0 };
            Twist { translation: both[0], rotation: both[1] }
        };
        let moved: [Outline; 2] = [H_MM, -H_MM].map(|h| traced(rim, &pose.moved(&twist(h), &centre), step));
        for p in still.points() {
            let held = [H_MM, -H_MM].map(|h| {
                let fixed = pose.inverse().transform(&p.world);
                view.project(&pose.moved(&twist(h), &centre).transform(&fixed)).unwrap().pixel
            });
            let expected = p.normal.dot(&(held[0] - held[1])) / (2.0 * H_MM);
            let [ahead, behind] = [0, 1].map(|k| crossing(moved[k].points(), &p.pixel, &p.normal));
            match (ahead, behind) {
                (Some(a), Some(b)) => found.push(((a - b) / (2.0 * H_MM) - expected).abs()),
                _ => missed += 1,
            }
        }
    }
    (found, missed)
}

/// As [`differences`], of six poses.
fn of_poses(name: &str, rim: &RimMesh) -> impl Fn(f64) -> f64 + use<> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
    let (mut all, mut missed) = (Vec::new(), 0);
    for _ in 0..6 {
        let (found, lost) = differences(rim, &random_pose(&mut random, rim.centroid()));
        all.extend(found);
        missed += lost;
    }
    all.sort_unstable_by(f64::total_cmp);
    let at = move |share: f64| all[((all.len() - 1) as f64 * share) as usize];
    println!(
        "{name}: differences {:.1e}, {:.1e} at 95 %, {:.1e} at 99 %, {:.1e} at 99.9 % px/mm",
        at(0.5),
        at(0.95),
        at(0.99),
        at(0.999)
    );
    assert!(missed < 10, "{name}: {missed} points were not compared");
    at
}

/// 3 px are 1 mm here. The few that differ by more lie where the rim jumps to another edge under the small motion.
#[test]
fn the_flat_outline_moves_as_points_held_fixed_to_the_body_do() {
    let implant = stl(&workspace().join("fixtures/scene/implant_3500.stl"), 1.0);
    for (name, mesh) in [("ellipsoid", ellipsoid(AXES, 24)), ("implant", implant)] {
        let at = of_poses(name, &RimMesh::flat(&mesh));
        assert!(at(0.999) < 1e-7, "{name}: {}", at(0.999));
    }
}

/// Of the curved rim that holds up to the mesh's fineness, of second order.
#[test]
fn the_curved_outline_moves_as_points_held_fixed_to_the_body_do() {
    let [coarse, fine] = [12, 24].map(|parts| of_poses("ellipsoid", &RimMesh::new(&ellipsoid(AXES, parts))));
    assert!(fine(0.5) < 1e-4 && fine(0.95) < 8e-3, "{} {}", fine(0.5), fine(0.95));
    for share in [0.5, 0.95] {
        assert!(coarse(share) > 3.0 * fine(share), "{share}: {} {}", coarse(share), fine(share));
    }
    let implant = stl(&workspace().join("fixtures/scene/implant_3500.stl"), 1.0);
    let at = of_poses("implant", &RimMesh::new(&implant));
    assert!(at(0.5) < 4e-4 && at(0.95) < 5e-2, "{} {}", at(0.5), at(0.95));
}
