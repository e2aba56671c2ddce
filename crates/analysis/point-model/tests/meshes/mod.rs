//! Meshes from binary STL files, for measurements: a reader of the plain form alone.

use std::path::Path;

use biplane_geometry::{Mesh, Point3};

/// A file of the project's parent folder, its coordinates multiplied; a message and none where it is absent.
pub fn stl(path: &str, factor: f64) -> Option<Mesh> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..").join(path);
    let Ok(bytes) = std::fs::read(&file) else {
        println!("skipped: {path} is not there");
        return None;
    };
    let number = |b: &[u8]| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])) * factor;
    let corner = |b: &[u8]| Point3::new(number(b), number(&b[4..]), number(&b[8..]));
    let soup: Vec<[Point3; 3]> = bytes[84..]
        .chunks_exact(50)
        .map(|t| [corner(&t[12..]), corner(&t[24..]), corner(&t[36..])])
        .collect();
    Mesh::from_soup(&soup).ok()
}
