//! The local coordinate system of a body, and the landmarks that a person gave for it.

use serde::{Deserialize, Serialize};

use crate::content::{decode_json, encode_json, hash_encoded};
use crate::{Artifact, Content, ContentHash, ContentHasher, DecodeError};

/// Points that a person named on a body: model coordinates, mm.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Landmarks(pub Vec<Landmark>);

/// A named point.
#[derive(Debug, Clone, PartialEq)]
pub struct Landmark {
    /// As the file has it, trimmed.
    pub name: String,
    /// Model coordinates, mm.
    pub at_mm: [f64; 3],
}

impl Content for Landmarks {
    const KIND: &'static str = "landmarks";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        let mut h = ContentHasher::new(Self::KIND, Self::SCHEMA);
        h.unsigned(self.0.len() as u64);
        for Landmark { name, at_mm } in &self.0 {
            h.text(name);
            at_mm.iter().for_each(|v| {
                h.float(*v);
            });
        }
        h.finish()
    }
}

/// A right-handed coordinate system fixed to a body, in model coordinates: **x anterior, y up (proximal), z to the subject's
/// right** (ISB; Wu et al. 2002), for left and right bodies alike.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BodyAxes {
    /// Where it begins, mm.
    pub origin_mm: [f64; 3],
    /// Unit vectors along x, y and z.
    pub axes: [[f64; 3]; 3],
    /// What the body is.
    pub body: BodyKind,
    /// Which side of the subject it belongs to.
    pub side: Side,
    /// Who said so.
    pub source: AxesSource,
    /// What the axes were made from, for a person to look at.
    pub features: Vec<AxesFeature>,
    /// What a person should know of them; none where all is well.
    pub warnings: Vec<String>,
}

/// What a body is: decides how its axes are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BodyKind {
    /// Distal femur.
    Femur,
    /// Proximal tibia.
    Tibia,
    /// Kneecap.
    Patella,
    /// Femoral component of a knee replacement.
    FemoralComponent,
    /// Tibial component: a tray, with or without its insert.
    TibialTray,
    /// Anything else: its principal axes.
    Other,
}

/// Side of the subject.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// The subject's left.
    Left,
    /// The subject's right.
    Right,
}

/// Who said where the axes lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AxesSource {
    /// A person, by an origin and points on the axes.
    Points,
    /// A person, by landmarks.
    Landmarks,
    /// The program, from the shape alone: a proposal.
    Shape,
}

/// A figure that axes were made from; model coordinates, mm.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "figure")]
pub enum AxesFeature {
    /// A place.
    Point {
        /// What it is.
        name: String,
        /// Where it is.
        at_mm: [f64; 3],
    },
    /// A straight line between two places.
    Line {
        /// What it is.
        name: String,
        /// Where it begins.
        from_mm: [f64; 3],
        /// Where it ends.
        to_mm: [f64; 3],
    },
    /// A sphere that was fitted.
    Sphere {
        /// What it is.
        name: String,
        /// Its centre.
        centre_mm: [f64; 3],
        /// Its radius.
        radius_mm: f64,
    },
    /// A cylinder that was fitted, between the centres of its ends.
    Cylinder {
        /// What it is.
        name: String,
        /// Centre of one end.
        from_mm: [f64; 3],
        /// Centre of the other.
        to_mm: [f64; 3],
        /// Its radius.
        radius_mm: f64,
    },
    /// A plane that was fitted, shown as a disc.
    Plane {
        /// What it is.
        name: String,
        /// Middle of the disc.
        centre_mm: [f64; 3],
        /// Unit normal.
        normal: [f64; 3],
        /// Radius of the disc.
        radius_mm: f64,
    },
}

impl Content for BodyAxes {
    const KIND: &'static str = "body axes";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        hash_encoded::<Self>(&self.encode())
    }
}

impl Artifact for BodyAxes {
    const EXTENSION: &'static str = "json";
    fn encode(&self) -> Vec<u8> {
        encode_json(self)
    }
    fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
        decode_json(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn round_trip_is_exact_and_names_count() {
        let axes = BodyAxes {
            origin_mm: [0.1, 0.2, 0.3],
            axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            body: BodyKind::FemoralComponent,
            side: Side::Left,
            source: AxesSource::Shape,
            features: vec![AxesFeature::Plane {
                name: "middle".to_owned(),
                centre_mm: [1.0 / 3.0, 0.0, 0.0],
                normal: [0.0, 0.0, 1.0],
                radius_mm: 20.0,
            }],
            warnings: vec!["look".to_owned()],
        };
        let bytes = axes.encode();
        assert_eq!(BodyAxes::decode(&bytes), Ok(axes));
        assert!(BodyAxes::decode(&bytes[..40]).is_err());
        let at = |name: &str| Landmarks(vec![Landmark { name: name.to_owned(), at_mm: [1.0, 2.0, 3.0] }]);
        assert_ne!(at("a").content_hash(), at("b").content_hash());
    }
}
