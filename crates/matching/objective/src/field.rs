//! Signed distances from a surface on a grid, between its points by a cubic of four in each direction (R. Keys, "Cubic convolution interpolation for
//! digital image processing", 1981), with their gradient.
//!
//! **Guaranteed:** value and gradient belong together and are continuous within the box; beyond it the distance of the box is added, so that the value
//! goes on growing. **Not guaranteed:** more than the grid holds. Near a smooth surface the error is a small part of a cell (a test measures it on a
//! ball); across a sheet thinner than two cells, and at sharp edges, it is a fair part of one.

use biplane_geometry::{Mesh, Point3, Vector3};
use biplane_surface::Surface;

/// Cells along the longest side of the box.
pub const CELLS: usize = 72;
/// Cells beyond the body's box on each side: enough for the cubic, and for rays that pass close by.
const MARGIN: usize = 4;

/// Signed distances, negative inside. Made once a mesh.
#[derive(Debug, Clone)]
pub struct DistanceField {
    first: Point3,
    cell: f64,
    counts: [usize; 3],
    /// In single precision, rounded by less than 1e-5 mm for any body; x runs fastest.
    values: Vec<f32>,
}

impl DistanceField {
    /// From a mesh, with 72 cells along its longest side.
    pub fn new(mesh: &Mesh) -> Self {
        Self::with_cells(mesh, CELLS)
    }

    /// With so many cells along its longest side.
    pub fn with_cells(mesh: &Mesh, cells: usize) -> Self {
        let surface = Surface::new(mesh);
        let (low, high) = mesh.bounding_box();
        let cell = ((high - low).amax() / cells.max(1) as f64).max(1e-6);
        let counts = [0, 1, 2].map(|k| ((high[k] - low[k]) / cell).ceil() as usize + 1 + 2 * MARGIN);
        let first = low - Vector3::repeat(MARGIN as f64 * cell);
        let mut values = Vec::with_capacity(counts.iter().product());
        for z in 0..counts[2] {
            for y in 0..counts[1] {
                for x in 0..counts[0] {
                    let place = first + Vector3::new(x as f64, y as f64, z as f64) * cell;
                    values.push(surface.signed_distance(&place) as f32);
                }
            }
        }
        Self { first, cell, counts, values }
    }

    /// Side of a cell, mm.
    pub fn cell_mm(&self) -> f64 {
        self.cell
    }

    /// The middle of the box (model, mm), and how far its corners are from there.
    pub fn ball(&self) -> (Point3, f64) {
        let half = Vector3::from_fn(|k, _| (self.counts[k] - 1) as f64) * (self.cell / 2.0);
        (self.first + half, half.norm())
    }

    /// Place in cells within the part that the cubic reaches, and how far outside of it, mm.
    fn inside(&self, at: &Point3) -> (Vector3, Vector3) {
        let place = (at - self.first) / self.cell;
        let within = Vector3::from_fn(|k, _| {
            // Not a number counts as the beginning.
            place[k].max(1.0).min(self.counts[k] as f64 - 2.0 - 1e-9)
        });
        (within, (place - within) * self.cell)
    }

    fn at(&self, [x, y, z]: [usize; 3]) -> f64 {
        f64::from(self.values[(z * self.counts[1] + y) * self.counts[0] + x])
    }

    /// The distance at a place (model, mm), linear between the eight points around it: quicker, for a first look.
    pub fn linear(&self, at: &Point3) -> f64 {
        let (within, outside) = self.inside(at);
        let cell = within.map(f64::floor);
        let (i, f) = (cell.map(|v| v as usize), within - cell);
        let mut sum = 0.0;
        for corner in 0..8_usize {
            let up = [corner & 1, corner >> 1 & 1, corner >> 2];
            let weight: f64 = (0..3).map(|k| if up[k] == 1 { f[k] } else { 1.0 - f[k] }).product();
            sum += weight * self.at([i.x + up[0], i.y + up[1], i.z + up[2]]);
        }
        sum + outside.norm()
    }

    /// The distance at a place (model, mm) and its gradient.
    pub fn cubic(&self, at: &Point3) -> (f64, Vector3) {
        let (within, outside) = self.inside(at);
        let cell = within.map(f64::floor);
        let weights: [_; 3] = std::array::from_fn(|k| keys(within[k] - cell[k]));
        let i = cell.map(|v| v as usize - 1);
        let (mut value, mut gradient) = (0.0, Vector3::zeros());
        for z in 0..4 {
            let (mut plane, mut plane_x, mut plane_y) = (0.0, 0.0, 0.0);
            for y in 0..4 {
                let from = ((i.z + z) * self.counts[1] + i.y + y) * self.counts[0] + i.x;
                let (mut line, mut slope) = (0.0, 0.0);
                for (x, v) in self.values[from..from + 4].iter().enumerate() {
                    line += weights[0].0[x] * f64::from(*v);
                    slope += weights[0].1[x] * f64::from(*v);
                }
                plane += weights[1].0[y] * line;
                plane_x += weights[1].0[y] * slope;
                plane_y += weights[1].1[y] * line;
            }
            value += weights[2].0[z] * plane;
            gradient +=
                Vector3::new(weights[2].0[z] * plane_x, weights[2].0[z] * plane_y, weights[2].1[z] * plane);
        }
        gradient /= self.cell;
        let far = outside.norm();
        if far > 0.0 {
            // Across a side that was passed the place within does not move.
            for k in 0..3 {
                if outside[k] != 0.0 {
                    gradient[k] = outside[k] / far;
                }
            }
        }
        (value + far, gradient)
    }
}

/// Weights of four points for a place so far from the second to the third, and their derivatives.
fn keys(t: f64) -> ([f64; 4], [f64; 4]) {
    let (t2, t3) = (t * t, t * t * t);
    (
        [
            -0.5 * t3 + t2 - 0.5 * t,
            1.5 * t3 - 2.5 * t2 + 1.0,
            -1.5 * t3 + 2.0 * t2 + 0.5 * t,
            0.5 * t3 - 0.5 * t2,
        ],
        [-1.5 * t2 + 2.0 * t - 0.5, 4.5 * t2 - 5.0 * t, -4.5 * t2 + 4.0 * t + 0.5, 1.5 * t2 - t],
    )
}
