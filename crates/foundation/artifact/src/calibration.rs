//! One fluoroscope: where its source stands and how it makes an image.

use serde::{Deserialize, Serialize};

use crate::{Content, ContentHash, ContentHasher, Environment};

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

/// How sure it is where fluoroscopes stand: nine parameters a view, view by view. They are source x, y, z (mm); middle of the detector
/// (the place of ideal pixel `((width - 1) / 2, (height - 1) / 2)`) x, y, z (mm); rotation of the detector about it x, y, z (rad), all
/// along laboratory axes. The size of a pixel on the detector is held.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibrationUncertainty {
    /// Distance of each view's source from its detector's plane, mm.
    pub source_to_detector_mm: Vec<f64>,
    /// Covariance of all parameters; as many rows and columns as there are parameters.
    pub covariance: Vec<Vec<f64>>,
}

impl CalibrationUncertainty {
    /// Parameters of a view.
    pub const PARAMETERS: usize = 9;

    /// Of views that are known independently. Each has the distance of its source from its detector, and the standard deviations of
    /// source and detector along each of the three axes, all mm; detectors are not turned.
    pub fn independent(views: &[[f64; 3]]) -> Self {
        let variances: Vec<f64> = views
            .iter()
            .flat_map(|[_, source, detector]| {
                [*source, *source, *source, *detector, *detector, *detector, 0.0, 0.0, 0.0]
            })
            .map(|sigma| sigma * sigma)
            .collect();
        let row = |i: usize| {
            let mut row = vec![0.0; variances.len()];
            row[i] = variances[i];
            row
        };
        Self {
            source_to_detector_mm: views.iter().map(|[distance, ..]| *distance).collect(),
            covariance: (0..variances.len()).map(row).collect(),
        }
    }

    /// Of some views of an environment, by their places and in this order; `None` where it has no such view or no covariance of all.
    pub fn of(environment: &Environment, views: &[usize]) -> Option<Self> {
        let parameters = |view: &usize| {
            let first = Self::PARAMETERS * view;
            first..first + Self::PARAMETERS
        };
        let chosen: Vec<usize> = views.iter().flat_map(parameters).collect();
        let row = |i: &usize| {
            let row = environment.covariance.get(*i)?;
            chosen.iter().map(|j| row.get(*j).copied()).collect()
        };
        Some(Self {
            source_to_detector_mm: views
                .iter()
                .map(|view| Some(environment.views.get(*view)?.source_to_detector_mm))
                .collect::<Option<_>>()?,
            covariance: chosen.iter().map(row).collect::<Option<_>>()?,
        })
    }
}

impl Content for CalibrationUncertainty {
    const KIND: &'static str = "calibration-uncertainty";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        let Self { source_to_detector_mm, covariance } = self;
        let mut h = ContentHasher::new(Self::KIND, Self::SCHEMA);
        h.unsigned(source_to_detector_mm.len() as u64);
        for v in source_to_detector_mm {
            h.float(*v);
        }
        for row in covariance {
            h.unsigned(row.len() as u64);
            for v in row {
                h.float(*v);
            }
        }
        h.finish()
    }
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
