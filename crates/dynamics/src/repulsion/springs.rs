//! All springs of a scene, over nodes.

use super::spring::RepulsionSpring;
use super::state::SpringState;
use crate::error::StepError;
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
    /// The part of the desired gap that prescribed nodes lack, see [`Self::note_lacking`] [m].
    lacking: Vec<f64>,
    /// s at the start of the time step [m].
    anchors: Vec<Vector>,
    pub(super) states: Vec<SpringState>,
    /// Whether the active set (which springs push, stick and slide) is a guess. Energies take a guess as
    /// given until the first update.
    pub(super) guessed: bool,
    /// The active springs at the last linearization.
    pub(super) linear: LinearSprings,
}

impl Repulsion {
    /// Checks the springs and looks up their nodes.
    pub fn new(model: &DynamicsModel, springs: &[RepulsionSpring]) -> Result<Self, StepError> {
        for (spring, s) in springs.iter().enumerate() {
            let refuse = |problem| Err(StepError::Repulsion { spring, problem });
            if s.vertices.iter().zip(s.weights).any(|(&v, w)| w != 0.0 && v as usize >= model.vertex_count())
            {
                return refuse("it names a vertex that does not exist");
            }
            let numbers = s.weights.iter().chain(s.normal.iter()).chain(s.force.iter());
            if !numbers.chain([&s.offset, &s.desired]).all(|value| value.is_finite()) {
                return refuse("its weights, normal, offset, desired gap and force must be finite");
            }
            if ![s.stiffness, s.friction].iter().all(|value| *value >= 0.0 && value.is_finite()) {
                return refuse("its stiffness and friction must be finite and at least 0");
            }
        }
        let node = |v: u32, w: f64| if w == 0.0 { NO_NODE } else { model.vertex_node[v as usize] };
        let nodes_of = |s: &RepulsionSpring| std::array::from_fn(|k| node(s.vertices[k], s.weights[k]));
        let nodes: Vec<[u32; 4]> = springs.par_iter().with_min_len(CHUNK).map(nodes_of).collect();
        // Which nodes are watched, then the place of each among them.
        let mut place = vec![NO_NODE; model.node_vertex.len()];
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
            states: vec![SpringState::INACTIVE; count],
            guessed: false,
            linear: LinearSprings::new(model.node_vertex.len()),
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

    /// The active springs at the last linearization.
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

    /// Notes the part of each desired gap that springs do not ask for, with watched nodes at `x`, those that are not
    /// `free` at their ends; `free` has one entry per node.
    ///
    /// Where prescribed nodes come nearer than desired, the free nodes of their side would have to make up for it. With
    /// a closest point near a prescribed node they have a short lever, and would have to go far. So springs ask free
    /// nodes for no more than the gap in their own places.
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
                // The other side's closest point, with the sign of its weights; obstacles are one side of a pair.
                let others = (0..4).filter(|&k| nodes[k] != NO_NODE && sign * s.weights[k] < 0.0);
                let opposite: Vector = others.map(|k| x[places[k] as usize] * s.weights[k]).sum();
                let opposite = opposite + self.fixed[spring];
                let gap = |k: usize| s.normal.dot(&(x[places[k] as usize] * sign + opposite)) - s.offset;
                *lacking +=
                    prescribed.map(|k| s.weights[k].abs() * (s.desired - gap(k)).max(0.0)).sum::<f64>();
            }
        }
    }

    /// Depth below the desired gap [m] and slip [m] with watched nodes at `x`.
    #[inline]
    pub(super) fn depth_and_slip(&self, spring: usize, x: &[Vector]) -> (f64, Vector) {
        let s = &self.springs[spring];
        let mut sides = self.fixed[spring];
        for (&place, weight) in self.places[spring].iter().zip(s.weights) {
            if place != NO_NODE {
                sides += x[place as usize] * weight;
            }
        }
        let moved = sides - self.anchors[spring];
        let desired = s.desired - self.lacking[spring];
        (desired + s.offset - s.normal.dot(&sides), moved - s.normal * s.normal.dot(&moved))
    }

    /// Forces of the springs with watched nodes at `x` [N], by spring: the multipliers that the next solve starts
    /// from.
    pub fn forces(&self, x: &[Vector]) -> Vec<Vector> {
        let force = |spring: usize| {
            let (state, s) = (&self.states[spring], &self.springs[spring]);
            if !state.active {
                return Vector::zeros();
            }
            let (depth, slip) = self.depth_and_slip(spring, x);
            let lambda = (state.lambda + state.stiffness * depth).max(0.0);
            let friction = state.coulomb(state.tau(), &slip, s.friction * lambda);
            s.normal * lambda + SpringState { friction, ..*state }.tau()
        };
        (0..self.springs.len()).into_par_iter().with_min_len(CHUNK).map(force).collect()
    }

    /// Subtracts the known forces of the springs on the nodes from `gradient` [N].
    pub fn subtract_known_forces(&self, gradient: &mut [Vector]) {
        for (spring, nodes) in self.springs.iter().zip(&self.nodes) {
            for (&node, weight) in nodes.iter().zip(spring.weights) {
                if node != NO_NODE {
                    gradient[node as usize] -= spring.force * weight;
                }
            }
        }
    }

    /// The known forces of the springs on the watched nodes [N].
    pub fn known_forces(&self) -> Vec<Vector> {
        let mut forces = vec![Vector::zeros(); self.watched.len()];
        for (spring, places) in self.springs.iter().zip(&self.places) {
            for (&place, weight) in places.iter().zip(spring.weights) {
                if place != NO_NODE {
                    forces[place as usize] += spring.force * weight;
                }
            }
        }
        forces
    }

    /// Calls `visit` with the nodes of every spring, active or not, see [`visit_nodes`].
    pub fn for_each_spring(&self, mut visit: impl FnMut(&[u32], bool)) {
        let springs = self.nodes.iter().zip(&self.springs);
        springs.for_each(|(nodes, spring)| visit_nodes(nodes, &spring.weights, &mut visit));
    }
}
