//! Landmarks that a person named on a body: a table, the fiducials of 3D Slicer, or the thesis's four points.
//!
//! * **CSV** with a header `landmark,x_mm,y_mm,z_mm`, columns in any order, others left alone, `#` before comments; `x_cm`, `x_m`, `x_in`
//!   say other units.
//! * **Slicer's `.fcsv` and `.mrk.json`**. Both say which way their axes go. Models are left-posterior-superior (LPS), as bones made from
//!   volumes are; what is right-anterior-superior (RAS) is turned: x and y change sign.
//! * **Four rows** of three numbers, mm, without a header: the origin of the axes and a point on each (Bingham 2006); these become the
//!   landmarks `origin`, `x`, `y`, `z`.
//!
//! Guaranteed: at least one landmark; each has a name, trimmed, that no other one has, upper and lower case alike; finite coordinates. Not
//! guaranteed: that they lie on the body, or that their names mean something for it.

use std::path::{Path, PathBuf};

use biplane_artifact::{Landmark, Landmarks};
use serde::Deserialize;

use crate::calibration::{CalibrationError, Table, lines, quote, read_text};

/// Why landmarks could not be read.
#[derive(Debug, thiserror::Error)]
pub enum LandmarkFileError {
    /// It cannot be read, is no text, or its table is wrong.
    #[error(transparent)]
    Text(#[from] CalibrationError),
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
    /// No landmark.
    #[error("{} holds no landmark; expected a row a landmark, or delete the file", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// Slicer's file does not say which way its axes go.
    #[error(
        "{} does not say which way its axes go; add the line `# CoordinateSystem = LPS` or `# CoordinateSystem = RAS` at its \
         beginning, or save it again as .mrk.json", path.display()
    )]
    NoCoordinateSystem {
        /// The file.
        path: PathBuf,
    },
}

/// How a file of landmarks is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LandmarkFormat {
    /// `landmark,x_mm,y_mm,z_mm`
    Csv,
    /// Slicer's fiducials as a table.
    Fcsv,
    /// Slicer's markups as JSON.
    MrkJson,
    /// An origin and three points.
    FourRows,
}

impl LandmarkFormat {
    /// Tells the format of a text; `None` if it is none of them.
    pub(crate) fn of_text(text: &str) -> Option<Self> {
        let first = text.lines().map(str::trim).find(|l| !l.is_empty())?;
        if first.starts_with('{') {
            return text.contains("\"controlPoints\"").then_some(Self::MrkJson);
        }
        if first.starts_with('#') && (comment(text, "columns").is_some() || first.contains("iducial")) {
            return Some(Self::Fcsv);
        }
        if Table::parse(Path::new(""), text).is_ok_and(|t| t.column("landmark").is_some()) {
            return Some(Self::Csv);
        }
        let mut rows = lines(text);
        let all = rows.by_ref().take(4).filter_map(|(_, line)| three(line)).count() == 4;
        (all && rows.next().is_none()).then_some(Self::FourRows)
    }

    /// The name in reports.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Csv => "CSV",
            Self::Fcsv => "3D Slicer's .fcsv",
            Self::MrkJson => "3D Slicer's .mrk.json",
            Self::FourRows => "an origin and a point on each axis, without names",
        }
    }
}

/// Landmarks with what is known of their file.
pub(crate) struct LandmarkFile {
    pub(crate) format: LandmarkFormat,
    /// Whether x and y changed their sign.
    pub(crate) turned: bool,
    pub(crate) landmarks: Landmarks,
}

/// Reads landmarks, mm, in the frame of the model.
///
/// # Errors
/// The file cannot be read or is in none of the forms known, has no landmark, one without a name, two of one name, or a coordinate that is
/// no finite number.
pub fn read_landmarks(path: impl AsRef<Path>) -> Result<Landmarks, LandmarkFileError> {
    let path = path.as_ref();
    Ok(parse(path, &read_text(path)?)?.landmarks)
}

