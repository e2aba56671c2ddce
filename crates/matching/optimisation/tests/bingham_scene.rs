//! The thesis's own method on scenes made elsewhere.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use biplane_artifact::{Calibration, Curves};
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Curve, EdgePoint, Mesh, Point2, Point3, Pose, Vector2, Vector3};
use biplane_optimisation::{BinghamParams, BinghamView, Descent, descend};
use serde_json::Value;

/// `scene.json` and the files beside it, if they are there.
fn folder() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data/simulated/scene");
    let there = folder.join("scene.json").exists();
    if !there {
        println!("skipped: {} is not there", folder.display());
    }
    there.then_some(folder)
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

struct Single {
    found: Descent,
    mm: f64,
    deg: f64,
}

fn singles(
    folder: &Path,
    body: &str,
    points: &str,
    outline: &str,
    set: &str,
    params: &BinghamParams,
) -> Vec<Single> {
    let scene: Value = serde_json::from_slice(&std::fs::read(folder.join("scene.json")).unwrap()).unwrap();
    let mesh = mesh(&folder.join(format!("{body}_{points}.stl")));
    let centroid = mesh.area_centroid();
    let mut all = Vec::new();
    for number in 0..4 {
        let posed = posed(folder, &scene, body, outline, number);
        for offset in scene["start_offsets"][set].as_array().unwrap() {
            let offset = numbers::<6>(offset);
            let start = of_thesis(&std::array::from_fn(|i| posed.truth[i] + offset[i]));
            let found = descend(mesh.vertices(), &centroid, &posed.views, &start, params);
            let error = found.pose.error_against(&posed.pose, &centroid);
            all.push(Single { found, mm: error.translation_mm, deg: error.rotation_rad.to_degrees() });
        }
    }
    all
}

fn median(mut v: Vec<f64>) -> f64 {
    v.sort_by(f64::total_cmp);
    v.get(v.len() / 2).copied().unwrap_or(f64::NAN)
}

#[test]
#[ignore]
fn measure() {
    let Some(folder) = folder() else { return };
    let params = BinghamParams::default();
    let set = std::env::var("SET").unwrap_or("A_truncated_gauss_sigma10_clip20".to_owned());
    for body in ["bone", "implant"] {
        let clock = std::time::Instant::now();
        let all = singles(&folder, body, "15000", "15000", &set, &params);
        let ms = clock.elapsed().as_secs_f64() * 1e3;
        let calls: usize = all.iter().map(|s| s.found.calls).sum();
        let ok: Vec<&Single> = all.iter().filter(|s| s.mm < 1.0 && s.deg < 1.0).collect();
        let conv = all.iter().filter(|s| s.found.converged).count();
        let okc = ok.iter().filter(|s| s.found.converged).count();
        println!(
            "{body}: right {} of {}, converged {conv} (right {okc}), median of right {:.4} mm {:.4} deg, calls {:.0}, {:.3} ms a call",
            ok.len(),
            all.len(),
            median(ok.iter().map(|s| s.mm).collect()),
            median(ok.iter().map(|s| s.deg).collect()),
            calls as f64 / all.len() as f64,
            ms / calls as f64
        );
        if std::env::var("V").is_ok() {
            for s in &all {
                println!(
                    "   {:.3} mm {:.3} deg, obj {:.4}, {} calls {}",
                    s.mm, s.deg, s.found.objective, s.found.calls, s.found.converged
                );
            }
        }
    }
}
