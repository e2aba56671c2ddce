//! A body's surface, and where its match starts.

use biplane_geometry::{Mesh, Pose};

use crate::{Content, ContentHash, ContentHasher};

/// A body's mesh in model coordinates, mm, wound outward where it is closed.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelMesh(pub Mesh);

impl Content for ModelMesh {
    const KIND: &'static str = "model";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        let Self(mesh) = self;
        let mut bytes = Vec::with_capacity(mesh.vertices().len() * 24 + mesh.triangles().len() * 12);
        bytes.extend(
            mesh.vertices().iter().flat_map(|v| [v.x, v.y, v.z]).flat_map(|c| c.to_bits().to_le_bytes()),
        );
        bytes.extend(mesh.triangles().iter().flatten().flat_map(|v| v.to_le_bytes()));
        ContentHasher::new(Self::KIND, Self::SCHEMA)
            .unsigned(mesh.vertices().len() as u64)
            .unsigned(mesh.triangles().len() as u64)
            .bytes(&bytes)
            .finish()
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
