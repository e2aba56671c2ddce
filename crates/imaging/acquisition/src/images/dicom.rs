//! DICOM, one frame or many, as X-ray angiography (XA), fluoroscopy (RF) and MR objects hold them.
//!
//! The data set is walked by an own reader ([`data_set`]), which takes up only the elements that describe the pixels and
//! steps over all others, so a patient's name is never even read; the DICOM crates decode compressed frames. Only
//! numbers, one of a few known words or a transfer syntax (digits and dots) ever reach a message.
//!
//! **Levels.** A frame's levels span what `BitsStored` can hold. Signed samples are shifted up by half of that range.
//! `MONOCHROME1` is turned round, and so is a negative rescale slope. The size of slope and intercept has no further
//! effect: rescaling is linear and the same for every pixel, so stretching its result over the frame's levels gives back
//! the stored ones. Window and level, which only say how to show a picture, are not applied.
//!
//! **Times** come from `FrameTimeVector`, else `FrameTime`, else `CineRate`, else `RecommendedDisplayFrameRate`.

mod data_set;
pub(crate) mod slice;

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use biplane_artifact::Frame;
use dicom_core::value::PixelFragmentSequence;
use dicom_core::{DataElement, PrimitiveValue, VR};
use dicom_dictionary_std::tags;
use dicom_object::{FileMetaTableBuilder, InMemDicomObject};
use dicom_pixeldata::PixelDecoder;

use self::data_set::{DataSet, Pixels};
use super::{ImageError, ImageFormat, ImageInfo, Place, quietly};

const ADVICE: &str = "export the run as uncompressed DICOM, or as 8- or 16-bit grey TIFF or PNG";

/// How the pixels of one file are stored.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Layout {
    width: usize,
    height: usize,
    frames: usize,
    allocated: u32,
    stored: u32,
    high_bit: u32,
    signed: bool,
    inverted: bool,
}

pub(super) struct Frames {
    layout: Layout,
    data: DataSet,
    length: u64,
}

pub(super) fn open(path: &Path, length: u64) -> Result<(ImageInfo, Frames), ImageError> {
    let place = Place { path, index: 0 };
    let data = data_set::walk(place, length)?;
    let layout = layout(place, &data, length)?;
    let (rate_hz, times_s) = times(&data, layout.frames);
    let info = ImageInfo {
        format: ImageFormat::Dicom,
        width: layout.width,
        height: layout.height,
        bits: layout.stored,
        frames: layout.frames,
        rate_hz,
        times_s,
    };
    Ok((info, Frames { layout, data, length }))
}

fn layout(place: Place<'_>, data: &DataSet, length: u64) -> Result<Layout, ImageError> {
    let need = |tag, name: &str| {
        data.unsigned(tag).ok_or_else(|| {
            place.damaged(format!(
                "its DICOM header has no {name} that is a number: not an image, or cut short"
            ))
        })
    };
    let (width, height) = (need(tags::COLUMNS, "Columns")?, need(tags::ROWS, "Rows")?);
    let allocated = need(tags::BITS_ALLOCATED, "BitsAllocated")?;
    let stored = data.unsigned(tags::BITS_STORED).unwrap_or(allocated);
    let high_bit = data.unsigned(tags::HIGH_BIT).unwrap_or(stored.saturating_sub(1));
    let frames = match data.decimals(tags::NUMBER_OF_FRAMES).as_deref() {
        None => 1,
        Some([n, ..]) if *n >= 1.0 && n.fract() == 0.0 => *n as u64,
        _ => return Err(place.damaged("its NumberOfFrames is not a number of frames")),
    };
    if data.unsigned(tags::SAMPLES_PER_PIXEL).unwrap_or(1) != 1 {
        return Err(place.unsupported("a DICOM colour picture", ADVICE));
    }
    if allocated != 8 && allocated != 16 {
        return Err(place.unsupported(format!("DICOM with {allocated} bits a pixel"), ADVICE));
    }
    if stored == 0 || stored > allocated || high_bit >= allocated || high_bit + 1 < stored {
        return Err(place.damaged(format!(
            "its DICOM header says {stored} bits stored of {allocated}, the highest being bit {high_bit}"
        )));
    }
    let inverted = match data.word(tags::PHOTOMETRIC_INTERPRETATION) {
        Some("MONOCHROME1") => true,
        Some("MONOCHROME2") => false,
        _ => {
            return Err(place.unsupported(
                "DICOM whose PhotometricInterpretation is neither MONOCHROME1 nor MONOCHROME2",
                ADVICE,
            ));
        }
    };
    let falling = data.decimals(tags::RESCALE_SLOPE).is_some_and(|s| s.first().is_some_and(|&s| s < 0.0));
    let bytes = u64::from(allocated / 8);
    place.check_size(width.into(), height.into(), bytes, length)?;
    let frame_bytes = u64::from(width) * u64::from(height) * bytes;
    match &data.pixels {
        Pixels::Missing => return Err(place.truncated(length)),
        Pixels::Native { length: held, .. } if frame_bytes.saturating_mul(frames) > *held => {
            let index = (held / frame_bytes) as usize;
            return Err(Place { index, ..place }.truncated(length));
        }
        Pixels::Native { .. } => {}
        // The first item is the table of offsets.
        Pixels::Encapsulated { items } if frames >= items.len() as u64 => {
            return Err(Place { index: items.len().saturating_sub(1), ..place }.truncated(length));
        }
        Pixels::Encapsulated { .. } => {}
    }
    Ok(Layout {
        width: width as usize,
        height: height as usize,
        frames: frames as usize,
        allocated,
        stored,
        high_bit,
        signed: data.unsigned(tags::PIXEL_REPRESENTATION) == Some(1),
        inverted: inverted != falling,
    })
}

