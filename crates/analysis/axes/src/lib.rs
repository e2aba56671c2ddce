//! Local coordinate systems of bones and implants.
