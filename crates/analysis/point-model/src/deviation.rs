//! How far a model is from what it was made of, and what that means for its silhouette.
//!
//! If each of two surfaces lies within `d` of the other, then so do their shadows: a ray that meets the one passes the other within
//! `d`, and the projection of a point that is `d` away is at most `d` times the magnification away (measured at the body's place;
//! a detector sees it magnified). So the shadow of either, grown by that much, covers the shadow of the other. What is guaranteed is
//! the shadow, as a set: a gap of the shadow narrower than `2 d` may close or open.

use biplane_geometry::Mesh;
use biplane_surface::{Farthest, Surface, farthest};

/// How far two surfaces are from each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation {
    /// The farthest point of the model from the original.
    pub of_model: Farthest,
    /// The farthest point of the original from the model.
    pub of_original: Farthest,
}

impl Deviation {
    /// Between a model and its original, each to within `tolerance_mm`.
    pub fn between(model: &Mesh, original: &Mesh, tolerance_mm: f64) -> Self {
        Self::with_tree(model, original, &Surface::new(original), tolerance_mm)
    }

    /// The same, with the original's tree.
    pub fn with_tree(model: &Mesh, original: &Mesh, tree: &Surface, tolerance_mm: f64) -> Self {
        Self {
            of_model: farthest(model, tree, tolerance_mm),
            of_original: farthest(original, &Surface::new(model), tolerance_mm),
        }
    }

    /// No silhouette of the model differs from the original's by more than this, mm in the body's plane: never less than the
    /// largest distance, and at most the tolerance more.
    pub fn silhouette_mm(&self) -> f64 {
        self.of_model.at_most_mm.max(self.of_original.at_most_mm)
    }
}
