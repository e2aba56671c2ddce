//! The program `biplane`; everything is in [`biplane::cli`].

fn main() -> std::process::ExitCode {
    biplane::cli::main(std::env::args_os())
}
