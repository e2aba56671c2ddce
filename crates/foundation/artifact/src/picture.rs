//! A picture for people: PNG bytes as they are.

use crate::content::hash_encoded;
use crate::{Artifact, Content, ContentHash, DecodeError};

/// The bytes of a PNG file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture(pub Vec<u8>);

impl Content for Picture {
    const KIND: &'static str = "picture";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        hash_encoded::<Self>(&self.0)
    }
}

impl Artifact for Picture {
    const EXTENSION: &'static str = "png";
    fn encode(&self) -> Vec<u8> {
        self.0.clone()
    }
    fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
        if bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
            Ok(Self(bytes.to_vec()))
        } else {
            Err(DecodeError::of::<Self>("the first bytes are not those of a PNG"))
        }
    }
}
