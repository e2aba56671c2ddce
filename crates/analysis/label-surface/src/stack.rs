//! A volume as the methods here see it: three axes with the places of the voxels along each in mm, checked once.
//!
//! Along rows and columns voxels are evenly spaced; slices lie behind each other along their normal, at distances that may differ
//! and shifted against each other as the volume has them.

use biplane_artifact::Volume;
use biplane_geometry::{Point3, Vector3};

use crate::LabelSurfaceError;

/// Places of a checked volume.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Stack {
    /// Columns, rows, slices.
    pub size: [usize; 3],
    /// Along rows, along columns, from slice to slice: the place of each voxel, mm from the first one, increasing.
    pub places_mm: [Vec<f64>; 3],
    /// Distance of neighbouring voxels along rows and columns, mm.
    pub pixel_mm: [f64; 2],
    /// Unit vectors along rows and columns.
    along: [Vector3; 2],
    /// Unit normal of the slices, towards the next one.
    normal: Vector3,
    origins: Vec<Point3>,
}

impl Stack {
    /// # Errors
    /// A volume whose samples, steps or slices do not make a stack.
    pub fn of(volume: &Volume) -> Result<Self, LabelSurfaceError> {
        let size = [volume.columns, volume.rows, volume.origins_mm.len()];
        let voxels = size.iter().try_fold(1_usize, |n, &side| n.checked_mul(side));
        if voxels != Some(volume.samples.len()) || volume.samples.is_empty() {
            return Err(LabelSurfaceError::Size { size, samples: volume.samples.len() });
        }
        let [u, v] = [volume.column_step_mm, volume.row_step_mm].map(Vector3::from);
        let pixel_mm = [u.norm(), v.norm()];
        let skew = u.dot(&v) / (pixel_mm[0] * pixel_mm[1]);
        if !pixel_mm.iter().all(|mm| (1e-6..1e3).contains(mm)) || !(-1e-3..1e-3).contains(&skew) {
            return Err(LabelSurfaceError::Steps { column: volume.column_step_mm, row: volume.row_step_mm });
        }
        let origins: Vec<Point3> = volume.origins_mm.iter().map(|o| Point3::from(*o)).collect();
        let way = |n: &Vector3| origins.iter().map(|o| (o - origins[0]).dot(n)).collect::<Vec<f64>>();
        let mut normal = u.cross(&v).normalize();
        let mut heights = way(&normal);
        if heights.last().is_some_and(|h| *h < 0.0) {
            normal = -normal;
            heights = way(&normal);
        }
        // Not a number is no order either.
        if let Some(slice) = heights.windows(2).position(|w| !(1e-6..1e5).contains(&(w[1] - w[0]))) {
            return Err(LabelSurfaceError::Order { slice: slice + 1 });
        }
        if !origins.iter().all(|o| o.coords.amax() < 1e6) {
            return Err(LabelSurfaceError::Order { slice: 0 });
        }
        let even = |a: usize| (0..size[a]).map(|n| n as f64 * pixel_mm[a]).collect();
        Ok(Self {
            size,
            places_mm: [even(0), even(1), heights],
            pixel_mm,
            along: [u / pixel_mm[0], v / pixel_mm[1]],
            normal,
            origins,
        })
    }

    /// Distance of a voxel to those beside it along an axis, mm: its thickness, for want of another. One slice alone is as thick
    /// as the larger side of a pixel.
    pub fn thickness_mm(&self, axis: usize, n: usize) -> f64 {
        let heights = &self.places_mm[2];
        let (low, high) = (n.saturating_sub(1), (n + 1).min(heights.len().saturating_sub(1)));
        match self.pixel_mm.get(axis) {
            Some(pixel) => *pixel,
            None if high > low => (heights[high] - heights[low]) / (high - low) as f64,
            None => self.pixel_mm[0].max(self.pixel_mm[1]),
        }
    }

    /// Volume of a voxel of a slice: its pixel times the slice's thickness, mm^3.
    pub fn voxel_mm3(&self, slice: usize) -> f64 {
        self.pixel_mm[0] * self.pixel_mm[1] * self.thickness_mm(2, slice)
    }

    /// The place of a voxel along an axis, also beyond the volume's ends, mm.
    pub fn place_mm(&self, axis: usize, n: isize) -> f64 {
        let places = &self.places_mm[axis];
        let last = places.len().saturating_sub(1);
        match usize::try_from(n) {
            Ok(n) if n <= last => places[n],
            Ok(n) => places[last] + (n - last) as f64 * self.thickness_mm(axis, last),
            Err(_) => places[0] + n as f64 * self.thickness_mm(axis, 0),
        }
    }

    /// A place along the three axes, mm from the first voxel, in the scanner's frame. Between slices it is shifted as they are.
    pub fn point(&self, [x, y, z]: [f64; 3]) -> Point3 {
        let in_plane = self.along[0] * x + self.along[1] * y;
        let heights = &self.places_mm[2];
        let count = heights.len();
        if count < 2 {
            return self.origins[0] + in_plane + self.normal * z;
        }
        let below = self.slice_below(z).min(count - 2);
        let part = (z - heights[below]) / (heights[below + 1] - heights[below]);
        self.origins[below] + (self.origins[below + 1] - self.origins[below]) * part + in_plane
    }

    /// How high a point is above the first slice, mm.
    pub fn height_mm(&self, point: &Point3) -> f64 {
        (point - self.origins[0]).dot(&self.normal)
    }

    /// The last slice that is not above a height; the first one for heights below it.
    pub fn slice_below(&self, height: f64) -> usize {
        self.places_mm[2].partition_point(|h| *h <= height + 1e-9).saturating_sub(1)
    }

    /// Whether rows, columns and the way from slice to slice are right-handed.
    pub fn right_handed(&self) -> bool {
        self.along[0].cross(&self.along[1]).dot(&self.normal) > 0.0
    }
}
