//! The sections of `docs/validation.md`, in its order: what `cargo xtask validate` measures.

mod agreement;
mod anywhere;
mod bias;
mod capture;
mod coverage;
mod distortion;
mod edges;
mod end_to_end;
mod environment;
mod ideal;
mod missing;
mod models;
mod moved;
mod natural;
mod one_view;
mod peers;
mod random;
mod spheres;
mod studies;
mod sweeps;
mod views;

use crate::plot::PlotError;
use crate::{Lab, SceneError, Section};

/// Why a section could not be measured.
#[derive(Debug, thiserror::Error)]
pub enum SectionError {
    /// A scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A plot.
    #[error(transparent)]
    Plot(#[from] PlotError),
}

/// A section's name on the command line, and what measures it; `None` where what it needs is not here.
pub type Measure = fn(&Lab) -> Result<Option<Section>, SectionError>;

/// All of them.
pub const ALL: &[(&str, Measure)] = &[
    ("ideal", ideal::measure),
    ("random", random::measure),
    ("capture", capture::measure),
    ("anywhere", anywhere::measure),
    ("peers", peers::measure),
    ("natural", natural::measure),
    ("spheres", spheres::measure),
    ("moved", moved::measure),
    ("views", views::measure),
    ("one-view", one_view::measure),
    ("distortion", distortion::measure),
    ("environment", environment::measure),
    ("edges", edges::measure),
    ("models", models::measure),
    ("end-to-end", end_to_end::measure),
    ("budget", end_to_end::budget),
    ("bias", bias::measure),
    ("sweeps", sweeps::measure),
    ("missing", missing::measure),
    ("coverage", coverage::measure),
    ("simulated", studies::simulated),
    ("far", studies::far),
    ("agreement", agreement::measure),
    ("real", studies::real),
];
