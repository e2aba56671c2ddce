//! What stages hand to each other: one file a kind, each with a schema number. No algorithm lives here.
//!
//! [`Content`] is anything whose bytes can be hashed: it may come from a laboratory's file (a frame, a calibration, a
//! mesh) and never be stored. [`Artifact`] is content that a stage made and the store keeps: it can be written to bytes
//! and read back. Both say their kind and schema number, which go into the cache key of whatever reads them.

mod body_axes;
mod bone_surface;
mod calibration;
mod content;
mod contour;
mod curves;
mod drawing;
mod environment;
mod frame;
mod joint;
mod matched;
mod model;
mod npy;
mod picture;
mod plate;
mod ply;
mod report_frame;
mod slice_contours;
mod smoothed;
mod spots;
mod volume;

pub use body_axes::{AxesFeature, AxesSource, BodyAxes, BodyKind, Landmark, Landmarks, Side};
pub use bone_surface::{BoneSurface, SurfaceFault, SurfaceReport};
pub use calibration::{Calibration, CalibrationUncertainty, DistortionTable, PixelOrigin};
pub use content::{Artifact, Content, ContentHash, ContentHasher, DecodeError};
pub use contour::{Contour, ContourPiece, EditedContour, EditedPiece};
pub use curves::Curves;
pub use drawing::Drawing;
pub use environment::{
    Bead, BeadClick, BeadClicks, BeadList, Detector, Environment, SeenBead, TriangulatedBead, ViewEnvironment,
};
pub use frame::Frame;
pub use joint::JointPose;
pub use matched::{Alternative, Match, PoseRecord, StartsTried, Verdict, ViewFit};
pub use model::{ModelMesh, Prediction, Start};
pub use picture::Picture;
pub use plate::{MatchedSpot, ModelScore, PlateClick, PlateClicks, PlateFit, PlatePattern, PlateSpot};
pub use report_frame::ReportFrame;
pub use slice_contours::{ContourSlice, SliceContour, SliceContours, SliceFlag, SlicePoint};
pub use smoothed::{SmoothedPose, SmoothedTrial};
pub use spots::{Circle, Spot, Spots};
pub use volume::Volume;
