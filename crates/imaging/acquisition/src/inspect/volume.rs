//! What a volume holds, for a person to read.

use biplane_artifact::Volume;
use nalgebra::Vector3;

use super::Description;
use crate::volumes::{Orientation, VolumeFile};

/// A volume with more whole numbers than this is no label map.
const MOST_LABELS: usize = 40;

pub(super) fn describe(file: &VolumeFile) -> Description {
    let VolumeFile { volume, format, stored, files, notes } = file;
    let Volume { columns, rows, column_step_mm, row_step_mm, origins_mm, samples } = volume;
    let labels = labels(samples);
    let kind = if labels.is_some() { "label map" } else { "volume" };
    let mut d = Description::new(format!("{kind}, {}", format.name()));
    let slices = origins_mm.len();
    d.line("size", format!("{columns} x {rows} x {slices} voxels (columns x rows x slices)"));
    d.line("stored", stored.as_str());
    if files.len() > 1 {
        d.line("files", files.len().to_string());
    }
    let (column, row) = (Vector3::from(*column_step_mm), Vector3::from(*row_step_mm));
    d.line("voxel", format!("{:.4} x {:.4} mm in a slice", column.norm(), row.norm()));
    let normal = column.cross(&row).normalize();
    let apart: Vec<f64> = origins_mm
        .windows(2)
        .map(|pair| (Vector3::from(pair[1]) - Vector3::from(pair[0])).dot(&normal).abs())
        .collect();
    let (least, most) = apart.iter().fold((f64::MAX, 0.0_f64), |(a, b), &v| (a.min(v), b.max(v)));
    d.line(
        "slices",
        match apart.len() {
            0 => "one".to_owned(),
            _ if most - least < 5e-4 => format!("{most:.4} mm apart"),
            _ => format!("{least:.4} to {most:.4} mm apart"),
        },
    );
    let orientation = Orientation::of(volume);
    d.line("orientation", orientation.words());
    let [i, j, k] = orientation.towards;
    let handed = if orientation.right_handed { "" } else { "; left-handed" };
    d.line("axes", format!("columns go to {i}, rows to {j}, slices to {k}{handed}"));
    d.line("frame", "left-posterior-superior, mm; places are those of voxel centres");
    // From centre to centre, over all corners.
    let corners = [0, slices.saturating_sub(1)].into_iter().flat_map(|k| {
        let (right, down) = (*columns as f64 - 1.0, *rows as f64 - 1.0);
        [(0.0, 0.0), (right, 0.0), (0.0, down), (right, down)]
            .into_iter()
            .filter_map(move |(i, j)| volume.place_mm(i, j, k))
    });
    let (mut low, mut high) = ([f64::MAX; 3], [f64::MIN; 3]);
    for corner in corners {
        for axis in 0..3 {
            low[axis] = low[axis].min(corner[axis]);
            high[axis] = high[axis].max(corner[axis]);
        }
    }
    let depth = apart.iter().sum::<f64>();
    d.line(
        "extent",
        format!(
            "{:.1} x {:.1} x {depth:.1} mm from first to last voxel centre",
            column.norm() * (*columns as f64 - 1.0),
            row.norm() * (*rows as f64 - 1.0)
        ),
    );
    for (axis, name) in ["left", "posterior", "superior"].into_iter().enumerate() {
        d.line(name, format!("{:.1} to {:.1} mm", low[axis], high[axis]));
    }
    let (min, max) = samples.iter().fold((f32::MAX, f32::MIN), |(a, b), &s| (a.min(s), b.max(s)));
    let mean = samples.iter().map(|&s| f64::from(s)).sum::<f64>() / samples.len().max(1) as f64;
    d.line("levels", format!("{min} to {max}, mean {mean:.1}"));
    for (label, count) in labels.unwrap_or_default() {
        d.line(format!("label {label}"), format!("{count} voxels"));
    }
    for note in notes {
        d.line("note", note.to_string());
    }
    d
}

/// The labels and how many voxels have each, if these are few and whole numbers from 0 on.
fn labels(samples: &[f32]) -> Option<Vec<(u32, usize)>> {
    let mut counts: Vec<(u32, usize)> = Vec::new();
    let mut last = 0;
    for &sample in samples {
        if sample < 0.0 || sample.fract() != 0.0 || sample > 16_777_216.0 {
            return None;
        }
        let label = sample as u32;
        // Neighbours mostly have one label.
        if counts.get(last).is_none_or(|(known, _)| *known != label) {
            last = counts.iter().position(|(known, _)| *known == label).unwrap_or(counts.len());
            if last == counts.len() {
                counts.push((label, 0));
            }
            if counts.len() > MOST_LABELS {
                return None;
            }
        }
        counts[last].1 += 1;
    }
    counts.sort_unstable();
    Some(counts)
}
