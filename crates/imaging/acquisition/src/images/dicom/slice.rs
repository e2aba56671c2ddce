//! One slice of an MRI or CT series: where it lies in the patient (PS3.3, C.7.6.2: image plane), and its levels after slope and
//! intercept, with their sign.

use std::path::{Path, PathBuf};

use dicom_dictionary_std::tags;
use dicom_object::Tag;
use nalgebra::Vector3;

use super::data_set::{self, DataSet, Pixels};
use super::{Frames, Layout, layout};
use crate::images::{ImageError, Place};

const ADVICE: &str = "export the series as one uncompressed DICOM file a slice, or as NRRD or NIfTI-1";
/// Cosines have a few decimals.
const UNIT: f64 = 1e-3;
const SPACING_MM: std::ops::RangeInclusive<f64> = 1e-4..=100.0;

/// A slice, its header read. It has no `Debug`, since what tells series apart may lead to a patient.
pub(crate) struct Slice {
    pub(crate) path: PathBuf,
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    /// Centre of the first pixel, left-posterior-superior, mm.
    pub(crate) position_mm: Vector3<f64>,
    /// Unit vectors of growing column and of growing row.
    pub(crate) directions: [Vector3<f64>; 2],
    /// From column to column and from row to row, mm.
    pub(crate) spacing_mm: [f64; 2],
    /// Which series it is of; not to be shown.
    pub(crate) series: Option<String>,
    pub(crate) echo: Option<f64>,
    pub(crate) shown_inverted: bool,
    pub(crate) stored_bits: u32,
    pub(crate) signed: bool,
    slope: f64,
    intercept: f64,
    frames: Frames,
}

impl Slice {
    /// Reads the header of a DICOM file; `None` if it holds no picture.
    pub(crate) fn open(path: &Path) -> Result<Option<Self>, ImageError> {
        let place = Place { path, index: 0 };
        let length = std::fs::metadata(path).map_err(|e| place.io(e))?.len();
        let data = data_set::walk(place, length)?;
        if matches!(data.pixels, Pixels::Missing) && data.unsigned(tags::ROWS).is_none() {
            return Ok(None);
        }
        let layout = layout(place, &data, length)?;
        if layout.frames != 1 {
            let what = format!("DICOM of {} frames in one file, whose places are not read", layout.frames);
            return Err(place.unsupported(what, ADVICE));
        }
        let position = numbers::<3>(&data, tags::IMAGE_POSITION_PATIENT);
        let cosines = numbers::<6>(&data, tags::IMAGE_ORIENTATION_PATIENT);
        let (Some(position), Some([a, b, c, d, e, f])) = (position, cosines) else {
            let what = "DICOM without a place in the patient (ImagePositionPatient, ImageOrientationPatient)";
            return Err(place.unsupported(what, ADVICE));
        };
        let directions = [Vector3::new(a, b, c), Vector3::new(d, e, f)];
        let [along_row, along_column] = &directions;
        if directions.iter().any(|d| (d.norm() - 1.0).abs() > UNIT)
            || along_row.dot(along_column).abs() > UNIT
        {
            return Err(place.damaged("its ImageOrientationPatient is no two unit vectors at right angles"));
        }
        // The first number is the distance of rows.
        let spacing = numbers::<2>(&data, tags::PIXEL_SPACING);
        let [between_rows, between_columns] =
            spacing.filter(|s| s.iter().all(|v| SPACING_MM.contains(v))).ok_or_else(|| {
                place.damaged(
                    "its PixelSpacing is missing, or none of a scanner (1e-4 to 100 mm are expected)",
                )
            })?;
        // Without a slope levels are as they are stored.
        let number = |tag, default| match data.decimals(tag) {
            None if !data.has(tag) => Some(default),
            found => found.and_then(|v| v.first().copied()).filter(|v: &f64| v.is_finite()),
        };
        let slope = number(tags::RESCALE_SLOPE, 1.0).filter(|s| *s != 0.0);
        let (Some(slope), Some(intercept)) = (slope, number(tags::RESCALE_INTERCEPT, 0.0)) else {
            return Err(
                place.damaged("its RescaleSlope or RescaleIntercept is no number, or the slope is zero")
            );
        };
        Ok(Some(Self {
            path: path.to_owned(),
            columns: layout.width,
            rows: layout.height,
            position_mm: position.into(),
            directions,
            spacing_mm: [between_columns, between_rows],
            series: data.word(tags::SERIES_INSTANCE_UID).map(str::to_owned),
            echo: numbers::<1>(&data, tags::ECHO_NUMBERS).map(|[echo]| echo),
            shown_inverted: data.word(tags::PHOTOMETRIC_INTERPRETATION) == Some("MONOCHROME1"),
            stored_bits: layout.stored,
            signed: layout.signed,
            slope,
            intercept,
            frames: Frames { layout, data, length },
        }))
    }

    /// Its levels, row by row.
    pub(crate) fn levels(&self) -> Result<Vec<f32>, ImageError> {
        let Layout { stored, high_bit, signed, .. } = self.frames.layout;
        let value = |sample: u16| {
            // The stored bits alone, brought to the top of a number, so that the highest one becomes its sign.
            let top = u32::from(sample) << (31 - high_bit);
            let level =
                if signed { (top as i32 >> (32 - stored)).into() } else { f64::from(top >> (32 - stored)) };
            (level * self.slope + self.intercept) as f32
        };
        Ok(self.frames.stored(&self.path, 0)?.into_iter().map(value).collect())
    }
}

/// An element of `N` finite numbers as text.
fn numbers<const N: usize>(data: &DataSet, tag: Tag) -> Option<[f64; N]> {
    let numbers = <[f64; N]>::try_from(data.decimals(tag)?).ok()?;
    numbers.iter().all(|v| v.is_finite()).then_some(numbers)
}
