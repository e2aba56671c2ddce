//! Measures the product against truth or references it did not make: its own stages, on scenes with known poses, from
//! seeded starts. Accuracy is a distribution: median, 95 %, worst, and what failed.

mod scene;
mod starts;
mod summary;

pub use scene::{Scene, SceneError, SceneFiles, ViewFiles};
pub use starts::{Attempt, StartOffset, attempts};
pub use summary::{Distribution, Summary};
