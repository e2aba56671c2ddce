//! Pictures of one fluoroscope: PNG, JPEG, BMP, TIFF (one page or many) and DICOM (one frame or many).
//!
//! The format is told by the first bytes. Grey of 8 or 16 bits (PNG also 1, 2, 4; DICOM any number up to 16) is read;
//! grey stored as red, green and blue is accepted where the three are equal everywhere, and refused, saying where, if
//! they are not. Larger is brighter afterwards: TIFF `WhiteIsZero` and DICOM `MONOCHROME1` are turned round.
//!
//! Not read: floating-point and 32-bit pictures, palettes, JPEG inside TIFF, DICOM JPEG-LS and JPEG 2000. Grey levels of
//! 12-bit pictures stored in 16 bits are given as 16 bits, unless the TIFF tag `MaxSampleValue` or DICOM's `BitsStored`
//! says how many are used.

pub(crate) mod dicom;
mod raster;
mod tiff_pages;

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use biplane_artifact::Frame;

/// Pixels a picture may have: four times what the largest detectors give.
const MAX_PIXELS: u64 = 1 << 27;
/// No compression of these formats makes a file smaller than its pixels by more than this (LZW: about 2700).
const MAX_COMPRESSION: u64 = 4096;

/// What an image file is written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImageFormat {
    /// Portable network graphics.
    Png,
    /// JPEG: lossy; its blocks shift edges.
    Jpeg,
    /// Windows bitmap.
    Bmp,
    /// TIFF or BigTIFF.
    Tiff,
    /// DICOM file, part 10.
    Dicom,
}

impl ImageFormat {
    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Png => "PNG",
            Self::Jpeg => "JPEG",
            Self::Bmp => "BMP",
            Self::Tiff => "TIFF",
            Self::Dicom => "DICOM",
        }
    }

    /// The format a file starts like, if one of those read here; 132 bytes are enough.
    pub fn of_start(start: &[u8]) -> Option<Self> {
        let tiff: [&[u8]; 4] = [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"];
        if start.starts_with(b"\x89PNG\r\n\x1a\n") {
            Some(Self::Png)
        } else if start.starts_with(b"\xff\xd8\xff") {
            Some(Self::Jpeg)
        } else if start.starts_with(b"BM") && start.len() > 26 {
            Some(Self::Bmp)
        } else if tiff.iter().any(|magic| start.starts_with(magic)) {
            Some(Self::Tiff)
        } else if start.get(128..132) == Some(b"DICM") {
            Some(Self::Dicom)
        } else {
            None
        }
    }
}

/// What a file says of its frames.
#[derive(Debug, Clone, PartialEq)]
pub struct ImageInfo {
    /// What it is written in.
    pub format: ImageFormat,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Bits of a grey level, 1 to 16.
    pub bits: u32,
    /// Frames (DICOM) or pages (TIFF); 1 for the others.
    pub frames: usize,
    /// Frames a second, if the file says so.
    pub rate_hz: Option<f64>,
    /// Seconds of each frame after the first one; empty if the file does not say.
    pub times_s: Vec<f64>,
}

