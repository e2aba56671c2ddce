//! The stage `distortion`: from the spots of a plate's picture to the map from recorded to ideal pixels.

mod affine;
mod correct;
mod coverage;
mod gauge;
mod held_out;
mod lattice;
mod local_weighted_mean;
mod model;
mod nearby;
mod pattern;
mod plate_fit;
mod polynomial;
mod reach;
mod recognise;
mod stage;
mod table;
mod tilt;

pub use correct::{Interpolation, Remap, RemapError};
pub use model::{FitError, Fitted, fit};
pub use pattern::PatternError;
pub use plate_fit::fit_plate;
pub use recognise::RecogniseError;
pub use stage::{DistortionError, DistortionInputs, DistortionParams, FitDistortion, Model};
pub use table::Sampled;
