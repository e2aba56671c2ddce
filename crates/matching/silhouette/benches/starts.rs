//! How long starts without a guess take: `cargo bench -p biplane-silhouette`.
fn main() {}
