//! The header follows the code, and a program in C does what it says.

// Links the crate, so that Cargo builds its libraries first.
use bowknot_c as _;
use std::path::{Path, PathBuf};
use std::process::Command;

fn folder() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn the_header_is_up_to_date() {
    let config = cbindgen::Config::from_file(folder().join("cbindgen.toml")).expect("settings");
    let bindings =
        cbindgen::Builder::new().with_crate(folder()).with_config(config).generate().expect("a header");
    let mut header = Vec::new();
    bindings.write(&mut header);
    let header = String::from_utf8(header).expect("text");
    let path = folder().join("include/bowknot.h");
    if std::env::var_os("BOWKNOT_ACCEPT").is_some() {
        std::fs::write(&path, &header).expect("written");
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        committed == header,
        "BOWKNOT_ACCEPT=1 cargo test --release --package bowknot-capi writes {}",
        path.display()
    );
}

/// The folder of the libraries that this test was built with.
fn libraries() -> PathBuf {
    let test = std::env::current_exe().expect("a path");
    let folder = test.parent().expect("a folder").to_owned();
    for library in ["libbowknot_c.so", "libbowknot_c.a"] {
        assert!(folder.join(library).is_file(), "no {library} in {}", folder.display());
    }
    folder
}

#[cfg(target_os = "linux")]
#[test]
fn a_program_in_c_simulates_resolves_and_is_refused() {
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    let libraries = libraries();
    let place = tempfile::tempdir().expect("a folder");
    let shared = place.path().join("drape");
    let linked = place.path().join("drape-static");
    let compile = |out: &Path, libraries: &[&str]| {
        let mut cc = Command::new(&compiler);
        cc.args(["-std=c11", "-Wall", "-Wextra", "-Werror", "-o"]).arg(out);
        cc.arg(folder().join("examples/drape.c")).arg("-I").arg(folder().join("include")).args(libraries);
        assert!(cc.status().expect("a compiler of C").success());
    };
    let path = libraries.to_str().expect("a path in UTF-8");
    compile(&shared, &["-L", path, "-lbowknot_c"]);
    compile(&linked, &[&format!("{path}/libbowknot_c.a"), "-lm", "-lpthread", "-ldl"]);
    let printed = [&shared, &linked].map(|program| {
        let output = Command::new(program).env("LD_LIBRARY_PATH", path).output().expect("it starts");
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).expect("text")
    });
    assert_eq!(printed[0], printed[1]);
    let lines: Vec<&str> = printed[0].lines().collect();
    assert!(
        lines[0].starts_with("sheet: 256 vertices, time 0.40 s") && lines[0].ends_with(", 0 intersections"),
        "{lines:?}"
    );
    assert!(lines[1].starts_with("refused: ") && lines[1].contains("100000"), "{lines:?}");
    let heights =
        lines[2].strip_prefix("corner at ").and_then(|rest| rest.strip_suffix(" m")).expect("heights");
    let heights: Vec<f64> =
        heights.split(" m, led to ").map(|text| text.parse().expect("a number")).collect();
    assert!((heights[0] - heights[1]).abs() < 1e-3, "{lines:?}");
    assert!(lines[3].ends_with("0 intersections, converged 1"), "{lines:?}");
    let leaf: f64 = lines[3]["leaf at ".len()..][..6].parse().expect("a height");
    assert!((0.005..=0.0101).contains(&leaf), "{lines:?}");
    assert!(lines[4].starts_with("refused: x: 2 pairs intersect at the start"), "{lines:?}");
}
