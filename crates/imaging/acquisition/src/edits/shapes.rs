//! Shapes of SVG as chains of cubic Bezier curves, in the shape's own coordinates.
//!
//! Paths after SVG 1.1, section 8.3, arcs after its appendix F.6: a part of at most an eighth of a right angle has an error of
//! 5e-9 of the radius. Not read by `svgtypes`' own simplification, whose arcs are within 0.1 of a unit only.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use svgtypes::{PathParser, PathSegment, PointsParser};

use super::chain::Chain;
use super::place::Pair;

/// The chains of an attribute `d`, one a subpath; lone moves are left out.
pub(super) fn path(d: &str) -> Result<Vec<Chain>, String> {
    let mut chains: Vec<Chain> = Vec::new();
    let mut open: Option<Chain> = None;
    // Where the pen is, and the handle that a smooth command reflects.
    let (mut pen, mut cubic, mut quadratic): (Pair, Option<Pair>, Option<Pair>) = ([0.0; 2], None, None);
    let mut start = [0.0; 2];
    for segment in PathParser::from(d) {
        let segment = segment.map_err(|e| format!("its path data cannot be read: {e}"))?;
        let absolute = segment.is_abs();
        let from = pen;
        let place = |x: f64, y: f64| if absolute { [x, y] } else { [from[0] + x, from[1] + y] };
        let reflected = |handle: Option<Pair>| handle.map_or(from, |h| [0, 1].map(|i| 2.0 * from[i] - h[i]));
        if let PathSegment::MoveTo { x, y, .. } = segment {
            chains.extend(open.take().filter(|c| !c.cubics.is_empty()));
            pen = place(x, y);
            start = pen;
            (cubic, quadratic) = (None, None);
            continue;
        }
        // After a `Z` a new subpath begins where the last one did.
        let chain = open.get_or_insert_with(|| Chain::new(from));
        let (mut next_cubic, mut next_quadratic) = (None, None);
        match segment {
            PathSegment::MoveTo { .. } => {}
            PathSegment::ClosePath { .. } => {
                chain.close();
                chains.extend(open.take().filter(|c| !c.cubics.is_empty()));
                pen = start;
                (cubic, quadratic) = (None, None);
                continue;
            }
            PathSegment::LineTo { x, y, .. } => chain.line_to(place(x, y)),
            PathSegment::HorizontalLineTo { x, .. } => chain.line_to([place(x, 0.0)[0], from[1]]),
            PathSegment::VerticalLineTo { y, .. } => chain.line_to([from[0], place(0.0, y)[1]]),
            PathSegment::CurveTo { x1, y1, x2, y2, x, y, .. } => {
                chain.cubics.push([place(x1, y1), place(x2, y2), place(x, y)]);
                next_cubic = Some(place(x2, y2));
            }
            PathSegment::SmoothCurveTo { x2, y2, x, y, .. } => {
                chain.cubics.push([reflected(cubic), place(x2, y2), place(x, y)]);
                next_cubic = Some(place(x2, y2));
            }
            PathSegment::Quadratic { x1, y1, x, y, .. } => {
                chain.cubics.push(raised(from, place(x1, y1), place(x, y)));
                next_quadratic = Some(place(x1, y1));
            }
            PathSegment::SmoothQuadratic { x, y, .. } => {
                let handle = reflected(quadratic);
                chain.cubics.push(raised(from, handle, place(x, y)));
                next_quadratic = Some(handle);
            }
            PathSegment::EllipticalArc { rx, ry, x_axis_rotation, large_arc, sweep, x, y, .. } => {
                arc_to(chain, [rx, ry], x_axis_rotation.to_radians(), [large_arc, sweep], place(x, y));
            }
        }
        pen = chain.end();
        (cubic, quadratic) = (next_cubic, next_quadratic);
    }
    chains.extend(open.filter(|c| !c.cubics.is_empty()));
    Ok(chains)
}

/// A quadratic as a cubic.
fn raised(from: Pair, handle: Pair, to: Pair) -> [Pair; 3] {
    let between = |end: Pair| [0, 1].map(|i| end[i] + 2.0 / 3.0 * (handle[i] - end[i]));
    [between(from), between(to), to]
}

