//! Legacy VTK files to triangles: `POLYDATA` (polygons and strips) and `UNSTRUCTURED_GRID` (triangles, quads, pixels, polygons, strips), ascii
//! and binary, which is big endian.
//!
//! Cells stand there in one of two ways: up to version 4.2 `POLYGONS n size`, then for each polygon how many corners and which; from 5.0 on
//! `POLYGONS n+1 m`, then `OFFSETS` (where each polygon begins in the next list) and `CONNECTIVITY`. Either is read of any version, by whether
//! the word `OFFSETS` follows. Attributes of points and cells, which come last, are not read. Lines, vertices and cells of volume are counted.

use std::path::Path;

use biplane_geometry::Point3;

use super::soup::Soup;
use super::vtk_cells::{Cells, Kind};
use super::words::{Words, parsed, words};
use super::{MeshFileError, MeshFormat};

pub(super) fn starts(start: &[u8]) -> bool {
    let start = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start);
    start.get(..23).is_some_and(|s| s.eq_ignore_ascii_case(b"# vtk DataFile Version "))
}

/// A type of number.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Scalar {
    bytes: usize,
    float: bool,
    signed: bool,
}

impl Scalar {
    fn of(name: &[u8]) -> Option<Self> {
        let whole = |bytes, signed| Some(Self { bytes, float: false, signed });
        match name.to_ascii_lowercase().as_slice() {
            b"float" => Some(Self { bytes: 4, float: true, signed: true }),
            b"double" => Some(Self { bytes: 8, float: true, signed: true }),
            b"char" | b"signed_char" => whole(1, true),
            b"unsigned_char" => whole(1, false),
            b"short" => whole(2, true),
            b"unsigned_short" => whole(2, false),
            // VTK writes its identifiers of points as int.
            b"int" | b"vtkidtype" => whole(4, true),
            b"unsigned_int" => whole(4, false),
            b"long" | b"vtktypeint64" => whole(8, true),
            b"unsigned_long" | b"vtktypeuint64" => whole(8, false),
            _ => None,
        }
    }

    /// The number in its bytes, the most significant one first.
    fn value(self, bytes: &[u8]) -> f64 {
        let number = bytes.iter().fold(0_u64, |n, b| n << 8 | u64::from(*b));
        match (self.float, self.bytes) {
            (true, 4) => f64::from(f32::from_bits(number as u32)),
            (true, _) => f64::from_bits(number),
            (false, n) if self.signed => {
                let shift = 64 - 8 * n as u32;
                ((number << shift) as i64 >> shift) as f64
            }
            (false, _) => number as f64,
        }
    }
}

struct Reader<'a> {
    text: Words<'a>,
    binary: bool,
}

impl<'a> Reader<'a> {
    /// `count` numbers of a type, each given to `each` with its place.
    fn numbers(
        &mut self,
        count: usize,
        scalar: Scalar,
        what: &str,
        each: &mut dyn FnMut(f64),
    ) -> Result<(), MeshFileError> {
        if !self.binary {
            for at in 0..count {
                let word = self.text.next();
                let expected = || format!("number {at} (counted from 0) of the {count} of {what}");
                each(parsed(word).ok_or_else(|| self.text.expected(expected(), word))?);
            }
            return Ok(());
        }
        let bytes = count.checked_mul(scalar.bytes).and_then(|n| self.text.take(n)).ok_or_else(|| {
            let there = self.text.rest().len();
            self.text.cut(format!(
                "{count} numbers of {} bytes of {what}, but {there} bytes are left",
                scalar.bytes
            ))
        })?;
        bytes.chunks_exact(scalar.bytes).for_each(|b| each(scalar.value(b)));
        Ok(())
    }

    /// As many numbers as a vector; memory is taken for no more than the file can hold.
    fn list(&mut self, count: usize, scalar: Scalar, what: &str) -> Result<Vec<i64>, MeshFileError> {
        let most = self.text.rest().len() / if self.binary { scalar.bytes } else { 2 } + 1;
        let mut list = Vec::with_capacity(count.min(most));
        // Beyond 2^53 no index is valid anyway.
        self.numbers(count, scalar, what, &mut |v| list.push(v as i64))?;
        Ok(list)
    }

