//! What the writers of calibrations share: what a format cannot hold is either told or refused.
//!
//! Every writer reads back what it wrote and compares the projections over the picture; where they differ by more than
//! 0.01 px, it refuses. So a loss that is told is one that no picture shows.

use biplane_artifact::{DistortionTable, PixelOrigin};

use super::camera::{Camera, NewWorld, largest_difference};
use super::{CalibratedView, ReadOptions};

/// By how much a projection may move, px, where a format cannot hold all.
const LIMIT_PX: f64 = 0.01;

/// How to write what a format leaves open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WriteOptions {
    /// Where the written file counts pixels from, in formats that do not say it.
    pub pixel_origin: PixelOrigin,
    /// Side of a pixel on the detector, mm, for views that do not know it.
    pub pixel_mm: Option<f64>,
    /// Leave the distortion out, for pictures that are corrected; otherwise a format that cannot hold it is refused.
    pub without_distortion: bool,
}

impl WriteOptions {
    /// How to read what was written with these.
    pub(super) fn reading(&self) -> ReadOptions {
        ReadOptions { pixel_origin: self.pixel_origin, size: None }
    }
}

/// A file's text, and what is not in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// What the file holds.
    pub text: String,
    /// What of the calibration the format cannot hold, for people.
    pub lost: Vec<String>,
    /// What its user has to know.
    pub notes: Vec<String>,
}

/// Why a calibration cannot be written in a format.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WriteError {
    /// The format has lengths on the detector.
    #[error(
        "{format} needs the side of a pixel on the detector in mm, which the calibration of view \"{view}\" does not hold; \
         give it with --pixel-mm"
    )]
    NeedsPixelSize {
        /// The format.
        format: &'static str,
        /// The view.
        view: String,
    },
    /// The picture is one as seen from behind the detector.
    #[error(
        "{format} cannot hold view \"{view}\": its picture is mirrored (as seen from behind the detector); mirror the \
         pictures and calibrate again, or use source and plane (JSON) or four points"
    )]
    Mirrored {
        /// The format.
        format: &'static str,
        /// The view.
        view: String,
    },
    /// The format has no distortion, or not this one.
    #[error(
        "{format} cannot hold the distortion of view \"{view}\", up to {px:.2} px in its picture; write it beside with \
         `--to distortion`, and leave it out here with --without-distortion: the file is then for corrected pictures"
    )]
    Distortion {
        /// The format.
        format: &'static str,
        /// The view.
        view: String,
        /// Its largest shift, px.
        px: f64,
    },
    /// Something else that pictures would show.
    #[error(
        "{format} cannot hold view \"{view}\": projections would move by up to {px:.3} px (expected at most {LIMIT_PX}), \
         since {why}; MayaCam 2.0 and four points hold it"
    )]
    Moves {
        /// The format.
        format: &'static str,
        /// The view.
        view: String,
        /// Largest shift, px.
        px: f64,
        /// What the format lacks.
        why: String,
    },
}

/// A number with every digit, and no `-0`.
pub(super) fn number(value: f64) -> String {
    format!("{}", value + 0.0)
}

/// The side of a pixel, mm: the view's own, else the one given.
pub(super) fn pixel_mm(
    format: &'static str,
    view: &CalibratedView,
    options: &WriteOptions,
) -> Result<f64, WriteError> {
    view.pixel_mm
        .or(options.pixel_mm)
        .ok_or_else(|| WriteError::NeedsPixelSize { format, view: view.calibration.view.clone() })
}

/// The one focal length that stands for two; says so if they differ.
pub(super) fn one_focal(camera: &Camera, lost: &mut Vec<String>) -> f64 {
    let [fx, fy] = camera.focal;
    if (fx - fy).abs() > 1e-9 * fx || camera.skew.abs() > 1e-9 * fx {
        lost.push(format!(
            "separate axes: fx and fy differ by {:.2e} px, skew {:.2e} px",
            fx - fy,
            camera.skew
        ));
    }
    camera.mean_focal()
}

/// The last step of a writer: refuses what moves a projection, and says what is lost whatever the format. Each view comes
/// with what was read back of it.
pub(super) fn checked(
    format: &'static str,
    views: &[(&CalibratedView, Option<CalibratedView>)],
    world: &NewWorld,
    options: &WriteOptions,
    mut lost: Vec<String>,
    text: String,
) -> Result<Written, WriteError> {
    for (view, back) in views {
        let name = || view.calibration.view.clone();
        let camera = Camera::of(&view.calibration);
        let back = back.as_ref();
        let keeps_side =
            back.is_some_and(|b| Camera::of(&b.calibration).is_mirrored() == camera.is_mirrored());
        if camera.is_mirrored() && !keeps_side {
            return Err(WriteError::Mirrored { format, view: name() });
        }
        let px = back.map_or(f64::INFINITY, |b| largest_difference(view, b, world));
        if px > LIMIT_PX {
            let why = format!(
                "its focal lengths are {:.3} and {:.3} px and its skew is {:.3} px",
                camera.focal[0], camera.focal[1], camera.skew
            );
            return Err(WriteError::Moves { format, view: name(), px, why });
        }
        let in_file = back.is_some_and(|b| b.calibration.distortion.is_some());
        if let Some(table) = view.calibration.distortion.as_ref().filter(|_| !in_file) {
            let px = largest_shift(table, view.calibration.size);
            if px > LIMIT_PX && !options.without_distortion {
                return Err(WriteError::Distortion { format, view: name(), px });
            }
            lost.push(format!("the distortion, up to {px:.2} px: the file is for corrected pictures"));
        }
        if view.covariance {
            lost.push("the covariance, and the residuals that it comes from".to_owned());
        }
    }
    let mut told: Vec<String> = Vec::with_capacity(lost.len());
    for what in lost {
        if !told.contains(&what) {
            told.push(what);
        }
    }
    Ok(Written { text, lost: told, notes: Vec::new() })
}

/// How far a distortion moves a point of the picture, px, at its samples.
fn largest_shift(table: &DistortionTable, size: [usize; 2]) -> f64 {
    let samples = table.ideal_px.iter().enumerate().map(|(i, ideal)| {
        let place = [i % table.count[0], i / table.count[0]];
        let recorded = [0, 1].map(|a| table.first_px[a] + table.step_px[a] * place[a] as f64);
        (recorded, (ideal[0] - recorded[0]).hypot(ideal[1] - recorded[1]))
    });
    let inside = |at: [f64; 2]| (0..2).all(|a| at[a] >= -1.0 && at[a] <= size[a] as f64);
    samples.filter(|(at, _)| inside(*at)).map(|(_, shift)| shift).fold(0.0, f64::max)
}
