//! Samples of every stored type and encoding to 32-bit floats, read as a stream: memory grows with what the file holds, not with
//! what its header claims.

use std::io::{self, BufRead, Read};

use bzip2_rs::DecoderReader;
use flate2::bufread::MultiGzDecoder;

use super::{MAX_ALONG, MAX_VOXELS, Source, VolumeFileError};

/// Deflate makes no file smaller than its content by more than this (258 bytes of two bits each).
const MAX_DEFLATE: u64 = 1032;
/// Letters a number written as text may have.
const MAX_WORD: usize = 64;

pub(super) fn is_gzip(start: &[u8]) -> bool {
    start.starts_with(&[0x1f, 0x8b])
}

/// Type of a stored sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SampleType {
    Int8,
    Uint8,
    Int16,
    Uint16,
    Int32,
    Uint32,
    Int64,
    Uint64,
    Float,
    Double,
}

impl SampleType {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Int8 => "int8",
            Self::Uint8 => "uint8",
            Self::Int16 => "int16",
            Self::Uint16 => "uint16",
            Self::Int32 => "int32",
            Self::Uint32 => "uint32",
            Self::Int64 => "int64",
            Self::Uint64 => "uint64",
            Self::Float => "float",
            Self::Double => "double",
        }
    }

    pub(super) fn bytes(self) -> usize {
        match self {
            Self::Int8 | Self::Uint8 => 1,
            Self::Int16 | Self::Uint16 => 2,
            Self::Int32 | Self::Uint32 | Self::Float => 4,
            Self::Int64 | Self::Uint64 | Self::Double => 8,
        }
    }

    fn is_whole(self) -> bool {
        !matches!(self, Self::Float | Self::Double)
    }

    /// Whether text may stand for such a sample.
    fn holds(self, value: f64) -> bool {
        let unsigned = matches!(self, Self::Uint8 | Self::Uint16 | Self::Uint32 | Self::Uint64);
        let bits = 8 * self.bytes() as i32;
        let (low, high) =
            if unsigned { (0.0, 2_f64.powi(bits)) } else { (-2_f64.powi(bits - 1), 2_f64.powi(bits - 1)) };
        !self.is_whole() || (value.fract() == 0.0 && (low..high).contains(&value))
    }

    /// The value of a sample whose bytes, the lowest one first, begin `b`.
    fn value(self, b: [u8; 8]) -> f64 {
        let [b0, b1, b2, b3, ..] = b;
        match self {
            Self::Int8 => i8::from_le_bytes([b0]).into(),
            Self::Uint8 => b0.into(),
            Self::Int16 => i16::from_le_bytes([b0, b1]).into(),
            Self::Uint16 => u16::from_le_bytes([b0, b1]).into(),
            Self::Int32 => i32::from_le_bytes([b0, b1, b2, b3]).into(),
            Self::Uint32 => u32::from_le_bytes([b0, b1, b2, b3]).into(),
            Self::Int64 => i64::from_le_bytes(b) as f64,
            Self::Uint64 => u64::from_le_bytes(b) as f64,
            Self::Float => f32::from_le_bytes([b0, b1, b2, b3]).into(),
            Self::Double => f64::from_le_bytes(b),
        }
    }
}

/// How bytes of a file become those of samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Raw,
    Gzip,
    Bzip2,
    /// Numbers as text.
    Text,
    /// Two hexadecimal digits a byte.
    Hex,
}

/// What a header says of the samples.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layout {
    pub(super) sizes: [u64; 3],
    pub(super) kind: SampleType,
    pub(super) big_endian: bool,
    pub(super) slope: f64,
    pub(super) intercept: f64,
}

/// Samples as they were read.
pub(super) struct Samples {
    pub(super) levels: Vec<f32>,
    /// Whole numbers that 24 bits do not hold.
    pub(super) rounded: usize,
}

