//! `cargo xtask dist`: what a release uploads, in one folder.
//!
//! Cargo builds with the profile `shipped`, without symbols and with paths that are those of no machine, so that the same
//! sources and compiler give the same bytes. `crates/xtask/dist/pack.py` writes archives whose times and owners are fixed,
//! tries them, and writes their checksums.

use crate::workspace::{cargo, succeed, target_folder};
use crate::{blender, bowknot, licenses, nightly, web, wheel};
use std::fs;
use std::io::{Error, Result};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// The command and the libraries for C. They are built together: what is linked into one may be in the other.
const PACKAGES: [&str; 2] = ["bowknot-cli", "bowknot-capi"];

/// Shells that completions are written for, and the names of the scripts.
const SHELLS: [(&str, &str); 4] =
    [("bash", "bowknot.bash"), ("zsh", "_bowknot"), ("fish", "bowknot.fish"), ("powershell", "_bowknot.ps1")];

/// What is packed.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Parts {
    /// All that a release uploads.
    All,
    /// The command and the libraries for C.
    Programs,
    /// What the steps of CI have built, in the release profile, with symbols.
    Built,
}

/// Builds and packs, and tries what is packed.
pub fn run(root: &Path, parts: Parts) -> ExitCode {
    match build(root, &target_folder(root), parts) {
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

fn build(root: &Path, target: &Path, what: Parts) -> Result<PathBuf> {
    let (out, parts) = (target.join("dist"), target.join("xtask/dist"));
    for folder in [&out, &parts] {
        if folder.exists() {
            fs::remove_dir_all(folder)?;
        }
        fs::create_dir_all(folder)?;
    }
    let mut command = bowknot::path(target);
    if what != Parts::Built {
        let mut build = cargo(root, "build --profile shipped --locked");
        build.args(PACKAGES.iter().flat_map(|package| ["--package", package]));
        succeed(build.env("CARGO_ENCODED_RUSTFLAGS", remapped(root)))?;
        command = target.join("shipped").join(command.file_name().unwrap_or_default());
    }
    pages(&command, &parts)?;
    licenses::write(root, &PACKAGES, &[], licenses::HOST, &parts)?;
    let mut pack = Command::new("python3");
    pack.arg(root.join("crates/xtask/dist/pack.py")).args(["--version", env!("CARGO_PKG_VERSION")]);
    pack.arg("--target").arg(target).arg("--out").arg(&out);
    match what {
        Parts::All => {
            let threads = nightly::has_sources(root);
            if !threads {
                println!(
                    "==> no module with threads: it needs the nightly compiler with the component rust-src"
                );
            }
            web::build(root, target, web::Options { quick: false, threads })?;
            // With the wheel, which it builds.
            let extension = blender::pack_and_test(root, target, Vec::new(), false)?;
            pack.arg("--others").arg("--blender").arg(extension);
        }
        Parts::Programs => {}
        Parts::Built => {
            let extension = blender::pack_and_test(root, target, vec![wheel::newest(target)?], false)?;
            pack.args(["--built", "--others", "--blender"]).arg(extension);
        }
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
