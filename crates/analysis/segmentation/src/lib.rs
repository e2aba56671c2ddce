//! From one frame to its edge curves, to a fraction of a pixel.
//!
//! Canny's detector (Canny 1986; thesis 2.2.2) in floating point, beside the others that the thesis compared: Gaussian smoothing,
//! gradient, the crest of its size across the edge, hysteresis of two thresholds, the crest's place by a parabola through the
//! logarithm of the gradient's size. Points are linked into curves where each chooses the other, small gaps are bridged, and the
//! shrinkage of curved edges is taken out. What belongs to which body is not decided here: **curves depend on the frame alone**.
//!
//! What a person drew in place of an automatic contour becomes curves here too ([`Trace`]).
//!
//! Known bias, left in: at the rim of a smooth X-rayed body the steepest place lies inside the true outline. Its size hangs on
//! the body (`docs/validation.md`), which matching knows.

mod crest;
mod crossing;
mod curved;
mod edges;
mod link;
mod stage;
mod trace;

pub use edges::{EdgeMap, find_edges};
pub use link::link;
pub use stage::{Method, Segment, SegmentError, SegmentInputs, SegmentParams, curves, curves_of, edges_of};
pub use trace::{Trace, TraceError, TraceInputs, TraceParams, traced};
