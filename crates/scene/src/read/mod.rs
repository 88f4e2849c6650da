//! From a parsed description to a [`Scene`]: the order in which its tables are read. `section.rs` reads one
//! table, the other files say which keys each part has.

mod body;
mod material;
mod section;
mod shape;
mod solver;

use crate::description::Scene;
use crate::error::SceneError;
use crate::fields::field_names;
use crate::params::{OutputParams, SimulationParams};
use crate::source::Source;
use crate::validate::{self, report_errors};
use bowknot_dynamics::Environment;
use bowknot_twoway::{ContactParams, Params};
use section::{Problems, Section};
use std::path::Path;

/// Top-level keys.
const TABLES: [&str; 7] = ["simulation", "contact", "solver", "output", "body", "obstacle", "pin"];

/// Reads a scene and checks it.
pub(super) fn scene(source: &Source, folder: &Path, name: &str) -> Result<Scene, SceneError> {
    let problems = Problems::new(source);
    let mut scene = read(&problems.root(), name);
    let found = problems.into_found();
    if !found.is_empty() {
        return Err(SceneError::Invalid(found));
    }
    folder.clone_into(&mut scene.folder);
    scene.origins = source.origins();
    validate::scene(&scene, source)?;
    Ok(scene)
}

/// Reads the parameters of the two-way method alone.
pub(super) fn twoway(source: &Source) -> Result<Params, SceneError> {
    let problems = Problems::new(source);
    let root = problems.root();
    for key in root.keys().filter(|key| !["contact", "solver"].contains(key)) {
        root.fail(key, "only keys of contact and solver can be set here");
    }
    let params = solver::read(&root).twoway();
    let mut found = problems.into_found();
    report_errors(&mut found, source, "", &params);
    if found.is_empty() { Ok(params) } else { Err(SceneError::Invalid(found)) }
}

fn read(root: &Section<'_>, name: &str) -> Scene {
    check_tables(root);
    let mut scene = solver::read(root);
    let simulation = root.table("simulation");
    simulation.check_keys(&simulation_keys());
    scene.simulation = simulation.fields(&SimulationParams::default(), &[]);
    if scene.simulation.name.is_empty() {
        name.clone_into(&mut scene.simulation.name);
    }
    scene.environment = simulation.fields(&Environment::default(), &[]);
    let friction_pairs = root.table("contact").tables("friction_pairs");
    scene.friction_pairs = friction_pairs.iter().map(|section| section.structure(&[])).collect();
    scene.output = root.table("output").structure::<OutputParams>(&[]);
    let bodies = root.tables("body").into_iter().enumerate();
    scene.bodies = bodies.map(|(index, section)| body::body(&section, index)).collect();
    let obstacles = root.tables("obstacle").into_iter().enumerate();
    scene.obstacles = obstacles.map(|(index, section)| body::obstacle(&section, index)).collect();
    scene.pins = root.tables("pin").iter().map(|section| body::pin(section, &scene.bodies)).collect();
    scene
}

fn simulation_keys() -> Vec<&'static str> {
    [field_names::<SimulationParams>(), field_names::<Environment>()].concat()
}

/// Reports top-level keys that are no tables. One that is a key of a table is said to be that, such as
/// `wind`.
fn check_tables(root: &Section<'_>) {
    let tables = [
        ("simulation", simulation_keys()),
        ("contact", field_names::<ContactParams>().to_vec()),
        ("output", field_names::<OutputParams>().to_vec()),
    ];
    let mut known = TABLES.to_vec();
    for key in root.keys() {
        if let Some((table, _)) = tables.iter().find(|(_, keys)| keys.contains(&key)) {
            root.fail(key, format!("unknown key; did you mean {table}.{key}?"));
            known.push(key);
        }
    }
    root.check_keys(&known);
}
