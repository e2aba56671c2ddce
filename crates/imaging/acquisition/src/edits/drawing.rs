//! SVG as Inkscape and other programs write it, read as pieces of outlines.
//!
//! Followed: transforms of groups and elements, nested `svg`, clones (`use`), every path command and basic shape, lengths in
//! all absolute units, `display`, `visibility` and `opacity` (what is hidden is left out with a note). Pixels are found by the
//! backdrop: wherever its `image` lies, its box is the picture, so a drawing may be moved, scaled or laid out in mm with
//! it. Without a backdrop the page is the picture, if it has its shape. Fill, clips, masks, guides and text do not count.
//! Style sheets are not followed.

mod pieces;

use std::collections::HashMap;
use std::path::Path;

use biplane_artifact::ContentHash;
use roxmltree::{Document, Node, ParsingOptions};

use super::chain::Chain;
use super::named::{body_of, known};
use super::place::{Affine, Box2, Pair, length};
use super::shapes;
use super::write::NAMESPACE;
use super::{About, BodyEdit, Edit, EditError, MAX_POINTS, VERSION};
use pieces::{End, mark_of};

const SVG: &str = "http://www.w3.org/2000/svg";
const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";
const XLINK: &str = "http://www.w3.org/1999/xlink";
/// Elements that a drawing may have, clones counted as often as they are shown.
const MAX_ELEMENTS: u32 = 200_000;
/// Groups within groups.
const MAX_DEPTH: usize = 128;
/// What the shapes of page and picture may differ by.
const SAME_SHAPE: f64 = 0.002;

/// What is drawn by one element, in the coordinates of the outermost `svg`.
struct Drawn<'a> {
    node: Node<'a, 'a>,
    body: usize,
    chains: Vec<Chain>,
    mark: Option<(String, End)>,
}

/// A picture in the drawing, and where its box is.
struct Backdrop<'a> {
    node: Node<'a, 'a>,
    root_from_corner: Affine,
}

/// What elements inherit.
#[derive(Clone)]
struct State<'a> {
    root_from_own: Affine,
    viewport: Pair,
    body: Option<usize>,
    /// The innermost layer that is none of a body.
    layer: Option<&'a str>,
    hidden: bool,
    visible: bool,
    stroked: bool,
    depth: usize,
}

struct Reader<'a> {
    path: &'a Path,
    document: &'a Document<'a>,
    bodies: &'a [&'a str],
    size: [usize; 2],
    ids: HashMap<&'a str, Node<'a, 'a>>,
    seen: u32,
    backdrops: Vec<Backdrop<'a>>,
    drawn: Vec<Drawn<'a>>,
    /// For each body: whether it has a layer that is shown, and how many elements were written into it.
    layers: Vec<(bool, Option<usize>)>,
    notes: Vec<String>,
}

/// Reads a drawing.
pub(super) fn read(path: &Path, text: &str, bodies: &[&str], size: [usize; 2]) -> Result<Edit, EditError> {
    let line = |line: usize, what: String| EditError::Line { path: path.to_owned(), line, what };
    // A document type is harmless, entities can be made to grow without end.
    if let Some(at) = text.find("<!ENTITY") {
        let what = "the file defines entities, which are not read; save it with Inkscape as Inkscape SVG or plain SVG";
        return Err(line(1 + text[..at].matches('\n').count(), what.to_owned()));
    }
    let options =
        ParsingOptions { allow_dtd: true, nodes_limit: 4 * MAX_ELEMENTS, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options).map_err(|e| {
        let what =
            format!("the file is damaged: {e}; take it from a backup, or let `biplane edit` write a new one");
        line(e.pos().row as usize, what)
    })?;
    let root = document.root_element();
    if !is_svg(&root) || root.tag_name().name() != "svg" {
        let name = root.tag_name().name();
        return Err(line(1, format!("the file is XML of the kind <{name}>; expected a drawing, <svg>")));
    }
    let mut ids = HashMap::new();
    for node in document.descendants() {
        if let Some(id) = node.attribute("id") {
            ids.entry(id).or_insert(node);
        }
    }
    let layers = vec![(false, None); bodies.len()];
    let mut reader = Reader {
        path,
        document: &document,
        bodies,
        size,
        ids,
        seen: 0,
        backdrops: Vec::new(),
        drawn: Vec::new(),
        layers,
        notes: Vec::new(),
    };
    let about = reader.about(root)?;
    let page = reader.page(root)?;
    let state = State {
        root_from_own: Affine::IDENTITY,
        viewport: page.sides,
        body: None,
        layer: None,
        hidden: false,
        visible: true,
        stroked: false,
        depth: 0,
    };
    for child in root.children().filter(Node::is_element) {
        reader.visit(child, &state)?;
    }
    reader.edit(about, page)
}

