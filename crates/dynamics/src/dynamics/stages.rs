//! Time integration in stages, each of which is a step of implicit Euler from a place and a velocity of its own.
//!
//! [`Integrator::Sdirk2`] is the singly diagonally implicit Runge-Kutta method of two stages and second order that is
//! L-stable (Alexander 1977, "Diagonally implicit Runge-Kutta methods for stiff O.D.E.'s"; compared with others for
//! elastic bodies by Loeschner et al. 2020, "Higher-order time integration for deformable solids"). With g = 1 - 1/sqrt(2)
//! and h = g dt,
//!
//! ```text
//! x1 = x0 + h v1                   v1 = v0 + h a(x1, v1)
//! x2 = x* + h v2                   v2 = v* + h a(x2, v2)
//! x* = x0 + (1 - g) dt v1          v* = v0 + (1 - g) dt a1
//! ```
//!
//! x2 and v2 are the end of the time step. A vibration of angular frequency w keeps the share 1 - 0.0074 (w dt)^4 of its
//! energy; implicit Euler keeps 1 - (w dt)^2.
//!
//! Contacts are not smooth. What stops a vertex within a stage would, carried forward by v* and x*, throw it back. So
//! contact forces are split:
//!
//! | part | in v* |
//! |---|---|
//! | forces on what was pressed as much before the stage | with the weight (1 - g) dt, as all other forces |
//! | the rest | once, h: as impulses that are over |
//!
//! and at the end of each stage, velocities at which contacts close or open and at which those that stick slip are taken
//! away, by pairs of impulses of at most `REBOUND` times those of the contact in the stage. They take kinetic energy
//! and conserve momentum. The position of a vertex in contact thus follows the contact, and its speed is that of what it
//! touches: impacts are plastic, and what bounces does so by the elasticity of the bodies. Contact-implicit forms of
//! Newmark's method have the same split (Kane et al. 1999, "Finite element methods in solid mechanics with contact";
//! Deuflhard et al. 2008, "A contact-stabilized Newmark method for dynamical contact problems").

use super::Dynamics;
use super::newton::state::{Earlier, Step};
use crate::nodes::NO_NODE;
use crate::params::Integrator;
use crate::repulsion::impacts::Impacts;
use bowknot_geometry::{Point, Vector};

/// g = 1 - 1/sqrt(2).
const GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;

/// Largest impulse that takes a velocity away, in impulses of the contact during the stage: what x* and v* carry forward
/// of it, (1 - g) / g.
const REBOUND: f64 = (1.0 - GAMMA) / GAMMA;

impl Integrator {
    /// The ends of its stages, as shares of the time step [1].
    pub fn stage_ends(self) -> &'static [f64] {
        match self {
            Self::ImplicitEuler => &[1.0],
            Self::Sdirk2 => &[GAMMA, 1.0],
        }
    }

    /// By how much implicit Euler goes on in each stage, as a share of the time step [1].
    pub fn stage_length(self) -> f64 {
        match self {
            Self::ImplicitEuler => 1.0,
            Self::Sdirk2 => GAMMA,
        }
    }

    /// How far a constant acceleration leads what contacts of the collision stage alone hold at rest to its target in each
    /// stage, as a share of the acceleration times the time step squared [1]. With two stages it has the velocity
    /// (1 - 2 g) dt of the acceleration there: x* and v* take nothing over from such contacts.
    pub fn held_way(self) -> f64 {
        match self {
            Self::ImplicitEuler => 1.0,
            Self::Sdirk2 => GAMMA * (1.0 - GAMMA),
        }
    }
}

