//! Sections of tables and plots, and `docs/validation.md` made of them.

use std::fmt::Write;
use std::path::Path;

use crate::{Budgets, Table};

/// A plot, ready to be written.
#[derive(Debug, Clone, PartialEq)]
pub struct Plot {
    /// Its file's name.
    pub file: String,
    /// What it shows.
    pub caption: String,
    /// The picture.
    pub svg: String,
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
            std::fs::write(plots.join(&plot.file), &plot.svg)?;
        }
    }
    let kept: Vec<&str> = sections.iter().flat_map(|s| &s.plots).map(|p| p.file.as_str()).collect();
    for entry in std::fs::read_dir(&plots)? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.extension().is_some_and(|e| e == "svg") && !kept.contains(&name.as_str()) {
            std::fs::remove_file(path)?;
        }
    }
    std::fs::write(folder.join("validation.md"), text)
}
