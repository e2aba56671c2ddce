//! The sheet of a model: the mesh from four sides, with the slices it came from, with its axes and what they were made from, how far it
//! is from a reference, and its numbers.

use std::collections::BTreeSet;

use biplane_artifact::{BodyAxes, BoneSurface, Drawing, ModelMesh, SliceContours, SurfaceReport};
use biplane_geometry::{Mesh, Point3, Vector3};
use biplane_stage::{Context, Stage, inputs};
use biplane_surface::MeshCheck;
use serde::{Deserialize, Serialize};

use super::DrawingError;
use super::camera::{Camera, Directions, Viewpoint};
use super::colours::{FAINT, INK, Level, RULE};
use super::contour_panel::slices_panel;
use super::distance_map::{DistanceMap, draw_bar};
use super::figures::{draw_axes, draw_figures, reaches, source, tips, write_names};
use super::model_numbers::{MESH_FACTS, grouped, unsigned_zero};
use super::shaded::{COARSE, FINE, Paint, Picture, Shape, shaded};
use super::sheet::{MARGIN, SMALL, TEXT, WIDTH, facts, quantity, shortened, wrapped};
use super::svg::{Anchor, Font, Style, Svg, text_width};

/// Room between pictures.
const GAP: f64 = 12.0;
/// Height of the four views.
const VIEW: f64 = 224.0;
/// Width and height of a panel.
pub(super) const PANEL: [f64; 2] = [(WIDTH - 2.0 * MARGIN - GAP) / 2.0, 430.0];
/// Room for a title above a picture.
const TITLE: f64 = 24.0;
/// Room around a body in its picture.
const ROOM: f64 = 14.0;
/// Faults and warnings that are shown.
const MOST_NAMED: usize = 10;
/// Length of the axes, in half diagonals of the body.
const AXES: f64 = 0.62;

inputs! {
    /// A body's model and, where there are such, its axes, the contours and the surface it was made from, and a mesh to compare it
    /// with: none or one of each.
    pub struct ModelDrawingInputs {
        model: ModelMesh,
        axes: [BodyAxes],
        contours: [SliceContours],
        surface: [BoneSurface],
        reference: [ModelMesh],
    }
}

/// Which body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelDrawingParams {
    /// Its name, for the title.
    pub body: String,
}

/// The stage `draw-model`: [`model_drawing`].
#[derive(Debug, Clone, Copy)]
pub struct DrawModel;

impl Stage for DrawModel {
    const NAME: &'static str = "draw-model";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = ModelDrawingInputs;
    type Params = ModelDrawingParams;
    type Output = Drawing;
    type Error = DrawingError;

    fn run(
        inputs: &ModelDrawingInputs,
        params: &ModelDrawingParams,
        _: &Context,
    ) -> Result<Drawing, DrawingError> {
        let shown = ModelDrawing {
            body: &params.body,
            axes: inputs.axes.first().map(|a| &**a),
            contours: inputs.contours.first().map(|c| &**c),
            surface: inputs.surface.first().map(|s| &s.report),
            reference: inputs.reference.first().map(|r| &r.0),
        };
        model_drawing(&inputs.model.0, &shown).map(Drawing)
    }
}

/// What is shown with a mesh. All of it in the mesh's own coordinates, mm.
#[derive(Debug, Clone, Copy, Default)]
pub struct ModelDrawing<'a> {
    /// The body's name.
    pub body: &'a str,
    /// Its axes.
    pub axes: Option<&'a BodyAxes>,
    /// The contours it was made from.
    pub contours: Option<&'a SliceContours>,
    /// What was found out when it was made from slices.
    pub surface: Option<&'a SurfaceReport>,
    /// Another mesh of the body.
    pub reference: Option<&'a Mesh>,
}

