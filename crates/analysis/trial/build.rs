//! Puts the hash of this stage's code into its cache key.

fn main() {
    biplane_code_hash::emit();
}
