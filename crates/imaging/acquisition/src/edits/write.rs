//! A drawing for Inkscape: the picture as a linked backdrop, a layer a body, a path a piece, marks at the ends of its trusted part.
//!
//! User units are pixels: the picture's box begins at (-0.5, -0.5), so that the centre of the first pixel is at (0, 0). Each
//! element carries what was written (`biplane:written`), so that a file that nobody changed is known as such even after a program
//! saved it in its own way. Stroke widths do not scale with the view.

use std::fmt::Write;

use biplane_artifact::ContentHash;
use biplane_geometry::Point2;
use biplane_spline::{Choice, Piece, Smoothing, Spline};

use super::VERSION;
use super::chain::Chain;
use super::named::id_of;
use super::place::Pair;

/// Namespace of this program's attributes.
pub(super) const NAMESPACE: &str = "urn:biplane:edit";
/// Distance of the nodes of a path at most, px.
const NODES_PX: f64 = 40.0;
/// Distance of a path from the smooth curve near the points at most, px.
const PATH_PX: f64 = 0.05;
/// Points that share one error: neighbours of a picture that was smoothed by a Gaussian of 1 px.
const CORRELATED_POINTS: f64 = 3.5;
/// Radius of a mark, px.
const MARK_PX: f64 = 2.5;

/// What is written for a person to edit.
#[derive(Debug, Clone, PartialEq)]
pub struct Sketch {
    /// Name of the trial.
    pub trial: String,
    /// Label of the frame.
    pub frame: String,
    /// Name of the view.
    pub view: String,
    /// Content hash of the picture.
    pub picture: ContentHash,
    /// Columns and rows of the picture.
    pub size: [usize; 2],
    /// In the order of their layers.
    pub bodies: Vec<SketchBody>,
}

/// One body of a sketch.
#[derive(Debug, Clone, PartialEq)]
pub struct SketchBody {
    /// Its name.
    pub name: String,
    /// Red, green, blue.
    pub colour: [u8; 3],
    /// Its pieces; none where no edge was found.
    pub pieces: Vec<SketchPiece>,
    /// What a person should look at.
    pub flags: Vec<String>,
}

/// One stretch of an edge, which may go on beyond what is trusted.
#[derive(Debug, Clone, PartialEq)]
pub struct SketchPiece {
    /// In order, about a pixel apart, px.
    pub points: Vec<[f64; 2]>,
    /// Standard deviation of each across the edge, px: the path that is written is as smooth as they let it be.
    pub sigmas: Vec<f64>,
    /// Whether the last point is followed by the first; all of it is trusted then.
    pub closed: bool,
    /// The first and the last trusted point.
    pub trusted: [usize; 2],
}

/// The sketch as SVG, with the picture linked at `href` (with forward slashes, relative to where the drawing will lie).
pub fn write_drawing(sketch: &Sketch, href: &str) -> String {
    let Sketch { trial, frame, view, picture, size: [columns, rows], bodies } = sketch;
    let [trial, frame, view] = [trial, frame, view].map(|t| escaped(t));
    let first = bodies.first().map_or_else(|| "picture".to_owned(), |b| id_of(&b.name));
    let mut out = String::new();
    let mut line = |text: std::fmt::Arguments<'_>| {
        // Writing into a text does not fail.
        let _ = writeln!(out, "{text}");
    };
    line(format_args!("<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"no\"?>"));
    line(format_args!(
        "<svg\n   xmlns=\"http://www.w3.org/2000/svg\"\n   xmlns:xlink=\"http://www.w3.org/1999/xlink\""
    ));
    line(format_args!("   xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\""));
    line(format_args!(
        "   xmlns:sodipodi=\"http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd\"\n   xmlns:biplane=\"{NAMESPACE}\""
    ));
    line(format_args!(
        "   width=\"{columns}\"\n   height=\"{rows}\"\n   viewBox=\"-0.5 -0.5 {columns} {rows}\""
    ));
    line(format_args!(
        "   biplane:version=\"{VERSION}\"\n   biplane:trial=\"{trial}\"\n   biplane:frame=\"{frame}\"\n   biplane:view=\"{view}\""
    ));
    line(format_args!("   biplane:picture=\"{}\">", picture.to_hex()));
    line(format_args!("  <title>{trial} {frame} {view}: outlines to edit</title>"));
    line(format_args!(
        "  <desc>Drag the nodes of a path, delete a path, or draw a new one in the layer of its body; an empty layer says that nothing \
         of the body can be trusted in this picture, and a deleted layer leaves the body to the program.\nThe two circles of a path \
         show where its trusted part begins and ends: drag them along the path; without circles all of it is trusted.\nSave the file \
         where it is, then run the study again.</desc>"
    ));
    line(format_args!(
        "  <sodipodi:namedview id=\"view\" pagecolor=\"#505050\" inkscape:document-units=\"px\" inkscape:current-layer=\"{first}\" \
         showgrid=\"false\" />"
    ));
    line(format_args!(
        "  <g inkscape:groupmode=\"layer\" id=\"picture\" inkscape:label=\"picture\" sodipodi:insensitive=\"true\">"
    ));
    line(format_args!(
        "    <image id=\"backdrop\" biplane:backdrop=\"true\" x=\"-0.5\" y=\"-0.5\" width=\"{columns}\" height=\"{rows}\" \
         preserveAspectRatio=\"none\" xlink:href=\"{}\" />",
        escaped(&address(href))
    ));
    line(format_args!("  </g>"));
    for body in bodies {
        out += &layer(body);
    }
    out + "</svg>\n"
}

