//! Plots as SVG: errors against something that is varied, and figures of several methods side by side.

use biplane_artifact::Frame;
use image::{GrayImage, ImageFormat, imageops};
use plotters::coord::Shift;
use plotters::prelude::*;

use crate::Plot;

/// What went wrong while a plot was drawn.
#[derive(Debug, thiserror::Error)]
#[error("a plot cannot be drawn: {0}")]
pub struct PlotError(String);

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Colours that people who confuse red and green tell apart (Okabe and Ito 2008).
const COLOURS: [RGBColor; 5] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(120, 120, 120),
];

/// Values of one thing in a panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Its name in the legend.
    pub name: String,
    /// x and y; points with a y that is not a number are left out.
    pub points: Vec<(f64, f64)>,
}

/// A panel of a plot of lines.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// What x is, with its unit.
    pub x: String,
    /// What y is, with its unit.
    pub y: String,
    /// Lines.
    pub series: Vec<Series>,
    /// A value that may not be passed, if there is one.
    pub limit: Option<f64>,
}

fn failed(error: impl std::fmt::Display) -> PlotError {
    PlotError(error.to_string())
}

fn drawn(
    file: &str,
    caption: &str,
    size: (u32, u32),
    draw: impl FnOnce(&Area) -> Result<(), PlotError>,
) -> Result<Plot, PlotError> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        area.fill(&WHITE).map_err(failed)?;
        draw(&area)?;
        area.present().map_err(failed)?;
    }
    Ok(Plot { file: file.to_owned(), caption: caption.to_owned(), content: svg.into_bytes() })
}

impl Panel {
    /// Shares of values below x, of distributions that [`cumulative`] makes.
    pub fn shares(x: &str, series: Vec<Series>) -> Self {
        Self { x: x.to_owned(), y: SHARE.to_owned(), series, limit: None }
    }
}

/// What the y of distributions is.
const SHARE: &str = "share";

/// Lines, a panel beside the other. y starts at zero.
///
/// # Errors
/// [`PlotError`].
pub fn lines(file: &str, caption: &str, panels: &[Panel]) -> Result<Plot, PlotError> {
    let size = (420 * panels.len().max(1) as u32, 300);
    drawn(file, caption, size, |area| {
        for (panel, area) in panels.iter().zip(area.split_evenly((1, panels.len()))) {
            draw_lines(&area, panel)?;
        }
        Ok(())
    })
}

fn draw_lines(area: &Area, panel: &Panel) -> Result<(), PlotError> {
    let finite: Vec<(f64, f64)> = panel
        .series
        .iter()
        .flat_map(|s| s.points.iter().copied())
        .filter(|p| p.0.is_finite() && p.1.is_finite())
        .collect();
    let mut low = finite.iter().map(|p| p.0).fold(f64::INFINITY, f64::min);
    let high = finite.iter().map(|p| p.0).fold(f64::NEG_INFINITY, f64::max);
    let is_share = panel.y == SHARE;
    if is_share {
        low = low.min(0.0);
    }
    let top = finite.iter().map(|p| p.1).chain(panel.limit).fold(0.0, f64::max) * 1.15;
    if finite.is_empty() || high <= low {
        return Ok(());
    }
    // The legend goes where fewer points are.
    let crowded = |within: fn(f64, f64) -> bool| {
        finite.iter().filter(|p| within((p.0 - low) / (high - low), p.1 / top)).count()
    };
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .x_label_area_size(38)
        .y_label_area_size(56)
        .build_cartesian_2d(low..high, 0.0..top.max(1e-9))
        .map_err(failed)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_labels(7)
        .y_labels(6)
        .x_desc(&panel.x)
        .y_desc(&panel.y)
        .draw()
        .map_err(failed)?;
    for (series, colour) in panel.series.iter().zip(COLOURS.iter().cycle()) {
        let points: Vec<(f64, f64)> = series.points.iter().copied().filter(|p| p.1.is_finite()).collect();
        chart
            .draw_series(LineSeries::new(points.clone(), colour.stroke_width(2)))
            .map_err(failed)?
            .label(&series.name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], colour.stroke_width(2)));
        if !is_share {
            let dots = points.into_iter().map(|p| Circle::new(p, 3, colour.filled()));
            chart.draw_series(dots).map_err(failed)?;
        }
    }
    if let Some(limit) = panel.limit {
        chart
            .draw_series(LineSeries::new([(low, limit), (high, limit)], BLACK.mix(0.5).stroke_width(1)))
            .map_err(failed)?
            .label("limit")
            .legend(|(x, y)| PathElement::new([(x, y), (x + 16, y)], BLACK.mix(0.5).stroke_width(1)));
    }
    chart
        .configure_series_labels()
        .position(if crowded(|x, y| x < 0.5 && y > 0.5) > crowded(|x, y| x > 0.5 && y < 0.5) {
            SeriesLabelPosition::LowerRight
        } else {
            SeriesLabelPosition::UpperLeft
        })
        .background_style(WHITE.mix(0.8))
        .border_style(TRANSPARENT)
        .draw()
        .map_err(failed)
}

