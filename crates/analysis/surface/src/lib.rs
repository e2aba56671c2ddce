//! A mesh as a surface in space.