fn is_svg(node: &Node<'_, '_>) -> bool {
    matches!(node.tag_name().namespace(), None | Some(SVG))
}

/// A property from the `style` of an element, or from its attribute.
fn property<'a>(node: Node<'a, 'a>, name: &str) -> Option<&'a str> {
    let style = node.attribute("style").unwrap_or_default();
    let mut declared = style.split(';').filter_map(|d| d.split_once(':')).filter(|(n, _)| n.trim() == name);
    let value = declared.next_back().map(|(_, value)| value).or_else(|| node.attribute(name))?;
    Some(value.trim().trim_end_matches("!important").trim_end())
}

/// What a person calls an element: its label, or its id.
fn name_of<'a>(node: Node<'a, 'a>) -> Option<&'a str> {
    node.attribute((INKSCAPE, "label")).or_else(|| node.attribute("id"))
}

fn own<'a>(node: Node<'a, 'a>, name: &str) -> Option<&'a str> {
    node.attribute((NAMESPACE, name))
}

impl<'a> Reader<'a> {
    /// An error at an element.
    fn at(&self, node: Node<'_, '_>, what: impl std::fmt::Display) -> EditError {
        EditError::Line {
            path: self.path.to_owned(),
            line: self.line(node),
            what: format!("{}: {what}", called(node)),
        }
    }

    fn line(&self, node: Node<'_, '_>) -> usize {
        self.document.text_pos_at(node.range().start).row as usize
    }

    fn about(&self, root: Node<'a, 'a>) -> Result<About, EditError> {
        if let Some(version) = own(root, "version") {
            match version.parse::<u32>() {
                Ok(v) if v <= VERSION => {}
                _ => {
                    let what = format!(
                        "it is of version `{version}` and this program knows up to {VERSION}; use the program it is from"
                    );
                    return Err(self.at(root, what));
                }
            }
        }
        let picture = own(root, "picture").map(|hex| {
            let what = || self.at(root, "its hash of the picture is not 64 hexadecimal digits; let `biplane edit` write the file anew");
            ContentHash::from_hex(hex).ok_or_else(what)
        });
        let text = |name| own(root, name).map(str::to_owned);
        Ok(About {
            trial: text("trial"),
            frame: text("frame"),
            view: text("view"),
            picture: picture.transpose()?,
        })
    }

    /// A length of an element, if it has it.
    fn length(&self, node: Node<'a, 'a>, name: &str, whole: f64) -> Result<Option<f64>, EditError> {
        let Some(text) = node.attribute(name) else { return Ok(None) };
        if text.trim() == "auto" {
            return Ok(None);
        }
        length(text, whole).map(Some).map_err(|e| self.at(node, format!("its {name} {e}")))
    }

    fn lengths(&self, node: Node<'a, 'a>, names: [&str; 2], whole: Pair) -> Result<Pair, EditError> {
        let one = |i: usize| self.length(node, names[i], whole[i]).map(|v| v.unwrap_or(0.0));
        Ok([one(0)?, one(1)?])
    }

    /// Width and height; `own` where it has none.
    fn sides(&self, node: Node<'a, 'a>, whole: Pair, own: Pair) -> Result<Pair, EditError> {
        let [width, height] = [self.length(node, "width", whole[0])?, self.length(node, "height", whole[1])?];
        Ok([width.unwrap_or(own[0]), height.unwrap_or(own[1])])
    }

    /// The page in the coordinates of the outermost `svg`.
    fn page(&self, root: Node<'a, 'a>) -> Result<Box2, EditError> {
        if let Some(text) = root.attribute("viewBox") {
            return Box2::parse(text).map_err(|e| self.at(root, e));
        }
        let own = self.size.map(|s| s as f64);
        let sides = self.sides(root, own, own)?;
        if sides.iter().all(|s| *s > 0.0 && s.is_finite()) {
            Ok(Box2 { corner: [0.0; 2], sides })
        } else {
            let [w, h] = sides;
            Err(self.at(root, format!("its page is {w} x {h}; expected sides above 0")))
        }
    }

