//! The stage `distortion`: from the spots of a plate's picture to the map from recorded to ideal pixels.

mod affine;
mod held_out;
mod lattice;
mod local_weighted_mean;
mod model;
mod nearby;
mod pattern;
mod polynomial;
mod reach;
mod recognise;
mod stage;
mod table;

pub use model::{FitError, Fitted, fit};
pub use stage::{DistortionError, DistortionInputs, DistortionParams, FitDistortion, Model, fit_plate};
pub use table::Sampled;
