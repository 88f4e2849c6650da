//! Checks of a whole scene: every part by itself, and that the names by which parts refer to each other
//! exist.

use crate::description::Scene;
use crate::error::{SceneError, SceneProblem, nearest};
use crate::kind::BodyKind;
use crate::shapes::Shape;
use crate::source::Source;
use crate::values::join;
use bowknot_dynamics::Integrator;
use bowknot_errors::Parameters;
use std::collections::{BTreeSet, HashMap};

/// Checks the values of a scene that has been read or made in code.
pub(super) fn scene(scene: &Scene, source: &Source) -> Result<(), SceneError> {
    let mut problems = Vec::new();
    report_errors(&mut problems, source, "simulation", &scene.simulation);
    report_errors(&mut problems, source, "simulation", &scene.environment);
    // The paths of these parameters are keys of the scene.
    report_errors(&mut problems, source, "", &scene.twoway());
    report_errors(&mut problems, source, "solver.newton", &scene.solver.newton);
    report_errors(&mut problems, source, "solver.repulsion", &scene.solver.repulsion);
    report_errors(&mut problems, source, "solver.sleep", &scene.solver.sleep);
    report_errors(&mut problems, source, "output", &scene.output);
    for (index, body) in scene.bodies.iter().enumerate() {
        report_errors(&mut problems, source, &format!("body[{index}]"), body);
    }
    for (index, obstacle) in scene.obstacles.iter().enumerate() {
        report_errors(&mut problems, source, &format!("obstacle[{index}]"), obstacle);
    }
    for (index, pin) in scene.pins.iter().enumerate() {
        report_errors(&mut problems, source, &format!("pin[{index}]"), pin);
    }
    for (index, pair) in scene.friction_pairs.iter().enumerate() {
        report_errors(&mut problems, source, &format!("contact.friction_pairs[{index}]"), pair);
    }
    let mut references = References { scene, source, problems };
    references.check_names();
    references.check_pins();
    references.check_friction_pairs();
    references.check_integrator();
    let problems = references.problems;
    if !problems.is_empty() {
        return Err(SceneError::Invalid(problems));
    }
    if scene.bodies.is_empty() { Err(SceneError::Empty) } else { Ok(()) }
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
        problems.push(source.problem(&join(path, &error.path), message.trim_start()));
    }
}

/// Checks the names by which parts of a scene refer to each other.
struct References<'a> {
    scene: &'a Scene,
    source: &'a Source,
    problems: Vec<SceneProblem>,
}

impl<'a> References<'a> {
    /// No two bodies or obstacles share a name.
    fn check_names(&mut self) {
        let scene = self.scene;
        let mut names: HashMap<&str, String> = HashMap::new();
        let paths = (0..scene.bodies.len())
            .map(|i| format!("body[{i}]"))
            .chain((0..scene.obstacles.len()).map(|i| format!("obstacle[{i}]")));
        for (path, name) in paths.zip(self.bodies().chain(self.obstacles())) {
            if let Some(first) = names.insert(name, path.clone()) {
                let message = format!("{name:?} is the name of {first} already; names must differ");
                self.report(&path, "name", message);
            }
        }
    }

    /// Pins name a body that there is, of the kind that they need, and an obstacle that there is.
    fn check_pins(&mut self) {
        let scene = self.scene;
        for (index, pin) in scene.pins.iter().enumerate() {
            let path = format!("pin[{index}]");
            let body = scene.bodies.iter().find(|body| body.name == pin.body);
            if body.is_none() {
                let message = unknown("body", &pin.body, self.bodies());
                self.report(&path, "body", message);
            }
            if pin.roots > 0 && body.is_none_or(|body| body.kind != BodyKind::Strands) {
                let message = "only strands have roots; the body is of another kind";
                self.report(&path, "roots", message.to_owned());
            }
            if let Some(name) = &pin.follow {
                let with_mesh =
                    scene.obstacles.iter().filter(|o| !matches!(o.shape, Some(Shape::HalfSpace(_))));
                let names: Vec<&str> = with_mesh.map(|o| o.name.as_str()).collect();
                if !names.contains(&name.as_str()) {
                    self.report(&path, "follow", unknown("obstacle with a mesh", name, names.into_iter()));
                }
            }
        }
    }

    /// A method of second order carries contact forces from one stage to the next, so it needs to know them.
    fn check_integrator(&mut self) {
        let Scene { simulation, contact, solver, .. } = self.scene;
        let knows_contacts = solver.repulsion.knows_contacts(contact.friction_model);
        if simulation.integrator != Integrator::ImplicitEuler && !knows_contacts {
            let message = "needs contact forces in the dynamics: set solver.repulsion.stiffness above 0, \
                           solver.repulsion.law to \"contact\" and contact.friction_model to \"coulomb\", \
                           or use \"implicit-euler\"";
            self.report("simulation", "integrator", message.to_owned());
        }
    }

    /// Pairs with friction of their own name two that there are and that can touch; no pair is named twice.
    fn check_friction_pairs(&mut self) {
        let mut seen = BTreeSet::new();
        for (index, pair) in self.scene.friction_pairs.iter().enumerate() {
            let path = format!("contact.friction_pairs[{index}]");
            for name in &pair.bodies {
                let all = || self.bodies().chain(self.obstacles());
                if !all().any(|known| known == name) {
                    let message = unknown("body or obstacle", name, all());
                    self.report(&path, "bodies", message);
                }
            }
            if pair.bodies.iter().all(|name| self.obstacles().any(|obstacle| obstacle == name)) {
                let message = "two obstacles never touch; one of the two must be a body";
                self.report(&path, "bodies", message.to_owned());
            }
            let mut sides = pair.bodies.clone();
            sides.sort_unstable();
            if !seen.insert(sides) {
                self.report(&path, "bodies", "the pair is named by an entry above already".to_owned());
            }
        }
    }

    fn bodies(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        self.scene.bodies.iter().map(|body| body.name.as_str())
    }

    fn obstacles(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        self.scene.obstacles.iter().map(|obstacle| obstacle.name.as_str())
    }

    fn report(&mut self, path: &str, key: &str, message: String) {
        self.problems.push(self.source.problem(&join(path, key), message));
    }
}

/// Says that there is nothing of a name, what there is, and which of it may have been meant.
pub(crate) fn unknown<'a>(what: &str, name: &str, known: impl Iterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.collect();
    let hint = nearest(name, known.iter().copied());
    let hint = hint.map_or_else(String::new, |name| format!("; did you mean {name}?"));
    format!("no {what} {name:?}; there are: {}{hint}", known.join(", "))
}
