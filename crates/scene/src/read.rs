//! From a parsed description to a [`Scene`].

use crate::body::BodySpec;
use crate::description::Scene;
use crate::error::{SceneError, nearest};
use crate::explain::explain;
use crate::fields::field_names;
use crate::friction::FrictionPair;
use crate::material;
use crate::motion::Motion;
use crate::obstacle::ObstacleSpec;
use crate::params::{OutputParams, Preset, SceneSolverParams, SimulationParams};
use crate::pin::{PinSpec, Region};
use crate::reader::Reader;
use crate::shapes::{
    Ball, Block, Cone, Cuboid, Figure, Garment, Grains, HalfSpaceShape, Lathe, Ribbon, Shape, Sheet, Strands,
    TetBall, Tube, Wedge, Woven,
};
use crate::source::Source;
use crate::validate::{self, report_errors};
use crate::values::{describe, join};
use bowknot_dynamics::Environment;
use bowknot_twoway::{ContactParams, Params, StopRule};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::path::Path;
use toml::{Table, Value};

/// Top-level keys.
const TABLES: [&str; 7] = ["simulation", "contact", "solver", "output", "body", "obstacle", "pin"];

/// Reads a scene and checks it.
pub(super) fn scene(source: &Source, folder: &Path, name: &str) -> Result<Scene, SceneError> {
    let mut reader = Reader::new(source);
    let root = &source.table;
    check_tables(&mut reader, root);

    let mut scene = read_solver(&mut reader, root);
    folder.clone_into(&mut scene.folder);
    scene.origins = source.origins();

    let table = reader.table(root, "", "simulation");
    reader.check_keys(&table, "simulation", &simulation_keys());
    scene.simulation = reader.fields(&SimulationParams::default(), &table, "simulation", &[]);
    if scene.simulation.name.is_empty() {
        name.clone_into(&mut scene.simulation.name);
    }
    scene.environment = reader.fields(&Environment::default(), &table, "simulation", &[]);
    let table = reader.table(root, "", "contact");
    for (table, path) in reader.tables(&table, "contact", "friction_pairs") {
        scene.friction_pairs.push(reader.structure::<FrictionPair>(&table, &path, &[]));
    }
    let table = reader.table(root, "", "output");
    scene.output = reader.structure::<OutputParams>(&table, "output", &[]);
    for (index, (table, path)) in reader.tables(root, "", "body").into_iter().enumerate() {
        scene.bodies.push(body(&mut reader, &table, &path, index));
    }
    for (index, (table, path)) in reader.tables(root, "", "obstacle").into_iter().enumerate() {
        scene.obstacles.push(obstacle(&mut reader, &table, &path, index));
    }
    for (table, path) in reader.tables(root, "", "pin") {
        let pin = pin(&mut reader, &table, &path, &scene.bodies);
        scene.pins.push(pin);
    }
    if !reader.problems.is_empty() {
        return Err(SceneError::Invalid(reader.problems));
    }
    validate::scene(&scene, source)?;
    Ok(scene)
}

fn simulation_keys() -> Vec<&'static str> {
    [field_names::<SimulationParams>(), field_names::<Environment>()].concat()
}

/// Reports top-level keys that are no tables. One that is a key of a table is said to be that, such as `wind`.
fn check_tables(reader: &mut Reader<'_>, root: &Table) {
    let tables = [
        ("simulation", simulation_keys()),
        ("contact", field_names::<ContactParams>().to_vec()),
        ("output", field_names::<OutputParams>().to_vec()),
    ];
    let mut known = TABLES.to_vec();
    for key in root.keys() {
        if let Some((table, _)) = tables.iter().find(|(_, keys)| keys.contains(&key.as_str())) {
            reader.fail(key, format!("unknown key; did you mean {table}.{key}?"));
            known.push(key);
        }
    }
    reader.check_keys(root, "", &known);
}

