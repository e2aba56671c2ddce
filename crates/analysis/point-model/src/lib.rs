//! Meshes to point models.
