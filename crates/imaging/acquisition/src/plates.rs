//! Plates of known patterns: the list of holes that a laboratory has, and correspondences that a person gives.
//!
//! A list is a CSV `hole,x_mm,y_mm,radius_mm` in the plate's own plane; `hole` and `radius_mm` may be missing, lengths may
//! be in `cm`, `m` or `in` if their columns say so. Guaranteed of what comes out: finite places in mm, no two holes on top
//! of each other, not all in a line, and the size of a plate. Clicks are a CSV `hole,x_px,y_px` or `x_mm,y_mm,x_px,y_px`;
//! pixels are those of the recorded picture, the centre of the first one at (0, 0). Not guaranteed: that a click is on a
//! hole of the picture.

use std::path::Path;

use biplane_artifact::{PlateClick, PlateClicks, PlatePattern, PlateSpot};

use crate::calibration::{CalibrationError, Lengths, Table, quote, read_text};
use crate::places::{MOST_ROWS, overlapping, unlikely_size};

/// Holes nearer than this, mm, are one hole listed twice: it is less than a pixel of the finest detector.
const SAME_PLACE_MM: f64 = 0.05;
/// Holes that a list has at least: fewer hold no model of a distortion.
const LEAST_HOLES: usize = 6;

/// Reads the list of a plate's holes; [`PlatePattern::List`] in the order of the file.
///
/// # Errors
/// The file cannot be read, a column is missing, a value is not a finite number, holes are not numbered 0, 1, 2... in the
/// order of rows, fewer than six, two in the same place, all in a line, or not the size of a plate (5 mm to 2 m across).
pub fn read_plate_list(path: impl AsRef<Path>) -> Result<PlatePattern, CalibrationError> {
    let path = path.as_ref();
    parse_list(path, &read_text(path)?)
}

/// Whether a text is such a list, by its header.
pub(crate) fn is_plate_list(text: &str) -> bool {
    let has = |header: &Table<'_>, name: &str| header.length(name).is_some();
    Table::parse(Path::new(""), text).is_ok_and(|t| {
        has(&t, "x")
            && has(&t, "y")
            && !has(&t, "z")
            && t.column("x_px").is_none()
            && t.column("bead").is_none()
    })
}

pub(crate) fn parse_list(path: &Path, text: &str) -> Result<PlatePattern, CalibrationError> {
    let table = Table::parse(path, text)?;
    let place = table.lengths(["x", "y"])?;
    let (hole, radius) = (table.column("hole"), table.length("radius"));
    let mut spots = Vec::with_capacity(table.rows.len());
    for (number, row) in table.rows.iter().enumerate() {
        if let Some(hole) = hole
            && table.count(row, hole)? != number
        {
            let expected = format!(
                "hole {number} (holes are numbered from 0 in the order of rows; leave the column out if yours are \
                 numbered otherwise)"
            );
            return Err(table.error(row.line, &expected, &quote(table.text(row, hole))));
        }
        let radius_mm = match radius {
            Some((column, _)) if table.text(row, column).is_empty() => None,
            Some((column, scale)) => Some(positive(&table, row.line, table.number(row, column)? * scale)?),
            None => None,
        };
        spots.push(PlateSpot { at_mm: table.point(row, &place)?, radius_mm });
    }
    let value = |what: String| CalibrationError::Value { path: path.to_owned(), what };
    if !(LEAST_HOLES..=MOST_ROWS).contains(&spots.len()) {
        return Err(value(format!("{} holes; a plate has {LEAST_HOLES} to {MOST_ROWS}", spots.len())));
    }
    let places: Vec<[f64; 3]> = spots.iter().map(|s| [s.at_mm[0], s.at_mm[1], 0.0]).collect();
    if let Some(what) = unlikely_size(&places, place.scale(), "plate", |unit| {
        format!("name the columns `x_{unit}`, `y_{unit}`")
    }) {
        return Err(value(what));
    }
    let radii: Vec<Option<f64>> = spots.iter().map(|s| s.radius_mm).collect();
    if let Some((a, b, apart)) = overlapping(&places, &radii, SAME_PLACE_MM) {
        let line = |i: usize| table.rows.get(i).map_or(0, |r| r.line);
        return Err(table.error(
            line(b),
            "a hole apart from the others",
            &format!("one {apart:.3} mm from that of line {}, where both overlap", line(a)),
        ));
    }
    if in_a_line(&spots) {
        return Err(value("all holes lie in a line; expected a pattern that fills the plate".to_owned()));
    }
    Ok(PlatePattern::List(spots))
}

/// A radius as it is read has to be a length.
fn positive(table: &Table<'_>, line: usize, radius_mm: f64) -> Result<f64, CalibrationError> {
    if radius_mm > 0.0 {
        Ok(radius_mm)
    } else {
        Err(table.error(line, "a radius above 0, or none", &format!("{radius_mm} mm")))
    }
}

fn in_a_line(spots: &[PlateSpot]) -> bool {
    let count = spots.len() as f64;
    let mean = [0, 1].map(|a| spots.iter().map(|s| s.at_mm[a]).sum::<f64>() / count);
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for spot in spots {
        let (x, y) = (spot.at_mm[0] - mean[0], spot.at_mm[1] - mean[1]);
        xx += x * x;
        xy += x * y;
        yy += y * y;
    }
    // The smaller eigenvalue is at least determinant / trace.
    xx * yy - xy * xy < 1e-4 * (xx + yy).powi(2)
}

/// Reads correspondences that a person gave for a picture of the plate `pattern`.
///
/// # Errors
/// The file cannot be read, a column is missing or a value is not a number, or a hole is none of the pattern's (a pattern
/// without end has no numbered holes: it takes `x_mm,y_mm,x_px,y_px`).
pub fn read_plate_clicks(
    path: impl AsRef<Path>,
    pattern: &PlatePattern,
) -> Result<PlateClicks, CalibrationError> {
    let path = path.as_ref();
    let text = read_text(path)?;
    let table = Table::parse(path, &text)?;
    let at = [table.required("x_px")?, table.required("y_px")?];
    let named = match table.column("hole") {
        Some(column) => Named::Hole(column),
        None => Named::Place(table.lengths(["x", "y"])?),
    };
    let mut clicks = Vec::with_capacity(table.rows.len());
    for row in &table.rows {
        let plate_mm = match (&named, pattern) {
            (Named::Place(place), _) => table.point(row, place)?,
            (Named::Hole(column), PlatePattern::List(spots)) => {
                let number = table.count(row, *column)?;
                let spot = spots.get(number).ok_or_else(|| {
                    let last = spots.len().saturating_sub(1);
                    table.error(row.line, &format!("a hole from 0 to {last}"), &format!("hole {number}"))
                })?;
                spot.at_mm
            }
            (Named::Hole(column), PlatePattern::Square { .. } | PlatePattern::Hexagonal { .. }) => {
                let expected =
                    "places on the plate, `x_mm,y_mm,x_px,y_px` (a grid without end has no numbered holes)";
                let found = format!("hole {}", quote(table.text(row, *column)));
                return Err(table.error(row.line, expected, &found));
            }
        };
        clicks.push(PlateClick { plate_mm, at_px: [table.number(row, at[0])?, table.number(row, at[1])?] });
    }
    Ok(PlateClicks(clicks))
}

/// How a table of clicks names the spot of the plate.
enum Named {
    /// By its number, in this column.
    Hole(usize),
    /// By its place, in these.
    Place(Lengths<2>),
}