/// Reads the parameters of the two-way method alone.
pub(super) fn twoway(source: &Source) -> Result<Params, SceneError> {
    let mut reader = Reader::new(source);
    for key in source.table.keys().filter(|key| !["contact", "solver"].contains(&key.as_str())) {
        reader.fail(key, "only keys of contact and solver can be set here");
    }
    let params = read_solver(&mut reader, &source.table).twoway();
    let mut problems = reader.problems;
    report_errors(&mut problems, source, "", &params);
    if problems.is_empty() { Ok(params) } else { Err(SceneError::Invalid(problems)) }
}

/// Reads the numbers of `[contact]`, and `[solver]`, into an empty scene.
fn read_solver(reader: &mut Reader<'_>, root: &Table) -> Scene {
    let contact = reader.table(root, "", "contact");
    let known = [&["preset", "friction_pairs"], field_names::<ContactParams>()].concat();
    reader.check_keys(&contact, "contact", &known);
    let preset = contact.get("preset").map_or_else(Preset::default, |value| {
        value.clone().try_into().unwrap_or_else(|error: toml::de::Error| {
            reader.fail("contact.preset", explain(error.message(), value));
            Preset::default()
        })
    });
    let base = Scene::with_preset(preset);
    let contact = reader.fields(&base.contact, &contact, "contact", &[]);

    let table = reader.table(root, "", "solver");
    reader.check_keys(&table, "solver", field_names::<SceneSolverParams>());
    let mut backward = solver_part(reader, &table, "backward", &base.solver.backward);
    // A scene with more sweeps than the preset's polish_sweeps polishes with as many.
    if !reader.table(&table, "solver", "backward").contains_key("polish_sweeps") {
        backward.polish_sweeps = backward.polish_sweeps.max(backward.sweeps);
    }
    let stop = solver_part(reader, &table, "stop", &base.solver.stop);
    warn_of_other_rule(reader, &table, &stop.rule);
    let solver = SceneSolverParams {
        backward,
        forward: solver_part(reader, &table, "forward", &base.solver.forward),
        stop,
        newton: solver_part(reader, &table, "newton", &base.solver.newton),
        repulsion: solver_part(reader, &table, "repulsion", &base.solver.repulsion),
        sleep: solver_part(reader, &table, "sleep", &base.solver.sleep),
    };
    Scene { contact, solver, ..base }
}

/// Warns of keys that belong to the stopping rule that is not in force.
fn warn_of_other_rule(reader: &mut Reader<'_>, solver: &Table, rule: &StopRule) {
    let (rule, others): (_, &[&str]) = match rule {
        StopRule::Clock { .. } => ("clock", &["net_residual", "residual"]),
        StopRule::Travel { .. } => ("travel", &["remaining_fraction"]),
    };
    let table = reader.table(solver, "solver", "stop");
    for key in others.iter().filter(|key| table.contains_key(**key)) {
        reader.warn(&format!("solver.stop.{key}"), format!("has no effect: solver.stop.rule is {rule:?}"));
    }
}

