//! Tables of poses: start poses and a person's edits come from CSV, and results can be read back as starts.
//!
//! One row is one body in one frame: `trial, frame, body, tx_mm, ty_mm, tz_mm, qw, qx, qy, qz`, the pose
//! `world_from_model` (mm; unit quaternion, scalar first). Columns are found by their names in any order, other columns
//! are left alone, lines that start with `#` are skipped. `trial` may be left out where a study has one trial.

use std::path::{Path, PathBuf};

use biplane_geometry::{Pose, Vector3};
use nalgebra::{Quaternion, UnitQuaternion};

use crate::diagnostics::{meant, slashes};

/// Columns a table of poses must have.
pub const POSE_COLUMNS: [&str; 9] = ["frame", "body", "tx_mm", "ty_mm", "tz_mm", "qw", "qx", "qy", "qz"];

/// Columns of a whole row, as a person should write them.
pub const EXAMPLE_HEADER: &str = "trial,frame,body,tx_mm,ty_mm,tz_mm,qw,qx,qy,qz";

/// A quaternion's length may be off 1 by this much (numbers printed with few decimals); it is then made 1.
const UNIT_TOLERANCE: f64 = 1e-3;

/// One pose of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseRow {
    /// Trial; `None` if the table has no such column.
    pub trial: Option<String>,
    /// Frame label.
    pub frame: String,
    /// Body.
    pub body: String,
    /// `world_from_model`.
    pub pose: Pose,
    /// Line in the file, from 1.
    pub line: u64,
}

/// A table of poses and where it came from.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseTable {
    /// The file.
    pub path: PathBuf,
    /// Its rows in order.
    pub rows: Vec<PoseRow>,
}

/// Why a table of poses cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    /// The file cannot be read.
    #[error("{path}: {source}")]
    Unreadable {
        /// Which.
        path: String,
        /// Why.
        source: std::io::Error,
    },
    /// The file is not CSV, or a row has another number of columns than the header.
    #[error("{path}{line}: {what}")]
    Malformed {
        /// Which.
        path: String,
        /// `:line`, if known.
        line: String,
        /// What was found and expected.
        what: String,
    },
    /// The header lacks a column.
    #[error(
        "{path}:1: column `{column}` is missing{hint}. A table of poses needs the header {EXAMPLE_HEADER}"
    )]
    NoColumn {
        /// Which file.
        path: String,
        /// Which column.
        column: &'static str,
        /// A similar one, if there is.
        hint: String,
    },
    /// A value cannot be used.
    #[error("{path}:{line}: column `{column}`: {what}")]
    Value {
        /// Which file.
        path: String,
        /// Which line, from 1.
        line: u64,
        /// Which column.
        column: &'static str,
        /// What was found and expected.
        what: String,
    },
    /// Two rows for the same body in the same frame.
    #[error(
        "{path}:{second}: frame {frame} of body {body} has a pose on line {first} already: keep one of them"
    )]
    Twice {
        /// Which file.
        path: String,
        /// Line of the first.
        first: u64,
        /// Line of the second.
        second: u64,
        /// Frame label.
        frame: String,
        /// Body.
        body: String,
    },
}

/// Whether two frame labels mean the same frame: the same text, or the same whole number ("17" and "0017").
pub fn same_frame(a: &str, b: &str) -> bool {
    let number = |s: &str| s.bytes().all(|c| c.is_ascii_digit()).then(|| s.parse::<u64>().ok()).flatten();
    a == b || matches!((number(a), number(b)), (Some(x), Some(y)) if x == y)
}

impl PoseTable {
    /// Reads a table.
    ///
    /// # Errors
    /// It cannot be read, lacks a column, or a value is not a finite number, a quaternion not of unit length, a name
    /// empty, a pose given twice. The error names file, line and column.
    pub fn read(path: &Path) -> Result<Self, TableError> {
        let bytes =
            std::fs::read(path).map_err(|source| TableError::Unreadable { path: slashes(path), source })?;
        Self::parse(path, &bytes)
    }

