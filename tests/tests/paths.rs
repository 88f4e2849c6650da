//! Every path that the documentation names exists.

use crate::layers::root;
use std::path::{Path, PathBuf};

/// Beginnings of the paths that are checked between backticks.
const TOPS: [&str; 5] = ["crates/", "assets/", "docs/", "tests/", ".ci/"];

/// All Markdown files, Rust files and manifests of the repository.
fn documents() -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![root()];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(&folder).into_iter().flatten().flatten() {
            let path = entry.path();
            let name = entry.file_name();
            let name = name.to_string_lossy();
            if path.is_dir() {
                if !matches!(name.as_ref(), "target" | "out" | ".git") {
                    open.push(path);
                }
            } else if matches!(path.extension().and_then(|e| e.to_str()), Some("md" | "rs"))
                || name == "Cargo.toml"
            {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The texts between single backticks on one line.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.lines().flat_map(|line| line.split('`').skip(1).step_by(2))
}

/// Targets of Markdown links, `[..](target)`.
fn linked(text: &str) -> impl Iterator<Item = &str> {
    text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target)
}

/// Whether a path exists, from the root or from one of the folders above the document.
fn exists(document: &Path, path: &str) -> bool {
    let top = root();
    document
        .ancestors()
        .skip(1)
        .take_while(|folder| folder.starts_with(&top))
        .any(|folder| folder.join(path).exists())
}

fn missing(document: &Path, text: &str) -> Vec<String> {
    let is_markdown = document.extension().is_some_and(|extension| extension == "md");
    let mut missing = Vec::new();
    for path in quoted(text) {
        // Patterns, placeholders and commands are not paths.
        let plain =
            path.chars().all(|c| c.is_ascii_alphanumeric() || "/._-".contains(c)) && !path.contains("..");
        if plain && TOPS.iter().any(|top| path.starts_with(top)) && !exists(document, path) {
            missing.push(path.to_owned());
        }
    }
    if is_markdown {
        let folder = document.parent().unwrap_or(document);
        for link in linked(text) {
            let path = link.split('#').next().unwrap_or_default();
            let elsewhere = path.is_empty() || path.contains("://") || path.starts_with("mailto:");
            if !elsewhere && !folder.join(path).exists() {
                missing.push(link.to_owned());
            }
        }
    }
    missing
}

#[test]
fn named_paths_exist() {
    let mut faults = Vec::new();
    let documents = documents();
    for document in &documents {
        let text = std::fs::read_to_string(document).unwrap_or_default();
        let shown = document.strip_prefix(root()).unwrap_or(document).display().to_string();
        faults.extend(missing(document, &text).into_iter().map(|path| format!("{shown} names {path}")));
    }
    assert!(documents.len() > 20, "only {} documents were found", documents.len());
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The rule itself can fail.
#[test]
fn missing_paths_are_seen() {
    let document = root().join("docs/page.md");
    let there = "`crates/geometry`, [geometry](../crates/geometry), `crates/*`, [site](https://example.org)";
    assert!(missing(&document, there).is_empty());
    // In parts, so that this file does not name them itself.
    let gone = ["`crates", "/gone` [one](gone.md#part) `docs", "/gone.md` `cargo run`"].concat();
    assert_eq!(missing(&document, &gone), ["crates/gone", "docs/gone.md", "gone.md#part"]);
}
