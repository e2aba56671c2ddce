//! Calibrations of fluoroscopes, read and written: MayaCam 1.0 and 2.0, JointTrack, source and plane (JSON), four points,
//! the environment that this program finds; and sampled distortion.
//!
//! Whatever the file's convention, what comes out counts pixels from the centre of the first one, and its third row is
//! the depth in mm along the detector's normal (see [`Calibration`]). Files are told apart by what they hold.

pub(crate) mod camera;
mod columns;
mod distortion;
mod environment;
mod four_points;
mod jointtrack;
mod mayacam;
mod mayacam1;
mod plane;
mod write;

use std::io::Read;
use std::path::{Path, PathBuf};

use biplane_artifact::{Calibration, PixelOrigin};

pub(crate) use columns::{Lengths, Row, Table, fields, lines};
pub(crate) use distortion::is_distortion_csv;
pub use distortion::{read_distortion_csv, write_distortion_csv};
pub use four_points::write_four_points;
pub use jointtrack::{right_up_back_of, write_jointtrack, write_jointtrack_biplane};
pub use mayacam::{read_mayacam2, write_mayacam2};
pub use mayacam1::write_mayacam1;
pub use plane::{read_plane_json, write_plane_json};
pub use write::{WriteError, WriteOptions, Written};

/// Bytes a calibration file may have: the densest distortion table anyone writes is a tenth of it.
const MAX_BYTES: u64 = 64 << 20;
/// Pixels a side of a picture may have.
const MAX_SIDE: f64 = 16384.0;

/// Why a calibration could not be read.
#[derive(Debug, thiserror::Error)]
pub enum CalibrationError {
    /// The operating system said no.
    #[error("cannot read {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// Not a text file of sensible length.
    #[error("{} is not a text file as calibrations are: {what}", path.display())]
    NotText {
        /// The file.
        path: PathBuf,
        /// What was found.
        what: String,
    },
    /// A text that is none of the formats known.
    #[error(
        "{} is not a calibration this program reads: {what}; it reads MayaCam 2.0 (first line `image size`, as XMALab \
         exports it) and 1.0 (five lines of three numbers), JointTrack (JT_INTCALIB, JTA_INTCALIB_BIPLANE), source and \
         plane as JSON (keys `size`, `pixel_mm`, `fluoroscopes`), four points a view as CSV", path.display()
    )]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// What it is, or how it starts.
        what: String,
    },
    /// A line that is not what its place demands.
    #[error("{}, line {line}: expected {expected}, found {found}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// What should stand there.
        expected: String,
        /// What stands there.
        found: String,
    },
    /// Numbers that cannot be those of a fluoroscope.
    #[error("{}: {what}", path.display())]
    Value {
        /// The file.
        path: PathBuf,
        /// Which number, what it is, and what it should be.
        what: String,
    },
    /// The format does not say how many pixels a picture has.
    #[error(
        "{} is a JointTrack calibration, which does not hold the picture's size; give it with --size, or make a calibration \
         that holds it: `biplane convert FILE --size COLUMNS,ROWS --to plane --output calibration.json`", path.display()
    )]
    NeedsSize {
        /// The file.
        path: PathBuf,
    },
    /// The file has no such view.
    #[error("{} has no fluoroscope \"{view}\"; it has {}", path.display(), known.join(", "))]
    NoSuchView {
        /// The file.
        path: PathBuf,
        /// The view asked for.
        view: String,
        /// The views there.
        known: Vec<String>,
    },
}

/// Which calibration format a file is in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CalibrationFormat {
    /// MayaCam 2.0, as XMALab writes it: one camera a file.
    MayaCam2,
    /// MayaCam 1.0: one camera a file.
    MayaCam1,
    /// JointTrack, one plane: one camera a file, which is the world.
    JointTrack,
    /// JointTrack, two planes: cameras A and B, of which A is the world.
    JointTrackBiplane,
    /// Source, detector centre and axes, as JSON: all views in one file.
    PlaneJson,
    /// Four points a view, as CSV: all views in one file.
    FourPoints,
    /// What this program found from beads, as JSON: all views in one file.
    Environment,
}