impl Dynamics {
    /// Begins the next stage of the time step after one that ended at `x` [m]. Call it once after each of
    /// [`Integrator::stage_ends`] but the last, with the springs that were in force there.
    /// Slices have one entry per vertex. Without a step that was begun nothing happens.
    pub fn next_stage(&mut self, x: &[Point], prescribed: &[bool]) {
        let Some(mut step) = self.step.take() else { return };
        let length = step.dt;
        let ahead = step.whole - 2.0 * length;
        let mut v: Vec<Vector> = x.iter().zip(step.from()).map(|(x, from)| (x - from) / length).collect();
        let forces = self.outer_forces(&step, &v);
        // The acceleration is that by which nodes were to go. Where the collision stage has held them back, it would
        // throw them back.
        let by_node = step.wanted.iter().zip(&step.start).zip(&step.velocities);
        let mut accelerations: Vec<Vector> =
            by_node.map(|((wanted, start), v)| ((wanted - start) / length - v) / length).collect();
        let impacts = self.impacts(x, prescribed, length);
        let pressed = impacts.pressures(accelerations.len());
        impacts.take_sudden_forces(&step.pressed, &pressed, &self.model.node_masses, &mut accelerations);
        impacts.stop(&self.model.node_masses, REBOUND, &mut v);

        let from: Vec<Point> = x.iter().zip(&v).map(|(x, v)| x + v * ahead).collect();
        for (v, &node) in v.iter_mut().zip(&self.model.vertex_node).filter(|(_, node)| **node != NO_NODE) {
            let vertex = self.model.node_vertex[node as usize] as usize;
            if !prescribed[vertex] {
                *v += accelerations[node as usize] * ahead;
            }
        }
        // What presses too much, as where bodies start too near to each other, would throw them apart.
        impacts.stop(&self.model.node_masses, REBOUND, &mut v);
        let (start, velocities) = (std::mem::take(&mut step.start), std::mem::take(&mut step.velocities));
        step.earlier = Some(Box::new(Earlier { start, velocities, from: from.clone(), forces }));
        step.pressed = pressed;
        step.positions.copy_from_slice(x);
        self.enter(step, &from, &v);
    }

    /// Notes how much contacts press on nodes at the start of a time step of several stages, at the iterate.
    pub(super) fn record_pressure(&mut self, step: &mut Step, x: &[Point], prescribed: &[bool]) {
        if self.params.integrator.stage_ends().len() == 1 || !step.pressed.is_empty() {
            return;
        }
        let iterate: Vec<Vector> =
            self.repulsion.watched().iter().map(|&node| self.work.x[node as usize]).collect();
        self.repulsion.place_obstacles(x);
        self.repulsion.prepare(&self.model, 1.0 / step.dt, &self.work.free, &iterate, None);
        step.pressed = self.impacts(x, prescribed, step.dt).pressures(self.model.node_vertex.len());
    }

    /// Velocities at the end of the time step, at positions `x` [m], before momenta are conserved, in `v` [m/s].
    pub(super) fn stage_velocities(&self, step: &Step, x: &[Point], prescribed: &[bool], v: &mut [Vector]) {
        for ((v, x), from) in v.iter_mut().zip(x).zip(step.from()) {
            *v = (x - from) / step.dt;
        }
        if step.earlier.is_some() {
            // What the collision stage does to the way counts as a change of the mean velocity of the stage.
            let surplus = 1.0 / step.dt - 1.0 / (step.whole - step.dt);
            for (wanted, &vertex) in step.wanted.iter().zip(&self.model.node_vertex) {
                let vertex = vertex as usize;
                if !prescribed[vertex] {
                    v[vertex] -= (x[vertex].coords - wanted) * surplus;
                }
            }
            self.impacts(x, prescribed, step.dt).stop(&self.model.node_masses, REBOUND, v);
        }
    }

    /// The contacts that press at positions `x` [m] at the end of a stage of so many seconds.
    fn impacts(&self, x: &[Point], prescribed: &[bool], length: f64) -> Impacts {
        let at = |&node: &u32| x[self.model.node_vertex[node as usize] as usize].coords;
        let watched: Vec<Vector> = self.repulsion.watched().iter().map(at).collect();
        self.repulsion.impacts(&watched, length, |vertex| {
            let node = self.model.vertex_node[vertex as usize];
            (node != NO_NODE && !prescribed[vertex as usize]).then_some(node)
        })
    }

    fn by_node<'a>(&'a self, of_vertices: &'a [Vector]) -> impl Iterator<Item = Vector> + 'a {
        self.model.node_vertex.iter().map(|&vertex| of_vertices[vertex as usize])
    }

    fn outer_forces(&self, step: &Step, v: &[Vector]) -> Vec<Vector> {
        let of_nodes: Vec<Vector> = self.by_node(v).collect();
        self.end_of(step).outer_forces(&of_nodes)
    }
}
