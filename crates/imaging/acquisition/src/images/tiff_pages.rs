//! TIFF and BigTIFF, one page or many, through the `tiff` crate: uncompressed, packbits, LZW and deflate.
//!
//! Pages that the file marks as reduced copies (thumbnails) are left out. The crate turns `WhiteIsZero` round.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use biplane_artifact::Frame;
use tiff::decoder::{Decoder, DecodingResult};
use tiff::tags::Tag;
use tiff::{ColorType, TiffError};

use super::{ImageError, ImageFormat, ImageInfo, Place};

const ADVICE: &str = "save it as 8- or 16-bit grey TIFF or PNG";
/// Pages a file may have: an hour at 500 frames a second.
const MAX_PAGES: usize = 2_000_000;

pub(super) struct Pages {
    decoder: Decoder<BufReader<File>>,
    length: u64,
    /// Directory of each page; thumbnails have none.
    directories: Vec<usize>,
}

fn explain(place: Place<'_>, length: u64, error: TiffError) -> ImageError {
    match error {
        TiffError::IoError(e) if e.kind() == std::io::ErrorKind::UnexpectedEof => place.truncated(length),
        TiffError::IoError(e) => place.io(e),
        TiffError::UnsupportedError(e) => place.unsupported(format!("a TIFF that is not read ({e})"), ADVICE),
        e => place.damaged(e),
    }
}

/// Channels and bits of a page.
fn layout(
    place: Place<'_>,
    length: u64,
    decoder: &mut Decoder<BufReader<File>>,
) -> Result<(usize, u32), ImageError> {
    let colour = decoder.colortype().map_err(|e| explain(place, length, e))?;
    let (channels, bits) = match colour {
        ColorType::Gray(bits) => (1, bits),
        ColorType::GrayA(bits) => (2, bits),
        ColorType::RGB(bits) => (3, bits),
        ColorType::RGBA(bits) => (4, bits),
        ColorType::Palette(_) => return Err(place.unsupported("a TIFF with a palette", ADVICE)),
        other => return Err(place.unsupported(format!("a TIFF of kind {other:?}"), ADVICE)),
    };
    let tag = |decoder: &mut Decoder<_>, tag| decoder.find_tag_unsigned_vec::<u16>(tag).ok().flatten();
    let format = tag(decoder, Tag::SampleFormat).and_then(|v| v.first().copied()).unwrap_or(1);
    if format == 3 {
        return Err(place.unsupported(format!("a TIFF of {bits}-bit floating-point numbers"), ADVICE));
    }
    if format == 2 {
        return Err(place.unsupported(format!("a TIFF of signed {bits}-bit numbers"), ADVICE));
    }
    if bits != 8 && bits != 16 {
        return Err(place.unsupported(format!("a TIFF of {bits}-bit numbers"), ADVICE));
    }
    let planar = tag(decoder, Tag::PlanarConfiguration).and_then(|v| v.first().copied()).unwrap_or(1);
    if channels > 1 && planar == 2 {
        return Err(place.unsupported("a TIFF whose colours lie in separate planes", ADVICE));
    }
    Ok((channels, u32::from(bits)))
}

/// Bits that the samples use, where the page says what its largest sample may be.
fn used_bits(decoder: &mut Decoder<BufReader<File>>, bits: u32) -> u32 {
    match decoder.find_tag_unsigned_vec::<u16>(Tag::MaxSampleValue) {
        Ok(Some(max)) if max.first().is_some_and(|&m| m > 0) => {
            let used = max.iter().map(|m| u16::BITS - m.leading_zeros()).max().unwrap_or(bits);
            // Below 8 bits the tag is more likely wrong than the picture that dark.
            used.clamp(8, bits)
        }
        _ => bits,
    }
}

