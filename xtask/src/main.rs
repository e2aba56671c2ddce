//! `cargo xtask COMMAND`: thin, calls the crates.
//!
//! `cargo xtask run pipeline.toml` is `biplane run pipeline.toml`; every other command of the program passes through too.

use std::ffi::OsString;
use std::process::ExitCode;

fn main() -> ExitCode {
    // Commands of this tool alone are matched here, before the program's.
    let arguments = std::env::args_os().skip(1);
    biplane::cli::main(std::iter::once(OsString::from("cargo xtask")).chain(arguments))
}