    fn visit(&mut self, node: Node<'a, 'a>, outer: &State<'a>) -> Result<(), EditError> {
        self.seen += 1;
        if self.seen > MAX_ELEMENTS {
            return Err(self.at(
                node,
                format!("the drawing shows more than {MAX_ELEMENTS} elements; take out what is no outline"),
            ));
        }
        if outer.depth > MAX_DEPTH {
            return Err(self.at(node, format!("more than {MAX_DEPTH} groups within groups; ungroup them")));
        }
        if !is_svg(&node) {
            return Ok(());
        }
        let kind = node.tag_name().name();
        let shape = matches!(kind, "path" | "line" | "polyline" | "polygon" | "rect" | "circle" | "ellipse");
        if !shape && !matches!(kind, "g" | "a" | "switch" | "svg" | "use" | "image" | "text" | "flowRoot") {
            return Ok(());
        }
        let mut state = outer.clone();
        state.depth += 1;
        if let Some(text) = node.attribute("transform") {
            let own = Affine::parse(text).map_err(|e| self.at(node, e))?;
            state.root_from_own = state.root_from_own.after(&own);
        }
        state.visible = match property(node, "visibility") {
            Some("hidden" | "collapse") => false,
            Some("visible") => true,
            _ => state.visible,
        };
        state.stroked = match property(node, "stroke") {
            Some("none") => false,
            Some(_) => true,
            // A style sheet may give it one.
            None => state.stroked || node.attribute("class").is_some(),
        };
        let gone = property(node, "display") == Some("none")
            || property(node, "opacity").and_then(|o| o.parse::<f64>().ok()) == Some(0.0);
        let named = name_of(node).and_then(|name| body_of(name, self.bodies));
        if kind == "g" {
            self.enter(node, &mut state, named, gone);
        }
        state.hidden |= gone;
        match kind {
            "g" | "a" | "switch" => self.children(node, &state),
            "svg" => {
                self.viewport(node, &mut state)?;
                self.children(node, &state)
            }
            "use" => self.clone_of(node, &state),
            "image" => self.image(node, &state),
            "text" | "flowRoot" => {
                if !state.hidden && state.body.is_some() {
                    self.note(node, "is text and no outline; it is left out");
                }
                Ok(())
            }
            _ => {
                state.body = state.body.or(named);
                self.shape(node, &state)
            }
        }
    }

    fn children(&mut self, node: Node<'a, 'a>, state: &State<'a>) -> Result<(), EditError> {
        node.children().filter(Node::is_element).try_for_each(|child| self.visit(child, state))
    }

    /// A group may be the layer of a body.
    fn enter(&mut self, node: Node<'a, 'a>, state: &mut State<'a>, named: Option<usize>, gone: bool) {
        if let Some(body) = named {
            state.body = Some(body);
            if gone || state.hidden {
                self.note(node, "is hidden, so it is as if it were not in the file");
            } else {
                let elements = own(node, "elements").and_then(|n| n.parse().ok());
                if let Some((shown, count)) = self.layers.get_mut(body) {
                    (*shown, *count) = (true, elements);
                }
            }
        } else if state.body.is_none() && node.attribute((INKSCAPE, "groupmode")) == Some("layer") {
            state.layer = name_of(node);
        }
    }

    fn viewport(&self, node: Node<'a, 'a>, state: &mut State<'a>) -> Result<(), EditError> {
        let corner = self.lengths(node, ["x", "y"], state.viewport)?;
        let outer = Box2 { corner, sides: self.sides(node, state.viewport, state.viewport)? };
        let inner = match node.attribute("viewBox") {
            Some(text) => Box2::parse(text).map_err(|e| self.at(node, e))?,
            None => Box2 { corner: [0.0; 2], sides: outer.sides },
        };
        let fit = outer.fit(&inner, node.attribute("preserveAspectRatio")).map_err(|e| self.at(node, e))?;
        state.root_from_own = state.root_from_own.after(&fit);
        state.viewport = inner.sides;
        Ok(())
    }

