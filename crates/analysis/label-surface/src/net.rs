//! The surface on which a field has one value: surface nets (Gibson 1998), closed and two-manifold.
//!
//! A vertex lies in each cell of the lattice through which the surface goes, in the middle of the crossings of the cell's edges;
//! a pair of triangles crosses each edge of the lattice that has one end inside and one outside. So the surface is, but for the
//! places of its vertices, the boundary of a set of voxels, and that is a two-manifold exactly where the set is well-composed
//! (Latecki 1997): no two of its voxels touch by an edge or corner only, nor two of the others. Where they do, a place more is
//! taken inside until none is left (Siqueira et al. 2008): parts that touch are joined.

use biplane_geometry::{Mesh, Point3};
use fast_surface_nets::ndshape::RuntimeShape;
use fast_surface_nets::{SurfaceNetsBuffer, surface_nets};

use crate::field::Field;
use crate::stack::Stack;

/// Value above the level that is given to a place that has to be inside.
const JOINED: f32 = 0.02;
/// No place of the lattice is nearer to the level than this: crossings in it would give triangles without area.
const NEAREST: f32 = 1e-3;

/// The corners of a cell's faces, in order around them; corner `c` is at `c & 1`, `c >> 1 & 1`, `c >> 2`.
const FACES: [[u8; 4]; 6] =
    [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];

/// The surface of a field at a level, wound outward; none where there is no surface.
pub(crate) fn net(field: &Field, stack: &Stack, level: f32) -> Option<Mesh> {
    let size = field.size();
    // Negative inside, as the library has it.
    let mut below: Vec<f32> = field.values.iter().map(|v| apart(level - v)).collect();
    make_well_composed(&mut below, size);
    let shape = RuntimeShape::<u32, 3>::new(size.map(|n| n as u32));
    let mut net = SurfaceNetsBuffer::default();
    surface_nets(&below, &shape, [0; 3], size.map(|n| n as u32 - 1), &mut net);
    let place = |(at, cell): (&[f32; 3], &[u32; 3])| -> Point3 {
        stack.point(std::array::from_fn(|a| {
            let line = &field.lines[a];
            let [first, last] = line.ends();
            // A lid lies in the border of the volume.
            if line.lids[0] && (cell[a] as usize) < first {
                line.at(first as f64)
            } else if line.lids[1] && cell[a] as usize >= last {
                line.at(last as f64)
            } else {
                line.at(f64::from(at[a]))
            }
        }))
    };
    let vertices = net.positions.iter().zip(&net.surface_points).map(place).collect();
    let triangles = net.indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
    let mesh = Mesh::new(vertices, triangles).ok()?;
    Some(if stack.right_handed() { mesh } else { mesh.inverted() })
}

fn apart(below: f32) -> f32 {
    if below < 0.0 { below.min(-NEAREST) } else { below.max(NEAREST) }
}

/// Takes places inside (negative) until no two sets touch by an edge or a corner only.
fn make_well_composed(below: &mut [f32], size: [usize; 3]) {
    let [columns, rows, slices] = size;
    let steps = [1, columns, columns * rows];
    let offset: [usize; 8] = std::array::from_fn(|c| (0..3).map(|a| (c >> a & 1) * steps[a]).sum());
    // Cells that have to be looked at again, after all.
    let mut again: Vec<usize> = Vec::new();
    let look = |below: &mut [f32], cell: usize, again: &mut Vec<usize>| {
        while let Some(corner) = to_join(&offset.map(|o| below[cell + o])) {
            let at = cell + offset[corner];
            below[at] = -JOINED;
            // No place at the end of the lattice is ever inside, so all its cells are there.
            again.extend(offset.iter().map(|o| at - o));
        }
    };
    // The four corners of a cell at each column, a bit for each that is inside: most cells are wholly in or out.
    let mut columns_of_row = vec![0_u8; columns];
    for k in 0..slices - 1 {
        for j in 0..rows - 1 {
            let row = (k * rows + j) * columns;
            let four = [row, row + steps[1], row + steps[2], row + steps[1] + steps[2]];
            columns_of_row.fill(0);
            for (bit, from) in four.into_iter().enumerate() {
                for (bits, value) in columns_of_row.iter_mut().zip(&below[from..from + columns]) {
                    *bits |= u8::from(*value < 0.0) << bit;
                }
            }
            for (i, pair) in columns_of_row.windows(2).enumerate() {
                if pair[0] != pair[1] || !matches!(pair[0], 0 | 15) {
                    look(below, row + i, &mut again);
                }
            }
        }
    }
    while let Some(cell) = again.pop() {
        look(below, cell, &mut again);
    }
}

/// The corner of a cell that has to be taken inside; of several the one that is nearest to it, of equal ones the first.
fn to_join(values: &[f32; 8]) -> Option<usize> {
    let inside = values.iter().enumerate().fold(0_u8, |bits, (c, v)| bits | u8::from(*v < 0.0) << c);
    if inside == 0 || inside == 255 {
        return None;
    }
    let mut candidates = 0_u8;
    for face in FACES {
        let [a, b, c, d] = face.map(|corner| inside >> corner & 1 == 1);
        if a == c && b == d && a != b {
            candidates = face.iter().filter(|c| inside >> *c & 1 == 0).fold(0, |bits, c| bits | 1 << c);
            break;
        }
    }
    let opposite = |bits: u8| (0..4).any(|c| bits == 1 << c | 1 << (7 - c));
    if opposite(inside) || opposite(!inside) {
        candidates = !inside;
    }
    (0..8).filter(|c| candidates >> c & 1 == 1).min_by(|a, b| values[*a].total_cmp(&values[*b]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_becomes_well_composed() {
        for inside in 0..=255_u8 {
            let mut values: [f32; 8] =
                std::array::from_fn(|c| if inside >> c & 1 == 1 { -0.1 } else { 0.1 + c as f32 });
            let mut count = 0;
            while let Some(corner) = to_join(&values) {
                assert!(values[corner] > 0.0);
                values[corner] = -JOINED;
                count += 1;
                assert!(count <= 6);
            }
            // Two diagonal corners of a face are joined by the first of the others, two of a cube by two.
            if inside == 0b1001 {
                assert_eq!((count, values[1]), (1, -JOINED));
            }
            if inside == 0b1000_0001 {
                assert_eq!(count, 2);
            }
        }
    }
}