/// Frames a second, and seconds of each frame after the first.
fn times(data: &DataSet, frames: usize) -> (Option<f64>, Vec<f64>) {
    let positive =
        |tag| data.decimals(tag).and_then(|v| v.first().copied()).filter(|v| *v > 0.0 && v.is_finite());
    let vector = data.decimals(tags::FRAME_TIME_VECTOR).filter(|v| {
        v.len() == frames && frames > 1 && v.iter().skip(1).all(|step| *step > 0.0 && step.is_finite())
    });
    if let Some(steps) = vector {
        let mut times = vec![0.0];
        let mut now = 0.0;
        for step in &steps[1..] {
            now += step / 1000.0;
            times.push(now);
        }
        return (Some((frames - 1) as f64 / now), times);
    }
    let rate = positive(tags::FRAME_TIME)
        .map(|ms| 1000.0 / ms)
        .or_else(|| positive(tags::CINE_RATE))
        .or_else(|| positive(tags::RECOMMENDED_DISPLAY_FRAME_RATE));
    (rate, rate.map_or_else(Vec::new, |rate| (0..frames).map(|i| i as f64 / rate).collect()))
}

impl Frames {
    pub(super) fn read(&self, path: &Path, index: usize) -> Result<Frame, ImageError> {
        let Layout { width, height, stored, .. } = self.layout;
        let samples = self.stored(path, index)?.into_iter().map(|s| self.layout.level(s)).collect();
        Ok(Frame { width, height, samples, bits: stored })
    }

    /// The samples of a frame with all of their bits.
    fn stored(&self, path: &Path, index: usize) -> Result<Vec<u16>, ImageError> {
        let place = Place { path, index };
        let Layout { width, height, allocated, .. } = self.layout;
        let mut file = File::open(path).map_err(|e| place.io(e))?;
        let mut raw: Vec<u16> = match &self.data.pixels {
            Pixels::Missing => return Err(place.truncated(self.length)),
            Pixels::Native { offset, length, words } => {
                let size = width * height * if allocated == 8 { 1 } else { 2 };
                let start = index as u64 * size as u64;
                // Of big-endian words that hold two samples each, the second byte is the first sample.
                let swapped = u64::from(self.data.big_endian && *words && allocated == 8);
                let (low, high) = (start & !swapped, (start + size as u64 + swapped) & !swapped);
                let bytes = self.bytes(place, &mut file, offset + low, high.min(*length) - low)?;
                if allocated == 8 {
                    (start - low..)
                        .take(size)
                        .map_while(|i| bytes.get((i ^ swapped) as usize))
                        .map(|b| (*b).into())
                        .collect()
                } else if self.data.big_endian {
                    bytes.chunks_exact(2).map(|b| u16::from_be_bytes([b[0], b[1]])).collect()
                } else {
                    bytes.chunks_exact(2).map(|b| u16::from_le_bytes([b[0], b[1]])).collect()
                }
            }
            Pixels::Encapsulated { items } => {
                let mut fragment = Vec::new();
                for (offset, length) in self.fragments(place, &mut file, items)? {
                    fragment.extend(self.bytes(place, &mut file, offset, length)?);
                }
                self.decode(place, fragment)?
            }
        };
        if raw.len() < width * height {
            return Err(place.truncated(self.length));
        }
        raw.truncate(width * height);
        Ok(raw)
    }

    /// Bytes of the file; that they are there was checked when it was walked.
    fn bytes(
        &self,
        place: Place<'_>,
        file: &mut File,
        offset: u64,
        length: u64,
    ) -> Result<Vec<u8>, ImageError> {
        file.seek(SeekFrom::Start(offset)).map_err(|e| place.io(e))?;
        let mut bytes = Vec::new();
        let read = file.take(length).read_to_end(&mut bytes).map_err(|e| place.io(e))?;
        if (read as u64) < length { Err(place.truncated(self.length)) } else { Ok(bytes) }
    }

