//! DICOM, one frame or many, as X-ray angiography (XA), fluoroscopy (RF) and MR objects hold them.
//!
//! Of the data set only the elements named in [`KEPT`] stay in memory, and only numbers, one of a few known words or a
//! transfer syntax (digits and dots) ever reach a message: the errors of the DICOM crates, which may quote a header, are
//! not passed on.
//!
//! **Levels.** A frame's levels span what `BitsStored` can hold. Signed samples are shifted up by half of that range.
//! `MONOCHROME1` is turned round, and so is a negative rescale slope. The size of slope and intercept has no further
//! effect: rescaling is linear and the same for every pixel, so stretching its result over the frame's levels gives back
//! the stored ones. Window and level, which only say how to show a picture, are not applied.
//!
//! **Times** come from `FrameTimeVector`, else `FrameTime`, else `CineRate`, else `RecommendedDisplayFrameRate`.

use std::path::Path;

use biplane_artifact::Frame;
use dicom_dictionary_std::tags;
use dicom_object::{DefaultDicomObject, OpenFileOptions, Tag};
use dicom_pixeldata::PixelDecoder;

use super::{ImageError, ImageFormat, ImageInfo, Place, quietly};

/// The elements that describe pixels; all others are dropped as soon as a file is read.
const KEPT: [Tag; 18] = [
    tags::SAMPLES_PER_PIXEL,
    tags::PHOTOMETRIC_INTERPRETATION,
    tags::PLANAR_CONFIGURATION,
    tags::NUMBER_OF_FRAMES,
    tags::ROWS,
    tags::COLUMNS,
    tags::BITS_ALLOCATED,
    tags::BITS_STORED,
    tags::HIGH_BIT,
    tags::PIXEL_REPRESENTATION,
    tags::RESCALE_INTERCEPT,
    tags::RESCALE_SLOPE,
    tags::FRAME_TIME,
    tags::FRAME_TIME_VECTOR,
    tags::CINE_RATE,
    tags::RECOMMENDED_DISPLAY_FRAME_RATE,
    tags::PIXEL_DATA,
    tags::EXTENDED_OFFSET_TABLE,
];

/// Transfer syntaxes that store pixels as they are.
const NOT_COMPRESSED: [&str; 5] =
    ["1.2.840.10008.1.2", "1.2.840.10008.1.2.1", "1.2.840.10008.1.2.2", DEFLATED, "1.2.840.113619.5.2"];
/// The transfer syntax that compresses the whole data set, not the pixels.
const DEFLATED: &str = "1.2.840.10008.1.2.1.99";

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
    compressed: bool,
}

pub(super) struct Frames {
    layout: Layout,
    length: u64,
    /// With the pixel data, once a frame was asked for.
    object: Option<DefaultDicomObject>,
}

/// Reads a file, whole or up to its pixels, and drops what is not kept.
fn load(place: Place<'_>, whole: bool) -> Result<DefaultDicomObject, ImageError> {
    let options = OpenFileOptions::new();
    let options =
        if whole { options.read_to(tags::PIXEL_DATA) } else { options.read_until(tags::PIXEL_DATA) };
    let mut object = quietly(|| options.open_file(place.path)).map_err(|error| match error {
        dicom_object::ReadError::ReadFile { source, .. }
        | dicom_object::ReadError::OpenFile { source, .. } => place.io(source),
        dicom_object::ReadError::ReadUnrecognizedTransferSyntax { .. }
        | dicom_object::ReadError::ReadUnsupportedTransferSyntax { .. } => {
            place.unsupported("DICOM with a transfer syntax that is not known", ADVICE)
        }
        _ => place.damaged("its DICOM data set cannot be read to the pixels: cut short, or not well formed"),
    })?;
    let dropped: Vec<Tag> = object.iter().map(|e| e.header().tag).filter(|t| !KEPT.contains(t)).collect();
    for tag in dropped {
        object.remove_element(tag);
    }
    let meta = object.meta_mut();
    meta.media_storage_sop_instance_uid.clear();
    meta.source_application_entity_title = None;
    meta.sending_application_entity_title = None;
    meta.receiving_application_entity_title = None;
    meta.private_information_creator_uid = None;
    meta.private_information = None;
    Ok(object)
}

fn whole_number(object: &DefaultDicomObject, tag: Tag) -> Option<u32> {
    object.element_opt(tag).ok().flatten()?.to_int::<u32>().ok()
}

fn numbers(object: &DefaultDicomObject, tag: Tag) -> Option<Vec<f64>> {
    object.element_opt(tag).ok().flatten()?.to_multi_float64().ok()
}

/// The transfer syntax, as digits and dots.
fn syntax(object: &DefaultDicomObject) -> String {
    object.meta().transfer_syntax().chars().filter(|c| c.is_ascii_digit() || *c == '.').take(64).collect()
}

pub(super) fn open(path: &Path, length: u64) -> Result<(ImageInfo, Frames), ImageError> {
    let place = Place { path, index: 0 };
    let object = load(place, false)?;
    let layout = layout(place, &object, length)?;
    let (rate_hz, times_s) = times(&object, layout.frames);
    let info = ImageInfo {
        format: ImageFormat::Dicom,
        width: layout.width,
        height: layout.height,
        bits: layout.stored,
        frames: layout.frames,
        rate_hz,
        times_s,
    };
    Ok((info, Frames { layout, length, object: None }))
}

