//! The round spots of a calibration picture: holes of a plate, or beads.

use serde::{Deserialize, Serialize};

use crate::content::{decode_json, encode_json, hash_encoded};
use crate::{Artifact, Content, ContentHash, DecodeError};

/// All spots of one picture, in recorded pixels (centre of the first one at (0, 0)), and the round border of the
/// intensifier if the picture shows it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Spots {
    /// Columns and rows of the picture.
    pub size: [usize; 2],
    /// From top to bottom.
    pub spots: Vec<Spot>,
    /// The round border of the intensifier's picture; none where the picture fills its rectangle.
    pub border: Option<Circle>,
    /// Worth a look, for people.
    pub warnings: Vec<String>,
}

/// One spot.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Spot {
    /// Centre of its area, px.
    pub at_px: [f64; 2],
    /// Radius of the circle of the same area, px.
    pub radius_px: f64,
    /// Longest over shortest axis, 1 for a circle.
    pub elongation: f64,
    /// How much it stands out of its surroundings, grey levels of 0..255; positive.
    pub contrast: f64,
    /// Standard deviation of each coordinate of the centre from the noise of the picture, px.
    pub sigma_px: f64,
    /// It is cut by the border of the picture or of the intensifier, or runs into another spot: its centre is not that of the hole
    /// or bead.
    pub cut: bool,
}

/// A circle, px.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Circle {
    /// Its middle, recorded px.
    pub centre_px: [f64; 2],
    /// Its radius, px.
    pub radius_px: f64,
}

impl Content for Spots {
    const KIND: &'static str = "spots";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        hash_encoded::<Self>(&self.encode())
    }
}

impl Artifact for Spots {
    const EXTENSION: &'static str = "json";
    fn encode(&self) -> Vec<u8> {
        encode_json(self)
    }
    fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
        decode_json(bytes)
    }
}
