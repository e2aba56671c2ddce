//! Which way a volume is cut into slices.

use std::borrow::Cow;

use biplane_artifact::Volume;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::SlicesError;
use crate::stack::Stack;

/// Which of a volume's directions the slices are counted along.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Across {
    /// As the file has them, unless voxels are at least a quarter longer along its rows or columns: then along those, as they
    /// were scanned.
    #[default]
    Scanned,
    /// As the file has them.
    Stored,
    /// Along the rows of the file's slices: a new slice is one column of each.
    Columns,
    /// Along the columns of the file's slices: a new slice is one row of each.
    Rows,
}

/// By how much longer a voxel has to be along a direction for the slices to be those across it.
const LONGER: f64 = 1.25;
/// By how much of its mean the distance of slices may change for the volume to be cut another way.
const EVEN: f64 = 1e-3;

/// The volume cut another way: the same voxels at the same places. Slices along the rows have the old columns for rows
/// (`i` runs along the old columns, `j` along the old slices); slices along the columns have `i` along the old rows.
///
/// # Errors
/// What is no stack of slices, or one whose slices are not at one distance behind each other and would have to be cut.
pub fn turned(volume: &Volume, across: Across) -> Result<Cow<'_, Volume>, SlicesError> {
    let stack = Stack::of(volume)?;
    let step = slice_step(volume);
    let axis = match across {
        Across::Stored => 2,
        Across::Columns => 0,
        Across::Rows => 1,
        Across::Scanned => {
            let [a, b] = stack.pixel_mm;
            let longest = a.max(b);
            let cut = stack.size[2] > 1 && step.is_some() && longest >= LONGER * stack.thickness_mm(0);
            match (cut, a > b) {
                (false, _) => 2,
                (true, true) => 0,
                (true, false) => 1,
            }
        }
    };
    if axis == 2 {
        return Ok(Cow::Borrowed(volume));
    }
    let Some(step) = step else {
        return Err(SlicesError::Uneven { slices: stack.size[2] });
    };
    let steps = [volume.column_step_mm, volume.row_step_mm, step];
    let [new_i, new_j] = if axis == 0 { [1, 2] } else { [0, 2] };
    let first = volume.origins_mm[0];
    let origins_mm = (0..stack.size[axis])
        .map(|n| std::array::from_fn(|a| first[a] + n as f64 * steps[axis][a]))
        .collect();
    let mut samples = Vec::with_capacity(volume.samples.len());
    for n in 0..stack.size[axis] {
        for j in 0..stack.size[new_j] {
            for i in 0..stack.size[new_i] {
                let mut place = [0; 3];
                (place[axis], place[new_i], place[new_j]) = (n, i, j);
                samples.push(volume.samples[stack.index(place)]);
            }
        }
    }
    Ok(Cow::Owned(Volume {
        columns: stack.size[new_i],
        rows: stack.size[new_j],
        column_step_mm: steps[new_i],
        row_step_mm: steps[new_j],
        origins_mm,
        samples,
    }))
}

/// The step from slice to slice; none where there is not one for all.
fn slice_step(volume: &Volume) -> Option<[f64; 3]> {
    let (first, last) = (volume.origins_mm.first()?, volume.origins_mm.last()?);
    let count = volume.origins_mm.len() - 1;
    if count == 0 {
        return None;
    }
    let step: [f64; 3] = std::array::from_fn(|a| (last[a] - first[a]) / count as f64);
    let length = step.iter().map(|s| s * s).sum::<f64>().sqrt();
    let even = volume
        .origins_mm
        .iter()
        .enumerate()
        .all(|(n, o)| (0..3).all(|a| (first[a] + n as f64 * step[a] - o[a]).abs() <= EVEN * length));
    even.then_some(step)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn volume() -> Volume {
        Volume {
            columns: 2,
            rows: 3,
            column_step_mm: [1.0, 0.0, 0.0],
            row_step_mm: [0.0, 0.5, 0.0],
            origins_mm: (0..4).map(|k| [7.0, 8.0, 0.5 * f64::from(k)]).collect(),
            samples: (0..24_u8).map(f32::from).collect(),
        }
    }

    #[test]
    fn every_voxel_keeps_its_place_in_space() {
        let old = volume();
        let places = |v: &Volume| {
            let mut all: Vec<([i64; 3], u32)> = Vec::new();
            for k in 0..v.origins_mm.len() {
                for (n, s) in v.slice(k).unwrap().iter().enumerate() {
                    let at = v.place_mm((n % v.columns) as f64, (n / v.columns) as f64, k).unwrap();
                    all.push((at.map(|c| (c * 1000.0).round() as i64), *s as u32));
                }
            }
            all.sort();
            all
        };
        for across in [Across::Scanned, Across::Stored, Across::Columns, Across::Rows] {
            assert_eq!(places(&turned(&old, across).unwrap()), places(&old), "{across:?}");
        }
        // Voxels are longest along the rows: that is the way it was scanned.
        assert_eq!(turned(&old, Across::Scanned), turned(&old, Across::Columns));
        assert_eq!(turned(&old, Across::Scanned).unwrap().origins_mm.len(), 2);
    }

    #[test]
    fn uneven_slices_are_not_cut() {
        let mut uneven = volume();
        uneven.origins_mm[3][2] = 1.7;
        assert!(matches!(turned(&uneven, Across::Rows), Err(SlicesError::Uneven { slices: 4 })));
        assert_eq!(*turned(&uneven, Across::Scanned).unwrap(), uneven);
    }
}
