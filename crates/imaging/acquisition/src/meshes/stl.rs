//! STL to triangles. Binary: 80 bytes of anything, a count, then 50 bytes a triangle (normal, three corners, two bytes).
//! Ascii: `solid`, `facet normal`, `outer loop`, three times `vertex x y z`, `endloop`, `endfacet`, ..., `endsolid`.
//!
//! A binary file may start with the word `solid`, so the count against the file's length decides before that word does.
//! Corners at the very same place become one vertex while they are read.

use std::path::Path;

use biplane_geometry::Point3;

use super::soup::Soup;
use super::weld::Welder;
use super::words::{parsed, quoted, words};
use super::{MeshFileError, MeshFormat};

/// Whether a file that starts like this and has this length may be STL.
pub(super) fn is_stl(start: &[u8], length: u64) -> bool {
    starts_ascii(start) || count(start).is_some_and(|n| n > 0 && binary_length(n) == length)
}

fn starts_ascii(start: &[u8]) -> bool {
    let start = start.trim_ascii_start();
    let head = &start[..start.len().min(1000)];
    let has = |word: &[u8]| head.windows(word.len()).any(|w| w.eq_ignore_ascii_case(word));
    start.len() >= 5
        && start[..5].eq_ignore_ascii_case(b"solid")
        && (has(b"facet") || has(b"endsolid"))
        && !head.contains(&0)
}

fn count(bytes: &[u8]) -> Option<u32> {
    let word = bytes.get(80..84)?;
    Some(u32::from_le_bytes([word[0], word[1], word[2], word[3]]))
}

fn binary_length(triangles: u32) -> u64 {
    84 + 50 * u64::from(triangles)
}

pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<Soup, MeshFileError> {
    let length = bytes.len() as u64;
    let claimed = count(bytes);
    if claimed.is_some_and(|n| binary_length(n) == length) {
        return Ok(binary(bytes, claimed.unwrap_or(0)));
    }
    if starts_ascii(bytes) {
        return ascii(path, bytes);
    }
    match claimed {
        None => Err(MeshFileError::NotStl {
            path: path.to_owned(),
            what: format!("it has {length} bytes and does not start like an ascii one (`solid` ... `facet`)"),
        }),
        // Some programs leave a few bytes behind the triangles; another kind of file gives a count of any size.
        Some(n) if n > 0 && binary_length(n) < length && length - binary_length(n) <= 50 + length / 100 => {
            Ok(binary(bytes, n))
        }
        Some(n) if binary_length(n) > length && is_likely_cut(bytes, n) => Err(MeshFileError::Truncated {
            path: path.to_owned(),
            claimed: n,
            expected: binary_length(n),
            length,
        }),
        Some(n) => Err(MeshFileError::NotStl {
            path: path.to_owned(),
            what: format!(
                "as a binary one it would hold {n} triangles in {} bytes, but it has {length}; and it does not start like \
                 an ascii one (`solid` ... `facet`)",
                binary_length(n)
            ),
        }),
    }
}

/// Whether the first triangle of a file that is too short looks like one: its normal is a unit vector, or zero.
fn is_likely_cut(bytes: &[u8], claimed: u32) -> bool {
    let Some(normal) = bytes.get(84..96) else { return claimed < 1 << 26 };
    let n: f32 = (0..3).map(|i| float(normal, 4 * i)).map(|v| v * v).sum();
    n == 0.0 || (n - 1.0).abs() < 0.1
}

fn float(bytes: &[u8], at: usize) -> f32 {
    f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]])
}

/// `bytes` holds at least `count` triangles.
fn binary(bytes: &[u8], count: u32) -> Soup {
    let mut soup = Soup::new(MeshFormat::StlBinary);
    let mut welder = Welder::new(count as usize / 2 + 3);
    let triangles = bytes.get(84..).unwrap_or_default().chunks_exact(50).take(count as usize);
    soup.triangles.reserve_exact(count as usize);
    for t in triangles {
        soup.triangle(
            [12, 24, 36].map(|at| welder.add(Point3::from([0, 4, 8].map(|c| f64::from(float(t, at + c)))))),
        );
    }
    soup.points = welder.finish();
    soup.trailing_bytes = bytes.len() as u64 - binary_length(count);
    soup
}

fn ascii(path: &Path, bytes: &[u8]) -> Result<Soup, MeshFileError> {
    let mut soup = Soup::new(MeshFormat::StlAscii);
    let mut welder = Welder::new(bytes.len() / 500);
    let mut corners: Vec<Point3> = Vec::with_capacity(3);
    let (mut in_solid, mut in_facet, mut last) = (false, false, 0);
    // The name of a solid may be in any encoding.
    for (i, line) in bytes.split(|b| *b == b'\n').enumerate() {
        let error = |expected: &str| MeshFileError::Line {
            path: path.to_owned(),
            line: i + 1,
            expected: expected.to_owned(),
            found: quoted(line),
        };
        let mut split = words(line);
        let Some(keyword) = split.next() else { continue };
        last = i + 1;
        // None of its words is longer.
        let mut lower = [0; 9];
        let short = keyword.len().min(lower.len());
        lower[..short].copy_from_slice(&keyword[..short]);
        lower.make_ascii_lowercase();
        match &lower[..short] {
            b"solid" if !in_facet => in_solid = true,
            b"facet" if in_solid && !in_facet => {
                in_facet = true;
                corners.clear();
            }
            b"outer" if in_facet => {}
            b"vertex" if in_facet => {
                let mut values = [0.0; 3];
                for value in &mut values {
                    *value =
                        split.next().and_then(parsed).ok_or_else(|| error("`vertex` and three numbers"))?;
                }
                if corners.len() == 3 {
                    return Err(error("`endloop` after three corners: only triangles are read"));
                }
                corners.push(Point3::from(values));
            }
            b"endloop" if in_facet => {
                let [a, b, c] = corners[..] else {
                    return Err(error("three lines `vertex x y z` before `endloop`"));
                };
                soup.triangle([a, b, c].map(|corner| welder.add(corner)));
            }
            b"endfacet" if in_facet => in_facet = false,
            b"endsolid" if in_solid && !in_facet => in_solid = false,
            _ if in_facet => return Err(error("`outer loop`, `vertex`, `endloop` or `endfacet`")),
            _ => return Err(error("`facet`, `endsolid` or `solid`")),
        }
    }
    if in_solid {
        return Err(MeshFileError::Line {
            path: path.to_owned(),
            line: last + 1,
            expected: if in_facet { "`endfacet`" } else { "`endsolid`" }.to_owned(),
            found: "the end of the file; it is cut short".to_owned(),
        });
    }
    soup.points = welder.finish();
    Ok(soup)
}
