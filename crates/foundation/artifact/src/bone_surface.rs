//! The surface of a bone as it was made from slices or labels, and what was found out about it on the way.

use biplane_geometry::Mesh;
use serde::{Deserialize, Serialize};

use crate::content::hash_encoded;
use crate::{Artifact, Content, ContentHash, DecodeError, ply};

/// A surface made from the slices of a volume, in the scanner's frame: mm, left-posterior-superior. Stored as a PLY file whose
/// one comment is the report.
#[derive(Debug, Clone, PartialEq)]
pub struct BoneSurface {
    /// Wound outward where it is closed.
    pub mesh: Mesh,
    /// How it was made and what is wrong with it.
    pub report: SurfaceReport,
}

/// How a surface was made, its sizes, and what is wrong with it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SurfaceReport {
    /// The method, as in pipeline.toml.
    pub method: String,
    /// Slices that have contours of the bone (or voxels of the label), and contours in them.
    pub slices: usize,
    /// Contours that the surface goes through; 0 for labels.
    pub contours: usize,
    /// Enclosed volume, mm^3.
    pub volume_mm3: f64,
    /// Enclosed volume before the surface was smoothed, mm^3; the same where it was not.
    pub unsmoothed_volume_mm3: f64,
    /// Surface area, mm^2.
    pub area_mm2: f64,
    /// Pieces connected through edges.
    pub pieces: usize,
    /// What keeps it from being a closed, oriented, two-manifold surface without self-intersection, each with its slice.
    pub faults: Vec<SurfaceFault>,
    /// What else a person should know.
    pub warnings: Vec<String>,
}

/// Something wrong with a surface.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SurfaceFault {
    /// Number of the slice beside it (the one below, where it lies between two), if it can be told.
    pub slice: Option<usize>,
    /// What is wrong, in words.
    pub what: String,
}

impl Content for BoneSurface {
    const KIND: &'static str = "bone surface";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        hash_encoded::<Self>(&self.encode())
    }
}

impl Artifact for BoneSurface {
    const EXTENSION: &'static str = "ply";
    fn encode(&self) -> Vec<u8> {
        // A struct of numbers and texts always has a JSON form, and JSON on one line has no line break.
        let report = serde_json::to_string(&self.report).unwrap_or_default();
        ply::encode(&self.mesh, &report)
    }
    fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
        let (mesh, comment) = ply::decode(bytes).map_err(DecodeError::of::<Self>)?;
        let report = serde_json::from_str(&comment).map_err(DecodeError::of::<Self>)?;
        Ok(Self { mesh, report })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_geometry::Point3;

    #[test]
    fn round_trip_keeps_the_report() {
        let vertices =
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(|[x, y, z]| Point3::new(x, y, z));
        let fault = SurfaceFault { slice: Some(3), what: "open\nalong \"4\" edges".to_owned() };
        let report = SurfaceReport {
            method: "distance".to_owned(),
            volume_mm3: 0.1 + 0.2,
            faults: vec![fault],
            ..SurfaceReport::default()
        };
        let surface = BoneSurface { mesh: Mesh::new(vertices.to_vec(), vec![[0, 1, 2]]).unwrap(), report };
        let bytes = surface.encode();
        assert_eq!(BoneSurface::decode(&bytes), Ok(surface));
        assert!(BoneSurface::decode(&bytes[..60]).is_err());
    }
}