/// Why a picture could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// The operating system said no.
    #[error("cannot read {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// Not a format that is read.
    #[error("{} is not an image this program reads: it starts with {found}; expected PNG, TIFF, DICOM, JPEG or BMP", path.display())]
    Unknown {
        /// The file.
        path: PathBuf,
        /// Its first bytes.
        found: String,
    },
    /// Not a byte in it.
    #[error("{} is empty (0 bytes): copy it again from where it was recorded", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// The file is shorter than what it says it holds.
    #[error(
        "{}: {} is cut short: the file ends after {length} bytes, before all of its pixels; copy it again \
         from where it was recorded", path.display(), which(*index)
    )]
    Truncated {
        /// The file.
        path: PathBuf,
        /// Zero-based frame.
        index: usize,
        /// Bytes of the file.
        length: u64,
    },
    /// A format that is read, but not this kind of it.
    #[error("{}: {} is {what}; {advice}", path.display(), which(*index))]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// Zero-based frame.
        index: usize,
        /// What was found.
        what: String,
        /// What to do about it.
        advice: &'static str,
    },
    /// A picture that is not grey.
    #[error(
        "{}: {} is a colour picture: at pixel ({x}, {y}) red, green and blue are {} {} {}; an X-ray picture \
         is grey, so convert it to grey and check that nothing was drawn into it", path.display(), which(*index), rgb[0], rgb[1], rgb[2]
    )]
    Colour {
        /// The file.
        path: PathBuf,
        /// Zero-based frame.
        index: usize,
        /// Column.
        x: usize,
        /// Row.
        y: usize,
        /// The three levels there.
        rgb: [u16; 3],
    },
    /// Something in the file contradicts itself.
    #[error("{}: {} is damaged: {what}", path.display(), which(*index))]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Zero-based frame.
        index: usize,
        /// What was found.
        what: String,
    },
    /// More pixels than the file can hold.
    #[error(
        "{}: {} claims {width} x {height} pixels, which a file of {length} bytes cannot hold (at most {} \
         pixels are read); the file is damaged", path.display(), which(*index), MAX_PIXELS
    )]
    Impossible {
        /// The file.
        path: PathBuf,
        /// Zero-based frame.
        index: usize,
        /// Columns claimed.
        width: u64,
        /// Rows claimed.
        height: u64,
        /// Bytes of the file.
        length: u64,
    },
    /// Pages of different sizes.
    #[error(
        "{}: page {index} has {} x {} pixels, the first one {} x {}; the frames of one file must have one size",
        path.display(), found[0], found[1], first[0], first[1]
    )]
    SizeChanges {
        /// The file.
        path: PathBuf,
        /// Zero-based page.
        index: usize,
        /// Columns and rows of that page.
        found: [usize; 2],
        /// Columns and rows of the first one.
        first: [usize; 2],
    },
    /// A frame was asked for that is not there.
    #[error("{} has {frames} frame(s); number {index}, counted from 0, is not there", path.display())]
    NoSuchFrame {
        /// The file.
        path: PathBuf,
        /// Zero-based frame.
        index: usize,
        /// Frames in the file.
        frames: usize,
    },
}

/// An open image file; its frames are decoded one at a time, when asked for.
pub struct ImageFile {
    path: PathBuf,
    info: ImageInfo,
    reader: Reader,
}

enum Reader {
    Raster,
    Tiff(Box<tiff_pages::Pages>),
    Dicom(Box<dicom::Frames>),
}

impl std::fmt::Debug for ImageFile {
    // Only the path and what describes the pixels: a DICOM data set names a patient.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ImageFile")
            .field("path", &self.path)
            .field("info", &self.info)
            .finish_non_exhaustive()
    }
}

impl ImageFile {
    /// Opens a file and reads what it says of its frames, but none of them.
    ///
    /// # Errors
    /// The file cannot be read, is not an image, or is of a kind that is not read (the kinds are named in the message).
    pub fn open(path: impl AsRef<Path>) -> Result<Self, ImageError> {
        let path = path.as_ref();
        let place = Place { path, index: 0 };
        let mut file = File::open(path).map_err(|source| place.io(source))?;
        let length = file.metadata().map_err(|source| place.io(source))?.len();
        let mut start = Vec::with_capacity(132);
        file.by_ref().take(132).read_to_end(&mut start).map_err(|source| place.io(source))?;
        if length == 0 {
            return Err(ImageError::Empty { path: path.to_owned() });
        }
        let Some(format) = ImageFormat::of_start(&start) else {
            return Err(ImageError::Unknown { path: path.to_owned(), found: describe_start(&start) });
        };
        drop(file);
        let (info, reader) = match format {
            ImageFormat::Tiff => {
                let (info, pages) = tiff_pages::open(path, length)?;
                (info, Reader::Tiff(Box::new(pages)))
            }
            ImageFormat::Dicom => {
                let (info, frames) = dicom::open(path, length)?;
                (info, Reader::Dicom(Box::new(frames)))
            }
            ImageFormat::Png | ImageFormat::Jpeg | ImageFormat::Bmp => {
                (raster::open(path, format, length)?, Reader::Raster)
            }
        };
        Ok(Self { path: path.to_owned(), info, reader })
    }

    /// What the file says of its frames.
    pub fn info(&self) -> &ImageInfo {
        &self.info
    }

