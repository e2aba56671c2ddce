//! What is left after the correction, hole by hole, and what the correction takes away.
//!
//! Residuals are those of holes held out of the fit, as arrows magnified by a round number. The distortion is drawn as a grid of
//! straight, square lines as the recorded picture shows them, its bends magnified where they would not be seen.

use biplane_artifact::{DistortionTable, PlateFit};
use biplane_fluoroscope::Distortion;
use biplane_geometry::Point2;

use super::arrows::{Magnified, round_below};
use super::backdrop::fitted;
use super::colours::{FAINT, INK, Level, RULE, by_length};
use super::plate::{heading, spacing_px};
use super::sheet::{MARGIN, SMALL, TEXT, WIDTH, quantity, sheet};
use super::svg::{Anchor, Font, Style, Svg};
use super::{DrawingError, PlateDrawingParams};

/// Width of each of the two fields.
const FIELD: f64 = (WIDTH - 3.0 * MARGIN) / 2.0;
/// Squares of the grid along the picture's longer side.
const SQUARES: usize = 16;
/// Points of a line of the grid between two others.
const FINE: usize = 6;

/// The residuals of the holes, the distortion, and how residuals are spread.
///
/// # Errors
/// The fit's distortion table is not one.
pub fn residual_drawing(fit: &PlateFit, params: &PlateDrawingParams) -> Result<String, DrawingError> {
    check(&fit.table)?;
    let distortion = Distortion::from(&fit.table);
    let heading = heading(fit, params, "what is left after the correction");
    Ok(sheet(&heading, |svg, top| {
        let extent = fit.size.map(|v| v as f64);
        let (size, scale) = fitted(extent, [FIELD, 700.0]);
        let (left, right) = ([MARGIN, top + 28.0], [2.0 * MARGIN + FIELD, top + 28.0]);
        let title = Font::new(TEXT, INK).bold();
        svg.text([left[0], top + 16.0], title, "Residuals of held-out holes");
        svg.text([right[0], top + 16.0], title, "Square lines as the picture shows them");
        for corner in [left, right] {
            svg.group(Style::line("field", RULE, 1.0), |svg| svg.rectangle(corner, size));
        }
        let y = left[1] + size[1] + 22.0;
        arrows(svg, fit, params, left, size, scale, y);
        let spread = histogram(svg, fit, params, [left[0], y + 66.0]);
        let described = grid(svg, fit, &distortion, right, size, scale, y);
        spread.max(described)
    }))
}

/// That a table can be looked up at all.
fn check(table: &DistortionTable) -> Result<(), DrawingError> {
    let DistortionTable { first_px, step_px, count, ideal_px } = table;
    let whole = count.iter().all(|n| *n >= 2) && count[0].checked_mul(count[1]) == Some(ideal_px.len());
    let numbers = first_px.iter().chain(step_px).chain(ideal_px.iter().flatten()).all(|v| v.is_finite());
    if whole && numbers && step_px.iter().all(|s| *s > 0.0) {
        Ok(())
    } else {
        Err(DrawingError::Table { count: *count, samples: ideal_px.len() })
    }
}

fn length(residual: [f64; 2]) -> f64 {
    residual[0].hypot(residual[1])
}

