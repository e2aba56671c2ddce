//! Sections of tables and plots, and `docs/validation.md` made of them.

use std::fmt::Write;
use std::path::Path;

use crate::summary::distribution_columns;
use crate::{Budgets, Row, Table};

/// A plot or a picture, ready to be written.
#[derive(Debug, Clone, PartialEq)]
pub struct Plot {
    /// Its file's name.
    pub file: String,
    /// What it shows.
    pub caption: String,
    /// SVG or PNG.
    pub content: Vec<u8>,
}

/// What belongs together: how it was measured, its tables and its plots.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Heading.
    pub title: String,
    /// How truth was made, what was measured, what is claimed. Markdown, a paragraph an item.
    pub text: Vec<String>,
    /// Figures.
    pub tables: Vec<Table>,
    /// Pictures.
    pub plots: Vec<Plot>,
}

impl Section {
    /// As Markdown; plots lie in `folder` beside the document.
    pub fn markdown(&self, budgets: &Budgets, folder: &str) -> String {
        let mut text = format!("## {}\n\n", self.title);
        for paragraph in &self.text {
            let _ = writeln!(text, "{paragraph}\n");
        }
        for table in &self.tables {
            let _ = writeln!(text, "{}", table.markdown(budgets));
        }
        for plot in &self.plots {
            let _ = writeln!(text, "![{}]({folder}/{})\n", plot.caption, plot.file);
        }
        text
    }
}

/// The rows that the README shows: table, row.
const HEADLINES: [(&str, &str); 13] = [
    ("gvirtualxray", "knee implant, femoral component"),
    ("gvirtualxray", "knee implant, tray"),
    ("gvirtualxray", "natural knee, femur"),
    ("gvirtualxray", "natural knee, tibia"),
    ("gvirtualxray", "natural knee, femur from MRI"),
    ("gvirtualxray", "natural knee, tibia from MRI"),
    ("end-to-end", "femoral component"),
    ("end-to-end", "tibial tray"),
    ("end-to-end", "distal femur"),
    ("end-to-end", "proximal tibia"),
    ("4.1-many", "femoral component, 15000 points"),
    ("4.1-many", "tibial component, 15000 points"),
    ("real", "real femur, pixel_origin = \"centre\""),
];
/// Between these lines the README has what [`headlines`] makes.
const MARKS: (&str, &str) = ("<!-- written by cargo xtask validate -->\n", "<!-- until here -->\n");

/// The table of the README, without limits: they stand where its rows come from.
fn headlines(sections: &[Section]) -> String {
    let tables: Vec<&Table> = sections.iter().flat_map(|s| &s.tables).collect();
    let columns = distribution_columns();
    let rows = HEADLINES.iter().filter_map(|(id, label)| {
        let table = tables.iter().find(|t| t.id == *id)?;
        let row = table.rows.iter().find(|r| r.label == *label)?;
        Some(Row {
            label: format!("{}: {label}", table.heading),
            ours: false,
            cells: row.cells[..columns.len()].to_vec(),
        })
    });
    let rows = rows.collect();
    Table { id: String::new(), heading: "measured".to_owned(), columns, rows }.plain()
}

/// The README with its table made anew; `None` where it has no place for it.
pub fn readme(text: &str, sections: &[Section]) -> Option<String> {
    let (before, rest) = text.split_once(MARKS.0)?;
    let (_, after) = rest.split_once(MARKS.1)?;
    Some(format!("{before}{}{}{}{after}", MARKS.0, headlines(sections), MARKS.1))
}

/// Name of the document's folder of plots.
const PLOTS: &str = "validation";

/// Writes `validation.md` and its plots into `folder`; plots of an earlier run that no section has any more are removed.
///
/// # Errors
/// A file cannot be written.
pub fn write(folder: &Path, head: &str, sections: &[Section], budgets: &Budgets) -> std::io::Result<()> {
    let plots = folder.join(PLOTS);
    std::fs::create_dir_all(&plots)?;
    let mut text = head.to_owned();
    for section in sections {
        text.push('\n');
        text.push_str(section.markdown(budgets, PLOTS).trim_end());
        text.push('\n');
        for plot in &section.plots {
            std::fs::write(plots.join(&plot.file), &plot.content)?;
        }
    }
    let kept: Vec<&str> = sections.iter().flat_map(|s| &s.plots).map(|p| p.file.as_str()).collect();
    for entry in std::fs::read_dir(&plots)? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.extension().is_some_and(|e| e == "svg" || e == "png") && !kept.contains(&name.as_str()) {
            std::fs::remove_file(path)?;
        }
    }
    std::fs::write(folder.join("validation.md"), text)
}

