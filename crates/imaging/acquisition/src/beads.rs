//! Frames of beads at known places: the list that a laboratory has of its frame, and beads that a person names in pictures.
//!
//! A list is a CSV `bead,x_mm,y_mm,z_mm,radius_mm[,mark]`, or a cube file of XMALab: a header `x y z`, or one that contains
//! `white` where beads are bright, then `x,y,z[,name]` in a unit that the file does not say. A header `s2,s2,s2,...` scales
//! its numbers, as in XMALab. XMALab's second file, `<number from 1> <name>` a line, names the reference beads.
//!
//! Marks are the beads by which a frame is recognised: those of the column `mark`, XMALab's references, else those whose
//! radius is at least 1.25 times the median one.
//!
//! Guaranteed of a list: finite places in mm, at least six beads with a name each, no two in the same place, not all in a
//! plane, and the size of a frame (5 mm to 2 m). Not guaranteed: that it is right-handed, which only a picture can tell.

use std::path::Path;

use biplane_artifact::{Bead, BeadClick, BeadClicks, BeadList};
use nalgebra::{Matrix3, Vector3};

use crate::calibration::{CalibrationError, Table, fields, lines, quote, read_text};
use crate::meshes::LengthUnit;
use crate::places::{MOST_ROWS, overlapping, unlikely_size};

/// A projection has eleven numbers, and a bead gives two of them.
const LEAST_BEADS: usize = 6;
/// Beads without a radius that are nearer than this, mm, are one bead listed twice.
const SAME_PLACE_MM: f64 = 0.2;
/// A bead of this many median radii is a mark.
const LARGE: f64 = 1.25;
/// Spread across the flattest direction over that along the longest, below which beads count as lying in a plane.
const FLAT: f64 = 0.01;

/// A frame as a file lists it.
#[derive(Debug, Clone, PartialEq)]
pub struct BeadFile {
    /// Its beads.
    pub list: BeadList,
    /// Whether beads are brighter than what is around them, where the file says (XMALab's `white`).
    pub bright: Option<bool>,
    /// What was assumed, for people.
    pub notes: Vec<String>,
}

/// Reads a list of beads. `unit` is that of a cube file of XMALab; a CSV says its own in the names of its columns.
///
/// # Errors
/// The file cannot be read, is neither form, has a value that is not a finite number, or breaks what the module guarantees.
pub fn read_bead_list(path: impl AsRef<Path>, unit: LengthUnit) -> Result<BeadFile, CalibrationError> {
    let path = path.as_ref();
    let text = read_text(path)?;
    match BeadFormat::of_text(&text) {
        Some(BeadFormat::Csv) => csv_list(path, &text),
        Some(BeadFormat::XmaLabCube) => cube(path, &text, unit),
        None => {
            let (line, found) = lines(&text).next().map_or((1, "nothing".to_owned()), |(n, l)| (n, quote(l)));
            Err(CalibrationError::Line {
                path: path.to_owned(),
                line,
                expected: "the header of a list of beads: `bead,x_mm,y_mm,z_mm,radius_mm`, or XMALab's `x y z` or `white`"
                    .to_owned(),
                found,
            })
        }
    }
}

/// Which form a list of beads has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BeadFormat {
    /// `bead,x_mm,y_mm,z_mm,radius_mm`
    Csv,
    /// XMALab's.
    XmaLabCube,
}

impl BeadFormat {
    /// By the header.
    pub(crate) fn of_text(text: &str) -> Option<Self> {
        let (_, header) = lines(text).next()?;
        let has = |t: &Table<'_>| ["x", "y", "z"].iter().all(|name| t.length(name).is_some());
        // Four points of a fluoroscope are places too.
        let beads = |t: &Table<'_>| has(t) && t.column("x_px").is_none() && t.column("point").is_none();
        if Table::parse(Path::new(""), text).is_ok_and(|t| beads(&t)) {
            return Some(Self::Csv);
        }
        let words: Vec<&str> = header.split([',', ' ', '\t', ';']).filter(|w| !w.is_empty()).collect();
        let cube = words == ["x", "y", "z"] || scales(header).is_some() || words.contains(&"white");
        cube.then_some(Self::XmaLabCube)
    }
}

/// The three factors of a header `s2,s2,s2,...`.
fn scales(header: &str) -> Option<[f64; 3]> {
    let fields = fields(header);
    let factors: Vec<f64> = fields
        .iter()
        .take(3)
        .map_while(|f| f.strip_prefix('s')?.parse().ok())
        .filter(|v: &f64| v.is_finite() && *v != 0.0)
        .collect();
    if fields.len() > 3 { <[f64; 3]>::try_from(factors).ok() } else { None }
}

