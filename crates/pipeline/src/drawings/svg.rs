//! SVG text, written mark by mark: what is drawn is well-formed and holds no number that is none, whatever it is fed.
//!
//! Attributes stand at each mark (no style sheet, no ids), so several drawings can stand in one page without disturbing
//! each other. Nothing refers to a file or an address outside.

/// A drawing in the making.
#[derive(Debug, Default)]
pub(super) struct Svg(String);

/// How the marks of a group look; what is not set is inherited from the group around it.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Style<'a> {
    /// What the marks are: `class` of the group.
    pub class: &'a str,
    /// Colour inside, `none` for outlines.
    pub fill: &'a str,
    /// Colour of lines.
    pub stroke: &'a str,
    /// Width of lines, in the units of the coordinates around.
    pub width: f64,
    /// Length of strokes and gaps, 0 for lines without gaps.
    pub dash: f64,
    /// 0 to 1, where 0 stands for not set.
    pub opacity: f64,
}

impl<'a> Style<'a> {
    /// Lines of a colour and width, nothing inside.
    pub(super) fn line(class: &'a str, colour: &'a str, width: f64) -> Self {
        Self { class, fill: "none", stroke: colour, width, ..Self::default() }
    }

    /// Areas of a colour, no lines.
    pub(super) fn area(class: &'a str, colour: &'a str) -> Self {
        Self { class, fill: colour, ..Self::default() }
    }
}

/// Which end of a text its place is.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum Anchor {
    /// The text begins there.
    #[default]
    Start,
    /// It has its middle there.
    Middle,
    /// It ends there.
    End,
}

/// How a text looks.
#[derive(Debug, Clone, Copy)]
pub(super) struct Font<'a> {
    /// Height of its line, in the units of the coordinates around.
    pub size: f64,
    /// Its colour.
    pub colour: &'a str,
    /// Whether it is bold.
    pub bold: bool,
    /// Where its place is.
    pub anchor: Anchor,
    /// Whether it has a dark edge, for pictures of any brightness.
    pub edged: bool,
}

impl<'a> Font<'a> {
    /// Plain text that begins at its place.
    pub(super) fn new(size: f64, colour: &'a str) -> Self {
        Self { size, colour, bold: false, anchor: Anchor::Start, edged: false }
    }

    /// The same, bold.
    pub(super) fn bold(self) -> Self {
        Self { bold: true, ..self }
    }

    /// The same, with a dark edge.
    pub(super) fn edged(self) -> Self {
        Self { edged: true, ..self }
    }

    /// The same, set to another end.
    pub(super) fn anchored(self, anchor: Anchor) -> Self {
        Self { anchor, ..self }
    }
}

/// About how wide a text is in a usual sans-serif font, in the units of `size`.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    text.chars().count() as f64 * size * 0.56
}

