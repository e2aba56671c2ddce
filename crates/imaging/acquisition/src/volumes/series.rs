//! A folder of DICOM slices, one file a slice, to a volume: sorted by their position along their normal, whatever the files are
//! called and however they are numbered.
//!
//! Refused: slices of several series (by the series' identifier, echo, size, spacing or orientation), and two different
//! pictures of one place. Noted: gaps, uneven distances, slices shifted against each other, copies of a file. Files that are
//! not DICOM are passed over. Not read: several frames in one file, whose places are in nested sequences.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use biplane_artifact::Volume;

use super::grid::squareness;
use super::{MAX_VOXELS, Orientation, Source, VolumeFile, VolumeFileError, VolumeFormat, VolumeNote};
use crate::frames::{files_of_folder, natural};
use crate::images::ImageFormat;
use crate::images::dicom::slice::Slice;

/// Cosines that differ by less are the same: 0.01 mm at 100 mm.
const SAME_COSINE: f64 = 1e-4;
/// Spacings that differ by a smaller share are the same.
const SAME_SPACING: f64 = 1e-4;
/// Slices nearer to each other are at one place, mm.
const SAME_PLACE_MM: f64 = 0.01;
/// Slices farther apart than this many times the usual distance have a gap between them.
const GAP: f64 = 1.5;
/// Distances within this share of the usual one are even.
const EVEN: f64 = 0.02;

/// Whether a folder holds a DICOM slice with a place in the patient.
pub(crate) fn is_series(folder: &Path) -> bool {
    dicom_files(folder)
        .is_ok_and(|(files, _)| files.iter().any(|path| matches!(Slice::open(path), Ok(Some(_)))))
}

/// The DICOM files of a folder in natural order, and how many files were looked at.
fn dicom_files(folder: &Path) -> Result<(Vec<PathBuf>, usize), VolumeFileError> {
    let mut files = files_of_folder(folder)?;
    let looked_at = files.len();
    files.sort_by(|a, b| natural(&a.to_string_lossy(), &b.to_string_lossy()));
    let mut found = Vec::new();
    for path in files {
        let mut start = Vec::new();
        let read = File::open(&path).and_then(|file| file.take(132).read_to_end(&mut start));
        read.map_err(|source| VolumeFileError::Io { path: path.clone(), source })?;
        if ImageFormat::of_start(&start) == Some(ImageFormat::Dicom) {
            found.push(path);
        }
    }
    Ok((found, looked_at))
}

pub(super) fn read(folder: &Path) -> Result<VolumeFile, VolumeFileError> {
    let (files, looked_at) = dicom_files(folder)?;
    let (mut slices, mut without) = (Vec::new(), Vec::new());
    for path in &files {
        match Slice::open(path)? {
            Some(slice) => slices.push(slice),
            None => without.push(name(path)),
        }
    }
    let mut notes = Vec::new();
    if !without.is_empty() {
        notes.push(VolumeNote::NoPicture { files: without });
    }
    let mut series = apart(slices);
    let slices = match (series.pop(), series.is_empty()) {
        (None, _) => return Err(VolumeFileError::NoSlices { folder: folder.to_owned(), files: looked_at }),
        (Some(slices), true) => slices,
        (Some(last), false) => {
            series.push(last);
            let series = series.iter().map(|slices| words(slices)).collect();
            return Err(VolumeFileError::SeveralSeries { folder: folder.to_owned(), series });
        }
    };
    stack(folder, slices, notes)
}

/// Slices by what they belong to, in the order in which they come.
fn apart(slices: Vec<Slice>) -> Vec<Vec<Slice>> {
    let mut series: Vec<Vec<Slice>> = Vec::new();
    for slice in slices {
        match series.iter_mut().find(|s| s.first().is_some_and(|first| belong_together(first, &slice))) {
            Some(found) => found.push(slice),
            None => series.push(vec![slice]),
        }
    }
    series
}

fn belong_together(a: &Slice, b: &Slice) -> bool {
    let even = |i: usize| (a.spacing_mm[i] - b.spacing_mm[i]).abs() <= SAME_SPACING * a.spacing_mm[i];
    let parallel = |i: usize| (a.directions[i] - b.directions[i]).amax() <= SAME_COSINE;
    (a.columns, a.rows, a.echo) == (b.columns, b.rows, b.echo)
        && a.series == b.series
        && (0..2).all(|i| even(i) && parallel(i))
}

