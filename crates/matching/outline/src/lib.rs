//! The outline of a mesh seen from an X-ray source: its rim, and the part of it that bounds the shadow.
//!
//! **Rim.** Where what looks at the source and what looks away meet, or the surface ends: on the curved surface that the triangles are a sample
//! of ([`RimMesh::new`]), or on the triangles as they are ([`RimMesh::flat`]). Projected, the rim is the apparent contour.
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
//! **Guaranteed:** the outline of a [`RimMesh::flat`] is that of the union of the projected triangles, exactly, up to the sampling along edges
//! ([`Sampling::step_px`]); nothing is allocated per evaluation once the buffers have grown. **Not guaranteed:** that a mesh is the body.
//! Triangles lie inside a convex surface by up to `edge^2 / 8 R`, which the curved rim takes out but for a higher order; where its lifted
//! points do not close to a twentieth of a pixel, it may show pinholes within the shadow.

mod grid;
mod rim;
mod symmetry;
mod tree;
mod visible;

pub use grid::GridOutline;
pub use rim::{RimMesh, RimWithoutCutEnds};
pub use visible::{Outline, OutlinePoint, Sampling};
