//! The stage `contour`: which edges of a picture belong to the outline of a posed body.
//!
//! Curves depend on the picture alone; here the projected model chooses among them. At every sample of the visible outline the edges of
//! each curve near it are compared: an edge must run as the outline does, be bright on the outer side (for a dark body), and lie at the
//! distance at which the edges of this body lie as a whole (their inset). The nearest wins, and stretches of curves that win are
//! the body's contour: what a person looks at and edits. So the outline of the femur does not run along the tibia, a bead or the
//! intensifier's border.
//!
//! Where a second curve could be meant as well, or no edge is found, nothing is guessed: it is counted, and beyond a limit the
//! frame is flagged for a person.
//!
//! **Guaranteed:** every piece is a stretch of one curve, trusted from its first to its last point; no edge is in two pieces.
//! **Not guaranteed:** that a pose which is wrong by more than `reach_px` finds its edges.

mod choose;
mod stage;

pub use choose::choose;
pub use stage::{ContourError, ContourInputs, ContourOf, ContourParams, Contrast};
