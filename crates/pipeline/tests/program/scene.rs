//! A tiny study made on the spot: a dark box before two fluoroscopes at right angles, three frames of 512 x 512.
//!
//! The pictures are drawn from the box's projected corners alone (the shadow of a convex body is the hull of its
//! corners), with an edge as a logistic step of about a pixel; nothing of the program has a part in them.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, SystemTime};

use nalgebra::{Matrix3, Point2, Point3, UnitQuaternion, Vector3};

/// Columns and rows.
pub const SIZE: u32 = 512;
/// px.
const FOCAL: f64 = 4000.0;
/// Of the source from the laboratory's origin, mm.
const DISTANCE: f64 = 1000.0;
/// Of the box, mm.
const SIDES: [f64; 3] = [52.0, 34.0, 22.0];

/// A study in a folder of its own.
pub struct Scene {
    folder: tempfile::TempDir,
}

/// World to camera: along z, and along x.
fn cameras() -> [Matrix3<f64>; 2] {
    [Matrix3::identity(), Matrix3::new(0.0, 0.0, -1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0)]
}

fn corners() -> Vec<Point3<f64>> {
    let half = |i: usize, axis: usize| SIDES[axis] * if i >> axis & 1 == 1 { 0.5 } else { -0.5 };
    (0..8).map(|i| Point3::new(half(i, 0), half(i, 1), half(i, 2))).collect()
}

/// Pose of the box in a frame.
pub fn truth(frame: usize) -> (UnitQuaternion<f64>, Vector3<f64>) {
    let f = frame as f64;
    (UnitQuaternion::from_euler_angles(0.5 + 0.1 * f, 0.4 - 0.05 * f, 0.3), Vector3::new(f, 2.0 - f, 1.0))
}

/// A row of a table of poses, `off` mm from the truth along each axis.
pub fn row(frame: usize, off: f64) -> String {
    let (q, t) = truth(frame);
    let t = t.add_scalar(off);
    format!("squat,{frame},box,{},{},{},{},{},{},{}\n", t.x, t.y, t.z, q.w, q.i, q.j, q.k)
}

pub const HEADER: &str = "trial,frame,body,tx_mm,ty_mm,tz_mm,qw,qx,qy,qz\n";

fn hull(mut points: Vec<Point2<f64>>) -> Vec<Point2<f64>> {
    points.sort_by(|a, b| (a.x, a.y).partial_cmp(&(b.x, b.y)).unwrap());
    let cross = |o: &Point2<f64>, a: &Point2<f64>, b: &Point2<f64>| (a - o).perp(&(b - o));
    let half = |points: &mut dyn Iterator<Item = Point2<f64>>| {
        let mut chain: Vec<Point2<f64>> = Vec::new();
        for p in points {
            while chain.len() > 1 && cross(&chain[chain.len() - 2], &chain[chain.len() - 1], &p) <= 0.0 {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut all = half(&mut points.iter().copied());
    all.extend(half(&mut points.iter().rev().copied()));
    all
}

fn picture(camera: &Matrix3<f64>, frame: usize) -> image::GrayImage {
    let (q, t) = truth(frame);
    let project = |p: &Point3<f64>| {
        let c = camera * (q * p.coords + t) + Vector3::new(0.0, 0.0, DISTANCE);
        Point2::new(c.x / c.z, c.y / c.z) * FOCAL + nalgebra::Vector2::repeat((f64::from(SIZE) - 1.0) / 2.0)
    };
    let hull = hull(corners().iter().map(project).collect());
    image::GrayImage::from_fn(SIZE, SIZE, |x, y| {
        let p = Point2::new(f64::from(x), f64::from(y));
        // Signed distance to the hull's nearest side, positive inside.
        let sides = hull.iter().zip(hull.iter().cycle().skip(1));
        let inside = sides.map(|(a, b)| (b - a).normalize().perp(&(p - a))).fold(f64::MAX, f64::min);
        image::Luma([(210.0 - 150.0 / (1.0 + (-inside / 0.6).exp())).round() as u8])
    })
}

fn mayacam(camera: &Matrix3<f64>, size: u32) -> String {
    let c = (f64::from(SIZE) - 1.0) / 2.0;
    let rows: Vec<String> =
        (0..3).map(|i| format!("{},{},{}", camera[(i, 0)], camera[(i, 1)], camera[(i, 2)])).collect();
    format!(
        "image size\n{size},{size}\n\ncamera matrix\n{FOCAL},0,{c}\n0,{FOCAL},{c}\n0,0,1\n\nrotation\n{}\n\ntranslation\n0\n0\n{DISTANCE}\n",
        rows.join("\n")
    )
}

fn stl() -> String {
    let corners = corners();
    let mut text = "solid box\n".to_owned();
    for q in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
        for t in [[q[0], q[1], q[2]], [q[0], q[2], q[3]]] {
            text += "facet normal 0 0 0\nouter loop\n";
            for i in t {
                text += &format!("vertex {} {} {}\n", corners[i].x, corners[i].y, corners[i].z);
            }
            text += "endloop\nendfacet\n";
        }
    }
    text + "endsolid box\n"
}

pub const PIPELINE: &str = r#"[study]
name = "box"

[fluoroscope.A]
calibration = "A.txt"

[fluoroscope.B]
calibration = "B.txt"

[[body]]
name = "box"
mesh = "box.stl"

[[trial]]
name = "squat"
frames = { A = "frames/A", B = "frames/B" }
frame_rate_hz = 10.0
starts = "starts.csv"

[match]
search_px = 20.0
"#;

impl Scene {
    /// Three good frames, started 1 mm off along each axis; the second frame has no start of its own.
    pub fn new() -> Self {
        let scene = Self { folder: tempfile::tempdir().unwrap() };
        for (view, camera) in ["A", "B"].iter().zip(cameras()) {
            scene.write(&format!("{view}.txt"), mayacam(&camera, SIZE).as_bytes());
            for frame in 0..3 {
                let mut png = std::io::Cursor::new(Vec::new());
                picture(&camera, frame).write_to(&mut png, image::ImageFormat::Png).unwrap();
                scene.write(&format!("frames/{view}/{frame:04}.png"), png.get_ref());
            }
        }
        scene.write("box.stl", stl().as_bytes());
        scene.write("starts.csv", format!("{HEADER}{}{}", row(0, 1.0), row(2, 1.0)).as_bytes());
        scene.write("pipeline.toml", PIPELINE.as_bytes());
        scene
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file as if it had been there for a minute.
    pub fn write(&self, name: &str, bytes: &[u8]) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, bytes).unwrap();
        let file = std::fs::File::options().write(true).open(&path).unwrap();
        file.set_modified(SystemTime::now() - Duration::from_secs(60)).unwrap();
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    /// `pipeline.toml` with a text replaced.
    pub fn edit(&self, from: &str, to: &str) {
        let text = self.read("pipeline.toml");
        assert!(text.contains(from), "{from}");
        self.write("pipeline.toml", text.replacen(from, to, 1).as_bytes());
    }

    /// Runs the program in the study's folder: exit code, stdout, stderr.
    pub fn biplane(&self, arguments: &[&str]) -> (i32, String, String) {
        run(self.folder.path(), arguments)
    }
}

pub fn run(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let Output { status, stdout, stderr } =
        Command::new(env!("CARGO_BIN_EXE_biplane")).args(arguments).current_dir(folder).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (status.code().unwrap(), text(stdout), text(stderr))
}
