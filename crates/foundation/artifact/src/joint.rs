//! How two bodies of a frame stand to each other.

use serde::{Deserialize, Serialize};

use crate::content::{decode_json, encode_json, hash_encoded};
use crate::{Artifact, Content, ContentHash, DecodeError, PoseRecord};

/// A joint in one frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JointPose {
    /// The distal body's axes in those of the proximal one: `x_proximal = R x_distal + t`, mm.
    pub proximal_from_distal: PoseRecord,
    /// The three angles of the joint's convention, rad, in -pi to pi.
    pub angles_rad: [f64; 3],
    /// Its three translations, mm.
    pub translations_mm: [f64; 3],
    /// Covariance of the angles (rad), then of the translations (mm); none where the first and the third axis are nearly parallel, so that
    /// their angles cannot be told apart, or where a match does not say how sure it is.
    pub covariance: Option<[[f64; 6]; 6]>,
    /// How far the surfaces of the two bodies are apart, mm; none if that was not asked for.
    pub distance_mm: Option<f64>,
    /// How deep they are in each other, mm: 0 where they do not meet; none where that is not known, because one is not closed.
    pub penetration_mm: Option<f64>,
}

impl Content for JointPose {
    const KIND: &'static str = "joint pose";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        hash_encoded::<Self>(&self.encode())
    }
}

impl Artifact for JointPose {
    const EXTENSION: &'static str = "json";
    fn encode(&self) -> Vec<u8> {
        encode_json(self)
    }
    fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
        decode_json(bytes)
    }
}
