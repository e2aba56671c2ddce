//! Faults of `[[body]]` that reading the file does not find, at their lines.

use std::ops::Range;

use biplane_axes::AxesError;
use biplane_label_surface::{LabelSurfaceError, LabelSurfaceParams};
use biplane_lofting::LoftError;
use biplane_point_model::ModelError;

use crate::config::{BodySection, SlicesSection};
use crate::diagnostics::Problem;

/// What is wrong with how the models of bodies are to be made.
pub fn faults(bodies: &[BodySection], bones: &[SlicesSection], text: &str) -> Vec<Problem> {
    let mut problems = Vec::new();
    for (number, body) in bodies.iter().enumerate() {
        let name = body.name.get_ref();
        let mut fault = |table: &str, key: Option<&str>, whole: Range<usize>, message: String| {
            let span = key.and_then(|key| place(text, number, table, key)).unwrap_or(whole);
            problems.push(Problem::at(span, format!("body {name}: {message}")));
        };
        if let Some(loft) = &body.loft
            && let Err(error) = loft.get_ref().check()
        {
            let key = match &error {
                LoftError::Parameter { name, .. } => Some(*name),
                _ => None,
            };
            fault("loft", key, loft.span(), error.to_string());
        }
        if let Some(labels) = &body.label_surface {
            // A label that is not given is that of the slices.
            let own = labels.get_ref();
            let of_bone =
                bones.iter().find(|b| body.slices.as_ref().is_some_and(|s| s.get_ref() == b.name.get_ref()));
            let label =
                if own.label == 0 { of_bone.map_or(1, |b| b.find.get_ref().label.max(1)) } else { own.label };
            if let Err(error) = (LabelSurfaceParams { label, ..own.clone() }).check() {
                let key = match &error {
                    LabelSurfaceError::Parameter { name, .. } => Some(*name),
                    _ => None,
                };
                fault("label_surface", key, labels.span(), error.to_string());
            }
        }
        if let Some(model) = &body.model
            && let Err(error) = model.get_ref().check()
        {
            let key = match &error {
                ModelError::Parameter { name, .. } => Some(*name),
                _ => None,
            };
            fault("model", key, model.span(), error.to_string());
        }
        if let Some(axes) = &body.axes
            && let Err(error) = axes.get_ref().check()
        {
            let key = match &error {
                AxesError::NoSide { .. } => Some("body"),
                _ => None,
            };
            fault("axes", key, axes.span(), error.to_string());
        }
    }
    problems
}

/// Where a key of a table of the body of this number stands.
fn place(text: &str, number: usize, table: &str, key: &str) -> Option<Range<usize>> {
    let tables = toml::de::DeTable::parse(text).ok()?;
    let bodies = tables.get_ref().get("body")?.get_ref().as_array()?;
    let inner = bodies.get(number)?.get_ref().as_table()?.get(table)?.get_ref().as_table()?;
    Some(inner.get(key)?.span())
}
