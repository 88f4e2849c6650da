//! `assets/scenes` follows the built-in scenes and `assets/materials` the named materials.
//! `BOWKNOT_ACCEPT=1 cargo test -p bowknot-scene --test assets` writes the files anew.

use bowknot_scene::{BUILTIN, BodyKind, Material, Scene};
use std::fs;
use std::path::{Path, PathBuf};

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets").join(name)
}

/// Writes the file if the environment says so, and compares it.
fn compare(path: &Path, text: &str) {
    if std::env::var_os("BOWKNOT_ACCEPT").is_some() {
        fs::write(path, text).expect("a writable file");
    }
    let found = fs::read_to_string(path).unwrap_or_default();
    assert!(found == text, "{} is out of date: run the tests with BOWKNOT_ACCEPT=1", path.display());
}

#[test]
fn built_in_scenes_are_files_that_run_as_they_are() {
    for builtin in BUILTIN {
        let scene = Scene::builtin(builtin.name, 1.0).expect("a built-in scene");
        let name = builtin.name;
        let text = format!(
            "# {name}: {}.\n# The built-in scene at scale 1; `bowknot run {name}` runs the same. A test \
             keeps this file equal to it.\n\n{}",
            builtin.summary,
            scene.to_short_toml()
        );
        let path = folder("scenes").join(format!("{name}.toml"));
        compare(&path, &text);
        let loaded = Scene::load::<&str>(&path, &[]).expect("a scene");
        let folder = scene.folder.clone();
        assert_eq!(Scene { folder, ..loaded }, scene, "{name}");
    }
}

/// The documentation of a constructor, as comments of TOML: what the numbers are and where they come from.
fn source_of(code: &str, constructor: &str) -> String {
    let end = code.find(&format!("    pub fn {constructor}() -> Self")).expect("a constructor of that name");
    let lines: Vec<&str> =
        code[..end].lines().rev().take_while(|line| line.trim().starts_with("///")).collect();
    let plain =
        |line: &&str| line.trim().trim_start_matches("///").replace("[`Self::", "`").replace("`]", "`");
    lines.iter().rev().map(|line| format!("#{}\n", plain(line))).collect()
}

#[test]
fn named_materials_are_files_with_their_sources() {
    for kind in BodyKind::ALL {
        let file = match kind {
            BodyKind::Strands => "strand",
            BodyKind::Particles => "particle",
            other => other.name(),
        };
        let code = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../dynamics/src/material/{file}.rs"));
        let code = fs::read_to_string(code).expect("the source of the materials");
        let mut text = format!(
            "# The named materials of kind `{}`: numbers in SI units, and their sources. A scene names one \
             with\n\
             # `material = \"NAME\"`, or changes single numbers: `material = {{ base = \"NAME\", density = \
             .. }}`.\n\
             # A test keeps this file equal to the presets of `crates/dynamics/src/material/{file}.rs`.\n",
            kind.name()
        );
        let mut tables = toml::Table::new();
        for name in kind.materials() {
            let material = Material::named(kind, name).expect("a material of that name");
            let table = toml::Table::try_from(material).expect("a table");
            text += &format!("\n{}[{name}]\n{table}", source_of(&code, &name.replace('-', "_")));
            tables.insert((*name).to_owned(), toml::Value::Table(table));
        }
        compare(&folder("materials").join(format!("{}.toml", kind.name())), &text);
        assert_eq!(text.parse::<toml::Table>().expect("TOML"), tables);
    }
}
