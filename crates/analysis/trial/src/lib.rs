//! The poses of one body over the frames of a trial: where a frame's neighbours say the body is, which frames do not go with theirs, and the most
//! probable motion through them all (the stage `smooth`).
//!
//! All on the rotation group and the path of the body's centroid: no angle of any sequence is interpolated, so nothing happens at a gimbal's
//! lock or where an angle passes 180 degrees.
//!
//! **Guaranteed:** the same poses give the same answer, whatever frame the laboratory has. **Not guaranteed:** that poses which agree are right.

mod jumps;
mod motion;
mod smooth;
mod stage;

pub use jumps::{JumpParams, Jumps, jumps};
pub use motion::{Predicted, Timed, predict};
pub use smooth::{Measured, smooth};
pub use stage::{Smooth, SmoothError, SmoothInputs, SmoothParams, SmoothSettings};
