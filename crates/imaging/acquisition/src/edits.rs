//! What a person drew for the outlines of bodies in one picture: SVG drawings and CSV tables, read and written.
//!
//! A drawing ([`write_drawing`]) links the picture and has a layer a body with a named path a piece; what comes back from
//! Inkscape or another program is read by [`read_edit`], which also reads the same as a table ([`write_table`]). Everything
//! comes out in recorded pixels, the centre of the first one at (0, 0), as points along what was drawn, at most 1 px apart
//! and within 0.01 px of it. A body that the file does not speak of is not in the answer; one whose layer is empty is, with
//! no pieces. Not guaranteed: that a piece lies on an edge, or that it does not cross itself.

mod chain;
mod drawing;
mod named;
mod place;
mod shapes;
mod table;
mod trusted;
mod write;

use std::io::Read;
use std::path::{Path, PathBuf};

use biplane_artifact::{ContentHash, EditedContour};

use crate::calibration::CalibrationError;
pub use table::write_table;
pub use write::{Sketch, SketchBody, SketchPiece, write_drawing};

/// Bytes that a file of edits may have: a picture of 4096 x 4096 embedded in it is less.
const MAX_BYTES: u64 = 64 << 20;
/// Points of all pieces of a file together.
const MAX_POINTS: usize = 500_000;
/// Version of the form that is written, and the newest that is read.
const VERSION: u32 = 1;

/// A file of edits.
#[derive(Debug, Clone, PartialEq)]
pub struct Edit {
    /// What it says it was drawn on.
    pub about: About,
    /// The bodies that it speaks of, in the order that they were asked for.
    pub bodies: Vec<BodyEdit>,
    /// What was left out of it, for people.
    pub notes: Vec<String>,
}

/// Which picture an edit is of, as far as its file says.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct About {
    /// Name of the trial.
    pub trial: Option<String>,
    /// Label of the frame.
    pub frame: Option<String>,
    /// Name of the view.
    pub view: Option<String>,
    /// Content hash of the picture.
    pub picture: Option<ContentHash>,
}

/// The edit of one body.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyEdit {
    /// Its place among the bodies asked for.
    pub body: usize,
    /// What was drawn; no piece where nothing of the outline is to be trusted.
    pub contour: EditedContour,
    /// Whether a person changed it since the program wrote it.
    pub touched: bool,
}

/// Why an edit cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum EditError {
    /// The operating system said no.
    #[error("cannot read {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// Neither a drawing nor a table.
    #[error(
        "{}: {what}; expected a drawing (SVG, as Inkscape saves it) or a table (CSV with the columns body,piece,x_px,y_px)",
        path.display()
    )]
    Form {
        /// The file.
        path: PathBuf,
        /// What was found.
        what: String,
    },
    /// A line that cannot be taken as it stands.
    #[error("{}, line {line}: {what}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// Which element, what is wrong with it, what was expected and what to do.
        what: String,
    },
    /// A table that cannot be taken as it stands.
    #[error(transparent)]
    Table(#[from] CalibrationError),
}

/// Reads the edits of a picture of `size` pixels (columns, rows) for the `bodies` that may be in it.
///
/// # Errors
/// The file cannot be read or is damaged, is neither SVG nor CSV, has a piece whose body is not clear, or no backdrop and a
/// page of another shape than the picture.
pub fn read_edit(path: impl AsRef<Path>, bodies: &[&str], size: [usize; 2]) -> Result<Edit, EditError> {
    let path = path.as_ref();
    let text = read_text(path)?;
    if text.trim_start().starts_with('<') {
        drawing::read(path, &text, bodies, size)
    } else {
        table::read(path, &text, bodies, size)
    }
}

fn read_text(path: &Path) -> Result<String, EditError> {
    let io = |source| EditError::Io { path: path.to_owned(), source };
    let form = |what: String| EditError::Form { path: path.to_owned(), what };
    let file = std::fs::File::open(path).map_err(io)?;
    let length = file.metadata().map_err(io)?.len();
    if length > MAX_BYTES {
        return Err(form(format!("the file has {length} bytes, and at most {MAX_BYTES} are read")));
    }
    let mut bytes = Vec::new();
    file.take(MAX_BYTES).read_to_end(&mut bytes).map_err(io)?;
    if bytes.starts_with(&[0x1f, 0x8b]) {
        return Err(form("the file is compressed (.svgz); save it as plain SVG or Inkscape SVG".to_owned()));
    }
    let text = String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        let line = 1 + e.as_bytes()[..at].iter().filter(|b| **b == b'\n').count();
        EditError::Line {
            path: path.to_owned(),
            line,
            what: format!("byte {at} is not text (UTF-8); save the file as SVG or CSV again"),
        }
    })?;
    let text = text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text);
    if text.trim().is_empty() {
        return Err(form("the file is empty".to_owned()));
    }
    Ok(text)
}
