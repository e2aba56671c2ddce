//! A small CSV by the names of its columns: the first line that is neither empty nor a comment (`#`) is the header.
//!
//! Columns come in any order and those that nobody asks for are left alone. Every message names the line as an editor
//! counts it, which is why the text is split here: the `csv` crate counts a comment with the row after it. Fields may
//! stand in double quotes, but have no comma in them.

use std::path::Path;

use super::{CalibrationError, quote};
use crate::meshes::LengthUnit;

/// A table of text.
pub(crate) struct Table<'a> {
    path: &'a Path,
    header: Vec<&'a str>,
    header_line: usize,
    /// Rows in the order of the file.
    pub(crate) rows: Vec<Row<'a>>,
}

/// A row, with its line counted from 1.
pub(crate) struct Row<'a> {
    pub(crate) line: usize,
    fields: Vec<&'a str>,
}

/// Columns of a point, and what one unit of each is in mm.
pub(crate) struct Lengths<const N: usize> {
    columns: [(usize, f64); N],
}

impl<const N: usize> Lengths<N> {
    /// One unit of the first column, mm.
    pub(crate) fn scale(&self) -> f64 {
        self.columns.first().map_or(1.0, |(_, scale)| *scale)
    }
}

impl<'a> Table<'a> {
    /// Splits a text; it need not have rows, but a header in which no name is twice.
    pub(crate) fn parse(path: &'a Path, text: &'a str) -> Result<Self, CalibrationError> {
        let mut rows = lines(text).map(|(line, text)| Row { line, fields: fields(text) });
        let Some(Row { line: header_line, fields: header }) = rows.next() else {
            return Err(CalibrationError::Value {
                path: path.to_owned(),
                what: "the file is empty".to_owned(),
            });
        };
        let table = Self { path, header, header_line, rows: rows.collect() };
        let twice = table.header.iter().enumerate().find(|(i, name)| table.header[..*i].contains(name));
        match twice {
            Some((_, name)) => {
                Err(table.error(header_line, "each column once in the header", &format!("`{name}` twice")))
            }
            None => Ok(table),
        }
    }

    /// The place of a column.
    pub(crate) fn column(&self, name: &str) -> Option<usize> {
        self.header.iter().position(|h| *h == name)
    }

    /// The place of a column that has to be there.
    pub(crate) fn required(&self, name: &str) -> Result<usize, CalibrationError> {
        self.column(name).ok_or_else(|| self.no_column(&format!("the column `{name}`")))
    }

    /// The columns of lengths `x_mm`, or `x_cm`, `x_m`, `x_in`, for each of the names `x`.
    pub(crate) fn lengths<const N: usize>(&self, names: [&str; N]) -> Result<Lengths<N>, CalibrationError> {
        let mut columns = [(0, 1.0); N];
        for (slot, name) in columns.iter_mut().zip(names) {
            *slot = self.length(name).ok_or_else(|| {
                self.no_column(&format!("the column `{name}_mm` (or `{name}_cm`, `{name}_m`, `{name}_in`)"))
            })?;
        }
        Ok(Lengths { columns })
    }

    /// The column of one length, if there is one.
    pub(crate) fn length(&self, name: &str) -> Option<(usize, f64)> {
        LengthUnit::ALL.iter().find_map(|unit| {
            let place = self.column(&format!("{name}_{}", unit.name()))?;
            Some((place, unit.millimetres()))
        })
    }

    /// A row's point, mm.
    pub(crate) fn point<const N: usize>(
        &self,
        row: &Row<'a>,
        lengths: &Lengths<N>,
    ) -> Result<[f64; N], CalibrationError> {
        let mut point = [0.0; N];
        for (value, (column, scale)) in point.iter_mut().zip(lengths.columns) {
            *value = self.number(row, column)? * scale;
        }
        Ok(point)
    }

    /// A field as it stands there, without quotes; empty where the row is short.
    pub(crate) fn text(&self, row: &Row<'a>, column: usize) -> &'a str {
        row.fields.get(column).copied().unwrap_or_default()
    }

    /// A finite number.
    pub(crate) fn number(&self, row: &Row<'a>, column: usize) -> Result<f64, CalibrationError> {
        let field = self.text(row, column);
        field.parse().ok().filter(|v: &f64| v.is_finite()).ok_or_else(|| {
            let name = self.header.get(column).copied().unwrap_or_default();
            self.error(row.line, &format!("a finite number in column `{name}`"), &quote(field))
        })
    }

    /// A whole number from 0.
    pub(crate) fn count(&self, row: &Row<'a>, column: usize) -> Result<usize, CalibrationError> {
        let field = self.text(row, column);
        field.parse().map_err(|_| {
            let name = self.header.get(column).copied().unwrap_or_default();
            self.error(row.line, &format!("a whole number from 0 in column `{name}`"), &quote(field))
        })
    }

    /// What a line should hold and what it does.
    pub(crate) fn error(&self, line: usize, expected: &str, found: &str) -> CalibrationError {
        CalibrationError::Line {
            path: self.path.to_owned(),
            line,
            expected: expected.to_owned(),
            found: found.to_owned(),
        }
    }

    fn no_column(&self, what: &str) -> CalibrationError {
        self.error(self.header_line, &format!("a header with {what}"), &quote(&self.header.join(",")))
    }
}

/// The lines that are neither empty nor comments, without blanks around them, numbered from 1.
pub(crate) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines()
        .enumerate()
        .map(|(i, line)| (i + 1, line.trim()))
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
}

/// The fields of a line.
pub(crate) fn fields(line: &str) -> Vec<&str> {
    line.split(',').map(|f| f.trim().trim_matches('"').trim()).collect()
}