    /// The pieces of one compressed frame: its own item, or by the table of offsets, or all of a single frame.
    fn fragments(
        &self,
        place: Place<'_>,
        file: &mut File,
        items: &[(u64, u64)],
    ) -> Result<Vec<(u64, u64)>, ImageError> {
        let frames = self.layout.frames;
        let (Some((table, pieces)), index) = (items.split_first(), place.index) else {
            return Err(place.truncated(self.length));
        };
        if pieces.len() == frames {
            return Ok(pieces[index..=index].to_vec());
        }
        if frames == 1 {
            return Ok(pieces.to_vec());
        }
        let offsets: Vec<u64> = if table.1 == 4 * frames as u64 {
            let bytes = self.bytes(place, file, table.0, table.1)?;
            bytes.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]).into()).collect()
        } else {
            return Err(place.unsupported(
                "DICOM whose compressed frames are cut to pieces without a table of them",
                ADVICE,
            ));
        };
        // Offsets count from the tag of the first piece, eight bytes before what is in it.
        let first = pieces[0].0;
        let end = offsets.get(index + 1).copied().unwrap_or(u64::MAX);
        let inside = |(offset, _): &&(u64, u64)| (offsets[index]..end).contains(&(offset - first));
        Ok(pieces.iter().filter(inside).copied().collect())
    }

    /// Decodes one compressed frame, through an object that holds nothing else.
    fn decode(&self, place: Place<'_>, fragment: Vec<u8>) -> Result<Vec<u16>, ImageError> {
        let Layout { width, height, allocated, stored, high_bit, signed, .. } = self.layout;
        if let Some(found) = jpeg_size(&fragment)
            && found != [width, height]
        {
            return Err(place.damaged(format!(
                "its header says {width} x {height} pixels, its JPEG {} x {}",
                found[0], found[1]
            )));
        }
        let mut object = InMemDicomObject::new_empty();
        let numbers = [
            (tags::SAMPLES_PER_PIXEL, 1),
            (tags::ROWS, height as u16),
            (tags::COLUMNS, width as u16),
            (tags::BITS_ALLOCATED, allocated as u16),
            (tags::BITS_STORED, stored as u16),
            (tags::HIGH_BIT, high_bit as u16),
            (tags::PIXEL_REPRESENTATION, signed.into()),
        ];
        for (tag, value) in numbers {
            object.put(DataElement::new(tag, VR::US, PrimitiveValue::from(value)));
        }
        object.put(DataElement::new(tags::NUMBER_OF_FRAMES, VR::IS, PrimitiveValue::from("1")));
        object.put(DataElement::new(
            tags::PHOTOMETRIC_INTERPRETATION,
            VR::CS,
            PrimitiveValue::from("MONOCHROME2"),
        ));
        let pixels = PixelFragmentSequence::new_fragments(vec![fragment]);
        object.put(DataElement::new(tags::PIXEL_DATA, VR::OB, pixels));
        let syntax = &self.data.syntax;
        let undecodable = || {
            place.unsupported(
                format!("DICOM whose pixels (transfer syntax {syntax}) cannot be decoded"),
                ADVICE,
            )
        };
        let meta = FileMetaTableBuilder::new()
            .transfer_syntax(syntax.as_str())
            .media_storage_sop_class_uid("1.2.840.10008.5.1.4.1.1.7")
            .media_storage_sop_instance_uid("2.25.1");
        let object = object.with_meta(meta).map_err(|_| undecodable())?;
        let decoded = quietly(|| object.decode_pixel_data_frame(0)).map_err(|_| undecodable())?;
        Ok(if allocated == 8 {
            decoded.data().iter().map(|&b| b.into()).collect()
        } else {
            decoded.data().chunks_exact(2).map(|b| u16::from_ne_bytes([b[0], b[1]])).collect()
        })
    }
}

/// Columns and rows that a JPEG says of itself; its decoder takes memory for as many.
fn jpeg_size(bytes: &[u8]) -> Option<[usize; 2]> {
    let mut at = 2;
    if bytes.get(..2)? != [0xff, 0xd8] {
        return None;
    }
    loop {
        let marker = bytes.get(at..at + 4)?;
        let length = usize::from(u16::from_be_bytes([marker[2], marker[3]]));
        match marker[..2] {
            [0xff, 0xff] => at += 1,
            // Start of frame; the three others of this range are tables and extensions.
            [0xff, kind @ 0xc0..=0xcf] if ![0xc4, 0xc8, 0xcc].contains(&kind) => {
                let size = bytes.get(at + 5..at + 9)?;
                let number = |i: usize| usize::from(u16::from_be_bytes([size[i], size[i + 1]]));
                return Some([number(2), number(0)]);
            }
            [0xff, _] => at += 2 + length,
            _ => return None,
        }
    }
}

impl Layout {
    /// The level of a stored sample: its stored bits alone, unsigned, larger brighter.
    fn level(&self, stored: u16) -> u16 {
        let largest = ((1_u32 << self.stored) - 1) as u16;
        let bits = (u32::from(stored) >> (self.high_bit + 1 - self.stored)) as u16 & largest;
        // Two's complement plus half of the range is the unsigned number with its highest bit turned round.
        let level = if self.signed { bits ^ (1 << (self.stored - 1)) } else { bits };
        if self.inverted { largest - level } else { level }
    }
}
