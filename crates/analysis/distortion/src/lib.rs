//! The stage `distortion`: from the spots of a plate's picture to the map from recorded to ideal pixels.

mod stage;

pub use stage::{DistortionError, DistortionInputs, DistortionParams, FitDistortion, Model, fit_plate};
