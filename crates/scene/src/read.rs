//! From a parsed description to a [`Scene`].

use crate::body::{BodySpec, ObstacleSpec, PinSpec, Region};
use crate::contact;
use crate::description::Scene;
use crate::error::{Problem, SceneError, nearest};
use crate::fields::field_names;
use crate::friction::FrictionPair;
use crate::kind::BodyKind;
use crate::material;
use crate::motion::Motion;
use crate::params::{OutputParams, Preset, RepulsionParams, SimulationParams};
use crate::reader::Reader;
use crate::shapes::{
    Ball, Block, Cone, Cuboid, Figure, Garment, Grains, HalfSpaceShape, Lathe, Ribbon, Shape, Sheet, Strands,
    TetBall, Tube, Wedge, Woven,
};
use crate::source::Source;
use crate::values::{describe, join};
use bowknot_dynamics::{DynamicsParams, Environment, NewtonParams};
use bowknot_errors::Parameters;
use bowknot_geometry::Vector;
use bowknot_io::Import;
use bowknot_twoway::{ContactParams, Params, SolverParams};
use std::collections::HashMap;
use std::path::Path;
use toml::{Table, Value};

/// Top-level keys.
const TABLES: [&str; 7] = ["simulation", "contact", "solver", "output", "body", "obstacle", "pin"];

/// Reads a scene and checks it.
pub(super) fn scene(source: &Source, folder: &Path, name: &str) -> Result<Scene, SceneError> {
    let mut reader = Reader::new(source);
    let root = &source.table;
    reader.check_keys(root, "", &TABLES);

    let table = reader.table(root, "", "simulation");
    let known = [field_names::<SimulationParams>(), field_names::<Environment>()].concat();
    reader.check_keys(&table, "simulation", &known);
    let mut simulation = reader.fields(&SimulationParams::default(), &table, "simulation", &[]);
    if simulation.name.is_empty() {
        simulation.name = name.to_owned();
    }
    let environment = reader.fields(&Environment::default(), &table, "simulation", &[]);
    let table = reader.table(root, "", "solver");
    let table = reader.table(&table, "solver", "newton");
    let newton = reader.structure::<NewtonParams>(&table, "solver.newton", &[]);
    let dynamics = DynamicsParams { environment, newton };
    let (preset, twoway) = read_twoway(&mut reader, root);

    let table = reader.table(root, "", "output");
    let output = reader.structure::<OutputParams>(&table, "output", &[]);

    let mut scene =
        Scene { simulation, dynamics, preset, twoway, output, folder: folder.to_owned(), ..Scene::default() };
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
    let table = reader.table(root, "", "contact");
    for (table, path) in reader.tables(&table, "contact", "friction_pairs") {
        scene.friction_pairs.push(reader.structure::<FrictionPair>(&table, &path, &[]));
    }
    let table = reader.table(root, "", "solver");
    let table = reader.table(&table, "solver", "repulsion");
    scene.repulsion = reader.structure::<RepulsionParams>(&table, "solver.repulsion", &[]);
    if !reader.problems.is_empty() {
        return Err(SceneError::Invalid(reader.problems));
    }
    validate(&scene, source)?;
    Ok(scene)
}

/// Reads the parameters of the two-way method alone.
pub(super) fn twoway(source: &Source) -> Result<Params, SceneError> {
    let mut reader = Reader::new(source);
    for key in source.table.keys().filter(|key| !["contact", "solver"].contains(&key.as_str())) {
        reader.fail(key, "only keys of contact and solver can be set here");
    }
    let (_, params) = read_twoway(&mut reader, &source.table);
    let mut problems = reader.problems;
    report_errors(&mut problems, source, "", &params);
    if problems.is_empty() { Ok(params) } else { Err(SceneError::Invalid(problems)) }
}

