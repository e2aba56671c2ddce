//! VTK's XML of polygons (`.vtp`, `PolyData`) to triangles: polygons and strips of all its pieces.
//!
//! Arrays may stand as text, as base64 in place, or behind `AppendedData` as base64 or raw; packed with zlib or not; in either byte
//! order; with 32-bit or 64-bit counts. What is behind `AppendedData` is no XML, so the document is cut there before it is parsed. A
//! binary array begins with its count of bytes; a packed one with its count of blocks, the bytes of a block, those of the last block (0: as
//! the others), and the packed bytes of each block.

use std::path::Path;

use biplane_geometry::Point3;
use roxmltree::{Document, Node};

use super::soup::Soup;
use super::vtk_cells::{Cells, Kind};
use super::vtp_bytes::{Bytes, base64, unpacked};
use super::words::{parsed, words};
use super::{MeshFileError, MeshFormat};

pub(super) fn starts(start: &[u8]) -> bool {
    let start = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start).trim_ascii_start();
    start.starts_with(b"<") && find(start, b"<VTKFile").is_some()
}

fn find(bytes: &[u8], word: &[u8]) -> Option<usize> {
    bytes.windows(word.len()).position(|w| w == word)
}

/// The document and what it says of its arrays.
struct File<'a> {
    path: &'a Path,
    document: &'a Document<'a>,
    big: bool,
    /// Bytes of a count.
    word: usize,
    packed: bool,
    /// Behind `AppendedData`, and whether that is base64.
    appended: &'a [u8],
    appended_base64: bool,
    /// Where arrays begin behind `AppendedData`, sorted.
    offsets: Vec<usize>,
}

pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<Soup, MeshFileError> {
    let refused = |what: String| MeshFileError::Refused { path: path.to_owned(), what };
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let (head, appended) = split(bytes);
    let text = std::str::from_utf8(&head)
        .map_err(|e| refused(format!("byte {} of its XML is not text (UTF-8)", e.valid_up_to())))?;
    let document = Document::parse(text).map_err(|e| {
        let line = e.pos().row as usize;
        MeshFileError::Line { path: path.to_owned(), line, expected: "XML".to_owned(), found: e.to_string() }
    })?;
    let root = document.root_element();
    let says = |name: &str| root.attribute(name).unwrap_or_default();
    if !root.has_tag_name("VTKFile") || says("type") != "PolyData" {
        return Err(refused(format!(
            "it holds `{}`, and of VTK's XML only `PolyData` is read; extract the surface (in ParaView: Extract Surface) and save it as .vtp or .stl",
            says("type")
        )));
    }
    let packed = match says("compressor") {
        "" => false,
        "vtkZLibDataCompressor" => true,
        other => {
            return Err(refused(format!("it is packed with `{other}`; save it with zlib or not packed")));
        }
    };
    let word = match says("header_type") {
        "" | "UInt32" => 4,
        "UInt64" => 8,
        other => return Err(refused(format!("its counts are `{other}`; expected UInt32 or UInt64"))),
    };
    let holder = root.children().find(|n| n.has_tag_name("AppendedData"));
    let arrays = document.descendants().filter(|n| n.has_tag_name("DataArray") || n.has_tag_name("Array"));
    let mut offsets: Vec<usize> = arrays.filter_map(|n| n.attribute("offset")?.parse().ok()).collect();
    offsets.sort_unstable();
    let file = File {
        path,
        document: &document,
        big: says("byte_order") == "BigEndian",
        word,
        packed,
        appended,
        appended_base64: holder.and_then(|h| h.attribute("encoding")) == Some("base64"),
        offsets,
    };
    let mut soup = Soup::new(MeshFormat::Vtp);
    for piece in document.descendants().filter(|n| n.has_tag_name("Piece")) {
        file.piece(piece, &mut soup)?;
    }
    Ok(soup)
}

