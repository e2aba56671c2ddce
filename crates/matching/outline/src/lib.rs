//! The outline of a mesh seen from an X-ray source: its exact rim, and the part of it that bounds the shadow.
//!
//! **Rim.** An edge of the mesh is on the rim where the faces that look at the source and those that look away meet, or
//! where the surface ends. Projected, the rim is the apparent contour.
//!
//! **Outline.** Orient each rim edge as the boundary of the front faces: the winding number of the projected rim about a
//! pixel is then the number of front faces over that pixel (the boundary of a sum of triangles, each counted once, so
//! this holds for any set of triangles: open, with several bodies, or badly wound). The same for the back faces. A rim
//! point is on the outline where the pixel just beside it is under no face at all. Crossings are counted along image
//! rows in bins, so the whole outline costs little more than the rim. Holes of the shadow have outlines too.
//!
//! **Cut ends.** Where a volume was cut, a bone's model ends and the bone does not: [`RimWithoutCutEnds`] has no outline there.
//!
//! **Grid outline.** [`GridOutline`] is the thesis's own outline of a cloud of points; it knows no triangles.
//!
//! **Guaranteed:** [`Outline`] is that of the union of the projected triangles, exactly, up to the sampling along edges
//! ([`Sampling::step_px`]); nothing is allocated per evaluation once the buffers have grown. **Not guaranteed:** that
//! the triangles are the body. They lie inside a convex surface by up to `edge^2 / 8 R`.

mod grid;
mod rim;
mod tree;
mod visible;

pub use grid::GridOutline;
pub use rim::{RimMesh, RimWithoutCutEnds};
pub use visible::{Outline, OutlinePoint, Sampling};
