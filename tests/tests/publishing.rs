//! Each published package is whole: what a registry asks for, its front page and its licenses are inside.

use crate::layers::{folders, manifest, name, our_dependencies, root};
use std::path::{Path, PathBuf};
use std::process::Command;
use toml::{Table, Value};

/// What a registry shows of a package.
const FIELDS: [&str; 7] =
    ["description", "license", "repository", "readme", "keywords", "categories", "rust-version"];

/// Files that every package holds. Licenses are copies of those of the repository, not links: on some systems
/// a checkout turns links into files that hold a path.
const LICENSES: [&str; 2] = ["LICENSE-MIT", "LICENSE-APACHE"];

/// The limits of crates.io.
const MOST_KEYWORDS: usize = 5;
const LONGEST_KEYWORD: usize = 20;

fn is_public(manifest: &Table) -> bool {
    manifest["package"].get("publish").and_then(Value::as_bool) != Some(false)
}

/// The public packages of the workspace: their folders and manifests.
fn public() -> Vec<(PathBuf, Table)> {
    let all = folders(&root().join("crates")).into_iter().map(|folder| {
        let manifest = manifest(&folder);
        (folder, manifest)
    });
    all.filter(|(_, manifest)| is_public(manifest)).collect()
}

/// What the manifest of a public package lacks, and which of its files differ from those of the repository.
fn faults(folder: &Path, manifest: &Table) -> Vec<String> {
    let package = manifest["package"].as_table().expect("a table");
    let absent = FIELDS.iter().filter(|field| !package.contains_key(**field));
    let mut faults: Vec<String> = absent.map(|field| format!("no {field}")).collect();
    if let Some(readme) = package.get("readme").and_then(Value::as_str)
        && !folder.join(readme).exists()
    {
        faults.push(format!("no file {readme}"));
    }
    // Those of the workspace would be the same for every package, and fit none.
    for list in ["keywords", "categories"] {
        let words = package.get(list).and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
        let lengths = words.iter().map(|word| word.as_str().map_or(usize::MAX, str::len));
        let too_long = list == "keywords" && lengths.max().is_some_and(|length| length > LONGEST_KEYWORD);
        if package.contains_key(list) && (words.is_empty() || words.len() > MOST_KEYWORDS || too_long) {
            faults.push(format!("{list} are not 1 to {MOST_KEYWORDS} words of its own"));
        }
    }
    for license in LICENSES {
        let text = |folder: &Path| std::fs::read(folder.join(license)).ok();
        if text(folder).is_none() || text(folder) != text(&root()) {
            faults.push(format!("{license} is not that of the repository"));
        }
    }
    faults
}

#[test]
fn public_packages_have_what_a_registry_asks_for() {
    for (folder, manifest) in public() {
        assert_eq!(faults(&folder, &manifest), Vec::<String>::new(), "{}", folder.display());
    }
}

/// A package can be published only after all that it depends on.
#[test]
fn public_packages_depend_on_public_packages() {
    let public = public();
    let names: Vec<&str> = public.iter().map(|(_, manifest)| name(manifest)).collect();
    assert!(names.contains(&"bowknot") && !names.contains(&"xtask"), "{names:?}");
    let workspace = manifest(&root());
    let versions = workspace["workspace"]["dependencies"].as_table().expect("a table");
    for (_, manifest) in &public {
        for dependency in our_dependencies(manifest) {
            assert!(names.contains(&dependency.as_str()), "{} needs {dependency}", name(manifest));
            assert!(versions[&dependency].get("version").is_some(), "{dependency} has no version");
        }
    }
}

/// What cargo would put in the packages, which is less than what lies in their folders: ignored files are not in
/// it.
#[test]
fn packages_hold_their_front_page_and_licenses() {
    for (folder, manifest) in public() {
        let package = name(&manifest);
        let mut cargo = Command::new(env!("CARGO"));
        cargo.args(["package", "--list", "--allow-dirty", "--offline", "--package", package]);
        let output = cargo.current_dir(&folder).output().expect("cargo starts");
        assert!(output.status.success(), "{package}: {}", String::from_utf8_lossy(&output.stderr));
        let list = String::from_utf8_lossy(&output.stdout);
        for file in ["Cargo.toml", "README.md"].into_iter().chain(LICENSES) {
            assert!(list.lines().any(|line| line == file), "{package} has no {file}:\n{list}");
        }
    }
}

