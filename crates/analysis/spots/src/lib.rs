//! The stage `spots`: the round spots of a calibration picture, to a fraction of a pixel.

mod stage;

pub use stage::{FindSpots, Look, SpotError, SpotInputs, SpotParams, SpotSettings, find_spots};
