//! Measures the product against truth or references it did not make: its own stages, on scenes with known poses, from
//! seeded starts. Accuracy is a distribution: median, 95 %, worst, and what failed.

mod bead_scenes;
mod bound;
mod calibrated;
mod document;
pub mod elsewhere;
mod faults;
mod goals;
pub mod knee;
pub mod lab;
mod many_outlines;
pub mod outcome;
pub mod pictures;
mod plates;
pub mod plot;
mod relative;
mod scene;
pub mod sections;
mod setups;
mod simulated_calibration;
pub mod sliced;
mod starts;
pub mod summary;
mod table;
pub mod thesis;
mod true_outline;

pub use document::{Plot, Section, put, readme, write};
pub use lab::{Effort, Lab};
pub use relative::{noise, seen_from};
pub use scene::{Claim, Made, Origin, Posed, Scene, SceneError, read_body, read_reference};
pub use starts::{GaussianOffset, SET_A, SET_B, STARTS, StartOffset, offset_by, set_a, turned};
pub use summary::Distribution;
pub use table::{Budgets, Cell, Column, Hold, Limit, Row, Spread, Table};
