//! Words and lines of a text that may turn into bytes: what the readers of PLY, OBJ, OFF and VTK walk along.
//!
//! It knows the line it is in, so that every message names one, and how many bytes are left, so that no count in a header
//! takes memory that the file could not fill. Lines end in LF, CRLF or CR.

use std::path::Path;

use super::MeshFileError;

/// A place in a file's bytes.
pub(super) struct Words<'a> {
    path: &'a Path,
    bytes: &'a [u8],
    at: usize,
    line: usize,
}

impl<'a> Words<'a> {
    /// At the beginning of a file, behind a byte order mark.
    pub(super) fn new(path: &'a Path, bytes: &'a [u8]) -> Self {
        let at = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Self { path, bytes, at, line: 1 }
    }

    /// The line it is in, counted from 1.
    pub(super) fn line(&self) -> usize {
        self.line
    }

    /// What comes next, to the end of the file.
    pub(super) fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.at..).unwrap_or_default()
    }

    /// The next `count` bytes, or none where the file ends before.
    pub(super) fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let taken = self.rest().get(..count)?;
        self.at += count;
        Some(taken)
    }

    /// The next line without its end and without blanks around it; none at the end of the file.
    pub(super) fn next_line(&mut self) -> Option<&'a [u8]> {
        let rest = self.rest();
        if rest.is_empty() {
            return None;
        }
        let end = rest.iter().position(|b| matches!(b, b'\n' | b'\r')).unwrap_or(rest.len());
        let (text, after) = rest.split_at(end);
        self.at += end + usize::from(!after.is_empty()) + usize::from(after.starts_with(b"\r\n"));
        self.line += usize::from(!after.is_empty());
        Some(text.trim_ascii())
    }

    /// The next line that holds something but a comment (`#`), and its number.
    pub(super) fn next_full_line(&mut self) -> Option<(usize, &'a [u8])> {
        loop {
            let number = self.line;
            let line = self.next_line()?;
            let end = line.iter().position(|b| *b == b'#').unwrap_or(line.len());
            let line = line.get(..end).unwrap_or_default().trim_ascii_end();
            if !line.is_empty() {
                return Some((number, line));
            }
        }
    }

    /// Passes over blanks and ends of lines.
    fn pass_blanks(&mut self) {
        while let Some(byte) = self.bytes.get(self.at)
            && byte.is_ascii_whitespace()
        {
            let next = self.bytes.get(self.at + 1);
            // CRLF is one end.
            self.line += usize::from(*byte == b'\n' || (*byte == b'\r' && next != Some(&b'\n')));
            self.at += 1;
        }
    }

    /// The next word, on whichever line; empty at the end of the file.
    pub(super) fn next(&mut self) -> &'a [u8] {
        self.pass_blanks();
        let rest = self.rest();
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.at += end;
        rest.get(..end).unwrap_or_default()
    }

    /// The next word, left where it is.
    pub(super) fn peek(&mut self) -> &'a [u8] {
        let (at, line) = (self.at, self.line);
        let word = self.next();
        (self.at, self.line) = (at, line);
        word
    }

    /// An error at the line it is in.
    pub(super) fn expected(&self, expected: impl Into<String>, found: &[u8]) -> MeshFileError {
        self.expected_at(self.line, expected, found)
    }

    /// An error at another line.
    pub(super) fn expected_at(
        &self,
        line: usize,
        expected: impl Into<String>,
        found: &[u8],
    ) -> MeshFileError {
        let at_end = found.is_empty() && self.rest().is_empty();
        let found = if at_end { "the end of the file; it is cut short".to_owned() } else { quoted(found) };
        MeshFileError::Line { path: self.path.to_owned(), line, expected: expected.into(), found }
    }

    /// An error of bytes that end too early.
    pub(super) fn cut(&self, what: impl Into<String>) -> MeshFileError {
        MeshFileError::Cut { path: self.path.to_owned(), what: what.into() }
    }

    /// An error of the file as a whole.
    pub(super) fn refused(&self, what: impl Into<String>) -> MeshFileError {
        MeshFileError::Refused { path: self.path.to_owned(), what: what.into() }
    }
}

/// The words of a line.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty())
}

/// A word as a number.
pub(super) fn parsed<T: std::str::FromStr>(word: &[u8]) -> Option<T> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// The first three words of a line as a place.
pub(super) fn place(line: &[u8]) -> Option<[f64; 3]> {
    let mut words = words(line);
    let mut next = || words.next().and_then(parsed);
    Some([next()?, next()?, next()?])
}

/// Something as a message can show it.
pub(super) fn quoted(found: &[u8]) -> String {
    let text = String::from_utf8_lossy(found.get(..found.len().min(200)).unwrap_or_default());
    let short: String = text.trim().chars().take(60).map(|c| if c.is_control() { '.' } else { c }).collect();
    if short.is_empty() { "nothing".to_owned() } else { format!("`{short}`") }
}