/// A bead with the line it was read from.
struct Listed {
    line: usize,
    bead: Bead,
}

fn csv_list(path: &Path, text: &str) -> Result<BeadFile, CalibrationError> {
    let table = Table::parse(path, text)?;
    let place = table.lengths(["x", "y", "z"])?;
    let (name, radius, mark) = (table.column("bead"), table.length("radius"), table.column("mark"));
    let mut listed = Vec::with_capacity(table.rows.len());
    for (number, row) in table.rows.iter().enumerate() {
        let name = match name {
            Some(column) if table.text(row, column).is_empty() => {
                return Err(table.error(row.line, "a name in column `bead`", "nothing"));
            }
            Some(column) => table.text(row, column).to_owned(),
            None => (number + 1).to_string(),
        };
        let radius_mm = match radius {
            Some((column, scale)) if !table.text(row, column).is_empty() => {
                let radius_mm = table.number(row, column)? * scale;
                if radius_mm <= 0.0 {
                    let found = format!("{radius_mm} mm");
                    return Err(table.error(row.line, "a radius above 0, or none", &found));
                }
                Some(radius_mm)
            }
            _ => None,
        };
        let mark = match mark.map(|column| table.text(row, column)) {
            None | Some("" | "0" | "no" | "false") => false,
            Some("1" | "yes" | "true" | "x") => true,
            Some(other) => {
                return Err(table.error(row.line, "1 or 0 in column `mark`", &quote(other)));
            }
        };
        let bead = Bead { name, at_mm: table.point(row, &place)?, radius_mm, mark };
        listed.push(Listed { line: row.line, bead });
    }
    let mut notes = Vec::new();
    if mark.is_none() {
        notes.extend(mark_the_large(&mut listed));
    }
    checked(path, &listed, place.scale(), |unit| {
        format!("name the columns `x_{unit}`, `y_{unit}`, `z_{unit}`")
    })?;
    Ok(BeadFile { list: list(listed), bright: None, notes })
}

fn cube(path: &Path, text: &str, unit: LengthUnit) -> Result<BeadFile, CalibrationError> {
    let error = |line: usize, expected: &str, found: String| CalibrationError::Line {
        path: path.to_owned(),
        line,
        expected: expected.to_owned(),
        found,
    };
    let mut rows = lines(text);
    let header = rows.next().map_or("", |(_, header)| header);
    let factors = scales(header);
    let mut listed = Vec::new();
    for (line, row) in rows {
        let fields = fields(row);
        let mut at_mm = [0.0; 3];
        for ((value, axis), factor) in at_mm.iter_mut().zip(0..).zip(factors.unwrap_or([1.0; 3])) {
            let field = fields.get(axis).copied().unwrap_or_default();
            let number = field.parse().ok().filter(|v: &f64| v.is_finite());
            *value = number
                .ok_or_else(|| error(line, "three finite numbers `x,y,z` and perhaps a name", quote(row)))?
                * factor
                * unit.millimetres();
        }
        if fields.len() > 4 {
            return Err(error(line, "`x,y,z` or `x,y,z,name`", quote(row)));
        }
        let number = (listed.len() + 1).to_string();
        let name = fields.get(3).filter(|n| !n.is_empty()).map_or(number, |n| (*n).to_owned());
        listed.push(Listed { line, bead: Bead { name, at_mm, radius_mm: None, mark: false } });
    }
    let unit_name = unit.name();
    let mut notes = vec![format!("the file does not say its unit; taken as {unit_name}")];
    if let Some([x, y, z]) = factors {
        notes.push(format!("its header scales x, y, z by {x}, {y}, {z}"));
    }
    checked(path, &listed, unit.millimetres(), |unit| format!("set its unit to \"{unit}\""))?;
    Ok(BeadFile { list: list(listed), bright: Some(header.contains("white")), notes })
}

fn list(listed: Vec<Listed>) -> BeadList {
    BeadList(listed.into_iter().map(|l| l.bead).collect())
}

/// Marks the beads that are clearly larger than most, and says which.
fn mark_the_large(listed: &mut [Listed]) -> Option<String> {
    let mut radii: Vec<f64> = listed.iter().filter_map(|l| l.bead.radius_mm).collect();
    radii.sort_by(f64::total_cmp);
    let median = *radii.get(radii.len() / 2)?;
    let mut names = Vec::new();
    for Listed { bead, .. } in listed.iter_mut() {
        bead.mark = bead.radius_mm.is_some_and(|r| r >= LARGE * median);
        if bead.mark {
            names.push(bead.name.as_str());
        }
    }
    (!names.is_empty()).then(|| format!("larger than the others, so marks: {}", names.join(", ")))
}

