//! How long meshes take to read and mend on one core: `cargo bench -p biplane-acquisition --bench meshes`.
//!
//! A bumpy ball of 73,008 triangles in every format, against the limit of 60 ms; the same of files named behind `--`.

use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

use biplane_acquisition::meshes::{LengthUnit, read_mesh};
use biplane_geometry::{Mesh, Point3};

/// For 73,119 triangles, ms.
const LIMIT_MS: f64 = 60.0;

/// The least time of many, ms.
fn least<T>(rounds: usize, mut of: impl FnMut() -> T) -> f64 {
    let once = |_| {
        let start = Instant::now();
        std::hint::black_box(of());
        start.elapsed().as_secs_f64() * 1e3
    };
    (0..rounds).map(once).fold(f64::INFINITY, f64::min)
}

/// A ball of 6 n^2 quads, each two triangles, and bumps so that no two places are alike; mm.
fn ball(n: u32) -> Mesh {
    let corner = |face: u32, i: u32, j: u32| {
        let [a, b] = [i, j].map(|k| (f64::from(k) / f64::from(n) * 2.0 - 1.0) * 1.0);
        let p = match face {
            0 => [a, b, 1.0],
            1 => [b, a, -1.0],
            2 => [1.0, a, b],
            3 => [-1.0, b, a],
            4 => [b, 1.0, a],
            _ => [a, -1.0, b],
        };
        let p = Point3::from(p);
        let bump = 1.0 + 0.1 * (3.0 * p.x + 2.0 * p.y).sin() * (4.0 * p.z).cos();
        // As single precision keeps it.
        Point3::from((p.coords.normalize() * 40.0 * bump).map(|c| f64::from(c as f32)))
    };
    let mut soup = Vec::new();
    for face in 0..6 {
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let [p, q, r, s] =
                [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| corner(face, i, j));
            soup.extend([[p, q, r], [p, r, s]]);
        }
    }
    Mesh::from_soup(&soup).unwrap_or_else(|e| unreachable!("{e}"))
}

fn binary_stl(mesh: &Mesh) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend((mesh.triangles().len() as u32).to_le_bytes());
    for t in 0..mesh.triangles().len() {
        bytes.extend([0; 12]);
        bytes.extend(
            mesh.corners(t).iter().flat_map(|c| [c.x, c.y, c.z]).flat_map(|c| (c as f32).to_le_bytes()),
        );
        bytes.extend([0; 2]);
    }
    bytes
}

fn ascii_stl(mesh: &Mesh) -> Vec<u8> {
    let mut text = "solid ball\n".to_owned();
    for t in 0..mesh.triangles().len() {
        text += "facet normal 0 0 0\nouter loop\n";
        for c in mesh.corners(t) {
            let _ = writeln!(text, "vertex {} {} {}", c.x as f32, c.y as f32, c.z as f32);
        }
        text += "endloop\nendfacet\n";
    }
    (text + "endsolid ball\n").into_bytes()
}

fn binary_ply(mesh: &Mesh) -> Vec<u8> {
    let (vertices, triangles) = (mesh.vertices(), mesh.triangles());
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        vertices.len(),
        triangles.len()
    )
    .into_bytes();
    bytes.extend(vertices.iter().flat_map(|v| [v.x, v.y, v.z]).flat_map(|c| (c as f32).to_le_bytes()));
    for t in triangles {
        bytes.push(3);
        bytes.extend(t.iter().flat_map(|v| v.to_le_bytes()));
    }
    bytes
}

fn lines(mesh: &Mesh, head: String, vertex: &str, face: &str, first: u32) -> Vec<u8> {
    let mut text = head;
    for v in mesh.vertices() {
        let _ = writeln!(text, "{vertex}{} {} {}", v.x as f32, v.y as f32, v.z as f32);
    }
    for [a, b, c] in mesh.triangles().iter().map(|t| t.map(|v| v + first)) {
        let _ = writeln!(text, "{face}{a} {b} {c}");
    }
    text.into_bytes()
}

fn main() {
    let mesh = ball(78);
    let (vertices, triangles) = (mesh.vertices().len(), mesh.triangles().len());
    println!("ball of {triangles} triangles, {vertices} vertices; limit {LIMIT_MS} ms");
    let soup: Vec<[Point3; 3]> = (0..triangles).map(|t| mesh.corners(t)).collect();
    let peer = least(10, || Mesh::from_soup(&soup).map(|m| m.topology()));
    println!(
        "{peer:8.2} ms  {:4.2} of it  peer: welding and edges by the standard library's HashMap, without reading",
        peer / LIMIT_MS
    );
    let Ok(folder) = tempfile::tempdir() else { return };
    let off = format!("OFF\n{vertices} {triangles} 0\n");
    let vtk = format!("# vtk DataFile Version 3.0\nball\nASCII\nDATASET POLYDATA\nPOINTS {vertices} float\n");
    let mut vtk = lines(&mesh, vtk, "", "3 ", 0);
    let polygons = format!("POLYGONS {triangles} {}\n", 4 * triangles);
    let split = line_start(&vtk, 5 + vertices);
    vtk.splice(split..split, polygons.bytes());
    let files = [
        ("binary.stl", binary_stl(&mesh)),
        ("ascii.stl", ascii_stl(&mesh)),
        ("binary.ply", binary_ply(&mesh)),
        ("ball.obj", lines(&mesh, String::new(), "v ", "f ", 1)),
        ("ball.off", lines(&mesh, off, "", "3 ", 0)),
        ("ascii.vtk", vtk),
    ];
    for (name, bytes) in files {
        let path = folder.path().join(name);
        if std::fs::write(&path, &bytes).is_ok() {
            time(&path, bytes.len());
        }
    }
    for path in std::env::args().skip(1).filter(|a| !a.starts_with("--")) {
        let bytes = std::fs::metadata(&path).map_or(0, |m| m.len() as usize);
        time(Path::new(&path), bytes);
    }
}

/// Where line `number` (counted from 0) begins.
fn line_start(text: &[u8], number: usize) -> usize {
    let mut ends = text.iter().enumerate().filter(|(_, b)| **b == b'\n').map(|(i, _)| i + 1);
    if number == 0 { 0 } else { ends.nth(number - 1).unwrap_or(text.len()) }
}

fn time(path: &Path, bytes: usize) {
    let read = || LengthUnit::ALL.iter().find_map(|unit| read_mesh(path, Some(*unit)).ok());
    let Some(file) = read() else {
        println!("          {} cannot be read", path.display());
        return;
    };
    let ms = least(10, || read_mesh(path, Some(file.unit)));
    let name = path.file_name().map(|n| n.to_string_lossy()).unwrap_or_default();
    println!(
        "{ms:8.2} ms  {:4.2} of it  {name}, {} triangles, {:.1} MB, {}",
        ms / LIMIT_MS,
        file.triangles_in_file,
        bytes as f64 / 1e6,
        file.format.name()
    );
}
