//! A plate of a known pattern, and what its picture says of an intensifier's distortion.

use serde::{Deserialize, Serialize};

use crate::content::{decode_json, encode_json, hash_encoded};
use crate::{Artifact, Circle, Content, ContentHash, ContentHasher, DecodeError, DistortionTable, Verdict};

/// Where the spots of a plate are, in the plate's own plane, mm.
#[derive(Debug, Clone, PartialEq)]
pub enum PlatePattern {
    /// Each spot by itself, numbered from 0 in this order.
    List(Vec<PlateSpot>),
    /// A square grid without end.
    Square {
        /// Distance of neighbours, mm.
        pitch_mm: f64,
    },
    /// A grid of equilateral triangles without end (XMALab's plate).
    Hexagonal {
        /// Distance of neighbours, mm.
        pitch_mm: f64,
    },
}

/// One hole or dot of a plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateSpot {
    /// Its centre on the plate, mm.
    pub at_mm: [f64; 2],
    /// Its radius, mm, if known: larger ones are marks by which the pattern is recognised.
    pub radius_mm: Option<f64>,
}

impl Content for PlatePattern {
    const KIND: &'static str = "plate-pattern";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        let mut h = ContentHasher::new(Self::KIND, Self::SCHEMA);
        match self {
            Self::List(spots) => {
                h.text("list").unsigned(spots.len() as u64);
                for PlateSpot { at_mm, radius_mm } in spots {
                    h.float(at_mm[0]).float(at_mm[1]).float(radius_mm.unwrap_or(f64::NAN));
                }
            }
            Self::Square { pitch_mm } => {
                h.text("square").float(*pitch_mm);
            }
            Self::Hexagonal { pitch_mm } => {
                h.text("hexagonal").float(*pitch_mm);
            }
        }
        h.finish()
    }
}

/// Correspondences that a person gave for one picture of a plate.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlateClicks(pub Vec<PlateClick>);

/// One of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateClick {
    /// The spot on the plate, mm.
    pub plate_mm: [f64; 2],
    /// About where it is in the picture, recorded px.
    pub at_px: [f64; 2],
}

impl Content for PlateClicks {
    const KIND: &'static str = "plate-clicks";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        let mut h = ContentHasher::new(Self::KIND, Self::SCHEMA);
        for PlateClick { plate_mm, at_px } in &self.0 {
            plate_mm.iter().chain(at_px).for_each(|v| {
                h.float(*v);
            });
        }
        h.finish()
    }
}

/// The distortion of one fluoroscope as its plate shows it.
///
/// Ideal pixels are squares of `pixel_mm` in the plate's plane; where they begin and how they are turned is free, and chosen so that
/// the map moves the recorded pixels least.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlateFit {
    /// Columns and rows of the picture.
    pub size: [usize; 2],
    /// Recorded to ideal pixels.
    pub table: DistortionTable,
    /// Side of an ideal pixel in the plate's plane, mm.
    pub pixel_mm: f64,
    /// Rows `[a, b, c]` of the similarity `plate = (a x + b y + c)` from ideal pixels to the plate's plane, mm.
    pub plate_from_ideal: [[f64; 3]; 2],
    /// Whether the plate is seen from its back: the similarity above has a reflection in it.
    pub mirrored: bool,
    /// The model that the table was made from, as in `models`: its name, for people.
    pub model: String,
    /// All models that were tried.
    pub models: Vec<ModelScore>,
    /// Spots of the picture that were matched to the plate, in the order of the picture's spots.
    pub matched: Vec<MatchedSpot>,
    /// Spots of the picture that belong to no spot of the plate, recorded px.
    pub strays_px: Vec<[f64; 2]>,
    /// Spots of the plate that lie within the picture and were not found, about where, recorded px.
    pub missing_px: Vec<[f64; 2]>,
    /// The intensifier's round border.
    pub border: Option<Circle>,
    /// How far recorded pixels of the spots are from ideal ones, root mean square, px: what is corrected.
    pub before_rms_px: f64,
    /// Largest error over the picture of going to ideal pixels and back, px.
    pub round_trip_px: f64,
    /// Whether the fit keeps the limits of pipeline.toml.
    pub verdict: Verdict,
    /// Why it does not, and what else is worth a look, for people.
    pub warnings: Vec<String>,
}

/// How well one model of the distortion does.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModelScore {
    /// `polynomial, degree 4` or `local weighted mean`.
    pub name: String,
    /// Root mean square residual of the spots it was fitted to, px (both coordinates together: length of the residual vector).
    pub fitted_rms_px: f64,
    /// The same of spots held out of the fit (cross-validation), px. Choose by this one.
    pub held_out_rms_px: f64,
    /// 95th percentile of the lengths of the held-out residuals, px.
    pub held_out_p95_px: f64,
}

/// A spot of the picture that is one of the plate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MatchedSpot {
    /// In the picture, recorded px.
    pub at_px: [f64; 2],
    /// On the plate, mm.
    pub plate_mm: [f64; 2],
    /// Held-out residual, ideal px: where the map takes it, less where it belongs.
    pub residual_px: [f64; 2],
    /// Whether the fit uses it; one that lies far off is left out.
    pub used: bool,
}

impl Content for PlateFit {
    const KIND: &'static str = "plate-fit";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        hash_encoded::<Self>(&self.encode())
    }
}

impl Artifact for PlateFit {
    const EXTENSION: &'static str = "json";
    fn encode(&self) -> Vec<u8> {
        encode_json(self)
    }
    fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
        decode_json(bytes)
    }
}