/// What the module guarantees of a list. `scale` is one unit of the file, mm.
fn checked(
    path: &Path,
    listed: &[Listed],
    scale: f64,
    set: impl Fn(&str) -> String,
) -> Result<(), CalibrationError> {
    let value = |what: String| CalibrationError::Value { path: path.to_owned(), what };
    if !(LEAST_BEADS..=MOST_ROWS).contains(&listed.len()) {
        return Err(value(format!("{} beads; a frame has {LEAST_BEADS} to {MOST_ROWS}", listed.len())));
    }
    let mut names: Vec<(&str, usize)> = listed.iter().map(|l| (l.bead.name.as_str(), l.line)).collect();
    names.sort_unstable();
    if let Some(twice) = names.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        let ((name, first), (_, second)) = (twice[0], twice[1]);
        return Err(value(format!(
            "lines {first} and {second} both name a bead `{name}`; each needs its own name"
        )));
    }
    let places: Vec<[f64; 3]> = listed.iter().map(|l| l.bead.at_mm).collect();
    if let Some(what) = unlikely_size(&places, scale, "frame of beads", set) {
        return Err(value(what));
    }
    let radii: Vec<Option<f64>> = listed.iter().map(|l| l.bead.radius_mm).collect();
    if let Some((a, b, apart)) = overlapping(&places, &radii, SAME_PLACE_MM) {
        return Err(value(format!(
            "beads `{}` (line {}) and `{}` (line {}) are {apart:.3} mm apart, nearer than beads can be; is one listed twice?",
            listed[a].bead.name, listed[a].line, listed[b].bead.name, listed[b].line
        )));
    }
    let flatness = flatness(&places);
    if flatness < FLAT {
        return Err(value(format!(
            "all beads lie in a plane (their spread across it is {:.2} % of that along it); a frame needs depth to show \
             where a source stands",
            100.0 * flatness
        )));
    }
    Ok(())
}

/// Spread across the flattest direction over that along the longest.
fn flatness(places: &[[f64; 3]]) -> f64 {
    let count = places.len().max(1) as f64;
    let mean = places.iter().map(|p| Vector3::from(*p)).sum::<Vector3<f64>>() / count;
    let spread: Matrix3<f64> =
        places.iter().map(|p| Vector3::from(*p) - mean).map(|d| d * d.transpose()).sum();
    let squares = spread.symmetric_eigenvalues();
    (squares.min().max(0.0) / squares.max().max(f64::MIN_POSITIVE)).sqrt()
}

/// A list of beads as XMALab takes it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct XmaLabCube {
    /// The cube file.
    pub cube: String,
    /// The file of reference beads; empty where the list has no marks.
    pub references: String,
    /// What these files cannot hold, for people.
    pub lost: Vec<String>,
}

/// Letters of a reference bead's name that XMALab reads.
const XMALAB_NAME: usize = 20;

/// The list as XMALab's two files, in mm; `bright` where beads are brighter than what is around them.
pub fn write_xmalab_cube(list: &BeadList, bright: bool) -> XmaLabCube {
    let mut files = XmaLabCube {
        cube: if bright { "white\n" } else { "x y z\n" }.to_owned(),
        references: String::new(),
        lost: Vec::new(),
    };
    let mut shortened = Vec::new();
    for (place, Bead { name, at_mm: [x, y, z], radius_mm: _, mark }) in list.0.iter().enumerate() {
        let number = (place + 1).to_string();
        // XMALab reads numbers alone here; a name behind them does not disturb it.
        let behind = if *name == number || name.contains(',') { String::new() } else { format!(",{name}") };
        files.cube += &format!("{x},{y},{z}{behind}\n");
        if *mark {
            let plain = name.chars().all(|c| c.is_ascii_alphanumeric() || c == ' ');
            if !plain || name.chars().count() > XMALAB_NAME {
                shortened.push(name.as_str());
            }
            files.references += &format!("{number} {name}\n");
        }
    }
    if list.0.iter().any(|b| b.radius_mm.is_some()) {
        files.lost.push("the beads' radii".to_owned());
    }
    if !shortened.is_empty() {
        let names = shortened.join(", ");
        files.lost.push(format!(
            "part of the names {names}: XMALab reads {XMALAB_NAME} letters, digits and blanks"
        ));
    }
    files
}

