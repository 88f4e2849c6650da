//! The licenses of the crates that are linked into a package, as one text, which lies beside all that a release uploads.

use crate::workspace::{cargo, output};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::{Error, Result};
use std::path::Path;

/// The name of the file with the text.
pub const FILE: &str = "LICENSES-OF-DEPENDENCIES.txt";

/// Names of files with licenses begin so.
const BEGINNINGS: [&str; 5] = ["license", "licence", "copying", "notice", "unlicense"];

/// The target of what this machine runs.
pub const HOST: &str = "host-tuple";

/// Writes the licenses of what is linked into packages that are built together for a target, with more features than their
/// own, into a folder.
pub fn write(root: &Path, packages: &[&str], features: &[&str], target: &str, folder: &Path) -> Result<()> {
    let mut metadata = cargo(root, "metadata --format-version 1 --locked --filter-platform");
    let metadata: Value = serde_json::from_str(&output(metadata.arg(target))?)?;
    let mut crates = BTreeMap::new();
    for package in metadata["packages"].as_array().into_iter().flatten() {
        let text = |field: &str| package[field].as_str().unwrap_or_default();
        // Ours have no source.
        if package["source"].is_string() {
            crates.insert(format!("{} v{}", text("name"), text("version")), package);
        }
    }
    let linked = linked(root, packages, features, target)?;
    let texts = texts(linked.iter().filter_map(|name| Some((name.as_str(), *crates.get(name)?))))?;
    fs::create_dir_all(folder)?;
    fs::write(folder.join(FILE), texts)
}

/// The crates in the tree of these packages, as `NAME vVERSION`.
fn linked(root: &Path, packages: &[&str], features: &[&str], target: &str) -> Result<BTreeSet<String>> {
    // Crates of builds and tests are not linked. What macros write is.
    let mut tree = cargo(root, "tree --locked --edges normal --prefix none --format {p} --target");
    tree.arg(target).args(packages.iter().flat_map(|package| ["--package", package]));
    tree.args(features.iter().flat_map(|feature| ["--features", feature]));
    let words = |line: &str| line.split(' ').take(2).collect::<Vec<_>>().join(" ");
    Ok(output(&mut tree)?.lines().map(words).collect())
}

/// One text of the licenses of all crates; a license that several have stands there once.
fn texts<'a>(crates: impl Iterator<Item = (&'a str, &'a Value)>) -> Result<String> {
    let mut texts: Vec<(String, Vec<String>)> = Vec::new();
    let mut without = String::new();
    for (name, package) in crates {
        let title = format!("{name}: {}", package["license"].as_str().unwrap_or("see below"));
        let manifest = Path::new(package["manifest_path"].as_str().unwrap_or_default());
        let found = of_folder(manifest.parent().unwrap_or(manifest))?;
        if found.is_empty() {
            without += &format!("  {title}\n");
        }
        for text in found {
            match texts.iter_mut().find(|(other, _)| *other == text) {
                Some((_, titles)) if titles.last() == Some(&title) => {}
                Some((_, titles)) => titles.push(title.clone()),
                None => texts.push((text, vec![title.clone()])),
            }
        }
    }
    if texts.is_empty() {
        return Err(Error::other(
            "no crate that is linked has a license: the sources of the registry are absent",
        ));
    }
    let mut all = format!(
        "Licenses of the crates that are linked into this program.\n\n\
         These carry no text of their own; that of their license stands at others:\n{without}\n"
    );
    for (text, titles) in texts {
        all += &format!("{}\n{}\n\n{text}\n", "=".repeat(80), titles.join("\n"));
    }
    Ok(all)
}

/// The texts of the files with licenses in a folder.
fn of_folder(folder: &Path) -> Result<Vec<String>> {
    let mut files = fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>>>()?;
    files.retain(|file| {
        let name = file.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
        file.is_file() && BEGINNINGS.iter().any(|beginning| name.starts_with(beginning))
    });
    files.sort();
    files.iter().map(|file| Ok(String::from_utf8_lossy(&fs::read(file)?).replace("\r\n", "\n"))).collect()
}
