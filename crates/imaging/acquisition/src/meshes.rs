//! Surfaces of bodies: STL, ascii and binary, to a checked mesh in mm.
//!
//! Read by an own reader, not by the crate `stl_io`: that one goes by the word `solid`, which many binary
//! files also start with, stops at the first of several solids without a word, insists on lower case and names no line.
//!
//! Guaranteed: coordinates are finite and in mm, corners with the very same coordinates are one vertex, triangles without
//! area are gone, a closed mesh is wound outward, and the size is that of a body. Not guaranteed: that the mesh is closed,
//! or that an open one is wound outward; what speaks against it is in the notes. Of several closed bodies the sign of the
//! volumes' sum decides. Normals stored in the file are not used.

mod stl;

use std::fmt;
use std::io::Read;
use std::path::{Path, PathBuf};

use biplane_artifact::ModelMesh;
use biplane_geometry::{Mesh, MeshError, Topology};
use serde::{Deserialize, Serialize};

pub use stl::StlEncoding;
pub(crate) use stl::is_stl;

/// Bytes a mesh file may have: 20 million triangles.
const MAX_BYTES: u64 = 1 << 30;
/// Diagonal of the box around a body, mm: a bead to a pelvis with both femurs.
const PLAUSIBLE_MM: std::ops::RangeInclusive<f64> = 5.0..=2000.0;

/// What one unit of a mesh file is. STL does not say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum LengthUnit {
    /// `mm`
    #[default]
    #[serde(rename = "mm")]
    Millimetres,
    /// `cm`
    #[serde(rename = "cm")]
    Centimetres,
    /// `m`
    #[serde(rename = "m")]
    Metres,
    /// `in`: 25.4 mm
    #[serde(rename = "in")]
    Inches,
}

impl LengthUnit {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Millimetres, Self::Centimetres, Self::Metres, Self::Inches];

    /// One unit, mm.
    pub fn millimetres(self) -> f64 {
        match self {
            Self::Millimetres => 1.0,
            Self::Centimetres => 10.0,
            Self::Metres => 1000.0,
            Self::Inches => 25.4,
        }
    }

    /// The word in files: `mm`, `cm`, `m`, `in`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Millimetres => "mm",
            Self::Centimetres => "cm",
            Self::Metres => "m",
            Self::Inches => "in",
        }
    }
}

/// Something about a mesh that its user should know, and that did not keep it from being read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeshNote {
    /// The closed mesh was wound inside out, and was turned.
    Inverted,
    /// Edges with one triangle.
    Open {
        /// How many.
        edges: usize,
    },
    /// An open mesh whose volume comes out negative: perhaps wound inside out, which cannot be told of an open one.
    WindingUnknown,
    /// Edges with more than two triangles.
    NonManifold {
        /// How many.
        edges: usize,
    },
    /// Edges along which neighbours are wound against each other.
    InconsistentWinding {
        /// How many.
        edges: usize,
    },
    /// Pieces that do not touch.
    Bodies {
        /// How many.
        count: usize,
    },
    /// Triangles without area, left out.
    Degenerate {
        /// How many.
        triangles: usize,
    },
    /// Bytes after the last triangle, left out.
    TrailingBytes {
        /// How many.
        bytes: u64,
    },
}

impl fmt::Display for MeshNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Inverted => write!(f, "wound inside out; turned round"),
            Self::Open { edges } => write!(f, "not closed: {edges} edges have one triangle only"),
            Self::WindingUnknown => {
                write!(f, "perhaps wound inside out, which cannot be told of an open mesh; left as it is")
            }
            Self::NonManifold { edges } => {
                write!(f, "not a surface at {edges} edges, which have more than two triangles")
            }
            Self::InconsistentWinding { edges } => {
                write!(f, "neighbouring triangles are wound against each other at {edges} edges")
            }
            Self::Bodies { count } => write!(f, "{count} pieces that do not touch"),
            Self::Degenerate { triangles } => write!(f, "{triangles} triangles without area were left out"),
            Self::TrailingBytes { bytes } => write!(f, "{bytes} bytes after the last triangle were left out"),
        }
    }
}

/// A mesh as it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshFile {
    /// The surface, mm.
    pub model: ModelMesh,
    /// Ascii or binary.
    pub encoding: StlEncoding,
    /// Triangles in the file; those without area are not in the mesh.
    pub triangles_in_file: usize,
    /// How its triangles hang together.
    pub topology: Topology,
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
    /// Neither ascii nor binary STL.
    #[error("{} is not an STL mesh: {what}", path.display())]
    NotStl {
        /// The file.
        path: PathBuf,
        /// What was found.
        what: String,
    },
    /// A binary file shorter than its count of triangles says.
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
    /// A line of an ascii file.
    #[error("{}, line {line}: expected {expected}, found {found}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// What should stand there.
        expected: &'static str,
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
    #[error("{} holds no surface: {triangles} triangles, none with an area", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
        /// Triangles in the file.
        triangles: usize,
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
}

