//! Numbers far out of range at every key of a scene: an error, or a time step, but no panic.

use bowknot::{Scene, Simulator};
use std::panic;
use toml::{Table, Value};

/// A cloth that a pin leads, a block, grains, a strand and two obstacles.
const SCENE: &str = r#"
    [[body]]
    name = "cloth"
    shape = { type = "sheet", size = [0.2, 0.2], edge = 0.05 }
    material = "cotton"
    translate = [0.0, 0.0, 0.3]

    [[body]]
    kind = "solid"
    shape = { type = "block", size = [0.1, 0.1, 0.1], edge = 0.05 }
    material = "jelly"
    translate = [0.5, 0.0, 0.3]

    [[body]]
    kind = "particles"
    shape = { type = "grains", count = [2, 2, 2], spacing = 0.01 }
    translate = [1.0, 0.0, 0.3]

    [[pin]]
    body = "cloth"
    side = "x-max"
    motion = { keyframes = [{ time = 0.0 }, { time = 1.0, translate = [0.1, 0.0, -0.5] }] }

    [[obstacle]]
    shape = { type = "ball", radius = 0.1 }

    [[obstacle]]
    shape = { type = "half-space" }
    translate = [0.0, 0.0, -1.0]
"#;

/// Appends the path of every number below `value`.
fn numbers(path: &str, value: &Value, found: &mut Vec<String>) {
    let below = |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
    match value {
        Value::Table(table) => table.iter().for_each(|(key, value)| numbers(&below(key), value, found)),
        Value::Array(list) => {
            list.iter()
                .enumerate()
                .for_each(|(index, value)| numbers(&below(&index.to_string()), value, found));
        }
        Value::Integer(_) | Value::Float(_) => found.push(path.to_owned()),
        _ => {}
    }
}

#[test]
fn no_number_of_a_scene_makes_the_program_panic() {
    let scene = Scene::from_toml(SCENE, "").expect("a scene");
    let table: Table = scene.to_toml().parse().expect("what was written");
    let mut keys = Vec::new();
    numbers("", &Value::Table(table), &mut keys);
    assert!(keys.len() > 120, "{keys:?}");
    let (mut refused, mut stepped, mut panicked) = (0, 0, Vec::new());
    for key in &keys {
        for number in ["0", "-1", "1e308", "-1e308", "1e-300", "inf", "nan"] {
            let set = format!("{key}={number}");
            let run = || {
                let scene = scene.clone().with_sets(&[&set, "solver.stop.max_steps=3"]).map_err(|_| ())?;
                let mut simulator = Simulator::new(&scene).map_err(|_| ())?;
                simulator.step().map(|_| ()).map_err(|_| ())
            };
            match panic::catch_unwind(run) {
                Ok(Ok(())) => stepped += 1,
                Ok(Err(())) => refused += 1,
                Err(_) => panicked.push(set),
            }
        }
    }
    assert!(panicked.is_empty(), "{panicked:?}");
    assert!(refused > keys.len() && stepped > keys.len(), "{refused} refused, {stepped} stepped");
}
