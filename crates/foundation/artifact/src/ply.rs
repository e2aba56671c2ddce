//! Triangle meshes as bytes: binary PLY 1.0, little endian, which every mesh program opens.
//!
//! Vertices are doubles, so a mesh comes back with every bit. Only what [`encode`] writes is read by [`decode`]; files of other
//! programs are read elsewhere.

use biplane_geometry::{Mesh, Point3};

/// Bytes of a vertex: three doubles.
const VERTEX: usize = 24;
/// Bytes of a face: a count and three indices.
const FACE: usize = 13;

/// Writes a mesh; `comment` is one line of the header.
pub(crate) fn encode(mesh: &Mesh, comment: &str) -> Vec<u8> {
    let (vertices, triangles) = (mesh.vertices(), mesh.triangles());
    let header = format!(
        "ply\nformat binary_little_endian 1.0\ncomment {comment}\nelement vertex {}\nproperty double x\nproperty double y\nproperty \
         double z\nelement face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        vertices.len(),
        triangles.len()
    );
    let mut bytes = Vec::with_capacity(header.len() + vertices.len() * VERTEX + triangles.len() * FACE);
    bytes.extend_from_slice(header.as_bytes());
    bytes.extend(vertices.iter().flat_map(|v| [v.x, v.y, v.z]).flat_map(f64::to_le_bytes));
    for triangle in triangles {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|v| v.to_le_bytes()));
    }
    bytes
}

/// Reads what [`encode`] wrote: the mesh and the comment.
pub(crate) fn decode(bytes: &[u8]) -> Result<(Mesh, String), String> {
    let mut rest = bytes;
    let mut line = || -> Result<&str, String> {
        let end = rest.iter().position(|&b| b == b'\n').ok_or("the header does not end")?;
        let text = std::str::from_utf8(&rest[..end]).map_err(|_| "the header is not text")?;
        rest = &rest[end + 1..];
        Ok(text)
    };
    let mut expect = |prefix: &str| -> Result<String, String> {
        let text = line()?;
        let found = text.strip_prefix(prefix);
        found.map(ToOwned::to_owned).ok_or_else(|| format!("expected `{prefix}`, found `{text}`"))
    };
    for whole in ["ply", "format binary_little_endian 1.0"] {
        expect(whole)?;
    }
    let comment = expect("comment ")?;
    let number =
        |text: String| text.parse::<usize>().map_err(|_| format!("expected a number, found `{text}`"));
    let vertices = number(expect("element vertex ")?)?;
    for axis in ["x", "y", "z"] {
        expect(&format!("property double {axis}"))?;
    }
    let faces = number(expect("element face ")?)?;
    for whole in ["property list uchar uint vertex_indices", "end_header"] {
        expect(whole)?;
    }
    let split =
        vertices.checked_mul(VERTEX).filter(|n| *n <= rest.len()).ok_or("cut short in its vertices")?;
    let (places, corners) = rest.split_at(split);
    if faces.checked_mul(FACE) != Some(corners.len()) {
        return Err(format!("{} bytes where {faces} faces should be", corners.len()));
    }
    let double = |b: &[u8]| b.try_into().map(f64::from_le_bytes).unwrap_or(f64::NAN);
    let index = |b: &[u8]| b.try_into().map(u32::from_le_bytes).unwrap_or(u32::MAX);
    let places = places.chunks_exact(VERTEX);
    let vertices =
        places.map(|p| Point3::new(double(&p[..8]), double(&p[8..16]), double(&p[16..]))).collect();
    let corners = corners.chunks_exact(FACE);
    let triangles: Vec<[u32; 3]> =
        corners.map(|f| [index(&f[1..5]), index(&f[5..9]), index(&f[9..])]).collect();
    let count = triangles.len();
    let mesh = Mesh::new(vertices, triangles).map_err(|e| e.to_string())?;
    if mesh.triangles().len() != count {
        return Err("it has triangles without an area".to_owned());
    }
    Ok((mesh, comment))
}
