//! Closed contours of one bone in each slice of a volume.

use serde::{Deserialize, Serialize};

use crate::content::hash_encoded;
use crate::{Artifact, Content, ContentHash, DecodeError};

/// The contours of one bone in a stack of parallel slices.
///
/// A place `(i, j)` of a slice, in pixels with the centre of its first voxel at (0, 0), lies at `origin_mm + i column_step_mm
/// + j row_step_mm` in the scanner's frame: millimetres, left-posterior-superior.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SliceContours {
    /// Pixels in a row, `i`.
    pub columns: usize,
    /// Rows in a slice, `j`.
    pub rows: usize,
    /// From a pixel to the next one of its row, mm.
    pub column_step_mm: [f64; 3],
    /// From a row to the next one, mm.
    pub row_step_mm: [f64; 3],
    /// Every slice in order, those without the bone too.
    pub slices: Vec<ContourSlice>,
    /// What a person should know of the whole; none where all is well.
    pub warnings: Vec<String>,
}

/// The bone in one slice.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ContourSlice {
    /// Centre of its first voxel, mm.
    pub origin_mm: [f64; 3],
    /// None where the bone is not.
    pub contours: Vec<SliceContour>,
    /// Why a person should look at it.
    pub flags: Vec<SliceFlag>,
    /// Whether a person drew it.
    pub edited: bool,
}

/// A closed contour: the last point is followed by the first, which is not repeated.
///
/// **Sense:** `sum(i[n] j[n+1] - i[n+1] j[n]) / 2` is positive where bone is inside, negative for a hole. So about the
/// direction column step x row step an outer contour runs counter-clockwise; in a picture with `j` down it runs clockwise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SliceContour {
    /// In order.
    pub points: Vec<SlicePoint>,
}

/// A point of a contour. In the file it is a list of three numbers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "[f64; 3]", into = "[f64; 3]")]
pub struct SlicePoint {
    /// Along the row, px.
    pub i: f64,
    /// Along the column, px.
    pub j: f64,
    /// Standard deviation of its place across the surface, mm.
    pub sigma_mm: f64,
}

/// Why a slice wants to be looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SliceFlag {
    /// Its area or its place is unlike what the slices before and after it let expect.
    Jumped,
    /// The bone is before it and after it, but not in it.
    Lost,
    /// The bone goes on beyond the border of the slice.
    TouchesBorder,
    /// It is the first or the last slice of the volume and the bone goes on.
    CutOff,
    /// Along more than a third of the contours there is no edge to be seen; they were carried across from beside it.
    Unclear,
    /// The seed lies in this slice, but in none of its contours.
    SeedOutside,
}

/// Decimals of a pixel and of a millimetre that are kept.
const SCALE: f64 = 1e5;

impl From<[f64; 3]> for SlicePoint {
    fn from([i, j, sigma_mm]: [f64; 3]) -> Self {
        Self { i, j, sigma_mm }
    }
}

impl From<SlicePoint> for [f64; 3] {
    fn from(SlicePoint { i, j, sigma_mm }: SlicePoint) -> Self {
        [i, j, sigma_mm]
    }
}

impl SlicePoint {
    /// Rounds to the five decimals that are stored, so that a value and its stored form are the same.
    pub fn rounded(i: f64, j: f64, sigma_mm: f64) -> Self {
        // Adding 0.0 makes -0.0 and 0.0 the same.
        Self::from([i, j, sigma_mm].map(|v| (v * SCALE).round() / SCALE + 0.0))
    }
}

impl SliceContour {
    /// Twice the area would be the sum of cross products; this is the area, px^2: positive with bone inside.
    pub fn area_px2(&self) -> f64 {
        let next = self.points.iter().cycle().skip(1);
        self.points.iter().zip(next).map(|(p, q)| p.i * q.j - q.i * p.j).sum::<f64>() / 2.0
    }

    /// Whether bone lies outside and not inside.
    pub fn is_hole(&self) -> bool {
        self.area_px2() < 0.0
    }
}

