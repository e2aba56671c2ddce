//! What a mesh holds, for a person to read: its size in each unit it may be in, its pieces, rims and seams, and what was mended.

use std::path::Path;

use biplane_geometry::Mesh;

use super::Description;
use crate::meshes::edges::Edges;
use crate::meshes::{
    EdgeChain, LengthUnit, MeshFile, MeshFileError, MeshNote, Repairs, USUAL_MM, digits, read_as, sides,
};

/// Pieces, rims and seams that get a line of their own.
const MOST_LINES: usize = 12;

/// Describes a mesh file, in the only unit in which it would be a bone or an implant, else as if it were in mm.
pub(super) fn describe(path: &Path) -> Result<Description, MeshFileError> {
    let mut size = [0.0; 3];
    let mut usual = Vec::new();
    let file = read_as(path, |raw| {
        size = raw;
        usual = LengthUnit::usual(raw);
        Ok(if let [one] = usual[..] { one } else { LengthUnit::Millimetres })
    })?;
    let MeshFile {
        model,
        format,
        unit,
        triangles_in_file,
        polygons_cut,
        repairs,
        pieces,
        rims,
        seams,
        notes,
        ..
    } = &file;
    let mesh = &model.0;
    let mut d = Description::new(format!("mesh, {}", format.name()));
    let kept = mesh.triangles().len();
    d.line(
        "triangles",
        if kept == *triangles_in_file {
            kept.to_string()
        } else {
            format!("{triangles_in_file} in the file, {kept} kept")
        },
    );
    if *polygons_cut > 0 {
        d.line("polygons", format!("{polygons_cut} of more than three corners, cut into triangles"));
    }
    d.line("vertices", mesh.vertices().len().to_string());
    d.line("size", format!("{} in the file's unit", sides(size, 1.0)));
    unit_lines(&mut d, size, &usual);
    d.line("figures below", format!("as if the file were in {}", unit.name()));
    d.line("surface", surface(&file));
    d.line("area", format!("{} mm^2", digits(mesh.area())));
    let volume = file.pieces.iter().map(|p| p.volume_mm3).sum::<Option<f64>>();
    d.line("volume", volume.map_or("none: not closed".to_owned(), |v| format!("{} mm^3", digits(v))));
    d.line("centroid", format!("{} mm, of the surface", triple(mesh.area_centroid().into())));
    d.line("edge length", spacing(mesh));
    for (i, piece) in pieces.iter().take(MOST_LINES).enumerate() {
        let size = [0, 1, 2].map(|a| piece.high_mm[a] - piece.low_mm[a]);
        let body = match piece.volume_mm3 {
            Some(volume) if piece.cavity => format!("closed, a cavity of {} mm^3", digits(-volume)),
            Some(volume) => format!("closed, {} mm^3", digits(volume)),
            None => "open".to_owned(),
        };
        let middle = [0, 1, 2].map(|a| (piece.high_mm[a] + piece.low_mm[a]) / 2.0);
        let (triangles, area) = (piece.triangles, digits(piece.area_mm2));
        d.line(
            format!("piece {}", i + 1),
            format!(
                "{triangles} triangles, {} mm around {}, {area} mm^2, {body}",
                sides(size, 1.0),
                triple(middle)
            ),
        );
    }
    more(&mut d, "pieces", pieces.len());
    chains(&mut d, "rim", rims, "of one triangle");
    chains(&mut d, "seam", seams, "of more than two triangles");
    if let Some(words) = mended(repairs) {
        d.line("mended", words);
    }
    // What the lines above have said already is not said again.
    let untold = |n: &&MeshNote| {
        matches!(
            n,
            MeshNote::WindingUnknown { .. }
                | MeshNote::Cavities { .. }
                | MeshNote::CavitiesUnknown
                | MeshNote::Crossed { .. }
                | MeshNote::LeftOut { .. }
                | MeshNote::TrailingBytes { .. }
        )
    };
    for note in notes.iter().filter(untold) {
        d.line("note", note.to_string());
    }
    Ok(d)
}

