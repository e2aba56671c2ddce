//! The fluoroscopes in the laboratory: sources, detectors, central rays, beads and axes, from three sides and as one sees them.

use biplane_artifact::{BeadList, Environment, ViewEnvironment};
use biplane_geometry::{Point3, Pose, Vector2, Vector3};

use super::SpaceDrawingParams;
use super::arrows::round_below;
use super::colours::{FAINT, INK, Level, RULE, VIEWS};
use super::labels::Labels;
use super::sheet::{Heading, MARGIN, Row, SMALL, TEXT, WIDTH, quantity, sheet, shortened, table};
use super::svg::{Anchor, Font, Style, Svg};

/// Width of a panel.
const PANEL: f64 = (WIDTH - 3.0 * MARGIN) / 2.0;
/// Room for a panel's title above it.
const TITLE: f64 = 26.0;
/// Colours of the axes x, y, z.
const AXES: [&str; 3] = ["#c5161d", "#14803c", "#1a4fb4"];

/// Both fluoroscopes in space, drawn to scale from above, from the front and from the side, and in perspective, with the numbers and
/// the verdict.
pub fn space_drawing(environment: &Environment, beads: &BeadList, params: &SpaceDrawingParams) -> String {
    let things = Things::new(environment, beads);
    let mut caption = vec![format!("{} fluoroscopes", environment.views.len())];
    if let Some(angle) = environment.angle_deg {
        caption.push(format!("central rays of the first two at {}°", quantity(angle, 2, "")));
    }
    if let Some(rms) = environment.triangulation_rms_mm {
        let (rms, limit) = (quantity(rms, 3, "mm"), quantity(params.max_triangulation_mm, 3, "mm"));
        caption.push(format!("beads found again within {rms} rms (limit {limit})"));
    }
    let heading = Heading {
        title: "The fluoroscopes in the laboratory".to_owned(),
        caption: caption.join(", "),
        verdict: environment.verdict,
        warnings: &environment.warnings,
    };
    sheet(&heading, |svg, top| {
        let y = panels(svg, &things, top);
        let y = views(svg, environment, params, y + 8.0);
        triangulated(svg, environment, params, y + 12.0)
    })
}

/// A view's parts in space.
struct Part<'a> {
    name: &'a str,
    colour: &'static str,
    source: Point3,
    centre: Point3,
    corners: [Point3; 4],
}

/// All that is drawn.
struct Things<'a> {
    parts: Vec<Part<'a>>,
    beads: Vec<Point3>,
    /// Length of the drawn axes, mm.
    axis_mm: f64,
    low: Point3,
    high: Point3,
}

impl<'a> Things<'a> {
    fn new(environment: &'a Environment, beads: &BeadList) -> Self {
        let parts: Vec<Part> = environment.views.iter().enumerate().map(|(i, v)| part(i, v)).collect();
        let first = environment.bead_frames.first().map_or_else(Pose::identity, |p| (*p).into());
        let beads: Vec<Point3> = beads.0.iter().map(|b| first.transform(&Point3::from(b.at_mm))).collect();
        let corners = parts.iter().flat_map(|p| p.corners.into_iter().chain([p.source, p.centre]));
        let all: Vec<Point3> = corners.chain(beads.iter().copied()).chain([Point3::origin()]).collect();
        // Numbers that are none, or beyond any room, must not decide the scale.
        let sound = all.iter().filter(|p| p.coords.amax() < 1e6);
        let (mut low, mut high) = (Point3::origin(), Point3::origin());
        for p in sound {
            low = low.inf(p);
            high = high.sup(p);
        }
        let axis_mm = round_below(0.12 * (high - low).amax().max(10.0));
        Self {
            parts,
            beads,
            axis_mm,
            low: low - Vector3::repeat(axis_mm / 4.0),
            high: high + Vector3::repeat(axis_mm / 4.0),
        }
    }
}

fn part(place: usize, view: &ViewEnvironment) -> Part<'_> {
    let [x, y] = [view.along_x, view.along_y].map(Vector3::from);
    let half = view.size.map(|n| n as f64 * view.pixel_mm / 2.0);
    let centre = Point3::from(view.centre);
    let corner = |i: f64, j: f64| centre + x * (i * half[0]) + y * (j * half[1]);
    Part {
        name: &view.view,
        colour: VIEWS[place % VIEWS.len()],
        source: Point3::from(view.source),
        centre,
        corners: [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
    }
}