/// The front page of a package is read on crates.io and docs.rs, where no path leads out of the package.
#[test]
fn front_pages_link_to_addresses_alone() {
    for (folder, _) in public() {
        let page = std::fs::read_to_string(folder.join("README.md")).expect("a front page");
        let links = page.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(link, _)| link);
        let bad: Vec<&str> =
            links.filter(|link| !link.starts_with("https://") && !link.starts_with('#')).collect();
        assert!(bad.is_empty(), "{}: {bad:?}", folder.display());
    }
}

/// The packages that a package needs, one line each, as cargo finds them.
fn tree(package: &str, options: &[&str]) -> Vec<String> {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["tree", "--offline", "--edges", "normal", "--prefix", "none", "--format", "{p}"]);
    let output = cargo.args(["--package", package]).args(options).current_dir(root()).output();
    let output = output.expect("cargo starts");
    assert!(output.status.success(), "{package}: {}", String::from_utf8_lossy(&output.stderr));
    let words = |line: &str| line.split(' ').take(2).collect::<Vec<_>>().join(" ");
    let mut lines: Vec<String> = String::from_utf8_lossy(&output.stdout).lines().skip(1).map(words).collect();
    lines.sort();
    lines.dedup();
    lines.retain(|line| !line.is_empty() && line.split(' ').next() != Some(package));
    lines
}

/// The counts are those of Linux: other systems need other packages.
#[test]
#[cfg(target_os = "linux")]
fn front_pages_name_what_the_package_depends_on() {
    for (folder, manifest) in public() {
        let (package, has_library) = (name(&manifest), folder.join("src/lib.rs").exists());
        let page = std::fs::read_to_string(folder.join("README.md")).expect("a front page");
        let page = page.split_whitespace().collect::<Vec<_>>().join(" ");
        let section = page.split_once("## Dependencies ").map(|(_, rest)| rest);
        let Some(section) = section.filter(|_| has_library) else {
            assert!(!has_library, "{package}: its front page does not say what it depends on");
            continue;
        };
        let version = manifest_of_workspace("rust-version");
        assert!(section.contains(&format!("Rust {version} or later")), "{package}: not the oldest compiler");
        let all = tree(package, &[]).len();
        let counted = section.contains(&format!(": {all} crates in all")) || all == 0;
        assert!(counted, "{package}: it needs {all} crates: {section}");
        let direct = tree(package, &["--depth", "1"]);
        let names = direct.iter().filter_map(|line| line.split(' ').next());
        let absent =
            names.filter(|name| !name.starts_with("bowknot") && !section.contains(&format!("`{name}`")));
        assert_eq!(absent.collect::<Vec<_>>(), Vec::<&str>::new(), "{package}: {section}");
    }
}

/// A field that all packages share.
fn manifest_of_workspace(field: &str) -> String {
    let fields = manifest(&root())["workspace"]["package"].clone();
    fields[field].as_str().expect("a text").to_owned()
}

/// The rules themselves can fail.
#[test]
fn faulty_packages_are_seen() {
    let bare: Table = toml::from_str("[package]\nname = \"x\"\nreadme = \"NONE.md\"").expect("a manifest");
    let found = faults(&root().join("docs"), &bare);
    assert_eq!(found.len(), 9, "six fields, a file and two licenses are missing: {found:?}");
    let words =
        "[package]\nname = 'x'\nkeywords.workspace = true\ncategories = ['a', 'b', 'c', 'd', 'e', 'f']";
    let found = faults(&root(), &words.parse().expect("a manifest"));
    assert_eq!(found.iter().filter(|fault| fault.contains("of its own")).count(), 2, "{found:?}");
    let private: Table = "[package]\npublish = false".parse().expect("a manifest");
    assert!(!is_public(&private));
}
