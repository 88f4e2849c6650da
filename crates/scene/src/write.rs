//! From a [`Scene`] to TOML.

use crate::description::Scene;
use serde::Serialize;
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// The scene as tables, every default filled in.
pub(super) fn table(scene: &Scene) -> Table {
    let mut simulation = fields(&scene.simulation);
    simulation.extend(fields(&scene.environment));
    let mut contact = Table::new();
    insert(&mut contact, "preset", &scene.preset);
    contact.extend(fields(&scene.contact));
    insert(&mut contact, "friction_pairs", &scene.friction_pairs);

    let mut root = Table::new();
    root.insert("simulation".to_owned(), Value::Table(simulation));
    root.insert("contact".to_owned(), Value::Table(contact));
    root.insert("solver".to_owned(), Value::Table(fields(&scene.solver)));
    root.insert("output".to_owned(), Value::Table(fields(&scene.output)));
    insert(&mut root, "body", &scene.bodies);
    insert(&mut root, "obstacle", &scene.obstacles);
    insert(&mut root, "pin", &scene.pins);
    root
}

/// As [`table`], without ends that never come: formats such as JSON have no infinity.
pub(super) fn table_without_ends(scene: &Scene) -> Table {
    let mut root = table(scene);
    for (list, key) in [("obstacle", "vanishes"), ("pin", "end")] {
        let entries = root.get_mut(list).and_then(Value::as_array_mut).into_iter().flatten();
        for entry in entries.filter_map(Value::as_table_mut) {
            if entry.get(key).and_then(Value::as_float) == Some(f64::INFINITY) {
                entry.remove(key);
            }
        }
    }
    root
}

/// As [`table`], with materials by name where all numbers are theirs, so that a change of one number, or of
/// the name, does what it would do in a file.
pub(super) fn table_of_names(scene: &Scene) -> Table {
    let mut root = table(scene);
    if let Some(Value::Array(bodies)) = root.get_mut("body") {
        for (spec, body) in scene.bodies.iter().zip(bodies) {
            if let (Value::Table(body), Some(name)) = (body, spec.material.name()) {
                body.insert("material".to_owned(), Value::String(name.to_owned()));
            }
        }
    }
    root
}

/// The scene as text, mesh paths made absolute.
pub(super) fn text(scene: &Scene) -> String {
    let mut scene = scene.clone();
    let absolute = |file: &mut PathBuf| {
        let path = scene.folder.join(&*file);
        *file = std::path::absolute(&path).unwrap_or(path);
    };
    scene.bodies.iter_mut().filter_map(|b| b.mesh.as_mut()).for_each(absolute);
    scene.obstacles.iter_mut().flat_map(|o| o.mesh.iter_mut().chain(&mut o.sequence)).for_each(absolute);
    scene.folder = Path::new("").to_owned();
    toml::to_string(&table(&scene)).unwrap_or_default()
}

/// Removes from `[contact]` and `[solver]` what equals the preset's own values.
pub(super) fn drop_defaults(root: &mut Table, scene: &Scene) {
    let base = table(&Scene::with_preset(scene.preset));
    for key in ["contact", "solver"] {
        if let (Some(Value::Table(own)), Some(Value::Table(base))) = (root.get_mut(key), base.get(key)) {
            subtract(own, base);
        }
    }
}

/// Removes from `own` what `base` has as well, and tables that this leaves empty.
pub(super) fn subtract(own: &mut Table, base: &Table) {
    own.retain(|key, value| match (value, base.get(key)) {
        (Value::Table(own), Some(Value::Table(base))) => {
            subtract(own, base);
            !own.is_empty()
        }
        (value, Some(base)) => value != base,
        (_, None) => true,
    });
}

/// A struct as a table.
pub(super) fn fields(value: &impl Serialize) -> Table {
    // None of the structs has a field that TOML cannot hold; a test writes and reads all of them.
    Table::try_from(value).unwrap_or_default()
}

fn insert(table: &mut Table, key: &str, value: &impl Serialize) {
    if let Ok(value) = Value::try_from(value) {
        table.insert(key.to_owned(), value);
    }
}
