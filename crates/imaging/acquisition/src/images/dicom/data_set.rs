//! A walk over a DICOM file (part 10 of the standard; the data set's encoding is part 5) that takes up what describes the
//! pixels and where they are in the patient, and steps over everything else without looking into it.
//!
//! An own reader, since the crates' one keeps every element in memory, takes memory for the length that an element
//! claims before it looks whether the file is as long, and calls itself for every sequence within a sequence. This one
//! takes memory for known elements within the file only, and counts how deep it is.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read};

use dicom_dictionary_std::tags;
use dicom_object::Tag;

use super::{ADVICE, ImageError, Place};

/// The elements that are taken up.
const KEPT: [Tag; 20] = [
    tags::SAMPLES_PER_PIXEL,
    tags::PHOTOMETRIC_INTERPRETATION,
    tags::NUMBER_OF_FRAMES,
    tags::ROWS,
    tags::COLUMNS,
    tags::BITS_ALLOCATED,
    tags::BITS_STORED,
    tags::HIGH_BIT,
    tags::PIXEL_REPRESENTATION,
    tags::RESCALE_SLOPE,
    tags::FRAME_TIME,
    tags::FRAME_TIME_VECTOR,
    tags::CINE_RATE,
    tags::RECOMMENDED_DISPLAY_FRAME_RATE,
    tags::RESCALE_INTERCEPT,
    tags::PIXEL_SPACING,
    tags::IMAGE_POSITION_PATIENT,
    tags::IMAGE_ORIENTATION_PATIENT,
    tags::ECHO_NUMBERS,
    // Compared, never shown.
    tags::SERIES_INSTANCE_UID,
];
/// Bytes such an element may have: the times of a million frames.
const MAX_VALUE: u64 = 16 << 20;
/// The length of what ends with a delimiter.
const UNDEFINED: u32 = u32::MAX;
const IMPLICIT_LITTLE: &str = "1.2.840.10008.1.2";
const EXPLICIT_BIG: &str = "1.2.840.10008.1.2.2";
/// Compresses the whole data set; and GE's mixture of byte orders.
const NOT_READ: [&str; 2] = ["1.2.840.10008.1.2.1.99", "1.2.840.113619.5.2"];
const ITEM: Tag = Tag(0xfffe, 0xe000);
const ITEM_END: Tag = Tag(0xfffe, 0xe00d);
const SEQUENCE_END: Tag = Tag(0xfffe, 0xe0dd);

/// Where the pixels are in the file.
pub(super) enum Pixels {
    /// Nowhere.
    Missing,
    /// As they are, all frames one after the other.
    Native { offset: u64, length: u64, words: bool },
    /// Compressed: offset and length of each item; the first is the table of offsets.
    Encapsulated { items: Vec<(u64, u64)> },
}

/// What a file says of its pixels.
pub(super) struct DataSet {
    /// The transfer syntax: digits and dots.
    pub(super) syntax: String,
    pub(super) big_endian: bool,
    pub(super) pixels: Pixels,
    kept: BTreeMap<Tag, Vec<u8>>,
}

impl DataSet {
    /// An element of 16-bit numbers: the first of them.
    pub(super) fn unsigned(&self, tag: Tag) -> Option<u32> {
        let bytes = self.kept.get(&tag)?.get(..2)?;
        let bytes = [bytes[0], bytes[1]];
        Some(if self.big_endian { u16::from_be_bytes(bytes) } else { u16::from_le_bytes(bytes) }.into())
    }

    /// Whether an element is there.
    pub(super) fn has(&self, tag: Tag) -> bool {
        self.kept.contains_key(&tag)
    }

    /// An element of numbers written as text.
    pub(super) fn decimals(&self, tag: Tag) -> Option<Vec<f64>> {
        let text = std::str::from_utf8(self.kept.get(&tag)?).ok()?;
        text.split('\\').map(|t| t.trim_matches([' ', '\0']).parse().ok()).collect()
    }

    /// An element of one word.
    pub(super) fn word(&self, tag: Tag) -> Option<&str> {
        Some(std::str::from_utf8(self.kept.get(&tag)?).ok()?.trim_matches([' ', '\0']))
    }
}

struct Header {
    tag: Tag,
    length: u32,
    /// `None` where the encoding has none.
    vr: Option<[u8; 2]>,
}

struct Walk<'a> {
    place: Place<'a>,
    file: BufReader<File>,
    at: u64,
    end: u64,
}

