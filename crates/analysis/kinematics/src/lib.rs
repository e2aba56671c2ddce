//! From the poses of two bodies to the kinematics of their joint.
//!
//! **Joint coordinates** ([`joint_values`]): the angles and translations of Grood and Suntay ("A joint coordinate system for the clinical description of
//! three-dimensional motions", 1983; ISB: Wu et al. 2002), right and left, or any of the twelve sequences of three turns. Each with its
//! covariance, by exact derivatives, from those of the two poses.
//!
//! **Finite helical axis** ([`helical_axis`]) between two relative poses, **resampling by an angle** ([`by_angle`]), and unwrapped angles ([`unwrap`]).
//!
//! The stage `joint` ([`Joint`]) does it for one joint in one frame, with how far the surfaces are apart and how deep they are in each other.
//!
//! **Guaranteed:** the values do not depend on the laboratory's frame. **Not guaranteed:** that a body's axes lie where an anatomist would lay them.

mod convention;
mod helical;
mod joint;
mod series;
mod stage;

pub use convention::{Convention, Sequence};
pub use helical::{HelicalAxis, helical_axis};
pub use joint::{Frame, JointValues, joint_values};
pub use series::{Crossing, by_angle, unwrap};
pub use stage::{Joint, JointError, JointInputs, JointParams};
