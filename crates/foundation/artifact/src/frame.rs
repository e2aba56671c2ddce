//! One picture of one fluoroscope.

use crate::{Content, ContentHash, ContentHasher};

/// Grey levels row by row, `samples[y * width + x]`; **larger is brighter**, so bone and metal are dark.
///
/// A reader turns pictures of the other polarity (DICOM MONOCHROME1) round before they get here.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Grey levels, 0 to `2^bits - 1`.
    pub samples: Vec<u16>,
    /// Bits a grey level has, 1 to 16.
    pub bits: u32,
}

impl Content for Frame {
    const KIND: &'static str = "frame";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        let Self { width, height, samples, bits } = self;
        let mut bytes = Vec::with_capacity(samples.len() * 2);
        bytes.extend(samples.iter().flat_map(|s| s.to_le_bytes()));
        ContentHasher::new(Self::KIND, Self::SCHEMA)
            .unsigned(*width as u64)
            .unsigned(*height as u64)
            .unsigned(u64::from(*bits))
            .bytes(&bytes)
            .finish()
    }
}
