//! One fluoroscope: where its source stands and how it makes an image.

use serde::{Deserialize, Serialize};

use crate::{Content, ContentHash, ContentHasher};

/// Where a calibration file counts pixels from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PixelOrigin {
    /// The centre of the first pixel is (0, 0): what this program uses inside, and OpenCV.
    Centre,
    /// The corner of the first pixel is (0, 0), so its centre is (0.5, 0.5): what renderers use.
    Corner,
}

/// The projection of one fluoroscope, and its distortion if its pictures are not corrected.
///
/// A laboratory point `X` (mm) appears at ideal pixel `(x, y)` with `w (x, y, 1) = matrix (X - source)`, `w > 0`.
/// Pixels here always have the centre of the first one at (0, 0), whatever the file said.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// The view's name in the study, to name it in messages.
    pub view: String,
    /// Columns and rows of its images.
    pub size: [usize; 2],
    /// The X-ray source, mm.
    pub source: [f64; 3],
    /// Rows of the 3x3 matrix, scaled so that `w` is the depth along the detector's normal, mm.
    pub matrix: [[f64; 3]; 3],
    /// Maps pixels of the recorded picture to ideal pixels; none if the pictures are corrected.
    pub distortion: Option<DistortionTable>,
}

/// Samples of the map from recorded to ideal pixels on a regular grid of recorded pixels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DistortionTable {
    /// Recorded pixel of the first sample.
    pub first_px: [f64; 2],
    /// Distance of samples, px, along x and y.
    pub step_px: [f64; 2],
    /// Samples along x and y.
    pub count: [usize; 2],
    /// Ideal pixels, row by row (x runs fastest).
    pub ideal_px: Vec<[f64; 2]>,
}

impl Content for Calibration {
    const KIND: &'static str = "calibration";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        let Self { view, size, source, matrix, distortion } = self;
        let mut h = ContentHasher::new(Self::KIND, Self::SCHEMA);
        h.text(view).unsigned(size[0] as u64).unsigned(size[1] as u64);
        for v in source.iter().chain(matrix.iter().flatten()) {
            h.float(*v);
        }
        feed_distortion(&mut h, distortion.as_ref());
        h.finish()
    }
}

/// Feeds a distortion, or that there is none.
pub(crate) fn feed_distortion(h: &mut ContentHasher, distortion: Option<&DistortionTable>) {
    h.unsigned(u64::from(distortion.is_some()));
    if let Some(DistortionTable { first_px, step_px, count, ideal_px }) = distortion {
        for v in first_px.iter().chain(step_px) {
            h.float(*v);
        }
        h.unsigned(count[0] as u64).unsigned(count[1] as u64).unsigned(ideal_px.len() as u64);
        for v in ideal_px.iter().flatten() {
            h.float(*v);
        }
    }
}
