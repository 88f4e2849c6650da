//! The manifests respect the layers: dependencies point one way.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml::Table;

/// The crate that every crate may depend on.
const SHARED: &str = "bowknot-errors";

/// The crate by which the tests of a consumer may judge what its library does.
const JUDGE: &str = "bowknot-check";

/// The crates of the workspace that each crate may depend on, beside [`SHARED`]. A crate that is not listed
/// fails the test.
const ALLOWED: &[(&str, &[&str])] = &[
    ("bowknot-errors", &[]),
    ("bowknot-geometry", &[]),
    ("bowknot-proximity", &["bowknot-geometry"]),
    ("bowknot-lcp", &[]),
    ("bowknot-constraints", &["bowknot-geometry", "bowknot-lcp", "bowknot-proximity"]),
    ("bowknot-stepper", &["bowknot-geometry", "bowknot-proximity"]),
    (
        "bowknot-twoway",
        &[
            "bowknot-check",
            "bowknot-constraints",
            "bowknot-geometry",
            "bowknot-lcp",
            "bowknot-proximity",
            "bowknot-stepper",
        ],
    ),
    (
        "bowknot-baselines",
        &[
            "bowknot-constraints",
            "bowknot-geometry",
            "bowknot-lcp",
            "bowknot-proximity",
            "bowknot-stepper",
            "bowknot-twoway",
        ],
    ),
    ("bowknot-bench", &["bowknot", "bowknot-baselines"]),
    ("bowknot-dynamics", &["bowknot-geometry"]),
    ("bowknot-io", &["bowknot-geometry"]),
    (
        "bowknot-scene",
        &[
            "bowknot-check",
            "bowknot-constraints",
            "bowknot-dynamics",
            "bowknot-geometry",
            "bowknot-io",
            "bowknot-proximity",
            "bowknot-stepper",
            "bowknot-twoway",
        ],
    ),
    // The judge shares no code with what it judges.
    ("bowknot-check", &["bowknot-geometry"]),
    ("bowknot-report", &["bowknot-geometry", "bowknot-io"]),
    (
        "bowknot-gpu",
        &["bowknot-check", "bowknot-dynamics", "bowknot-geometry", "bowknot-proximity", "bowknot-twoway"],
    ),
    (
        "bowknot",
        &[
            "bowknot-check",
            "bowknot-constraints",
            "bowknot-dynamics",
            "bowknot-geometry",
            "bowknot-gpu",
            "bowknot-io",
            "bowknot-lcp",
            "bowknot-proximity",
            "bowknot-report",
            "bowknot-scene",
            "bowknot-stepper",
            "bowknot-twoway",
        ],
    ),
    ("bowknot-render", &["bowknot-geometry"]),
    ("bowknot-cli", &["bowknot", "bowknot-render"]),
    ("bowknot-capi", &["bowknot"]),
    ("bowknot-python", &["bowknot", "bowknot-render"]),
    ("bowknot-web", &["bowknot"]),
    ("twins", &[]),
    ("xtask", &[]),
];

pub fn root() -> PathBuf {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR"));
    tests.parent().unwrap_or(tests).to_path_buf()
}

pub fn manifest(folder: &Path) -> Table {
    let path = folder.join("Cargo.toml");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    text.parse().unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

pub fn name(manifest: &Table) -> &str {
    manifest["package"]["name"].as_str().expect("a package has a name")
}

/// Folders of a folder, sorted.
pub fn folders(parent: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(parent).unwrap_or_else(|error| panic!("{}: {error}", parent.display()));
    let mut folders: Vec<PathBuf> = entries
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| path.join("Cargo.toml").is_file())
        .collect();
    folders.sort();
    folders
}

/// Names of our packages on which a package depends in any way: for building, for testing, on some target,
/// under another name.
pub fn our_dependencies(manifest: &Table) -> Vec<String> {
    let mut tables = vec![manifest];
    if let Some(targets) = manifest.get("target").and_then(|value| value.as_table()) {
        tables.extend(targets.values().filter_map(|value| value.as_table()));
    }
    let mut found = Vec::new();
    for table in tables {
        for key in ["dependencies", "dev-dependencies", "build-dependencies"] {
            let Some(dependencies) = table.get(key).and_then(|value| value.as_table()) else { continue };
            for (key, value) in dependencies {
                let package = value.get("package").and_then(|value| value.as_str()).unwrap_or(key);
                // A dependency with a path is ours, whatever its name.
                if package.starts_with("bowknot") || package == "xtask" || value.get("path").is_some() {
                    found.push(package.to_owned());
                }
            }
        }
    }
    found
}

