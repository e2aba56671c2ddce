//! A grid of slices in space, and how much of each of its voxels a solid fills.
//!
//! A voxel of a slice stack is a box: the in-plane spacing wide, and as thick as the slice, which may be more or less than
//! the distance of neighbouring slices (overlaps and gaps). The fraction of it inside a solid is found on cells of at most
//! [`CELL_MM`]: the solid's function is taken at a cell's corners, between them it is trilinear, and each of 4 x 4 x 4 parts
//! of the cell counts by how far its middle is from the surface (for a surface along the grid's axes this is exact).
//! Voxels farther from the surface than their own half diagonal are decided without that, and blocks of them at once.

use biplane_geometry::{Model, Point3, Rigid, Vector3};

use crate::Solid;

/// The scanner's own frame, mm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scanner {}

/// Largest side of a cell over which a solid's function is taken as trilinear, mm.
const CELL_MM: f64 = 0.6;
/// Parts of a cell's side.
const PARTS: usize = 4;
/// Voxels of a block that is first decided as a whole, along each axis.
const BLOCK: usize = 16;
/// Most voxels of a grid: 2^28, half a gigabyte of samples.
const MOST_VOXELS: usize = 1 << 28;

/// Where the voxels of a slice stack lie. Voxel `(i, j, k)` has its **centre** at
/// `origin + i spacing[0] axes[0] + j spacing[1] axes[1] + k spacing[2] axes[2]` in the scanner's frame; `k` counts slices.
#[derive(Debug, Clone, PartialEq)]
pub struct SliceGrid {
    /// Columns and rows of a slice, and slices.
    pub size: [usize; 3],
    /// Distance of neighbouring centres along a row, along a column, and of slices, mm.
    pub spacing_mm: [f64; 3],
    /// How thick a slice is, mm.
    pub thickness_mm: f64,
    /// Centre of the first voxel, mm.
    pub origin: Point3,
    /// Unit vectors at right angles: along a row, along a column, from slice to slice.
    pub axes: [Vector3; 3],
}

/// Why a grid cannot be filled.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GridError {
    /// No voxel, or more than can be kept.
    #[error("a stack of {size:?} voxels; each number has to be at least 1 and their product at most 2^28")]
    Size {
        /// Columns, rows, slices.
        size: [usize; 3],
    },
    /// A spacing or the thickness is not a length.
    #[error("spacing {spacing_mm:?} mm, slices {thickness_mm} mm thick; all have to be positive and finite")]
    Spacing {
        /// Along a row, along a column, of slices.
        spacing_mm: [f64; 3],
        /// Of a slice.
        thickness_mm: f64,
    },
    /// The axes are not of length 1 and at right angles, or the origin is not finite.
    #[error("axes {axes:?} from {origin}; they have to be of length 1 and at right angles, within 1e-9")]
    Axes {
        /// As given.
        axes: [Vector3; 3],
        /// As given.
        origin: Point3,
    },
}

impl SliceGrid {
    /// Slices at right angles to the scanner's axis `across` (0 sagittal, 1 coronal, 2 axial where x is to the side, y to the
    /// front and z up) that cover a box with `margin_mm` around it: slice distance and thickness `slice_mm`, `pixel_mm` in the
    /// plane. Rows run along the next axis, columns along the one after it, so the three are right-handed.
    pub fn covering(
        bounds: (Point3, Point3),
        margin_mm: f64,
        across: usize,
        pixel_mm: f64,
        slice_mm: f64,
    ) -> Self {
        let order = [(across + 1) % 3, (across + 2) % 3, across % 3];
        let spacing_mm = [pixel_mm, pixel_mm, slice_mm];
        let middle = nalgebra::center(&bounds.0, &bounds.1);
        let mut origin = middle;
        let mut size = [0; 3];
        for axis in 0..3 {
            let extent = bounds.1[order[axis]] - bounds.0[order[axis]] + 2.0 * margin_mm;
            size[axis] = (extent / spacing_mm[axis]).ceil().max(1.0) as usize;
            origin[order[axis]] -= (size[axis] as f64 - 1.0) / 2.0 * spacing_mm[axis];
        }
        let axes = order.map(|axis| Vector3::ith(axis, 1.0));
        Self { size, spacing_mm, thickness_mm: slice_mm, origin, axes }
    }