impl CalibrationFormat {
    /// Tells the format of a text; `None` if it is none of them.
    pub fn of_text(text: &str) -> Option<Self> {
        let trimmed = text.trim_start();
        let first = trimmed.lines().next().unwrap_or_default().trim();
        if first.eq_ignore_ascii_case("image size") {
            Some(Self::MayaCam2)
        } else if environment::is_environment(trimmed) {
            Some(Self::Environment)
        } else if first.starts_with('{') && text.contains("\"fluoroscopes\"") {
            Some(Self::PlaneJson)
        } else if let Some(planes) = jointtrack::planes(text) {
            Some(if planes == 1 { Self::JointTrack } else { Self::JointTrackBiplane })
        } else if mayacam1::is_mayacam1(text) {
            Some(Self::MayaCam1)
        } else {
            four_points::is_four_points(text).then_some(Self::FourPoints)
        }
    }

    /// Its name, for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::MayaCam2 => "MayaCam 2.0",
            Self::MayaCam1 => "MayaCam 1.0",
            Self::JointTrack => "JointTrack, one plane",
            Self::JointTrackBiplane => "JointTrack, two planes",
            Self::PlaneJson => "source and detector plane as JSON",
            Self::FourPoints => "four points a fluoroscope (CSV)",
            Self::Environment => "fluoroscopes found from beads (JSON of this program)",
        }
    }

    /// Whether a file holds one view without a name.
    pub fn has_one_view(self) -> bool {
        matches!(self, Self::MayaCam2 | Self::MayaCam1 | Self::JointTrack)
    }

    /// Whether it gives pixel coordinates without saying where they count from.
    pub fn leaves_pixel_origin_open(self) -> bool {
        matches!(self, Self::MayaCam2 | Self::MayaCam1 | Self::JointTrack | Self::JointTrackBiplane)
    }
}

/// What calibration formats leave open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReadOptions {
    /// Where the file counts pixels from, in formats that do not say it.
    pub pixel_origin: PixelOrigin,
    /// Columns and rows of the pictures, for JointTrack, which does not say it.
    pub size: Option<[usize; 2]>,
}

/// One view of a calibration file, with what its projection does not say.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibratedView {
    /// Its projection.
    pub calibration: Calibration,
    /// Side of a pixel on the detector, mm, where the file says it: with it the distance of the detector is known.
    pub pixel_mm: Option<f64>,
    /// OpenCV's `k1 k2 p1 p2 k3 k4 k5 k6`, of which the projection's distortion is the sampled form.
    pub coefficients: Option<[f64; 8]>,
    /// Whether the file has a covariance of the projection's parameters.
    pub covariance: bool,
}

impl CalibratedView {
    /// Distance of the source from the detector's plane, mm, where the size of a pixel is known.
    pub fn source_to_detector_mm(&self) -> Option<f64> {
        Some(self.pixel_mm? * camera::Camera::of(&self.calibration).mean_focal())
    }
}

/// A calibration file with all its views.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibrationSet {
    /// Its format.
    pub format: CalibrationFormat,
    /// Its views, named as in the file; the only one of a format without names has the empty name.
    pub views: Vec<CalibratedView>,
}

