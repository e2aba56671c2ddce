//! PLY 1.0 (Turk 1994) to triangles: ascii, and binary of either byte order.
//!
//! Of the element `vertex` the properties `x`, `y`, `z` are used, of `face` the list `vertex_indices` (or `vertex_index`), of `tristrips` the
//! same list, where -1 begins a new strip. All other properties and elements are passed over by what the header says of them.

use std::path::Path;

use biplane_geometry::Point3;

use super::soup::{MOST_CORNERS, Soup};
use super::words::{Words, parsed, quoted, words};
use super::{MeshFileError, MeshFormat};

pub(super) fn starts(start: &[u8]) -> bool {
    let start = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start);
    start.len() >= 4 && start.starts_with(b"ply") && start[3].is_ascii_whitespace()
}

/// A type of number in the header.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Scalar {
    Int8,
    Uint8,
    Int16,
    Uint16,
    Int32,
    Uint32,
    Int64,
    Uint64,
    Float32,
    Float64,
}

impl Scalar {
    fn of(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::Int8,
            b"uchar" | b"uint8" => Self::Uint8,
            b"short" | b"int16" => Self::Int16,
            b"ushort" | b"uint16" => Self::Uint16,
            b"int" | b"int32" => Self::Int32,
            b"uint" | b"uint32" => Self::Uint32,
            b"int64" | b"longlong" => Self::Int64,
            b"uint64" | b"ulonglong" => Self::Uint64,
            b"float" | b"float32" => Self::Float32,
            b"double" | b"float64" => Self::Float64,
            _ => return None,
        })
    }

    fn bytes(self) -> usize {
        match self {
            Self::Int8 | Self::Uint8 => 1,
            Self::Int16 | Self::Uint16 => 2,
            Self::Int32 | Self::Uint32 | Self::Float32 => 4,
            Self::Int64 | Self::Uint64 | Self::Float64 => 8,
        }
    }

    /// The number in its bytes; 64-bit whole numbers are rounded to 53 bits.
    fn value(self, bytes: &[u8], big: bool) -> f64 {
        let mut word = [0_u8; 8];
        let n = self.bytes().min(bytes.len());
        word[..n].copy_from_slice(&bytes[..n]);
        if big {
            word[..n].reverse();
        }
        let [a, b, c, d, ..] = word;
        match self {
            Self::Int8 => f64::from(a as i8),
            Self::Uint8 => f64::from(a),
            Self::Int16 => f64::from(i16::from_le_bytes([a, b])),
            Self::Uint16 => f64::from(u16::from_le_bytes([a, b])),
            Self::Int32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Self::Uint32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Self::Float32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Self::Int64 => i64::from_le_bytes(word) as f64,
            Self::Uint64 => u64::from_le_bytes(word) as f64,
            Self::Float64 => f64::from_le_bytes(word),
        }
    }
}

#[derive(Debug)]
enum Property {
    One(Scalar),
    List { count: Scalar, item: Scalar },
}

#[derive(Debug)]
struct Element {
    name: String,
    count: usize,
    properties: Vec<(String, Property)>,
    line: usize,
}

impl Element {
    fn property(&self, names: &[&str]) -> Option<usize> {
        self.properties.iter().position(|(name, _)| names.contains(&name.as_str()))
    }

    /// The fewest bytes of one, in text or not: a list may be empty, a number in text takes a digit and a blank.
    fn least_bytes(&self, ascii: bool) -> usize {
        let of = |(_, property): &(String, Property)| match property {
            _ if ascii => 2,
            Property::One(scalar) => scalar.bytes(),
            Property::List { count, .. } => count.bytes(),
        };
        self.properties.iter().map(of).sum()
    }
}

/// What the header says.
struct Header {
    format: MeshFormat,
    elements: Vec<Element>,
}

