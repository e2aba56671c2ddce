//! A mesh as a surface in space: what is near it, what crosses it, and what is wrong with it.
//!
//! [`MeshCheck`] says what keeps a mesh from being a closed, oriented two-manifold, [`Surface`] is its triangles in a tree of
//! boxes, for closest points, signed distances, winding numbers and pairs of triangles that cross, and [`distances`] and
//! [`farthest`] compare two surfaces, [`Surface::apart`] says how far two posed ones are apart. [`Edges`] is the mesh's adjacency, made by counting and without a hash.
//!
//! **Guaranteed:** the same result on every run; whether triangles cross, and on which side of a surface a point lies along a
//! ray, is decided exactly, by floating point where its error bound allows and by exact expansions where not. **Not
//! guaranteed:** anything for coordinates beyond 1e100 mm or differences below 1e-100 mm.

mod apart;
mod beam;
mod check;
mod closest;
mod crossing;
mod cut_end;
mod distances;
mod edges;
mod farthest;
mod overlay;
mod predicates;
mod self_crossing;
mod side;
mod tree;

pub use apart::Apart;
pub use check::MeshCheck;
pub use closest::Closest;
pub use cut_end::cut_ends;
pub use distances::{Spread, distances, spread_points};
pub use edges::Edges;
pub use farthest::{Farthest, farthest};
pub use tree::Surface;
