//! All springs of a scene, over nodes.

use super::spring::{RepulsionSpring, SpringKind};
use super::state::SpringState;
use crate::error::StepError;
use crate::groups::{Groups, Hold};
use crate::linear::springs::{LinearSprings, visit_nodes};
use crate::model::DynamicsModel;
use crate::nodes::{CHUNK, NO_NODE};
use bowknot_geometry::{Point, Vector};
use rayon::prelude::*;

/// The springs of a scene, over nodes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Repulsion {
    pub(super) springs: Vec<RepulsionSpring>,
    /// Nodes of each spring; [`NO_NODE`] for obstacles and weights of 0.
    pub(super) nodes: Vec<[u32; 4]>,
    /// The nodes that springs act on, ascending. Positions have one entry for each of them.
    watched: Vec<u32>,
    /// Places of [`Self::nodes`] among the watched ones.
    pub(super) places: Vec<[u32; 4]>,
    /// The share of obstacles in s [m].
    fixed: Vec<Vector>,
    /// The part of the gap that prescribed nodes lack, see [`Self::note_lacking`] [m].
    lacking: Vec<f64>,
    /// s at the start of the time step [m].
    anchors: Vec<Vector>,
    /// What changes from solve to solve.
    pub(super) states: Vec<SpringState>,
    /// Whether the next linearization takes sliding friction for as stiff in its direction as across it. That
    /// is a majorizer of its energy: steps are shorter, but do not overshoot.
    pub majorizes_friction: bool,
    /// The springs that pushed at the last linearization.
    pub(super) linear: LinearSprings,
}

impl Repulsion {
    /// Checks the springs and looks up their nodes.
    pub fn new(model: &DynamicsModel, springs: &[RepulsionSpring]) -> Result<Self, StepError> {
        Self::over(springs, model.vertex_count(), model.node_vertex.len(), |v| model.vertex_node[v as usize])
    }

    /// Checks springs of so many vertices, and looks up their nodes with `node_of`.
    pub fn over(
        springs: &[RepulsionSpring],
        vertex_count: usize,
        node_count: usize,
        node_of: impl Fn(u32) -> u32 + Sync,
    ) -> Result<Self, StepError> {
        for (spring, s) in springs.iter().enumerate() {
            let refuse = |problem| Err(StepError::Repulsion { spring, problem });
            if s.vertices.iter().zip(s.weights).any(|(&v, w)| w != 0.0 && v as usize >= vertex_count) {
                return refuse("it names a vertex that does not exist");
            }
            let numbers = s.weights.iter().chain(s.normal.iter()).chain(s.friction_ratio.iter());
            if !numbers.chain([&s.offset, &s.reach, &s.floor, &s.start_gap]).all(|value| value.is_finite()) {
                return refuse("its weights, normal, offset, gaps and friction must be finite");
            }
            if ![s.stiffness, s.friction].iter().all(|value| *value >= 0.0 && value.is_finite()) {
                return refuse("its stiffness and friction must be finite and at least 0");
            }
            if s.floor >= s.reach {
                return refuse("its floor must be below its reach");
            }
            if s.kind != SpringKind::Contact && s.friction != 0.0 {
                return refuse("only a contact has friction");
            }
        }
        let node = |v: u32, w: f64| if w == 0.0 { NO_NODE } else { node_of(v) };
        let nodes_of = |s: &RepulsionSpring| std::array::from_fn(|k| node(s.vertices[k], s.weights[k]));
        let nodes: Vec<[u32; 4]> = springs.par_iter().with_min_len(CHUNK).map(nodes_of).collect();
        // Which nodes are watched, then the place of each among them.
        let mut place = vec![NO_NODE; node_count];
        nodes.iter().flatten().filter(|node| **node != NO_NODE).for_each(|&node| place[node as usize] = 0);
        let mut watched = Vec::new();
        for (node, place) in (0..).zip(&mut place).filter(|(_, place)| **place != NO_NODE) {
            *place = watched.len() as u32;
            watched.push(node);
        }
        let place = |node: u32| if node == NO_NODE { NO_NODE } else { place[node as usize] };
        let places = nodes.par_iter().with_min_len(CHUNK).map(|nodes| nodes.map(place)).collect();
        let count = springs.len();
        Ok(Self {
            springs: springs.to_vec(),
            nodes,
            watched,
            places,
            fixed: vec![Vector::zeros(); count],
            lacking: vec![0.0; count],
            anchors: vec![Vector::zeros(); count],
            states: vec![SpringState::default(); count],
            majorizes_friction: false,
            linear: LinearSprings::new(node_count),
        })
    }

    /// Whether there are no springs.
    pub fn is_empty(&self) -> bool {
        self.springs.is_empty()
    }

    /// The nodes that springs act on, ascending: positions of nodes are given for these.
    pub fn watched(&self) -> &[u32] {
        &self.watched
    }

    /// The springs that pushed at the last linearization.
    pub fn linear(&self) -> &LinearSprings {
        &self.linear
    }

    /// Sets the positions `x` of all vertices from which slip is measured: those at the start of the time
    /// step.
    pub fn anchor(&mut self, x: &[Point]) {
        let springs = self.anchors.par_iter_mut().zip(&self.springs).with_min_len(CHUNK);
        springs.for_each(|(anchor, s)| {
            let used = (0..4).filter(|&k| s.weights[k] != 0.0);
            *anchor = used.map(|k| x[s.vertices[k] as usize].coords * s.weights[k]).sum();
        });
    }