/// The sheet.
///
/// # Errors
/// A picture cannot be written as PNG.
pub fn model_drawing(model: &Mesh, shown: &ModelDrawing) -> Result<String, DrawingError> {
    let body = Body::new(model, shown);
    let mut svg = Svg::default();
    let mut y = heading(&mut svg, &body);
    y = views(&mut svg, &body, y + 14.0)?;
    let mut place = Places { y: y + 16.0, beside: false };
    if let Some(contours) = shown.contours {
        slices_panel(&mut svg, &body, contours, place.next(PANEL[1] + TITLE + 30.0))?;
    }
    if let Some(axes) = shown.axes {
        axes_panel(&mut svg, &body, axes, place.next(PANEL[1] + TITLE + 30.0))?;
    }
    y = place.y;
    let [left, right] = [MARGIN, MARGIN + PANEL[0] + GAP];
    let numbers = body.numbers();
    let (mesh, made) = numbers.split_at(MESH_FACTS.min(numbers.len()));
    if place.beside {
        // The numbers fit beside a panel that is alone.
        let top = y - (PANEL[1] + TITLE + 30.0);
        let end = facts(&mut svg, [right + 10.0, top + 4.0], PANEL[0] - 10.0, mesh);
        facts(&mut svg, [right + 10.0, end + 10.0], PANEL[0] - 10.0, made);
    }
    if let Some(reference) = shown.reference {
        y = distance_panel(&mut svg, &body, reference, y)? + 16.0;
    }
    if !place.beside {
        let ends = [
            facts(&mut svg, [left, y - 6.0], PANEL[0], mesh),
            facts(&mut svg, [right, y - 6.0], PANEL[0], made),
        ];
        y = ends[0].max(ends[1]) + 10.0;
    }
    y = faults(&mut svg, shown, y);
    Ok(svg.into_page([WIDTH, (y + MARGIN).ceil()]))
}

/// Where panels go: two beside each other.
struct Places {
    y: f64,
    /// Whether the last one is alone so far.
    beside: bool,
}

impl Places {
    fn next(&mut self, height: f64) -> [f64; 2] {
        let corner = if self.beside {
            [MARGIN + PANEL[0] + GAP, self.y - height]
        } else {
            self.y += height;
            [MARGIN, self.y - height]
        };
        self.beside = !self.beside;
        corner
    }
}

/// A body and what is known of it.
pub(super) struct Body<'a> {
    pub(super) model: &'a Mesh,
    pub(super) shown: &'a ModelDrawing<'a>,
    pub(super) shape: Shape<'a>,
    pub(super) check: MeshCheck,
    pub(super) directions: Directions,
    /// Length of the drawn axes, mm.
    axis_mm: f64,
}

impl<'a> Body<'a> {
    fn new(model: &'a Mesh, shown: &'a ModelDrawing<'a>) -> Self {
        // What came from slices is in the scanner's frame.
        let scanned = shown.contours.is_some() || shown.surface.is_some();
        let directions = match shown.axes {
            Some(axes) => Directions::of_axes(axes),
            None if scanned => Directions::of_scanner(),
            None => Directions::of_coordinates(),
        };
        let (low, high) = model.bounding_box();
        let axis_mm = AXES * ((high - low).norm() / 2.0).clamp(1e-9, 1e12);
        Self { model, shown, shape: Shape::new(model), check: MeshCheck::of(model), directions, axis_mm }
    }

    /// A camera that shows all of the body, and its axes where there are some.
    pub(super) fn camera(&self, from: Viewpoint, size: [f64; 2], in_perspective: bool) -> Camera {
        let marks: Vec<Point3> = self
            .shown
            .axes
            .map_or(Vec::new(), |a| tips(a, self.axis_mm).into_iter().chain(reaches(a)).collect());
        let vertices = self.model.vertices();
        let used = self.model.triangles().iter().flatten().map(move |v| &vertices[*v as usize]);
        // Marks far away would make the body a dot.
        let (low, high) = self.model.bounding_box();
        let room = (high - low).norm();
        let near = marks.iter().filter(|t| (*t - nalgebra::center(&low, &high)).norm() <= 0.9 * room);
        Camera::fitted(self.directions.frame(from), used.chain(near), size, ROOM, in_perspective)
    }

    fn level(&self) -> (Level, &'static str) {
        let faults = self.shown.surface.is_some_and(|s| !s.faults.is_empty());
        if faults || !self.check.is_manifold() {
            (Level::Bad, "faulty")
        } else if !self.check.open_edges.is_empty() {
            (Level::Near, "open")
        } else if !warnings(self.shown).is_empty() {
            (Level::Near, "look at it")
        } else {
            (Level::Good, "good")
        }
    }

    /// Sides of the box along the body's axes, or along the coordinates, mm.
    pub(super) fn size_mm(&self) -> [f64; 3] {
        let axes = self.shown.axes.map(|a| a.axes.map(Vector3::from));
        let axes = axes.unwrap_or([Vector3::x(), Vector3::y(), Vector3::z()]);
        axes.map(|axis| {
            let along = self.model.triangles().iter().flatten();
            let along = along.map(|v| self.model.vertices()[*v as usize].coords.dot(&axis));
            let (low, high) =
                along.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
            high - low
        })
    }
}

