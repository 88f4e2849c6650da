//! What the run's `scene.toml` and `summary.json` say.
//!
//! Both are read leniently: a run of another version, or one that did not end, still has a page.

use crate::bodies::BodyFacts;
use serde_json::Value as Json;
use std::fs;
use std::path::Path;
use toml::{Table, Value};

/// What is known of a run beside its frames and statistics.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Facts {
    /// Bodies in the order of the world: deformable ones, obstacles with a mesh, half-spaces.
    pub(super) bodies: Vec<BodyFacts>,
    pub(super) name: Option<String>,
    pub(super) preset: Option<String>,
    /// Time step [s].
    pub(super) dt: Option<f64>,
    /// Time steps asked for.
    pub(super) frames: Option<i64>,
    /// Distance that contacts are separated to [m], if the scene states it.
    pub(super) delta: Option<f64>,
    /// `summary.json`; none if the run has not ended.
    pub(super) summary: Option<Json>,
    /// What could not be read, in words.
    pub(super) missing: Vec<String>,
}

impl Facts {
    pub(super) fn read(folder: &Path) -> Self {
        let mut facts = Self::default();
        let text = |name: &str| fs::read_to_string(folder.join(name)).ok();
        match text("scene.toml").and_then(|text| text.parse::<Table>().ok()) {
            Some(scene) => facts.take(&scene),
            None => facts.missing.push(
                "scene.toml is missing or damaged: bodies have no names, frames may have no times".to_owned(),
            ),
        }
        facts.summary = text("summary.json").and_then(|text| serde_json::from_str(&text).ok());
        if facts.summary.is_none() {
            let message = "summary.json is missing: the run is under way or was cut off";
            facts.missing.push(message.to_owned());
        }
        facts
    }

    fn take(&mut self, scene: &Table) {
        let table = |key: &str| scene.get(key).and_then(Value::as_table);
        let word = |table: Option<&Table>, key: &str| {
            table.and_then(|t| t.get(key)).and_then(Value::as_str).map(str::to_owned)
        };
        let simulation = table("simulation");
        self.name = word(simulation, "name").filter(|name| !name.is_empty());
        self.dt = number(simulation, "dt").filter(|&dt| dt > 0.0);
        self.frames = simulation.and_then(|t| t.get("frames")).and_then(Value::as_integer);
        self.preset = word(table("contact"), "preset");
        self.delta = number(table("contact"), "delta");

        let list = |key: &str| {
            let list = scene.get(key).and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
            list.iter().filter_map(Value::as_table)
        };
        let name = |table: &Table, default: String| word(Some(table), "name").unwrap_or(default);
        for (index, body) in list("body").enumerate() {
            let kind = word(Some(body), "kind").unwrap_or_else(|| "cloth".to_owned());
            self.bodies.push(BodyFacts { name: name(body, format!("body{index}")), kind });
        }
        let mut half_spaces = Vec::new();
        for (index, obstacle) in list("obstacle").enumerate() {
            let shape = word(obstacle.get("shape").and_then(Value::as_table), "type");
            let half_space = shape.as_deref() == Some("half-space");
            let kind = if half_space { "half-space" } else { "obstacle" }.to_owned();
            let facts = BodyFacts { name: name(obstacle, format!("obstacle{index}")), kind };
            if half_space { half_spaces.push(facts) } else { self.bodies.push(facts) }
        }
        self.bodies.extend(half_spaces);
    }
}

fn number(table: Option<&Table>, key: &str) -> Option<f64> {
    let value = table?.get(key)?;
    value.as_float().or_else(|| value.as_integer().map(|n| n as f64)).filter(|x| x.is_finite())
}
