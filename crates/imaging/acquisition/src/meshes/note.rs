//! What a mesh's user should know, in few words.

use std::fmt;

use super::repair::Repaired;

/// Something about a mesh that its user should know, and that did not keep it from being read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MeshNote {
    /// Closed surfaces that were wound inside out, and were turned.
    Inverted {
        /// How many.
        count: usize,
        /// Of how many closed ones.
        of: usize,
    },
    /// Open surfaces that were wound inside out by the volume that they nearly enclose, and were turned.
    OpenInverted {
        /// How many.
        count: usize,
    },
    /// Triangles that were wound against their neighbours, and were turned.
    Rewound {
        /// How many.
        triangles: usize,
    },
    /// Edges with one triangle.
    Open {
        /// How many.
        edges: usize,
        /// Chains of them.
        rims: usize,
        /// Length of the longest chain, mm.
        longest_mm: f64,
        /// Its middle, mm.
        centre_mm: [f64; 3],
    },
    /// Open surfaces whose volume comes out negative: perhaps wound inside out, which cannot be told where much is missing.
    WindingUnknown {
        /// How many.
        count: usize,
    },
    /// Edges with more than two triangles.
    NonManifold {
        /// How many.
        edges: usize,
        /// Middle of the longest chain of them, mm.
        centre_mm: [f64; 3],
    },
    /// Edges along which neighbours are wound against each other, on a surface with one side (a Möbius strip).
    InconsistentWinding {
        /// How many.
        edges: usize,
    },
    /// Pieces that do not touch.
    Bodies {
        /// How many.
        count: usize,
    },
    /// Closed surfaces within others, which face inward.
    Cavities {
        /// How many.
        count: usize,
    },
    /// Too many closed surfaces to tell which of them are cavities: all face outward.
    CavitiesUnknown,
    /// Triangles without area, left out.
    Degenerate {
        /// How many.
        triangles: usize,
    },
    /// Triangles without area, taken into the neighbour across their longest side.
    Needles {
        /// How many.
        triangles: usize,
    },
    /// Triangles with the same corners as an earlier one, left out.
    Duplicate {
        /// How many.
        triangles: usize,
    },
    /// Vertices of open edges that were welded to one that lies closer than rounding.
    Welded {
        /// How many.
        vertices: usize,
    },
    /// Polygons that cross themselves.
    Crossed {
        /// How many.
        polygons: usize,
    },
    /// Things that are no surface, or of a kind that is not read.
    LeftOut {
        /// How many.
        count: usize,
        /// What they are.
        what: &'static str,
    },
    /// Bytes after the last triangle, left out.
    TrailingBytes {
        /// How many.
        bytes: u64,
    },
}

/// A count with its word, `s` added to it where it is not one.
fn many(count: usize, word: &str) -> String {
    if count == 1 { format!("1 {word}") } else { format!("{count} {word}s") }
}

fn at(centre: &[f64; 3]) -> String {
    let [x, y, z] = centre;
    format!("({x:.1}, {y:.1}, {z:.1}) mm")
}

