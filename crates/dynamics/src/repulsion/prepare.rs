//! The laws of springs in a time step, and their state at the iterate that a target begins from.
//!
//! The stiffness of a spring is relative to that of the nodes it acts on, so that a contact neither gives way
//! nor makes the system ill-conditioned. A node is as stiff as its inertia and its body at rest in the
//! softest direction: bending for cloth. Two things correct that. A whole body cannot resist more than its
//! own inertia, however stiff it is. And what lies under a stack carries what presses on it: a node is backed
//! by the stiffness of the nodes at the other side of its closed contacts.

use super::law::MIN_BEND;
use super::spring::SpringKind;
use super::springs::Repulsion;
use super::state::SpringState;
use crate::model::DynamicsModel;
use crate::nodes::{CHUNK, NO_NODE};
use bowknot_geometry::Vector;
use rayon::prelude::*;

/// Compliance of nodes against rigid motion of their bodies, in dt^2 / mass of the body. Larger: softer
/// contacts of stiff and light bodies. Smaller: they hardly give way, and conjugate gradients take longer.
const RIGID_COMPLIANCE: f64 = 1.0;

/// Time in which contacts open [s]. Larger: they open more slowly and bounce less. Smaller: they return more
/// energy.
const OPENING_TIME: f64 = 0.03;

/// Share of the gap's room at the iterate at which the static force begins to go on linearly, and its largest
/// value. Larger: steps that close gaps by more see the linear law, which the update then corrects. Smaller:
/// the exact law at once, but Newton's method takes shorter steps.
const BEND_SHARE: f64 = 0.5;
const MAX_BEND: f64 = 0.5;

/// Smallest share of the room at which the stiffness of sticking is taken. Larger: softer sticking of pressed
/// contacts, which slip farther before they slide. Smaller: stiffer systems.
pub(super) const MIN_GRIP_SHARE: f64 = 0.2;

/// Share of the bound of friction from which on a contact slid in the last time step. Larger: more contacts
/// are first taken to stick on. Smaller: more are first taken to slide.
const SLIDING: f64 = 0.999;

/// Share of the largest stiffness at rest that counts at edges at their limit. Larger: edges exceed their
/// limit by less. Smaller: systems are better conditioned.
const ALONG: f64 = 0.1;

/// Share of the stiffness of what presses on a node that backs it at its other contacts. Larger: the bottom
/// of a stack gives way less, but systems are stiffer. Smaller: loads press through to the floor of the law.
const BACKING: f64 = 0.5;

/// Largest ratio of the backed stiffness of a node to its own. Larger: light nodes under heavy ones give way
/// less. Smaller: systems are better conditioned.
const MAX_BACKING: f64 = 30.0;

/// Layers through which backing passes. More: higher stacks are backed. Fewer: less time.
const BACKING_PASSES: usize = 4;