fn layer(body: &SketchBody) -> String {
    let SketchBody { name, colour: [r, g, b], pieces, flags } = body;
    let (id, label, colour) = (id_of(name), escaped(name), format!("#{r:02x}{g:02x}{b:02x}"));
    let mut elements = 0;
    let mut inner = String::new();
    let style = format!(
        "fill:none;stroke:{colour};stroke-width:1.5;stroke-opacity:0.9;vector-effect:non-scaling-stroke"
    );
    for (piece, number) in pieces.iter().zip(1..) {
        let Some(chain) = nodes(piece) else { continue };
        let d = data(&chain);
        elements += 1;
        inner += &format!(
            "    <path id=\"{id}_{number}\" inkscape:label=\"{label} {number}\" style=\"{style}\"\n       biplane:written=\"{d}\"\n       d=\"{d}\" />\n"
        );
        let ends = [("from", piece.trusted[0]), ("to", piece.trusted[1])];
        for (word, [x, y]) in ends.iter().filter_map(|(word, at)| Some((word, piece.points.get(*at)?))) {
            if piece.closed {
                break;
            }
            elements += 1;
            inner += &format!(
                "    <circle id=\"{id}_{number}_{word}\" inkscape:label=\"{label} {number} {word}\" biplane:mark=\"{word}\" biplane:of=\"{label} \
                 {number}\"\n       style=\"fill:{colour};fill-opacity:0.6;stroke:none\" biplane:written=\"M {x:.3},{y:.3} h 0\" \
                 cx=\"{x:.3}\" cy=\"{y:.3}\" r=\"{MARK_PX}\" />\n"
            );
        }
    }
    let mut out = format!(
        "  <g inkscape:groupmode=\"layer\" id=\"{id}\" inkscape:label=\"{label}\" biplane:elements=\"{elements}\">\n"
    );
    for flag in flags {
        out += &format!("    <desc>{}</desc>\n", escaped(flag));
    }
    out + &inner + "  </g>\n"
}

/// A piece as a path with few nodes; `None` where its points are no curve.
fn nodes(piece: &SketchPiece) -> Option<Chain> {
    let points: Vec<Point2> = piece.points.iter().map(|p| Point2::from(*p)).collect();
    let how = Smoothing { choice: Choice::Risk, correlated_points: CORRELATED_POINTS };
    let smooth = Spline::near(&points, &piece.sigmas, piece.closed, how).ok()?;
    Chain::of(&Piece::whole(smooth.spline).fewer_beziers(NODES_PX, PATH_PX).curves, piece.closed)
}

/// A chain as the attribute `d`.
fn data(chain: &Chain) -> String {
    let pair = |[x, y]: Pair| format!("{x:.3},{y:.3}");
    let cubics = chain.cubics.iter().map(|[a, b, c]| format!(" {} {} {}", pair(*a), pair(*b), pair(*c)));
    let close = if chain.closed { " Z" } else { "" };
    format!("M {} C{}{close}", pair(chain.start), cubics.collect::<String>())
}

/// Text within XML.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            // XML has no other control characters, and would turn these into blanks.
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

/// A relative path as the address of a link.
fn address(path: &str) -> String {
    let mut out = String::with_capacity(path.len());
    for byte in path.bytes() {
        if byte.is_ascii_alphanumeric() || b"-_./~".contains(&byte) {
            out.push(char::from(byte));
        } else {
            out += &format!("%{byte:02X}");
        }
    }
    out
}