    /// Number of voxels.
    ///
    /// # Errors
    /// Where the grid is none: see [`GridError`].
    pub fn voxels(&self) -> Result<usize, GridError> {
        let count =
            self.size.iter().try_fold(1_usize, |n, &side| n.checked_mul(side).filter(|&n| n <= MOST_VOXELS));
        let lengths = self.spacing_mm.iter().chain([&self.thickness_mm]);
        let orthonormal = (0..3).all(|i| {
            (0..3).all(|j| {
                let wanted = if i == j { 1.0 } else { 0.0 };
                (self.axes[i].dot(&self.axes[j]) - wanted).abs() < 1e-9
            })
        });
        match count {
            Some(n) if n > 0 => {
                if !lengths.into_iter().all(|l| l.is_finite() && *l > 0.0) {
                    let (spacing_mm, thickness_mm) = (self.spacing_mm, self.thickness_mm);
                    Err(GridError::Spacing { spacing_mm, thickness_mm })
                } else if !orthonormal || !self.origin.coords.iter().all(|c| c.is_finite()) {
                    Err(GridError::Axes { axes: self.axes, origin: self.origin })
                } else {
                    Ok(n)
                }
            }
            _ => Err(GridError::Size { size: self.size }),
        }
    }

    /// Volume of a voxel's box, mm^3.
    pub fn voxel_mm3(&self) -> f64 {
        self.spacing_mm[0] * self.spacing_mm[1] * self.thickness_mm
    }

    /// The point at a place counted in voxels (0 is the centre of the first one), scanner frame, mm.
    pub fn position(&self, place: [f64; 3]) -> Point3 {
        (0..3).fold(self.origin, |p, axis| p + self.axes[axis] * (place[axis] * self.spacing_mm[axis]))
    }

    /// Fraction of each voxel inside a solid, 0 to 1; rows run fastest, then columns, then slices.
    ///
    /// # Errors
    /// Where the grid is none: see [`GridError`].
    pub fn filled(
        &self,
        solid: &dyn Solid,
        scanner_from_model: &Rigid<Scanner, Model>,
    ) -> Result<Vec<f32>, GridError> {
        let mut filled = vec![0.0; self.voxels()?];
        self.fill(solid, scanner_from_model, [0.0; 3], |voxel, fraction| filled[voxel] = fraction as f32);
        Ok(filled)
    }

    /// Calls `each` with every voxel that the solid touches, displaced by `shift` voxels, and the fraction inside.
    pub(crate) fn fill(
        &self,
        solid: &dyn Solid,
        scanner_from_model: &Rigid<Scanner, Model>,
        shift: [f64; 3],
        mut each: impl FnMut(usize, f64),
    ) {
        let model_from_scanner = scanner_from_model.inverse();
        let to_model = |v: Vector3| model_from_scanner.rotation() * v;
        let steps: [Vector3; 3] = std::array::from_fn(|a| to_model(self.axes[a] * self.spacing_mm[a]));
        let first = model_from_scanner.transform(&self.position(shift.map(|s| -s)));
        let box_mm = [self.spacing_mm[0], self.spacing_mm[1], self.thickness_mm];
        let sides: [Vector3; 3] = std::array::from_fn(|a| to_model(self.axes[a] * box_mm[a]));
        let mut voxel = Voxel::new(solid, sides, box_mm);
        let mut blocks = Vec::new();
        for k in (0..self.size[2]).step_by(BLOCK) {
            for j in (0..self.size[1]).step_by(BLOCK) {
                for i in (0..self.size[0]).step_by(BLOCK) {
                    let low = [i, j, k];
                    let high: [usize; 3] = std::array::from_fn(|a| (low[a] + BLOCK).min(self.size[a]));
                    blocks.push((low, high));
                }
            }
        }
        // A block is decided as a whole, or cut in two across its longest side.
        while let Some((low, high)) = blocks.pop() {
            let count: [usize; 3] = std::array::from_fn(|a| high[a] - low[a]);
            let middle =
                (0..3).fold(first, |p, a| p + steps[a] * (low[a] as f64 + (count[a] as f64 - 1.0) / 2.0));
            let half = (0..3)
                .map(|a| ((count[a] as f64 - 1.0) * self.spacing_mm[a] + box_mm[a]).powi(2))
                .sum::<f64>()
                .sqrt()
                / 2.0;
            let value = solid.value(&middle);
            if value > half {
                continue;
            }
            if value >= -half && count != [1; 3] {
                let longest = (0..3).fold(0, |a, b| {
                    let mm = |c: usize| count[c] as f64 * self.spacing_mm[c];
                    if count[a] == 1 || (count[b] > 1 && mm(b) > mm(a)) { b } else { a }
                });
                let cut = low[longest] + count[longest] / 2;
                let (mut below, mut above) = (high, low);
                below[longest] = cut;
                above[longest] = cut;
                blocks.extend([(low, below), (above, high)]);
                continue;
            }
            let fraction = if value < -half { 1.0 } else { voxel.fraction(&middle) };
            for k in low[2]..high[2] {
                for j in low[1]..high[1] {
                    let row = (k * self.size[1] + j) * self.size[0];
                    for i in low[0]..high[0] {
                        each(row + i, fraction);
                    }
                }
            }
        }
    }
}

