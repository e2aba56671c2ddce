//! The binary arrays of VTK's XML: base64, counts, zlib.

use std::io::Read;

use ::base64::Engine;
use ::base64::engine::general_purpose::STANDARD;
use flate2::bufread::ZlibDecoder;

/// How counts are written.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bytes {
    /// Most significant byte first.
    pub(super) big: bool,
    /// Bytes of a count: 4 or 8.
    pub(super) word: usize,
}

impl Bytes {
    /// Count `at` (counted from 0) of those that `bytes` begin with.
    fn count(self, bytes: &[u8], at: usize) -> Result<usize, String> {
        let word = at.checked_mul(self.word).and_then(|from| bytes.get(from..from.checked_add(self.word)?));
        let word = word.ok_or("the end; it is cut short")?;
        let fold = |n: u64, b: &u8| n << 8 | u64::from(*b);
        let n = if self.big { word.iter().fold(0, fold) } else { word.iter().rev().fold(0, fold) };
        usize::try_from(n).map_err(|_| format!("a count of {n}"))
    }

    /// The bytes behind their count.
    pub(super) fn counted(self, bytes: &[u8]) -> Result<&[u8], String> {
        let count = self.count(bytes, 0)?;
        let behind = bytes.get(self.word..).unwrap_or_default();
        behind
            .get(..count)
            .ok_or_else(|| format!("{count} claimed and {} there; it is cut short", behind.len()))
    }
}

/// Blocks of zlib behind their counts; more than `most` bytes are an error.
pub(super) fn unpacked(bytes: &[u8], order: Bytes, most: usize) -> Result<Vec<u8>, String> {
    let blocks = order.count(bytes, 0)?;
    let header = blocks.checked_add(3).and_then(|n| n.checked_mul(order.word)).filter(|n| *n <= bytes.len());
    let header =
        header.ok_or_else(|| format!("{blocks} blocks claimed, more than there can be; it is cut short"))?;
    let mut packed = bytes.get(header..).unwrap_or_default();
    let mut raw = Vec::new();
    for block in 0..blocks {
        let size = order.count(bytes, 3 + block)?;
        let there = packed.len();
        let (own, rest) = packed.split_at_checked(size).ok_or_else(|| {
            format!("{size} bytes claimed for block {block} and {there} there; it is cut short")
        })?;
        packed = rest;
        let room = (most - raw.len()) as u64 + 1;
        ZlibDecoder::new(own).take(room).read_to_end(&mut raw).map_err(|e| format!("block {block}: {e}"))?;
        if raw.len() > most {
            return Err(format!("more than {most} bytes when unpacked"));
        }
    }
    Ok(raw)
}

/// Decodes base64 with blanks in it, and with padding where one part ends and the next begins; stops at what is none.
pub(super) fn base64(text: &[u8]) -> Vec<u8> {
    let text: Vec<u8> = text.iter().copied().filter(|b| !b.is_ascii_whitespace()).collect();
    let mut decoded = Vec::with_capacity(text.len() / 4 * 3);
    let mut rest = &text[..];
    while !rest.is_empty() {
        // A part ends behind its padding.
        let end = rest
            .iter()
            .position(|b| *b == b'=')
            .map_or(rest.len(), |at| at.next_multiple_of(4).min(rest.len()));
        let end = if end == 0 { 4.min(rest.len()) } else { end };
        let (part, behind) = rest.split_at(end);
        match STANDARD.decode(part) {
            Ok(bytes) => decoded.extend(bytes),
            Err(_) => break,
        }
        rest = behind;
    }
    decoded
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_several_parts_is_joined() {
        assert_eq!(base64(b"AQ==Ag\n==\nAwQF AA=="), [1, 2, 3, 4, 5, 0]);
        assert_eq!(base64(b"AQID"), [1, 2, 3]);
        assert_eq!(base64(b"===="), [0; 0]);
        assert_eq!(base64(b""), [0; 0]);
        assert_eq!(base64(b"AQIDA"), [0; 0]);
    }

    #[test]
    fn claims_beyond_the_bytes_are_refused() {
        let order = Bytes { big: false, word: 8 };
        assert!(order.counted(&[0xff; 20]).unwrap_err().contains("claimed and 12 there"));
        assert!(unpacked(&[0xff; 40], order, 10).unwrap_err().contains("blocks claimed"));
        assert!(order.counted(&[1]).is_err());
    }
}
