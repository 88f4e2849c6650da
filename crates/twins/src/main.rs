//! The twins of the kernels, written from the text of the shaders.
//!
//! `cargo xtask twins` writes `crates/gpu/src/kernels`; a test fails where that isn't what the shaders say. This crate does not
//! depend on the one that it writes for, which may not compile before.
//!
//! | module | holds |
//! |---|---|
//! | `kernel`, `file` | a kernel; its file |
//! | `body` | that of a function |
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
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What a shader that needs shared parts begins with: their names follow.
const PARTS: &str = "// Parts: ";

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn kernel(shaders: &Path, name: &str) -> Kernel {
    let text = read(&shaders.join(format!("{name}.wgsl")));
    let first = text.lines().next().unwrap_or_default();
    let parts = first.strip_prefix(PARTS).map(|parts| parts.trim_end_matches('.').split(", "));
    let parts: Vec<String> =
        std::iter::once("dispatch").chain(parts.into_iter().flatten()).map(str::to_owned).collect();
    let shared = |part: &String| read(&shaders.join("shared").join(format!("{part}.wgsl")));
    let source: String = parts.iter().map(shared).chain([text.clone()]).collect();
    Kernel::new(name, parts, &source)
}

/// The list of all kernels.
fn list(names: &[String]) -> String {
    let mut out = String::from(
        "//! The kernels, each with its table entry and its twin.\n//!\n\
         //! Written from `shader/` by `cargo xtask twins`: change those files, not these.\n\n",
    );
    for name in names {
        let _ = writeln!(out, "pub mod {name};");
    }
    out.push('\n');
    for name in names {
        let _ = writeln!(out, "pub use {name}::STAGE as {};", name.to_uppercase());
    }
    let _ = writeln!(
        out,
        "\n/// All of them.\n#[cfg(test)]\npub static ALL: &[&crate::stages::Stage] = &[{}];",
        names.iter().map(|name| format!("&{}", name.to_uppercase())).collect::<Vec<_>>().join(", ")
    );
    out
}

/// All files by their names without an ending.
fn files(shaders: &Path) -> Vec<(String, String)> {
    let found = fs::read_dir(shaders).unwrap_or_else(|error| panic!("{}: {error}", shaders.display()));
    let mut names: Vec<String> = found
        .map(|entry| entry.expect("an entry of a folder").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "wgsl"))
        .filter_map(|path| path.file_stem().map(|stem| stem.to_string_lossy().into_owned()))
        .collect();
    names.sort();
    let twins = names.iter().map(|name| (name.clone(), kernel(shaders, name).file()));
    twins.chain([("mod".to_owned(), list(&names))]).collect()
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
