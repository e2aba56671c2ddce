//! Wavefront OBJ to triangles: `v x y z` and `f` with `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 1, or from the end if negative.
//!
//! Objects and groups are one mesh. What speaks of normals, textures, materials and smoothing is passed over; lines, points and free-form
//! surfaces are counted. A line that ends in `\` goes on in the next. Faces may name vertices that come later. A keyword that OBJ does not
//! have is an error: it is another kind of file, or damaged.

use std::borrow::Cow;
use std::path::Path;

use biplane_geometry::Point3;

use super::soup::{MOST_CORNERS, Soup};
use super::words::{Words, parsed, place, words};
use super::{MeshFileError, MeshFormat};

/// Passed over.
const OTHER: [&[u8]; 34] = [
    b"vt",
    b"vn",
    b"vp",
    b"o",
    b"g",
    b"s",
    b"mg",
    b"usemtl",
    b"usemap",
    b"mtllib",
    b"maplib",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"lod",
    b"shadow_obj",
    b"trace_obj",
    b"cstype",
    b"deg",
    b"bmat",
    b"step",
    b"parm",
    b"trim",
    b"hole",
    b"scrv",
    b"sp",
    b"end",
    b"con",
    b"call",
    b"csh",
    b"ctech",
    b"stech",
    b"curv",
    b"curv2",
];

/// Whether it begins with OBJ's keywords: of the lines that are no comments each has one, and one of them is a vertex or what
/// comes before vertices.
pub(super) fn starts(start: &[u8]) -> bool {
    let start = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start);
    if start.contains(&0) {
        return false;
    }
    // The last line may be cut off.
    let complete = start.len() < 4096;
    let mut lines: Vec<&[u8]> = start.split(|b| matches!(b, b'\n' | b'\r')).collect();
    if !complete && lines.len() > 1 {
        lines.pop();
    }
    let mut lines =
        lines.into_iter().map(<[u8]>::trim_ascii).filter(|l| !l.is_empty() && !l.starts_with(b"#"));
    let of_obj = |line: &[u8]| match words(line).next() {
        Some(b"v") => line.get(1..).and_then(place).is_some(),
        Some(b"mtllib" | b"o" | b"g" | b"vn" | b"vt" | b"usemtl") => true,
        _ => false,
    };
    match lines.next() {
        Some(first) => of_obj(first),
        // Nothing but a long comment of a modelling program.
        None => !complete && start.starts_with(b"#"),
    }
}

pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<Soup, MeshFileError> {
    let mut soup = Soup::new(MeshFormat::Obj);
    let mut text = Words::new(path, bytes);
    let mut corners: Vec<u32> = Vec::new();
    // Faces wait until all vertices are there: their line, and where their corners end.
    let mut faces: Vec<(usize, usize)> = Vec::new();
    while let Some((number, line)) = text.next_full_line() {
        let line = joined(&mut text, line);
        let mut split = words(&line);
        let keyword = split.next().unwrap_or_default();
        let wrong = |expected: &str| text.expected_at(number, expected, &line);
        match keyword {
            b"v" => {
                let place = line.get(1..).and_then(place).ok_or_else(|| wrong("`v` and three numbers"))?;
                soup.points.push(Point3::from(place));
            }
            b"f" | b"fo" => {
                let before = corners.len();
                for word in split {
                    let index = word.split(|b| *b == b'/').next().and_then(parsed::<i64>);
                    let count = soup.points.len() as i64;
                    // From the end, of the vertices so far.
                    let index = match index {
                        Some(i) if i > 0 => Some(i - 1),
                        Some(i) if i < 0 && i >= -count => Some(count + i),
                        _ => None,
                    };
                    let index = index.and_then(|i| u32::try_from(i).ok());
                    corners.push(index.ok_or_else(|| {
                        wrong(&format!(
                            "`f` and vertices counted from 1, or from -1 for the last of the {count} so far"
                        ))
                    })?);
                }
                if corners.len() - before < 3 {
                    return Err(wrong("`f` and three vertices or more"));
                }
                if corners.len() - before > MOST_CORNERS {
                    return Err(wrong(&format!("a polygon of at most {MOST_CORNERS} corners")));
                }
                faces.push((number, corners.len()));
            }
            b"l" => soup.leave_out(1, "lines"),
            b"p" => soup.leave_out(1, "points"),
            b"surf" => soup.leave_out(1, "free-form surfaces"),
            _ if OTHER.contains(&keyword) => {}
            _ => return Err(wrong("`v`, `f` or another keyword of OBJ")),
        }
    }
    let count = soup.points.len();
    let mut from = 0;
    for (number, to) in faces {
        let face = corners.get(from..to).unwrap_or_default();
        if let Some(beyond) = face.iter().find(|i| **i as usize >= count) {
            let found = format!("vertex {}", u64::from(*beyond) + 1);
            return Err(text.expected_at(
                number,
                format!("a face of the {count} vertices of the file"),
                found.as_bytes(),
            ));
        }
        soup.polygon(face);
        from = to;
    }
    Ok(soup)
}

/// A line with those that continue it.
fn joined<'a>(text: &mut Words<'a>, line: &'a [u8]) -> Cow<'a, [u8]> {
    let mut whole = Cow::Borrowed(line);
    while let Some(part) = whole.strip_suffix(b"\\") {
        let mut longer = part.to_vec();
        longer.push(b' ');
        let next = text.next_line();
        longer.extend_from_slice(next.unwrap_or_default());
        whole = Cow::Owned(longer);
    }
    whole
}
