//! Distortion as samples: a CSV with the columns `distorted_x_px`, `distorted_y_px`, `ideal_x_px`, `ideal_y_px`.
//!
//! The distorted (recorded) pixels lie on a regular grid, in any order of rows; pixels have the centre of the first one
//! at (0, 0). What comes out has every sample of the grid and does not fold the picture over.

use std::path::Path;

use biplane_artifact::DistortionTable;

use super::{CalibrationError, quote, read_text};

const COLUMNS: [&str; 4] = ["distorted_x_px", "distorted_y_px", "ideal_x_px", "ideal_y_px"];

/// Reads the map from recorded to ideal pixels.
///
/// # Errors
/// A column is missing, a value is not a finite number, the recorded pixels are not a full regular grid of at least
/// 4 x 4, or neighbouring samples change sides (the picture is folded).
pub fn read_distortion_csv(path: impl AsRef<Path>) -> Result<DistortionTable, CalibrationError> {
    let path = path.as_ref();
    parse(path, &read_text(path)?)
}

/// The table as such a CSV.
pub fn write_distortion_csv(table: &DistortionTable) -> String {
    let DistortionTable { first_px, step_px, count, ideal_px } = table;
    let mut text = COLUMNS.join(",") + "\n";
    for (place, [ideal_x, ideal_y]) in ideal_px.iter().enumerate() {
        let [column, row] = [place % count[0], place / count[0]].map(|n| n as f64);
        let (x, y) = (first_px[0] + step_px[0] * column, first_px[1] + step_px[1] * row);
        text += &format!("{x},{y},{ideal_x},{ideal_y}\n");
    }
    text
}

pub(crate) fn is_distortion_csv(text: &str) -> bool {
    let header = text.lines().next().unwrap_or_default();
    COLUMNS.iter().all(|c| header.split(',').any(|h| h.trim() == *c))
}

fn parse(path: &Path, text: &str) -> Result<DistortionTable, CalibrationError> {
    let value = |what: String| CalibrationError::Value { path: path.to_owned(), what };
    let line = |line: usize, expected: String, found: String| CalibrationError::Line {
        path: path.to_owned(),
        line,
        expected,
        found,
    };
    let mut reader =
        csv::ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_reader(text.as_bytes());
    let header = reader.headers().map_err(|e| value(e.to_string()))?.clone();
    let mut places = [0; 4];
    for (place, name) in places.iter_mut().zip(COLUMNS) {
        *place = header.iter().position(|h| h == name).ok_or_else(|| {
            line(
                1,
                format!("a header with the column `{name}`"),
                quote(&header.iter().collect::<Vec<_>>().join(",")),
            )
        })?;
    }
    let mut samples: Vec<[f64; 4]> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| value(e.to_string()))?;
        let number = record.position().map_or(0, |p| p.line() as usize);
        let mut sample = [0.0; 4];
        for ((slot, place), name) in sample.iter_mut().zip(places).zip(COLUMNS) {
            let field = record.get(place).unwrap_or_default();
            *slot =
                field.parse().ok().filter(|v: &f64| v.is_finite()).ok_or_else(|| {
                    line(number, format!("a finite number in column `{name}`"), quote(field))
                })?;
        }
        samples.push(sample);
    }
    let (first_x, step_x, columns) =
        axis(samples.iter().map(|s| s[0])).map_err(|e| value(format!("{}: {e}", COLUMNS[0])))?;
    let (first_y, step_y, rows) =
        axis(samples.iter().map(|s| s[1])).map_err(|e| value(format!("{}: {e}", COLUMNS[1])))?;
    if samples.len() != columns * rows {
        let place = |s: &[f64; 4]| {
            let row = ((s[1] - first_y) / step_y).round() as usize;
            row * columns + ((s[0] - first_x) / step_x).round() as usize
        };
        let there: std::collections::BTreeSet<usize> = samples.iter().map(place).collect();
        let gap = (0..columns * rows).find(|i| !there.contains(i)).map(|i| {
            let (x, y) = (first_x + step_x * (i % columns) as f64, first_y + step_y * (i / columns) as f64);
            format!("; the first one missing is that of recorded pixel ({x}, {y})")
        });
        return Err(value(format!(
            "{} samples, but a full grid of {columns} x {rows} has {}{}. Export the table again, whole",
            samples.len(),
            columns * rows,
            gap.unwrap_or_default()
        )));
    }
    let mut ideal: Vec<Option<[f64; 2]>> = vec![None; columns * rows];
    for [x, y, ideal_x, ideal_y] in samples {
        let column = ((x - first_x) / step_x).round() as usize;
        let row = ((y - first_y) / step_y).round() as usize;
        if let Some(slot) = ideal.get_mut(row * columns + column)
            && slot.replace([ideal_x, ideal_y]).is_some()
        {
            return Err(value(format!("recorded pixel ({x}, {y}) is there twice")));
        }
    }
    let ideal_px: Vec<[f64; 2]> = ideal.into_iter().flatten().collect();
    let table = DistortionTable {
        first_px: [first_x, first_y],
        step_px: [step_x, step_y],
        count: [columns, rows],
        ideal_px,
    };
    if let Some([x, y]) = folded(&table) {
        return Err(value(format!(
            "the map folds over at recorded pixel ({x}, {y}): neighbouring samples change sides; one of them is wrong"
        )));
    }
    Ok(table)
}

/// First value, step and number of values of a regular axis.
fn axis(values: impl Iterator<Item = f64>) -> Result<(f64, f64, usize), String> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    // Printed with few decimals, one column of the grid may have values that differ in the last.
    values.dedup_by(|a, b| (*a - *b).abs() < 1e-3);
    let (Some(&first), Some(&last)) = (values.first(), values.last()) else {
        return Err("no samples".to_owned());
    };
    let count = values.len();
    if count < 4 {
        return Err(format!("{count} different values; expected a grid of at least 4 x 4"));
    }
    let step = (last - first) / (count - 1) as f64;
    for (i, v) in values.iter().enumerate() {
        let regular = first + step * i as f64;
        if (v - regular).abs() > 2e-3 {
            return Err(format!("{v} is not on a regular grid of step {step:.4}; expected {regular:.4}"));
        }
    }
    Ok((first, step, count))
}

/// The recorded pixel of a cell whose corners do not keep the order of the others.
fn folded(table: &DistortionTable) -> Option<[f64; 2]> {
    let [columns, rows] = table.count;
    let at = |c: usize, r: usize| table.ideal_px[r * columns + c];
    let turn =
        |o: [f64; 2], a: [f64; 2], b: [f64; 2]| (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
    // A picture that is mirrored as a whole is not folded.
    let side = turn(at(0, 0), at(columns - 1, 0), at(0, rows - 1)).signum();
    for r in 0..rows - 1 {
        for c in 0..columns - 1 {
            let [a, b, d, e] = [at(c, r), at(c + 1, r), at(c, r + 1), at(c + 1, r + 1)];
            let turns = [turn(a, b, d), turn(b, e, a), turn(e, d, b), turn(d, a, e)];
            if turns.iter().any(|t| *t * side <= 0.0) {
                return Some([
                    table.first_px[0] + table.step_px[0] * c as f64,
                    table.first_px[1] + table.step_px[1] * r as f64,
                ]);
            }
        }
    }
    None
}
