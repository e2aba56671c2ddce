//! The order of a mesh's vertices and triangles in memory: what is near in space is near in memory.
//!
//! Vertices follow Hilbert's curve through the box of the mesh (Skilling, "Programming the Hilbert curve", 2004), triangles their
//! lowest vertex. Loops over faces and edges then read memory nearly in order.

use biplane_geometry::{Mesh, MeshError};

/// Bits a coordinate along the curve.
const BITS: u32 = 16;

/// The same mesh in another order; vertices without a triangle are left out. Each triangle begins with its lowest vertex.
///
/// # Errors
/// None for a mesh that has triangles with an area.
pub fn laid_out(mesh: &Mesh) -> Result<Mesh, MeshError> {
    let (low, high) = mesh.bounding_box();
    let size = (high - low).max().max(f64::MIN_POSITIVE);
    let scale = f64::from((1_u32 << BITS) - 1) / size;
    let mut used = vec![false; mesh.vertices().len()];
    for v in mesh.triangles().as_flattened() {
        used[*v as usize] = true;
    }
    let key = |v: u32| {
        let at = mesh.vertices()[v as usize] - low;
        hilbert([0, 1, 2].map(|axis| (at[axis] * scale) as u32))
    };
    let mut order: Vec<(u64, u32)> =
        (0..used.len() as u32).filter(|v| used[*v as usize]).map(|v| (key(v), v)).collect();
    order.sort_unstable();
    let mut number = vec![0; used.len()];
    for (new, (_, old)) in order.iter().enumerate() {
        number[*old as usize] = new as u32;
    }
    let lowest_first = |t: &[u32; 3]| {
        let mut t = t.map(|v| number[v as usize]);
        let lowest = (0..3).fold(0, |best, k| if t[k] < t[best] { k } else { best });
        t.rotate_left(lowest);
        t
    };
    let mut triangles: Vec<[u32; 3]> = mesh.triangles().iter().map(lowest_first).collect();
    triangles.sort_unstable();
    Mesh::new(order.iter().map(|(_, v)| mesh.vertices()[*v as usize]).collect(), triangles)
}

/// How far along the curve a cell lies.
fn hilbert(mut x: [u32; 3]) -> u64 {
    let mut bit = 1 << (BITS - 1);
    while bit > 1 {
        for axis in 0..3 {
            if x[axis] & bit != 0 {
                x[0] ^= bit - 1;
            } else {
                let turn = (x[0] ^ x[axis]) & (bit - 1);
                x[0] ^= turn;
                x[axis] ^= turn;
            }
        }
        bit >>= 1;
    }
    x[1] ^= x[0];
    x[2] ^= x[1];
    let mut turn = 0;
    let mut bit = 1 << (BITS - 1);
    while bit > 1 {
        if x[2] & bit != 0 {
            turn ^= bit - 1;
        }
        bit >>= 1;
    }
    let x = x.map(|c| c ^ turn);
    (0..BITS).rev().fold(0, |key, b| x.iter().fold(key, |key, c| key << 1 | u64::from(c >> b & 1)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_phantom::ball_mesh;

    #[test]
    fn the_curve_goes_from_cell_to_neighbouring_cell() {
        let side = 8_u32;
        let cells = (0..side).flat_map(|i| (0..side).flat_map(move |j| (0..side).map(move |k| [i, j, k])));
        let mut along: Vec<(u64, [u32; 3])> = cells.map(|c| (hilbert(c), c)).collect();
        along.sort_unstable();
        for pair in along.windows(2) {
            let steps: u32 = (0..3).map(|axis| pair[0].1[axis].abs_diff(pair[1].1[axis])).sum();
            assert_eq!((steps, pair[1].0 - pair[0].0), (1, 1));
        }
    }

    #[test]
    fn the_mesh_is_the_same_and_neighbours_are_near() {
        let ball = ball_mesh(10.0, 4000).unwrap();
        let laid = laid_out(&ball).unwrap();
        assert_eq!(laid.vertices().len(), ball.vertices().len());
        assert!((laid.signed_volume() - ball.signed_volume()).abs() < 1e-9);
        assert_eq!(laid.topology(), ball.topology());
        assert_eq!(laid_out(&laid).unwrap(), laid);
        // Half of the triangles have their vertices within a few cells of memory.
        let spans = laid.triangles().iter().map(|t| t.iter().max().unwrap() - t.iter().min().unwrap());
        let mut spans: Vec<u32> = spans.collect();
        spans.sort_unstable();
        assert!(spans[spans.len() / 2] < 40, "{}", spans[spans.len() / 2]);
    }
}