    /// The table in `bytes`; `path` is for messages.
    ///
    /// # Errors
    /// As [`PoseTable::read`].
    pub fn parse(path: &Path, bytes: &[u8]) -> Result<Self, TableError> {
        let name = slashes(path);
        // Spreadsheet programs put a byte order mark in front.
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let mut reader =
            csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_reader(bytes);
        let malformed = |e: csv::Error| {
            let line = e.position().map_or(String::new(), |p| format!(":{}", line_of(bytes, p)));
            let what = match e.kind() {
                csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
                    format!("{len} columns, but the header has {expected_len}")
                }
                csv::ErrorKind::Utf8 { .. } => "not UTF-8 text; save the table as CSV (UTF-8)".to_owned(),
                _ => e.to_string(),
            };
            TableError::Malformed { path: name.clone(), line, what }
        };
        let header = reader.headers().map_err(malformed)?.clone();
        let column = |wanted: &'static str| -> Result<usize, TableError> {
            header.iter().position(|h| h == wanted).ok_or_else(|| {
                let others = || header.iter().filter(|h| !POSE_COLUMNS.contains(h));
                let near = others()
                    .find(|h| h.len() > 1 && wanted.starts_with(*h))
                    .or_else(|| crate::diagnostics::nearest(wanted, others()));
                let hint = match near {
                    Some(h) => format!(" (is `{h}` meant?)"),
                    _ if header.len() == 1 && header.get(0).is_some_and(|h| h.contains(';')) => {
                        " (columns are parted by commas, not semicolons)".to_owned()
                    }
                    _ => String::new(),
                };
                TableError::NoColumn { path: name.clone(), column: wanted, hint }
            })
        };
        let trial = header.iter().position(|h| h == "trial");
        let mut at = [0; POSE_COLUMNS.len()];
        for (slot, wanted) in at.iter_mut().zip(POSE_COLUMNS) {
            *slot = column(wanted)?;
        }
        let mut rows: Vec<PoseRow> = Vec::new();
        for record in reader.records() {
            let record = record.map_err(malformed)?;
            let line = record.position().map_or(0, |p| line_of(bytes, p));
            let bad = |column, what| TableError::Value { path: name.clone(), line, column, what };
            let text = |i: usize| {
                let value = record.get(at[i]).unwrap_or_default();
                if value.is_empty() {
                    Err(bad(POSE_COLUMNS[i], "is empty".to_owned()))
                } else {
                    Ok(value.to_owned())
                }
            };
            let number = |i: usize| {
                let value = text(i)?;
                match value.parse::<f64>() {
                    Ok(v) if v.is_finite() => Ok(v),
                    _ => Err(bad(POSE_COLUMNS[i], format!("\"{value}\" is not a finite number"))),
                }
            };
            let translation = Vector3::new(number(2)?, number(3)?, number(4)?);
            let q = Quaternion::new(number(5)?, number(6)?, number(7)?, number(8)?);
            let length = q.norm();
            if (length - 1.0).abs() > UNIT_TOLERANCE {
                let what = format!(
                    "qw, qx, qy, qz have length {length:.6}, expected 1 (a unit quaternion, scalar first, to {UNIT_TOLERANCE})"
                );
                return Err(bad("qw", what));
            }
            let trial = match trial.and_then(|i| record.get(i)) {
                Some("") => return Err(bad("trial", "is empty".to_owned())),
                other => other.map(str::to_owned),
            };
            let pose = Pose::new(UnitQuaternion::from_quaternion(q), translation);
            rows.push(PoseRow { trial, frame: text(0)?, body: text(1)?, pose, line });
        }
        let mut order: Vec<&PoseRow> = rows.iter().collect();
        order.sort_by(|a, b| (&a.trial, &a.body, key(&a.frame)).cmp(&(&b.trial, &b.body, key(&b.frame))));
        let twice = order.windows(2).find(|w| {
            w[0].trial == w[1].trial && w[0].body == w[1].body && same_frame(&w[0].frame, &w[1].frame)
        });
        if let Some([a, b]) = twice {
            return Err(TableError::Twice {
                path: name,
                first: a.line.min(b.line),
                second: a.line.max(b.line),
                frame: b.frame.clone(),
                body: b.body.clone(),
            });
        }
        Ok(Self { path: path.to_owned(), rows })
    }

    /// What of the table cannot belong to the study: bodies and trials nobody knows, one line of text each.
    ///
    /// # Errors
    /// The table has no column `trial` though the study has several.
    pub fn strangers(&self, trials: &[&str], bodies: &[&str]) -> Result<Vec<String>, TableError> {
        let path = slashes(&self.path);
        if trials.len() > 1 && self.rows.iter().any(|r| r.trial.is_none()) {
            return Err(TableError::NoColumn {
                path,
                column: "trial",
                hint: format!(" (the study has {} trials)", trials.len()),
            });
        }
        let mut notes: Vec<String> = Vec::new();
        let mut seen: Vec<&str> = Vec::new();
        for row in &self.rows {
            let trial = row.trial.as_deref().filter(|t| !trials.contains(t)).map(|t| ("trial", t, trials));
            let body = Some(row.body.as_str()).filter(|b| !bodies.contains(b)).map(|b| ("body", b, bodies));
            for (what, name, known) in trial.into_iter().chain(body) {
                if !seen.contains(&name) {
                    seen.push(name);
                    let meant = meant(name, known.iter().copied());
                    notes.push(format!(
                        "{path}:{}: the study has no {what} `{name}`: {meant} Its rows are not used",
                        row.line
                    ));
                }
            }
        }
        Ok(notes)
    }

    /// The rows for one body of one trial.
    pub fn of<'a>(&'a self, trial: &'a str, body: &'a str) -> impl Iterator<Item = &'a PoseRow> {
        self.rows.iter().filter(move |r| r.body == body && r.trial.as_deref().is_none_or(|t| t == trial))
    }
}

