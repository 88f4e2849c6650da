//! Checks of a whole scene: what the parts of a description must not contradict.

use crate::body::{ObstacleSpec, PinSpec};
use crate::contact;
use crate::description::Scene;
use crate::error::{SceneError, SceneProblem, nearest};
use crate::kind::BodyKind;
use crate::motion::Motion;
use crate::shapes::Shape;
use crate::source::Source;
use crate::values::join;
use bowknot_errors::Parameters;
use bowknot_geometry::Vector;
use bowknot_io::Import;
use std::collections::HashMap;

/// Checks the values of a scene that has been read or made in code.
pub(super) fn scene(scene: &Scene, source: &Source) -> Result<(), SceneError> {
    let mut problems = Vec::new();
    report_errors(&mut problems, source, "simulation", &scene.simulation);
    report_errors(&mut problems, source, "simulation", &scene.environment);
    report_errors(&mut problems, source, "solver.newton", &scene.solver.newton);
    report_errors(&mut problems, source, "solver.repulsion", &scene.solver.repulsion);
    report_errors(&mut problems, source, "output", &scene.output);
    // The paths of these parameters are keys of the scene.
    report_errors(&mut problems, source, "", &scene.twoway());
    validate_bodies(scene, source, &mut problems);
    contact::validate_pairs(scene, source, &mut problems);
    for (index, pin) in scene.pins.iter().enumerate() {
        validate_pin(scene, pin, source, &format!("pin[{index}]"), &mut problems);
    }
    if !problems.is_empty() {
        return Err(SceneError::Invalid(problems));
    }
    if scene.bodies.is_empty() { Err(SceneError::Empty) } else { Ok(()) }
}

fn report(
    problems: &mut Vec<SceneProblem>,
    source: &Source,
    path: &str,
    faults: &mut Vec<(&'static str, String)>,
) {
    problems.extend(faults.drain(..).map(|(key, message)| source.problem(&join(path, key), message)));
}

fn validate_bodies(scene: &Scene, source: &Source, problems: &mut Vec<SceneProblem>) {
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

fn validate_shape(shape: Option<&Shape>, source: &Source, path: &str, problems: &mut Vec<SceneProblem>) {
    if let Some(shape) = shape {
        report_errors(problems, source, &join(path, "shape"), shape);
    }
}

fn validate_motion(motion: Option<&Motion>, source: &Source, path: &str, problems: &mut Vec<SceneProblem>) {
    if let Some(motion) = motion {
        report_errors(problems, source, &join(path, "motion"), motion);
    }
}

/// Reports the fields of a struct that are out of their range, with the struct's place in the scene.
pub(super) fn report_errors(
    problems: &mut Vec<SceneProblem>,
    source: &Source,
    path: &str,
    parameters: &impl Parameters,
) {
    for error in parameters.validate().err().into_iter().flatten() {
        let message = format!("{} {}", error.value, error.allowed);
        problems.push(source.problem(&join(path, &error.path), message));
    }
}

fn validate_pin(scene: &Scene, pin: &PinSpec, source: &Source, path: &str, problems: &mut Vec<SceneProblem>) {
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
