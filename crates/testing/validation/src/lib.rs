//! Measures the product against truth or references it did not make: its own stages, on scenes with known poses, from
//! seeded starts. Accuracy is a distribution: median, 95 %, worst, and what failed.

mod checks;
mod relative;
mod scene;
mod starts;
mod summary;

pub use checks::{Check, Limits, STARTS, knee, real_knee};
pub use relative::{noise, seen_from};
pub use scene::{Posed, Scene, SceneError, read_body, read_reference};
pub use starts::{Attempt, StartOffset, attempts, turned};
pub use summary::{Distribution, Summary};