/// The four panels; returns where they end.
fn panels(svg: &mut Svg, things: &Things, top: f64) -> f64 {
    let extent = things.high - things.low;
    // One scale for all three, so that one can be held against another.
    let scale = (PANEL / extent.x.max(extent.y)).min(620.0 / extent.y).min(420.0 / extent.z);
    let (upper, lower) = ((extent.y * scale).max(330.0), extent.z * scale);
    let [left, right] = [MARGIN, 2.0 * MARGIN + PANEL];
    let second = top + TITLE + upper + 14.0;
    let flat = |across: usize, up: usize, size: [f64; 2]| {
        let (low, high) = (things.low, things.high);
        move |p: &Point3| {
            let middle = |axis: usize| (low[axis] + high[axis]) / 2.0;
            [
                size[0] / 2.0 + scale * (p[across] - middle(across)),
                size[1] / 2.0 - scale * (p[up] - middle(up)),
            ]
        }
    };
    let panel =
        |svg: &mut Svg, corner: [f64; 2], size: [f64; 2], title: &str, onto: &dyn Fn(&Point3) -> [f64; 2]| {
            svg.text([corner[0], corner[1] + 16.0], Font::new(TEXT, INK).bold(), title);
            let corner = [corner[0], corner[1] + TITLE];
            svg.group(Style::line("field", RULE, 1.0), |svg| svg.rectangle(corner, size));
            svg.window(corner, size, [0.0, 0.0], size, |svg| draw(svg, things, size, onto));
        };
    let size = [PANEL, upper];
    panel(svg, [left, top], size, "from above: x right, y up", &flat(0, 1, size));
    panel(svg, [right, top], size, "in perspective", &perspective(things, size));
    let size = [PANEL, lower];
    panel(svg, [left, second], size, "from the front: x right, z up", &flat(0, 2, size));
    panel(svg, [right, second], size, "from the side: y right, z up", &flat(1, 2, size));
    let y = second + TITLE + lower + 18.0;
    let shown = round_below(160.0 / scale);
    let end = left + shown * scale;
    svg.group(Style::line("scale", INK, 2.0), |svg| {
        let ticks = [left, end].map(|x| vec![[x, y - 5.0], [x, y + 5.0]]);
        svg.strokes(&[vec![vec![[left, y], [end, y]]], ticks.into()].concat(), false);
    });
    let note = format!("{} (not for the perspective)", quantity(shown, 0, "mm"));
    svg.text([end + 10.0, y + 5.0], Font::new(SMALL, INK), &note);
    y + 8.0
}

/// A camera that looks at the middle of everything, from the right, the front and above, as near as fits the panel.
fn perspective(things: &Things, size: [f64; 2]) -> impl Fn(&Point3) -> [f64; 2] {
    let middle = nalgebra::center(&things.low, &things.high);
    let distance = 1.6 * (things.high - things.low).norm();
    let away = Vector3::new(0.42, -0.72, 0.55).normalize();
    let right = Vector3::z().cross(&away).normalize();
    let up = away.cross(&right);
    let seen = move |p: &Point3| {
        let from = p - middle;
        let depth = (distance - from.dot(&away)).max(0.1 * distance);
        Vector2::new(from.dot(&right), -from.dot(&up)) / depth
    };
    let shown = things.parts.iter().flat_map(|p| p.corners.iter().chain([&p.source])).chain(&things.beads);
    let (mut low, mut high) = (Vector2::zeros(), Vector2::zeros());
    for p in shown.map(seen).filter(|p| p.amax() < 1e3) {
        low = low.inf(&p);
        high = high.sup(&p);
    }
    let room = Vector2::from(size) - Vector2::repeat(60.0);
    let zoom = room.component_div(&(high - low).add_scalar(1e-6)).min();
    move |p: &Point3| (Vector2::from(size) / 2.0 + (seen(p) - (low + high) / 2.0) * zoom).into()
}

/// Everything, through a projection onto the panel.
fn draw(svg: &mut Svg, things: &Things, size: [f64; 2], onto: &dyn Fn(&Point3) -> [f64; 2]) {
    for Part { colour, source, centre, corners, .. } in &things.parts {
        let beam = Style { opacity: 0.35, ..Style::line("beam", colour, 0.8) };
        svg.group(beam, |svg| {
            let rays: Vec<_> = corners.iter().map(|c| vec![onto(source), onto(c)]).collect();
            svg.strokes(&rays, false);
        });
        let face = Style { fill: colour, opacity: 0.12, ..Style::default() };
        svg.group(face, |svg| svg.polygon(&corners.map(|c| onto(&c))));
        svg.group(Style::line("detector", colour, 2.0), |svg| svg.polygon(&corners.map(|c| onto(&c))));
        let ray = Style { dash: 6.0, ..Style::line("ray", colour, 1.2) };
        svg.group(ray, |svg| svg.line(&[onto(source), onto(centre)]));
        svg.group(Style::area("source", colour), |svg| svg.circle(onto(source), 5.0));
    }
    svg.group(Style::area("beads", INK), |svg| things.beads.iter().for_each(|b| svg.circle(onto(b), 1.7)));
    let origin = onto(&Point3::origin());
    for (axis, (name, colour)) in ["x", "y", "z"].into_iter().zip(AXES).enumerate() {
        let mut tip = Point3::origin();
        tip[axis] = things.axis_mm;
        let tip = onto(&tip);
        let [dx, dy] = [tip[0] - origin[0], tip[1] - origin[1]];
        let length = dx.hypot(dy);
        // The axis that points at the viewer is a point.
        if length > 4.0 {
            svg.group(Style::line("axis", colour, 2.0), |svg| svg.line(&[origin, tip]));
            let at = [tip[0] + 9.0 * dx / length, tip[1] + 9.0 * dy / length + 4.0];
            let font = Font::new(SMALL, colour).bold().anchored(Anchor::Middle);
            svg.text(at, font, name);
        }
    }
    names(svg, things, size, onto);
}

