//! Collision problems: recorded from a simulation, solved again outside of it.

use crate::io::States;
use crate::simulator::{CollisionProblem, Simulator};
use bowknot_geometry::Topology;
use bowknot_proximity::{BodyFilter, CollisionModel};
use bowknot_twoway::{Params, ResolveError, ResolveInput, Resolver};
use std::collections::BTreeMap;

/// Makes files of the collision problems of one simulation.
#[derive(Clone, Debug)]
pub struct Recorder {
    /// All but what moves.
    fixed: States,
}

impl Recorder {
    /// A recorder of the simulation's problems.
    pub fn new(simulator: &Simulator) -> Self {
        let world = simulator.world();
        let count = world.collision_vertices();
        let topology = world.collision.topology();
        let contact = &world.contact;
        Self {
            fixed: States {
                triangles: topology.triangles.clone(),
                strands: topology.strand_edges.iter().map(|&e| topology.edges[e as usize]).collect(),
                particles: topology.particles.clone(),
                rest: world.positions[..count].to_vec(),
                masses: simulator.dynamics_model().masses()[..count].to_vec(),
                obstacle: (0..count as u32).map(|v| world.collision.is_obstacle(v)).collect(),
                body: world.collision.vertex_body().to_vec(),
                half_spaces: world.collision.half_spaces().to_vec(),
                body_contacts: contact.bodies.clone(),
                half_space_contacts: contact.half_spaces.clone(),
                pair_frictions: contact.pairs.clone(),
                ..States::default()
            },
        }
    }

    /// The problem as a file holds it: all that its solution depends on but the parameters of the method.
    pub fn states(&self, problem: &CollisionProblem<'_>) -> States {
        States {
            x: problem.positions.to_vec(),
            y: problem.target.to_vec(),
            fixed: problem.prescribed.to_vec(),
            time_step: Some(problem.time_step),
            groups: problem.groups.to_vec(),
            start: problem.start.to_vec(),
            ..self.fixed.clone()
        }
    }
}

impl States {
    /// The collision model of the problem: a body is an obstacle if all its vertices are.
    ///
    /// # Errors
    /// A mesh that is none, a body with obstacle and deformable vertices; in words.
    pub fn collision_model(&self) -> Result<CollisionModel, String> {
        let topology = Topology::new(self.x.len(), self.triangles.clone(), &self.strands, &self.particles)
            .map_err(|errors| first_of(&errors))?;
        let mut obstacle: BTreeMap<u32, bool> = BTreeMap::new();
        for (vertex, (&body, &flag)) in self.body.iter().zip(&self.obstacle).enumerate() {
            if *obstacle.entry(body).or_insert(flag) != flag {
                return Err(format!(
                    "array O: body {body} has obstacle and deformable vertices (vertex {vertex} differs from its \
                     first)"
                ));
            }
        }
        let count = obstacle.keys().next_back().map_or(0, |&body| body as usize + 1);
        let filter = |body: u32| match obstacle.get(&body) {
            Some(true) => BodyFilter::OBSTACLE,
            _ => BodyFilter::DEFORMABLE,
        };
        let filters = (0..count as u32).map(filter).collect();
        CollisionModel::new(topology, self.body.clone(), filters, self.half_spaces.clone())
            .map_err(|error| error.to_string())
    }

    /// The two-way method for the problem, over its [`Self::collision_model`].
    ///
    /// # Errors
    /// As [`Resolver::new`] and [`Resolver::with_bodies`].
    pub fn resolver(&self, model: CollisionModel, params: Params) -> Result<Resolver, ResolveError> {
        let mut resolver = Resolver::new(model, &self.rest, &self.masses, params)?;
        if !self.body_contacts.is_empty() {
            resolver = resolver.with_bodies(self.body_contacts.clone())?;
        }
        if !self.half_space_contacts.is_empty() {
            resolver = resolver.with_half_spaces(self.half_space_contacts.clone())?;
        }
        resolver.with_pair_friction(&self.pair_frictions)
    }

    /// The call that the problem stands for.
    pub fn input(&self) -> ResolveInput<'_> {
        ResolveInput {
            prescribed: &self.fixed,
            time_step: self.time_step,
            start: (!self.start.is_empty()).then_some(&self.start),
            groups: &self.groups,
            max_steps: None,
        }
    }
}

fn first_of(errors: &[impl ToString]) -> String {
    let first = errors.first().map(ToString::to_string).unwrap_or_default();
    if errors.len() > 1 { format!("{first}; and {} more", errors.len() - 1) } else { first }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;
    use crate::simulator::Watcher;
    use bowknot_geometry::Point;
    use std::ops::ControlFlow;

    /// Solves each problem again from its file, and keeps both ends.
    struct Again {
        recorder: Recorder,
        params: Params,
        path: std::path::PathBuf,
        ends: Vec<Vec<Point>>,
    }

    impl Watcher for Again {
        fn problem(&mut self, problem: &CollisionProblem<'_>) -> ControlFlow<()> {
            let states = self.recorder.states(problem);
            states.write(&self.path).expect("written");
            let read = States::read(&self.path).expect("read");
            let model = read.collision_model().expect("a model");
            let mut resolver = read.resolver(model, self.params.clone()).expect("a resolver");
            let mut x = read.x.clone();
            resolver.resolve_with(&mut x, &read.y, &read.input(), &mut ()).expect("resolved");
            self.ends.push(x);
            ControlFlow::Continue(())
        }
    }

    /// Grains of their own size with friction on a plane, and a sheet with pins: the file holds all that matters.
    #[test]
    fn a_recorded_problem_ends_where_the_simulation_did() {
        let text = r#"
            [[body]]
            kind = "particles"
            shape = { type = "grains", count = [5, 5, 4], spacing = 0.0045 }
            delta = 0.004
            thickness = 0.003
            friction = 0.4
            translate = [0.0, 0.0, 0.012]

            [[body]]
            name = "sheet"
            shape = { type = "sheet", size = [0.1, 0.1], edge = 0.02 }
            translate = [0.0, 0.0, 0.06]

            [[pin]]
            body = "sheet"
            side = "x-max"
            motion = { keyframes = [{ time = 0.0 }, { time = 1.0, translate = [0.1, 0.0, -0.5] }] }

            [[obstacle]]
            shape = { type = "half-space" }
            friction = 0.3
        "#;
        let scene = Scene::from_toml(text, ".").expect("a scene");
        let folder = tempfile::tempdir().expect("a folder");
        let mut simulator = Simulator::new(&scene).expect("a simulator");
        let mut again = Again {
            recorder: Recorder::new(&simulator),
            params: scene.twoway.clone(),
            path: folder.path().join("problem.npz"),
            ends: Vec::new(),
        };
        for step in 0..8 {
            simulator.step_watched(&mut again).expect("a step");
            let count = simulator.world().collision_vertices();
            let end = again.ends.last().expect("a problem in each step");
            assert!(*end == simulator.positions()[..count], "step {step} ends elsewhere");
        }
    }
}
