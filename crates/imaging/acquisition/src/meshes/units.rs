//! The unit of a mesh file, which hardly any format says: told by the size of the body, or asked for.
//!
//! A bone or an implant is 15 to 550 mm across (the diagonal of the box around it): a carpal bone to a whole femur. Without a word of
//! the user a file is taken as mm only where it is that in mm and would not be in any other unit, which is between 55 and 550 units: a
//! file of 8 units may be a knee in cm or one in inches, and one of 50 a patella in mm or a tibia in cm. Otherwise the answer is a
//! question. With the user's word only what is absurd is refused: less than 5 mm, a bead, or more than 2000 mm.

use std::ops::RangeInclusive;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::MeshFileError;

/// Diagonal of the box around a bone or an implant, mm.
pub(crate) const USUAL_MM: RangeInclusive<f64> = 15.0..=550.0;
/// The same of what is read at all if the user says the unit, mm.
pub(super) const PLAUSIBLE_MM: RangeInclusive<f64> = 5.0..=2000.0;

/// What one unit of a mesh file is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum LengthUnit {
    /// `mm`
    #[default]
    #[serde(rename = "mm")]
    Millimetres,
    /// `cm`
    #[serde(rename = "cm")]
    Centimetres,
    /// `m`
    #[serde(rename = "m")]
    Metres,
    /// `in`: 25.4 mm
    #[serde(rename = "in")]
    Inches,
}

impl LengthUnit {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Millimetres, Self::Centimetres, Self::Metres, Self::Inches];

    /// One unit, mm.
    pub fn millimetres(self) -> f64 {
        match self {
            Self::Millimetres => 1.0,
            Self::Centimetres => 10.0,
            Self::Metres => 1000.0,
            Self::Inches => 25.4,
        }
    }

    /// The word in files: `mm`, `cm`, `m`, `in`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Millimetres => "mm",
            Self::Centimetres => "cm",
            Self::Metres => "m",
            Self::Inches => "in",
        }
    }

    /// The units in which something whose box has these sides would be a bone or an implant.
    pub fn usual(size: [f64; 3]) -> Vec<Self> {
        let fits = |unit: &Self| USUAL_MM.contains(&(diagonal(size) * unit.millimetres()));
        Self::ALL.into_iter().filter(fits).collect()
    }
}

/// The unit of a file whose box has these sides, in the file's own unit; `given` is what the user says.
pub(super) fn decide(
    path: &Path,
    size: [f64; 3],
    given: Option<LengthUnit>,
) -> Result<LengthUnit, MeshFileError> {
    let usual = LengthUnit::usual(size);
    match given {
        Some(unit) => {
            let diagonal_mm = diagonal(size) * unit.millimetres();
            if PLAUSIBLE_MM.contains(&diagonal_mm) {
                return Ok(unit);
            }
            Err(MeshFileError::Implausible {
                path: path.to_owned(),
                diagonal_mm,
                unit,
                advice: advice(size, &usual),
            })
        }
        None if usual == [LengthUnit::Millimetres] => Ok(LengthUnit::Millimetres),
        None => Err(MeshFileError::UnitUnknown { path: path.to_owned(), question: question(size, &usual) }),
    }
}

fn diagonal(size: [f64; 3]) -> f64 {
    size[0].hypot(size[1]).hypot(size[2])
}

/// Which units would make a body of it.
fn advice(size: [f64; 3], usual: &[LengthUnit]) -> String {
    let words = |u: &LengthUnit| {
        let across = length(diagonal(size) * u.millimetres());
        format!("units = \"{}\" if the file is in {} ({across})", u.name(), u.name())
    };
    let fits: Vec<String> = usual.iter().map(words).collect();
    if fits.is_empty() { String::new() } else { format!(": set {}", fits.join(", or ")) }
}

/// Says what the box is in each unit that would fit, and which key to set.
fn question(size: [f64; 3], usual: &[LengthUnit]) -> String {
    let raw = sides(size, 1.0);
    let words = |u: &LengthUnit| format!("{} mm if it is in {}", sides(size, u.millimetres()), u.name());
    let choices: Vec<String> = usual.iter().map(words).collect();
    let range = format!("{} to {} mm across", USUAL_MM.start(), USUAL_MM.end());
    match usual {
        [] => format!(
            "{raw} units would be the size of a bone or implant ({range}) neither in mm nor in cm, m or inches; scale it in the program that \
             made it, or say the unit with `units = \"mm\"` (\"cm\", \"m\", \"in\") in its [[body]]"
        ),
        [one] => format!(
            "{raw} units are {}; if so, add `units = \"{}\"` to its [[body]]",
            choices.concat(),
            one.name()
        ),
        _ => {
            let keys: Vec<String> = usual.iter().map(|u| format!("`units = \"{}\"`", u.name())).collect();
            format!("{raw} units are {}; add {} to its [[body]]", choices.join(", "), keys.join(" or "))
        }
    }
}

/// The sides of a box, each times a factor.
pub(crate) fn sides(size: [f64; 3], factor: f64) -> String {
    size.map(|s| digits(s * factor)).join(" x ")
}

/// A length, mm, with three digits or so.
pub(super) fn length(mm: f64) -> String {
    if mm >= 10.0 { format!("{mm:.0} mm") } else { format!("{mm:.3} mm") }
}

/// A number with three or four digits that count.
pub(crate) fn digits(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        a if !(1e-4..1e7).contains(&a) => format!("{value:.2e}"),
        a if a >= 100.0 => format!("{value:.0}"),
        a if a >= 10.0 => format!("{value:.1}"),
        a if a >= 1.0 => format!("{value:.2}"),
        a if a >= 0.1 => format!("{value:.3}"),
        a if a >= 0.01 => format!("{value:.4}"),
        _ => format!("{value:.6}"),
    }
}
