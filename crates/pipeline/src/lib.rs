//! The program `biplane`: from two X-ray videos, their calibrations and meshes to poses.

pub mod config;
pub mod diagnostics;
pub mod reference;
pub mod study;
pub mod tables;
