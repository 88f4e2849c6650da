//! `cargo xtask dist`: what a release uploads, in one folder.
//!
//! Cargo builds with the profile `shipped`, without symbols and with paths that are those of no machine, so that the same
//! sources and compiler give the same bytes. `crates/xtask/dist/pack.py` collects licenses and writes archives whose times
//! and owners are fixed, and their checksums.

use crate::workspace::{cargo, succeed, target_folder};
use crate::{blender, web};
use std::fs;
use std::io::{Error, Result};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Shells that completions are written for, and the names of the scripts.
const SHELLS: [(&str, &str); 4] =
    [("bash", "bowknot.bash"), ("zsh", "_bowknot"), ("fish", "bowknot.fish"), ("powershell", "_bowknot.ps1")];

/// Builds everything, or the archives of the command and of the libraries alone, and tries the command.
pub fn run(root: &Path, check: bool) -> ExitCode {
    match build(root, &target_folder(root), check) {
        Ok(out) => {
            println!("{}", out.display());
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn build(root: &Path, target: &Path, check: bool) -> Result<PathBuf> {
    let (out, parts) = (target.join("dist"), target.join("xtask/dist"));
    for folder in [&out, &parts] {
        if folder.exists() {
            fs::remove_dir_all(folder)?;
        }
        fs::create_dir_all(folder)?;
    }
    let mut build =
        cargo(root, "build --profile shipped --locked --package bowknot-cli --package bowknot-capi");
    succeed(build.env("CARGO_ENCODED_RUSTFLAGS", remapped(root)))?;
    let built = target.join("shipped");
    let command = built.join("bowknot").with_extension(std::env::consts::EXE_EXTENSION);
    pages(&command, &parts)?;
    if !check {
        web::build(root, target)?;
    }
    let mut pack = Command::new("python3");
    pack.arg(root.join("crates/xtask/dist/pack.py")).args(["--version", env!("CARGO_PKG_VERSION")]);
    pack.arg("--target").arg(target).arg("--out").arg(&out);
    if !check {
        // With the wheel, which it builds.
        pack.arg("--blender").arg(blender::pack_and_test(root, target, Vec::new(), false)?);
    }
    succeed(pack.current_dir(root))?;
    Ok(out)
}

/// Completions and manual pages, which the command writes itself.
fn pages(command: &Path, parts: &Path) -> Result<()> {
    let completions = parts.join("completions");
    fs::create_dir_all(&completions)?;
    for (shell, name) in SHELLS {
        let output = Command::new(command).args(["completions", shell]).output()?;
        if !output.status.success() || output.stdout.is_empty() {
            return Err(Error::other(format!("no completions for {shell}")));
        }
        fs::write(completions.join(name), output.stdout)?;
    }
    succeed(Command::new(command).arg("man").arg(parts.join("man")))
}

/// Flags by which the paths in messages are not those of this machine, as Cargo parts them.
fn remapped(root: &Path) -> String {
    let home = std::env::var_os("CARGO_HOME").map(PathBuf::from);
    let home = home.or_else(|| std::env::home_dir().map(|home| home.join(".cargo")));
    let mut flags = format!("--remap-path-prefix={}=bowknot", root.display());
    if let Some(home) = home {
        flags += &format!("\x1f--remap-path-prefix={}=cargo", home.display());
    }
    flags
}
