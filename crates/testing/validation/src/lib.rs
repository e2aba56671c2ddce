//! Measures the product against truth or references it did not make: its own stages, on scenes with known poses, from
//! seeded starts. Accuracy is a distribution: median, 95 %, worst, and what failed.

mod checks;
mod document;
pub mod elsewhere;
pub mod plot;
mod relative;
mod scene;
mod starts;
mod summary;
mod table;

pub use checks::{Check, Limits, STARTS, knee, real_knee};
pub use document::{Plot, Section, write};
pub use relative::{noise, seen_from};
pub use scene::{Claim, Made, Origin, Posed, Scene, SceneError, read_body, read_reference};
pub use starts::{Attempt, StartOffset, attempts, set_a, turned};
pub use summary::{Distribution, Summary};
pub use table::{Budgets, Cell, Column, Hold, Limit, Row, Spread, Table};