    fn clone_of(&mut self, node: Node<'a, 'a>, state: &State<'a>) -> Result<(), EditError> {
        let href = node.attribute((XLINK, "href")).or_else(|| node.attribute("href")).unwrap_or_default();
        let target = href.strip_prefix('#').and_then(|id| self.ids.get(id).copied());
        let Some(target) = target.filter(|t| is_svg(t) && t.tag_name().name() != "symbol") else {
            if state.hidden || !(state.stroked || state.body.is_some()) {
                return Ok(());
            }
            return Err(self.at(node, format!("it is a clone of `{href}`, which is no shape of this file; unlink it (Edit > Clone > Unlink Clone)")));
        };
        let by = self.lengths(node, ["x", "y"], state.viewport)?;
        let state =
            State { root_from_own: state.root_from_own.after(&Affine::translate(by)), ..state.clone() };
        self.visit(target, &state)
    }

    fn image(&mut self, node: Node<'a, 'a>, state: &State<'a>) -> Result<(), EditError> {
        let corner = self.lengths(node, ["x", "y"], state.viewport)?;
        let size = self.size.map(|s| s as f64);
        let sides = self.sides(node, state.viewport, size)?;
        if !sides.iter().all(|s| *s > 0.0 && s.is_finite()) {
            return Err(self.at(node, "the picture has no size; undo what was done to it, or link it anew"));
        }
        let picture = Box2 { corner: [0.0; 2], sides: size };
        let fit = Box2 { corner, sides }.fit(&picture, node.attribute("preserveAspectRatio"));
        let fit = fit.map_err(|e| self.at(node, e))?;
        self.backdrops.push(Backdrop { node, root_from_corner: state.root_from_own.after(&fit) });
        Ok(())
    }

    fn shape(&mut self, node: Node<'a, 'a>, state: &State<'a>) -> Result<(), EditError> {
        if state.hidden || !state.visible {
            // What is in a hidden layer is not spoken of one by one.
            if state.body.and_then(|body| self.layers.get(body)).is_some_and(|(shown, _)| *shown) {
                self.note(node, "is hidden; it is left out");
            }
            return Ok(());
        }
        let chains = self.chains(node, state)?;
        if chains.is_empty() {
            return Ok(());
        }
        let body = match (state.body, self.bodies) {
            (Some(body), _) => body,
            _ if !state.stroked => {
                self.note(node, "has no stroke and is in no layer of a body; it is left out");
                return Ok(());
            }
            (None, [_]) => 0,
            (None, bodies) => {
                let what = match state.layer {
                    Some(layer) => format!(
                        "it is in the layer `{layer}`, which is named after no body ({})",
                        known(layer, bodies)
                    ),
                    None => format!(
                        "it is in no layer, so it is not clear of which body it is a piece ({})",
                        known("", bodies)
                    ),
                };
                return Err(self.at(node, format!("{what}. Move it into the layer of its body (Layer > Move Selection to Layer), or delete it")));
            }
        };
        let mark = mark_of(node, self.bodies);
        let chains = chains.iter().map(|c| c.mapped(&state.root_from_own)).collect();
        self.drawn.push(Drawn { node, body, chains, mark });
        Ok(())
    }

    fn chains(&self, node: Node<'a, 'a>, state: &State<'a>) -> Result<Vec<Chain>, EditError> {
        let whole = state.viewport;
        let text = |name| node.attribute(name).unwrap_or_default();
        let fault = |e: String| {
            self.at(node, format!("{e}. Undo the last change to it, or delete it and draw it anew"))
        };
        // SVG 1.1, section 7.10: a percentage of what is neither width nor height.
        let diagonal = whole[0].hypot(whole[1]) / std::f64::consts::SQRT_2;
        let chain = match node.tag_name().name() {
            "path" => return shapes::path(text("d")).map_err(fault),
            "polyline" | "polygon" => {
                let closed = node.tag_name().name() == "polygon";
                shapes::polyline(text("points"), closed).map_err(fault)?
            }
            "line" => {
                let mut chain = Chain::new(self.lengths(node, ["x1", "y1"], whole)?);
                chain.line_to(self.lengths(node, ["x2", "y2"], whole)?);
                Some(chain)
            }
            "rect" => {
                let (corner, sides) =
                    (self.lengths(node, ["x", "y"], whole)?, self.lengths(node, ["width", "height"], whole)?);
                let (rx, ry) = (self.length(node, "rx", whole[0])?, self.length(node, "ry", whole[1])?);
                let radii = [rx.or(ry).unwrap_or(0.0), ry.or(rx).unwrap_or(0.0)];
                (sides[0] > 0.0 && sides[1] > 0.0).then(|| shapes::rectangle(corner, sides, radii))
            }
            kind => {
                let centre = self.lengths(node, ["cx", "cy"], whole)?;
                let radii = match (kind, self.length(node, "r", diagonal)?) {
                    ("circle", r) => [r.unwrap_or(0.0); 2],
                    _ => self.lengths(node, ["rx", "ry"], whole)?,
                };
                (radii[0] > 0.0 && radii[1] > 0.0).then(|| shapes::ellipse(centre, radii))
            }
        };
        Ok(chain.into_iter().collect())
    }

