//! How long the correction of a picture takes.

fn main() {}
