//! What is written of a body's model for other programs: its mesh as STL, its axes as landmarks.

use std::fmt::Write;

use biplane_artifact::BodyAxes;
use biplane_geometry::Mesh;

/// What `models/README.txt` says.
pub const README: &str = include_str!("readme.txt");
/// How far from the origin the points on the axes are written, mm.
const ARM_MM: f64 = 50.0;

/// A mesh as binary STL, which has no unit and single precision; mm.
///
/// An STL file counts its triangles with 32 bits, as a mesh does its vertices.
pub fn stl(mesh: &Mesh) -> Vec<u8> {
    let count = mesh.triangles().len();
    let mut bytes = Vec::with_capacity(84 + 50 * count);
    let mut header = [b' '; 80];
    // Not the word that ascii files begin with.
    let text = b"biplane model, mm";
    header[..text.len()].copy_from_slice(text);
    bytes.extend_from_slice(&header);
    bytes.extend_from_slice(&(count as u32).to_le_bytes());
    for triangle in 0..count {
        let area = mesh.area_vector(triangle);
        let normal = area / area.norm().max(f64::MIN_POSITIVE);
        let corners = mesh.corners(triangle).map(|p| p.coords);
        for number in std::iter::once(normal).chain(corners).flat_map(|v| [v.x, v.y, v.z]) {
            bytes.extend_from_slice(&(number as f32).to_le_bytes());
        }
        bytes.extend_from_slice(&[0, 0]);
    }
    bytes
}

/// A body's axes as landmarks: its origin and a point 50 mm along each axis. As `edits/landmarks/NAME.csv` it gives the axes again.
pub fn axes_csv(axes: &BodyAxes) -> Vec<u8> {
    let mut text = "landmark,x_mm,y_mm,z_mm\n".to_owned();
    let along = |axis: &[f64; 3]| std::array::from_fn(|i| axes.origin_mm[i] + ARM_MM * axis[i]);
    let points = std::iter::once(axes.origin_mm).chain(axes.axes.iter().map(along));
    for (name, [x, y, z]) in ["origin", "x", "y", "z"].into_iter().zip(points) {
        // Writing to a text does not fail.
        let _ = writeln!(text, "{name},{x:.6},{y:.6},{z:.6}");
    }
    text.into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_acquisition::meshes::{LengthUnit, read_mesh};
    use biplane_artifact::{AxesSource, BodyKind, Side};
    use biplane_geometry::Point3;

    #[test]
    fn the_stl_is_read_back() {
        let at = [[0.0, 0.0, 0.0], [40.0, 0.0, 0.0], [0.0, 50.0, 0.0], [0.0, 0.0, 60.0]];
        let vertices = at.map(|[x, y, z]| Point3::new(x, y, z)).to_vec();
        let mesh = Mesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.stl");
        std::fs::write(&path, stl(&mesh)).unwrap();
        let back = read_mesh(&path, Some(LengthUnit::Millimetres)).unwrap().model.0;
        assert_eq!(back.triangles().len(), 4);
        assert!((back.signed_volume() - 20_000.0).abs() < 1e-6);
    }

    #[test]
    fn axes_are_written_as_landmarks() {
        let axes = BodyAxes {
            origin_mm: [1.0, 2.0, 3.0],
            axes: [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]],
            body: BodyKind::Femur,
            side: Side::Left,
            source: AxesSource::Shape,
            features: Vec::new(),
            warnings: Vec::new(),
        };
        let text = String::from_utf8(axes_csv(&axes)).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[1], "origin,1.000000,2.000000,3.000000");
        assert_eq!(lines[2], "x,1.000000,52.000000,3.000000");
        assert_eq!(lines.len(), 5);
    }
}
