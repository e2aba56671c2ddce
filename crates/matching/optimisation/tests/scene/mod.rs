//! The scene of another program (`fixtures/scene`): two bodies, four poses, two views, exact outlines.

// Not every test uses all of it; a test whose set-up fails has failed.
#![allow(clippy::unwrap_used, dead_code)]

use std::path::{Path, PathBuf};

use biplane_artifact::{Calibration, Curves};
use biplane_geometry::{Curve, EdgePoint, Mesh, Point2, Point3, Pose, Vector2, Vector3};
use serde_json::Value;

pub fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..")
}

pub fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    std::array::from_fn(|i| value[i].as_f64().unwrap())
}

/// A binary STL: 80 bytes, the number of triangles, then 50 bytes each.
pub fn mesh(path: &Path) -> Mesh {
    let bytes = std::fs::read(path).unwrap();
    let float = |b: &[u8]| f64::from(f32::from_le_bytes(b.try_into().unwrap()));
    let corner =
        |t: &[u8], k: usize| Point3::from(std::array::from_fn(|i| float(&t[12 + 12 * k + 4 * i..][..4])));
    let soup: Vec<[Point3; 3]> =
        bytes[84..].chunks_exact(50).map(|t| std::array::from_fn(|k| corner(t, k))).collect();
    Mesh::from_soup(&soup).unwrap()
}

/// A body of the scene at one of its poses, seen by both fluoroscopes.
pub struct Posed {
    pub truth: [f64; 6],
    pub pose: Pose,
    /// Its outline, and the size of a pixel on the detector, mm.
    pub views: Vec<(Calibration, Curves, f64)>,
}

pub fn of_thesis(v: &[f64; 6]) -> Pose {
    let a = [v[3], v[4], v[5]].map(f64::to_radians);
    Pose::from_thesis(a[0], a[1], a[2], Vector3::new(v[0], v[1], v[2]), Vector3::zeros())
}

pub fn posed(folder: &Path, scene: &Value, body: &str, outline: &str, number: usize) -> Posed {
    let pose = &scene["objects"][body]["poses"][number];
    let ([x, y, z], [a, b, c]) = (numbers(&pose["t"]), numbers(&pose["euler"]));
    let truth = [x, y, z, a, b, c];
    let views = scene["views"].as_array().unwrap().iter().map(|view| {
        let v = |key: &str| Vector3::from(numbers::<3>(&view[key]));
        let (source, centre, along_x, along_y, n) = (v("source"), v("centre"), v("u"), v("v"), v("n"));
        let (l, pixel) = (view["l"].as_f64().unwrap(), view["pixel"].as_f64().unwrap());
        // Pixel 511.5 + (p - centre) . axis / pixel of the point p where the ray meets the detector.
        let row = |axis: &Vector3| -> [f64; 3] {
            let middle = 511.5 - (centre - source).dot(axis) / pixel;
            (axis * (l / pixel) + n * middle).into()
        };
        let calibration = Calibration {
            view: view["name"].as_str().unwrap().to_owned(),
            size: [1024, 1024],
            source: source.into(),
            matrix: [row(&along_x), row(&along_y), n.into()],
            distortion: None,
        };
        let file = pose["silhouettes"][outline][view["name"].as_str().unwrap()].as_str().unwrap();
        let text = std::fs::read_to_string(folder.join(file)).unwrap();
        let corner = |line: &str| {
            let (a, b) = line.split_once(',').unwrap();
            let px = |t: &str| 511.5 + t.trim().parse::<f64>().unwrap() / pixel;
            Point2::new(px(a), px(b))
        };
        (calibration, Curves(vec![outline_of(&text.lines().map(corner).collect::<Vec<_>>())]), pixel)
    });
    Posed { truth, pose: of_thesis(&truth), views: views.collect() }
}

/// A closed contour of these corners, at most a pixel from point to point, directions outward.
fn outline_of(corners: &[Point2]) -> Curve {
    let sides = || corners.iter().zip(corners.iter().cycle().skip(1));
    let turn: f64 = sides().map(|(a, b)| a.coords.perp(&b.coords)).sum();
    let points = sides().flat_map(|(a, b)| {
        let along = b - a;
        let parts = along.norm().ceil().max(1.0);
        (0..parts as usize).map(move |k| EdgePoint {
            position: a + along * (k as f64 / parts),
            direction: Vector2::new(along.y, -along.x).normalize() * turn.signum(),
            strength: 1.0,
            sigma_px: 0.1,
        })
    });
    Curve { points: points.collect(), closed: true }
}
