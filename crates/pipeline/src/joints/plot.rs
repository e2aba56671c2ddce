//! A joint over the frames of a trial: three angles and three translations with their 95 % bands, as SVG.

use plotters::coord::Shift;
use plotters::prelude::*;

use super::StudyJoint;
use super::series::Series;
use crate::outcome::Outcome;
use crate::study::Study;

/// Colour of a line and of its band (Okabe and Ito 2008).
const LINE: RGBColor = RGBColor(0, 114, 178);
/// Frames whose poses are not both good.
const DOUBTFUL: RGBColor = RGBColor(213, 94, 0);

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// One frame in a panel: when, the value, and half the width of its interval.
type Mark = (f64, f64, Option<f64>, bool);

/// The drawing of a joint over a trial.
///
/// # Errors
/// What the library of plots says.
pub fn plot(
    study: &Study,
    outcome: &Outcome,
    joint: &StudyJoint,
    series: &Series<'_>,
) -> Result<String, String> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (900, 640)).into_drawing_area();
        area.fill(&WHITE).map_err(|e| e.to_string())?;
        let title = format!("{} of {}: value and 95 % interval", joint.name, study.trials[series.trial].name);
        let area = area.titled(&title, ("sans-serif", 18)).map_err(|e| e.to_string())?;
        let timed = series.frames.iter().all(|f| outcome.frames[f.frame].time_s.is_some());
        let names = joint.convention.names();
        let panels = area.split_evenly((3, 2));
        for (k, name) in names.iter().enumerate() {
            // Angles on the left, translations on the right.
            let panel = &panels[2 * (k % 3) + k / 3];
            let at = |number: usize, frame: usize| {
                if timed { outcome.frames[frame].time_s.unwrap_or_default() } else { number as f64 + 1.0 }
            };
            let marks: Vec<Option<Mark>> = series
                .frames
                .iter()
                .enumerate()
                .map(|(number, f)| {
                    let good = f.joint.verdict == biplane_artifact::Verdict::Good;
                    Some((at(number, f.frame), f.values?[k], f.half_widths.map(|h| h[k]), good))
                })
                .collect();
            let unit = if k < 3 { "°" } else { "mm" };
            let x = if timed { "time, s" } else { "frame" };
            draw(panel, &format!("{}, {unit}", name.replace('_', " ")), x, &marks)
                .map_err(|e| e.to_string())?;
        }
        area.present().map_err(|e| e.to_string())?;
    }
    Ok(svg)
}

fn draw(area: &Area, y: &str, x: &str, marks: &[Option<Mark>]) -> Result<(), Box<dyn std::error::Error>> {
    let known: Vec<Mark> = marks.iter().flatten().copied().filter(|m| m.1.is_finite()).collect();
    let half = |m: &Mark| m.2.filter(|h| h.is_finite()).unwrap_or_default();
    let low = known.iter().map(|m| m.1 - half(m)).fold(f64::INFINITY, f64::min);
    let high = known.iter().map(|m| m.1 + half(m)).fold(f64::NEG_INFINITY, f64::max);
    let (Some(first), Some(last)) = (known.first().map(|m| m.0), known.last().map(|m| m.0)) else {
        return Ok(());
    };
    let room = (0.08 * (high - low)).max(0.05);
    let span = first..last.max(first + 1e-6);
    let mut chart = ChartBuilder::on(area)
        .margin(10)
        .x_label_area_size(32)
        .y_label_area_size(52)
        .build_cartesian_2d(span, low - room..high + room)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(RGBColor(225, 225, 225))
        .x_desc(x)
        .y_desc(y)
        .y_labels(6)
        .draw()?;
    // Without a bridge over frames that have no value.
    for run in marks.split(|m| m.is_none()) {
        let run: Vec<Mark> = run.iter().flatten().copied().collect();
        let above = run.iter().map(|m| (m.0, m.1 + half(m)));
        let below = run.iter().rev().map(|m| (m.0, m.1 - half(m)));
        let band: Vec<(f64, f64)> = above.chain(below).collect();
        chart.draw_series(std::iter::once(Polygon::new(band, LINE.mix(0.25))))?;
        chart.draw_series(LineSeries::new(run.iter().map(|m| (m.0, m.1)), LINE.stroke_width(2)))?;
        let dots = run.iter().map(|m| {
            let (size, colour) = if m.3 { (2, LINE) } else { (4, DOUBTFUL) };
            Circle::new((m.0, m.1), size, colour.filled())
        });
        chart.draw_series(dots)?;
    }
    Ok(())
}