pub(super) fn open(path: &Path, length: u64) -> Result<(ImageInfo, Pages), ImageError> {
    let place = |index| Place { path, index };
    let file = File::open(path).map_err(|e| place(0).io(e))?;
    let mut decoder = Decoder::new(BufReader::new(file)).map_err(|e| explain(place(0), length, e))?;
    let mut directories = Vec::new();
    let mut first = None;
    for directory in 0..MAX_PAGES {
        let place = place(directories.len());
        let reduced =
            decoder.find_tag_unsigned::<u32>(Tag::NewSubfileType).ok().flatten().unwrap_or(0) & 1 == 1;
        if !reduced {
            let (width, height) = decoder.dimensions().map_err(|e| explain(place, length, e))?;
            let (channels, bits) = layout(place, length, &mut decoder)?;
            place.check_size(width.into(), height.into(), channels as u64 * u64::from(bits / 8), length)?;
            let found = [width as usize, height as usize];
            let used = used_bits(&mut decoder, bits);
            let &mut (first, _) = first.get_or_insert((found, used));
            if found != first {
                return Err(ImageError::SizeChanges {
                    path: path.to_owned(),
                    index: place.index,
                    found,
                    first,
                });
            }
            directories.push(directory);
        }
        if !decoder.more_images() {
            break;
        }
        decoder.next_image().map_err(|e| explain(place, length, e))?;
    }
    let Some(([width, height], bits)) = first else {
        return Err(place(0).damaged("it holds reduced copies (thumbnails) only"));
    };
    let frames = directories.len();
    check_imagej(place(0), length, &mut decoder, frames)?;
    let info = ImageInfo {
        format: ImageFormat::Tiff,
        width,
        height,
        bits,
        frames,
        rate_hz: None,
        times_s: Vec::new(),
    };
    Ok((info, Pages { decoder, length, directories }))
}

/// ImageJ writes stacks beyond 4 GB with one page only, and the count in the description: reading one frame of them in
/// silence would lose the rest.
fn check_imagej(
    place: Place<'_>,
    length: u64,
    decoder: &mut Decoder<BufReader<File>>,
    pages: usize,
) -> Result<(), ImageError> {
    decoder.seek_to_image(0).map_err(|e| explain(place, length, e))?;
    let Ok(text) = decoder.get_tag_ascii_string(Tag::ImageDescription) else { return Ok(()) };
    let claimed = text
        .lines()
        .filter(|_| text.starts_with("ImageJ="))
        .find_map(|line| line.strip_prefix("images=")?.trim().parse::<usize>().ok());
    match claimed {
        Some(images) if images > pages => Err(place.unsupported(
            format!("the first of {images} that ImageJ says it wrote, but only {pages} page(s) can be found"),
            "save the stack as an image sequence, one file a frame",
        )),
        _ => Ok(()),
    }
}

impl Pages {
    pub(super) fn read(&mut self, path: &Path, index: usize) -> Result<Frame, ImageError> {
        let place = Place { path, index };
        let length = self.length;
        let Some(&directory) = self.directories.get(index) else {
            return Err(ImageError::NoSuchFrame {
                path: path.to_owned(),
                index,
                frames: self.directories.len(),
            });
        };
        self.decoder.seek_to_image(directory).map_err(|e| explain(place, length, e))?;
        let (width, height) = self.decoder.dimensions().map_err(|e| explain(place, length, e))?;
        let (width, height) = (width as usize, height as usize);
        let (channels, bits) = layout(place, length, &mut self.decoder)?;
        let samples = match self.decoder.read_image().map_err(|e| explain(place, length, e))? {
            DecodingResult::U8(samples) => samples.into_iter().map(u16::from).collect(),
            DecodingResult::U16(samples) => samples,
            _ => return Err(place.unsupported("a TIFF of neither 8 nor 16 bits", ADVICE)),
        };
        if samples.len() != width * height * channels {
            return Err(place.truncated(length));
        }
        let samples = place.grey(samples, channels, width, bits)?;
        let used = used_bits(&mut self.decoder, bits);
        // A tag that the pixels contradict does not count.
        let bits = if samples.iter().all(|&s| u32::from(s) < 1 << used) { used } else { bits };
        Ok(Frame { width, height, samples, bits })
    }
}
