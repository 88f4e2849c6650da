//! `assets/scenes` follows the built-in scenes. `BOWKNOT_ACCEPT=1 cargo test -p bowknot-scene --test assets` writes the
//! files anew.

use bowknot_scene::{BUILTIN, Scene};
use std::fs;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/scenes")
}

#[test]
fn built_in_scenes_are_files_that_run_as_they_are() {
    let accept = std::env::var_os("BOWKNOT_ACCEPT").is_some();
    for builtin in BUILTIN {
        let scene = Scene::builtin(builtin.name, 1.0).expect("a built-in scene");
        let name = builtin.name;
        let text = format!(
            "# {name}: {}.\n# The built-in scene at scale 1; `bowknot run {name}` runs the same. A test keeps this \
             file equal to it.\n\n{}",
            builtin.summary,
            scene.to_short_toml()
        );
        let path = folder().join(format!("{name}.toml"));
        if accept {
            fs::write(&path, &text).expect("a writable file");
        }
        let found = fs::read_to_string(&path).unwrap_or_default();
        assert!(found == text, "{} is out of date: run the tests with BOWKNOT_ACCEPT=1", path.display());
        let loaded = Scene::load::<&str>(&path, &[]).expect("a scene");
        let folder = scene.folder.clone();
        assert_eq!(Scene { folder, ..loaded }, scene, "{name}");
    }
}
