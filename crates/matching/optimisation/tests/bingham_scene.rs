//! The thesis's own method on the scene of another program (`fixtures/scene`; the whole of it, with outlines of the meshes
//! themselves, is not part of the project).

// A test whose set-up fails has failed.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use biplane_artifact::{Calibration, Curves};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Curve, EdgePoint, Mesh, Point2, Point3, Pose, Vector2, Vector3};
use biplane_optimisation::{BinghamParams, BinghamView, Descent, descend};
use serde_json::Value;

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..")
}

fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    std::array::from_fn(|i| value[i].as_f64().unwrap())
}

/// A binary STL: 80 bytes, the number of triangles, then 50 bytes each.
fn mesh(path: &Path) -> Mesh {
    let bytes = std::fs::read(path).unwrap();
    let float = |b: &[u8]| f64::from(f32::from_le_bytes(b.try_into().unwrap()));
    let corner =
        |t: &[u8], k: usize| Point3::from(std::array::from_fn(|i| float(&t[12 + 12 * k + 4 * i..][..4])));
    let soup: Vec<[Point3; 3]> =
        bytes[84..].chunks_exact(50).map(|t| std::array::from_fn(|k| corner(t, k))).collect();
    Mesh::from_soup(&soup).unwrap()
}

/// A body of the scene at one of its poses, seen by both fluoroscopes.
struct Posed {
    truth: [f64; 6],
    pose: Pose,
    views: Vec<BinghamView>,
}

fn of_thesis(v: &[f64; 6]) -> Pose {
    let a = [v[3], v[4], v[5]].map(f64::to_radians);
    Pose::from_thesis(a[0], a[1], a[2], Vector3::new(v[0], v[1], v[2]), Vector3::zeros())
}

fn posed(folder: &Path, scene: &Value, body: &str, outline: &str, number: usize) -> Posed {
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
        let fluoroscope = Fluoroscope::from(&Calibration {
            view: view["name"].as_str().unwrap().to_owned(),
            size: [1024, 1024],
            source: source.into(),
            matrix: [row(&along_x), row(&along_y), n.into()],
            distortion: None,
        });
        let file = pose["silhouettes"][outline][view["name"].as_str().unwrap()].as_str().unwrap();
        let text = std::fs::read_to_string(folder.join(file)).unwrap();
        let points = text.lines().map(|line| {
            let (a, b) = line.split_once(',').unwrap();
            let mm = |t: &str| 511.5 + t.trim().parse::<f64>().unwrap() / pixel;
            EdgePoint {
                position: Point2::new(mm(a), mm(b)),
                direction: Vector2::x(),
                strength: 1.0,
                sigma_px: 0.1,
            }
        });
        let curves = Curves(vec![Curve { points: points.collect(), closed: true }]);
        BinghamView::new(fluoroscope, &curves, pixel)
    });
    Posed { truth, pose: of_thesis(&truth), views: views.collect() }
}

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
        for offset in offsets {
            let offset = numbers::<6>(offset);
            let start = of_thesis(&std::array::from_fn(|i| posed.truth[i] + offset[i]));
            let params = BinghamParams::default();
            let found = descend(mesh.vertices(), &centroid, &posed.views, &start, &params);
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
