//! The nightly compiler, for what the pinned one cannot do.

use std::path::Path;
use std::process::{Command, Stdio};

/// Nightly's cargo in the workspace's root. Through rustup: within `cargo xtask` the variable CARGO names the
/// pinned compiler's cargo, which knows no `+`.
pub fn cargo(root: &Path) -> Command {
    let mut command = Command::new("rustup");
    command.current_dir(root).args(["run", "nightly", "cargo"]);
    // What the build of this command passes on belongs to another compiler.
    ["RUSTC", "RUSTDOC", "CARGO", "RUSTUP_TOOLCHAIN"].iter().for_each(|name| {
        command.env_remove(name);
    });
    command
}

/// Whether there is one.
pub fn is_installed(root: &Path) -> bool {
    let status = cargo(root).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    status.is_ok_and(|status| status.success())
}

/// Whether there are the sources of its standard library.
pub fn has_sources(root: &Path) -> bool {
    let mut rustc = Command::new("rustup");
    rustc.current_dir(root).args(["run", "nightly", "rustc", "--print", "sysroot"]);
    let output = rustc.output().map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned());
    output.is_ok_and(|sysroot| Path::new(&sysroot).join("lib/rustlib/src/rust/library/Cargo.lock").exists())
}
