//! The virtual fluoroscope: a source and an intensifier, and what they do to a point.
//!
//! A laboratory point `X` (mm) appears at the ideal pixel `(x, y)` with `w (x, y, 1) = M (X - v)`, where `v` is the
//! source and `w` the depth along the detector's normal in mm: the thesis's Eq. 3.3 (Bingham 2006) with the detector's
//! pixels written into `M`. Ideal pixels are those of a picture without distortion; [`Distortion`] maps between them and
//! the pixels that were recorded, both ways. Pixels have the centre of the first one at (0, 0), x right, y down.
//!
//! Guaranteed: the derivatives of [`Fluoroscope::project_with_derivative`] (by the point) and of [`Fluoroscope::pixel_by_placement`]
//! (by where source and detector stand) are exact (tests compare them with finite differences), and `Distortion::recorded` undoes `Distortion::ideal` to 1e-9 px wherever it gives an answer.

mod distortion;
mod placement;
mod projection;

pub use distortion::Distortion;
pub use projection::{Fluoroscope, Projection};
