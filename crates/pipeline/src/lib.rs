//! The program `biplane`: from two X-ray videos, their calibrations and meshes to poses.

pub mod config;
pub mod diagnostics;
pub mod logging;
pub mod look;
pub mod outcome;
pub mod prepare;
pub mod reference;
pub mod report;
pub mod results;
pub mod run;
pub mod sources;
pub mod starts;
pub mod steps;
pub mod study;
pub mod summary;
pub mod tables;