fn read_twoway(reader: &mut Reader<'_>, root: &Table) -> (Preset, Params) {
    let contact = reader.table(root, "", "contact");
    let known = [&["preset", "friction_pairs"], field_names::<ContactParams>()].concat();
    reader.check_keys(&contact, "contact", &known);
    let preset = match contact.get("preset").map(|value| value.clone().try_into::<Preset>()) {
        None => Preset::default(),
        Some(Ok(preset)) => preset,
        Some(Err(error)) => {
            reader.fail("contact.preset", error.message().trim());
            Preset::default()
        }
    };
    let base = preset.params();
    let contact = reader.fields(&base.contact, &contact, "contact", &[]);

    let solver = reader.table(root, "", "solver");
    let known = [field_names::<SolverParams>(), &["newton", "repulsion"]].concat();
    reader.check_keys(&solver, "solver", &known);
    let backward_table = reader.table(&solver, "solver", "backward");
    let mut backward = reader.structure_over(&base.solver.backward, &backward_table, "solver.backward");
    // A scene with more sweeps than the preset's polish_sweeps polishes with as many.
    if !backward_table.contains_key("polish_sweeps") {
        backward.polish_sweeps = backward.polish_sweeps.max(backward.sweeps);
    }
    let table = reader.table(&solver, "solver", "forward");
    let forward = reader.structure_over(&base.solver.forward, &table, "solver.forward");
    let table = reader.table(&solver, "solver", "stop");
    let stop = reader.structure_over(&base.solver.stop, &table, "solver.stop");
    (preset, Params { contact, solver: SolverParams { backward, forward, stop } })
}

