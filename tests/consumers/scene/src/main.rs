//! A scene of one's own, put together without a simulation.
#![allow(clippy::print_stdout, reason = "a command")]

use bowknot_scene::{Scene, SceneError, World};

const SCENE: &str = r#"
[[body]]
name = "cloth"
shape = { type = "sheet", size = [1.0, 1.0], edge = 0.1 }
translate = [0.0, 0.0, 1.0]

[[obstacle]]
name = "ball"
shape = { type = "ball", radius = 0.3 }
"#;

fn main() -> Result<(), SceneError> {
    let scene = Scene::from_toml(SCENE, "")?;
    let world = World::new(&scene)?;
    let info = world.info(scene.simulation.dt);
    println!("{info:?}");
    assert_eq!(info.vertices, world.deformable_vertices);
    let error = Scene::from_toml("[[body]]\nmash = \"a.obj\"\n", "").expect_err("an unknown key");
    assert!(error.to_string().contains("did you mean body[0].mesh?"), "{error}");
    Ok(())
}

#[test]
fn runs() {
    main().unwrap();
}