/// The XML without what is appended, and that, from behind its underscore to its end tag.
fn split(bytes: &[u8]) -> (Vec<u8>, &[u8]) {
    let tag = find(bytes, b"<AppendedData");
    let Some(open) = tag.and_then(|at| Some(at + find(bytes.get(at..)?, b">")? + 1)) else {
        return (bytes.to_vec(), &[]);
    };
    let (head, behind) = bytes.split_at(open);
    if head.ends_with(b"/>") {
        return (bytes.to_vec(), &[]);
    }
    let close = b"</AppendedData>";
    let end = behind.windows(close.len()).rposition(|w| w == close).unwrap_or(behind.len());
    let behind = behind.get(..end).unwrap_or_default();
    let begin = behind.iter().position(|b| *b == b'_').map_or(behind.len(), |at| at + 1);
    ([head, close, b"</VTKFile>"].concat(), behind.get(begin..).unwrap_or_default())
}

impl File<'_> {
    fn wrong(&self, node: Node<'_, '_>, expected: &str, found: &str) -> MeshFileError {
        let line = self.document.text_pos_at(node.range().start).row as usize;
        MeshFileError::Line {
            path: self.path.to_owned(),
            line,
            expected: expected.to_owned(),
            found: found.to_owned(),
        }
    }

    fn piece(&self, piece: Node<'_, '_>, soup: &mut Soup) -> Result<(), MeshFileError> {
        let child = |name: &str| piece.children().find(|n| n.has_tag_name(name));
        let count = |name: &str| -> Result<usize, MeshFileError> {
            let Some(text) = piece.attribute(name) else { return Ok(0) };
            text.trim()
                .parse()
                .map_err(|_| self.wrong(piece, &format!("a whole number in {name}"), &format!("`{text}`")))
        };
        let points = count("NumberOfPoints")?;
        let first = soup.points.len();
        if points > 0 {
            let array = child("Points").and_then(|n| n.children().find(|n| n.has_tag_name("DataArray")));
            let array = array.ok_or_else(|| self.wrong(piece, "Points with a DataArray", "none"))?;
            let values = self.values(array, points.saturating_mul(3))?;
            soup.points.extend(values.chunks_exact(3).map(|p| Point3::new(p[0], p[1], p[2])));
        }
        for (name, number, kind) in
            [("Polys", "NumberOfPolys", Kind::Polygon), ("Strips", "NumberOfStrips", Kind::Strip)]
        {
            let number = count(number)?;
            if number == 0 {
                continue;
            }
            let cells = child(name).ok_or_else(|| self.wrong(piece, name, "none"))?;
            let array = |which: &str| {
                let found = cells
                    .children()
                    .find(|n| n.has_tag_name("DataArray") && n.attribute("Name") == Some(which));
                found.ok_or_else(|| self.wrong(cells, &format!("a DataArray `{which}`"), "none"))
            };
            let whole = |values: Vec<f64>| values.into_iter().map(|v| v as i64).collect::<Vec<i64>>();
            let ends = whole(self.values(array("offsets")?, number)?);
            let corners = ends.last().copied().unwrap_or_default();
            let corners = usize::try_from(corners).map_err(|_| {
                self.wrong(cells, "offsets from 0 on", &format!("`{corners}` as the last one"))
            })?;
            let corners = whole(self.values(array("connectivity")?, corners)?);
            Cells::from_ends(ends, corners).and_then(|cells| cells.add_each(first, |_| kind, soup)).map_err(
                |found| self.wrong(cells, &format!("{name} that name points of their piece"), &found),
            )?;
        }
        soup.leave_out(count("NumberOfLines")?, "lines");
        soup.leave_out(count("NumberOfVerts")?, "vertices of no face");
        Ok(())
    }

    /// The numbers of an array, of which there have to be `count`.
    fn values(&self, array: Node<'_, '_>, count: usize) -> Result<Vec<f64>, MeshFileError> {
        let kind = array.attribute("type").unwrap_or_default();
        let name = array.attribute("Name").unwrap_or("Points");
        let number = number(kind).ok_or_else(|| {
            self.wrong(array, "a type as Float32 or Int64", &format!("`{kind}` in the array {name}"))
        })?;
        // Remarks of VTK stand between the numbers and the end.
        let text: String = array.children().filter(Node::is_text).filter_map(|n| n.text()).collect();
        let values = match array.attribute("format").unwrap_or("ascii") {
            "ascii" => {
                let values = words(text.as_bytes()).map(|word| {
                    parsed(word).ok_or_else(|| {
                        let found = format!("`{}`", String::from_utf8_lossy(word));
                        self.wrong(array, &format!("numbers in the array {name}"), &found)
                    })
                });
                values.collect::<Result<Vec<f64>, _>>()?
            }
            "binary" => self.decoded(array, name, number, count, &base64(text.as_bytes()))?,
            "appended" => {
                let offset: usize = array
                    .attribute("offset")
                    .and_then(|o| o.parse().ok())
                    .ok_or_else(|| self.wrong(array, "an offset", "none that is a number"))?;
                let next = self.offsets.iter().find(|o| **o > offset).copied().unwrap_or(self.appended.len());
                let from = self.appended.get(offset..next.min(self.appended.len()).max(offset));
                let from = from.ok_or_else(|| {
                    let found = format!("offset {offset} of {} bytes; it is cut short", self.appended.len());
                    self.wrong(array, "an offset into what is appended", &found)
                })?;
                if self.appended_base64 {
                    self.decoded(array, name, number, count, &base64(from))?
                } else {
                    self.decoded(array, name, number, count, from)?
                }
            }
            other => {
                let expected = "the format ascii, binary or appended";
                return Err(self.wrong(array, expected, &format!("`{other}`")));
            }
        };
        if values.len() != count {
            let found = format!("{}", values.len());
            return Err(self.wrong(array, &format!("{count} numbers in the array {name}"), &found));
        }
        Ok(values)
    }

    fn decoded(
        &self,
        array: Node<'_, '_>,
        name: &str,
        number: Number,
        count: usize,
        bytes: &[u8],
    ) -> Result<Vec<f64>, MeshFileError> {
        let order = Bytes { big: self.big, word: self.word };
        let most = count.saturating_mul(number.bytes);
        let raw =
            if self.packed { unpacked(bytes, order, most) } else { order.counted(bytes).map(<[u8]>::to_vec) };
        let raw =
            raw.map_err(|found| self.wrong(array, &format!("the bytes of the array {name}"), &found))?;
        Ok(raw.chunks_exact(number.bytes).map(|b| number.value(b, self.big)).collect())
    }
}

/// A type of number.
#[derive(Clone, Copy)]
struct Number {
    bytes: usize,
    kind: u8,
}

fn number(kind: &str) -> Option<Number> {
    let (letter, bits) = [("UInt", b'u'), ("Int", b'i'), ("Float", b'f')]
        .iter()
        .find_map(|(word, letter)| Some((*letter, kind.strip_prefix(word)?)))?;
    let bytes = match bits {
        "8" => 1,
        "16" => 2,
        "32" => 4,
        "64" => 8,
        _ => return None,
    };
    (letter != b'f' || bytes >= 4).then_some(Number { bytes, kind: letter })
}

impl Number {
    fn value(self, bytes: &[u8], big: bool) -> f64 {
        let fold = |n: u64, b: &u8| n << 8 | u64::from(*b);
        let n = if big { bytes.iter().fold(0, fold) } else { bytes.iter().rev().fold(0, fold) };
        match (self.kind, self.bytes) {
            (b'f', 4) => f64::from(f32::from_bits(n as u32)),
            (b'f', _) => f64::from_bits(n),
            (b'i', width) => {
                let shift = 64 - 8 * width as u32;
                ((n << shift) as i64 >> shift) as f64
            }
            _ => n as f64,
        }
    }
}
