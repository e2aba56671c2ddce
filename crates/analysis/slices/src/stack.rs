//! A volume as the methods here see it: a box of voxels with its steps in mm, checked once.

use biplane_artifact::Volume;
use nalgebra::Vector3;

use crate::SlicesError;

/// Sizes of a checked volume.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Stack {
    /// Columns, rows, slices.
    pub size: [usize; 3],
    /// Distance of neighbouring voxels along a row and along a column, mm.
    pub pixel_mm: [f64; 2],
    /// Place of each slice along the normal, mm, increasing.
    pub heights_mm: Vec<f64>,
}

impl Stack {
    /// # Errors
    /// A volume whose samples, steps or slices do not make a stack.
    pub fn of(volume: &Volume) -> Result<Self, SlicesError> {
        let size = [volume.columns, volume.rows, volume.origins_mm.len()];
        let voxels = size.iter().try_fold(1_usize, |n, &side| n.checked_mul(side));
        if voxels != Some(volume.samples.len()) || volume.samples.is_empty() {
            return Err(SlicesError::Size { size, samples: volume.samples.len() });
        }
        if let Some(at) = volume.samples.iter().position(|s| !s.is_finite()) {
            return Err(SlicesError::Sample { slice: at / (size[0] * size[1]) });
        }
        let [u, v] = [volume.column_step_mm, volume.row_step_mm].map(Vector3::from);
        let pixel_mm = [u.norm(), v.norm()];
        let skew = u.dot(&v) / (pixel_mm[0] * pixel_mm[1]);
        if !pixel_mm.iter().all(|mm| (1e-6..1e3).contains(mm)) || !(-1e-3..1e-3).contains(&skew) {
            return Err(SlicesError::Steps { column: volume.column_step_mm, row: volume.row_step_mm });
        }
        let normal = u.cross(&v).normalize();
        let along: Vec<f64> = volume.origins_mm.iter().map(|o| Vector3::from(*o).dot(&normal)).collect();
        // Counted from the first slice, so that they increase whichever way the slices were stacked.
        let heights_mm: Vec<f64> = match along.last() {
            Some(last) => along.iter().map(|h| (h - along[0]) * (last - along[0]).signum()).collect(),
            None => Vec::new(),
        };
        if !heights_mm.iter().all(|h| h.is_finite()) {
            return Err(SlicesError::Order { slice: 0 });
        }
        if let Some(slice) = heights_mm.windows(2).position(|w| w[1] - w[0] <= 1e-6) {
            return Err(SlicesError::Order { slice: slice + 1 });
        }
        Ok(Self { size, pixel_mm, heights_mm })
    }

    /// Voxels in a slice.
    pub fn slice_voxels(&self) -> usize {
        self.size[0] * self.size[1]
    }

    /// All voxels.
    pub fn voxels(&self) -> usize {
        self.slice_voxels() * self.size[2]
    }

    /// Place of a voxel in the samples.
    pub fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.size[1] + j) * self.size[0] + i
    }

    /// The voxel at a place in the samples.
    pub fn place(&self, index: usize) -> [usize; 3] {
        let [columns, rows, _] = self.size;
        [index % columns, index / columns % rows, index / (columns * rows)]
    }

    /// Places in the samples of the (up to six) neighbours across a voxel's faces.
    pub fn neighbours(&self, index: usize) -> impl Iterator<Item = usize> + use<> {
        let place = self.place(index);
        let steps = [1, self.size[0], self.slice_voxels()];
        let size = self.size;
        (0..3).flat_map(move |a| {
            let below = (place[a] > 0).then(|| index - steps[a]);
            let above = (place[a] + 1 < size[a]).then(|| index + steps[a]);
            [below, above].into_iter().flatten()
        })
    }

    /// Distance of a slice to the ones beside it, mm: its thickness, for want of another. One slice alone counts as a pixel.
    pub fn thickness_mm(&self, k: usize) -> f64 {
        let h = &self.heights_mm;
        let (low, high) = (k.saturating_sub(1), (k + 1).min(h.len().saturating_sub(1)));
        if high > low {
            (h[high] - h[low]) / (high - low) as f64
        } else {
            self.pixel_mm[0].max(self.pixel_mm[1])
        }
    }

    /// The part from `low` up to but without `high`.
    pub fn part(&self, low: [usize; 3], high: [usize; 3]) -> Self {
        Self {
            size: std::array::from_fn(|a| high[a] - low[a]),
            pixel_mm: self.pixel_mm,
            heights_mm: self.heights_mm[low[2]..high[2]].to_vec(),
        }
    }

    /// The values of [`Stack::part`].
    pub fn cut<T: Copy>(&self, values: &[T], low: [usize; 3], high: [usize; 3]) -> Vec<T> {
        let rows = (low[2]..high[2]).flat_map(|k| (low[1]..high[1]).map(move |j| [low[0], j, k]));
        rows.flat_map(|first| {
            let at = self.index(first);
            values[at..at + high[0] - low[0]].iter().copied()
        })
        .collect()
    }

    /// Smallest box, as `low` and `high` without its end, that holds all voxels that are `true`, with `margin_mm` around it
    /// where the stack reaches so far; none where no voxel is.
    pub fn bounds(&self, mask: impl Fn(usize) -> bool, margin_mm: f64) -> Option<([usize; 3], [usize; 3])> {
        let (mut low, mut high) = (self.size, [0; 3]);
        for index in (0..self.voxels()).filter(|&v| mask(v)) {
            let place = self.place(index);
            for a in 0..3 {
                low[a] = low[a].min(place[a]);
                high[a] = high[a].max(place[a] + 1);
            }
        }
        if high[0] == 0 {
            return None;
        }
        for a in 0..2 {
            let margin = (margin_mm / self.pixel_mm[a]).ceil() as usize;
            low[a] = low[a].saturating_sub(margin);
            high[a] = high[a].saturating_add(margin).min(self.size[a]);
        }
        let [from, to] = [self.heights_mm[low[2]] - margin_mm, self.heights_mm[high[2] - 1] + margin_mm];
        // One slice more than the margin asks for, so that what ends is seen to end.
        while low[2] > 0 && self.heights_mm[low[2]] > from {
            low[2] -= 1;
        }
        while high[2] < self.size[2] && self.heights_mm[high[2] - 1] < to {
            high[2] += 1;
        }
        Some((low, high))
    }
}
