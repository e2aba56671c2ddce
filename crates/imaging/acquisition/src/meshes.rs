//! Surfaces of bodies: STL, PLY, OBJ, OFF and VTK to a mended, described mesh in mm.
//!
//! Read by own readers. Measured on a grid of 72,200 triangles against `ply-rs-bw` 4.0.1 and `tobj` 4.0.5: the first is sound, but takes 46 ms and
//! 27 times the file's memory for what takes 4 ms here, and its messages list the grammar; the second takes 25 ms against 16 ms, cuts every
//! polygon as a fan, which is wrong where it is not convex, does not join continued lines, and its errors name no line. `stl_io` goes by the
//! word `solid`, which many binary files also start with, and stops at the first of several solids. `vtkio` panics on some compressed files
//! and miscounts the cells of version 5.1.
//!
//! Mended by own code too (see the module `repair`). `parry3d` 0.31 welds, drops what is degenerate or there twice, and finds neighbours of a mesh of 73,119
//! triangles in 129 ms, against 29 ms here with reading, winding and all; where triangles are wound against each other it deletes them, and
//! it knows neither cavities nor rims.
//!
//! Guaranteed: coordinates are finite and in mm; the size is that of a body; no vertex is there twice, none without a triangle; every
//! triangle has an area and no other one has the same corners; neighbours are wound alike wherever that can be; every closed piece is
//! wound outward, or inward where it lies within another one. Not guaranteed: that the mesh is closed, or free of crossings; what speaks
//! against it is in the notes, the rims and the seams. Normals, colours and other attributes of the file are not used.
//!
//! NURBS (STEP, IGES) are not read: a reader that meshes them would stand beside the others in `format`, and give what they give.

#[cfg(test)]
mod damage;
pub(crate) mod edges;
mod format;
mod nesting;
mod note;
mod obj;
mod off;
mod ply;
mod repair;
mod soup;
mod stl;
mod units;
mod vtk;
mod vtk_cells;
mod vtp;
mod vtp_bytes;
mod weld;
mod winding;
mod words;

use std::io::Read;
use std::path::{Path, PathBuf};

use biplane_artifact::ModelMesh;
use biplane_geometry::{MeshError, Point3, Topology, Vector3};

pub use format::MeshFormat;
pub(crate) use format::{is_cad, is_mesh};
pub use note::MeshNote;
pub use repair::{EdgeChain, Piece, Repairs};
pub use units::LengthUnit;
use units::{PLAUSIBLE_MM, length};
pub(crate) use units::{USUAL_MM, digits, sides};

/// Bytes a mesh file may have: 20 million triangles of binary STL.
const MAX_BYTES: u64 = 1 << 30;

/// A mesh as it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshFile {
    /// The surface, mm.
    pub model: ModelMesh,
    /// What kind of file it was.
    pub format: MeshFormat,
    /// What one unit of the file was taken for.
    pub unit: LengthUnit,
    /// Triangles in the file, those of its polygons among them; those that were dropped are not in the mesh.
    pub triangles_in_file: usize,
    /// Polygons in the file of more than three corners, which were cut into triangles.
    pub polygons_cut: usize,
    /// How its triangles hang together.
    pub topology: Topology,
    /// What was mended.
    pub repairs: Repairs,
    /// What hangs together through edges, the largest area first.
    pub pieces: Vec<Piece>,
    /// Edges of one triangle that hang together, the longest first: each the rim of a hole, or of several that touch.
    pub rims: Vec<EdgeChain>,
    /// The same of edges of more than two triangles.
    pub seams: Vec<EdgeChain>,
    /// What its user should know.
    pub notes: Vec<MeshNote>,
}