    fn note(&mut self, node: Node<'_, '_>, what: &str) {
        let line = self.line(node);
        self.notes.push(format!("line {line}: {} {what}", called(node)));
    }

    /// The map from the outermost `svg` to pixels.
    fn pixels(&mut self, page: Box2) -> Result<Affine, EditError> {
        // The corner of the picture is half a pixel before the centre of its first one.
        let pixel_from_corner = Affine::translate([-0.5; 2]);
        let marked = |b: &&Backdrop<'_>| {
            own(b.node, "backdrop").is_some() || b.node.attribute("id") == Some("backdrop")
        };
        let mut choice: Vec<&Backdrop<'_>> = self.backdrops.iter().filter(marked).collect();
        if choice.is_empty() {
            choice = self.backdrops.iter().collect();
        }
        match choice[..] {
            [one] => {
                let back = one.root_from_corner.inverse();
                let back = back
                    .ok_or_else(|| self.at(one.node, "the picture has no size; undo what was done to it"))?;
                Ok(pixel_from_corner.after(&back))
            }
            [_, second, ..] => {
                let what = "it is one of several pictures, and it is not clear which one was drawn over; delete the others";
                Err(self.at(second.node, what))
            }
            [] => {
                let picture = Box2 { corner: [0.0; 2], sides: self.size.map(|s| s as f64) };
                let [w, h] = page.sides;
                let [columns, rows] = picture.sides;
                if ((w / h) / (columns / rows) - 1.0).abs() > SAME_SHAPE {
                    let what = format!(
                        "the drawing has no picture in it, and its page of {w} x {h} has not the shape of the frame of {columns} x {rows} \
                         pixels; so where its pixels are is not known. Draw over the picture, as `biplane edit` links it"
                    );
                    return Err(EditError::Line { path: self.path.to_owned(), line: 1, what });
                }
                self.notes
                    .push("there is no picture in it, so its page was taken for the picture".to_owned());
                let fit =
                    page.fit(&picture, Some("none")).map_err(|e| self.at(self.document.root_element(), e))?;
                let back = fit.inverse().unwrap_or(Affine::IDENTITY);
                Ok(pixel_from_corner.after(&back))
            }
        }
    }

    fn edit(mut self, about: About, page: Box2) -> Result<Edit, EditError> {
        let pixels = self.pixels(page)?;
        for drawn in &mut self.drawn {
            drawn.chains = drawn.chains.iter().map(|c| c.mapped(&pixels)).collect();
        }
        let drawn = std::mem::take(&mut self.drawn);
        let mut left = MAX_POINTS;
        let mut bodies = Vec::new();
        for (body, (shown, elements)) in self.layers.clone().into_iter().enumerate() {
            let own: Vec<&Drawn<'_>> = drawn.iter().filter(|d| d.body == body).collect();
            if !shown && own.is_empty() {
                continue;
            }
            let touched = elements != Some(own.len()) || own.iter().any(|d| !d.is_as_written());
            let contour = self.contour(&own, &mut left)?;
            bodies.push(BodyEdit { body, contour, touched });
        }
        if bodies.is_empty() {
            let what = format!(
                "there is no layer named after a body, and nothing is drawn ({})",
                known("", self.bodies)
            );
            self.notes.push(what);
        }
        Ok(Edit { about, bodies, notes: self.notes })
    }
}

/// An element as a message names it.
fn called(node: Node<'_, '_>) -> String {
    let kind = node.tag_name().name();
    match (node.attribute((INKSCAPE, "label")), node.attribute("id")) {
        (Some(label), Some(id)) if label != id => format!("<{kind}> `{label}` (id {id})"),
        (Some(name), _) | (None, Some(name)) => format!("<{kind}> `{name}`"),
        (None, None) => format!("<{kind}> without a name"),
    }
}
