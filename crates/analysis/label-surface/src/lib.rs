//! A map of labels to a closed mesh: the boundary of one label, smooth below the size of a voxel.
//!
//! The label's voxels are cut out ([`Keep`] says which of their pieces), smoothed by a kernel that keeps curved surfaces where they
//! are, and surface nets are laid through the field on an even lattice, at the level at which the volume is that of the voxels.
//! Where the label ends with the volume the surface is closed by a flat lid.
//!
//! **Guaranteed:** closed, oriented outward, two-manifold, the same bytes on every run; crossings of the surface with itself are
//! looked for and reported. **Measured** by this crate's tests: see `tests/accuracy.rs`.
//!
//! **Not guaranteed:** that slices much thicker than their pixels are followed well. A surface that runs along them shows their
//! stairs, since no voxel says where between two slices it lies: lofting their contours does better there.

mod faults;
mod field;
mod net;
mod parts;
mod stack;
mod stage;

pub use stage::{
    Keep, LabelSurface, LabelSurfaceError, LabelSurfaceInputs, LabelSurfaceParams, label_surface,
};
