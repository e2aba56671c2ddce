//! The program `biplane`: from two X-ray videos, their calibrations and meshes to poses.
//!
//! [`study`] reads and checks `pipeline.toml`, [`prepare`] lists what there is to do, [`run`] does it through the
//! [`steps`] of the method and writes [`results`] and [`report`], [`look`] says what would be done and why. [`cli`] is
//! the command line.

pub mod calibrate;
pub mod cli;
pub mod compare;
pub mod config;
pub mod convert;
pub mod correct;
pub mod diagnostics;
pub mod doctor;
pub mod drawings;
pub mod edit;
pub mod edit_list;
pub mod edits;
pub mod exchange;
pub mod exports;
pub mod init;
pub mod joints;
pub mod logging;
pub mod look;
pub mod made;
pub mod models;
pub mod outcome;
pub mod overlay;
pub mod prepare;
pub mod reference;
pub mod report;
pub mod results;
pub mod run;
pub mod slices;
pub mod smoothing;
pub mod sources;
pub mod starts;
pub mod steps;
pub mod study;
pub mod summary;
pub mod tables;
pub mod tracking;
pub mod walk;
