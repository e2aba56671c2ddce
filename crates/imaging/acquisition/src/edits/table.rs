//! Edits as a table, for those who draw in CAD, MATLAB or a spreadsheet.
//!
//! `body,piece,x_px,y_px[,closed][,trusted]`, a row a point in the order of the piece, after comments `# frame hash: ...` that say
//! of which picture it is. Points may be sparse: a smooth curve goes through them, so a corner is the end of one piece and the
//! beginning of another. A piece is closed where its column says so or where it ends at its first point. Only stretches
//! between neighbouring points that are both trusted count. A row with a body and no place says that nothing of that body
//! is to be trusted.

use std::path::Path;

use biplane_artifact::{Content, ContentHash, EditedContour};
use biplane_geometry::Point2;
use biplane_spline::{Piece, Spline};

use super::chain::{Chain, distance};
use super::named::{body_of, known};
use super::place::Pair;
use super::trusted::Line;
use super::write::Sketch;
use super::{About, BodyEdit, Edit, EditError, MAX_POINTS, VERSION};
use crate::calibration::{CalibrationError, Row, Table, quote};

/// First and last point nearer than this close a piece, px.
const CLOSES_PX: f64 = 1e-6;

/// One piece as its rows give it.
struct Rows<'a> {
    name: &'a str,
    line: usize,
    points: Vec<Pair>,
    trusted: Vec<bool>,
    closed: bool,
}

/// Reads a table.
pub(super) fn read(path: &Path, text: &str, bodies: &[&str], size: [usize; 2]) -> Result<Edit, EditError> {
    let about = comments(path, text)?;
    let table = Table::parse(path, text)?;
    if table.column("body").is_none() && table.column("x_px").is_none() {
        let what = format!("the file begins with {}", quote(text.lines().next().unwrap_or_default()));
        return Err(EditError::Form { path: path.to_owned(), what });
    }
    let (body, piece) = (table.required("body")?, table.column("piece"));
    let at = [table.required("x_px")?, table.required("y_px")?];
    let (closed, trusted) = (table.column("closed"), table.column("trusted"));
    let mut listed: Vec<Option<Vec<Rows<'_>>>> = bodies.iter().map(|_| None).collect();
    if table.rows.len() > MAX_POINTS {
        let what = format!("{} rows; at most {MAX_POINTS} are read", table.rows.len());
        return Err(EditError::Form { path: path.to_owned(), what });
    }
    for row in &table.rows {
        let named = table.text(row, body);
        let pieces = body_of(named, bodies).and_then(|b| listed.get_mut(b)).ok_or_else(|| {
            table.error(row.line, &format!("a body of the trial ({})", known(named, bodies)), &quote(named))
        })?;
        let pieces = pieces.get_or_insert_default();
        if at.iter().all(|c| table.text(row, *c).is_empty()) {
            continue;
        }
        let name = piece.map_or("1", |c| table.text(row, c));
        let place = [table.number(row, at[0])?, table.number(row, at[1])?];
        let closed = closed.map_or(Ok(false), |c| yes_or_no(&table, row, c, "closed", false))?;
        let trusted = trusted.map_or(Ok(true), |c| yes_or_no(&table, row, c, "trusted", true))?;
        let known = pieces.iter().position(|p| p.name == name);
        let known = known.unwrap_or_else(|| {
            pieces.push(Rows {
                name,
                line: row.line,
                points: Vec::new(),
                trusted: Vec::new(),
                closed: false,
            });
            pieces.len() - 1
        });
        if let Some(rows) = pieces.get_mut(known) {
            rows.points.push(place);
            rows.trusted.push(trusted);
            rows.closed |= closed;
        }
    }
    let mut edit = Edit { about: about.about, bodies: Vec::new(), notes: Vec::new() };
    let mut left = MAX_POINTS;
    for (body, pieces) in listed.into_iter().enumerate() {
        let Some(pieces) = pieces else { continue };
        let mut contour = EditedContour { pieces: Vec::new() };
        for rows in pieces {
            let (name, line) = (rows.name, rows.line);
            let before = contour.pieces.len();
            let fault = |what: String| EditError::Line {
                path: path.to_owned(),
                line,
                what: format!(
                    "piece {}: {what}; expected pixels of the picture in the order of the outline",
                    quote(name)
                ),
            };
            for stretch in rows.stretches().map_err(fault)? {
                let points = stretch.points().map_err(|e| fault(e.to_string()))?;
                left = left.checked_sub(points.len()).ok_or_else(|| {
                    fault(format!("with it the file has more than {MAX_POINTS} px of curves"))
                })?;
                let parts = Line { points, closed: stretch.closed }.within(size);
                contour.pieces.extend(parts.into_iter().filter_map(|p| p.piece(name)));
            }
            if contour.pieces.len() == before {
                edit.notes.push(format!(
                    "line {line}: piece {} is not trusted, outside the picture or shorter than 2 px; it is left out",
                    quote(name)
                ));
            }
        }
        let written = about.written.iter().find(|(name, _)| bodies.get(body) == Some(&name.as_str()));
        let touched = written.is_none_or(|(_, hash)| *hash != contour.content_hash().to_hex());
        edit.bodies.push(BodyEdit { body, contour, touched });
    }
    Ok(edit)
}