/// An elliptical arc from where the chain ends.
fn arc_to(chain: &mut Chain, radii: Pair, turn: f64, [large, sweep]: [bool; 2], to: Pair) {
    let from = chain.end();
    let [mut rx, mut ry] = radii.map(f64::abs);
    if rx == 0.0 || ry == 0.0 {
        return chain.line_to(to);
    }
    if from == to {
        return;
    }
    let (sin, cos) = turn.sin_cos();
    let half = [0, 1].map(|i| (from[i] - to[i]) / 2.0);
    let (x, y) = (cos * half[0] + sin * half[1], -sin * half[0] + cos * half[1]);
    // Too small radii grow until the arc reaches.
    let reach = ((x / rx).powi(2) + (y / ry).powi(2)).sqrt().max(1.0);
    (rx, ry) = (rx * reach, ry * reach);
    let off = (x / rx).powi(2) + (y / ry).powi(2);
    let side = if large == sweep { -1.0 } else { 1.0 };
    let side = side * ((1.0 - off).max(0.0) / off).sqrt();
    let (cx, cy) = (side * rx * y / ry, -side * ry * x / rx);
    let centre =
        [(from[0] + to[0]) / 2.0 + cos * cx - sin * cy, (from[1] + to[1]) / 2.0 + sin * cx + cos * cy];
    let first = ((y - cy) / ry).atan2((x - cx) / rx);
    let last = ((-y - cy) / ry).atan2((-x - cx) / rx);
    let mut angle = last - first;
    if sweep && angle < 0.0 {
        angle += TAU;
    } else if !sweep && angle > 0.0 {
        angle -= TAU;
    }
    ellipse_part(chain, centre, [rx, ry], [sin, cos], first, angle);
    if let Some(end) = chain.cubics.last_mut() {
        // Without the rounding of sines.
        end[2] = to;
    }
}

/// A part of an ellipse from the angle `first` on, from where the chain ends.
fn ellipse_part(chain: &mut Chain, centre: Pair, [rx, ry]: Pair, [sin, cos]: Pair, first: f64, angle: f64) {
    let count = (angle.abs() / (FRAC_PI_2 / 8.0)).ceil();
    if !(1.0..=32.0).contains(&count) {
        return chain.line_to([f64::NAN; 2]);
    }
    let step = angle / count;
    let handle = 4.0 / 3.0 * (step / 4.0).tan();
    let place =
        |x: f64, y: f64| [centre[0] + cos * rx * x - sin * ry * y, centre[1] + sin * rx * x + cos * ry * y];
    for part in 0..count as usize {
        let (s0, c0) = (first + step * part as f64).sin_cos();
        let (s1, c1) = (first + step * (part + 1) as f64).sin_cos();
        chain.cubics.push([
            place(c0 - handle * s0, s0 + handle * c0),
            place(c1 + handle * s1, s1 - handle * c1),
            place(c1, s1),
        ]);
    }
}

/// A whole ellipse.
pub(super) fn ellipse(centre: Pair, radii: Pair) -> Chain {
    let mut chain = Chain::new([centre[0] + radii[0], centre[1]]);
    ellipse_part(&mut chain, centre, radii, [0.0, 1.0], 0.0, TAU);
    let start = chain.start;
    if let Some(end) = chain.cubics.last_mut() {
        end[2] = start;
    }
    chain.closed = true;
    chain
}

/// A rectangle with rounded corners.
pub(super) fn rectangle([x, y]: Pair, [w, h]: Pair, [rx, ry]: Pair) -> Chain {
    let (rx, ry) = (rx.clamp(0.0, w / 2.0), ry.clamp(0.0, h / 2.0));
    let mut chain = Chain::new([x + rx, y]);
    let corners = [
        ([x + w - rx, y], [x + w - rx, y + ry], -FRAC_PI_2),
        ([x + w, y + h - ry], [x + w - rx, y + h - ry], 0.0),
        ([x + rx, y + h], [x + rx, y + h - ry], FRAC_PI_2),
        ([x, y + ry], [x + rx, y + ry], PI),
    ];
    for (side, centre, first) in corners {
        chain.line_to(side);
        if rx > 0.0 && ry > 0.0 {
            ellipse_part(&mut chain, centre, [rx, ry], [0.0, 1.0], first, FRAC_PI_2);
        }
    }
    chain.close();
    chain
}

/// An attribute `points`.
pub(super) fn polyline(points: &str, closed: bool) -> Result<Option<Chain>, String> {
    let count = points.split(|c: char| c == ',' || c.is_ascii_whitespace()).filter(|p| !p.is_empty()).count();
    let mut places = PointsParser::from(points).map(|(x, y)| [x, y]);
    let Some(start) = places.next() else {
        return if count == 0 { Ok(None) } else { Err("its points cannot be read".to_owned()) };
    };
    let mut chain = Chain::new(start);
    for place in places {
        chain.line_to(place);
    }
    // The parser stops quietly where it cannot go on. (Numbers may also be parted by a sign alone, so there may be more points.)
    if 2 * (chain.cubics.len() + 1) < count {
        let after = chain.cubics.len() + 1;
        return Err(format!("its points cannot be read after the first {after}"));
    }
    if closed {
        chain.close();
    }
    Ok((!chain.cubics.is_empty()).then_some(chain))
}