/// The box of one voxel, to be put anywhere in a solid's frame.
struct Voxel<'a> {
    solid: &'a dyn Solid,
    /// From one corner to the next of a cell.
    steps: [Vector3; 3],
    /// Cells along each side.
    cells: [usize; 3],
    corners: Vec<f64>,
}

impl<'a> Voxel<'a> {
    fn new(solid: &'a dyn Solid, sides: [Vector3; 3], box_mm: [f64; 3]) -> Self {
        let cells = box_mm.map(|mm| (mm / CELL_MM).ceil().clamp(1.0, 32.0) as usize);
        let steps = std::array::from_fn(|a| sides[a] / cells[a] as f64);
        Self { solid, steps, cells, corners: Vec::new() }
    }

    /// The part of the box about `centre` (model frame) that is inside the solid.
    fn fraction(&mut self, centre: &Point3) -> f64 {
        let cells = self.cells;
        let low = (0..3).fold(*centre, |p, a| p - self.steps[a] * (cells[a] as f64 / 2.0));
        self.corners.clear();
        for k in 0..=cells[2] {
            for j in 0..=cells[1] {
                let row = low + self.steps[2] * k as f64 + self.steps[1] * j as f64;
                for i in 0..=cells[0] {
                    self.corners.push(self.solid.value(&(row + self.steps[0] * i as f64)));
                }
            }
        }
        let at = |i: usize, j: usize, k: usize| self.corners[(k * (cells[1] + 1) + j) * (cells[0] + 1) + i];
        let mut sum = 0.0;
        for k in 0..cells[2] {
            for j in 0..cells[1] {
                for i in 0..cells[0] {
                    sum +=
                        inside_cell(std::array::from_fn(|c| at(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2))));
                }
            }
        }
        sum / cells.iter().product::<usize>() as f64
    }
}