/// Reads all views of a calibration, in whichever of the known formats the file is.
///
/// # Errors
/// The file cannot be read, is in no known format, holds numbers that cannot be those of a fluoroscope, or (JointTrack) does
/// not say a size that is not given either.
pub fn read_calibrations(
    path: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<CalibrationSet, CalibrationError> {
    let path = path.as_ref();
    parse(path, &read_text(path)?, options)
}

pub(crate) fn parse(
    path: &Path,
    text: &str,
    options: &ReadOptions,
) -> Result<CalibrationSet, CalibrationError> {
    let Some(format) = CalibrationFormat::of_text(text) else {
        return Err(CalibrationError::UnknownFormat { path: path.to_owned(), what: guess(text) });
    };
    let only = |view: CalibratedView| vec![(String::new(), view)];
    let named = match format {
        CalibrationFormat::MayaCam2 => only(mayacam::parse(path, text, options.pixel_origin)?),
        CalibrationFormat::MayaCam1 => only(mayacam1::parse(path, text, options)?),
        CalibrationFormat::JointTrack | CalibrationFormat::JointTrackBiplane => {
            jointtrack::parse(path, text, options)?
        }
        CalibrationFormat::PlaneJson => plane::parse(path, text)?,
        CalibrationFormat::FourPoints => four_points::parse(path, text)?,
        CalibrationFormat::Environment => environment::parse(path, text)?,
    };
    let views = named.into_iter().map(|(view, mut read)| {
        read.calibration.view = view;
        read
    });
    Ok(CalibrationSet { format, views: views.collect() })
}

/// Reads the calibration of one view, in whichever of the known formats the file is.
///
/// `view` matters only where one file holds several views, `pixel_origin` only where the file gives pixel coordinates and
/// does not say where they count from (MayaCam, JointTrack): the other forms name points of the picture.
///
/// # Errors
/// Those of [`read_calibrations`], and the file has no such view.
pub fn read_calibration(
    path: impl AsRef<Path>,
    view: &str,
    pixel_origin: PixelOrigin,
) -> Result<Calibration, CalibrationError> {
    let path = path.as_ref();
    let CalibrationSet { format, views } =
        read_calibrations(path, &ReadOptions { pixel_origin, size: None })?;
    let known = || views.iter().map(|v| v.calibration.view.clone()).collect();
    let wanted = if format.has_one_view() { "" } else { view };
    match views.iter().find(|v| v.calibration.view == wanted) {
        Some(found) => Ok(Calibration { view: view.to_owned(), ..found.calibration.clone() }),
        None => {
            Err(CalibrationError::NoSuchView { path: path.to_owned(), view: view.to_owned(), known: known() })
        }
    }
}

/// What a text that is not read seems to be.
fn guess(text: &str) -> String {
    let triple = |l: &str| {
        let numbers = l.split([',', ' ', '\t', ';']).filter(|t| !t.is_empty());
        numbers.map(str::parse::<f64>).filter(Result::is_ok).count() == 3
    };
    let count = lines(text).count();
    match lines(text).next() {
        None => "it is empty".to_owned(),
        Some((_, l)) if l.starts_with('{') => "it is JSON without `fluoroscopes`".to_owned(),
        Some(_) if count.is_multiple_of(4) && lines(text).all(|(_, l)| triple(l)) => {
            "it looks like the thesis's matrix of four points a fluoroscope, which lacks the pixels; write it with the header \
             view,columns,rows,point,x_mm,y_mm,z_mm,x_px,y_px"
                .to_owned()
        }
        Some((_, l)) => format!("its first line is {}", quote(l)),
    }
}

/// A whole text file, without byte order mark.
pub(crate) fn read_text(path: &Path) -> Result<String, CalibrationError> {
    let io = |source| CalibrationError::Io { path: path.to_owned(), source };
    let not_text = |what: String| CalibrationError::NotText { path: path.to_owned(), what };
    let file = std::fs::File::open(path).map_err(io)?;
    let length = file.metadata().map_err(io)?.len();
    if length > MAX_BYTES {
        return Err(not_text(format!("it has {length} bytes, and at most {MAX_BYTES} are read")));
    }
    let mut bytes = Vec::new();
    file.take(MAX_BYTES).read_to_end(&mut bytes).map_err(io)?;
    let text = String::from_utf8(bytes)
        .map_err(|e| not_text(format!("byte {} is not text (UTF-8)", e.utf8_error().valid_up_to())))?;
    Ok(text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text))
}

/// The start of a line, in quotes, as a message can show it.
pub(crate) fn quote(line: &str) -> String {
    let line = line.trim_end();
    let short: String = line.chars().take(60).collect();
    if line.is_empty() {
        "nothing".to_owned()
    } else if short.len() < line.len() {
        format!("`{short}...`")
    } else {
        format!("`{line}`")
    }
}