/// What the file is in each unit, and what to set.
fn unit_lines(d: &mut Description, size: [f64; 3], usual: &[LengthUnit]) {
    let diagonal = size[0].hypot(size[1]).hypot(size[2]);
    for unit in LengthUnit::ALL {
        let verdict = match diagonal * unit.millimetres() {
            across if USUAL_MM.contains(&across) => "a bone or implant may be that",
            across if across < *USUAL_MM.start() => "too small for a bone or implant",
            _ => "too large for a bone or implant",
        };
        d.line(
            format!("if in {}", unit.name()),
            format!("{} mm: {verdict}", sides(size, unit.millimetres())),
        );
    }
    let keys: Vec<String> = usual.iter().map(|u| format!("units = \"{}\"", u.name())).collect();
    d.line(
        "unit",
        match usual {
            [] => "not in the file, and none of these fits: scale it in the program that made it".to_owned(),
            [LengthUnit::Millimetres] => "not in the file; taken as mm, which alone fits".to_owned(),
            [one] => format!("not mm: set {} in its [[body]]", key(*one)),
            _ => format!(
                "not in the file, and the size leaves it open: set {} in its [[body]]",
                keys.join(" or ")
            ),
        },
    );
}

fn key(unit: LengthUnit) -> String {
    format!("units = \"{}\"", unit.name())
}

fn surface(file: &MeshFile) -> String {
    let topology = &file.topology;
    let mut words = Vec::new();
    words.push(match (topology.open_edges, topology.non_manifold_edges) {
        (0, 0) => "closed".to_owned(),
        (0, seams) => format!("without rims, but {seams} edges have more than two triangles"),
        (open, 0) => format!("open: {open} edges have one triangle"),
        (open, seams) => format!("open: {open} edges have one triangle, {seams} more than two"),
    });
    let unclear = file.notes.iter().any(|n| matches!(n, MeshNote::WindingUnknown { .. }));
    words.push(match topology.inconsistent_edges {
        0 if unclear => "neighbours wound alike, perhaps inside out".to_owned(),
        0 => "wound outward".to_owned(),
        edges => format!("neighbours wound against each other at {edges} edges"),
    });
    words.push(if topology.bodies == 1 {
        "one piece".to_owned()
    } else {
        format!("{} pieces", topology.bodies)
    });
    words.join(", ")
}

fn triple(v: [f64; 3]) -> String {
    format!("({:.2}, {:.2}, {:.2})", v[0], v[1], v[2])
}

/// How evenly vertices are spread, by the length of edges.
fn spacing(mesh: &Mesh) -> String {
    let vertices = mesh.vertices();
    let edges = Edges::of(vertices.len(), mesh.triangles());
    let mut lengths: Vec<f64> =
        edges.iter().map(|e| e.ends.map(|v| vertices[v as usize])).map(|[p, q]| (q - p).norm()).collect();
    lengths.sort_unstable_by(f64::total_cmp);
    let at = |share: f64| digits(lengths[((lengths.len() - 1) as f64 * share).round() as usize]);
    format!("median {} mm, 5 to 95 %: {} to {} mm, longest {} mm", at(0.5), at(0.05), at(0.95), at(1.0))
}

fn chains(d: &mut Description, what: &str, chains: &[EdgeChain], of: &str) {
    for (i, EdgeChain { edges, length_mm, centre_mm, piece }) in chains.iter().take(MOST_LINES).enumerate() {
        let edges = if *edges == 1 { "1 edge".to_owned() } else { format!("{edges} edges") };
        d.line(
            format!("{what} {}", i + 1),
            format!(
                "{edges} {of}, {} mm long around {} mm, of piece {}",
                digits(*length_mm),
                triple(*centre_mm),
                piece + 1
            ),
        );
    }
    more(d, &format!("{what}s"), chains.len());
}

fn more(d: &mut Description, what: &str, count: usize) {
    if count > MOST_LINES {
        d.line(format!("more {what}"), format!("{} smaller ones", count - MOST_LINES));
    }
}

/// What was done, in words.
fn mended(repairs: &Repairs) -> Option<String> {
    let Repairs {
        same_vertices,
        near_vertices,
        unused_vertices,
        degenerate,
        needles,
        duplicate,
        rewound,
        inverted,
    } = *repairs;
    let words: Vec<String> = [
        (same_vertices, "vertices at the place of another, welded"),
        (near_vertices, "vertices of open edges closer than rounding, welded"),
        (unused_vertices, "vertices of no triangle, dropped"),
        (degenerate, "triangles without area, dropped"),
        (needles, "triangles without area, taken into the neighbour"),
        (duplicate, "triangles with the corners of another, dropped"),
        (rewound, "triangles wound against the others, turned"),
        (inverted, "surfaces inside out, turned"),
    ]
    .into_iter()
    .filter(|(count, _)| *count > 0)
    .map(|(count, what)| format!("{what}: {count}"))
    .collect();
    (!words.is_empty()).then(|| words.join("; "))
}