fn header(text: &mut Words<'_>) -> Result<Header, MeshFileError> {
    text.next_line();
    let mut format = None;
    let mut elements: Vec<Element> = Vec::new();
    loop {
        let line = text.line();
        let Some(full) = text.next_line() else {
            return Err(text.expected("`end_header`", b""));
        };
        let wrong = |expected: &str| text.expected_at(line, expected, full);
        let split: Vec<&[u8]> = words(full).collect();
        match split[..] {
            [] | [b"comment" | b"obj_info", ..] => {}
            [b"format", name, b"1.0"] => {
                format = Some(match name {
                    b"ascii" => MeshFormat::PlyAscii,
                    b"binary_little_endian" => MeshFormat::PlyLittleEndian,
                    b"binary_big_endian" => MeshFormat::PlyBigEndian,
                    _ => {
                        return Err(wrong(
                            "`format ascii`, `binary_little_endian` or `binary_big_endian`, and `1.0`",
                        ));
                    }
                });
            }
            [b"element", name, count] => {
                let count = parsed(count).ok_or_else(|| wrong("`element`, a name and a count"))?;
                let name = String::from_utf8_lossy(name).into_owned();
                elements.push(Element { name, count, properties: Vec::new(), line });
            }
            [b"property", ref types @ .., name] => {
                let property = match types {
                    [one] => Scalar::of(one).map(Property::One),
                    [b"list", count, item] => Scalar::of(count)
                        .zip(Scalar::of(item))
                        .map(|(count, item)| Property::List { count, item }),
                    _ => None,
                };
                let expected = "`property TYPE NAME` or `property list TYPE TYPE NAME` (char, uchar, short, ushort, int, uint, \
                                float, double) after an `element`";
                let element = elements.last_mut().ok_or_else(|| wrong(expected))?;
                let property = property.ok_or_else(|| wrong(expected))?;
                element.properties.push((String::from_utf8_lossy(name).into_owned(), property));
            }
            [b"end_header"] => break,
            _ => return Err(wrong("`format`, `comment`, `element`, `property` or `end_header`")),
        }
    }
    let format = format.ok_or_else(|| text.refused("its header has no line `format`; export it again"))?;
    Ok(Header { format, elements })
}

/// Numbers of the body one after another, whatever their encoding.
struct Body<'a> {
    text: Words<'a>,
    format: MeshFormat,
}

impl Body<'_> {
    fn number(&mut self, scalar: Scalar, of: &Element, at: usize) -> Result<f64, MeshFileError> {
        if self.format == MeshFormat::PlyAscii {
            let word = self.text.next();
            return parsed(word).ok_or_else(|| {
                self.text.expected(format!("a number of {} {at} (counted from 0)", of.name), word)
            });
        }
        match self.text.take(scalar.bytes()) {
            Some(bytes) => Ok(scalar.value(bytes, self.format == MeshFormat::PlyBigEndian)),
            None => Err(self.cut(of, at)),
        }
    }

    fn cut(&self, of: &Element, at: usize) -> MeshFileError {
        self.text.cut(format!(
            "its header says {} of the element {}, and it ends in number {at} (counted from 0)",
            of.count, of.name
        ))
    }

    /// A message for something wrong in an element.
    fn wrong(&self, of: &Element, at: usize, expected: &str, found: &str) -> MeshFileError {
        if self.format == MeshFormat::PlyAscii {
            return self
                .text
                .expected(format!("{expected} in {} {at} (counted from 0)", of.name), found.as_bytes());
        }
        self.text.refused(format!(
            "{} {at} (counted from 0): expected {expected}, found {}",
            of.name,
            quoted(found.as_bytes())
        ))
    }

    /// Reads one property; a list goes to `into`, if that is asked for.
    fn property(
        &mut self,
        property: &Property,
        of: &Element,
        at: usize,
        mut into: Option<&mut Vec<f64>>,
    ) -> Result<f64, MeshFileError> {
        let (count, item) = match *property {
            Property::One(scalar) => return self.number(scalar, of, at),
            Property::List { count, item } => (count, item),
        };
        let count = self.number(count, of, at)?;
        // A list has fewer members than the rest of the file has bytes.
        if !(0.0..=self.text.rest().len() as f64).contains(&count) || count.fract() != 0.0 {
            return Err(self.wrong(of, at, "a list's count that the file can hold", &count.to_string()));
        }
        for _ in 0..count as usize {
            let value = self.number(item, of, at)?;
            if let Some(into) = &mut into {
                into.push(value);
            }
        }
        Ok(count)
    }
}

pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<Soup, MeshFileError> {
    let mut text = Words::new(path, bytes);
    let Header { format, elements } = header(&mut text)?;
    let ascii = format == MeshFormat::PlyAscii;
    let mut soup = Soup::new(format);
    let mut body = Body { text, format };
    for element in &elements {
        let least = element.least_bytes(ascii);
        // The last number of a text needs no blank behind it.
        if element.count.saturating_mul(least) > body.text.rest().len() + usize::from(ascii) {
            return Err(body.text.cut(format!(
                "its header says {} of the element {} (line {}), more than the {} bytes behind can hold",
                element.count,
                element.name,
                element.line,
                body.text.rest().len()
            )));
        }
        match element.name.as_str() {
            _ if least == 0 => {}
            "vertex" => places(&mut body, element, &mut soup.points)?,
            "face" | "tristrips" => faces(&mut body, element, &mut soup)?,
            _ => pass(&mut body, element)?,
        }
    }
    soup.trailing_bytes = body.text.rest().trim_ascii().len() as u64;
    Ok(soup)
}

fn places(body: &mut Body<'_>, element: &Element, points: &mut Vec<Point3>) -> Result<(), MeshFileError> {
    let axes = ["x", "y", "z"].map(|axis| element.property(&[axis]));
    let [Some(x), Some(y), Some(z)] = axes else {
        let found = "an element vertex without one of them";
        return Err(body.text.expected_at(element.line, "the properties x, y and z", found.as_bytes()));
    };
    points.reserve_exact(element.count);
    let mut values = vec![0.0; element.properties.len()];
    for at in 0..element.count {
        for (value, (_, property)) in values.iter_mut().zip(&element.properties) {
            *value = body.property(property, element, at, None)?;
        }
        points.push(Point3::new(values[x], values[y], values[z]));
    }
    Ok(())
}

fn faces(body: &mut Body<'_>, element: &Element, soup: &mut Soup) -> Result<(), MeshFileError> {
    let wanted = element.property(&["vertex_indices", "vertex_index"]);
    let wanted =
        wanted.filter(|w| matches!(element.properties[*w].1, Property::List { .. })).ok_or_else(|| {
            let found = format!("an element {} without it", element.name);
            body.text.expected_at(element.line, "`property list ... vertex_indices`", found.as_bytes())
        })?;
    let vertices = soup.points.len();
    let strips = element.name == "tristrips";
    let mut list: Vec<f64> = Vec::new();
    let mut corners: Vec<u32> = Vec::new();
    for at in 0..element.count {
        list.clear();
        for (i, (_, property)) in element.properties.iter().enumerate() {
            body.property(property, element, at, (i == wanted).then_some(&mut list))?;
        }
        corners.clear();
        for value in &list {
            if strips && *value == -1.0 {
                soup.strip(&corners);
                corners.clear();
                continue;
            }
            if !(0.0..vertices as f64).contains(value) || value.fract() != 0.0 {
                let expected = format!("indices of the {vertices} vertices before it, from 0");
                return Err(body.wrong(element, at, &expected, &value.to_string()));
            }
            corners.push(*value as u32);
        }
        if strips {
            soup.strip(&corners);
        } else if corners.len() > MOST_CORNERS {
            let expected = format!("a polygon of at most {MOST_CORNERS} corners");
            return Err(body.wrong(element, at, &expected, &corners.len().to_string()));
        } else {
            soup.polygon(&corners);
        }
    }
    Ok(())
}

fn pass(body: &mut Body<'_>, element: &Element) -> Result<(), MeshFileError> {
    for at in 0..element.count {
        for (_, property) in &element.properties {
            body.property(property, element, at, None)?;
        }
    }
    Ok(())
}