impl SliceContours {
    /// The points of one contour in the scanner's frame, mm; empty where there is no such contour.
    pub fn points_mm(&self, slice: usize, contour: usize) -> Vec<[f64; 3]> {
        let Some((slice, contour)) = self.slices.get(slice).and_then(|s| Some((s, s.contours.get(contour)?)))
        else {
            return Vec::new();
        };
        let [u, v] = [self.column_step_mm, self.row_step_mm];
        let place = |p: &SlicePoint| std::array::from_fn(|a| slice.origin_mm[a] + p.i * u[a] + p.j * v[a]);
        contour.points.iter().map(place).collect()
    }

    /// The planes' unit normal: column step x row step.
    pub fn normal(&self) -> [f64; 3] {
        let [u, v] = [self.column_step_mm, self.row_step_mm].map(nalgebra::Vector3::from);
        u.cross(&v).try_normalize(0.0).unwrap_or_default().into()
    }

    /// Every number finite, every contour of at least three points.
    fn check(&self) -> Result<(), String> {
        let steps = self.column_step_mm.iter().chain(&self.row_step_mm);
        if !steps.chain(self.slices.iter().flat_map(|s| &s.origin_mm)).all(|v| v.is_finite()) {
            return Err("a plane with a number that is not finite".to_owned());
        }
        for (number, slice) in self.slices.iter().enumerate() {
            for contour in &slice.contours {
                if contour.points.len() < 3 {
                    return Err(format!("slice {number} has a contour of {} points", contour.points.len()));
                }
                if !contour.points.iter().all(|p| <[f64; 3]>::from(*p).iter().all(|v| v.is_finite())) {
                    return Err(format!("slice {number} has a number that is not finite"));
                }
            }
        }
        Ok(())
    }
}

impl Content for SliceContours {
    const KIND: &'static str = "slice_contours";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        hash_encoded::<Self>(&self.encode())
    }
}

impl Artifact for SliceContours {
    const EXTENSION: &'static str = "json";
    /// Without line breaks between numbers: a bone has a hundred thousand of them.
    fn encode(&self) -> Vec<u8> {
        let mut bytes = serde_json::to_vec(self).unwrap_or_default();
        bytes.push(b'\n');
        bytes
    }
    fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
        let contours: Self = serde_json::from_slice(bytes).map_err(DecodeError::of::<Self>)?;
        contours.check().map_err(DecodeError::of::<Self>)?;
        Ok(contours)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> SliceContours {
        let points = [[1.0, 1.0], [3.123_456_7, 1.0], [3.0, 2.5]];
        let points = points.map(|[i, j]| SlicePoint::rounded(i, j, 0.1 / 3.0)).to_vec();
        let bone = ContourSlice {
            origin_mm: [10.0, 20.0, 30.0],
            contours: vec![SliceContour { points }],
            flags: vec![SliceFlag::Jumped, SliceFlag::TouchesBorder],
            edited: false,
        };
        let empty = ContourSlice { contours: Vec::new(), flags: Vec::new(), ..bone.clone() };
        SliceContours {
            columns: 9,
            rows: 8,
            column_step_mm: [0.0, 0.5, 0.0],
            row_step_mm: [0.0, 0.0, -2.0],
            slices: vec![bone, empty],
            warnings: vec!["look".to_owned()],
        }
    }

    #[test]
    fn round_trip_is_exact_and_damage_is_found() {
        let contours = sample();
        let bytes = contours.encode();
        assert_eq!(SliceContours::decode(&bytes), Ok(contours.clone()));
        for cut in [0, 9, bytes.len() / 2, bytes.len() - 3] {
            assert!(SliceContours::decode(&bytes[..cut]).is_err(), "cut at {cut}");
        }
        let mut short = contours;
        short.slices[0].contours[0].points.pop();
        assert!(SliceContours::decode(&short.encode()).is_err());
    }

    #[test]
    fn places_and_sense_are_as_said() {
        let contours = sample();
        assert_eq!(contours.points_mm(0, 0)[2], [10.0, 21.5, 25.0]);
        assert!(contours.points_mm(1, 0).is_empty());
        assert_eq!(contours.normal(), [-1.0, 0.0, 0.0]);
        let contour = &contours.slices[0].contours[0];
        assert!((contour.area_px2() - 0.5 * 2.12346 * 1.5).abs() < 1e-9);
        assert!(!contour.is_hole());
    }
}