/// All warnings, each once.
fn warnings(shown: &ModelDrawing) -> Vec<String> {
    let of_axes = shown.axes.iter().flat_map(|a| &a.warnings);
    let of_surface = shown.surface.iter().flat_map(|s| &s.warnings);
    let all = of_surface.chain(shown.contours.iter().flat_map(|c| &c.warnings)).chain(of_axes);
    let mut seen = BTreeSet::new();
    all.filter(|w| seen.insert(w.as_str())).cloned().collect()
}

/// The title, what kind of model it is, and a word about it; returns where they end.
fn heading(svg: &mut Svg, body: &Body) -> f64 {
    let (level, word) = body.level();
    let mut y = MARGIN + 16.0;
    svg.text(
        [MARGIN, y],
        Font::new(22.0, INK).bold(),
        &format!("Model of {}", shortened(body.shown.body, 48)),
    );
    let chip = text_width(word, 17.0) + 26.0;
    svg.group(Style::area("verdict", level.ink()), |svg| {
        svg.rectangle([WIDTH - MARGIN - chip, y - 20.0], [chip, 28.0]);
    });
    let middle = Font::new(17.0, "#ffffff").bold().anchored(Anchor::Middle);
    svg.text([WIDTH - MARGIN - chip / 2.0, y], middle, word);
    y += 24.0;
    let size = body.size_mm().map(|v| quantity(v, 0, "")).join(" × ");
    let caption = format!(
        "{} vertices, {} triangles, {size} mm",
        grouped(body.model.vertices().len()),
        grouped(body.model.triangles().len()),
    );
    svg.text([MARGIN, y], Font::new(TEXT, INK), &caption);
    if let Some(axes) = body.shown.axes {
        let (text, level) = source(axes);
        let font = Font::new(TEXT, level.ink()).bold().anchored(Anchor::End);
        svg.text([WIDTH - MARGIN, y + 4.0], font, text);
    }
    y
}

/// A title and a frame; returns the corner of what is inside.
pub(super) fn framed(svg: &mut Svg, corner: [f64; 2], size: [f64; 2], title: &str) -> [f64; 2] {
    svg.text([corner[0], corner[1] + 16.0], Font::new(TEXT, INK).bold(), title);
    let corner = [corner[0], corner[1] + TITLE];
    svg.group(Style::line("field", RULE, 1.0), |svg| svg.rectangle(corner, size));
    corner
}

/// A shaded picture in a frame, and marks on it in its own units.
pub(super) fn pictured(
    svg: &mut Svg,
    corner: [f64; 2],
    size: [f64; 2],
    picture: &Picture,
    marks: impl FnOnce(&mut Svg),
) {
    svg.window(corner, size, [0.0, 0.0], size, |svg| {
        svg.png([0.0, 0.0], size, &picture.base64);
        marks(svg);
    });
}

/// The body from four sides; returns where they end.
fn views(svg: &mut Svg, body: &Body, top: f64) -> Result<f64, DrawingError> {
    let size = [(WIDTH - 2.0 * MARGIN - 3.0 * GAP) / 4.0, VIEW];
    for (place, from) in
        [Viewpoint::Front, Viewpoint::Side, Viewpoint::Above, Viewpoint::Corner].into_iter().enumerate()
    {
        let in_perspective = from == Viewpoint::Corner;
        let title = if in_perspective { "in perspective" } else { body.directions.name(from) };
        let corner = [MARGIN + place as f64 * (size[0] + GAP), top];
        let corner = framed(svg, corner, size, title);
        let camera = body.camera(from, size, in_perspective);
        let picture = shaded(&body.shape, &camera, Paint::Plain { faded: 0.0 }, COARSE)?;
        pictured(svg, corner, size, &picture, |svg| {
            if let Some(axes) = body.shown.axes {
                draw_figures(svg, axes, &picture, &camera, true);
                draw_axes(svg, axes, body.axis_mm, &picture, &camera, true);
            }
            if !in_perspective {
                scale_bar(svg, &camera);
            }
        });
    }
    Ok(top + TITLE + VIEW)
}

/// A bar of a round length in the lower left corner.
pub(super) fn scale_bar(svg: &mut Svg, camera: &Camera) {
    let mm = super::arrows::round_below(0.3 * camera.size()[0] / camera.scale());
    let [left, y] = [8.0, camera.size()[1] - 8.0];
    let right = left + mm * camera.scale();
    svg.group(Style::line("scale", INK, 1.6), |svg| svg.line(&[[left, y], [right, y]]));
    let decimals = if mm < 1.0 { 2 } else { 0 };
    svg.text([left, y - 5.0], Font::new(SMALL - 1.0, INK), &quantity(mm, decimals, "mm"));
}