pub(crate) fn parse(path: &Path, text: &str) -> Result<LandmarkFile, LandmarkFileError> {
    let Some((line, found)) =
        text.lines().enumerate().map(|(i, l)| (i + 1, l)).find(|(_, l)| !l.trim().is_empty())
    else {
        return Err(LandmarkFileError::Empty { path: path.to_owned() });
    };
    let mut list = List { path, landmarks: Vec::new() };
    let format = LandmarkFormat::of_text(text);
    let turned = match format {
        Some(LandmarkFormat::Csv) => {
            let table = Table::parse(path, text)?;
            let (name, place) = (table.required("landmark")?, table.lengths(["x", "y", "z"])?);
            for row in &table.rows {
                list.add(row.line, table.text(row, name), table.point(row, &place)?)?;
            }
            false
        }
        Some(LandmarkFormat::Fcsv) => fcsv(text, &mut list)?,
        Some(LandmarkFormat::MrkJson) => mrk_json(text, &mut list)?,
        Some(LandmarkFormat::FourRows) => {
            let rows = lines(text).filter_map(|(line, row)| Some((line, three(row)?)));
            for ((line, at), name) in rows.zip(["origin", "x", "y", "z"]) {
                list.add(line, name, at)?;
            }
            false
        }
        None => {
            let (line, found) = lines(text).next().unwrap_or((line, found));
            let expected = "a header `landmark,x_mm,y_mm,z_mm`, four rows of three numbers (origin, and a point on x, y and z), or what 3D \
                            Slicer writes (.fcsv, .mrk.json)";
            return Err(list.wrong(line, expected, &quote(found)));
        }
    };
    if turned {
        for landmark in &mut list.landmarks {
            let [x, y, z] = landmark.at_mm;
            // Without making a zero negative.
            landmark.at_mm = [0.0 - x, 0.0 - y, z];
        }
    }
    match (format, list.landmarks.is_empty()) {
        (Some(format), false) => Ok(LandmarkFile { format, turned, landmarks: Landmarks(list.landmarks) }),
        _ => Err(LandmarkFileError::Empty { path: path.to_owned() }),
    }
}

struct List<'a> {
    path: &'a Path,
    landmarks: Vec<Landmark>,
}

impl List<'_> {
    fn wrong(&self, line: usize, expected: &str, found: &str) -> LandmarkFileError {
        let (expected, found) = (expected.to_owned(), found.to_owned());
        LandmarkFileError::Line { path: self.path.to_owned(), line, expected, found }
    }

    fn add(&mut self, line: usize, name: &str, at_mm: [f64; 3]) -> Result<(), LandmarkFileError> {
        let name = name.trim();
        if name.is_empty() {
            return Err(self.wrong(line, "the landmark's name", "nothing"));
        }
        if self.landmarks.iter().any(|l| l.name.eq_ignore_ascii_case(name)) {
            return Err(self.wrong(line, "each landmark once", &format!("{} again", quote(name))));
        }
        self.landmarks.push(Landmark { name: name.to_owned(), at_mm });
        Ok(())
    }

    /// Whether axes go right-anterior-superior, by Slicer's word for it.
    fn is_ras(&self, line: usize, word: &str) -> Result<bool, LandmarkFileError> {
        match word {
            "RAS" | "0" => Ok(true),
            "LPS" | "1" => Ok(false),
            other => Err(self.wrong(line, "the coordinate system LPS or RAS (1 or 0)", &quote(other))),
        }
    }
}

/// Three finite numbers, with commas, semicolons or blanks between them.
fn three(line: &str) -> Option<[f64; 3]> {
    let words = line.split([',', ';', ' ', '\t']).filter(|w| !w.is_empty());
    let numbers: Option<Vec<f64>> = words.map(|w| w.parse().ok().filter(|v: &f64| v.is_finite())).collect();
    <[f64; 3]>::try_from(numbers?).ok()
}

/// What a comment `# key = value` says, and its line.
fn comment<'a>(text: &'a str, key: &str) -> Option<(usize, &'a str)> {
    let comments = text.lines().enumerate().filter_map(|(i, l)| Some((i + 1, l.trim().strip_prefix('#')?)));
    comments
        .filter_map(|(line, text)| Some((line, text.split_once('=')?)))
        .find(|(_, (name, _))| name.trim() == key)
        .map(|(line, (_, value))| (line, value.trim()))
}

/// Slicer's table: `# CoordinateSystem = LPS`, `# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,...`, a row a point.
fn fcsv(text: &str, list: &mut List<'_>) -> Result<bool, LandmarkFileError> {
    let (line, system) = comment(text, "CoordinateSystem")
        .ok_or_else(|| LandmarkFileError::NoCoordinateSystem { path: list.path.to_owned() })?;
    let turned = list.is_ras(line, system)?;
    let (header, columns) = comment(text, "columns")
        .ok_or_else(|| list.wrong(line, "a line `# columns = id,x,y,z,...,label,...` below", "none"))?;
    let columns: Vec<&str> = columns.split(',').map(str::trim).collect();
    let column = |name: &str| {
        let found = columns.iter().position(|c| *c == name);
        found.ok_or_else(|| {
            list.wrong(
                header,
                &format!("the columns x, y, z and label, among them `{name}`"),
                &quote(&columns.join(",")),
            )
        })
    };
    let (axes, label) = ([column("x")?, column("y")?, column("z")?], column("label")?);
    for (line, row) in lines(text) {
        let fields = separated(row);
        let mut at = [0.0; 3];
        for ((value, axis), name) in at.iter_mut().zip(axes).zip(["x", "y", "z"]) {
            let field = fields.get(axis).map(String::as_str).unwrap_or_default();
            *value = field.trim().parse().ok().filter(|v: &f64| v.is_finite()).ok_or_else(|| {
                list.wrong(line, &format!("a finite number in column `{name}`"), &quote(field))
            })?;
        }
        list.add(line, fields.get(label).map(String::as_str).unwrap_or_default(), at)?;
    }
    Ok(turned)
}