impl Layout {
    /// Refuses sizes that are zero, more than are read, or more than `length` bytes can hold.
    pub(super) fn check(
        &self,
        source: Source<'_>,
        encoding: Encoding,
        length: u64,
    ) -> Result<(), VolumeFileError> {
        let voxels = self.sizes.iter().fold(1_u64, |n, &size| n.saturating_mul(size));
        if voxels == 0 {
            let [i, j, k] = self.sizes;
            return Err(source.damaged(format!("it claims {i} x {j} x {k} voxels")));
        }
        // A file cut short is within this too, and told apart when it is read. Bzip2 has no such bound.
        let bytes = voxels.saturating_mul(self.kind.bytes() as u64);
        let fits = encoding == Encoding::Bzip2 || length.saturating_mul(MAX_DEFLATE) >= bytes;
        if voxels > MAX_VOXELS || self.sizes.iter().any(|&size| size > MAX_ALONG) || !fits {
            return Err(VolumeFileError::Impossible { path: source.path(), sizes: self.sizes, length });
        }
        Ok(())
    }

    /// Of sizes that were checked.
    pub(super) fn voxels(&self) -> u64 {
        self.sizes.iter().product()
    }

    /// Bytes of all samples; of sizes that were checked.
    pub(super) fn bytes(&self) -> u64 {
        self.voxels() * self.kind.bytes() as u64
    }

    /// Reads the samples from a stream that begins with the first byte of them and ends after the last.
    pub(super) fn read(&self, source: Source<'_>, stream: impl Read) -> Result<Samples, VolumeFileError> {
        let mut taken = Taken::new(self, source);
        taken.binary(stream)?;
        Ok(taken.samples)
    }

    /// The same, of numbers written as text.
    pub(super) fn read_text(
        &self,
        source: Source<'_>,
        stream: impl BufRead,
    ) -> Result<Samples, VolumeFileError> {
        let mut taken = Taken::new(self, source);
        taken.text(stream)?;
        Ok(taken.samples)
    }
}

/// The bytes of samples of which `stream` holds the encoded ones; text is left as it is.
pub(super) fn decoded<'a>(stream: impl BufRead + 'a, encoding: Encoding) -> Box<dyn Read + 'a> {
    match encoding {
        Encoding::Raw | Encoding::Text => Box::new(stream),
        Encoding::Gzip => Box::new(MultiGzDecoder::new(stream)),
        Encoding::Bzip2 => Box::new(DecoderReader::new(stream)),
        Encoding::Hex => Box::new(HexReader(stream)),
    }
}

/// Pairs of hexadecimal digits, white space left out.
struct HexReader<R>(R);

impl<R: BufRead> Read for HexReader<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let mut written = 0;
        let mut high = None;
        let mut bytes = self.0.by_ref().bytes();
        while written < buffer.len() {
            let Some(byte) = bytes.next() else { break };
            let byte = byte?;
            if byte.is_ascii_whitespace() {
                continue;
            }
            let digit = char::from(byte).to_digit(16).ok_or_else(|| {
                io::Error::new(io::ErrorKind::InvalidData, "a byte that is no hexadecimal digit")
            })? as u8;
            match high.take() {
                None => high = Some(digit << 4),
                Some(high) => {
                    buffer[written] = high | digit;
                    written += 1;
                }
            }
        }
        // Half a byte at the end is none.
        Ok(written)
    }
}

/// What became of a stream that failed after `found` whole voxels.
pub(super) fn fault(source: Source<'_>, error: io::Error, found: u64, expected: u64) -> VolumeFileError {
    if error.raw_os_error().is_some() {
        source.io(error)
    } else if error.kind() == io::ErrorKind::UnexpectedEof {
        VolumeFileError::Truncated { path: source.path(), found, expected }
    } else {
        source.damaged(format!("its samples cannot be decoded beyond voxel {found} of {expected} ({error})"))
    }
}

/// Samples on their way.
struct Taken<'a> {
    layout: Layout,
    source: Source<'a>,
    samples: Samples,
}

impl<'a> Taken<'a> {
    fn new(layout: &Layout, source: Source<'a>) -> Self {
        Self { layout: *layout, source, samples: Samples { levels: Vec::new(), rounded: 0 } }
    }

