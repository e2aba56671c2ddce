//! Meshes to point models: as many points as asked for, evenly spread or as the shape asks for, and a bound on what that moves.
//!
//! The stage [`Model`] samples a surface evenly ([`even_points`], which the thesis's grid outline needs) or simplifies it
//! ([`simplified`], nearer to the shape with as many points), keeps sharp edges and rims, and lays the result out for the matcher's
//! loops ([`laid_out`]). [`Evenness`] and [`Deviation`] measure it.
//!
//! **Guaranteed:** a closed two-manifold stays one; an open mesh keeps its rims; faults of a mesh stay as they are and make nothing
//! panic; [`Deviation::silhouette_mm`] bounds the difference of every silhouette; the same result on every run.

mod deviation;
mod even;
mod evenness;
mod half_edges;
mod layout;
mod lines;
mod simplify;
mod stage;

pub use deviation::Deviation;
pub use evenness::Evenness;
pub use layout::laid_out;
pub use stage::{
    Method, Model, ModelError, ModelInputs, ModelParams, even_points, fewest, point_model, simplified,
};