fn layout(place: Place<'_>, object: &DefaultDicomObject, length: u64) -> Result<Layout, ImageError> {
    let need = |tag, name: &str| {
        whole_number(object, tag).ok_or_else(|| {
            place.damaged(format!(
                "its DICOM header has no {name} that is a number: not an image, or cut short"
            ))
        })
    };
    let (width, height) = (need(tags::COLUMNS, "Columns")?, need(tags::ROWS, "Rows")?);
    let allocated = need(tags::BITS_ALLOCATED, "BitsAllocated")?;
    let stored = whole_number(object, tags::BITS_STORED).unwrap_or(allocated);
    let high_bit = whole_number(object, tags::HIGH_BIT).unwrap_or(stored.saturating_sub(1));
    let frames = whole_number(object, tags::NUMBER_OF_FRAMES).unwrap_or(1).max(1);
    if whole_number(object, tags::SAMPLES_PER_PIXEL).unwrap_or(1) != 1 {
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
    let photometric = object
        .element_opt(tags::PHOTOMETRIC_INTERPRETATION)
        .ok()
        .flatten()
        .and_then(|e| e.to_str().ok().map(|s| s.trim_matches([' ', '\0']).to_owned()));
    let inverted = match photometric.as_deref() {
        Some("MONOCHROME1") => true,
        Some("MONOCHROME2") => false,
        _ => {
            return Err(place.unsupported(
                "DICOM whose PhotometricInterpretation is neither MONOCHROME1 nor MONOCHROME2",
                ADVICE,
            ));
        }
    };
    let falling = numbers(object, tags::RESCALE_SLOPE).is_some_and(|s| s.first().is_some_and(|&s| s < 0.0));
    let compressed = !NOT_COMPRESSED.contains(&object.meta().transfer_syntax());
    let bytes = u64::from(allocated / 8);
    place.check_size(width.into(), height.into(), bytes, length)?;
    let deflated = object.meta().transfer_syntax() == DEFLATED;
    let frame_bytes = u64::from(width) * u64::from(height) * bytes;
    if !compressed && !deflated && frame_bytes.saturating_mul(frames.into()) > length {
        let index = (length / frame_bytes) as usize;
        return Err(Place { index, ..place }.truncated(length));
    }
    // An encapsulated frame has a header of 8 bytes at least.
    if u64::from(frames) > length {
        return Err(place.damaged(format!("it claims {frames} frames in {length} bytes")));
    }
    Ok(Layout {
        width: width as usize,
        height: height as usize,
        frames: frames as usize,
        allocated,
        stored,
        high_bit,
        signed: whole_number(object, tags::PIXEL_REPRESENTATION) == Some(1),
        inverted: inverted != falling,
        compressed,
    })
}

/// Frames a second, and seconds of each frame after the first.
fn times(object: &DefaultDicomObject, frames: usize) -> (Option<f64>, Vec<f64>) {
    let positive =
        |tag| numbers(object, tag).and_then(|v| v.first().copied()).filter(|v| *v > 0.0 && v.is_finite());
    let vector = numbers(object, tags::FRAME_TIME_VECTOR).filter(|v| {
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
    pub(super) fn read(&mut self, path: &Path, index: usize) -> Result<Frame, ImageError> {
        let place = Place { path, index };
        let object = match &mut self.object {
            Some(object) => object,
            none => none.insert(load(place, true)?),
        };
        let Layout { width, height, allocated, compressed, .. } = self.layout;
        let bytes = if allocated == 8 { 1 } else { 2 };
        let size = width * height * bytes;
        let raw = if compressed {
            let transfer_syntax = syntax(object);
            // The decoder's own message may quote the header.
            let decoded =
                quietly(|| object.decode_pixel_data_frame(u32::try_from(index).unwrap_or(u32::MAX)))
                    .map_err(|_| {
                        place.unsupported(
                            format!(
                                "DICOM whose pixels (transfer syntax {transfer_syntax}) cannot be decoded"
                            ),
                            ADVICE,
                        )
                    })?;
            to_samples(decoded.data(), bytes)
        } else {
            native(object, index * size, size, bytes).ok_or_else(|| place.truncated(self.length))?
        };
        if raw.len() < width * height {
            return Err(place.truncated(self.length));
        }
        let samples = raw.iter().take(width * height).map(|&s| self.layout.level(s)).collect();
        Ok(Frame { width, height, samples, bits: self.layout.stored })
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

fn to_samples(bytes: &[u8], per_sample: usize) -> Vec<u16> {
    if per_sample == 1 {
        bytes.iter().map(|&b| u16::from(b)).collect()
    } else {
        bytes.chunks_exact(2).map(|b| u16::from_ne_bytes([b[0], b[1]])).collect()
    }
}

/// Samples of `size` bytes from `offset` on, of pixel data that is not compressed.
fn native(object: &DefaultDicomObject, offset: usize, size: usize, per_sample: usize) -> Option<Vec<u16>> {
    let element = object.element_opt(tags::PIXEL_DATA).ok().flatten()?;
    let end = offset.checked_add(size)?;
    if let (Ok(words), 2) = (element.uint16_slice(), per_sample) {
        return Some(words.get(offset / 2..end / 2)?.to_vec());
    }
    // Bytes as they lie in the file; of words that hold two samples each, the low byte is the first one.
    let bytes = element.to_bytes().ok()?;
    let samples = bytes.get(offset..end)?;
    Some(if per_sample == 1 {
        to_samples(samples, 1)
    } else {
        samples.chunks_exact(2).map(|b| u16::from_le_bytes([b[0], b[1]])).collect()
    })
}
