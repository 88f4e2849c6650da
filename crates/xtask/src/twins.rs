//! `cargo xtask twins`: the twins of the kernels. The crate `twins` writes them; it needs a parser of shaders, and this one has
//! no dependencies.

use std::path::Path;
use std::process::{Command, ExitCode};

/// Writes the twins.
pub fn run(root: &Path) -> ExitCode {
    let mut command = Command::new(env!("CARGO"));
    command.args(["run", "--release", "--quiet", "--package", "twins"]).current_dir(root);
    match command.status() {
        Ok(status) if status.success() => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("cargo run: {error}");
            ExitCode::FAILURE
        }
    }
}