fn body(reader: &mut Reader<'_>, table: &Table, path: &str, index: usize) -> BodySpec {
    let mut body: BodySpec = reader.structure(table, path, &["shape", "material"]);
    if body.name.is_empty() {
        body.name = format!("body{index}");
    }
    body.shape = shape(reader, table, path);
    // Of what an unknown kind is made nobody knows.
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

/// Checks the values of a scene that has been read or made in code.
pub(super) fn validate(scene: &Scene, source: &Source) -> Result<(), SceneError> {
    let mut problems = Vec::new();
    report_errors(&mut problems, source, "simulation", &scene.simulation);
    report_errors(&mut problems, source, "simulation", &scene.dynamics.environment);
    report_errors(&mut problems, source, "solver.newton", &scene.dynamics.newton);
    report_errors(&mut problems, source, "output", &scene.output);
    // The paths of these parameters are keys of the scene.
    report_errors(&mut problems, source, "", &scene.twoway);
    validate_bodies(scene, source, &mut problems);
    contact::validate_pairs(scene, source, &mut problems);
    report_errors(&mut problems, source, "solver.repulsion", &scene.repulsion);
    for (index, pin) in scene.pins.iter().enumerate() {
        validate_pin(scene, pin, source, &format!("pin[{index}]"), &mut problems);
    }
    if !problems.is_empty() {
        return Err(SceneError::Invalid(problems));
    }
    if scene.bodies.is_empty() { Err(SceneError::Empty) } else { Ok(()) }
}

fn report(
    problems: &mut Vec<Problem>,
    source: &Source,
    path: &str,
    faults: &mut Vec<(&'static str, String)>,
) {
    problems.extend(faults.drain(..).map(|(key, message)| source.problem(&join(path, key), message)));
}

fn validate_bodies(scene: &Scene, source: &Source, problems: &mut Vec<Problem>) {
    let mut faults = Vec::new();
    let mut names: HashMap<&str, String> = HashMap::new();
    let paths = (0..scene.bodies.len())
        .map(|i| format!("body[{i}]"))
        .chain((0..scene.obstacles.len()).map(|i| format!("obstacle[{i}]")));
    let all = scene.bodies.iter().map(|b| &b.name).chain(scene.obstacles.iter().map(|o| &o.name));
    for (path, name) in paths.zip(all) {
        if let Some(first) = names.insert(name, path.clone()) {
            let message = format!("{name:?} is the name of {first} already; names must differ");
            problems.push(source.problem(&join(&path, "name"), message));
        }
    }
    for (index, body) in scene.bodies.iter().enumerate() {
        let path = format!("body[{index}]");
        placement(&mut faults, body.scale, [&body.rotate, &body.translate, &body.velocity]);
        groups(&mut faults, &body.groups, body.collides_with.as_deref());
        geometry(&mut faults, body.mesh.is_some(), body.shape.as_ref(), false);
        contact::validate_body(body, &mut faults);
        for (key, value) in
            [("angular_velocity", Some(&body.angular_velocity)), ("gravity", body.gravity.as_ref())]
        {
            if value.is_some_and(|value| !value.iter().all(|c| c.is_finite())) {
                faults.push((key, "must be finite".to_owned()));
            }
        }
        if body.material.kind() != body.kind {
            let (own, kind) = (body.material.kind().name(), body.kind.name());
            faults.push(("material", format!("is one of kind {own}, but the body is of kind {kind}")));
        }
        if let Some(Shape::HalfSpace(_)) = body.shape {
            faults.push(("shape", "a half-space can only be an obstacle".to_owned()));
        } else if let Some(shape) = &body.shape
            && shape.kind() != body.kind
        {
            let (own, kind) = (shape.kind().name(), body.kind.name());
            faults.push(("shape", format!("makes a body of kind {own}, but this one is of kind {kind}")));
        }
        if let Some(Shape::Figure(_)) = body.shape {
            faults.push(("shape", "a figure can only be an obstacle".to_owned()));
        }
        report(problems, source, &path, &mut faults);
        validate_shape(body.shape.as_ref(), source, &path, problems);
        report_errors(problems, source, &join(&path, "material"), &body.material);
    }
    for (index, obstacle) in scene.obstacles.iter().enumerate() {
        let path = format!("obstacle[{index}]");
        placement(&mut faults, obstacle.scale, [&obstacle.rotate, &obstacle.translate, &Vector::zeros()]);
        groups(&mut faults, &obstacle.groups, obstacle.collides_with.as_deref());
        let sequence = obstacle.sequence.is_some();
        geometry(&mut faults, obstacle.mesh.is_some(), obstacle.shape.as_ref(), sequence);
        contact::validate_obstacle(obstacle, &mut faults);
        if !(obstacle.sequence_rate.is_finite() && obstacle.sequence_rate > 0.0) {
            let message = format!("{} must be a number of frames a second above 0", obstacle.sequence_rate);
            faults.push(("sequence_rate", message));
        }
        if !obstacle.sequence_start.is_finite() {
            faults.push(("sequence_start", format!("{} must be finite", obstacle.sequence_start)));
        }
        let moves = sequence || obstacle.shape.as_ref().is_some_and(|shape| shape.animated().is_some());
        if moves && obstacle.motion.is_some() {
            faults.push((
                "motion",
                "the obstacle moves by itself already; only one of them may be given".to_owned(),
            ));
        }
        if let Some(shape @ (Shape::Strands(_) | Shape::Woven(_) | Shape::Grains(_))) = &obstacle.shape {
            let kind = shape.kind().name();
            faults.push(("shape", format!("makes a body of kind {kind}, which is no obstacle")));
        }
        if let Some(Shape::HalfSpace(_)) = obstacle.shape {
            if obstacle.motion.is_some() {
                faults.push(("motion", "a half-space does not move; use a box".to_owned()));
            }
            if obstacle.collides_with.is_some() || obstacle.groups != [0] {
                faults.push(("groups", "a half-space meets every body; use a box".to_owned()));
            }
        }
        report(problems, source, &path, &mut faults);
        validate_shape(obstacle.shape.as_ref(), source, &path, problems);
        validate_motion(obstacle.motion.as_ref(), source, &path, problems);
    }
}

fn validate_shape(shape: Option<&Shape>, source: &Source, path: &str, problems: &mut Vec<Problem>) {
    if let Some(shape) = shape {
        report_errors(problems, source, &join(path, "shape"), shape);
    }
}

fn validate_motion(motion: Option<&Motion>, source: &Source, path: &str, problems: &mut Vec<Problem>) {
    if let Some(motion) = motion {
        report_errors(problems, source, &join(path, "motion"), motion);
    }
}

/// Reports the fields of a struct that are out of their range, with the struct's place in the scene.
fn report_errors(problems: &mut Vec<Problem>, source: &Source, path: &str, parameters: &impl Parameters) {
    for error in parameters.validate().err().into_iter().flatten() {
        let message = format!("{} {}", error.value, error.allowed);
        problems.push(source.problem(&join(path, &error.path), message));
    }
}

fn validate_pin(scene: &Scene, pin: &PinSpec, source: &Source, path: &str, problems: &mut Vec<Problem>) {
    let mut faults = Vec::new();
    if !scene.bodies.iter().any(|body| body.name == pin.body) {
        let names: Vec<&str> = scene.bodies.iter().map(|b| b.name.as_str()).collect();
        let hint = nearest(&pin.body, names.iter().copied());
        let hint = hint.map_or_else(String::new, |name| format!("; did you mean {name}?"));
        let message = format!("no body {:?}; there are: {}{hint}", pin.body, names.join(", "));
        faults.push(("body", message));
    }
    if pin.vertices.is_empty() && pin.region.is_none() && pin.side.is_none() && pin.roots == 0 {
        faults.push(("vertices", "a pin needs vertices, a box, a side or roots".to_owned()));
    }
    let strands = |name: &String| scene.bodies.iter().any(|b| b.name == *name && b.kind == BodyKind::Strands);
    if pin.roots > 0 && !strands(&pin.body) {
        faults.push(("roots", "only strands have roots; the body is of another kind".to_owned()));
    }
    if let Some(name) = &pin.follow {
        let with_mesh = |o: &&ObstacleSpec| !matches!(o.shape, Some(Shape::HalfSpace(_)));
        let names: Vec<&str> = scene.obstacles.iter().filter(with_mesh).map(|o| o.name.as_str()).collect();
        if !names.contains(&name.as_str()) {
            let hint = nearest(name, names.iter().copied());
            let hint = hint.map_or_else(String::new, |name| format!("; did you mean {name}?"));
            let message = format!("no obstacle {name:?} with a mesh; there are: {}{hint}", names.join(", "));
            faults.push(("follow", message));
        }
        if pin.motion.is_some() {
            faults.push(("follow", "stands beside motion; only one of them may be given".to_owned()));
        }
    }
    if let Some(region) = pin.region {
        // Not by `<`, which is false for NaN.
        if !(0..3).all(|c| region.min[c] <= region.max[c]) {
            faults.push(("box", "min must not exceed max, and neither be NaN".to_owned()));
        }
    }
    if !(pin.start.is_finite() && pin.start >= 0.0) {
        faults.push(("start", format!("{} must be finite and at least 0", pin.start)));
    }
    if pin.end.is_nan() || pin.end <= pin.start {
        faults.push(("end", format!("{} must be later than start", pin.end)));
    }
    report(problems, source, path, &mut faults);
    validate_motion(pin.motion.as_ref(), source, path, problems);
}

fn placement(
    faults: &mut Vec<(&'static str, String)>,
    scale: f64,
    [rotate, translate, velocity]: [&Vector; 3],
) {
    for error in (Import { scale, ..Import::default() }).validate().err().into_iter().flatten() {
        faults.push(("scale", format!("{} {}", error.value, error.allowed)));
    }
    for (key, value) in [("rotate", rotate), ("translate", translate), ("velocity", velocity)] {
        if !value.iter().all(|c| c.is_finite()) {
            faults.push((key, "must be finite".to_owned()));
        }
    }
}

fn groups(faults: &mut Vec<(&'static str, String)>, groups: &[u32], collides_with: Option<&[u32]>) {
    for (key, list) in [("groups", groups), ("collides_with", collides_with.unwrap_or_default())] {
        if let Some(group) = list.iter().find(|group| **group > 31) {
            faults.push((key, format!("group {group} must be at most 31")));
        }
    }
    if groups.is_empty() {
        faults.push(("groups", "must name at least one group".to_owned()));
    }
}

fn geometry(faults: &mut Vec<(&'static str, String)>, mesh: bool, shape: Option<&Shape>, sequence: bool) {
    match (mesh, shape, sequence) {
        (true, Some(_), _) => {
            faults.push(("shape", "stands beside mesh; only one of them may be given".to_owned()))
        }
        (true, None, true) | (false, Some(_), true) => {
            faults.push(("sequence", "stands beside a mesh or a shape; only one may be given".to_owned()));
        }
        (false, None, false) => faults.push(("mesh", "needs a mesh file, or a shape".to_owned())),
        _ => {}
    }
}
