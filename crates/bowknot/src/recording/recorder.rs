//! Makes files of the collision problems of a simulation.

use crate::recording::filters;
use crate::recording::states::States;
use crate::simulator::{CollisionProblem, Simulator};
use bowknot_geometry::Point;
use bowknot_scene::world::World;

/// Makes files of the collision problems of one simulation.
#[derive(Clone, Debug)]
pub struct Recorder {
    /// All but what moves.
    fixed: States,
}

impl Recorder {
    /// A recorder of the simulation's problems, until another obstacle appears or vanishes.
    pub fn new(simulator: &Simulator) -> Self {
        Self::of_world(simulator.world(), simulator.present(), simulator.dynamics_model().masses())
    }

    /// A recorder of problems of a scene with those bodies and half-spaces that are `present`, whose vertices
    /// have these masses [kg].
    pub(crate) fn of_world(world: &World, present: &[bool], masses: &[f64]) -> Self {
        let count = world.collision_vertices();
        let topology = world.collision.topology();
        let contact = &world.contact;
        let (bodies, half_spaces) = world.filters(present);
        Self {
            fixed: States {
                triangles: topology.triangles.clone(),
                strands: topology.strand_edges.iter().map(|&e| topology.edges[e as usize]).collect(),
                particles: topology.particles.clone(),
                rest: world.positions[..count].to_vec(),
                masses: masses[..count].to_vec(),
                obstacle: (0..count as u32).map(|v| world.collision.is_obstacle(v)).collect(),
                body: world.collision.vertex_body().to_vec(),
                half_spaces,
                body_contacts: contact.bodies.clone(),
                half_space_contacts: contact.half_spaces.clone(),
                pair_frictions: contact.pairs.clone(),
                filters: filters::kept(bodies),
                ..States::default()
            },
        }
    }

    /// The problem that has these positions [m] as its start and as its target.
    pub(crate) fn at_rest(&self, positions: &[Point]) -> States {
        let fixed = self.fixed.obstacle.clone();
        States { x: positions.to_vec(), y: positions.to_vec(), fixed, ..self.fixed.clone() }
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
            known: problem.known.to_vec(),
            carried: problem.carried.to_vec(),
            yielding: problem.yielding.to_vec(),
            ..self.fixed.clone()
        }
    }
}
