//! Tells the formats of meshes apart by what a file holds, and names those that are not read.

use std::path::Path;

use super::soup::Soup;
use super::{MeshFileError, obj, off, ply, stl, vtk, vtp};

/// How a mesh file is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeshFormat {
    /// STL as text.
    StlAscii,
    /// STL, 50 bytes a triangle.
    StlBinary,
    /// PLY as text.
    PlyAscii,
    /// PLY, least significant byte first.
    PlyLittleEndian,
    /// PLY, most significant byte first.
    PlyBigEndian,
    /// Wavefront OBJ.
    Obj,
    /// Object File Format, as text.
    Off,
    /// Legacy VTK as text.
    VtkAscii,
    /// Legacy VTK, most significant byte first.
    VtkBinary,
    /// VTK's XML of polygons.
    Vtp,
}

impl MeshFormat {
    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::StlAscii => "ascii STL",
            Self::StlBinary => "binary STL",
            Self::PlyAscii => "ascii PLY",
            Self::PlyLittleEndian => "binary PLY (little endian)",
            Self::PlyBigEndian => "binary PLY (big endian)",
            Self::Obj => "OBJ",
            Self::Off => "OFF",
            Self::VtkAscii => "ascii VTK (legacy)",
            Self::VtkBinary => "binary VTK (legacy)",
            Self::Vtp => "VTK XML (.vtp)",
        }
    }
}

/// Whether a file that starts like this and has this length may be a mesh.
pub(crate) fn is_mesh(start: &[u8], length: u64) -> bool {
    ply::starts(start)
        || vtk::starts(start)
        || vtp::starts(start)
        || off::starts(start)
        || stl::is_stl(start, length)
        || obj::starts(start)
}

/// Whether a file that starts like this is a drawing of surfaces from CAD.
pub(crate) fn is_cad(path: &Path, start: &[u8]) -> bool {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    // STEP's first line; the first line of IGES has an S in column 73.
    start.trim_ascii_start().starts_with(b"ISO-10303-21")
        || start.get(72..80).is_some_and(|end| end[0] == b'S' && end.ends_with(b"1") && start.is_ascii())
        || ["step", "stp", "iges", "igs"].contains(&extension.as_str())
}

/// Reads whichever it is.
pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<Soup, MeshFileError> {
    let start = bytes.get(..bytes.len().min(4096)).unwrap_or_default();
    if ply::starts(start) {
        ply::parse(path, bytes)
    } else if vtk::starts(start) {
        vtk::parse(path, bytes)
    } else if vtp::starts(start) {
        vtp::parse(path, bytes)
    } else if off::starts(start) {
        off::parse(path, bytes)
    } else if stl::is_stl(start, bytes.len() as u64) {
        stl::parse(path, bytes)
    } else if is_cad(path, start) {
        Err(MeshFileError::Cad { path: path.to_owned() })
    } else if obj::starts(start) {
        obj::parse(path, bytes)
    } else {
        // The reader of STL says most of what is wrong; another extension is another kind of file.
        stl::parse(path, bytes).map_err(|error| match error {
            MeshFileError::NotStl { path, .. }
                if path.extension().is_none_or(|e| !e.eq_ignore_ascii_case("stl")) =>
            {
                MeshFileError::NotMesh { path }
            }
            other => other,
        })
    }
}
