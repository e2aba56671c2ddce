//! One frame of the report: a script that a page opened from disk can load, with pictures and outlines as text.

use crate::content::hash_encoded;
use crate::{Artifact, Content, ContentHash, DecodeError};

/// How the script begins: a page may load scripts from a disk, but no data.
const OPENING: &str = "biplaneFrame(";

/// A script that calls one function of the page with one object. What is in the object is described in `docs/formats.md`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReportFrame(String);

impl ReportFrame {
    /// From the object as JSON.
    pub fn of_json(json: &str) -> Self {
        Self(format!("{OPENING}{json});\n"))
    }

    /// The script.
    pub fn script(&self) -> &str {
        &self.0
    }
}

impl Content for ReportFrame {
    const KIND: &'static str = "report frame";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        hash_encoded::<Self>(self.0.as_bytes())
    }
}

impl Artifact for ReportFrame {
    const EXTENSION: &'static str = "js";
    fn encode(&self) -> Vec<u8> {
        self.0.as_bytes().to_vec()
    }
    fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
        match std::str::from_utf8(bytes) {
            Ok(text) if text.starts_with(OPENING) && text.ends_with(");\n") => Ok(Self(text.to_owned())),
            Ok(_) => Err(DecodeError::of::<Self>("it is no call of biplaneFrame")),
            Err(error) => Err(DecodeError::of::<Self>(error)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comes_back_as_it_was_and_a_cut_one_is_refused() {
        let frame = ReportFrame::of_json("{\"views\":[]}");
        assert_eq!(frame.script(), "biplaneFrame({\"views\":[]});\n");
        let bytes = frame.encode();
        assert_eq!(ReportFrame::decode(&bytes), Ok(frame));
        assert!((0..bytes.len()).all(|cut| ReportFrame::decode(&bytes[..cut]).is_err()));
    }
}
