//! Where the voxels of a regular grid are, checked; and its samples put there.

use biplane_artifact::Volume;
use nalgebra::{Matrix3, Vector3};

use super::samples::{Layout, Samples};
use super::{Source, VolumeFileError, VolumeNote};

/// Steps between voxels that are not those of an image of a body, mm.
const STEP_MM: std::ops::RangeInclusive<f64> = 1e-4..=1e3;
/// Coordinates beyond this are none of a scanner, mm.
const FAR_MM: f64 = 1e6;
/// Angles smaller than this come of the few digits that headers have, degrees.
const SQUARE_DEG: f64 = 0.1;

/// A regular grid: left-posterior-superior, mm.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grid {
    /// Centre of the first voxel.
    pub(super) origin: Vector3<f64>,
    /// From a voxel to the next one along the file's first, second and third axis.
    pub(super) steps: [Vector3<f64>; 3],
}

impl Grid {
    /// Refuses what is no grid, and notes where it is not a right-angled one.
    pub(super) fn check(&self, source: Source<'_>) -> Result<Vec<VolumeNote>, VolumeFileError> {
        let [column, row, slice] = self.steps;
        for (axis, step) in self.steps.iter().enumerate() {
            if !STEP_MM.contains(&step.norm()) {
                return Err(source.damaged(format!(
                    "voxels along axis {axis}, counted from 0, would be {} mm apart",
                    step.norm()
                )));
            }
        }
        if !self.origin.iter().all(|v| v.abs() <= FAR_MM) {
            let [x, y, z] = self.origin.into();
            return Err(source.damaged(format!("its first voxel would be at ({x}, {y}, {z}) mm")));
        }
        let unit = Matrix3::from_columns(&self.steps.map(|s| s.normalize()));
        if unit.determinant().abs() < 1e-3 {
            return Err(source.damaged("its three axes lie in a plane"));
        }
        Ok(squareness(column, row, slice))
    }

    /// The volume of these samples; `layout`'s sizes were checked.
    pub(super) fn volume(&self, layout: &Layout, samples: Samples) -> Volume {
        let [columns, rows, slices] = layout.sizes.map(|size| size as usize);
        let [column, row, slice] = self.steps;
        Volume {
            columns,
            rows,
            column_step_mm: column.into(),
            row_step_mm: row.into(),
            origins_mm: (0..slices).map(|k| (self.origin + slice * k as f64).into()).collect(),
            samples: samples.levels,
        }
    }
}

/// What is not at right angles: rows and columns, or the stack of the slices and their normal.
pub(super) fn squareness(column: Vector3<f64>, row: Vector3<f64>, slice: Vector3<f64>) -> Vec<VolumeNote> {
    let mut notes = Vec::new();
    let skew = (column.angle(&row).to_degrees() - 90.0).abs();
    if skew > SQUARE_DEG {
        notes.push(VolumeNote::Skewed { degrees: skew });
    }
    let tilt = slice.angle(&column.cross(&row)).to_degrees();
    let tilt = tilt.min(180.0 - tilt);
    if tilt > SQUARE_DEG {
        notes.push(VolumeNote::Tilted { degrees: tilt });
    }
    notes
}