/// The part of a cell where the function that is trilinear between the eight corners is negative; corner `c` lies at
/// `c & 1`, `c >> 1 & 1`, `c >> 2` along the three axes.
fn inside_cell(f: [f64; 8]) -> f64 {
    if f.iter().all(|&v| v >= 0.0) {
        return 0.0;
    }
    if f.iter().all(|&v| v <= 0.0) {
        return 1.0;
    }
    let mean = |bit: usize, set: bool| {
        f.iter().enumerate().filter(|(c, _)| (c >> bit & 1 == 1) == set).map(|(_, v)| v).sum::<f64>() / 4.0
    };
    // How far the function changes over one part, along the three axes together.
    let change: f64 =
        (0..3).map(|bit| (mean(bit, true) - mean(bit, false)).abs()).sum::<f64>() / PARTS as f64;
    let change = change.max(f64::MIN_POSITIVE);
    let place = |part: usize| (part as f64 + 0.5) / PARTS as f64;
    let blend = |a: f64, b: f64, s: f64| a + (b - a) * s;
    let mut sum = 0.0;
    for k in 0..PARTS {
        let plane: [f64; 4] = std::array::from_fn(|c| blend(f[c], f[c + 4], place(k)));
        for j in 0..PARTS {
            let line: [f64; 2] = std::array::from_fn(|c| blend(plane[c], plane[c + 2], place(j)));
            for i in 0..PARTS {
                sum += (0.5 - blend(line[0], line[1], place(i)) / change).clamp(0.0, 1.0);
            }
        }
    }
    sum / (PARTS * PARTS * PARTS) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Ball;
    use approx::assert_relative_eq;
    use nalgebra::UnitQuaternion;

    /// Everything below a plane through `point` with unit normal `normal`.
    struct HalfSpace(Point3, Vector3);

    impl Solid for HalfSpace {
        fn value(&self, point: &Point3) -> f64 {
            (point - self.0).dot(&self.1)
        }
        fn bounds(&self) -> (Point3, Point3) {
            (Point3::from(Vector3::repeat(-1e6)), Point3::from(Vector3::repeat(1e6)))
        }
    }

    fn grid(size: [usize; 3], spacing_mm: [f64; 3], thickness_mm: f64) -> SliceGrid {
        SliceGrid {
            size,
            spacing_mm,
            thickness_mm,
            origin: Point3::origin(),
            axes: std::array::from_fn(|a| Vector3::ith(a, 1.0)),
        }
    }

    #[test]
    fn fractions_add_up_to_the_volume_however_the_slices_lie() {
        let ball = Ball { centre: Point3::new(3.0, -41.0, 12.0), radius: 21.3 };
        let volume = 4.0 / 3.0 * std::f64::consts::PI * ball.radius.powi(3);
        let tilted =
            Rigid::new(UnitQuaternion::from_euler_angles(0.3, -0.5, 1.0), Vector3::new(9.0, 8.0, 7.0));
        for (pose, across, pixel, slice) in
            [(Rigid::identity(), 0, 0.5, 1.0), (tilted, 1, 0.625, 4.0), (tilted, 2, 0.365, 0.7)]
        {
            let c = pose.transform(&ball.centre);
            let around = (c - Vector3::repeat(22.0), c + Vector3::repeat(22.0));
            let grid = SliceGrid::covering(around, 1.0, across, pixel, slice);
            let sum: f64 = grid.filled(&ball, &pose).unwrap().iter().map(|&f| f64::from(f)).sum();
            assert_relative_eq!(sum * grid.voxel_mm3(), volume, max_relative = 5e-4);
        }
    }

    #[test]
    fn a_plane_along_the_slices_cuts_them_exactly() {
        let plane = HalfSpace(Point3::new(0.0, 0.0, 7.3), Vector3::z());
        // Slices 2 mm thick, 3 mm apart: slice 2 reaches from 5 to 7 mm, so the plane at 7.3 is in the gap above it.
        let column = grid([1, 1, 5], [1.0, 1.0, 3.0], 2.0);
        let filled = column.filled(&plane, &Rigid::identity()).unwrap();
        assert_eq!(filled, [1.0, 1.0, 1.0, 0.0, 0.0]);
        let plane = HalfSpace(Point3::new(0.0, 0.0, 6.3), Vector3::z());
        let filled = column.filled(&plane, &Rigid::identity()).unwrap();
        assert_relative_eq!(filled[2], 0.65, epsilon = 1e-6);
        // The same turned by 90 degrees, the plane along x.
        let plane = HalfSpace(Point3::new(2.1, 0.0, 0.0), Vector3::x());
        let filled = grid([5, 1, 1], [1.0; 3], 1.0).filled(&plane, &Rigid::identity()).unwrap();
        assert_relative_eq!(filled[2], 0.6, epsilon = 1e-6);
    }

    #[test]
    fn a_thick_slice_is_the_mean_of_thin_ones() {
        let ball = Ball { centre: Point3::new(10.2, 9.7, 11.1), radius: 8.4 };
        let thin = grid([20, 20, 24], [1.0; 3], 1.0).filled(&ball, &Rigid::identity()).unwrap();
        let mut thick = grid([20, 20, 6], [1.0, 1.0, 4.0], 4.0);
        thick.origin.z = 1.5;
        let thick = thick.filled(&ball, &Rigid::identity()).unwrap();
        for (voxel, fraction) in thick.iter().enumerate() {
            let (slice, within) = (voxel / 400, voxel % 400);
            let mean: f32 = (0..4).map(|k| thin[(4 * slice + k) * 400 + within]).sum::<f32>() / 4.0;
            assert_relative_eq!(mean, *fraction, epsilon = 2e-3);
        }
    }

    #[test]
    fn what_is_no_grid_is_refused() {
        let good = grid([4, 5, 6], [1.0; 3], 1.0);
        assert_eq!(good.voxels(), Ok(120));
        for size in [[0, 5, 6], [usize::MAX, 2, 2], [1 << 10, 1 << 10, 1 << 10]] {
            assert_eq!(SliceGrid { size, ..good.clone() }.voxels(), Err(GridError::Size { size }));
        }
        let flat = SliceGrid { thickness_mm: 0.0, ..good.clone() };
        assert!(matches!(flat.voxels(), Err(GridError::Spacing { .. })));
        let skew = SliceGrid { axes: [Vector3::x(), Vector3::new(0.1, 1.0, 0.0), Vector3::z()], ..good };
        assert!(matches!(skew.voxels(), Err(GridError::Axes { .. })));
    }
}