/// A length with three digits or so.
fn length(mm: f64) -> String {
    if mm >= 10.0 { format!("{mm:.0} mm") } else { format!("{mm:.3} mm") }
}

/// Reads a mesh whose unit of length is `unit`.
///
/// # Errors
/// The file cannot be read, is not an STL mesh, is cut short, has a corner that is not finite or no triangle with an area,
/// or is not the size of a body (5 to 2000 mm across) in the unit given.
pub fn read_mesh(path: impl AsRef<Path>, unit: LengthUnit) -> Result<MeshFile, MeshFileError> {
    let path = path.as_ref();
    let mut file = read_unscaled(path)?;
    check_size(path, &file.model.0, unit)?;
    file.model = ModelMesh(file.model.0.scaled(unit.millimetres()));
    Ok(file)
}

/// Whether a mesh in the file's own unit would be the size of a body, if that unit is `unit`.
pub(crate) fn check_size(path: &Path, mesh: &Mesh, unit: LengthUnit) -> Result<(), MeshFileError> {
    let (low, high) = mesh.bounding_box();
    let raw = (high - low).norm();
    let diagonal_mm = raw * unit.millimetres();
    if PLAUSIBLE_MM.contains(&diagonal_mm) {
        return Ok(());
    }
    Err(MeshFileError::Implausible { path: path.to_owned(), diagonal_mm, unit, advice: unit_advice(raw) })
}

/// Which units would make a body of it.
fn unit_advice(raw: f64) -> String {
    let fits: Vec<String> = LengthUnit::ALL
        .iter()
        .filter(|u| (10.0..=1000.0).contains(&(raw * u.millimetres())))
        .map(|u| {
            format!(
                "units = \"{}\" if the file is in {} ({})",
                u.name(),
                u.name(),
                length(raw * u.millimetres())
            )
        })
        .collect();
    if fits.is_empty() { String::new() } else { format!(": set {}", fits.join(", or ")) }
}

/// As [`read_mesh`], in the file's own unit and whatever its size.
pub(crate) fn read_unscaled(path: &Path) -> Result<MeshFile, MeshFileError> {
    let io = |source| MeshFileError::Io { path: path.to_owned(), source };
    let not_stl = |what: String| MeshFileError::NotStl { path: path.to_owned(), what };
    let file = std::fs::File::open(path).map_err(io)?;
    let length = file.metadata().map_err(io)?.len();
    if length > MAX_BYTES {
        return Err(not_stl(format!("it has {length} bytes, and at most {MAX_BYTES} are read")));
    }
    let mut bytes = Vec::new();
    file.take(MAX_BYTES).read_to_end(&mut bytes).map_err(io)?;
    let stl::Soup { encoding, triangles, trailing_bytes } = stl::parse(path, &bytes)?;
    drop(bytes);
    let bad = triangles.iter().enumerate().find_map(|(triangle, corners)| {
        corners.iter().find(|c| !c.coords.iter().all(|v| v.is_finite())).map(|c| (triangle, [c.x, c.y, c.z]))
    });
    if let Some((triangle, corner)) = bad {
        return Err(MeshFileError::NotFinite { path: path.to_owned(), triangle, corner });
    }
    let mesh = Mesh::from_soup(&triangles).map_err(|e| match e {
        MeshError::Empty { triangles } => MeshFileError::Empty { path: path.to_owned(), triangles },
        other => not_stl(other.to_string()),
    })?;
    let topology = mesh.topology();
    let Topology { open_edges, non_manifold_edges, inconsistent_edges, bodies } = topology;
    let inside_out = mesh.signed_volume() < 0.0;
    let oriented = open_edges == 0 && inconsistent_edges == 0;
    let mut notes = Vec::new();
    let mut note = |when: bool, note| {
        if when {
            notes.push(note);
        }
    };
    let degenerate = triangles.len() - mesh.triangles().len();
    note(inside_out && oriented, MeshNote::Inverted);
    note(open_edges > 0, MeshNote::Open { edges: open_edges });
    note(inside_out && !oriented, MeshNote::WindingUnknown);
    note(inconsistent_edges > 0, MeshNote::InconsistentWinding { edges: inconsistent_edges });
    note(non_manifold_edges > 0, MeshNote::NonManifold { edges: non_manifold_edges });
    note(bodies > 1, MeshNote::Bodies { count: bodies });
    note(degenerate > 0, MeshNote::Degenerate { triangles: degenerate });
    note(trailing_bytes > 0, MeshNote::TrailingBytes { bytes: trailing_bytes });
    let mesh = if inside_out && oriented { mesh.inverted() } else { mesh };
    Ok(MeshFile { model: ModelMesh(mesh), encoding, triangles_in_file: triangles.len(), topology, notes })
}
