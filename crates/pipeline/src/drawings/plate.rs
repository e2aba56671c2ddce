//! The picture of a plate with what was found in it: holes used and left out, strays, holes that were not found.

use biplane_artifact::{Frame, ModelScore, PlateFit};

use super::backdrop::Backdrop;
use super::colours::{Level, MISSING, REJECTED, STRAY, USED};
use super::legend::{Mark, legend};
use super::sheet::{Heading, MARGIN, Row, WIDTH, facts, quantity, sheet, shortened, table};
use super::svg::{Style, Svg};
use super::{DrawingError, PlateDrawingParams};

/// Where the numbers beside the picture begin.
const BESIDE: f64 = 716.0;

/// The picture of a plate as backdrop, every hole with what became of it, the models that were tried, the numbers and the verdict.
///
/// # Errors
/// The frame is not that of the fit, or is none.
pub fn plate_drawing(
    frame: &Frame,
    fit: &PlateFit,
    params: &PlateDrawingParams,
) -> Result<String, DrawingError> {
    if [frame.width, frame.height] != fit.size {
        return Err(DrawingError::Size { frame: [frame.width, frame.height], artifact: fit.size });
    }
    let backdrop = Backdrop::new(frame)?;
    let heading = heading(fit, params, "the plate and what was found of it");
    Ok(sheet(&heading, |svg, top| {
        let (size, scale) = backdrop.fitted([BESIDE - 2.0 * MARGIN, 900.0]);
        backdrop.draw(svg, [MARGIN, top], size, |svg| marks(svg, fit, 1.0 / scale));
        let below = beside(svg, fit, params, top);
        below.max(top + size[1])
    }))
}

/// The heading of both drawings of a plate.
pub(super) fn heading<'a>(fit: &'a PlateFit, params: &PlateDrawingParams, what: &str) -> Heading<'a> {
    let used = fit.matched.iter().filter(|m| m.used).count();
    let held_out = chosen(fit).map_or(f64::NAN, |m| m.held_out_rms_px);
    Heading {
        title: format!("View {}: {what}", shortened(&params.view, 24)),
        caption: format!(
            "{}: held out {} rms (limit {}), {used} of {} matched holes used, distortion {} rms",
            shortened(&fit.model, 40),
            quantity(held_out, 3, "px"),
            quantity(params.max_held_out_px, 3, "px"),
            fit.matched.len(),
            quantity(fit.before_rms_px, 2, "px"),
        ),
        verdict: fit.verdict,
        warnings: &fit.warnings,
    }
}

/// The score of the model that the table was made from.
pub(super) fn chosen(fit: &PlateFit) -> Option<&ModelScore> {
    fit.models.iter().find(|m| m.name == fit.model)
}

/// About how far holes are from each other, px: as if they were spread evenly.
pub(super) fn spacing_px(fit: &PlateFit) -> f64 {
    let area = match fit.border {
        Some(circle) => std::f64::consts::PI * circle.radius_px.powi(2),
        None => fit.size[0] as f64 * fit.size[1] as f64,
    };
    let spacing = (area / fit.matched.len().max(1) as f64).sqrt();
    spacing.clamp(8.0, (fit.size[0].max(fit.size[1]) as f64 / 10.0).max(8.0))
}

/// The marks; a line one `unit` wide is as wide as a unit of the sheet.
fn marks(svg: &mut Svg, fit: &PlateFit, unit: f64) {
    let radius = (0.24 * spacing_px(fit)).max(4.0 * unit);
    if let Some(border) = fit.border {
        let style = Style { dash: 8.0 * unit, ..Style::line("border", MISSING, 1.5 * unit) };
        svg.group(style, |svg| svg.circle(border.centre_px, border.radius_px));
    }
    let of = |used: bool| fit.matched.iter().filter(move |m| m.used == used);
    svg.group(Style::line("used", USED, 1.2 * unit), |svg| {
        of(true).for_each(|m| svg.circle(m.at_px, radius))
    });
    svg.group(Style::line("rejected", REJECTED, 2.5 * unit), |svg| {
        of(false).for_each(|m| svg.circle(m.at_px, 1.25 * radius));
    });
    svg.group(Style::line("strays", STRAY, 2.5 * unit), |svg| {
        fit.strays_px.iter().for_each(|p| svg.cross(*p, radius));
    });
    svg.group(Style::line("missing", MISSING, 2.5 * unit), |svg| {
        fit.missing_px.iter().for_each(|p| svg.circle(*p, radius));
    });
}

/// What stands beside the picture; returns where it ends.
fn beside(svg: &mut Svg, fit: &PlateFit, params: &PlateDrawingParams, top: f64) -> f64 {
    let used = fit.matched.iter().filter(|m| m.used).count();
    let rejected = fit.matched.len() - used;
    let entries = [
        (Mark::Ring, USED, "holes used", Some(used)),
        (Mark::Ring, REJECTED, "holes left out: too far off", Some(rejected)),
        (Mark::Cross, STRAY, "spots that are no hole", Some(fit.strays_px.len())),
        (Mark::Ring, MISSING, "holes not found", Some(fit.missing_px.len())),
    ];
    let y = legend(svg, [BESIDE, top], &entries);
    let limit = params.max_held_out_px;
    let score = chosen(fit);
    let px = |value: Option<f64>| quantity(value.unwrap_or(f64::NAN), 3, "px");
    let held_out = score.map(|m| m.held_out_rms_px);
    let lines = [
        ("held-out rms", px(held_out), Level::of(held_out.unwrap_or(f64::NAN), limit)),
        ("limit", quantity(limit, 3, "px"), Level::Plain),
        ("95 % of them below", px(score.map(|m| m.held_out_p95_px)), Level::Plain),
        ("rms of the holes fitted", px(score.map(|m| m.fitted_rms_px)), Level::Plain),
        ("distortion, rms", quantity(fit.before_rms_px, 2, "px"), Level::Plain),
        ("there and back", quantity(fit.round_trip_px, 4, "px"), Level::Plain),
        ("pixel on the plate", quantity(fit.pixel_mm, 5, "mm"), Level::Plain),
        ("plate seen from its", if fit.mirrored { "back" } else { "front" }.to_owned(), Level::Plain),
    ];
    let y = facts(svg, [BESIDE, y], WIDTH - MARGIN - BESIDE, &lines);
    let rows: Vec<Row> = fit
        .models
        .iter()
        .take(24)
        .map(|m| Row {
            cells: vec![
                (shortened(&m.name, 24), Level::Plain),
                (quantity(m.fitted_rms_px, 3, ""), Level::Plain),
                (quantity(m.held_out_rms_px, 3, ""), Level::of(m.held_out_rms_px, limit)),
            ],
            bold: m.name == fit.model,
        })
        .collect();
    table(svg, [BESIDE, y + 16.0], &["model, rms in px", "fitted", "held out"], &[200.0, 264.0], &rows)
}
