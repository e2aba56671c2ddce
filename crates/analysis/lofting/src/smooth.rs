//! The stairs of thick slices: contours that are each a little off, in or out, unlike their neighbours.
//!
//! At each point of a contour the signed distances of the two slices below and the two above, with the slice's own 0, are fitted by a parabola in the
//! height (least squares; for even slices the weights of Savitzky and Golay, -3, 12, 17, 12, -3 of 35). The point moves across the
//! contour by the parabola's value there: what the slices have in common stays, curvature along the stack too, and errors that they do not share are
//! reduced to 0.7. What departs by much more than `size` is shape and not error: a departure `d` counts as `d / (1 + (d / size)^2)`. Where there are
//! fewer than two slices on a side nothing is moved.
//!
//! **Measured** on the phantom's femur with errors of 0.2 mm that slices do not share, `size` 0.4 mm: 0.142 mm rms become 0.113 in slices of 1 mm, 0.140
//! become 0.115 at 2 mm, 0.142 become 0.129 at 3 mm, and the error of the normals falls by a half, a third and a quarter. Without such errors it costs: 0.005 mm in
//! the median at 2 mm, 0.02 mm at 4 mm, and real labels, which share their errors, are left 0.01 to 0.03 mm farther off. So it is off
//! unless asked for.

use biplane_geometry::Vector3;
use nalgebra::Matrix3;

use crate::layer::{Grid, Layer};
use crate::plane::Plane;
use crate::stack::{Contour, Slice};

/// No point moves by more cells than this, whatever `size` is: the grid goes no farther.
const MOST_CELLS: f64 = 2.0;
/// Slices on either side.
const SIDE: usize = 2;

/// The slices with their contours moved. `layers` are the same slices on the grid.
pub(crate) fn smoothed(slices: &[&Slice], layers: &[Layer], grid: &Grid, size: f64) -> Vec<Slice> {
    let mut planes: Vec<Option<Plane>> = vec![None; layers.len()];
    let mut moved = Vec::with_capacity(slices.len());
    for (k, slice) in slices.iter().enumerate() {
        let mut slice = (*slice).clone();
        let around = k.saturating_sub(SIDE)..(k + SIDE + 1).min(layers.len());
        let whole =
            around.len() == 2 * SIDE + 1 && layers[around.clone()].iter().all(|l| !l.regions.is_empty());
        if whole {
            if let Some(past) = around.start.checked_sub(1) {
                planes[past] = None;
            }
            let near: Vec<&Plane> = planes[around.clone()]
                .iter_mut()
                .zip(&layers[around.clone()])
                .map(|(plane, layer)| {
                    &*plane.get_or_insert_with(|| {
                        let mut plane = Plane::default();
                        plane.near(grid, layer.sides.iter().copied(), &layer.runs);
                        plane.complete(grid);
                        plane
                    })
                })
                .collect();
            let weights =
                weights(&layers[around].iter().map(|l| l.height - slice.height).collect::<Vec<f64>>());
            for contour in &mut slice.contours {
                let points = contour.points.iter().enumerate().map(|(n, p)| {
                    let at = grid.in_cells(*p).map(|v| v as f32);
                    let distance =
                        |(plane, w): (&&Plane, &f64)| f64::from(plane.between(grid, at[0], at[1])) * w;
                    let off = grid.cell * near.iter().zip(&weights).map(distance).sum::<f64>();
                    let off = (off / (1.0 + (off / size).powi(2)))
                        .clamp(-MOST_CELLS * grid.cell, MOST_CELLS * grid.cell);
                    let mut normal = across(&contour.points, n);
                    let beside = |s: f64| {
                        let [x, y] = [0, 1].map(|a| at[a] + (s * normal[a]) as f32);
                        near[SIDE].between(grid, x, y)
                    };
                    if beside(0.5) < beside(-0.5) {
                        normal = normal.map(|v| -v);
                    }
                    let [x, y] = normal;
                    [p[0] - off * x, p[1] - off * y]
                });
                *contour = Contour::of(contour.number, points.collect());
            }
        }
        moved.push(slice);
    }
    moved
}

/// What each distance counts in the parabola's value at height 0; that slice's own distance is 0.
fn weights(heights: &[f64]) -> Vec<f64> {
    let scale = heights.iter().fold(f64::MIN_POSITIVE, |most, h| most.max(h.abs()));
    let row = |h: &f64| Vector3::new(1.0, h / scale, (h / scale).powi(2));
    let normal: Matrix3<f64> = heights.iter().map(row).map(|r| r * r.transpose()).sum();
    let first = normal.try_inverse().map_or(Vector3::zeros(), |inverse| inverse.column(0).into_owned());
    let own = |h: &f64| if *h == 0.0 { 0.0 } else { 1.0 };
    heights.iter().map(|h| own(h) * row(h).dot(&first)).collect()
}

/// The direction to the right of a contour's course: out of the bone, if the contour runs in its sense.
fn across(points: &[[f64; 2]], n: usize) -> [f64; 2] {
    let count = points.len();
    let (p, q) = (points[(n + count - 1) % count], points[(n + 1) % count]);
    let (x, y) = (q[0] - p[0], q[1] - p[1]);
    let length = x.hypot(y);
    if length > 0.0 { [y / length, -x / length] } else { [0.0; 2] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_slices_have_the_weights_of_savitzky_and_golay() {
        let found = weights(&[-4.0, -2.0, 0.0, 2.0, 4.0]);
        for (w, wanted) in found.iter().zip([-3.0, 12.0, 0.0, 12.0, -3.0]) {
            assert!((w * 35.0 - wanted).abs() < 1e-9, "{found:?}");
        }
        // Uneven ones keep parabolas as well.
        let heights = [-5.0, -1.0, 0.0, 0.5, 3.0];
        let value: f64 =
            heights.iter().zip(weights(&heights)).map(|(h, w)| (2.0 * h - 0.7 * h * h) * w).sum();
        assert!(value.abs() < 1e-12, "{value}");
    }
}
