//! A body's surface, and where its match starts.

use biplane_geometry::{Mesh, Pose};

use crate::content::hash_encoded;
use crate::{Artifact, Content, ContentHash, ContentHasher, DecodeError, ply};

/// A body's mesh in model coordinates, mm, wound outward where it is closed.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelMesh(pub Mesh);

impl Content for ModelMesh {
    const KIND: &'static str = "model";
    const SCHEMA: u32 = 2;
    fn content_hash(&self) -> ContentHash {
        hash_encoded::<Self>(&self.encode())
    }
}

impl Artifact for ModelMesh {
    const EXTENSION: &'static str = "ply";
    fn encode(&self) -> Vec<u8> {
        ply::encode(&self.0, "biplane model, mm, model frame")
    }
    fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
        ply::decode(bytes).map(|(mesh, _)| Self(mesh)).map_err(DecodeError::of::<Self>)
    }
}

/// The pose a match starts from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Start(pub Pose);

impl Content for Start {
    const KIND: &'static str = "start";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        let Self(pose) = self;
        let mut h = ContentHasher::new(Self::KIND, Self::SCHEMA);
        for v in pose.translation().iter().chain(pose.rotation().as_ref().coords.iter()) {
            h.float(*v);
        }
        h.finish()
    }
}

/// Where the frames beside it say a body is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prediction {
    /// `world_from_model`.
    pub pose: Pose,
    /// How far the mesh's centroid may be from there, mm.
    pub within_mm: f64,
    /// How far the body may be turned from there, rad.
    pub within_rad: f64,
}

impl Content for Prediction {
    const KIND: &'static str = "prediction";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        let Self { pose, within_mm, within_rad } = self;
        let mut h = ContentHasher::new(Self::KIND, Self::SCHEMA);
        for v in pose.translation().iter().chain(pose.rotation().as_ref().coords.iter()) {
            h.float(*v);
        }
        h.float(*within_mm).float(*within_rad);
        h.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_geometry::Point3;

    fn tetrahedron() -> Mesh {
        let at = [[0.0, 0.0, 0.1], [1.0, 0.0, -0.0], [0.0, 1.0, 1e-300], [0.0, 0.0, 1.0]];
        let vertices = at.map(|[x, y, z]| Point3::new(x, y, z)).to_vec();
        Mesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap()
    }

    #[test]
    fn a_mesh_comes_back_with_every_bit_and_damage_is_found() {
        let model = ModelMesh(tetrahedron());
        let bytes = model.encode();
        let back = ModelMesh::decode(&bytes).unwrap();
        assert_eq!(back.encode(), bytes);
        assert_eq!(back, model);
        for cut in 0..bytes.len() {
            assert!(ModelMesh::decode(&bytes[..cut]).is_err(), "cut at {cut}");
        }
        let text = String::from_utf8_lossy(&bytes[..180]).replace("vertex 4", "vertex 9");
        let claimed = [text.as_bytes(), &bytes[180..]].concat();
        assert!(ModelMesh::decode(&claimed).is_err());
    }
}
