//! Known truth: what a laboratory would record of bodies whose shape and pose are known exactly.
//!
//! Bodies are solids given by functions ([`Solid`]); from the same function come their meshes of any density, their ideal
//! outlines and, through the finest mesh, their X-ray pictures. Fluoroscopes are given as a laboratory would measure them
//! ([`TrueFluoroscope`]). Nothing here uses the code of the product that is measured with it: projection, outlines and
//! distortion are written anew, so that a fault there shows.
//!
//! **Guaranteed:** truth is apart from what spoils a picture (blur, noise, distortion); the same seed gives the same
//! bytes. **Not guaranteed:** that real X-rays have nothing else in them.

mod blur;
mod distortion;
mod exposure;
mod fluoroscope;
mod material;
mod mri;
mod raster;
mod scene;
mod slice_grid;
mod solid;
mod transmission;

pub use distortion::IntensifierDistortion;
pub use exposure::{Exposure, picture};
pub use fluoroscope::{TrueFluoroscope, biplane};
pub use material::Material;
pub use mri::{MriFaults, MriScene, ScannedBone, SliceStack, TissueLevels};
pub use scene::{Absorber, Ellipsoid, PosedBody, Scene, Surface};
pub use slice_grid::{GridError, Scanner, SliceGrid};
pub use solid::{Ball, Solid, gradient};
pub use transmission::{PictureError, Transmission};
