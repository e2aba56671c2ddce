//! The sphere on a square: projected onto an octahedron whose faces unfold (Meyer et al. 2010).

use biplane_geometry::Vector3;

/// The unit vector at a place of the square, each coordinate -1 to 1.
fn unfold(x: f64, y: f64) -> Vector3 {
    let z = 1.0 - x.abs() - y.abs();
    let fold = (-z).max(0.0);
    Vector3::new(x - fold.copysign(x), y - fold.copysign(y), z).normalize()
}

/// The middles of the cells of a map of `side` cells a side, row by row.
pub(crate) fn middles(side: usize) -> impl Iterator<Item = Vector3> {
    let middle = move |k: usize| (2 * k + 1) as f64 / side as f64 - 1.0;
    (0..side * side).map(move |cell| unfold(middle(cell % side), middle(cell / side)))
}

/// Where a vector that is not zero lies on the square, each coordinate -1 to 1.
pub(crate) fn fold(v: &Vector3) -> [f64; 2] {
    let scale = 1.0 / (v.x.abs() + v.y.abs() + v.z.abs());
    let (x, y) = (v.x * scale, v.y * scale);
    // The lower half is folded outward over the edges of the upper one.
    if v.z < 0.0 { [(1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y)] } else { [x, y] }
}

/// The cell of a map of `side` cells a side that a vector lies in.
pub(crate) fn cell(v: &Vector3, side: usize) -> usize {
    let [x, y] = fold(v).map(|w| (((w + 1.0) * (side as f64 / 2.0)) as usize).min(side - 1));
    y * side + x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_holds_its_middle() {
        for (k, middle) in middles(31).enumerate() {
            assert!((middle.norm() - 1.0).abs() < 1e-12);
            assert_eq!(cell(&(middle * 3.0), 31), k);
        }
    }
}
