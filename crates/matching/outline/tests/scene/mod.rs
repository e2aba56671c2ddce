//! What the tests of outlines share: a view, poses drawn at random, meshes from files and of known shape.

// Not every test uses all of it; a test whose set-up fails has failed.
#![allow(clippy::unwrap_used, dead_code)]

use std::path::{Path, PathBuf};

use biplane_artifact::Calibration;
use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Mesh, Point3, Pose, Vector3};
use biplane_outline::{Outline, RimMesh, Sampling};
use nalgebra::UnitQuaternion;
use rand::Rng;
use rand_xoshiro::Xoshiro256PlusPlus;

pub fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(3).unwrap()
}

/// A folder of the data beside the workspace, if it is there.
pub fn real(folder: &str) -> Option<PathBuf> {
    let path = workspace().parent()?.join("shared/data/real").join(folder);
    if path.is_dir() {
        return Some(path);
    }
    println!("skipped: {folder} is not there");
    None
}

/// Looks along +z from 1000 mm away, 3 px per mm at the origin.
pub fn view() -> Fluoroscope {
    Fluoroscope::from(&Calibration {
        view: "A".to_owned(),
        size: [1024, 1024],
        source: [10.0, -20.0, -1000.0],
        matrix: [[3000.0, 0.0, 511.5], [0.0, 3000.0, 511.5], [0.0, 0.0, 1.0]],
        distortion: None,
    })
}

/// A binary STL (80 bytes, the number of triangles, then 50 bytes each) whose unit is so many mm.
pub fn stl(path: &Path, mm: f64) -> Mesh {
    let bytes = std::fs::read(path).unwrap();
    let float = |b: &[u8]| f64::from(f32::from_le_bytes(b.try_into().unwrap()));
    let corner =
        |t: &[u8], k: usize| Point3::from(std::array::from_fn(|i| float(&t[12 + 12 * k + 4 * i..][..4])));
    let soup: Vec<[Point3; 3]> =
        bytes[84..].chunks_exact(50).map(|t| std::array::from_fn(|k| corner(t, k))).collect();
    Mesh::from_soup(&soup).unwrap().scaled(mm)
}

/// A pose turned anyhow, that has `centroid` within 30 mm of the laboratory's origin along each axis.
pub fn random_pose(random: &mut Xoshiro256PlusPlus, centroid: &Point3) -> Pose {
    // Shoemake 1992: even over all rotations.
    let [u, v, w]: [f64; 3] = std::array::from_fn(|_| random.random_range(0.0..1.0));
    let (v, w) = (std::f64::consts::TAU * v, std::f64::consts::TAU * w);
    let (a, b) = ((1.0 - u).sqrt(), u.sqrt());
    let turn = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(
        a * v.sin(),
        a * v.cos(),
        b * w.sin(),
        b * w.cos(),
    ));
    let place = Vector3::from_fn(|_, _| random.random_range(-30.0..30.0));
    Pose::new(turn, place - turn * centroid.coords)
}

pub fn traced(rim: &RimMesh, pose: &Pose, step_px: f64) -> Outline {
    let mut outline = Outline::new();
    outline.trace(rim, pose, &view(), Sampling { step_px });
    outline
}

/// An ellipsoid with these half axes, mm: an octahedron whose sides are cut into `parts`, blown up.
pub fn ellipsoid(axes: [f64; 3], parts: u32) -> Mesh {
    let mut soup = Vec::new();
    for octant in 0..8_u32 {
        let sign = [0, 1, 2].map(|axis| if octant >> axis & 1 == 0 { 1.0 } else { -1.0 });
        let at = |i: u32, j: u32| {
            // Even steps of the angle, not of the flat side, keep triangles of one size.
            let of = |k: u32| (std::f64::consts::FRAC_PI_2 * f64::from(k) / f64::from(parts)).sin();
            let p = Vector3::new(of(i), of(j), of(parts - i - j)).normalize();
            Point3::new(axes[0] * sign[0] * p.x, axes[1] * sign[1] * p.y, axes[2] * sign[2] * p.z)
        };
        let outward = sign[0] * sign[1] * sign[2] > 0.0;
        let mut add = |a, b, c| soup.push(if outward { [a, b, c] } else { [a, c, b] });
        for i in 0..parts {
            for j in 0..parts - i {
                add(at(i, j), at(i + 1, j), at(i, j + 1));
                if i + j + 1 < parts {
                    add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                }
            }
        }
    }
    Mesh::from_soup(&soup).unwrap()
}

/// A ring round z: half thickness `tube`, its middle `radius` from the axis, mm.
pub fn torus(radius: f64, tube: f64, sectors: u32) -> Mesh {
    let rounds = sectors / 2;
    let at = |i: u32, j: u32| {
        let (a, b) = (
            std::f64::consts::TAU * f64::from(i % sectors) / f64::from(sectors),
            std::f64::consts::TAU * f64::from(j % rounds) / f64::from(rounds),
        );
        let r = radius + tube * b.cos();
        Point3::new(r * a.cos(), r * a.sin(), tube * b.sin())
    };
    let mut soup = Vec::new();
    for i in 0..sectors {
        for j in 0..rounds {
            soup.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            soup.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    Mesh::from_soup(&soup).unwrap()
}