/// Describes the slices of one series among several.
fn words(slices: &[Slice]) -> String {
    let [.., last] = slices else { return String::new() };
    let first = &slices[0];
    let volume = Volume {
        columns: first.columns,
        rows: first.rows,
        column_step_mm: first.directions[0].into(),
        row_step_mm: first.directions[1].into(),
        origins_mm: vec![],
        samples: vec![],
    };
    let echo = first.echo.map_or(String::new(), |echo| format!(", echo {echo}"));
    let [between_columns, between_rows] = first.spacing_mm;
    format!(
        "{} slice(s) of {} x {} px of {between_columns} x {between_rows} mm, {}{echo}: {} to {}",
        slices.len(),
        first.columns,
        first.rows,
        Orientation::of(&volume).words(),
        name(&first.path),
        name(&last.path)
    )
}

fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Slices of one series, at least one, to a volume.
fn stack(
    folder: &Path,
    mut slices: Vec<Slice>,
    mut notes: Vec<VolumeNote>,
) -> Result<VolumeFile, VolumeFileError> {
    let [along_row, along_column] = slices[0].directions;
    let [between_columns, between_rows] = slices[0].spacing_mm;
    let (column, row) = (along_row * between_columns, along_column * between_rows);
    let normal = along_row.cross(&along_column).normalize();
    let height = |slice: &Slice| slice.position_mm.dot(&normal);
    // Of slices at one place the first by name stays first.
    slices.sort_by(|a, b| height(a).total_cmp(&height(b)));
    let (columns, rows) = (slices[0].columns, slices[0].rows);
    let voxels = (columns as u64 * rows as u64).saturating_mul(slices.len() as u64);
    if voxels > MAX_VOXELS {
        let what = format!("a series of {voxels} voxels, of which at most {MAX_VOXELS} are read");
        return Err(
            Source(folder).unsupported(what, "take the slices that are not of the bone out of the folder")
        );
    }
    if slices.iter().any(|slice| slice.shown_inverted) {
        notes.push(VolumeNote::ShownInverted);
    }
    let mut samples: Vec<f32> = Vec::new();
    let mut kept: Vec<&Slice> = Vec::new();
    for slice in &slices {
        let levels = slice.levels()?;
        if let Some(i) = levels.iter().position(|level| !level.is_finite()) {
            let at = [i % columns, i / columns, 0];
            return Err(VolumeFileError::NotFinite { path: slice.path.clone(), at });
        }
        match kept.last() {
            Some(last) if height(slice) - height(last) < SAME_PLACE_MM => {
                if samples[samples.len() - levels.len()..] != levels {
                    return Err(VolumeFileError::SamePlace {
                        first: last.path.clone(),
                        second: slice.path.clone(),
                        place_mm: height(slice),
                    });
                }
                notes.push(VolumeNote::Copy { file: name(&slice.path), of: name(&last.path) });
            }
            _ => {
                samples.extend(levels);
                kept.push(slice);
            }
        }
    }
    notes.extend(distances(&kept, height));
    if let [first, .., last] = kept.as_slice() {
        notes.extend(squareness(column, row, last.position_mm - first.position_mm));
    }
    let sign = if slices[0].signed { "signed" } else { "unsigned" };
    Ok(VolumeFile {
        format: VolumeFormat::DicomSeries,
        stored: format!("{} bits, {sign}", slices[0].stored_bits),
        files: kept.iter().map(|slice| slice.path.clone()).collect(),
        notes,
        volume: Volume {
            columns,
            rows,
            column_step_mm: column.into(),
            row_step_mm: row.into(),
            origins_mm: kept.iter().map(|slice| slice.position_mm.into()).collect(),
            samples,
        },
    })
}

/// Where sorted slices are not evenly apart.
fn distances(slices: &[&Slice], height: impl Fn(&Slice) -> f64) -> Vec<VolumeNote> {
    let apart: Vec<f64> = slices.windows(2).map(|pair| height(pair[1]) - height(pair[0])).collect();
    let mut sorted = apart.clone();
    sorted.sort_by(f64::total_cmp);
    let Some(&usual_mm) = sorted.get(sorted.len().saturating_sub(1) / 2) else { return Vec::new() };
    let mut notes = Vec::new();
    for (pair, &apart_mm) in slices.windows(2).zip(&apart) {
        if apart_mm > GAP * usual_mm {
            let (before, after) = (name(&pair[0].path), name(&pair[1].path));
            notes.push(VolumeNote::Gap { before, after, apart_mm, usual_mm });
        }
    }
    let whole = || sorted.iter().copied().filter(|apart| *apart <= GAP * usual_mm);
    if whole().any(|apart| (apart - usual_mm).abs() > EVEN * usual_mm) {
        let (least_mm, most_mm) = whole().fold((f64::MAX, 0.0), |(a, b): (f64, f64), v| (a.min(v), b.max(v)));
        notes.push(VolumeNote::Uneven { least_mm, most_mm });
    }
    notes
}