/// The names of sources and detectors: each beside its place, where it covers least.
fn names(svg: &mut Svg, things: &Things, size: [f64; 2], onto: &dyn Fn(&Point3) -> [f64; 2]) {
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()].map(|a| (Point3::from(a * things.axis_mm), 12.0));
    let sources = things.parts.iter().map(|p| (p.source, 5.0));
    let beads = things.beads.iter().map(|b| (*b, 3.0));
    let marks = axes.into_iter().chain(sources).chain(beads).map(|(p, radius)| (onto(&p), radius));
    let mut labels = Labels::new([0.0, 0.0], size, marks);
    for Part { name, colour, source, corners, .. } in &things.parts {
        let highest = corners.iter().map(onto).min_by(|a, b| a[1].total_cmp(&b[1]));
        for (what, at) in [("source", Some(onto(source))), ("detector", highest)] {
            let text = format!("{}: {what}", shortened(name, 14));
            if let Some(at) = at {
                let at = labels.place(at, 6.0, &text, SMALL);
                svg.text(at, Font::new(SMALL, colour).bold(), &text);
            }
        }
    }
}

/// One line a view; returns where it ends.
fn views(svg: &mut Svg, environment: &Environment, params: &SpaceDrawingParams, top: f64) -> f64 {
    let triple = |v: [f64; 3]| v.map(|x| quantity(x, 1, "")).join(", ");
    let rows: Vec<Row> = environment
        .views
        .iter()
        .enumerate()
        .take(16)
        .map(|(place, view)| {
            let variance = |i: usize| environment.covariance.get(i).and_then(|row| row.get(i)).copied();
            let source = (0..3).map(|i| variance(9 * place + i).unwrap_or(f64::NAN)).sum::<f64>().sqrt();
            let used = view.beads.iter().filter(|b| b.used).count();
            let rms = view.reprojection_rms_px;
            let plain = |text: String| (text, Level::Plain);
            Row {
                cells: vec![
                    plain(shortened(&view.view, 16)),
                    plain(quantity(view.source_to_detector_mm, 1, "")),
                    plain(triple(view.source)),
                    plain(quantity(source, 2, "")),
                    plain(triple(view.centre)),
                    plain(format!("{used} of {}", view.beads.len() + view.missing.len())),
                    (quantity(rms, 3, ""), Level::of(rms, params.max_reprojection_px)),
                ],
                bold: false,
            }
        })
        .collect();
    let names = [
        "view",
        "source to detector",
        "source x y z, mm",
        "± mm",
        "detector's middle x y z, mm",
        "beads used",
        "residual, px",
    ];
    table(svg, [MARGIN, top], &names, &[230.0, 420.0, 480.0, 700.0, 820.0, 960.0], &rows)
}

/// How well beads are found again; returns where it ends.
fn triangulated(svg: &mut Svg, environment: &Environment, params: &SpaceDrawingParams, top: f64) -> f64 {
    let Some(rms) = environment.triangulation_rms_mm else { return top - 12.0 };
    let level = Level::of(rms, params.max_triangulation_mm);
    let text = format!(
        "{} beads, each found again from calibrations made without it: {} rms, limit {}",
        environment.triangulated.len(),
        quantity(rms, 3, "mm"),
        quantity(params.max_triangulation_mm, 3, "mm")
    );
    svg.text([MARGIN, top + 16.0], Font::new(TEXT, level.ink()).bold(), &text);
    let length = |e: &[f64; 3]| Vector3::from(*e).norm();
    let worst =
        environment.triangulated.iter().max_by(|a, b| length(&a.error_mm).total_cmp(&length(&b.error_mm)));
    let Some(worst) = worst else { return top + 16.0 };
    let [x, y, z] = worst.error_mm.map(|v| quantity(v, 3, ""));
    let text = format!("the farthest off is {}: {x}, {y}, {z} mm along x, y, z", shortened(&worst.name, 24));
    svg.text([MARGIN, top + 36.0], Font::new(SMALL, FAINT), &text);
    top + 36.0
}
