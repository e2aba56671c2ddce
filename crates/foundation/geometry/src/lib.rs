//! The nouns of the method: frames, poses, meshes, edge curves. No files, no serialisation, no algorithm of a stage.
//!
//! Units are millimetres and radians; image coordinates are pixels, with the **centre of the first pixel at (0, 0)**,
//! x to the right along a row and y down the columns of the picture as it is stored. `docs/conventions.md` says all of
//! it in one place, and names the test of each.

mod curve;
mod mesh;
mod pose;

pub use curve::{Curve, EdgePoint};
pub use mesh::{Mesh, MeshError, Topology};
pub use pose::{Model, Pose, PoseError, Rigid, Twist, World};

/// A point in space, mm.
pub type Point3 = nalgebra::Point3<f64>;
/// A vector in space, mm unless a name says otherwise.
pub type Vector3 = nalgebra::Vector3<f64>;
/// A point in an image, px (centre of the first pixel at (0, 0)).
pub type Point2 = nalgebra::Point2<f64>;
/// A vector in an image, px.
pub type Vector2 = nalgebra::Vector2<f64>;
