//! Slices of a volume, MRI, CT or labels, to the contours of bones in the scanner's millimetres.
//!
//! Three ways lead to the same [`SliceContours`](biplane_artifact::SliceContours): the boundary of one number of a map of
//! labels; the outside of the cortical shell around one seed in the marrow of an MRI or CT; a person's contours of a slice in
//! the place of those ([`replace()`]).
//!
//! **Guaranteed:** contours are closed, and those of a bone found from a seed move to its edges only as far as they do not
//! cross themselves; those of a label pass between the centres of voxels inside and outside; the same input gives the same
//! contours. **Measured** by this crate's tests (`cargo test -p biplane-slices -- --nocapture` shows the figures): with the
//! phantom's faults 0.05 mm rms of a bone's surface in 1 mm slices and 0.20 mm in 3 mm slices, 0.07 to 0.13 pixels of a label's.
//!
//! **Not guaranteed:** that a contour is right where a bone touches what is as dark as its shell (tendon, meniscus), where its
//! marrow is as bright as fat beside a shell with holes, or where a slice lies along the surface. Much of that is flagged; all of
//! it wants a look.

mod blur;
mod bone;
mod distance;
mod evenly;
mod grow;
mod labels;
mod levels;
mod marching;
mod placing;
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