fn yes_or_no(
    table: &Table<'_>,
    row: &Row<'_>,
    column: usize,
    name: &str,
    default: bool,
) -> Result<bool, CalibrationError> {
    match table.text(row, column) {
        "" => Ok(default),
        "1" | "yes" | "true" => Ok(true),
        "0" | "no" | "false" => Ok(false),
        other => Err(table.error(row.line, &format!("1 or 0 in column `{name}`"), &quote(other))),
    }
}

impl Rows<'_> {
    /// The trusted stretches of the spline through the points.
    fn stretches(mut self) -> Result<Vec<Chain>, String> {
        let meets = |p: &[Pair]| {
            p.len() > 3 && p.first().zip(p.last()).is_some_and(|(a, b)| distance(*a, *b) <= CLOSES_PX)
        };
        if meets(&self.points) {
            self.closed = true;
            self.points.pop();
            self.trusted.pop();
        }
        let points: Vec<Point2> = self.points.iter().map(|p| Point2::from(*p)).collect();
        let spline = Spline::through(&points, self.closed).map_err(|e| e.to_string())?;
        if self.trusted.iter().all(|t| *t) {
            return Ok(Chain::of(&Piece::whole(spline).beziers(), self.closed).into_iter().collect());
        }
        let count = points.len();
        // Begun at a point that is not trusted, no stretch of a closed curve runs through the seam unseen.
        let first = if self.closed { self.trusted.iter().position(|t| !t).unwrap_or(0) } else { 0 };
        let places: Vec<usize> = (first..first + count).map(|i| i % count).collect();
        let runs = places.split(|i| !self.trusted[*i]).filter(|run| run.len() > 1);
        let chain = |run: &[usize]| {
            let piece = Piece::between_points(spline.clone(), run[0], run[run.len() - 1])
                .map_err(|e| e.to_string())?;
            Ok(Chain::of(&piece.beziers(), false))
        };
        runs.map(chain).filter_map(Result::transpose).collect()
    }
}

/// What the comments say.
#[derive(Default)]
struct Comments {
    about: About,
    /// Bodies and the hashes of what was written of them.
    written: Vec<(String, String)>,
}

fn comments(path: &Path, text: &str) -> Result<Comments, EditError> {
    let mut found = Comments::default();
    for (number, line) in text.lines().enumerate() {
        let Some((key, value)) = line.trim().strip_prefix('#').and_then(|l| l.split_once(':')) else {
            continue;
        };
        let fault = |what: String| EditError::Line { path: path.to_owned(), line: number + 1, what };
        // A spreadsheet fills every line up to the same number of commas.
        let value = value.trim().trim_end_matches(',').trim();
        match key.trim() {
            "trial" => found.about.trial = Some(value.to_owned()),
            "frame" => found.about.frame = Some(value.to_owned()),
            "view" => found.about.view = Some(value.to_owned()),
            "frame hash" => {
                let hash = ContentHash::from_hex(value);
                let what = || {
                    fault(format!(
                        "the frame's hash {} is not 64 hexadecimal digits; delete the line, or let `biplane edit` write the file anew",
                        quote(value)
                    ))
                };
                found.about.picture = Some(hash.ok_or_else(what)?);
            }
            "as written" => {
                found.written.extend(value.rsplit_once(' ').map(|(n, h)| (n.trim().to_owned(), h.to_owned())))
            }
            "version" if value.parse::<u32>().is_ok_and(|v| v > VERSION) => {
                return Err(fault(format!(
                    "it is of version {value} and this program knows up to {VERSION}; use the program it is from"
                )));
            }
            _ => {}
        }
    }
    Ok(found)
}

/// The sketch as a table. Names have no comma in them: such a body's rows are not read back.
pub fn write_table(sketch: &Sketch) -> String {
    let mut rows = "body,piece,closed,trusted,x_px,y_px\n".to_owned();
    for body in &sketch.bodies {
        let name = &body.name;
        if body.pieces.is_empty() {
            rows += &format!("{name},,,,,\n");
        }
        for (piece, number) in body.pieces.iter().zip(1..) {
            let closed = u8::from(piece.closed);
            for (i, [x, y]) in piece.points.iter().enumerate() {
                let trusted = u8::from(piece.closed || (piece.trusted[0]..=piece.trusted[1]).contains(&i));
                rows += &format!("{name},{number},{closed},{trusted},{x:.3},{y:.3}\n");
            }
        }
    }
    let names: Vec<&str> = sketch.bodies.iter().map(|b| b.name.as_str()).collect();
    let mut out = format!(
        "# version: {VERSION}\n# trial: {}\n# frame: {}\n# view: {}\n# frame hash: {}\n",
        sketch.trial,
        sketch.frame,
        sketch.view,
        sketch.picture.to_hex()
    );
    out += "# x_px, y_px: pixels of the recorded picture, the centre of the first one at (0, 0), x to the right, y down\n";
    // Read back, so that the hash is of what a reader sees.
    let read = read(Path::new(""), &rows, &names, sketch.size);
    for edit in read.iter().flat_map(|e| &e.bodies) {
        let name = names.get(edit.body).copied().unwrap_or_default();
        out += &format!("# as written: {name} {}\n", edit.contour.content_hash().to_hex());
    }
    out + &rows
}