/// The line a record starts on. The reader's position is where it began to look, before blank lines and comments.
fn line_of(bytes: &[u8], position: &csv::Position) -> u64 {
    let rest = usize::try_from(position.byte()).ok().and_then(|at| bytes.get(at..)).unwrap_or_default();
    let skipped =
        rest.split(|b| *b == b'\n').take_while(|l| l.starts_with(b"#") || l.trim_ascii().is_empty());
    position.line() + skipped.count() as u64
}

/// Sorts labels that mean the same frame next to each other.
fn key(frame: &str) -> (Option<u64>, &str) {
    let number = frame.bytes().all(|c| c.is_ascii_digit()).then(|| frame.parse().ok()).flatten();
    (number, if number.is_some() { "" } else { frame })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<PoseTable, String> {
        PoseTable::parse(Path::new("starts.csv"), text.as_bytes()).map_err(|e| e.to_string())
    }

    #[test]
    fn columns_come_in_any_order_and_others_are_left_alone() {
        let text = "# by hand\nbody,note,frame,qw,qx,qy,qz,tx_mm,ty_mm,tz_mm\nfemur, ok ,17,0.7071,0,0.7071,0,1,2,3\n";
        let table = parse(text).unwrap();
        let row = &table.rows[0];
        assert_eq!((row.frame.as_str(), row.body.as_str(), row.line), ("17", "femur", 3));
        assert_eq!(row.pose.translation(), Vector3::new(1.0, 2.0, 3.0));
        assert!((row.pose.rotation().as_ref().norm() - 1.0).abs() < 1e-15);
        assert!((row.pose.rotation().angle().to_degrees() - 90.0).abs() < 1e-6);
        assert_eq!(table.of("any", "femur").count(), 1);
    }

    #[test]
    fn faults_name_line_and_column() {
        let header = "trial,frame,body,tx_mm,ty_mm,tz_mm,qw,qx,qy,qz\n";
        for (row, expected) in [
            ("t,1,f,1,2,x,1,0,0,0\n", "starts.csv:2: column `tz_mm`: \"x\" is not a finite number"),
            ("t,1,f,1,2,NaN,1,0,0,0\n", "starts.csv:2: column `tz_mm`: \"NaN\" is not a finite number"),
            (
                "t,1,f,1,2,3,1,0.2,0,0\n",
                "starts.csv:2: column `qw`: qw, qx, qy, qz have length 1.019804, expected 1",
            ),
            ("t,1,,1,2,3,1,0,0,0\n", "starts.csv:2: column `body`: is empty"),
            ("t,1,f,1,2,3,1,0,0\n", "starts.csv:2: 9 columns, but the header has 10"),
            (
                "t,1,f,1,2,3,1,0,0,0\n# x\nt,001,f,1,2,3,1,0,0,0\n",
                "starts.csv:4: frame 001 of body f has a pose on line 2",
            ),
        ] {
            let message = parse(&format!("{header}{row}")).unwrap_err();
            assert!(message.starts_with(expected), "{message}");
        }
        let message = parse("frame,body,tx,ty_mm,tz_mm,qw,qx,qy,qz\n").unwrap_err();
        assert!(message.starts_with("starts.csv:1: column `tx_mm` is missing (is `tx` meant?)"), "{message}");
        let message = parse("frame;body;tx_mm\n").unwrap_err();
        assert!(message.contains("parted by commas"), "{message}");
    }

    #[test]
    fn labels_match_as_text_or_number() {
        assert!(same_frame("17", "0017") && same_frame("a7", "a7"));
        assert!(!same_frame("a7", "a07") && !same_frame("17", "18") && !same_frame("", "0"));
    }

    #[test]
    fn strangers_are_named_once_with_what_may_be_meant() {
        let text = "trial,frame,body,tx_mm,ty_mm,tz_mm,qw,qx,qy,qz\nlunge,1,femr,1,2,3,1,0,0,0\nlunge,2,femr,1,2,3,1,0,0,0\n";
        let notes = parse(text).unwrap().strangers(&["lunge"], &["femur", "tibia"]).unwrap();
        assert_eq!(notes.len(), 1);
        assert!(notes[0].contains(":2: the study has no body `femr`: did you mean `femur`?"), "{notes:?}");
        let no_trial = parse("frame,body,tx_mm,ty_mm,tz_mm,qw,qx,qy,qz\n1,f,1,2,3,1,0,0,0\n").unwrap();
        assert!(no_trial.strangers(&["a", "b"], &["f"]).is_err());
    }
}