    /// The next line that holds something, split into words, with its number.
    fn keyword(&mut self) -> Option<(usize, &'a [u8])> {
        loop {
            let number = self.text.line();
            let line = self.text.next_line()?;
            if !line.is_empty() {
                return Some((number, line));
            }
        }
    }
}

pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<Soup, MeshFileError> {
    let mut text = Words::new(path, bytes);
    text.next_line();
    text.next_line();
    let number = text.line();
    let encoding = text.next_line().unwrap_or_default();
    let binary = match encoding.to_ascii_uppercase().as_slice() {
        b"ASCII" => false,
        b"BINARY" => true,
        _ => return Err(text.expected_at(number, "`ASCII` or `BINARY`", encoding)),
    };
    let mut soup = Soup::new(if binary { MeshFormat::VtkBinary } else { MeshFormat::VtkAscii });
    let mut reader = Reader { text, binary };
    let mut cells: Vec<(Kind, Cells)> = Vec::new();
    let mut grid: Option<Cells> = None;
    let mut types: Vec<i64> = Vec::new();
    let mut dataset = false;
    while let Some((number, line)) = reader.keyword() {
        let split: Vec<&[u8]> = words(line).collect();
        let key = split.first().map(|k| k.to_ascii_uppercase()).unwrap_or_default();
        let argument = |i: usize| split.get(i).copied().and_then(parsed::<usize>);
        let two = || argument(1).zip(argument(2));
        let wrong = |reader: &Reader<'_>, expected: &str| reader.text.expected_at(number, expected, line);
        match key.as_slice() {
            b"DATASET" => {
                let kind = split.get(1).map(|k| k.to_ascii_uppercase()).unwrap_or_default();
                if kind != b"POLYDATA" && kind != b"UNSTRUCTURED_GRID" {
                    let expected =
                        "`DATASET POLYDATA` or `UNSTRUCTURED_GRID`: a surface (in ParaView: Extract Surface)";
                    return Err(wrong(&reader, expected));
                }
                dataset = true;
            }
            _ if !dataset && key != b"FIELD" && key != b"METADATA" => {
                return Err(wrong(&reader, "`DATASET POLYDATA` or `DATASET UNSTRUCTURED_GRID`"));
            }
            b"POINTS" => {
                let scalar = split.get(2).copied().and_then(Scalar::of);
                let (count, scalar) = argument(1)
                    .zip(scalar)
                    .ok_or_else(|| wrong(&reader, "`POINTS`, a count and a type (float, double, ...)"))?;
                places(&mut reader, count, scalar, &mut soup)?;
            }
            b"POLYGONS" | b"TRIANGLE_STRIPS" | b"LINES" | b"VERTICES" | b"CELLS" => {
                let (first, second) =
                    two().ok_or_else(|| wrong(&reader, "the keyword and two counts, as `POLYGONS 12 48`"))?;
                let read = read_cells(&mut reader, &key, first, second)?;
                match key.as_slice() {
                    b"POLYGONS" => cells.push((Kind::Polygon, read)),
                    b"TRIANGLE_STRIPS" => cells.push((Kind::Strip, read)),
                    b"CELLS" => grid = Some(read),
                    b"LINES" => soup.leave_out(read.len(), "lines"),
                    _ => soup.leave_out(read.len(), "vertices of no face"),
                }
            }
            b"CELL_TYPES" => {
                let count = argument(1).ok_or_else(|| wrong(&reader, "`CELL_TYPES` and a count"))?;
                types = reader.list(count, Scalar { bytes: 4, float: false, signed: true }, "CELL_TYPES")?;
            }
            b"FIELD" => {
                let count =
                    argument(2).ok_or_else(|| wrong(&reader, "`FIELD`, a name and a count of arrays"))?;
                (0..count).try_for_each(|_| pass_array(&mut reader))?;
            }
            // Until an empty line.
            b"METADATA" => while reader.text.next_line().is_some_and(|line| !line.is_empty()) {},
            b"POINT_DATA" | b"CELL_DATA" => break,
            _ => {
                return Err(wrong(
                    &reader,
                    "`POINTS`, `POLYGONS`, `TRIANGLE_STRIPS`, `CELLS` or `POINT_DATA`",
                ));
            }
        }
    }
    if let Some(grid) = grid {
        if types.len() != grid.len() {
            let what =
                format!("it has {} cells and {} types of them; export it again", grid.len(), types.len());
            return Err(reader.text.refused(what));
        }
        grid.add_each(0, |i| Kind::of(types[i]), &mut soup).map_err(|what| reader.text.refused(what))?;
    }
    for (kind, cells) in cells {
        cells.add_each(0, |_| kind, &mut soup).map_err(|what| reader.text.refused(what))?;
    }
    Ok(soup)
}