/// The fields of a row, of which a quoted one may hold commas.
fn separated(row: &str) -> Vec<String> {
    let mut fields = vec![String::new()];
    let mut quoted = false;
    for c in row.chars() {
        match (c, fields.last_mut()) {
            ('"', _) => quoted = !quoted,
            (',', _) if !quoted => fields.push(String::new()),
            (c, Some(field)) => field.push(c),
            _ => {}
        }
    }
    fields
}

#[derive(Deserialize)]
struct Document {
    markups: Vec<Markup>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Markup {
    #[serde(default = "lps")]
    coordinate_system: serde_json::Value,
    #[serde(default)]
    coordinate_units: serde_json::Value,
    control_points: Vec<ControlPoint>,
}

/// What Slicer's schema says of a markup that does not say it.
fn lps() -> serde_json::Value {
    "LPS".into()
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct ControlPoint {
    #[serde(default)]
    label: String,
    #[serde(default)]
    position: Vec<serde_json::Value>,
    #[serde(default)]
    position_status: String,
}

/// Slicer's markups: the control points of all lists in the file. Lists of both kinds of axes in one file are refused.
fn mrk_json(text: &str, list: &mut List<'_>) -> Result<bool, LandmarkFileError> {
    let document: Document = serde_json::from_str(text).map_err(|e| {
        list.wrong(e.line(), "JSON as 3D Slicer writes it (`markups` with `controlPoints`)", &e.to_string())
    })?;
    // JSON that has been parsed has no lines; the keys are counted instead.
    let line_of = |key: &str, nth: usize| {
        let at = text.match_indices(key).nth(nth).map_or(0, |(at, _)| at);
        text.get(..at).unwrap_or_default().matches('\n').count() + 1
    };
    let mut turned = None;
    let mut points = 0;
    for (nth, markup) in document.markups.iter().enumerate() {
        let line = line_of("\"controlPoints\"", nth);
        let word =
            |value: &serde_json::Value| value.as_str().map_or_else(|| value.to_string(), ToOwned::to_owned);
        let ras = list.is_ras(line, &word(&markup.coordinate_system))?;
        if turned.is_some_and(|t| t != ras) {
            return Err(list.wrong(
                line,
                "lists of one coordinate system",
                "LPS and RAS; save them as two files",
            ));
        }
        turned = Some(ras);
        let units = match &markup.coordinate_units {
            serde_json::Value::Null => "mm".to_owned(),
            serde_json::Value::Array(units) => units.first().map_or_else(String::new, word),
            one => word(one),
        };
        if units != "mm" {
            return Err(list.wrong(line, "coordinateUnits mm", &quote(&units)));
        }
        for point in &markup.control_points {
            let line = line_of("\"position\"", points);
            let name = quote(&point.label);
            if !["", "defined"].contains(&point.position_status.as_str()) {
                let found = format!("{name}, which is {}; place it, or delete it", point.position_status);
                return Err(list.wrong(line, "landmarks that are placed", &found));
            }
            points += 1;
            let numbers: Vec<f64> = point.position.iter().filter_map(serde_json::Value::as_f64).collect();
            let at = <[f64; 3]>::try_from(numbers).ok().filter(|_| point.position.len() == 3);
            let at = at.filter(|at| at.iter().all(|v| v.is_finite())).ok_or_else(|| {
                let found = serde_json::Value::from(point.position.clone()).to_string();
                list.wrong(line, &format!("a position of three numbers of {name}"), &found)
            })?;
            list.add(line, &point.label, at)?;
        }
    }
    Ok(turned == Some(true))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn damage_does_no_harm() {
        let fcsv = "# Markups fiducial file version = 4.11\n# CoordinateSystem = LPS\n# columns = id,x,y,z,label\n1,2,3,4,\"a, b\"\n";
        let json = r#"{"markups": [{"coordinateSystem": "RAS", "coordinateUnits": ["mm", "mm", "mm"], "controlPoints":
            [{"label": "a", "position": [1, 2, 3], "positionStatus": "defined"}, {"label": "b", "position": [1e3, 2, 3]}]}]}"#;
        let table = "landmark,x_mm,y_mm,z_mm\na,1,2,3\nb,4,5,6\n";
        let rows = "1,2,3\n2,2,3\n1,3,3\n1,2,4.5\n";
        let path = Path::new("x");
        for whole in [fcsv, json, table, rows] {
            assert!(parse(path, whole).is_ok(), "{whole}");
            for cut in 0..whole.len() {
                let _ = parse(path, &whole[..cut]);
            }
            for at in 0..whole.len() {
                for with in ["\"", ",", "{", "\n", "9", "#", "=", "e", "-", "\u{fe0f}"] {
                    let _ = parse(path, &format!("{}{with}{}", &whole[..at], &whole[at + 1..]));
                }
            }
        }
    }
}