    /// Decodes one frame, counted from 0.
    ///
    /// # Errors
    /// There is no such frame, or its pixels are cut short, damaged, in colour or of a kind that is not read.
    pub fn frame(&mut self, index: usize) -> Result<Frame, ImageError> {
        if index >= self.info.frames {
            return Err(ImageError::NoSuchFrame { path: self.path.clone(), index, frames: self.info.frames });
        }
        match &mut self.reader {
            Reader::Raster => raster::read(&self.path, self.info.format),
            Reader::Tiff(pages) => pages.read(&self.path, index),
            Reader::Dicom(frames) => frames.read(&self.path, index),
        }
    }
}

/// Reads one frame of a file, counted from 0. To read many frames of one file, open it once with [`ImageFile::open`].
///
/// # Errors
/// As [`ImageFile::open`] and [`ImageFile::frame`].
pub fn read_frame(path: impl AsRef<Path>, index_in_file: usize) -> Result<Frame, ImageError> {
    ImageFile::open(path)?.frame(index_in_file)
}

/// Which frame of which file an error is about.
#[derive(Clone, Copy)]
struct Place<'a> {
    path: &'a Path,
    index: usize,
}

impl Place<'_> {
    fn io(self, source: io::Error) -> ImageError {
        ImageError::Io { path: self.path.to_owned(), source }
    }

    fn damaged(self, what: impl ToString) -> ImageError {
        ImageError::Damaged { path: self.path.to_owned(), index: self.index, what: what.to_string() }
    }

    fn unsupported(self, what: impl ToString, advice: &'static str) -> ImageError {
        ImageError::Unsupported {
            path: self.path.to_owned(),
            index: self.index,
            what: what.to_string(),
            advice,
        }
    }

    fn truncated(self, length: u64) -> ImageError {
        ImageError::Truncated { path: self.path.to_owned(), index: self.index, length }
    }

    /// Refuses a size that is zero, or more than `length` bytes can hold, before memory is taken for it.
    fn check_size(
        self,
        width: u64,
        height: u64,
        bytes_per_pixel: u64,
        length: u64,
    ) -> Result<(), ImageError> {
        let pixels = width.saturating_mul(height);
        if pixels == 0 {
            return Err(self.damaged(format!("it claims {width} x {height} pixels")));
        }
        let held = length.saturating_mul(MAX_COMPRESSION);
        if pixels > MAX_PIXELS || pixels.saturating_mul(bytes_per_pixel) > held {
            return Err(ImageError::Impossible {
                path: self.path.to_owned(),
                index: self.index,
                width,
                height,
                length,
            });
        }
        Ok(())
    }

    /// One channel of `channels` interleaved ones (1 grey, 2 grey and opacity, 3 colour, 4 colour and opacity).
    fn grey(
        self,
        samples: Vec<u16>,
        channels: usize,
        width: usize,
        bits: u32,
    ) -> Result<Vec<u16>, ImageError> {
        if channels == 1 {
            return Ok(samples);
        }
        let opaque = ((1_u32 << bits) - 1) as u16;
        let mut grey = Vec::with_capacity(samples.len() / channels);
        for (i, pixel) in samples.chunks_exact(channels).enumerate() {
            if channels >= 3 && (pixel[0] != pixel[1] || pixel[1] != pixel[2]) {
                return Err(ImageError::Colour {
                    path: self.path.to_owned(),
                    index: self.index,
                    x: i % width.max(1),
                    y: i / width.max(1),
                    rgb: [pixel[0], pixel[1], pixel[2]],
                });
            }
            if channels.is_multiple_of(2) && pixel[channels - 1] != opaque {
                return Err(self.unsupported("partly transparent", "save it without transparency"));
            }
            grey.push(pixel[0]);
        }
        Ok(grey)
    }
}

/// A picture of a file for messages: most files have one only, of which a number would say nothing.
fn which(index: usize) -> String {
    if index == 0 { "the picture".to_owned() } else { format!("frame {index} (counted from 0)") }
}

/// The first bytes of a file as a message can show them; text is not shown, since it may name someone.
fn describe_start(start: &[u8]) -> String {
    let bytes: Vec<String> = start.iter().take(8).map(|b| format!("{b:02x}")).collect();
    format!("the bytes {}", bytes.join(" "))
}

/// Runs a DICOM or image decoder with its logging off: what such a crate logs may quote a header.
fn quietly<T>(work: impl FnOnce() -> T) -> T {
    tracing::subscriber::with_default(tracing::subscriber::NoSubscriber::default(), work)
}