    /// Places obstacles at their keyframes, which have one entry per vertex.
    pub fn place_obstacles(&mut self, keyframes: &[Point]) {
        let springs = self.fixed.par_iter_mut().zip(&self.springs).zip(&self.nodes).with_min_len(CHUNK);
        springs.for_each(|((fixed, spring), nodes)| {
            let obstacles = (0..4).filter(|&k| nodes[k] == NO_NODE && spring.weights[k] != 0.0);
            *fixed =
                obstacles.map(|k| keyframes[spring.vertices[k] as usize].coords * spring.weights[k]).sum();
        });
    }

    /// Notes what is added to each gap because of prescribed nodes, with watched nodes at `x`, those that are
    /// not `free` at their ends; `free` has one entry per node.
    ///
    /// Where prescribed nodes come nearer than the reach, the free nodes of their side would have to make up
    /// for it. With a closest point near a prescribed node they have a short lever, and would have to go far.
    /// So a prescribed node counts as if it were at the reach.
    pub(super) fn note_lacking(&mut self, free: &[bool], x: &[Vector]) {
        for (spring, lacking) in self.lacking.iter_mut().enumerate() {
            let (s, nodes, places) = (&self.springs[spring], &self.nodes[spring], &self.places[spring]);
            *lacking = 0.0;
            for sign in [1.0, -1.0] {
                let on_side = |k: &usize| nodes[*k] != NO_NODE && sign * s.weights[*k] > 0.0;
                let is_free = |k: usize| free[nodes[k] as usize];
                let prescribed = (0..4).filter(on_side).filter(|&k| !is_free(k));
                if prescribed.clone().next().is_none() || !(0..4).filter(on_side).any(is_free) {
                    continue;
                }
                // The other side's closest point, with the sign of its weights; obstacles are one side of a
                // pair.
                let others = (0..4).filter(|&k| nodes[k] != NO_NODE && sign * s.weights[k] < 0.0);
                let opposite: Vector = others.map(|k| x[places[k] as usize] * s.weights[k]).sum();
                let opposite = opposite + self.fixed[spring];
                let gap = |k: usize| s.normal.dot(&(x[places[k] as usize] * sign + opposite)) - s.offset;
                *lacking += prescribed.map(|k| s.weights[k].abs() * (s.reach - gap(k)).max(0.0)).sum::<f64>();
            }
        }
    }

    /// Gap [m] and slip [m] with watched nodes at `x`.
    #[inline]
    pub(super) fn gap_and_slip(&self, spring: usize, x: &[Vector]) -> (f64, Vector) {
        let s = &self.springs[spring];
        let sides = self.sides(spring, x);
        if s.kind == SpringKind::Limit {
            return (-s.offset - sides.norm(), Vector::zeros());
        }
        let moved = sides - self.anchors[spring];
        let gap = s.normal.dot(&sides) - s.offset + self.lacking[spring];
        (gap, moved - s.normal * s.normal.dot(&moved))
    }

    /// Gap at the start of the time step [m], with what prescribed nodes lack at its end.
    pub(super) fn start_gap(&self, spring: usize) -> f64 {
        self.springs[spring].start_gap + self.lacking[spring]
    }

    /// The direction in which the gap opens, with watched nodes at `x`: that of a limit turns with its ends.
    pub(super) fn normal(&self, spring: usize, x: &[Vector]) -> Vector {
        let s = &self.springs[spring];
        match s.kind {
            SpringKind::Contact | SpringKind::Repulsion => s.normal,
            SpringKind::Limit => (-self.sides(spring, x)).try_normalize(0.0).unwrap_or(s.normal),
        }
    }

    /// s = sum beta_i x_i with watched nodes at `x` [m].
    fn sides(&self, spring: usize, x: &[Vector]) -> Vector {
        let mut sides = self.fixed[spring];
        for (&place, weight) in self.places[spring].iter().zip(self.springs[spring].weights) {
            if place != NO_NODE {
                sides += x[place as usize] * weight;
            }
        }
        sides
    }

    /// Forces of the springs with watched nodes at `x` [N], by spring. Friction is bounded by the normal
    /// force there.
    pub fn forces(&self, x: &[Vector]) -> Vec<Vector> {
        let force = |spring: usize| {
            let (state, s) = (&self.states[spring], &self.springs[spring]);
            if !state.acts {
                return Vector::zeros();
            }
            let (gap, slip) = self.gap_and_slip(spring, x);
            let push = state.push(gap).force;
            let bound = s.friction * push;
            self.normal(spring, x) * push + state.rub(&slip, bound).force
        };
        (0..self.springs.len()).into_par_iter().with_min_len(CHUNK).map(force).collect()
    }

    /// The forces of the springs on the watched nodes at `x` [N].
    pub fn forces_on_nodes(&self, x: &[Vector]) -> Vec<Vector> {
        let mut forces = vec![Vector::zeros(); self.watched.len()];
        for ((force, spring), places) in self.forces(x).iter().zip(&self.springs).zip(&self.places) {
            for (&place, weight) in places.iter().zip(spring.weights) {
                if place != NO_NODE {
                    forces[place as usize] += force * weight;
                }
            }
        }
        forces
    }

    /// Joins the components that springs join, and holds those that springs join to obstacles and
    /// half-spaces. All springs count, or those `pushing` at the last linearization.
    pub fn join(&self, model: &DynamicsModel, groups: &mut Groups, pushing: bool) {
        for ((spring, nodes), state) in self.springs.iter().zip(&self.nodes).zip(&self.states) {
            if pushing && !state.pushes() {
                continue;
            }
            visit_nodes(nodes, &spring.weights, |nodes, held| {
                let hold =
                    if held { Hold::contact(&spring.normal, spring.friction > 0.0) } else { Hold::NONE };
                groups.join_all(nodes.iter().map(|&node| model.component(node)), hold);
            });
        }
    }
}
