//! `cargo xtask publish`: the packages that a release uploads to crates.io, compiled from what is in them alone.
//!
//! `cargo publish --workspace --dry-run` compiles each package in a folder of its own, together with all that it
//! depends on. Here they are members of one workspace with the profiles, the lock file and the target folder of this
//! one, so that other people's crates are there already.

use crate::workspace::{cargo, output, succeed, target_folder};
use serde_json::Value;
use std::fs;
use std::io::Result;
use std::path::Path;
use std::process::{Command, ExitCode};

/// Packs every public crate and compiles the packages.
pub fn run(root: &Path) -> ExitCode {
    match build(root, &target_folder(root)) {
        Ok(count) => {
            println!("{count} packages compile from what is in them");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn build(root: &Path, target: &Path) -> Result<usize> {
    let packages = public(root)?;
    let mut package = cargo(root, "package --quiet --no-verify --allow-dirty");
    package.args(packages.iter().flat_map(|(name, _)| ["--package", name]));
    succeed(&mut package)?;
    let folder = target.join("xtask/publish");
    if folder.exists() {
        fs::remove_dir_all(&folder)?;
    }
    fs::create_dir_all(&folder)?;
    let mut members = String::new();
    for (name, version) in &packages {
        let member = format!("{name}-{version}");
        // Archives have times of long ago, by which Cargo would not see that a file has changed: `m` leaves them out.
        let archive = target.join("package").join(format!("{member}.crate"));
        succeed(Command::new("tar").arg("-xmzf").arg(archive).arg("-C").arg(&folder))?;
        members += &format!("{name} = {{ path = \"{member}\" }}\n");
    }
    let own = fs::read_to_string(root.join("Cargo.toml"))?;
    let profiles = own.find("[profile.").map_or("", |start| &own[start..]);
    let manifest = format!(
        "[workspace]\nresolver = \"3\"\nmembers = [\"*-*\"]\n\n[patch.crates-io]\n{members}\n{profiles}"
    );
    fs::write(folder.join("Cargo.toml"), manifest)?;
    fs::copy(root.join("Cargo.lock"), folder.join("Cargo.lock"))?;
    succeed(cargo(&folder, "check --release --workspace").env("CARGO_TARGET_DIR", target))?;
    Ok(packages.len())
}

/// Names and versions of the crates that are published.
fn public(root: &Path) -> Result<Vec<(String, String)>> {
    let metadata = output(&mut cargo(root, "metadata --format-version 1 --no-deps --locked"))?;
    let metadata: Value = serde_json::from_str(&metadata)?;
    let packages = metadata["packages"].as_array().into_iter().flatten();
    // Those that may go to no registry have an empty list of them.
    let public = packages.filter(|package| package["publish"].is_null());
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    Ok(public.map(|package| (text(&package["name"]), text(&package["version"]))).collect())
}