/// Why a mesh could not be read.
#[derive(Debug, thiserror::Error)]
pub enum MeshFileError {
    /// The operating system said no.
    #[error("cannot read {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// None of the formats known.
    #[error("{} is none of the meshes that are read: STL, PLY, OBJ, OFF, VTK (legacy) and VTK XML (.vtp)", path.display())]
    NotMesh {
        /// The file.
        path: PathBuf,
    },
    /// Surfaces of CAD.
    #[error(
        "{} is a CAD file (STEP or IGES), which is not read; export it from CAD as STL or PLY, in mm, with a chord tolerance of 0.01 mm",
        path.display()
    )]
    Cad {
        /// The file.
        path: PathBuf,
    },
    /// Neither ascii nor binary STL.
    #[error("{} is not an STL mesh: {what}", path.display())]
    NotStl {
        /// The file.
        path: PathBuf,
        /// What was found.
        what: String,
    },
    /// A binary STL file shorter than its count of triangles says.
    #[error(
        "{} is cut short: it claims {claimed} triangles, which take {expected} bytes, but it has {length}; export it again",
        path.display()
    )]
    Truncated {
        /// The file.
        path: PathBuf,
        /// Triangles claimed.
        claimed: u32,
        /// Bytes they take.
        expected: u64,
        /// Bytes there.
        length: u64,
    },
    /// A binary file that ends too early.
    #[error("{} is cut short: {what}; export it again", path.display())]
    Cut {
        /// The file.
        path: PathBuf,
        /// Where.
        what: String,
    },
    /// Something in the file that is not read, or wrong.
    #[error("{}: {what}", path.display())]
    Refused {
        /// The file.
        path: PathBuf,
        /// What was found, and what to do.
        what: String,
    },
    /// A line of a text.
    #[error("{}, line {line}: expected {expected}, found {found}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// What should stand there.
        expected: String,
        /// What stands there.
        found: String,
    },
    /// A coordinate is NaN or infinite.
    #[error(
        "{}: triangle {triangle} (counted from 0) has a corner at ({}, {}, {}), which is not a finite point; mend the mesh \
         in the program that made it", path.display(), corner[0], corner[1], corner[2]
    )]
    NotFinite {
        /// The file.
        path: PathBuf,
        /// Zero-based triangle.
        triangle: usize,
        /// Its corner.
        corner: [f64; 3],
    },
    /// No triangle, or none with an area.
    #[error("{} holds no surface: {triangles} triangles, none with an area{}", path.display(), others(left_out))]
    Empty {
        /// The file.
        path: PathBuf,
        /// Triangles in the file.
        triangles: usize,
        /// What else it holds.
        left_out: Vec<(usize, &'static str)>,
    },
    /// Not the size of a body.
    #[error(
        "{} would be {} across with units = \"{}\"; a body is {} to {} mm{advice}",
        path.display(), length(*diagonal_mm), unit.name(), PLAUSIBLE_MM.start(), PLAUSIBLE_MM.end()
    )]
    Implausible {
        /// The file.
        path: PathBuf,
        /// Diagonal of the box around it in the unit given, mm.
        diagonal_mm: f64,
        /// The unit given.
        unit: LengthUnit,
        /// Which unit would make it plausible.
        advice: String,
    },
    /// The unit is not given, and the size does not tell it.
    #[error("{} does not say its unit, and its size leaves it open: {question}", path.display())]
    UnitUnknown {
        /// The file.
        path: PathBuf,
        /// The sizes it would have, and the key to set.
        question: String,
    },
}

