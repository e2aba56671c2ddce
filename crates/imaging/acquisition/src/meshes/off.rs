//! OFF (Geomview's Object File Format, text) to triangles: a line `OFF`, counts of vertices, faces and edges, a line a vertex, a line a
//! face (how many corners, then these, counted from 0).
//!
//! The letters before the word are read past: `C` colours, `N` normals and `ST` texture stand behind the place, as a face's colour
//! behind its corners. Four or `n` coordinates and the binary form are refused.

use std::path::Path;

use biplane_geometry::Point3;

use super::soup::{MOST_CORNERS, Soup};
use super::words::{Words, parsed, place, words};
use super::{MeshFileError, MeshFormat};

/// The first word of the file, if that is OFF with any letters before it.
fn keyword(start: &[u8]) -> Option<&[u8]> {
    let start = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start);
    let mut lines = start.split(|b| matches!(b, b'\n' | b'\r')).map(<[u8]>::trim_ascii);
    let first = lines.find(|l| !l.is_empty() && !l.starts_with(b"#"))?;
    let word = words(first).next()?;
    let letters = word.strip_suffix(b"OFF")?;
    [&b""[..], b"C", b"N", b"CN", b"ST", b"STC", b"STN", b"STCN", b"4", b"n", b"4n"]
        .contains(&letters)
        .then_some(word)
}

pub(super) fn starts(start: &[u8]) -> bool {
    keyword(start).is_some()
}

pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<Soup, MeshFileError> {
    let mut soup = Soup::new(MeshFormat::Off);
    let mut text = Words::new(path, bytes);
    let word = keyword(bytes).unwrap_or_default();
    if word.contains(&b'4') || word.contains(&b'n') {
        return Err(text.refused(format!(
            "its points have other than three coordinates (`{}`); export it as `OFF`",
            String::from_utf8_lossy(word)
        )));
    }
    let first = text.next_full_line().map_or(&b""[..], |(_, line)| line);
    let behind = first.get(word.len()..).unwrap_or_default().trim_ascii();
    if behind.starts_with(b"BINARY") {
        return Err(text.refused("binary OFF is not read; export it as text, or as PLY"));
    }
    let counts_of = |line: &[u8]| {
        let mut split = words(line);
        let vertices: usize = split.next().and_then(parsed)?;
        Some([vertices, split.next().and_then(parsed)?])
    };
    let expected = "how many vertices, faces and edges there are";
    let counts = if behind.is_empty() {
        let (number, line) = text.next_full_line().unwrap_or((text.line(), b""));
        counts_of(line).ok_or_else(|| text.expected_at(number, expected, line))
    } else {
        counts_of(behind).ok_or_else(|| text.expected(expected, behind))
    };
    let [vertices, faces] = counts?;
    // The shortest line of a vertex is `0 0 0` and its end.
    soup.points.reserve_exact(vertices.min(text.rest().len() / 6 + 1));
    for at in 0..vertices {
        let (number, line) = text.next_full_line().unwrap_or((text.line(), b""));
        let expected = || format!("three coordinates of vertex {at} (counted from 0) of {vertices}");
        let place = place(line).ok_or_else(|| text.expected_at(number, expected(), line))?;
        soup.points.push(Point3::from(place));
    }
    let mut corners: Vec<u32> = Vec::new();
    for at in 0..faces {
        let (number, line) = text.next_full_line().unwrap_or((text.line(), b""));
        let wrong = || {
            let expected = format!(
                "face {at} (counted from 0) of {faces}: how many corners (at most {MOST_CORNERS}), and these, each from 0 to {}",
                vertices.saturating_sub(1)
            );
            text.expected_at(number, expected, line)
        };
        let mut split = words(line);
        let count =
            split.next().and_then(parsed::<usize>).filter(|n| *n <= MOST_CORNERS).ok_or_else(wrong)?;
        corners.clear();
        for _ in 0..count {
            let corner = split.next().and_then(parsed::<u32>).filter(|c| (*c as usize) < vertices);
            corners.push(corner.ok_or_else(wrong)?);
        }
        soup.polygon(&corners);
    }
    let mut rest = 0;
    while text.next_full_line().is_some() {
        rest += 1;
    }
    soup.leave_out(rest, "lines after the last face");
    Ok(soup)
}
