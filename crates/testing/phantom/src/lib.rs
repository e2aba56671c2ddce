//! Known truth: what a laboratory would record of bodies whose shape and pose are known exactly.
//!
//! Bodies are solids given by functions ([`Solid`]); from the same function come their meshes of any density, their ideal
//! outlines and, through the finest mesh, their X-ray pictures. Fluoroscopes are given as a laboratory would measure them
//! ([`TrueFluoroscope`]). Nothing here uses the code of the product that is measured with it: projection, outlines and
//! distortion are written anew, so that a fault there shows.
//!
//! **Guaranteed:** truth is apart from what spoils a picture (blur, noise, distortion); the same seed gives the same
//! bytes. **Not guaranteed:** that real X-rays have nothing else in them.

mod bead_frame;
mod blur;
mod bodies;
mod disc;
mod distortion;
mod exposure;
mod fluoroscope;
mod ideal_outline;
mod material;
mod meshing;
mod mri;
mod plate;
mod prism;
mod raster;
mod scene;
mod shadow;
mod shapes;
mod slice_grid;
mod solid;
mod transmission;

pub use bead_frame::{BeadFrame, BeadFrameError, BeadLayout, SeenBead, Tube};
pub use bodies::{Body, DistalFemur, FemoralComponent, Patella, ProximalTibia, TibialTray};
pub use disc::BlurredDisc;
pub use distortion::IntensifierDistortion;
pub use exposure::{Exposure, picture};
pub use fluoroscope::{TrueFluoroscope, biplane};
pub use ideal_outline::ideal_outline;
pub use material::Material;
pub use meshing::{MeshingError, ball_mesh, mesh};
pub use mri::{MriFaults, MriScene, ScannedBone, SliceStack, TissueLevels};
pub use plate::{Plate, PlatePlacement, Scratch, SeenSpot, Spot, SpotKind, SpotPattern, SpotRadii};
pub use scene::{Absorber, Ellipsoid, PosedBody, Scene, Surface};
pub use shadow::{area_centroid, shadow_outline};
pub use slice_grid::{GridError, Scanner, SliceGrid};
pub use solid::{Ball, Solid, gradient};
pub use transmission::{PictureError, Transmission};
