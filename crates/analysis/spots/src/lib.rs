//! The stage `spots`: the round spots of a calibration picture, to a fraction of a pixel.
//!
//! The round border of an intensifier is found and taken out (module `border`); places that may be spots are maxima over place and scale
//! (module `candidates`); a soft-edged ellipse is fitted to the picture at each (module `fit`), and what is no spot falls out (module `find`).

mod border;
mod candidates;
mod cells;
mod find;
mod fit;
mod ground;
mod noise;
mod profile;
mod stage;
mod window;

pub use find::{find_border, find_spots};
pub use stage::{FindSpots, Look, SpotError, SpotInputs, SpotParams, SpotSettings};
