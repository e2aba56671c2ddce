//! Bones in the slices of volumes: from an MRI, a CT or a map of labels to contours, with what a person drew in place of some.
//!
//! `slices/<bone>` finds the contours, `slice_edits/<bone>` puts drawn ones in the place of those of their slices, `drawing/slices/<bone>`
//! shows them to people. They hang on no frame and no frame on them: a fault in one stops no other.

pub mod command;
pub mod drawn;
pub mod edited;
pub mod list;
pub mod run;
pub mod section;
pub mod table;
pub mod walk;

use biplane_artifact::{ContourSlice, SliceFlag};

/// The folder in `edits/` and in the results that is theirs.
pub const SLICES: &str = "slices";

/// A flag as people read it.
pub fn words(flag: SliceFlag) -> &'static str {
    match flag {
        SliceFlag::Jumped => "jumped",
        SliceFlag::Lost => "lost",
        SliceFlag::TouchesBorder => "touches the border",
        SliceFlag::CutOff => "cut off",
        SliceFlag::Unclear => "unclear",
        SliceFlag::SeedOutside => "seed outside",
    }
}

/// Why a slice wants to be looked at; empty where it does not.
pub fn flags_of(slice: &ContourSlice) -> String {
    slice.flags.iter().map(|f| words(*f)).collect::<Vec<_>>().join(", ")
}
