//! Shapes, by the key `type`.

use super::section::Section;
use crate::error::nearest;
use crate::shapes::Shape;
use crate::values::describe;
use toml::{Table, Value};

/// Reads the shape of a body or an obstacle, at the key `shape`.
pub fn read(section: &Section<'_>) -> Option<Shape> {
    // A name alone stands for the shape with its defaults.
    let (kind, shape) = match section.get("shape")? {
        Value::String(name) => (Some(name.clone()), section.at("shape", Table::new())),
        Value::Table(table) => {
            let mut shape = section.at("shape", table.clone());
            (shape.remove("type").and_then(|kind| kind.as_str().map(str::to_owned)), shape)
        }
        other => {
            let message = format!("must be a table with a key type, or a name, not {}", describe(other));
            section.fail("shape", message);
            return None;
        }
    };
    let names = Shape::NAMES.join(", ");
    let Some(kind) = kind else {
        section.fail("shape", format!("needs a key type, one of {names}"));
        return None;
    };
    Some(match kind.as_str() {
        "sheet" => Shape::Sheet(shape.structure(&[])),
        "tube" => Shape::Tube(shape.structure(&[])),
        "ball" => Shape::Ball(shape.structure(&[])),
        "cone" => Shape::Cone(shape.structure(&[])),
        "box" => Shape::Box(shape.structure(&[])),
        "figure" => Shape::Figure(shape.structure(&[])),
        "garment" => Shape::Garment(shape.structure(&[])),
        "wedge" => Shape::Wedge(shape.structure(&[])),
        "lathe" => Shape::Lathe(shape.structure(&[])),
        "ribbon" => Shape::Ribbon(shape.structure(&[])),
        "half-space" => Shape::HalfSpace(shape.structure(&[])),
        "block" => Shape::Block(shape.structure(&[])),
        "tet-ball" => Shape::TetBall(shape.structure(&[])),
        "strands" => Shape::Strands(shape.structure(&[])),
        "woven" => Shape::Woven(shape.structure(&[])),
        "grains" => Shape::Grains(shape.structure(&[])),
        "arrays" => Shape::Arrays(shape.structure(&[])),
        unknown => {
            let hint = nearest(unknown, Shape::NAMES.into_iter());
            let hint = hint.map_or_else(String::new, |name| format!("; did you mean {name}?"));
            shape.fail("type", format!("{unknown:?} must be one of {names}{hint}"));
            return None;
        }
    })
}
