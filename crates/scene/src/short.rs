//! A scene as the TOML that a person would write: without what is default.

use crate::body::BodySpec;
use crate::description::Scene;
use crate::material::Material;
use crate::motion::{Keyframe, Motion};
use crate::obstacle::ObstacleSpec;
use crate::params::Preset;
use crate::pin::PinSpec;
use crate::shapes::Shape;
use crate::write::{self, subtract};
use serde::Deserialize;
use toml::{Table, Value};

/// The scene as text. What equals a default, or a preset's value, is left out.
pub(super) fn text(scene: &Scene) -> String {
    let mut root = write::table_of_names(scene);
    let base = write::table(&Scene::with_preset(scene.preset));
    for key in ["simulation", "contact", "solver", "output"] {
        if let (Some(Value::Table(own)), Some(Value::Table(base))) = (root.get_mut(key), base.get(key)) {
            let preset = own.get("preset").filter(|_| scene.preset != Preset::default()).cloned();
            subtract(own, base);
            own.extend(preset.map(|preset| ("preset".to_owned(), preset)));
        }
    }
    for (body, table) in scene.bodies.iter().zip(tables(&mut root, "body")) {
        let material = Material::of(body.kind);
        let base = BodySpec { material, ..BodySpec::default() };
        shorten(table, &write::fields(&base));
        // The material of a kind has the name of its first one by default.
        let default = material.name();
        if default.is_some() && table.get("material").and_then(Value::as_str) == default {
            table.remove("material");
        }
    }
    tables(&mut root, "obstacle").for_each(|table| shorten(table, &write::fields(&ObstacleSpec::default())));
    tables(&mut root, "pin").for_each(|table| shorten(table, &write::fields(&PinSpec::default())));
    let mut text = String::new();
    for key in ["simulation", "contact", "solver", "output", "body", "obstacle", "pin"] {
        match root.remove(key) {
            Some(Value::Table(table)) => section(&mut text, &format!("[{key}]"), key, &table),
            Some(Value::Array(list)) => list.iter().filter_map(Value::as_table).for_each(|table| {
                section(&mut text, &format!("[[{key}]]"), key, table);
            }),
            _ => {}
        }
    }
    text.trim_start().to_owned()
}

/// Lines longer than this are broken.
const LINE_WIDTH: usize = 100;

/// Keys that come before the others in their table.
const FIRST: [&str; 8] = ["type", "name", "kind", "body", "mesh", "shape", "material", "time"];

/// Writes a table: values on one line each, long arrays one element per line, long tables as sections of
/// their own.
fn section(text: &mut String, header: &str, path: &str, table: &Table) {
    if table.is_empty() {
        return;
    }
    let mut keys: Vec<&String> = table.keys().collect();
    keys.sort_by_key(|key| (FIRST.iter().position(|first| first == key).unwrap_or(FIRST.len()), *key));
    let mut sections = Vec::new();
    text.push_str(&format!("\n{header}\n"));
    for key in keys {
        let line = format!("{key} = {}", table[key]);
        match &table[key] {
            Value::Table(inner) if line.len() > LINE_WIDTH => sections.push((format!("{path}.{key}"), inner)),
            Value::Array(list) if line.len() > LINE_WIDTH => {
                let elements: String = list.iter().map(|element| format!("    {element},\n")).collect();
                text.push_str(&format!("{key} = [\n{elements}]\n"));
            }
            _ => text.push_str(&format!("{line}\n")),
        }
    }
    for (path, inner) in sections {
        section(text, &format!("[{path}]"), &path, inner);
    }
}

/// The tables of an array of tables.
fn tables<'a>(root: &'a mut Table, key: &str) -> impl Iterator<Item = &'a mut Table> {
    let list = root.get_mut(key).and_then(Value::as_array_mut);
    list.into_iter().flatten().filter_map(Value::as_table_mut)
}

/// Removes the defaults of a body, an obstacle or a pin, those of its shape and its motion included.
fn shorten(table: &mut Table, base: &Table) {
    let nested: Vec<(&str, Option<Value>)> =
        ["shape", "motion"].into_iter().map(|key| (key, table.remove(key))).collect();
    subtract(table, base);
    for (key, value) in nested {
        let Some(Value::Table(mut value)) = value else { continue };
        let base = if key == "shape" { shape(&value) } else { write::fields(&Motion::default()) };
        let kind = value.get("type").cloned();
        subtract(&mut value, &base);
        if let Some(kind) = kind {
            value.insert("type".to_owned(), kind);
        }
        let keyframe = write::fields(&Keyframe::default());
        tables(&mut value, "keyframes").for_each(|frame| {
            let time = frame.get("time").cloned();
            subtract(frame, &keyframe);
            frame.extend(time.map(|time| ("time".to_owned(), time)));
        });
        table.insert(key.to_owned(), Value::Table(value));
    }
}

/// The defaults of a shape of the same type.
fn shape(own: &Table) -> Table {
    let alone: Table =
        own.iter().filter(|(key, _)| *key == "type").map(|(k, v)| (k.clone(), v.clone())).collect();
    Shape::deserialize(Value::Table(alone)).map_or_else(|_| Table::new(), |shape| write::fields(&shape))
}
