//! The stage `environment`: from the beads in the pictures of all views to their sources and detectors.
//!
//! The thesis's "environment recreation" (Bingham 2006, 2.2.3): spots are taken to ideal pixels, named as beads of the list
//! (without a person, or with a few clicks), solved linearly, then by least squares over all views and all placings of the frame.
//! **Held:** the size of a pixel on the detector; the distance of the source is found. The two trade against each other, since only their
//! ratio, the focal length in pixels, makes a picture.
//!
//! **Guaranteed:** the same input gives the same bytes; the covariance is that of the noise found in the residuals. **Not in it:**
//! errors of the bead list that all views share, and of the size of a pixel: one of 1 % makes the distance wrong by 1 %.

mod adjust;
mod clicks;
mod error;
mod estimate;
mod find;
mod judge;
mod label;
mod linear;
mod region;
mod search;
mod stage;
mod triangulate;
mod view;

pub use error::EnvironmentError;
pub use find::find_environment;
pub use region::{SourceRegion, covariance_of_point, source_covariance, source_region};
pub use stage::{EnvironmentInputs, EnvironmentParams, FindEnvironment};