/// Puts sections into the `validation.md` of `folder` in place of those of their titles, or after all where there is none, and writes
/// their plots.
///
/// # Errors
/// A file cannot be read or written.
pub fn put(folder: &Path, sections: &[Section], budgets: &Budgets) -> std::io::Result<()> {
    let path = folder.join("validation.md");
    let document = std::fs::read_to_string(&path)?;
    let mut parts: Vec<String> = document.split("\n## ").map(str::to_owned).collect();
    for section in sections {
        let markdown = section.markdown(budgets, PLOTS);
        let own = markdown.trim_end().trim_start_matches("## ");
        let own = format!("{own}\n");
        let titled = |part: &&mut String| part.lines().next() == Some(section.title.as_str());
        match parts.iter_mut().skip(1).find(titled) {
            Some(part) => *part = own,
            None => parts.push(own),
        }
        for plot in &section.plots {
            std::fs::write(folder.join(PLOTS).join(&plot.file), &plot.content)?;
        }
    }
    std::fs::write(path, parts.join("\n## "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Cell;

    fn section(value: f64) -> Section {
        let cells = distribution_columns().iter().map(|_| Cell::Number(value)).collect();
        let rows = vec![Row::ours("femoral component", cells)];
        let table = Table {
            id: "end-to-end".to_owned(),
            heading: "from raw pictures".to_owned(),
            columns: distribution_columns(),
            rows,
        };
        Section { title: "A title".to_owned(), text: vec![], tables: vec![table], plots: vec![] }
    }

    #[test]
    fn the_readme_gets_its_rows_and_keeps_the_rest() {
        let text = format!("above\n{}old\n{}below\n", MARKS.0, MARKS.1);
        let made = readme(&text, &[section(0.125)]).unwrap();
        assert!(made.starts_with("above\n") && made.ends_with("below\n") && !made.contains("old"));
        assert!(made.contains("| from raw pictures: femoral component | 0.125 |"), "{made}");
        assert_eq!(readme(&made, &[section(0.125)]).as_deref(), Some(made.as_str()));
        assert_eq!(readme("no marks", &[]), None);
    }

    #[test]
    fn plots_of_an_earlier_run_go_and_other_files_stay() {
        let folder = tempfile::tempdir().unwrap();
        let plots = folder.path().join(PLOTS);
        std::fs::create_dir_all(&plots).unwrap();
        for name in ["old.svg", "notes.txt"] {
            std::fs::write(plots.join(name), "x").unwrap();
        }
        let plot = Plot { file: "new.svg".to_owned(), caption: "c".to_owned(), content: b"<svg/>".to_vec() };
        let one = Section { plots: vec![plot], ..section(1.0) };
        write(folder.path(), "# Head\n", &[one], &Budgets::built_in().unwrap()).unwrap();
        assert!(!plots.join("old.svg").exists() && plots.join("notes.txt").exists());
        let text = std::fs::read_to_string(folder.path().join("validation.md")).unwrap();
        assert!(text.contains("## A title") && text.contains("](validation/new.svg)"));
    }

    #[test]
    fn a_section_measured_alone_takes_the_place_of_its_own() {
        let folder = tempfile::tempdir().unwrap();
        let section = |title: &str, text: &str| Section {
            title: title.to_owned(),
            text: vec![text.to_owned()],
            tables: vec![],
            plots: vec![],
        };
        let budgets = Budgets::built_in().unwrap();
        write(folder.path(), "# Head\n", &[section("A", "one"), section("B", "two")], &budgets).unwrap();
        put(folder.path(), &[section("A", "three"), section("C", "four")], &budgets).unwrap();
        let text = std::fs::read_to_string(folder.path().join("validation.md")).unwrap();
        assert_eq!(text, "# Head\n\n## A\n\nthree\n\n## B\n\ntwo\n\n## C\n\nfour\n");
    }
}
