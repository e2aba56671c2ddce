//! PNG, JPEG and BMP, through the `image` crate.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use biplane_artifact::Frame;
use image::{DynamicImage, ImageDecoder, ImageReader};

use super::{ImageError, ImageFormat, ImageInfo, Place, quietly};

fn reader(path: &Path, format: ImageFormat) -> Result<ImageReader<BufReader<File>>, ImageError> {
    let file = File::open(path).map_err(|source| Place { path, index: 0 }.io(source))?;
    let format = match format {
        ImageFormat::Jpeg => image::ImageFormat::Jpeg,
        ImageFormat::Bmp => image::ImageFormat::Bmp,
        _ => image::ImageFormat::Png,
    };
    Ok(ImageReader::with_format(BufReader::new(file), format))
}

/// What the decoder said; a file that ends early is told apart.
fn explain(place: Place<'_>, error: image::ImageError) -> ImageError {
    match error {
        image::ImageError::IoError(e) if e.kind() == std::io::ErrorKind::UnexpectedEof => {
            place.truncated(std::fs::metadata(place.path).map_or(0, |m| m.len()))
        }
        image::ImageError::IoError(e) => place.io(e),
        image::ImageError::Unsupported(e) => place.unsupported(e, "save it as 8- or 16-bit grey PNG"),
        e => place.damaged(e),
    }
}

pub(super) fn open(path: &Path, format: ImageFormat, length: u64) -> Result<ImageInfo, ImageError> {
    let place = Place { path, index: 0 };
    let decoder = quietly(|| reader(path, format)?.into_decoder().map_err(|e| explain(place, e)))?;
    let (width, height) = decoder.dimensions();
    let colour = decoder.color_type();
    place.check_size(width.into(), height.into(), colour.bytes_per_pixel().into(), length)?;
    if format == ImageFormat::Jpeg {
        check_jpeg_end(place, length)?;
    }
    Ok(ImageInfo {
        format,
        width: width as usize,
        height: height as usize,
        bits: u32::from(colour.bits_per_pixel() / u16::from(colour.channel_count().max(1))),
        frames: 1,
        rate_hz: None,
        times_s: Vec::new(),
    })
}

/// A JPEG decoder fills what is missing with grey and says nothing, so the end marker is looked for.
fn check_jpeg_end(place: Place<'_>, length: u64) -> Result<(), ImageError> {
    let mut tail = Vec::new();
    let mut file = File::open(place.path).map_err(|e| place.io(e))?;
    file.seek(SeekFrom::Start(length.saturating_sub(4096))).map_err(|e| place.io(e))?;
    file.take(4096).read_to_end(&mut tail).map_err(|e| place.io(e))?;
    if tail.windows(2).any(|w| w == [0xff, 0xd9]) { Ok(()) } else { Err(place.truncated(length)) }
}

pub(super) fn read(path: &Path, format: ImageFormat) -> Result<Frame, ImageError> {
    let place = Place { path, index: 0 };
    let picture = quietly(|| reader(path, format)?.decode().map_err(|e| explain(place, e)))?;
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let channels = usize::from(picture.color().channel_count());
    let wide = |bytes: Vec<u8>| bytes.into_iter().map(u16::from).collect::<Vec<_>>();
    let (samples, bits) = match picture {
        DynamicImage::ImageLuma8(p) => (wide(p.into_raw()), 8),
        DynamicImage::ImageLumaA8(p) => (wide(p.into_raw()), 8),
        DynamicImage::ImageRgb8(p) => (wide(p.into_raw()), 8),
        DynamicImage::ImageRgba8(p) => (wide(p.into_raw()), 8),
        DynamicImage::ImageLuma16(p) => (p.into_raw(), 16),
        DynamicImage::ImageLumaA16(p) => (p.into_raw(), 16),
        DynamicImage::ImageRgb16(p) => (p.into_raw(), 16),
        DynamicImage::ImageRgba16(p) => (p.into_raw(), 16),
        other => {
            return Err(place.unsupported(
                format!("a picture of {:?}", other.color()),
                "save it as 8- or 16-bit grey PNG",
            ));
        }
    };
    Ok(Frame { width, height, samples: place.grey(samples, channels, width, bits)?, bits })
}