/// The mesh with its axes and what they were made from.
fn axes_panel(svg: &mut Svg, body: &Body, axes: &BodyAxes, corner: [f64; 2]) -> Result<(), DrawingError> {
    let title = format!("with its axes, {}", body.directions.name(Viewpoint::Corner));
    let inside = framed(svg, corner, PANEL, &title);
    let camera = body.camera(Viewpoint::Corner, PANEL, false);
    let picture = shaded(&body.shape, &camera, Paint::Plain { faded: 0.55 }, FINE)?;
    pictured(svg, inside, PANEL, &picture, |svg| {
        draw_figures(svg, axes, &picture, &camera, false);
        draw_axes(svg, axes, body.axis_mm, &picture, &camera, false);
        write_names(svg, axes, body.axis_mm, &camera);
        scale_bar(svg, &camera);
    });
    let (text, level) = source(axes);
    let y = inside[1] + PANEL[1] + 19.0;
    svg.text([inside[0], y], Font::new(SMALL, level.ink()).bold(), text);
    let origin = axes.origin_mm.map(|v| unsigned_zero(v, 1, "")).join(", ");
    let font = Font::new(SMALL, FAINT).anchored(Anchor::End);
    let note = format!("origin at {origin} mm");
    svg.text([inside[0] + PANEL[0], y], font, &note);
    Ok(())
}

/// The distance from a reference, from two sides that show it all; returns where it ends.
fn distance_panel(svg: &mut Svg, body: &Body, reference: &Mesh, top: f64) -> Result<f64, DrawingError> {
    let map = DistanceMap::of(body.model, reference);
    let size = [(WIDTH - 2.0 * MARGIN - 2.0 * GAP - 160.0) / 2.0, 400.0];
    for (place, from) in [Viewpoint::Corner, Viewpoint::OtherCorner].into_iter().enumerate() {
        let corner = [MARGIN + place as f64 * (size[0] + GAP), top];
        let title = match place {
            0 => format!("distance from the reference, {}", body.directions.name(from)),
            _ => body.directions.name(from).to_owned(),
        };
        let corner = framed(svg, corner, size, &title);
        // Without the axes' tips: here the surface is what is looked at.
        let vertices = body.model.vertices();
        let used = body.model.triangles().iter().flatten().map(move |v| &vertices[*v as usize]);
        let camera = Camera::fitted(body.directions.frame(from), used, size, ROOM, false);
        let colour = |value: f32| map.colour(value);
        let paint = Paint::Values { values: &map.values, colour: &colour };
        let picture = shaded(&body.shape, &camera, paint, COARSE)?;
        pictured(svg, corner, size, &picture, |svg| scale_bar(svg, &camera));
    }
    let end = draw_bar(svg, &map, [WIDTH - MARGIN - 154.0, top + TITLE + 8.0], 190.0);
    Ok((top + TITLE + size[1]).max(end))
}

/// Faults and warnings in words; returns where they end.
fn faults(svg: &mut Svg, shown: &ModelDrawing, top: f64) -> f64 {
    let mut y = top;
    let fault = |f: &biplane_artifact::SurfaceFault| match f.slice {
        Some(slice) => format!("slice {slice}: {}", f.what),
        None => f.what.clone(),
    };
    let faults: Vec<String> = shown.surface.iter().flat_map(|s| &s.faults).map(fault).collect();
    let columns = ((WIDTH - 2.0 * MARGIN) / (0.86 * text_width("x", SMALL + 1.0))) as usize;
    for (title, lines, level) in [("Faults", faults, Level::Bad), ("Warnings", warnings(shown), Level::Near)]
    {
        if lines.is_empty() {
            continue;
        }
        y += 24.0;
        svg.text([MARGIN, y], Font::new(TEXT, level.ink()).bold(), title);
        for line in lines.iter().take(MOST_NAMED) {
            for part in wrapped(&format!("• {line}"), columns).iter().take(3) {
                y += 19.0;
                svg.text([MARGIN, y], Font::new(SMALL + 1.0, INK), part);
            }
        }
        if lines.len() > MOST_NAMED {
            y += 19.0;
            let more = format!("• and {} more", lines.len() - MOST_NAMED);
            svg.text([MARGIN, y], Font::new(SMALL + 1.0, INK), &more);
        }
    }
    y
}
