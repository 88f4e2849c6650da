//! The twins of the kernels, written from the text of the shaders.
//!
//! `cargo xtask twins` writes `crates/gpu/src/kernels`; a test fails where that isn't what the shaders say.
//! This crate does not depend on the one that it writes for, which may not compile before.
//!
//! | module | holds |
//! |---|---|
//! | `kernel`, `file` | a kernel; its file |
//! | `body` | that of a function: its expressions, places, statements, and regions between waits |
//! | `scopes` | where its variables are declared |
//! | `uniform` | what is the same for all threads of a workgroup |
//! | `flow` | walks over statements |
//! | `math`, `types`, `names` | operators, types and names in Rust |

// A command for people: printing is what it does.
#![allow(clippy::print_stdout)]

mod body;
mod file;
mod flow;
mod kernel;
mod math;
mod names;
mod scopes;
mod types;
mod uniform;

use kernel::Kernel;
use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What a shader that needs shared parts begins with: their names follow.
const PARTS: &str = "// Parts: ";

/// The folder of the shared parts; all others hold kernels.
const SHARED: &str = "shared";

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The kernel in `FOLDER/NAME.wgsl`.
fn kernel(shaders: &Path, folder: &str, name: &str) -> Kernel {
    let text = read(&shaders.join(folder).join(format!("{name}.wgsl")));
    let first = text.lines().next().unwrap_or_default();
    let parts = first.strip_prefix(PARTS).map(|parts| parts.trim_end_matches('.').split(", "));
    let parts: Vec<String> =
        std::iter::once("dispatch").chain(parts.into_iter().flatten()).map(str::to_owned).collect();
    let shared = |part: &String| read(&shaders.join(SHARED).join(format!("{part}.wgsl")));
    let source: String = parts.iter().map(shared).chain([text.clone()]).collect();
    Kernel::new(folder, name, parts, &source)
}

/// The list of all kernels, by folder.
fn list(shaders: &[(String, String)]) -> String {
    let mut out = String::from(
        "//! The kernels, each with its table entry and its twin.\n//!\n\
         //! Written from `shader/` by `cargo xtask twins`: change those files, not these.\n\n",
    );
    let mut folder = "";
    for (next, name) in shaders {
        if next != folder {
            let _ = writeln!(out, "{}// shader/{next}", if folder.is_empty() { "" } else { "\n" });
            folder = next;
        }
        let _ = writeln!(out, "pub mod {name};");
    }
    out.push('\n');
    for (_, name) in shaders {
        let _ = writeln!(out, "pub use {name}::STAGE as {};", name.to_uppercase());
    }
    let _ = writeln!(
        out,
        "\n/// All of them.\n#[cfg(test)]\npub static ALL: &[&crate::stages::Stage] = &[{}];",
        shaders.iter().map(|(_, name)| format!("&{}", name.to_uppercase())).collect::<Vec<_>>().join(", ")
    );
    out
}

/// Paths of what is in a folder, sorted.
fn entries(folder: &Path) -> Vec<PathBuf> {
    let found = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<PathBuf> = found.map(|entry| entry.expect("an entry of a folder").path()).collect();
    paths.sort();
    paths
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// Folder and name of each kernel. A name says which one it is without its folder.
fn kernels(shaders: &Path) -> Vec<(String, String)> {
    let folders = entries(shaders).into_iter().filter(|path| !path.ends_with(SHARED));
    let folders = folders.inspect(|path| assert!(path.is_dir(), "{}: in no folder", path.display()));
    let of_folder = |folder: PathBuf| {
        let files = entries(&folder).into_iter();
        files
            .filter(|path| path.extension().is_some_and(|e| e == "wgsl"))
            .map(move |p| (stem(&folder), stem(&p)))
    };
    let found: Vec<(String, String)> = folders.flat_map(of_folder).collect();
    let mut names = BTreeSet::new();
    for (folder, name) in &found {
        assert!(names.insert(name), "{folder}/{name}.wgsl: another folder has a kernel of this name");
    }
    found
}

/// All files by their names without an ending.
fn files(shaders: &Path) -> Vec<(String, String)> {
    let kernels = kernels(shaders);
    let twins = kernels.iter().map(|(folder, name)| (name.clone(), kernel(shaders, folder, name).file()));
    twins.chain([("mod".to_owned(), list(&kernels))]).collect()
}

/// Where the crate of the kernels is.
fn gpu() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../gpu")
}

fn main() -> ExitCode {
    let files = files(&gpu().join("shader"));
    let folder = gpu().join("src/kernels");
    let write = || {
        if folder.exists() {
            fs::remove_dir_all(&folder)?;
        }
        fs::create_dir_all(&folder)?;
        files.iter().try_for_each(|(name, text)| fs::write(folder.join(format!("{name}.rs")), text))
    };
    match write() {
        Ok(()) => {
            println!("wrote {} files to crates/gpu/src/kernels", files.len());
            ExitCode::SUCCESS
        }
        Err(error) => {
            println!("{}: {error}", folder.display());
            ExitCode::FAILURE
        }
    }
}

#[test]
fn twins_are_what_the_shaders_say() {
    let folder = gpu().join("src/kernels");
    let expected = files(&gpu().join("shader"));
    for (name, text) in &expected {
        let path = folder.join(format!("{name}.rs"));
        assert!(
            read(&path) == *text,
            "{} is not what the shader says: run `cargo xtask twins`",
            path.display()
        );
    }
    let found = fs::read_dir(&folder).expect("twins").count();
    assert_eq!(
        found,
        expected.len(),
        "src/kernels has files of kernels that are gone: run `cargo xtask twins`"
    );
}