fn arrows(
    svg: &mut Svg,
    fit: &PlateFit,
    params: &PlateDrawingParams,
    corner: [f64; 2],
    size: [f64; 2],
    scale: f64,
    below: f64,
) {
    let used = || fit.matched.iter().filter(|m| m.used);
    let magnified = Magnified::of(used().map(|m| length(m.residual_px)), 0.9 * spacing_px(fit));
    let unit = 1.0 / scale;
    let mut cut = 0;
    svg.window(corner, size, [-0.5, -0.5], fit.size.map(|v| v as f64), |svg| {
        if let Some(border) = fit.border {
            svg.group(Style::line("border", RULE, unit), |svg| {
                svg.circle(border.centre_px, border.radius_px);
            });
        }
        svg.group(Style::line("residuals", INK, 1.3 * unit), |svg| {
            for spot in used() {
                let (strokes, is_cut) = magnified.arrow(spot.at_px, spot.residual_px);
                cut += usize::from(is_cut);
                let colour = by_length(length(spot.residual_px), params.max_held_out_px);
                let style = Style { stroke: &colour, ..Style::default() };
                svg.group(style, |svg| svg.strokes(&strokes, false));
            }
        });
        let red = Level::Bad.ink();
        svg.group(Style::line("rejected", red, 2.0 * unit), |svg| {
            for spot in fit.matched.iter().filter(|m| !m.used) {
                let (mut strokes, is_cut) = magnified.arrow(spot.at_px, spot.residual_px);
                cut += usize::from(is_cut);
                let [x, y] = spot.at_px;
                let half = 4.0 * unit;
                strokes.push(vec![[x - half, y - half], [x + half, y + half]]);
                strokes.push(vec![[x - half, y + half], [x + half, y - half]]);
                svg.strokes(&strokes, false);
            }
        });
    });
    magnified.bar(svg, [corner[0], below], scale, INK, SMALL);
    let rejected = fit.matched.len() - used().count();
    let note = match (rejected, cut) {
        (0, 0) => String::new(),
        (n, 0) => format!("{n} with a red cross are left out of the fit"),
        (n, c) => format!("{n} with a red cross are left out of the fit; {c} arrows are cut short"),
    };
    svg.text([corner[0], below + 44.0], Font::new(SMALL, Level::Bad.ink()), &note);
    // The colours, on a bar of their own.
    let [x, width, y] = [corner[0] + 100.0, 180.0, below + 16.0];
    svg.text([corner[0], y + 11.0], Font::new(SMALL, FAINT), "length: 0");
    for step in 0..36 {
        let share = f64::from(step) / 35.0;
        let colour = by_length(2.0 * share, 1.0);
        svg.group(Style::area("colours", &colour), |svg| {
            svg.rectangle([x + width * f64::from(step) / 36.0 - 36.0, y], [width / 36.0 + 0.3, 12.0]);
        });
    }
    let limit = params.max_held_out_px;
    let legend =
        format!("{} (limit in the middle: {})", quantity(2.0 * limit, 2, "px"), quantity(limit, 2, "px"));
    svg.text([x + width - 28.0, y + 11.0], Font::new(SMALL, FAINT), &legend);
}

/// How many residuals are how long, and where the limit lies; returns where it ends.
fn histogram(svg: &mut Svg, fit: &PlateFit, params: &PlateDrawingParams, corner: [f64; 2]) -> f64 {
    const BINS: usize = 24;
    const HEIGHT: f64 = 130.0;
    let lengths: Vec<f64> = fit
        .matched
        .iter()
        .filter(|m| m.used)
        .map(|m| length(m.residual_px))
        .filter(|l| l.is_finite())
        .collect();
    let limit = params.max_held_out_px;
    let longest = lengths.iter().copied().fold(0.0, f64::max);
    // To just beyond the limit where residuals keep it, so that one sees by how much.
    let end = if limit.is_finite() { longest.max(1.15 * limit) } else { longest }.max(1e-3);
    let mut bins = [0_usize; BINS];
    for l in &lengths {
        bins[((l / end * BINS as f64) as usize).min(BINS - 1)] += 1;
    }
    let most = bins.iter().copied().max().unwrap_or(0).max(1);
    let [x, y] = corner;
    let base = y + 40.0 + HEIGHT;
    let title = format!("How long the {} residuals used are", lengths.len());
    svg.text([x, y + 12.0], Font::new(TEXT, INK).bold(), &title);
    svg.group(Style::default(), |svg| {
        for (place, number) in bins.iter().enumerate() {
            let middle = (place as f64 + 0.5) / BINS as f64 * end;
            let height = HEIGHT * *number as f64 / most as f64;
            let colour = by_length(middle, limit);
            let bar = FIELD / BINS as f64;
            svg.group(Style::area("bin", &colour), |svg| {
                svg.rectangle([x + bar * place as f64, base - height], [bar - 1.0, height]);
            });
        }
    });
    svg.group(Style::line("axis", FAINT, 1.0), |svg| svg.line(&[[x, base], [x + FIELD, base]]));
    let small = Font::new(SMALL, FAINT);
    svg.text([x, base + 16.0], small, "0");
    svg.text([x + FIELD, base + 16.0], small.anchored(Anchor::End), &quantity(end, 3, "px"));
    if limit <= end {
        let at = x + FIELD * limit / end;
        let style = Style { dash: 4.0, ..Style::line("limit", INK, 1.5) };
        svg.group(style, |svg| svg.line(&[[at, base], [at, y + 38.0]]));
        let font = Font::new(SMALL, INK).anchored(if at > x + 60.0 { Anchor::End } else { Anchor::Start });
        svg.text([at, y + 33.0], font, "limit");
    }
    base + 18.0
}

