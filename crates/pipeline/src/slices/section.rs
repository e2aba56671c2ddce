//! Faults of `[[slices]]` that reading the file does not find, at their lines.

use std::ops::Range;

use biplane_slices::SlicesError;

use crate::config::SlicesSection;
use crate::diagnostics::Problem;

/// What is wrong with how bones are to be found.
pub fn faults(sections: &[SlicesSection], text: &str) -> Vec<Problem> {
    let faulty =
        sections.iter().enumerate().filter_map(|(n, s)| Some((n, s, s.find.get_ref().check().err()?)));
    faulty
        .map(|(number, section, error)| {
            let key = match &error {
                SlicesError::Parameter { name, .. } => Some(*name),
                _ => None,
            };
            let span = key.and_then(|key| place(text, number, key)).unwrap_or_else(|| section.find.span());
            Problem::at(span, format!("bone {}: {error}", section.name.get_ref()))
        })
        .collect()
}

/// Where a key of `find` stands in the table of this number.
fn place(text: &str, number: usize, key: &str) -> Option<Range<usize>> {
    let tables = toml::de::DeTable::parse(text).ok()?;
    let sections = tables.get_ref().get("slices")?.get_ref().as_array()?;
    let find = sections.get(number)?.get_ref().as_table()?.get("find")?.get_ref().as_table()?;
    Some(find.get(key)?.span())
}
