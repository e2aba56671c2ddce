//! Contours of a bone's slices to the closed surface of the bone.
//!
//! Two methods. `distance`, the default: slices are signed distances in their planes, these are interpolated across the
//! slices, and where the interpolated distance is zero lies the surface (shape-based interpolation: Raya and Udupa 1990; Herman,
//! Zheng and Bucholtz 1992). Branchings, holes and their openings come out of it by themselves; contours that begin and end
//! are closed as their shape suggests. `diagonal`, the thesis's `assembleMesh` (Bingham 2006, A.1.2): points of neighbouring
//! contours joined by the shorter diagonal, one contour a slice.
//!
//! **Guaranteed** for `distance`, whatever the contours: a closed, oriented two-manifold; the same bytes on every run; the checks of
//! [`loft`] find no crossing triangles, since what would cross is taken back (otherwise a fault says so). **Measured** by this crate's
//! tests: with spacing in plane and across the slices refined together, the error on smooth bodies falls with their square.
//! **Not guaranteed:** what no slice shows. Where a bone ends between two slices, how contours far apart belong together, and
//! anything smaller than a cell of the grid is an estimate; what was left out for its size is said.

mod cells;
mod diagonal;
mod distance;
mod dome;
mod faults;
mod finish;
mod gap;
mod layer;
mod lid;
mod links;
mod march;
mod plane;
mod self_crossing;
mod smooth;
mod stack;
mod stage;

pub use stage::{Caps, Loft, LoftError, LoftInputs, LoftParams, Method, loft, surface_of};