/// A coordinate: three decimals, never an exponent, `NaN` or infinite; those become 0 or a place far outside.
fn number(value: f64) -> String {
    let value = if value.is_nan() { 0.0 } else { value.clamp(-1e6, 1e6) };
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// A text as XML has it: marks of XML written out, control characters that XML forbids replaced.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\t' | '\n' | '\r' => out.push(' '),
            '\u{0}'..='\u{1f}' | '\u{7f}'..='\u{9f}' | '\u{fffe}' | '\u{ffff}' => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

impl Svg {
    /// The whole drawing: a page of `size` units, white, with what was drawn on it, in a generic font.
    pub(super) fn into_page(self, size: [f64; 2]) -> String {
        let [width, height] = size.map(number);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} \
             {height}\" font-family=\"sans-serif\">\n<rect width=\"{width}\" height=\"{height}\" \
             fill=\"#ffffff\"/>\n{}</svg>\n",
            self.0
        )
    }

    /// Marks of one look.
    pub(super) fn group(&mut self, style: Style, draw: impl FnOnce(&mut Self)) {
        let Style { class, fill, stroke, width, dash, opacity } = style;
        self.0.push_str("<g");
        for (name, value) in [("class", class), ("fill", fill), ("stroke", stroke)] {
            if !value.is_empty() {
                self.0.push_str(&format!(" {name}=\"{}\"", escaped(value)));
            }
        }
        for (name, value) in [("stroke-width", width), ("stroke-dasharray", dash), ("opacity", opacity)] {
            if value > 0.0 {
                self.0.push_str(&format!(" {name}=\"{}\"", number(value)));
            }
        }
        self.0.push_str(">\n");
        draw(self);
        self.0.push_str("</g>\n");
    }

    /// A window at `corner` of `size` through which one looks at the part `first..first + extent` of other coordinates; what
    /// lies outside is cut off.
    pub(super) fn window(
        &mut self,
        corner: [f64; 2],
        size: [f64; 2],
        first: [f64; 2],
        extent: [f64; 2],
        draw: impl FnOnce(&mut Self),
    ) {
        let ([x, y], [width, height]) = (corner.map(number), size.map(number));
        let ([left, top], [wide, high]) = (first.map(number), extent.map(number));
        self.0.push_str(&format!(
            "<svg x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" viewBox=\"{left} {top} {wide} {high}\" \
             overflow=\"hidden\">\n"
        ));
        draw(self);
        self.0.push_str("</svg>\n");
    }

    /// A circle.
    pub(super) fn circle(&mut self, at: [f64; 2], radius: f64) {
        let [x, y] = at.map(number);
        self.0.push_str(&format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{}\"/>\n", number(radius.max(0.0))));
    }

    /// A rectangle.
    pub(super) fn rectangle(&mut self, corner: [f64; 2], size: [f64; 2]) {
        let ([x, y], [width, height]) = (corner.map(number), size.map(|v| number(v.max(0.0))));
        self.0.push_str(&format!("<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"/>\n"));
    }

    /// A diagonal cross that reaches `half` to each side.
    pub(super) fn cross(&mut self, at: [f64; 2], half: f64) {
        let [x, y] = at;
        let strokes = [
            vec![[x - half, y - half], [x + half, y + half]],
            vec![[x - half, y + half], [x + half, y - half]],
        ];
        self.strokes(&strokes, false);
    }

    /// A line through points.
    pub(super) fn line(&mut self, points: &[[f64; 2]]) {
        self.strokes(&[points.to_vec()], false);
    }

    /// A closed line through points.
    pub(super) fn polygon(&mut self, points: &[[f64; 2]]) {
        self.strokes(&[points.to_vec()], true);
    }

    /// Several lines as one mark.
    pub(super) fn strokes(&mut self, lines: &[Vec<[f64; 2]>], closed: bool) {
        let mut path = String::new();
        for line in lines {
            for (place, point) in line.iter().enumerate() {
                let [x, y] = point.map(number);
                path.push_str(&format!("{}{x} {y}", if place == 0 { "M" } else { "L" }));
            }
            path.push_str(if closed { "Z" } else { "" });
        }
        self.0.push_str(&format!("<path d=\"{path}\"/>\n"));
    }

    /// A text whose base line is at `at`.
    pub(super) fn text(&mut self, at: [f64; 2], font: Font, text: &str) {
        let [x, y] = at.map(number);
        let anchor = match font.anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let weight = if font.bold { " font-weight=\"bold\"" } else { "" };
        let edge = match font.edged {
            true => format!(
                "stroke=\"#15191d\" stroke-width=\"{}\" paint-order=\"stroke\"",
                number(0.22 * font.size)
            ),
            false => "stroke=\"none\"".to_owned(),
        };
        self.0.push_str(&format!(
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" fill=\"{}\" {edge}{anchor}{weight}>{}</text>\n",
            number(font.size),
            escaped(font.colour),
            escaped(text)
        ));
    }

    /// A PNG picture, drawn into a rectangle.
    pub(super) fn png(&mut self, corner: [f64; 2], size: [f64; 2], base64: &str) {
        let ([x, y], [width, height]) = (corner.map(number), size.map(number));
        self.0.push_str(&format!(
            "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" preserveAspectRatio=\"none\" \
             href=\"data:image/png;base64,{base64}\"/>\n"
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_always_numbers() {
        let written: Vec<String> =
            [1.0, -0.0001, 0.25, f64::NAN, f64::INFINITY, -1e300, 1234.5678].map(number).into();
        assert_eq!(written, ["1", "0", "0.25", "0", "1000000", "-1000000", "1234.568"]);
    }

    #[test]
    fn text_keeps_its_meaning_and_breaks_nothing() {
        assert_eq!(
            escaped("<a b=\"c\"> & 'd'\n\u{0}\u{1b}é"),
            "&lt;a b=&quot;c&quot;&gt; &amp; &#39;d&#39; \u{fffd}\u{fffd}é"
        );
    }
}