fn places(
    reader: &mut Reader<'_>,
    count: usize,
    scalar: Scalar,
    soup: &mut Soup,
) -> Result<(), MeshFileError> {
    let numbers = count.checked_mul(3).ok_or_else(|| reader.text.cut(format!("it claims {count} points")))?;
    let most = reader.text.rest().len() / if reader.binary { scalar.bytes } else { 2 } / 3 + 1;
    soup.points = Vec::with_capacity(count.min(most));
    let mut place = [0.0; 3];
    let mut axis = 0;
    reader.numbers(numbers, scalar, "POINTS", &mut |v| {
        place[axis] = v;
        axis = (axis + 1) % 3;
        if axis == 0 {
            soup.points.push(Point3::from(place));
        }
    })
}

fn read_cells(
    reader: &mut Reader<'_>,
    key: &[u8],
    first: usize,
    second: usize,
) -> Result<Cells, MeshFileError> {
    let what = String::from_utf8_lossy(key);
    let int = Scalar { bytes: 4, float: false, signed: true };
    if reader.text.peek().eq_ignore_ascii_case(b"OFFSETS") {
        let mut part = |word: &str, count: usize| {
            let (number, line) = reader.keyword().unwrap_or((reader.text.line(), b""));
            let mut split = words(line);
            let scalar = split
                .next()
                .filter(|w| w.eq_ignore_ascii_case(word.as_bytes()))
                .and_then(|_| split.next().and_then(Scalar::of))
                .ok_or_else(|| {
                    reader.text.expected_at(number, format!("`{word}` and a type, as vtktypeint64"), line)
                })?;
            reader.list(count, scalar, &format!("{word} of {what}"))
        };
        let offsets = part("OFFSETS", first)?;
        let corners = part("CONNECTIVITY", second)?;
        return Cells::from_offsets(offsets, corners)
            .map_err(|e| reader.text.refused(format!("{what}: {e}")));
    }
    let list = reader.list(second, int, &what)?;
    Cells::from_counts(first, &list).map_err(|e| reader.text.refused(format!("{what}: {e}")))
}

/// Passes over an array of a field: a name, components, tuples, a type, and the numbers.
fn pass_array(reader: &mut Reader<'_>) -> Result<(), MeshFileError> {
    let (number, line) = loop {
        let (number, line) = reader.keyword().unwrap_or((reader.text.line(), b""));
        if !line.eq_ignore_ascii_case(b"METADATA") {
            break (number, line);
        }
        // Remarks on the array before, until an empty line.
        while reader.text.next_line().is_some_and(|line| !line.is_empty()) {}
    };
    let split: Vec<&[u8]> = words(line).collect();
    let read = match split[..] {
        [_, components, tuples, kind] => parsed::<usize>(components)
            .zip(parsed::<usize>(tuples))
            .and_then(|(c, t)| c.checked_mul(t))
            .zip(Scalar::of(kind)),
        _ => None,
    };
    let expected = "an array of numbers: name, components, tuples and type; write it without field data";
    let (count, scalar) = read.ok_or_else(|| reader.text.expected_at(number, expected, line))?;
    reader.numbers(count, scalar, "a field", &mut |_| {})
}
