//! A body's axes as arrows, and the figures they were made from as lines in space, over a shaded picture of the body.

use biplane_artifact::{AxesFeature, AxesSource, BodyAxes};
use biplane_geometry::{Point3, Vector3};

use super::camera::Camera;
use super::colours::{INK, Level};
use super::labels::Labels;
use super::shaded::Picture;
use super::sheet::{SMALL, shortened};
use super::svg::{Font, Style, Svg};

/// Colours of the axes x, y, z.
const AXES: [&str; 3] = ["#d3202c", "#14803c", "#1a4fb4"];
/// What the axes mean.
const NAMES: [&str; 3] = ["X anterior", "Y proximal", "Z right"];
/// Colour of the figures.
const FIGURE: &str = "#7b2d8e";
/// Sides of what stands for a circle.
const SIDES: usize = 48;
/// Lines along a cylinder.
const ALONG: usize = 6;
/// Figures that are named, so that names do not cover all.
const NAMED: usize = 14;

/// Who said where the axes lie, for a person, and whether that wants a look.
pub(super) fn source(axes: &BodyAxes) -> (&'static str, Level) {
    match axes.source {
        AxesSource::Points => ("axes by a person's points", Level::Good),
        AxesSource::Landmarks => ("axes by a person's landmarks", Level::Good),
        AxesSource::Shape => ("axes proposed from the shape", Level::Near),
    }
}

/// The tips of the arrows.
pub(super) fn tips(axes: &BodyAxes, length_mm: f64) -> [Point3; 3] {
    axes.axes.map(|a| Point3::from(axes.origin_mm) + Vector3::from(a) * length_mm)
}

/// Places that the spheres and cylinders reach to.
pub(super) fn reaches(axes: &BodyAxes) -> Vec<Point3> {
    let round = |f: &&AxesFeature| matches!(f, AxesFeature::Sphere { .. } | AxesFeature::Cylinder { .. });
    axes.features.iter().filter(round).flat_map(|f| lines(f, axes)).flat_map(|(line, _)| line).collect()
}

/// A figure as lines, each with whether it is closed; a point has none.
fn lines(figure: &AxesFeature, axes: &BodyAxes) -> Vec<(Vec<Point3>, bool)> {
    let circle = |centre: Point3, u: Vector3, v: Vector3, radius: f64| {
        let at = |n: usize| {
            let (sin, cos) = (n as f64 * std::f64::consts::TAU / SIDES as f64).sin_cos();
            centre + (u * cos + v * sin) * radius
        };
        ((0..SIDES).map(at).collect::<Vec<Point3>>(), true)
    };
    match figure {
        AxesFeature::Point { .. } => Vec::new(),
        AxesFeature::Line { from_mm, to_mm, .. } => {
            vec![(vec![Point3::from(*from_mm), Point3::from(*to_mm)], false)]
        }
        AxesFeature::Sphere { centre_mm, radius_mm, .. } => {
            let [x, y, z] = axes.axes.map(Vector3::from);
            [(x, y), (y, z), (z, x)].map(|(u, v)| circle((*centre_mm).into(), u, v, *radius_mm)).into()
        }
        AxesFeature::Cylinder { from_mm, to_mm, radius_mm, .. } => {
            let (from, to) = (Point3::from(*from_mm), Point3::from(*to_mm));
            let [u, v] = across(&(to - from));
            let mut lines = vec![circle(from, u, v, *radius_mm), circle(to, u, v, *radius_mm)];
            for n in 0..ALONG {
                let (sin, cos) = (n as f64 * std::f64::consts::TAU / ALONG as f64).sin_cos();
                let out = (u * cos + v * sin) * *radius_mm;
                lines.push((vec![from + out, to + out], false));
            }
            lines
        }
        AxesFeature::Plane { centre_mm, normal, radius_mm, .. } => {
            let [u, v] = across(&Vector3::from(*normal));
            vec![circle((*centre_mm).into(), u, v, *radius_mm)]
        }
    }
}

/// Two unit vectors at right angles to one and to each other.
fn across(way: &Vector3) -> [Vector3; 2] {
    let way = way.try_normalize(0.0).unwrap_or(Vector3::z());
    let least = if way.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
    let u = way.cross(&least).normalize();
    [u, way.cross(&u)]
}

/// A figure's name, and the place it is written at.
fn named(figure: &AxesFeature) -> (&str, Point3) {
    match figure {
        AxesFeature::Point { name, at_mm } => (name, Point3::from(*at_mm)),
        AxesFeature::Line { name, to_mm, .. } => (name, Point3::from(*to_mm)),
        AxesFeature::Sphere { name, centre_mm, .. } => (name, Point3::from(*centre_mm)),
        AxesFeature::Cylinder { name, from_mm, to_mm, .. } => {
            (name, nalgebra::center(&Point3::from(*from_mm), &Point3::from(*to_mm)))
        }
        AxesFeature::Plane { name, centre_mm, normal, radius_mm } => {
            let [u, _] = across(&Vector3::from(*normal));
            (name, Point3::from(*centre_mm) + u * *radius_mm)
        }
    }
}

