//! A stack of slices: MRI, CT, or a label map.

use crate::{Content, ContentHash, ContentHasher};

/// Voxels slice by slice, `samples[(k * rows + j) * columns + i]`, and where they are in the scanner's frame.
///
/// Positions are of voxel centres, mm, **left-posterior-superior** (DICOM's patient frame): a reader turns other frames round
/// before they get here. Slices are parallel and in order along their normal; their spacing may differ.
#[derive(Debug, Clone, PartialEq)]
pub struct Volume {
    /// Voxels in a row, `i`.
    pub columns: usize,
    /// Rows in a slice, `j`.
    pub rows: usize,
    /// From a voxel to the next one of its row, mm.
    pub column_step_mm: [f64; 3],
    /// From a row to the next one of its slice, mm.
    pub row_step_mm: [f64; 3],
    /// Centre of the first voxel of each slice, mm.
    pub origins_mm: Vec<[f64; 3]>,
    /// Grey levels as the file means them (after its rescale slope), or label numbers.
    pub samples: Vec<f32>,
}

impl Volume {
    /// Centre of the place `(i, j)` of slice `k`, fractions of voxels included, mm; `None` where there is no such slice.
    pub fn place_mm(&self, i: f64, j: f64, k: usize) -> Option<[f64; 3]> {
        let origin = self.origins_mm.get(k)?;
        Some(std::array::from_fn(|a| origin[a] + i * self.column_step_mm[a] + j * self.row_step_mm[a]))
    }

    /// The samples of slice `k`, row by row; `None` where there is no such slice.
    pub fn slice(&self, k: usize) -> Option<&[f32]> {
        let size = self.columns * self.rows;
        self.samples.get(k * size..(k + 1) * size)
    }
}

impl Content for Volume {
    const KIND: &'static str = "volume";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        let Self { columns, rows, column_step_mm, row_step_mm, origins_mm, samples } = self;
        let mut hasher = ContentHasher::new(Self::KIND, Self::SCHEMA);
        hasher.unsigned(*columns as u64).unsigned(*rows as u64).unsigned(origins_mm.len() as u64);
        for v in [column_step_mm, row_step_mm].into_iter().chain(origins_mm).flatten() {
            hasher.float(*v);
        }
        let bytes: Vec<u8> = samples.iter().flat_map(|s| s.to_le_bytes()).collect();
        hasher.bytes(&bytes).finish()
    }
}
