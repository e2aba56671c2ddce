//! Local coordinate systems of bones and implants: **x anterior, y up (proximal), z to the subject's right**, right-handed, for left
//! and right bodies alike (ISB: Wu et al., J. Biomech. 35 (2002) 543; the knee's axes: Grood and Suntay, J. Biomech. Eng. 105
//! (1983) 136).
//!
//! Three ways lead to the same [`BodyAxes`](biplane_artifact::BodyAxes), and a person's always wins: an origin and points on the
//! axes (Bingham 2006); landmarks by name ([`landmark_names`]); a proposal from the shape alone. A proposal is made of the same
//! landmarks, so what a person gives takes the place of what the shape says, one by one, and the rest is filled in, with a warning.
//!
//! A left body is mirrored, treated as a right one, and its axes are mirrored back; so there is one method for both. The shape is
//! looked at in its own frame (centroid and principal axes), so a proposal turns with the mesh.
//!
//! **Guaranteed:** axes are orthonormal and right-handed; the same input gives the same axes; whatever is not taken from a person
//! is said in the warnings where it is doubtful, and everything a proposal rests on is in `features`. **Measured** by this
//! crate's tests (`cargo test -p biplane-axes -- --nocapture` shows the figures).
//!
//! **Not guaranteed:** that a proposal is what an anatomist would say. It is a start that wants a look.

mod condyles;
mod femoral_component;
mod femur;
mod figures;
mod frame;
mod head;
mod landmarks;
mod moments;
mod patella;
mod points;
mod proposal;
mod section;
mod shaft;
mod shape;
mod stage;
mod symmetry;
mod tibia;
mod tray;

pub use landmarks::landmark_names;
pub use stage::{Axes, AxesError, AxesInputs, AxesParams, ModelFrame, body_axes};
