//! The program `biplane`: from two X-ray videos, their calibrations and meshes to poses.

pub mod config;
pub mod diagnostics;
pub mod outcome;
pub mod reference;
pub mod report;
pub mod results;
pub mod sources;
pub mod starts;
pub mod study;
pub mod tables;