fn others(left_out: &[(usize, &'static str)]) -> String {
    left_out.iter().map(|(count, what)| format!("; {count} {what} are not read")).collect()
}

/// Reads a mesh whose unit of length is `unit`; `None` where the user says nothing of it: then mm is taken if the size is that of a bone or
/// implant in mm and in no other unit (see [`LengthUnit`]).
///
/// # Errors
/// The file cannot be read, is no mesh of the kinds known, is cut short or damaged, has a corner that is not finite or no triangle with an area,
/// is not the size of a body (5 to 2000 mm across) in the unit given, or leaves its unit open.
pub fn read_mesh(path: impl AsRef<Path>, unit: Option<LengthUnit>) -> Result<MeshFile, MeshFileError> {
    let path = path.as_ref();
    read_as(path, |size| units::decide(path, size, unit))
}

/// As [`read_mesh`] in the unit that `choose` makes of the sides of the box, in the file's own unit, whatever its size.
pub(crate) fn read_as(
    path: &Path,
    choose: impl FnOnce([f64; 3]) -> Result<LengthUnit, MeshFileError>,
) -> Result<MeshFile, MeshFileError> {
    of_bytes(path, contents(path)?, choose)
}

/// The same of what a file holds.
fn of_bytes(
    path: &Path,
    bytes: Vec<u8>,
    choose: impl FnOnce([f64; 3]) -> Result<LengthUnit, MeshFileError>,
) -> Result<MeshFile, MeshFileError> {
    let parsed = format::parse(path, &bytes)?;
    drop(bytes);
    let soup::Soup {
        format, mut points, triangles, cut, crossed, left_out, trailing_bytes, too_many, ..
    } = parsed;
    if too_many {
        let what = format!("it has more than {} triangles; simplify it", soup::MOST_TRIANGLES);
        return Err(MeshFileError::Refused { path: path.to_owned(), what });
    }
    let Some(size) = size(path, &points, &triangles)? else {
        return Err(MeshFileError::Empty { path: path.to_owned(), triangles: triangles.len(), left_out });
    };
    let unit = choose(size)?;
    if unit != LengthUnit::Millimetres {
        points.iter_mut().for_each(|p| *p *= unit.millimetres());
    }
    let triangles_in_file = triangles.len();
    let repaired = repair::repair(&points, triangles).map_err(|e| match e {
        MeshError::Empty { triangles } => {
            MeshFileError::Empty { path: path.to_owned(), triangles, left_out: left_out.clone() }
        }
        other => MeshFileError::Refused { path: path.to_owned(), what: other.to_string() },
    })?;
    let notes = note::notes(&repaired, crossed, &left_out, trailing_bytes);
    let repair::Repaired { mesh, topology, repairs, pieces, rims, seams, .. } = repaired;
    Ok(MeshFile {
        model: mesh,
        format,
        unit,
        triangles_in_file,
        polygons_cut: cut,
        topology,
        repairs,
        pieces,
        rims,
        seams,
        notes,
    })
}

fn contents(path: &Path) -> Result<Vec<u8>, MeshFileError> {
    let io = |source| MeshFileError::Io { path: path.to_owned(), source };
    let file = std::fs::File::open(path).map_err(io)?;
    let length = file.metadata().map_err(io)?.len();
    if length > MAX_BYTES {
        let what = format!("it has {length} bytes, and at most {MAX_BYTES} are read; simplify it");
        return Err(MeshFileError::Refused { path: path.to_owned(), what });
    }
    let mut bytes = Vec::with_capacity(length as usize);
    file.take(MAX_BYTES).read_to_end(&mut bytes).map_err(io)?;
    Ok(bytes)
}

/// Sides of the box around all triangles with an area; none if there is none. All corners have to be finite.
fn size(path: &Path, points: &[Point3], triangles: &[[u32; 3]]) -> Result<Option<[f64; 3]>, MeshFileError> {
    let (mut low, mut high) = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
    for (triangle, corners) in triangles.iter().enumerate() {
        let places = corners.map(|v| points.get(v as usize).copied().unwrap_or_default());
        if let Some(bad) = places.iter().find(|p| !p.coords.iter().all(|c| c.is_finite())) {
            return Err(MeshFileError::NotFinite { path: path.to_owned(), triangle, corner: (*bad).into() });
        }
        let [a, b, c] = places.map(|p| p.coords);
        if (b - a).cross(&(c - a)) != Vector3::zeros() {
            low = low.inf(&a).inf(&b).inf(&c);
            high = high.sup(&a).sup(&b).sup(&c);
        }
    }
    Ok((low <= high).then(|| (high - low).into()))
}
