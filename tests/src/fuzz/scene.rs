//! No text of a scene makes the parser panic, and a scene that was read can be written and read again.

use bowknot::shapes::Shape;
use bowknot::{Scene, SceneError, Simulator};
use toml::{Table, Value};

/// Most vertices of a scene that is built, by a rough estimate: its size is what its text asks for.
const MAX_VERTICES: f64 = 5e3;

/// Reads the bytes as a scene file. A scene that is sound and small is built as a simulation.
pub fn scene(data: &[u8]) -> bool {
    let text = String::from_utf8_lossy(data);
    let scene = match Scene::from_toml(&text, ".") {
        Ok(scene) => scene,
        Err(error) => return check_error(&error),
    };
    let written = scene.to_toml();
    let again = Scene::from_toml(&written, ".");
    let again = again.unwrap_or_else(|error| panic!("what was written is refused: {error}\n{written}"));
    assert_eq!(again.to_toml(), written, "what was written is read as another scene");
    let short = scene.to_short_toml();
    let again = Scene::from_toml(&short, ".");
    let again = again.unwrap_or_else(|error| panic!("the short form is refused: {error}\n{short}"));
    // Zeros below zero are defaults, which the short form leaves out.
    let table = |text: &str| text.parse::<Table>().unwrap_or_else(|error| panic!("{error}:\n{text}"));
    assert_eq!(table(&again.to_toml()), table(&written), "the short form is another scene:\n{short}");
    if vertices(&scene) <= MAX_VERTICES
        && let Err(error) = Simulator::new(&scene)
    {
        assert!(!error.to_string().is_empty());
    }
    true
}

fn check_error(error: &SceneError) -> bool {
    assert!(!error.to_string().is_empty());
    false
}

/// About how many vertices the shapes of a scene have, rather too many than too few.
fn vertices(scene: &Scene) -> f64 {
    let shapes = scene.bodies.iter().map(|b| &b.shape).chain(scene.obstacles.iter().map(|o| &o.shape));
    shapes.flatten().map(of_shape).sum()
}

fn of_shape(shape: &Shape) -> f64 {
    let Ok(Value::Table(table)) = Value::try_from(shape) else { return f64::INFINITY };
    let mut numbers = Vec::new();
    table.values().for_each(|value| collect(value, &mut numbers));
    let largest = numbers.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    let number = |key: &str| table.get(key).and_then(|v| v.as_float().or(v.as_integer().map(|n| n as f64)));
    match shape {
        Shape::HalfSpace(_) => 4.0,
        Shape::Grains(_) | Shape::Woven(_) | Shape::Strands(_) => {
            let counts = numbers.iter().filter(|n| n.fract() == 0.0 && **n > 1.0);
            let spacing = numbers.iter().copied().filter(|n| *n > 0.0).fold(f64::INFINITY, f64::min);
            counts.product::<f64>().max(largest / spacing)
        }
        _ => {
            let edge = number("edge").or(number("spacing")).unwrap_or(1e-9);
            let per_side = 4.0 * largest.max(2.0) / edge;
            if matches!(shape, Shape::Block(_) | Shape::TetBall(_)) {
                per_side.powi(3) / 64.0
            } else {
                per_side.powi(2)
            }
        }
    }
}

fn collect(value: &Value, numbers: &mut Vec<f64>) {
    match value {
        Value::Integer(number) => numbers.push(*number as f64),
        Value::Float(number) => numbers.push(*number),
        Value::Array(list) => list.iter().for_each(|value| collect(value, numbers)),
        Value::Table(table) => table.values().for_each(|value| collect(value, numbers)),
        _ => {}
    }
}
