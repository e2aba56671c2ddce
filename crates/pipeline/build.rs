//! Gives the program the hash of its own code: what its readers made is read again when they change.

fn main() {
    biplane_code_hash::emit();
}
