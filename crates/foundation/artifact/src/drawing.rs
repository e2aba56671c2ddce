//! A drawing for people: SVG text as it is.

use crate::content::hash_encoded;
use crate::{Artifact, Content, ContentHash, DecodeError};

/// An SVG file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Drawing(pub String);

impl Content for Drawing {
    const KIND: &'static str = "drawing";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        hash_encoded::<Self>(self.0.as_bytes())
    }
}

impl Artifact for Drawing {
    const EXTENSION: &'static str = "svg";
    fn encode(&self) -> Vec<u8> {
        self.0.as_bytes().to_vec()
    }
    fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
        match std::str::from_utf8(bytes) {
            Ok(text) if text.starts_with("<svg") => Ok(Self(text.to_owned())),
            Ok(_) => Err(DecodeError::of::<Self>("it does not begin with <svg")),
            Err(error) => Err(DecodeError::of::<Self>(error)),
        }
    }
}
