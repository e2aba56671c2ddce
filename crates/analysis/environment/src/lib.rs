//! The stage `environment`: from the beads in the pictures of all views to their sources and detectors.

mod stage;

pub use stage::{EnvironmentError, EnvironmentInputs, EnvironmentParams, FindEnvironment, find_environment};
