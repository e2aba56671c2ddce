//! A frame of beads at known places, and the fluoroscopes that its pictures show.

use serde::{Deserialize, Serialize};

use crate::calibration::feed_distortion;
use crate::content::{decode_json, encode_json, hash_encoded};
use crate::{
    Artifact, Content, ContentHash, ContentHasher, DecodeError, DistortionTable, PoseRecord, Verdict,
};

/// The beads of a frame; their coordinates are the laboratory's.
#[derive(Debug, Clone, PartialEq)]
pub struct BeadList(pub Vec<Bead>);

/// One bead.
#[derive(Debug, Clone, PartialEq)]
pub struct Bead {
    /// Its name or number, for people.
    pub name: String,
    /// Its centre, mm.
    pub at_mm: [f64; 3],
    /// Its radius, mm, if known.
    pub radius_mm: Option<f64>,
    /// It is one of a few by which the frame is recognised: larger than the others, or named as reference.
    pub mark: bool,
}

impl Content for BeadList {
    const KIND: &'static str = "bead-list";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        let mut h = ContentHasher::new(Self::KIND, Self::SCHEMA);
        for Bead { name, at_mm, radius_mm, mark } in &self.0 {
            h.text(name).float(radius_mm.unwrap_or(f64::NAN)).unsigned(u64::from(*mark));
            for v in at_mm {
                h.float(*v);
            }
        }
        h.finish()
    }
}

/// Beads that a person named in the pictures of one view.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BeadClicks(pub Vec<BeadClick>);

/// One of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeadClick {
    /// Which view, by its place.
    pub view: usize,
    /// Which picture of the view, from 0.
    pub picture: usize,
    /// Which bead, by its place in the list.
    pub bead: usize,
    /// About where it is, recorded px.
    pub at_px: [f64; 2],
}

impl Content for BeadClicks {
    const KIND: &'static str = "bead-clicks";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        let mut h = ContentHasher::new(Self::KIND, Self::SCHEMA);
        for BeadClick { view, picture, bead, at_px } in &self.0 {
            h.unsigned(*view as u64).unsigned(*picture as u64).unsigned(*bead as u64);
            h.float(at_px[0]).float(at_px[1]);
        }
        h.finish()
    }
}

/// What is known of one view's detector before its place is: how its recorded pixels become ideal ones, and their size.
#[derive(Debug, Clone, PartialEq)]
pub struct Detector {
    /// The view's name in the study.
    pub view: String,
    /// Columns and rows of its pictures.
    pub size: [usize; 2],
    /// Side of an ideal pixel on the detector, mm; it is held, the source's distance is found.
    pub pixel_mm: f64,
    /// Recorded to ideal pixels; none if the pictures are corrected.
    pub distortion: Option<DistortionTable>,
}

impl Content for Detector {
    const KIND: &'static str = "detector";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        let Self { view, size, pixel_mm, distortion } = self;
        let mut h = ContentHasher::new(Self::KIND, Self::SCHEMA);
        h.text(view).unsigned(size[0] as u64).unsigned(size[1] as u64).float(*pixel_mm);
        feed_distortion(&mut h, distortion.as_ref());
        h.finish()
    }
}

/// The fluoroscopes in the frame of the beads: the recreated environment of the thesis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Environment {
    /// In the order of the study's views.
    pub views: Vec<ViewEnvironment>,
    /// Where the frame of beads stood in each set of pictures, `world_from_beads`; the first is the world itself.
    pub bead_frames: Vec<PoseRecord>,
    /// Angle between the central rays of the first two views, degrees; none with one view.
    pub angle_deg: Option<f64>,
    /// Every bead seen in at least two views, found from calibrations that were made without it.
    pub triangulated: Vec<TriangulatedBead>,
    /// Root mean square length of their errors, mm; none with one view.
    pub triangulation_rms_mm: Option<f64>,
    /// Covariance of all views' parameters, 9 a view, view by view: source x, y, z (mm); middle of the detector x, y, z
    /// (mm); rotation of the detector about its middle x, y, z (rad), all along laboratory axes. The size of a pixel is held.
    /// From the residuals; the beads' places count as exact.
    pub covariance: Vec<Vec<f64>>,
    /// Whether the limits of pipeline.toml are kept.
    pub verdict: Verdict,
    /// Why not, and what else is worth a look, for people.
    pub warnings: Vec<String>,
}

/// One fluoroscope, found from beads.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ViewEnvironment {
    /// The view's name in the study.
    pub view: String,
    /// Columns and rows of its pictures.
    pub size: [usize; 2],
    /// Side of an ideal pixel on the detector, mm: held, not found.
    pub pixel_mm: f64,
    /// The X-ray source, mm.
    pub source: [f64; 3],
    /// Middle of the detector: the place of ideal pixel `((width - 1) / 2, (height - 1) / 2)`, mm.
    pub centre: [f64; 3],
    /// Unit vector along which ideal `x` grows.
    pub along_x: [f64; 3],
    /// Unit vector along which ideal `y` grows, at a right angle to `along_x`.
    pub along_y: [f64; 3],
    /// `M` of `w (x, y, 1) = M (X - source)`, rows scaled so that `w` is the depth in mm.
    pub matrix: [[f64; 3]; 3],
    /// Distance of the source from the detector's plane, mm.
    pub source_to_detector_mm: f64,
    /// Root mean square length of the residuals of the beads used, ideal px.
    pub reprojection_rms_px: f64,
    /// Estimated standard deviation of each coordinate of a bead's centre, px.
    pub sigma_px: f64,
    /// Beads found, of all pictures of the view.
    pub beads: Vec<SeenBead>,
    /// Spots that are no bead, recorded px, and which picture of the view they are in.
    pub strays: Vec<(usize, [f64; 2])>,
    /// Beads of the list that were not found: picture of the view, place in the list, and where they should be, recorded px.
    pub missing: Vec<(usize, usize, [f64; 2])>,
}

/// A bead in a picture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SeenBead {
    /// Which picture of the view, from 0.
    pub picture: usize,
    /// Its place in the list.
    pub bead: usize,
    /// Its name in the list.
    pub name: String,
    /// Where it was found, recorded px.
    pub at_px: [f64; 2],
    /// Where it was found less where the fluoroscope has it, ideal px.
    pub residual_px: [f64; 2],
    /// Whether the fit uses it; one that lies far off, or is cut, is left out.
    pub used: bool,
}

/// A bead found again from two or more views.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TriangulatedBead {
    /// Which set of pictures, from 0.
    pub picture: usize,
    /// Its place in the list.
    pub bead: usize,
    /// Its name in the list.
    pub name: String,
    /// Where it was found less where the list has it, mm, in the frame of the beads.
    pub error_mm: [f64; 3],
}

impl Content for Environment {
    const KIND: &'static str = "environment";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        hash_encoded::<Self>(&self.encode())
    }
}

impl Artifact for Environment {
    const EXTENSION: &'static str = "json";
    fn encode(&self) -> Vec<u8> {
        encode_json(self)
    }
    fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
        decode_json(bytes)
    }
}