impl fmt::Display for MeshNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Inverted { count: 1, of: 1 } => write!(f, "wound inside out; turned round"),
            Self::Inverted { count, of } => {
                write!(f, "{count} of {of} closed surfaces were wound inside out; turned round")
            }
            Self::OpenInverted { count } => {
                write!(
                    f,
                    "{} wound inside out, by the volume nearly enclosed; turned round",
                    many(*count, "open surface")
                )
            }
            Self::Rewound { triangles } => {
                write!(f, "{} wound against the others; turned round", many(*triangles, "triangle"))
            }
            Self::Open { edges, rims, longest_mm, centre_mm } => write!(
                f,
                "not closed: {} with one triangle only, in {}; the longest is {longest_mm:.1} mm long around {}",
                many(*edges, "edge"),
                many(*rims, "rim"),
                at(centre_mm)
            ),
            Self::WindingUnknown { count } => write!(
                f,
                "{} perhaps wound inside out, which cannot be told of an open mesh; left as it is",
                many(*count, "open surface")
            ),
            Self::NonManifold { edges, centre_mm } => write!(
                f,
                "not a surface at {} with more than two triangles, around {}",
                many(*edges, "edge"),
                at(centre_mm)
            ),
            Self::InconsistentWinding { edges } => write!(
                f,
                "a surface with one side only: neighbouring triangles are wound against each other at {}",
                many(*edges, "edge")
            ),
            Self::Bodies { count } => write!(f, "{count} pieces that do not touch"),
            Self::Cavities { count } => {
                write!(
                    f,
                    "{} within others, taken for cavities and wound inward",
                    many(*count, "closed surface")
                )
            }
            Self::CavitiesUnknown => {
                write!(f, "too many closed surfaces to tell which are cavities; all are wound outward")
            }
            Self::Degenerate { triangles } => {
                write!(f, "{triangles} triangles without area were left out")
            }
            Self::Needles { triangles } => {
                write!(f, "{} without area taken into the neighbour", many(*triangles, "triangle"))
            }
            Self::Duplicate { triangles } => {
                write!(f, "{triangles} triangles with the corners of another one were left out")
            }
            Self::Welded { vertices } => {
                write!(
                    f,
                    "{} at open edges welded to another, closer than rounding",
                    many(*vertices, "corner")
                )
            }
            Self::Crossed { polygons } => write!(f, "{} that cross themselves", many(*polygons, "polygon")),
            Self::LeftOut { count, what } => write!(f, "{count} {what} were left out"),
            Self::TrailingBytes { bytes } => write!(f, "{bytes} bytes after the last triangle were left out"),
        }
    }
}

/// All that is worth a note.
pub(super) fn notes(
    mesh: &Repaired,
    crossed: usize,
    left_out: &[(usize, &'static str)],
    trailing_bytes: u64,
) -> Vec<MeshNote> {
    let Repaired { topology, repairs, closed_inverted, open_inverted, doubtful, cavities, .. } = mesh;
    let mut notes = Vec::new();
    let mut note = |count: usize, note: MeshNote| {
        if count > 0 {
            notes.push(note);
        }
    };
    note(*closed_inverted, MeshNote::Inverted { count: *closed_inverted, of: mesh.closed });
    note(*open_inverted, MeshNote::OpenInverted { count: *open_inverted });
    note(repairs.rewound, MeshNote::Rewound { triangles: repairs.rewound });
    if let [longest, ..] = &mesh.rims[..] {
        let (longest_mm, centre_mm) = (longest.length_mm, longest.centre_mm);
        note(1, MeshNote::Open { edges: topology.open_edges, rims: mesh.rims.len(), longest_mm, centre_mm });
    }
    note(*doubtful, MeshNote::WindingUnknown { count: *doubtful });
    note(topology.inconsistent_edges, MeshNote::InconsistentWinding { edges: topology.inconsistent_edges });
    if let [longest, ..] = &mesh.seams[..] {
        note(1, MeshNote::NonManifold { edges: topology.non_manifold_edges, centre_mm: longest.centre_mm });
    }
    note(topology.bodies - 1, MeshNote::Bodies { count: topology.bodies });
    note(*cavities, MeshNote::Cavities { count: *cavities });
    note(usize::from(mesh.cavities_unknown), MeshNote::CavitiesUnknown);
    note(repairs.degenerate, MeshNote::Degenerate { triangles: repairs.degenerate });
    note(repairs.needles, MeshNote::Needles { triangles: repairs.needles });
    note(repairs.duplicate, MeshNote::Duplicate { triangles: repairs.duplicate });
    note(repairs.near_vertices, MeshNote::Welded { vertices: repairs.near_vertices });
    note(crossed, MeshNote::Crossed { polygons: crossed });
    for (count, what) in left_out {
        note(*count, MeshNote::LeftOut { count: *count, what });
    }
    note(usize::from(trailing_bytes > 0), MeshNote::TrailingBytes { bytes: trailing_bytes });
    notes
}
