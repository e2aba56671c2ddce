//! From one frame to its edge curves, to a fraction of a pixel.
//!
//! Canny's detector (Canny 1986; thesis 2.2.2) in floating point: Gaussian smoothing, gradient, the crest of its size
//! across the edge, hysteresis of two thresholds. The crest is placed by a parabola through the logarithm of the
//! gradient's size, which is exact for a straight step edge that was blurred by Gaussians. Crest pixels are linked into
//! curves. What belongs to which body is not decided here: **curves depend on the frame alone**.
//!
//! Known bias, left in: on an edge of radius `R` the crest after smoothing by `s` lies about `s^2 / 2R` towards the centre
//! of curvature (0.01 px for `R` = 50 px and `s` = 1 px), and at the rim of a smooth X-rayed body inside the true outline.

mod edges;
mod link;
mod smooth;
mod stage;

pub use edges::{EdgeMap, find_edges};
pub use link::link;
pub use stage::{Segment, SegmentError, SegmentInputs, SegmentParams, curves};