/// The list as this program's CSV, in mm.
pub fn write_bead_csv(list: &BeadList) -> String {
    let rows = list.0.iter().map(|Bead { name, at_mm: [x, y, z], radius_mm, mark }| {
        let radius = radius_mm.map_or_else(String::new, |r| r.to_string());
        format!("{name},{x},{y},{z},{radius},{}\n", u8::from(*mark))
    });
    "bead,x_mm,y_mm,z_mm,radius_mm,mark\n".to_owned() + &rows.collect::<String>()
}

/// Reads XMALab's reference beads, `<number from 1> <name>` a line: each gets its name and becomes a mark. Returns how many.
///
/// # Errors
/// The file cannot be read, a line is not of this form, a number is none of the list's, or a name would be there twice; the
/// list is then left as it was.
pub fn read_xmalab_references(
    path: impl AsRef<Path>,
    list: &mut BeadList,
) -> Result<usize, CalibrationError> {
    let path = path.as_ref();
    let text = read_text(path)?;
    let error = |line: usize, expected: String, found: String| CalibrationError::Line {
        path: path.to_owned(),
        line,
        expected,
        found,
    };
    let mut named = list.clone();
    let mut seen = Vec::new();
    for (line, row) in lines(&text) {
        let (number, name) = row.split_once(char::is_whitespace).unwrap_or((row, ""));
        let name = name.trim();
        let count = named.0.len();
        let bead = number
            .parse::<usize>()
            .ok()
            .and_then(|n| n.checked_sub(1))
            .and_then(|index| named.0.get_mut(index).map(|bead| (index, bead)));
        let (Some((index, bead)), false) = (bead, name.is_empty()) else {
            return Err(error(line, format!("a number from 1 to {count} and a name"), quote(row)));
        };
        if seen.contains(&index) {
            return Err(error(line, "each bead once".to_owned(), quote(row)));
        }
        seen.push(index);
        name.clone_into(&mut bead.name);
        bead.mark = true;
        if let Some(other) = (0..count).find(|i| *i != index && named.0[*i].name == name) {
            return Err(error(line, format!("a name that bead {} does not have", other + 1), quote(row)));
        }
    }
    if seen.is_empty() {
        return Err(error(
            1,
            "reference beads, `<number from 1> <name>` a line".to_owned(),
            "none".to_owned(),
        ));
    }
    *list = named;
    Ok(seen.len())
}

/// Reads the beads that a person named in the pictures of view `view` (its place in the study): a CSV
/// `bead,x_px,y_px[,picture]`, the picture counted from 0 and 0 where it is left out.
///
/// # Errors
/// The file cannot be read, a column is missing, a value is not a number, a bead is none of the list's (near names are said)
/// or named twice in a picture.
pub fn read_bead_clicks(
    path: impl AsRef<Path>,
    view: usize,
    list: &BeadList,
) -> Result<BeadClicks, CalibrationError> {
    let path = path.as_ref();
    let text = read_text(path)?;
    let table = Table::parse(path, &text)?;
    let (name, x, y) = (table.required("bead")?, table.required("x_px")?, table.required("y_px")?);
    let picture = table.column("picture");
    let mut clicks: Vec<BeadClick> = Vec::with_capacity(table.rows.len());
    for row in &table.rows {
        let wanted = table.text(row, name);
        let bead = list.0.iter().position(|b| b.name == wanted).ok_or_else(|| {
            table.error(row.line, &format!("a bead of the list{}", near(wanted, list)), &quote(wanted))
        })?;
        let picture = match picture {
            Some(column) if !table.text(row, column).is_empty() => table.count(row, column)?,
            _ => 0,
        };
        if clicks.iter().any(|c| c.bead == bead && c.picture == picture) {
            let found = format!("`{wanted}` again in picture {picture}");
            return Err(table.error(row.line, "each bead once in a picture", &found));
        }
        clicks.push(BeadClick { view, picture, bead, at_px: [table.number(row, x)?, table.number(row, y)?] });
    }
    Ok(BeadClicks(clicks))
}

/// The names nearest to a word, as a message adds them.
fn near(word: &str, list: &BeadList) -> String {
    let word = word.to_lowercase();
    let mut names: Vec<(usize, &str)> = list
        .0
        .iter()
        .map(|b| (strsim::damerau_levenshtein(&word, &b.name.to_lowercase()), b.name.as_str()))
        .collect();
    names.sort_unstable();
    let near: Vec<String> = names.iter().take(3).map(|(_, name)| format!("`{name}`")).collect();
    if near.is_empty() { String::new() } else { format!(", perhaps {}", near.join(", ")) }
}
