//! Calibrations of one fluoroscope: MayaCam 2.0, the detector plane as JSON, and sampled distortion.
//!
//! Whatever the file's convention, what comes out counts pixels from the centre of the first one, and its third row is
//! the depth in mm along the detector's normal (see [`Calibration`]). Files are told apart by what they hold.

mod columns;
mod distortion;
mod mayacam;
mod plane;

use std::io::Read;
use std::path::{Path, PathBuf};

use biplane_artifact::{Calibration, PixelOrigin};

pub(crate) use columns::{Lengths, Table, fields, lines};
pub(crate) use distortion::is_distortion_csv;
pub use distortion::read_distortion_csv;
pub use mayacam::read_mayacam2;
pub use plane::read_plane_json;
pub(crate) use plane::views as plane_views;

/// Bytes a calibration file may have: the densest distortion table anyone writes is a tenth of it.
const MAX_BYTES: u64 = 64 << 20;

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
         exports it) and the detector plane as JSON (keys `size`, `pixel_mm`, `fluoroscopes`)", path.display()
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
    /// Source, detector centre and axes, as JSON: all views in one file.
    PlaneJson,
}

impl CalibrationFormat {
    /// Tells the format of a text; `None` if it is neither.
    pub fn of_text(text: &str) -> Option<Self> {
        let first = text.trim_start().lines().next().unwrap_or_default().trim();
        if first.eq_ignore_ascii_case("image size") {
            Some(Self::MayaCam2)
        } else if first.starts_with('{') && text.contains("\"fluoroscopes\"") {
            Some(Self::PlaneJson)
        } else {
            None
        }
    }
}

/// Reads the calibration of one view, in whichever of the known formats the file is.
///
/// `view` matters only where one file holds several views, `pixel_origin` only where the file gives pixel coordinates
/// (MayaCam 2.0): the JSON form names the middle of the picture, which is the same point in either convention.
///
/// # Errors
/// The file cannot be read, is in no known format, or holds numbers that cannot be those of a fluoroscope.
pub fn read_calibration(
    path: impl AsRef<Path>,
    view: &str,
    pixel_origin: PixelOrigin,
) -> Result<Calibration, CalibrationError> {
    let path = path.as_ref();
    let text = read_text(path)?;
    let calibration = match CalibrationFormat::of_text(&text) {
        Some(CalibrationFormat::MayaCam2) => mayacam::parse(path, &text, pixel_origin)?,
        Some(CalibrationFormat::PlaneJson) => plane::parse(path, &text, view)?,
        None => return Err(CalibrationError::UnknownFormat { path: path.to_owned(), what: guess(&text) }),
    };
    Ok(Calibration { view: view.to_owned(), ..calibration })
}

/// What a text that is not read seems to be.
fn guess(text: &str) -> String {
    let lines: Vec<&str> = text.lines().map(str::trim).filter(|l| !l.is_empty()).collect();
    let triple = |l: &&str| l.split(',').filter(|t| t.trim().parse::<f64>().is_ok()).count() == 3;
    match lines.first() {
        None => "it is empty".to_owned(),
        Some(l) if l.starts_with("JT_INTCALIB") || l.starts_with("JTA_INTCALIB") => {
            "it is a JointTrack calibration".to_owned()
        }
        Some(l) if l.starts_with('{') => "it is JSON without `fluoroscopes`".to_owned(),
        Some(_) if lines.len() == 5 && lines.iter().all(triple) => {
            "it looks like MayaCam 1.0 (five lines of three numbers); export MayaCam 2.0 instead".to_owned()
        }
        Some(l) => format!("its first line is {}", quote(l)),
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