/// One line of a plot of dots: a label, and the value of each of the named series if it has one.
#[derive(Debug, Clone, PartialEq)]
pub struct Dots {
    /// Printed beside the line.
    pub label: String,
    /// One a series; `None` where there is none.
    pub values: Vec<Option<f64>>,
}

/// Values of several series, a line a row, on a logarithmic scale: how many times better one is, is a distance.
///
/// # Errors
/// [`PlotError`].
pub fn dots(file: &str, caption: &str, x: &str, series: &[&str], rows: &[Dots]) -> Result<Plot, PlotError> {
    let size = (760, 80 + 24 * (rows.len() + series.len()) as u32);
    drawn(file, caption, size, |area| {
        let values = || rows.iter().flat_map(|r| r.values.iter().flatten()).copied().filter(|v| *v > 0.0);
        let low = values().fold(f64::INFINITY, f64::min) / 1.6;
        let high = values().fold(0.0, f64::max) * 1.6;
        if high <= low {
            return Ok(());
        }
        let count = rows.len() as f64;
        let mut chart = ChartBuilder::on(area)
            .margin(12)
            .x_label_area_size(38)
            .y_label_area_size(270)
            // Above the rows there is room for the legend.
            .build_cartesian_2d((low..high).log_scale(), 0.0..count + series.len() as f64)
            .map_err(failed)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .disable_y_mesh()
            .y_labels(0)
            .x_desc(x)
            .x_label_formatter(&|v| if *v < 9e-4 { format!("{v:.0e}") } else { v.to_string() })
            .draw()
            .map_err(failed)?;
        for (index, row) in rows.iter().enumerate() {
            let y = count - index as f64 - 0.5;
            let at = chart.backend_coord(&(low, y));
            let style =
                TextStyle::from(("sans-serif", 13).into_font()).pos(plotters::style::text_anchor::Pos::new(
                    plotters::style::text_anchor::HPos::Right,
                    plotters::style::text_anchor::VPos::Center,
                ));
            area.draw_text(&row.label, &style, (at.0 - 8, at.1)).map_err(failed)?;
            chart
                .draw_series(LineSeries::new([(low, y), (high, y)], BLACK.mix(0.1).stroke_width(1)))
                .map_err(failed)?;
        }
        for (column, (name, colour)) in series.iter().zip(COLOURS.iter().cycle()).enumerate() {
            let points: Vec<(f64, f64)> = rows
                .iter()
                .enumerate()
                .filter_map(|(index, r)| {
                    let value = r.values.get(column).copied().flatten().filter(|v| *v > 0.0)?;
                    Some((value, count - index as f64 - 0.5))
                })
                .collect();
            chart
                .draw_series(points.into_iter().map(|p| Circle::new(p, 5, colour.filled())))
                .map_err(failed)?
                .label(*name)
                .legend(move |(x, y)| Circle::new((x + 8, y), 5, colour.filled()));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .background_style(WHITE.mix(0.8))
            .border_style(TRANSPARENT)
            .draw()
            .map_err(failed)
    })
}

/// Distributions of position errors (mm) and rotation errors (degrees), a panel each.
///
/// # Errors
/// [`PlotError`].
pub fn distributions(file: &str, caption: &str, errors: [Vec<Series>; 2]) -> Result<Plot, PlotError> {
    let [mm, deg] = errors;
    let panels = [Panel::shares("position error, mm", mm), Panel::shares("rotation error, degrees", deg)];
    lines(file, caption, &panels)
}

/// Side of a frame in a strip, px.
const TILE_PX: u32 = 320;

/// Frames beside each other as a PNG, each scaled to 320 px and stretched to its own range of grey levels.
///
/// # Errors
/// [`PlotError`].
pub fn strip(file: &str, caption: &str, frames: &[&Frame]) -> Result<Plot, PlotError> {
    let mut joined = GrayImage::new(TILE_PX * frames.len() as u32, TILE_PX);
    for (index, frame) in frames.iter().enumerate() {
        let top = f64::from(frame.samples.iter().copied().max().unwrap_or(1).max(1));
        // The square root shows bone and metal beside the open beam.
        let grey = |s: &u16| (255.0 * (f64::from(*s) / top).sqrt()) as u8;
        let pixels = frame.samples.iter().map(grey).collect();
        let full = GrayImage::from_raw(frame.width as u32, frame.height as u32, pixels)
            .ok_or_else(|| failed("a frame has not as many samples as pixels"))?;
        let tile = imageops::resize(&full, TILE_PX, TILE_PX, imageops::FilterType::Triangle);
        imageops::replace(&mut joined, &tile, i64::from(TILE_PX) * index as i64, 0);
    }
    let mut content = Vec::new();
    joined.write_to(&mut std::io::Cursor::new(&mut content), ImageFormat::Png).map_err(failed)?;
    Ok(Plot { file: file.to_owned(), caption: caption.to_owned(), content })
}

/// The share of values that are at most x, as points of a line: shows a distribution whole.
pub fn cumulative(name: &str, values: &[f64]) -> Series {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let count = sorted.len() as f64;
    // Of many values every so many are drawn, and always the first and the last.
    let step = (sorted.len() / 60).max(1);
    let picked = sorted.iter().enumerate().filter(|(i, _)| i % step == 0 || i + 1 == sorted.len());
    let first = sorted.first().map(|v| (*v, 0.0));
    let points = first.into_iter().chain(picked.map(|(i, v)| (*v, (i + 1) as f64 / count)));
    Series { name: name.to_owned(), points: points.collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(plot: &Plot) -> String {
        String::from_utf8(plot.content.clone()).unwrap()
    }

    #[test]
    fn plots_hold_their_lines_and_labels() {
        let series = |name: &str| Series {
            name: name.to_owned(),
            points: vec![(0.0, 1.0), (1.0, 2.0), (2.0, f64::NAN)],
        };
        let panel = Panel {
            x: "noise, px".to_owned(),
            y: "error, mm".to_owned(),
            series: vec![series("default"), series("thesis")],
            limit: Some(3.0),
        };
        let plot = lines("a.svg", "A caption", &[panel.clone(), panel]).unwrap();
        for word in ["noise, px", "error, mm", "default", "thesis", "limit"] {
            assert!(text(&plot).contains(word), "{word}");
        }
        let rows = [Dots { label: "femoral component".to_owned(), values: vec![Some(0.01), None] }];
        let plot = dots("b.svg", "B", "mm", &["ours", "thesis"], &rows).unwrap();
        assert!(text(&plot).contains("femoral component"));
        let nothing = Panel { x: String::new(), y: String::new(), series: vec![], limit: None };
        assert!(lines("c.svg", "", &[nothing]).is_ok());
        assert!(dots("d.svg", "", "", &[], &[]).is_ok());
    }

    #[test]
    fn cumulative_ends_at_one() {
        let s = cumulative("x", &[3.0, 1.0, 2.0, 4.0]);
        assert_eq!(s.points, [(1.0, 0.0), (1.0, 0.25), (2.0, 0.5), (3.0, 0.75), (4.0, 1.0)]);
    }
}
