//! Reads what a laboratory has - images, calibrations, meshes, volumes - and pairs the frames of its views.
//!
//! Everything is told apart by what a file holds, not by its name. What comes out are the artifacts of
//! `biplane-artifact`: frames in which larger is brighter, calibrations whose pixels have the centre of the first one at
//! (0, 0), meshes in mm. What a file claims about its own size is checked against its length before memory is taken for
//! it. Of a DICOM header only what describes the pixels is kept: no value that names a patient is stored, reported or
//! logged.

pub mod beads;
pub mod calibration;
pub mod edits;
pub mod frames;
pub mod images;
pub mod inspect;
pub mod landmarks;
pub mod meshes;
mod places;
pub mod plates;
pub mod poses;
pub mod volumes;