impl Repulsion {
    /// Sets the laws and the state of friction. `rate` is 1 / dt [1/s]; positions have one entry per watched
    /// node, `free` one per node. With positions `ahead`, where inertia leads, open contacts that close there
    /// are taken for closed in the first solve, and friction is linearized there.
    pub fn prepare(
        &mut self,
        model: &DynamicsModel,
        rate: f64,
        free: &[bool],
        iterate: &[Vector],
        ahead: Option<&[Vector]>,
    ) {
        self.note_lacking(free, iterate);
        let own: Vec<f64> = self.watched().iter().map(|&node| own_stiffness(model, rate, node)).collect();
        let backed = self.backed_stiffness(&own, free, iterate);
        let mut states = std::mem::take(&mut self.states);
        states.par_iter_mut().enumerate().with_min_len(CHUNK).for_each(|(spring, state)| {
            let s = &self.springs[spring];
            let compliance = |of_node: &dyn Fn(u32, usize) -> f64| -> f64 {
                let nodes = self.nodes[spring].iter().zip(&self.places[spring]).zip(s.weights);
                let moving = nodes.filter(|((node, _), _)| **node != NO_NODE && free[**node as usize]);
                moving.map(|((&node, &place), weight)| weight * weight / of_node(node, place as usize)).sum()
            };
            let compliance = match s.kind {
                SpringKind::Contact => compliance(&|_, place| backed[place]),
                SpringKind::Repulsion => compliance(&|_, place| own[place]),
                SpringKind::Limit => compliance(&|node, _| along_stiffness(model, rate, node)),
            };
            *state = SpringState::default();
            if compliance <= 0.0 || s.stiffness == 0.0 {
                return;
            }
            state.acts = true;
            state.law = s.law(s.stiffness / compliance, self.start_gap(spring));
            if s.kind == SpringKind::Repulsion {
                return;
            }
            let (gap, _) = self.gap_and_slip(spring, iterate);
            state.law.set_drag(OPENING_TIME * rate, s.start_gap);
            // Before the law is bent: what friction was in the last time step does not depend on the iterate.
            let ratio = s.friction_ratio - s.normal * s.normal.dot(&s.friction_ratio);
            state.tau = ratio * state.law.force_at_start();
            state.law.bend_at((BEND_SHARE * state.law.share(gap)).clamp(MIN_BEND, MAX_BEND));
            state.grip = state.law.tangent(gap, MIN_GRIP_SHARE);
            let push = state.law.at(gap);
            state.bound = s.friction * push.force;
            // What stuck is likely to stick on.
            let stuck = state.tau != Vector::zeros() && state.tau.norm() < SLIDING * state.bound;
            state.slip_ahead = ahead.filter(|_| !stuck).map(|ahead| self.gap_and_slip(spring, ahead).1);
            state.predicted =
                push.force == 0.0 && ahead.is_some_and(|ahead| self.gap_and_slip(spring, ahead).0 < s.reach);
        });
        self.states = states;
    }

    /// Stiffness of watched nodes [N/m]: their `own`, or, if that is larger, a share of that of what presses
    /// on them.
    fn backed_stiffness(&self, own: &[f64], free: &[bool], x: &[Vector]) -> Vec<f64> {
        let mut stiffness = own.to_vec();
        let is_closed = |&spring: &usize| {
            let s = &self.springs[spring];
            s.kind == SpringKind::Contact
                && self.gap_and_slip(spring, x).0.min(self.start_gap(spring)) < s.reach
        };
        let closed: Vec<usize> = (0..self.springs.len()).filter(is_closed).collect();
        for _ in 0..BACKING_PASSES {
            let before = stiffness.clone();
            for &spring in &closed {
                let (s, nodes, places) = (&self.springs[spring], &self.nodes[spring], &self.places[spring]);
                let side =
                    |sign: f64| (0..4).filter(move |&k| s.weights[k] * sign > 0.0 && nodes[k] != NO_NODE);
                for sign in [1.0, -1.0] {
                    let behind: f64 = side(-sign)
                        .filter(|&k| free[nodes[k] as usize])
                        .map(|k| s.weights[k].abs() * before[places[k] as usize])
                        .sum();
                    for k in side(sign) {
                        let place = places[k] as usize;
                        let backing = (BACKING * s.weights[k].abs() * behind).min(MAX_BACKING * own[place]);
                        stiffness[place] = stiffness[place].max(backing);
                    }
                }
            }
        }
        stiffness
    }
}

/// Stiffness of a node at a contact [N/m].
fn own_stiffness(model: &DynamicsModel, rate: f64, node: u32) -> f64 {
    let node = node as usize;
    let local = model.node_masses[node] * rate * rate + model.node_stiffness[node][0];
    let rigid = model.component_masses[node] * rate * rate;
    1.0 / (1.0 / local + RIGID_COMPLIANCE / rigid)
}

/// Stiffness of a node at an edge that is taut [N/m].
fn along_stiffness(model: &DynamicsModel, rate: f64, node: u32) -> f64 {
    let node = node as usize;
    model.node_masses[node] * rate * rate + ALONG * model.node_stiffness[node][1]
}
