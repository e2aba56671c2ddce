//! The sheet that every drawing is on: what it shows, its verdict with the reasons, numbers and tables beside it.
//!
//! A verdict that is not good makes a red frame with the reasons on top: nobody must have to look for them.

use biplane_artifact::Verdict;

use super::colours::{FAINT, INK, Level, RULE};
use super::svg::{Anchor, Font, Style, Svg, text_width};

/// Width of every drawing; texts are readable when it is shown 800 px wide.
pub(super) const WIDTH: f64 = 1000.0;
/// Room at the edge.
pub(super) const MARGIN: f64 = 20.0;
/// Usual text.
pub(super) const TEXT: f64 = 15.0;
/// Small text.
pub(super) const SMALL: f64 = 13.0;
/// Warnings shown before the rest is only counted.
const WARNINGS: usize = 8;
const RED: &str = "#c5161d";

/// What stands on top of a drawing.
#[derive(Debug)]
pub(super) struct Heading<'a> {
    /// What it shows.
    pub title: String,
    /// The numbers that decide, in one line.
    pub caption: String,
    /// Whether what it shows can be used.
    pub verdict: Verdict,
    /// Why not, and what else is worth a look.
    pub warnings: &'a [String],
}

/// A drawing: its heading, and below what `draw` makes of it; `draw` gets where to begin and says where it ended.
pub(super) fn sheet(heading: &Heading, draw: impl FnOnce(&mut Svg, f64) -> f64) -> String {
    let mut svg = Svg::default();
    let good = heading.verdict == Verdict::Good;
    let mut y = if good { MARGIN } else { reasons(&mut svg, heading) };
    y += 16.0;
    svg.text([MARGIN, y], Font::new(22.0, INK).bold(), &shortened(&heading.title, 60));
    let colour = if good { Level::Good.ink() } else { RED };
    let word = heading.verdict.word();
    let chip = text_width(word, 17.0) + 26.0;
    svg.group(Style::area("verdict", colour), |svg| {
        svg.rectangle([WIDTH - MARGIN - chip, y - 20.0], [chip, 28.0]);
    });
    let middle = Font::new(17.0, "#ffffff").bold().anchored(Anchor::Middle);
    svg.text([WIDTH - MARGIN - chip / 2.0, y], middle, word);
    y += 24.0;
    svg.text([MARGIN, y], Font::new(TEXT, INK), &heading.caption);
    if good {
        for line in warning_lines(heading.warnings, 2) {
            y += 20.0;
            svg.text([MARGIN, y], Font::new(TEXT, Level::Near.ink()), &line);
        }
    }
    let bottom = (draw(&mut svg, y + 16.0) + MARGIN).ceil();
    if !good {
        let (inset, width) = (3.0, 6.0);
        svg.group(Style::line("alarm", RED, width), |svg| {
            svg.rectangle([inset, inset], [WIDTH - 2.0 * inset, bottom - 2.0 * inset]);
        });
    }
    svg.into_page([WIDTH, bottom])
}

/// A red band with the reasons; returns where it ends.
fn reasons(svg: &mut Svg, heading: &Heading) -> f64 {
    let lines = if heading.warnings.is_empty() {
        vec!["no reason is given; compare the numbers below with the limits".to_owned()]
    } else {
        warning_lines(heading.warnings, 3)
    };
    let bottom = 44.0 + 20.0 * lines.len() as f64;
    svg.group(Style::area("reasons", RED), |svg| svg.rectangle([0.0, 0.0], [WIDTH, bottom]));
    let what = match heading.verdict {
        Verdict::Failed => "FAILED: do not use this calibration",
        Verdict::Ambiguous | Verdict::Doubtful | Verdict::Good => {
            "DOUBTFUL: something speaks against this calibration"
        }
    };
    svg.text([MARGIN, 30.0], Font::new(19.0, "#ffffff").bold(), what);
    for (place, line) in lines.iter().enumerate() {
        svg.text([MARGIN, 52.0 + 20.0 * place as f64], Font::new(TEXT, "#ffffff"), line);
    }
    bottom + MARGIN / 2.0
}

/// The warnings as lines of the sheet's width, at most `most_lines` each.
fn warning_lines(warnings: &[String], most_lines: usize) -> Vec<String> {
    // Prose has many narrow letters: with names one allows for wider ones.
    let columns = ((WIDTH - 2.0 * MARGIN) / (0.86 * text_width("x", TEXT))) as usize;
    let mut lines = Vec::new();
    for warning in warnings.iter().take(WARNINGS) {
        let mut wrapped = wrapped(&format!("• {warning}"), columns);
        if wrapped.len() > most_lines {
            wrapped.truncate(most_lines);
            if let Some(last) = wrapped.last_mut() {
                *last = format!("{} …", shortened(last, columns.saturating_sub(2)));
            }
        }
        lines.extend(wrapped);
    }
    if warnings.len() > WARNINGS {
        lines.push(format!("• and {} more", warnings.len() - WARNINGS));
    }
    lines
}

