//! Which edges of a picture are taken for the outline of one body, and what a person drew instead.

use serde::{Deserialize, Serialize};

use crate::content::{decode_json, encode_json, hash_encoded};
use crate::{Artifact, Content, ContentHash, ContentHasher, DecodeError};

/// The part of one view's [`crate::Curves`] that lies on the outline of one body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Contour {
    /// By curve.
    pub pieces: Vec<ContourPiece>,
    /// Length of the outline within the picture, px.
    pub outline_px: f64,
    /// Length of it that has an edge, px.
    pub found_px: f64,
    /// Length of it where edges of two curves lie near enough and in the right direction, so that either could be meant, px.
    pub unclear_px: f64,
    /// Why a person should look at it; none where nothing is unclear.
    pub flags: Vec<String>,
}

/// One stretch of a curve with its trusted part `t0..t1`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ContourPiece {
    /// Number of the curve, from 0.
    pub curve: usize,
    /// Its first trusted point.
    pub first: usize,
    /// Its last trusted point. On a closed curve it may lie before the first: the piece then runs through the seam.
    pub last: usize,
}

/// What a person drew for the outline of one body in one picture, in recorded pixels: it stands for the automatic contour.
#[derive(Debug, Clone, PartialEq)]
pub struct EditedContour {
    /// The trusted part of every piece.
    pub pieces: Vec<EditedPiece>,
}

/// One drawn piece.
#[derive(Debug, Clone, PartialEq)]
pub struct EditedPiece {
    /// Its name in the file, for messages.
    pub name: String,
    /// Points along it, at most 1 px apart and within 0.01 px of the drawn curve, px.
    pub points: Vec<[f64; 2]>,
    /// Whether the last point is followed by the first.
    pub closed: bool,
}

impl Content for Contour {
    const KIND: &'static str = "contour";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        hash_encoded::<Self>(&self.encode())
    }
}

impl Artifact for Contour {
    const EXTENSION: &'static str = "json";
    fn encode(&self) -> Vec<u8> {
        encode_json(self)
    }
    fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
        decode_json(bytes)
    }
}

impl Content for EditedContour {
    const KIND: &'static str = "edited_contour";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        let mut hasher = ContentHasher::new(Self::KIND, Self::SCHEMA);
        hasher.unsigned(self.pieces.len() as u64);
        for EditedPiece { name, points, closed } in &self.pieces {
            hasher.text(name).unsigned(u64::from(*closed)).unsigned(points.len() as u64);
            for v in points.iter().flatten() {
                hasher.float(*v);
            }
        }
        hasher.finish()
    }
}