/// The figures, over a picture that was drawn through the camera; `plain` leaves out planes, which would
/// crowd a small picture.
pub(super) fn draw_figures(svg: &mut Svg, axes: &BodyAxes, picture: &Picture, camera: &Camera, plain: bool) {
    let width = if plain { 0.9 } else { 1.5 };
    let is_plane = |f: &AxesFeature| matches!(f, AxesFeature::Plane { .. });
    for figure in axes.features.iter().filter(|_| !plain) {
        if is_plane(figure) {
            for (line, _) in lines(figure, axes) {
                let disc = Style { opacity: 0.12, ..Style::area("disc", FIGURE) };
                svg.group(disc, |svg| svg.polygon(&line.iter().map(|p| camera.onto(p)).collect::<Vec<_>>()));
            }
        }
    }
    let mut parts = [Vec::new(), Vec::new()];
    let figures = axes.features.iter().filter(|f| !plain || !is_plane(f));
    for (line, closed) in figures.flat_map(|f| lines(f, axes)) {
        let [seen, hidden] = picture.parted(&line, closed);
        parts[0].extend(seen);
        parts[1].extend(hidden);
    }
    let hidden = Style { opacity: 0.6, ..Style::line("figure-hidden", FIGURE, 0.8 * width) };
    for (style, parts) in [(hidden, &parts[1]), (Style::line("figure", FIGURE, width), &parts[0])] {
        if !parts.is_empty() {
            svg.group(style, |svg| svg.strokes(parts, false));
        }
    }
    let points = axes.features.iter().filter(|f| matches!(f, AxesFeature::Point { .. }));
    svg.group(Style::area("landmark", FIGURE), |svg| {
        points.for_each(|f| svg.circle(camera.onto(&named(f).1), if plain { 1.8 } else { 3.2 }));
    });
}

/// The axes as arrows of a length.
pub(super) fn draw_axes(
    svg: &mut Svg,
    axes: &BodyAxes,
    length_mm: f64,
    picture: &Picture,
    camera: &Camera,
    plain: bool,
) {
    let origin = Point3::from(axes.origin_mm);
    let width = if plain { 1.6 } else { 3.0 };
    // Those that point away first, so that those towards the viewer are on top.
    let tips = tips(axes, length_mm);
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| camera.nearness(&tips[*a]).total_cmp(&camera.nearness(&tips[*b])));
    for axis in order {
        let (tip, colour) = (tips[axis], AXES[axis]);
        let [seen, hidden] = picture.parted(&[origin, tip], false);
        let inside =
            Style { dash: 2.0 * width, opacity: 0.8, ..Style::line("axis-hidden", colour, 0.7 * width) };
        for (style, parts) in [(inside, hidden), (Style::line("axis", colour, width), seen)] {
            if !parts.is_empty() {
                svg.group(style, |svg| svg.strokes(&parts, false));
            }
        }
        let (from, to) = (camera.onto(&origin), camera.onto(&tip));
        let way = [to[0] - from[0], to[1] - from[1]];
        let length = way[0].hypot(way[1]);
        let head = 3.6 * width;
        // An axis that points at the viewer has no head to be seen.
        if length > head {
            let [dx, dy] = way.map(|v| v / length * head);
            let back = [to[0] - 0.3 * dx, to[1] - 0.3 * dy];
            let tip = [to[0] + 0.7 * dx, to[1] + 0.7 * dy];
            let sides =
                [[back[0] - 0.36 * dy, back[1] + 0.36 * dx], [back[0] + 0.36 * dy, back[1] - 0.36 * dx]];
            svg.group(Style::area("head", colour), |svg| svg.polygon(&[sides[0], tip, sides[1]]));
        }
    }
    svg.group(Style::area("origin", INK), |svg| svg.circle(camera.onto(&origin), 1.4 * width));
}

/// The names of axes and figures, each where it covers least.
pub(super) fn write_names(svg: &mut Svg, axes: &BodyAxes, length_mm: f64, camera: &Camera) {
    let origin = Point3::from(axes.origin_mm);
    let tips = tips(axes, length_mm);
    let figures: Vec<(&str, Point3)> = axes.features.iter().map(named).take(NAMED).collect();
    // An arrow is in the way all along, a place is a dot.
    let along =
        tips.iter().flat_map(|tip| (0..=12).map(move |n| origin + (tip - origin) * (f64::from(n) / 12.0)));
    let marks = along.chain(figures.iter().map(|(_, at)| *at)).map(|p| (camera.onto(&p), 5.0));
    let mut labels = Labels::new([0.0, 0.0], camera.size(), marks);
    for (axis, tip) in tips.iter().enumerate() {
        let at = labels.place(camera.onto(tip), 9.0, NAMES[axis], SMALL + 1.0);
        svg.text(at, Font { edged: false, ..Font::new(SMALL + 1.0, AXES[axis]).bold() }, NAMES[axis]);
    }
    for (name, place) in figures {
        let name = shortened(name, 34);
        let at = labels.place(camera.onto(&place), 4.0, &name, SMALL - 1.0);
        svg.text(at, Font::new(SMALL - 1.0, FIGURE), &name);
    }
}