/// A text in lines of at most `columns` characters, broken at spaces where there are some.
pub(super) fn wrapped(text: &str, columns: usize) -> Vec<String> {
    let columns = columns.max(1);
    let mut lines = Vec::new();
    let mut line = String::new();
    for word in text.split_whitespace() {
        let letters: Vec<char> = word.chars().collect();
        for piece in letters.chunks(columns) {
            let piece: String = piece.iter().collect();
            if !line.is_empty() && line.chars().count() + 1 + piece.chars().count() > columns {
                lines.push(std::mem::take(&mut line));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(&piece);
        }
    }
    lines.push(line);
    lines
}

/// A text of at most `most` characters, with an ellipsis where it was longer.
pub(super) fn shortened(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    text.chars().take(most.saturating_sub(1)).chain(['…']).collect()
}

/// A number for people: so many decimals and a unit; a dash where it is none.
pub(super) fn quantity(value: f64, decimals: usize, unit: &str) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    let text = if value.abs() < 1e7 { format!("{value:.decimals$}") } else { format!("{value:.1e}") };
    if unit.is_empty() { text } else { format!("{text} {unit}") }
}

/// A name, its value and how that stands to its limit.
pub(super) type Fact = (&'static str, String, Level);

/// Names on the left and values on the right of a column; returns where it ends.
pub(super) fn facts(svg: &mut Svg, corner: [f64; 2], width: f64, facts: &[Fact]) -> f64 {
    let [x, mut y] = corner;
    for (name, value, level) in facts {
        y += 22.0;
        svg.text([x, y], Font::new(TEXT - 1.0, FAINT), name);
        let font = Font::new(TEXT - 1.0, level.ink()).anchored(Anchor::End);
        svg.text([x + width, y], if *level == Level::Plain { font } else { font.bold() }, value);
    }
    y
}

/// One row of a table: its cells, how they stand to limits, and whether it is the one that counts.
#[derive(Debug)]
pub(super) struct Row {
    pub cells: Vec<(String, Level)>,
    pub bold: bool,
}

/// A table: the first column begins at `corner`, the others end at `ends` (from there); returns where it ends.
pub(super) fn table(svg: &mut Svg, corner: [f64; 2], names: &[&str], ends: &[f64], rows: &[Row]) -> f64 {
    let [x, mut y] = corner;
    let place = |column: usize, font: Font<'static>| match column.checked_sub(1).and_then(|c| ends.get(c)) {
        Some(end) => (x + end, font.anchored(Anchor::End)),
        None => (x, font),
    };
    y += 16.0;
    for (column, name) in names.iter().enumerate() {
        let (at, font) = place(column, Font::new(SMALL, FAINT));
        svg.text([at, y], font, name);
    }
    let right = x + ends.last().copied().unwrap_or(0.0);
    svg.group(Style::line("rule", RULE, 1.0), |svg| svg.line(&[[x, y + 6.0], [right, y + 6.0]]));
    y += 4.0;
    for row in rows {
        y += 20.0;
        for (column, (cell, level)) in row.cells.iter().enumerate() {
            let font = Font::new(SMALL, level.ink());
            let (at, font) = place(column, if row.bold { font.bold() } else { font });
            svg.text([at, y], font, cell);
        }
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_words_and_lines_are_broken() {
        assert_eq!(wrapped("one two  three", 7), ["one two", "three"]);
        assert_eq!(wrapped("abcdefgh ij", 3), ["abc", "def", "gh", "ij"]);
        assert_eq!(wrapped("é é é", 3), ["é é", "é"]);
    }

    #[test]
    fn quantities_that_are_none_show_a_dash() {
        assert_eq!(quantity(f64::NAN, 2, "px"), "–");
        assert_eq!(quantity(1.005, 1, "mm"), "1.0 mm");
        assert_eq!(quantity(1e300, 1, ""), "1.0e300");
    }

    #[test]
    fn many_warnings_are_counted() {
        let warnings: Vec<String> = (0..11).map(|i| format!("warning {i}")).collect();
        let lines = warning_lines(&warnings, 2);
        assert_eq!(lines.len(), 9);
        assert_eq!(lines[8], "• and 3 more");
    }
}