fn solver_part<T>(reader: &mut Reader<'_>, solver: &Table, key: &str, base: &T) -> T
where
    T: Serialize + DeserializeOwned + Default + Clone,
{
    let table = reader.table(solver, "solver", key);
    reader.structure_over(base, &table, &join("solver", key))
}

fn body(reader: &mut Reader<'_>, table: &Table, path: &str, index: usize) -> BodySpec {
    let mut body: BodySpec = reader.structure(table, path, &["shape", "material"]);
    if body.name.is_empty() {
        body.name = format!("body{index}");
    }
    body.shape = shape(reader, table, path);
    // No material can be read for an unknown kind.
    if table.get("kind").is_none_or(|kind| kind.as_str() == Some(body.kind.name())) {
        body.material = material::read(reader, table, path, body.kind);
    }
    body
}

fn obstacle(reader: &mut Reader<'_>, table: &Table, path: &str, index: usize) -> ObstacleSpec {
    let mut obstacle: ObstacleSpec = reader.structure(table, path, &["shape", "motion"]);
    if obstacle.name.is_empty() {
        obstacle.name = format!("obstacle{index}");
    }
    obstacle.shape = shape(reader, table, path);
    obstacle.motion = motion(reader, table, path);
    obstacle
}

fn pin(reader: &mut Reader<'_>, table: &Table, path: &str, bodies: &[BodySpec]) -> PinSpec {
    let mut pin: PinSpec = reader.structure(table, path, &["box", "motion"]);
    if let (true, [only]) = (pin.body.is_empty(), bodies) {
        pin.body.clone_from(&only.name);
    }
    if table.contains_key("box") {
        let region = reader.table(table, path, "box");
        pin.region = Some(reader.structure::<Region>(&region, &join(path, "box"), &[]));
    }
    pin.motion = motion(reader, table, path);
    pin
}

fn motion(reader: &mut Reader<'_>, table: &Table, path: &str) -> Option<Motion> {
    table.contains_key("motion").then(|| {
        let motion = reader.table(table, path, "motion");
        let path = join(path, "motion");
        let mut read: Motion = reader.structure(&motion, &path, &["keyframes"]);
        for (keyframe, path) in reader.tables(&motion, &path, "keyframes") {
            let keyframe = reader.structure(&keyframe, &path, &[]);
            read.keyframes.push(keyframe);
        }
        read
    })
}

fn shape(reader: &mut Reader<'_>, table: &Table, path: &str) -> Option<Shape> {
    let value = table.get("shape")?;
    let path = join(path, "shape");
    // A name alone stands for the shape with its defaults.
    let (kind, rest) = match value {
        Value::String(name) => (Some(name.clone()), Table::new()),
        Value::Table(table) => {
            let mut rest = table.clone();
            let kind = rest.remove("type").and_then(|kind| kind.as_str().map(str::to_owned));
            (kind, rest)
        }
        other => {
            let message = format!("must be a table with a key type, or a name, not {}", describe(other));
            reader.fail(&path, message);
            return None;
        }
    };
    let names = Shape::NAMES.join(", ");
    let Some(kind) = kind else {
        reader.fail(&path, format!("needs a key type, one of {names}"));
        return None;
    };
    Some(match kind.as_str() {
        "sheet" => Shape::Sheet(reader.structure::<Sheet>(&rest, &path, &[])),
        "tube" => Shape::Tube(reader.structure::<Tube>(&rest, &path, &[])),
        "ball" => Shape::Ball(reader.structure::<Ball>(&rest, &path, &[])),
        "cone" => Shape::Cone(reader.structure::<Cone>(&rest, &path, &[])),
        "box" => Shape::Box(reader.structure::<Cuboid>(&rest, &path, &[])),
        "figure" => Shape::Figure(reader.structure::<Figure>(&rest, &path, &[])),
        "garment" => Shape::Garment(reader.structure::<Garment>(&rest, &path, &[])),
        "wedge" => Shape::Wedge(reader.structure::<Wedge>(&rest, &path, &[])),
        "lathe" => Shape::Lathe(reader.structure::<Lathe>(&rest, &path, &[])),
        "ribbon" => Shape::Ribbon(reader.structure::<Ribbon>(&rest, &path, &[])),
        "half-space" => Shape::HalfSpace(reader.structure::<HalfSpaceShape>(&rest, &path, &[])),
        "block" => Shape::Block(reader.structure::<Block>(&rest, &path, &[])),
        "tet-ball" => Shape::TetBall(reader.structure::<TetBall>(&rest, &path, &[])),
        "strands" => Shape::Strands(reader.structure::<Strands>(&rest, &path, &[])),
        "woven" => Shape::Woven(reader.structure::<Woven>(&rest, &path, &[])),
        "grains" => Shape::Grains(reader.structure::<Grains>(&rest, &path, &[])),
        unknown => {
            let hint = nearest(unknown, Shape::NAMES.into_iter());
            let hint = hint.map_or_else(String::new, |name| format!("; did you mean {name}?"));
            reader.fail(&join(&path, "type"), format!("{unknown:?} must be one of {names}{hint}"));
            return None;
        }
    })
}
