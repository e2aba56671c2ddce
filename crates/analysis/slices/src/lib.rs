//! Slices of a volume, MRI, CT or labels, to the contours of bones in the scanner's millimetres.

mod blur;
mod bone;
mod distance;
mod evenly;
mod grow;
mod labels;
mod levels;
mod marching;
mod replace;
mod review;
mod ring;
mod shell;
mod stack;
mod stage;
mod turn;

pub use replace::{ReplaceError, replace};
pub use stage::{Contrast, Method, Slices, SlicesError, SlicesInputs, SlicesParams, slice_contours};
pub use turn::{Across, turned};