/// Walks the file up to its pixels; `length` is the file's.
pub(super) fn walk(place: Place<'_>, length: u64) -> Result<DataSet, ImageError> {
    let file = File::open(place.path).map_err(|e| place.io(e))?;
    let mut walk = Walk { place, file: BufReader::new(file), at: 0, end: length };
    walk.skip(132)?;
    let syntax = walk.meta()?;
    if NOT_READ.contains(&syntax.as_str()) {
        return Err(place.unsupported(format!("DICOM of the transfer syntax {syntax}"), ADVICE));
    }
    let big_endian = syntax == EXPLICIT_BIG;
    let explicit = syntax != IMPLICIT_LITTLE;
    let mut kept = BTreeMap::new();
    // How many sequences and items without a length are open, and within how many of them no VR is written.
    let (mut depth, mut implicit_below) = (0_u64, None);
    while walk.at < walk.end {
        let Header { tag, length, vr } = walk.header(explicit && implicit_below.is_none(), big_endian)?;
        if tag == ITEM_END || tag == SEQUENCE_END {
            depth = depth.checked_sub(1).ok_or_else(|| walk.malformed())?;
            if implicit_below.is_some_and(|d| depth <= d) {
                implicit_below = None;
            }
        } else if depth > 0 || (tag != tags::PIXEL_DATA && length == UNDEFINED) {
            if length != UNDEFINED {
                walk.skip(length.into())?;
                continue;
            }
            // A sequence whose VR is unknown is written without VRs (part 5, 6.2.2).
            if vr == Some(*b"UN") && implicit_below.is_none() {
                implicit_below = Some(depth);
            }
            depth += 1;
        } else if tag == tags::PIXEL_DATA {
            let pixels = if length == UNDEFINED {
                Pixels::Encapsulated { items: walk.items(big_endian)? }
            } else {
                let held = u64::from(length).min(walk.end - walk.at);
                Pixels::Native { offset: walk.at, length: held, words: vr != Some(*b"OB") }
            };
            return Ok(DataSet { syntax, big_endian, pixels, kept });
        } else if KEPT.contains(&tag) {
            kept.insert(tag, walk.value(length.into())?);
        } else {
            walk.skip(length.into())?;
        }
    }
    Ok(DataSet { syntax, big_endian, pixels: Pixels::Missing, kept })
}

impl Walk<'_> {
    fn malformed(&self) -> ImageError {
        self.place.damaged(format!(
            "its DICOM data set cannot be followed beyond byte {} of {}: cut short, or not well formed",
            self.at, self.end
        ))
    }

    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], ImageError> {
        if self.end - self.at < N as u64 {
            return Err(self.malformed());
        }
        let mut bytes = [0; N];
        self.file.read_exact(&mut bytes).map_err(|e| self.place.io(e))?;
        self.at += N as u64;
        Ok(bytes)
    }

    fn skip(&mut self, length: u64) -> Result<(), ImageError> {
        if self.end - self.at < length {
            return Err(self.malformed());
        }
        self.at += length;
        // Stays within the buffer where it can.
        self.file.seek_relative(length as i64).map_err(|e| self.place.io(e))
    }

    fn value(&mut self, length: u64) -> Result<Vec<u8>, ImageError> {
        if self.end - self.at < length || length > MAX_VALUE {
            return Err(self.malformed());
        }
        let mut bytes = vec![0; length as usize];
        self.file.read_exact(&mut bytes).map_err(|e| self.place.io(e))?;
        self.at += length;
        Ok(bytes)
    }

    fn header(&mut self, explicit: bool, big_endian: bool) -> Result<Header, ImageError> {
        let short = |b: [u8; 2]| if big_endian { u16::from_be_bytes(b) } else { u16::from_le_bytes(b) };
        let long = |b: [u8; 4]| if big_endian { u32::from_be_bytes(b) } else { u32::from_le_bytes(b) };
        let [a, b, c, d] = self.bytes()?;
        let tag = Tag(short([a, b]), short([c, d]));
        if tag.0 == 0xfffe || !explicit {
            return Ok(Header { tag, length: long(self.bytes()?), vr: None });
        }
        let vr = self.bytes::<2>()?;
        if !vr.iter().all(u8::is_ascii_uppercase) {
            return Err(self.malformed());
        }
        const LONG: [&[u8; 2]; 13] =
            [b"OB", b"OD", b"OF", b"OL", b"OV", b"OW", b"SQ", b"SV", b"UC", b"UN", b"UR", b"UT", b"UV"];
        let length = if LONG.contains(&&vr) {
            self.bytes::<2>()?;
            long(self.bytes()?)
        } else {
            short(self.bytes()?).into()
        };
        Ok(Header { tag, length, vr: Some(vr) })
    }

    /// The group of the file's own description, explicit little endian whatever follows; gives the transfer syntax.
    fn meta(&mut self) -> Result<String, ImageError> {
        let mut syntax = None;
        while self.end - self.at >= 8 {
            let group = self.bytes::<2>()?;
            self.at -= 2;
            self.file.seek_relative(-2).map_err(|e| self.place.io(e))?;
            if group != [2, 0] {
                break;
            }
            let Header { tag, length, .. } = self.header(true, false)?;
            if tag == tags::TRANSFER_SYNTAX_UID && length <= 64 {
                let value = self.value(length.into())?;
                let text: String =
                    value.iter().map(|b| char::from(*b)).filter(|c| *c != '\0' && *c != ' ').collect();
                if !text.chars().all(|c| c.is_ascii_digit() || c == '.') {
                    return Err(self.malformed());
                }
                syntax = Some(text);
            } else {
                self.skip(length.into())?;
            }
        }
        syntax.ok_or_else(|| {
            self.place.damaged("its DICOM header names no transfer syntax: not a DICOM file, or cut short")
        })
    }

    /// Offset and length of the items of compressed pixels.
    fn items(&mut self, big_endian: bool) -> Result<Vec<(u64, u64)>, ImageError> {
        let mut items = Vec::new();
        loop {
            // A file cut within a frame still has the frames before it.
            if self.end - self.at < 8 {
                return Ok(items);
            }
            let Header { tag, length, .. } = self.header(true, big_endian)?;
            match tag {
                SEQUENCE_END => return Ok(items),
                ITEM if u64::from(length) > self.end - self.at => return Ok(items),
                ITEM => {
                    items.push((self.at, length.into()));
                    self.skip(length.into())?;
                }
                _ => return Err(self.malformed()),
            }
        }
    }
}