#[test]
fn dependencies_point_down() {
    let allowed: BTreeMap<&str, &[&str]> = ALLOWED.iter().copied().collect();
    let mut faults = Vec::new();
    let mut seen = Vec::new();
    for folder in folders(&root().join("crates")) {
        let manifest = manifest(&folder);
        let package = name(&manifest);
        let short = folder.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let expected = match short {
            "bowknot" | "twins" | "xtask" => short.to_owned(),
            _ => format!("bowknot-{short}"),
        };
        if package != expected {
            faults.push(format!("crates/{short} holds package {package}, not {expected}"));
        }
        let Some(may) = allowed.get(package) else {
            faults.push(format!("{package} has no place in the layers: add it to ALLOWED"));
            continue;
        };
        for dependency in our_dependencies(&manifest) {
            // Tests of a crate depend on it with more features.
            if dependency != SHARED && dependency != package && !may.contains(&dependency.as_str()) {
                faults.push(format!("{package} must not depend on {dependency}"));
            }
        }
        seen.push(package.to_owned());
    }
    faults.extend(
        ALLOWED.iter().filter(|(p, _)| !seen.iter().any(|s| s == p)).map(|(p, _)| format!("{p} is gone")),
    );
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Faults of a consumer of a library: it must use the library and no other package of ours, but for the judge
/// in its tests.
fn consumer_faults(short: &str, library: &str, consumer: &Table) -> Vec<String> {
    let mut consumer = consumer.clone();
    if let Some(of_tests) = consumer.get_mut("dev-dependencies").and_then(|value| value.as_table_mut()) {
        of_tests.remove(JUDGE);
    }
    let used = our_dependencies(&consumer);
    let mut faults = Vec::new();
    if !used.iter().any(|package| package == library) {
        faults.push(format!("tests/consumers/{short} does not use {library}"));
    }
    // A library re-exports the types of lower layers that its signatures use.
    for other in used.iter().filter(|other| *other != library) {
        faults.push(format!("tests/consumers/{short} must not need {other}"));
    }
    faults
}

/// Every library has a consumer that uses it and no other package of ours.
#[test]
fn every_library_is_usable_alone() {
    let consumers = root().join("tests/consumers");
    let mut faults = Vec::new();
    for folder in folders(&root().join("crates")) {
        let short = folder.file_name().and_then(|name| name.to_str()).unwrap_or_default().to_owned();
        if matches!(short.as_str(), "bench" | "capi" | "cli" | "python" | "twins" | "web" | "xtask") {
            continue;
        }
        let library = name(&manifest(&folder)).to_owned();
        let consumer = consumers.join(&short);
        if consumer.join("Cargo.toml").is_file() {
            faults.extend(consumer_faults(&short, &library, &manifest(&consumer)));
        } else {
            faults.push(format!("{library} has no consumer in tests/consumers/{short}"));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The rule itself can fail.
#[test]
fn forbidden_edges_are_seen() {
    let manifest: Table = r#"
        [dependencies]
        bowknot-geometry.workspace = true
        alias = { package = "bowknot-twoway", version = "0.1" }
        elsewhere = { path = "../elsewhere" }
        serde = "1"
        [target.'cfg(unix)'.dev-dependencies]
        bowknot-lcp.workspace = true
    "#
    .parse()
    .expect("valid TOML");
    let mut found = our_dependencies(&manifest);
    found.sort();
    assert_eq!(found, ["bowknot-geometry", "bowknot-lcp", "bowknot-twoway", "elsewhere"]);
}

#[test]
fn dependent_consumers_are_seen() {
    let consumer =
        |text: &str| consumer_faults("stepper", "bowknot-stepper", &text.parse().expect("valid TOML"));
    assert!(consumer("dependencies.bowknot-stepper.workspace = true").is_empty());
    let judged =
        |table| format!("dependencies = {{ bowknot-stepper = '0.1' }}\n{table}.bowknot-check = '0.1'");
    assert!(consumer(&judged("dev-dependencies")).is_empty());
    assert_eq!(
        consumer(&judged("build-dependencies")),
        ["tests/consumers/stepper must not need bowknot-check"]
    );
    assert_eq!(
        consumer("dependencies.serde = '1'"),
        ["tests/consumers/stepper does not use bowknot-stepper"]
    );
    let both = "dependencies = { bowknot-stepper = '0.1', points = { package = 'bowknot-geometry' } }";
    assert_eq!(consumer(both), ["tests/consumers/stepper must not need bowknot-geometry"]);
}