    fn found(&self) -> u64 {
        self.samples.levels.len() as u64
    }

    fn push(&mut self, stored: f64) -> Result<(), VolumeFileError> {
        let Layout { kind, slope, intercept, sizes: [columns, rows, _], .. } = self.layout;
        let level = (stored * slope + intercept) as f32;
        if !level.is_finite() {
            let (i, columns, rows) = (self.samples.levels.len(), columns as usize, rows as usize);
            let at = [i % columns, i / columns % rows, i / columns / rows];
            return Err(VolumeFileError::NotFinite { path: self.source.path(), at });
        }
        // Through a slope every level is rounded anyway.
        if kind.is_whole() && (slope, intercept) == (1.0, 0.0) && f64::from(level) != stored {
            self.samples.rounded += 1;
        }
        self.samples.levels.push(level);
        Ok(())
    }

    fn binary(&mut self, mut stream: impl Read) -> Result<(), VolumeFileError> {
        let Layout { kind, big_endian, .. } = self.layout;
        let (width, expected) = (kind.bytes(), self.layout.voxels());
        let mut buffer = vec![0; 1 << 16];
        while self.found() < expected {
            let wanted = usize::try_from((expected - self.found()) * width as u64).unwrap_or(usize::MAX);
            let wanted = wanted.min(buffer.len());
            let (filled, end) = fill(&mut stream, &mut buffer[..wanted]);
            for bytes in buffer[..filled].chunks_exact(width) {
                let mut word = [0; 8];
                word[..width].copy_from_slice(bytes);
                if big_endian {
                    word[..width].reverse();
                }
                self.push(kind.value(word))?;
            }
            if let Err(error) = end {
                return Err(fault(self.source, error, self.found(), expected));
            }
        }
        // One byte more: there is none, and a compressed stream checks its sum.
        match fill(&mut stream, &mut [0]) {
            (0, Err(error)) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(()),
            (_, Err(error)) => Err(fault(self.source, error, expected, expected)),
            (_, Ok(())) => Err(VolumeFileError::Longer { path: self.source.path(), expected }),
        }
    }

    /// Numbers between white space or commas.
    fn text(&mut self, stream: impl BufRead) -> Result<(), VolumeFileError> {
        let expected = self.layout.voxels();
        let mut word = String::new();
        for byte in stream.bytes() {
            let byte = byte.map_err(|e| fault(self.source, e, self.found(), expected))?;
            if !byte.is_ascii_whitespace() && byte != b',' {
                word.push(char::from(byte));
                if word.len() > MAX_WORD {
                    return Err(self.no_number());
                }
            } else if !word.is_empty() {
                self.word(&word)?;
                word.clear();
            }
        }
        if !word.is_empty() {
            self.word(&word)?;
        }
        if self.found() < expected {
            return Err(VolumeFileError::Truncated {
                path: self.source.path(),
                found: self.found(),
                expected,
            });
        }
        Ok(())
    }

    fn word(&mut self, word: &str) -> Result<(), VolumeFileError> {
        let expected = self.layout.voxels();
        if self.found() == expected {
            return Err(VolumeFileError::Longer { path: self.source.path(), expected });
        }
        let stored = word.parse().ok().filter(|&v| self.layout.kind.holds(v));
        self.push(stored.ok_or_else(|| self.no_number())?)
    }

    fn no_number(&self) -> VolumeFileError {
        let found = self.found();
        self.source.damaged(format!(
            "sample {found} of its text, counted from 0, is no number of the type {}",
            self.layout.kind.name()
        ))
    }
}

/// Reads until the buffer is full; how far it got, and why no further.
fn fill(stream: &mut impl Read, buffer: &mut [u8]) -> (usize, io::Result<()>) {
    let mut filled = 0;
    while filled < buffer.len() {
        match stream.read(&mut buffer[filled..]) {
            Ok(0) => return (filled, Err(io::ErrorKind::UnexpectedEof.into())),
            Ok(n) => filled += n,
            Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
            Err(e) => return (filled, Err(e)),
        }
    }
    (filled, Ok(()))
}
