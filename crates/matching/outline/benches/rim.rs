//! How long the rim takes: `cargo bench -p biplane-outline`. A ball of 15,000 points seen from 1 m, and loops over the same arrays that
//! do nothing but read them.

use std::time::Instant;

use biplane_artifact::Calibration;
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Mesh, Point3, Pose, Vector3};
use biplane_outline::{Outline, RimMesh, Sampling};

/// The least time of many, s.
fn least<T>(rounds: usize, mut of: impl FnMut() -> T) -> f64 {
    let once = |_| {
        let start = Instant::now();
        std::hint::black_box(of());
        start.elapsed().as_secs_f64()
    };
    (0..rounds).map(once).fold(f64::INFINITY, f64::min)
}

/// A ball of radius 40 mm with `n` rings and `2 n` sectors, its triangles in bands round it.
fn ball(n: usize) -> Option<Mesh> {
    let point = |i: usize, j: usize| {
        let turn = |k: usize| std::f64::consts::PI * k as f64 / n as f64;
        let (a, b) = (turn(i), turn(j % (2 * n)));
        if i == 0 || i == n {
            return Point3::new(0.0, 0.0, if i == 0 { 40.0 } else { -40.0 });
        }
        Point3::new(40.0 * a.sin() * b.cos(), 40.0 * a.sin() * b.sin(), 40.0 * a.cos())
    };
    let cell = |i: usize, j: usize| {
        let (p, q, r, s) = (point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1));
        [[p, q, r], [p, r, s]]
    };
    let soup: Vec<[Point3; 3]> = (0..n).flat_map(|i| (0..2 * n).flat_map(move |j| cell(i, j))).collect();
    Mesh::from_soup(&soup).ok()
}

fn main() {
    let Some(mesh) = ball(87) else { return };
    println!("{} points, {} triangles", mesh.vertices().len(), mesh.triangles().len());
    let view = Fluoroscope::from(&Calibration {
        view: "A".to_owned(),
        size: [1000, 1000],
        source: [0.0, 0.0, -1000.0],
        matrix: [[4000.0, 0.0, 500.0], [0.0, 4000.0, 500.0], [0.0, 0.0, 1.0]],
        distortion: None,
    });
    println!("{:9.1} us  adjacency and planes", 1e6 * least(20, || RimMesh::new(&mesh)));
    let rim = RimMesh::new(&mesh);
    let mut outline = Outline::new();
    let poses: Vec<Pose> = (0..50)
        .map(|k| {
            let turn =
                nalgebra::UnitQuaternion::from_euler_angles(0.1 * f64::from(k), 0.7, 0.05 * f64::from(k));
            Pose::new(turn, Vector3::new(f64::from(k), 5.0, 2.0))
        })
        .collect();
    let per = 1e6 / poses.len() as f64;
    let time = per
        * least(40, || {
            let mut points = 0;
            for pose in &poses {
                outline.trace(&rim, pose, &view, Sampling { step_px: 1000.0 });
                points += outline.points().len();
            }
            points
        });
    // What must be read at least: four numbers a face, two faces an edge.
    let planes: Vec<f64> = (0..mesh.triangles().len() * 4).map(|k| k as f64).collect();
    let sides: Vec<u32> = (0..mesh.triangles().len() as u32 * 3).collect();
    let streamed = per
        * least(40, || {
            poses
                .iter()
                .map(|_| {
                    let planes = std::hint::black_box(&planes);
                    let sides = std::hint::black_box(&sides);
                    let faces: f64 = planes
                        .as_chunks::<4>()
                        .0
                        .iter()
                        .fold([0.0; 4], |s, p| [0, 1, 2, 3].map(|k| s[k] + p[k]))[0];
                    faces + f64::from(sides.iter().fold(0_u32, |s, v| s ^ v))
                })
                .sum::<f64>()
        });
    println!(
        "{time:9.1} us  outline; {streamed:.1} us a loop that reads the faces and edges, {:.1} times as long",
        time / streamed
    );
}