/// The grid, and what is said of it; returns where it ends.
fn grid(
    svg: &mut Svg,
    fit: &PlateFit,
    distortion: &Distortion,
    corner: [f64; 2],
    size: [f64; 2],
    scale: f64,
    below: f64,
) -> f64 {
    let [width, height] = fit.size.map(|v| v as f64);
    let step = width.max(height) / SQUARES as f64;
    let inside = |p: &Point2| match fit.border {
        Some(border) => (p - Point2::from(border.centre_px)).norm() <= border.radius_px,
        None => (0.0..=width - 1.0).contains(&p.x) && (0.0..=height - 1.0).contains(&p.y),
    };
    let middle = [(width - 1.0) / 2.0, (height - 1.0) / 2.0];
    // A line of the grid, fixed along one axis: ideal points with the recorded ones where the picture shows them.
    let line = |axis: usize, place: isize| -> Vec<Option<[Point2; 2]>> {
        let fine = (SQUARES * FINE) as isize;
        (-fine..=fine)
            .map(|k| {
                let mut ideal = middle;
                ideal[axis] += place as f64 * step;
                ideal[1 - axis] += k as f64 * step / FINE as f64;
                let ideal = Point2::from(ideal);
                distortion.recorded(&ideal).filter(inside).map(|recorded| [ideal, recorded])
            })
            .collect()
    };
    let half = SQUARES as isize;
    let lines: Vec<_> = [0, 1].into_iter().flat_map(|a| (-half..=half).map(move |k| (a, k))).collect();
    let lines: Vec<Vec<Option<[Point2; 2]>>> = lines.into_iter().map(|(a, k)| line(a, k)).collect();
    let moved = |[ideal, recorded]: &[Point2; 2]| (recorded - ideal).norm();
    let largest = lines.iter().flatten().flatten().map(moved).fold(0.0, f64::max);
    let factor = round_below(0.05 * width.max(height) / largest.max(1e-3)).max(1.0);
    let unit = 1.0 / scale;
    let drawn =
        |[ideal, recorded]: &[Point2; 2]| -> [f64; 2] { (ideal + (recorded - ideal) * factor).into() };
    svg.window(corner, size, [-0.5, -0.5], [width, height], |svg| {
        if let Some(border) = fit.border {
            svg.group(Style::line("border", RULE, unit), |svg| {
                svg.circle(border.centre_px, border.radius_px);
            });
        }
        let runs = |of: &dyn Fn(&[Point2; 2]) -> [f64; 2]| -> Vec<Vec<[f64; 2]>> {
            let split = lines.iter().flat_map(|l| l.split(Option::is_none));
            split.map(|run| run.iter().flatten().map(of).collect()).filter(|r: &Vec<_>| r.len() > 1).collect()
        };
        svg.group(Style::line("square", RULE, unit), |svg| svg.strokes(&runs(&|p| p[0].into()), false));
        svg.group(Style::line("warped", "#0072b2", 1.5 * unit), |svg| svg.strokes(&runs(&drawn), false));
    });
    let how = if factor > 1.0 { format!("; bends drawn × {factor}") } else { String::new() };
    let texts = [
        format!("blue: lines that are straight and square in space{how}"),
        "grey: the same without distortion".to_owned(),
        format!(
            "moved by at most {}, {} rms over the holes",
            quantity(largest, 1, "px"),
            quantity(fit.before_rms_px, 2, "px")
        ),
        format!("model: {}", super::sheet::shortened(&fit.model, 50)),
        format!("recorded to ideal pixels and back: {} at most", quantity(fit.round_trip_px, 4, "px")),
    ];
    for (place, text) in texts.iter().enumerate() {
        svg.text([corner[0], below + 4.0 + 20.0 * place as f64], Font::new(SMALL, INK), text);
    }
    below + 20.0 * texts.len() as f64
}
