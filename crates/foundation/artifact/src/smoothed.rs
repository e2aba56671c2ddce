//! The poses of one body over a trial after smoothing, beside which the raw ones stay.

use serde::{Deserialize, Serialize};

use crate::content::{decode_json, encode_json, hash_encoded};
use crate::{Artifact, Content, ContentHash, DecodeError, PoseRecord};

/// A body over the frames of a trial, smoothed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SmoothedTrial {
    /// One a frame of the trial; none where there is nothing to smooth and gaps were not to be bridged.
    pub frames: Vec<Option<SmoothedPose>>,
    /// Intensity of the acceleration that the motion was taken to have: of the centroid, mm^2 / t^3, and of turning, rad^2 / t^3, with the unit t of
    /// the frames' times.
    pub intensity: [f64; 2],
    /// Mean square of the innovations over what they should be: 1 where stated covariances and intensity are right; of place and of turning.
    pub normalised_innovation: [f64; 2],
    /// Root mean square of what smoothing moved: centroid, mm, and turn, rad.
    pub moved: [f64; 2],
}

/// One frame of it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SmoothedPose {
    /// `world_from_model`.
    pub pose: PoseRecord,
    /// As [`crate::Match::covariance`].
    pub covariance: [[f64; 6]; 6],
    /// Whether the frame has a match of its own; otherwise the pose bridges a gap.
    pub measured: bool,
    /// How far it lies from the raw pose: centroid, mm, and turn, rad; zero for a bridge.
    pub moved: [f64; 2],
}

impl Content for SmoothedTrial {
    const KIND: &'static str = "smoothed trial";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        hash_encoded::<Self>(&self.encode())
    }
}

impl Artifact for SmoothedTrial {
    const EXTENSION: &'static str = "json";
    fn encode(&self) -> Vec<u8> {
        encode_json(self)
    }
    fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
        decode_json(bytes)
    }
}
