//! What is wrong with a surface, with the slice beside it; and vertices taken back where moving them made triangles cross.

use biplane_artifact::{BoneSurface, SurfaceFault};
use biplane_geometry::{Mesh, Point3};
use biplane_surface::{MeshCheck, Surface};

use crate::stack::Stack;
use crate::stage::Made;

/// Crossing pairs that are looked for at a time.
const MOST_CROSSINGS: usize = 1000;
/// Rounds of taking back; each takes a ring more of vertices.
const MOST_ROUNDS: usize = 8;
/// Faults of a kind that are named one by one.
const MOST_NAMED: usize = 5;

/// The surface with what the checks found.
pub(crate) fn checked(stack: &Stack, made: Made) -> BoneSurface {
    let Made { mut mesh, unmoved, unsmoothed_volume_mm3, mut report } = made;
    let mut crossings = Surface::new(&mesh).self_crossings(MOST_CROSSINGS);
    let mut back = vec![false; mesh.vertices().len()];
    let mut taken = 0;
    if let Some(unmoved) = unmoved {
        for _ in 0..MOST_ROUNDS {
            if crossings.is_empty() {
                break;
            }
            let Some(next) = taken_back(&mesh, &unmoved, &crossings, &mut back) else { break };
            mesh = next;
            taken = back.iter().filter(|b| **b).count();
            crossings = Surface::new(&mesh).self_crossings(MOST_CROSSINGS);
        }
        if !crossings.is_empty()
            && let Ok(plain) = Mesh::new(unmoved, mesh.triangles().to_vec())
        {
            (taken, mesh) = (plain.vertices().len(), plain);
            crossings = Surface::new(&mesh).self_crossings(MOST_CROSSINGS);
        }
    }
    if taken > 0 {
        report.warnings.push(format!(
            "{taken} of {} vertices stay unevenly spread: triangles would have crossed",
            back.len()
        ));
    }
    let check = MeshCheck::of(&mesh);
    report.volume_mm3 = check.signed_volume_mm3;
    report.unsmoothed_volume_mm3 = unsmoothed_volume_mm3.unwrap_or(report.volume_mm3);
    report.area_mm2 = check.area_mm2;
    report.pieces = check.pieces;
    let middle = |vertices: &[u32]| {
        let sum =
            vertices.iter().fold(Point3::origin().coords, |s, v| s + mesh.vertices()[*v as usize].coords);
        Point3::from(sum / vertices.len().max(1) as f64)
    };
    let mut kinds: Vec<(&str, Vec<Point3>)> = vec![
        ("open along an edge", check.open_edges.iter().map(|e| middle(e)).collect()),
        ("more than two triangles at an edge", check.crowded_edges.iter().map(|e| middle(e)).collect()),
        (
            "neighbouring triangles wound against each other",
            check.inconsistent_edges.iter().map(|e| middle(e)).collect(),
        ),
        ("parts that touch in a vertex", check.pinched_vertices.iter().map(|v| middle(&[*v])).collect()),
        (
            "triangles that cross",
            crossings.iter().map(|[t, _]| middle(&mesh.triangles()[*t as usize])).collect(),
        ),
    ];
    if check.open_edges.is_empty() && check.signed_volume_mm3 <= 0.0 {
        kinds.push(("wound inside out", vec![mesh.area_centroid()]));
    }
    for (what, places) in kinds {
        // By slices, each with how often and where first.
        let mut by_slice: Vec<(usize, usize, Point3)> = Vec::new();
        for place in places {
            let slice = stack.slice_below(&place);
            match by_slice.iter_mut().find(|s| s.0 == slice) {
                Some(found) => found.1 += 1,
                None => by_slice.push((slice, 1, place)),
            }
        }
        by_slice.sort_by_key(|s| s.0);
        let more = by_slice.len().saturating_sub(MOST_NAMED);
        for (slice, count, at) in by_slice.into_iter().take(MOST_NAMED) {
            let what = format!("{what}, {count} times, first at ({:.2}, {:.2}, {:.2}) mm", at.x, at.y, at.z);
            report.faults.push(SurfaceFault { slice: Some(slice), what });
        }
        if more > 0 {
            report.faults.push(SurfaceFault { slice: None, what: format!("{what}, in {more} more slices") });
        }
    }
    BoneSurface { mesh, report }
}

/// The mesh with the vertices of crossing triangles, and a ring around those taken back before, where they were.
fn taken_back(mesh: &Mesh, unmoved: &[Point3], crossings: &[[u32; 2]], back: &mut [bool]) -> Option<Mesh> {
    let ring: Vec<u32> = mesh
        .triangles()
        .iter()
        .filter(|t| t.iter().any(|v| back[*v as usize]))
        .chain(crossings.iter().flatten().map(|t| &mesh.triangles()[*t as usize]))
        .flatten()
        .copied()
        .collect();
    for v in ring {
        back[v as usize] = true;
    }
    let vertices =
        mesh.vertices().iter().enumerate().map(|(v, p)| if back[v] { unmoved[v] } else { *p }).collect();
    let next = Mesh::new(vertices, mesh.triangles().to_vec()).ok()?;
    (next.triangles().len() == mesh.triangles().len()).then_some(next)
}
