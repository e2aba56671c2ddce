//! The program as its users meet it: run on a study made on the spot.
#![allow(clippy::unwrap_used)]

mod calibration;
mod compare;
mod edits;
mod exports;
mod messages;
mod models;
mod report;
mod scene;
mod slices;
mod study;
mod tracking;
