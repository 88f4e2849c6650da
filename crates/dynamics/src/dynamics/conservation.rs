//! Velocities at the end of a time step that conserve linear and angular momentum.
//!
//! The mean velocity of a step, (x1 - x0) / dt, is the velocity in its middle. Implicit Euler takes it for
//! the velocity at the end, which slows rotation: with forces f that act at x1, about the center of mass and
//! relative to its motion,
//!
//! ```text
//! x1 = x0 + dt v1,  m (v1 - v0) = dt f
//! =>  sum m x1 x v1 = sum m x0 x v0 + dt sum x1 x f - dt sum m v0 x v1
//! ```
//!
//! The last term is lost, whatever the forces are: a body that rotates by 0.2 rad per step loses 2 % of its
//! rotation in each step. In addition, the mean velocity of a point that rotates is a chord of its circle,
//! which points out of the circle at x1. Therefore the rigid motion of each body, fitted to the mean
//! velocities at (x0 + x1) / 2, is replaced by one about x1 that includes the lost term; the rest of the
//! motion, vibrations, stays. Groups of bodies that touch nothing but each other then get a common rigid
//! motion, which gives them exactly the linear and angular momentum that gravity and air leave them:
//! tolerances of linear solves and contacts have no effect on these. Groups that touch obstacles without
//! friction keep their linear momentum in the directions across all normals of these contacts. Groups on
//! which custom elements exert outer forces keep the momenta that the time step gives them.
//!
//! Positions do not change, so no intersection can result. Energy is not gained: a body, or a group of bodies
//! that touch, ends with at most the kinetic energy that it had at the start plus the work of gravity, air
//! and elasticity since, or, after a step of implicit Euler, with at most the kinetic energy without the
//! correction.
//!
//! After a time step of several stages ([`super::stages`]) velocities have no such error, and only the momenta
//! of groups are corrected.

use super::newton::momentum::nodes_of;
use super::newton::state::Step;
use crate::groups::{Group, Groups, Hold};
use crate::model::DynamicsModel;
use crate::params::Environment;
use crate::repulsion::springs::Repulsion;
use bowknot_geometry::{Point, Vector};
use nalgebra::{Matrix3, SymmetricEigen};
use std::ops::Range;

/// Moments of inertia up to this share of the largest one count as zero, such as that of a straight strand
/// about its axis.
const MIN_INERTIA_RATIO: f64 = 1e-6;

/// Largest rotation in a time step that the step resolves [rad]; faster rotations are not corrected.
const MAX_TURN: f64 = 0.7;

/// The contacts that occurred during a time step.
#[derive(Clone, Debug, Default)]
pub struct Touching {
    /// Pairs of vertices that a contact joins. Those with vertices of obstacles join nothing.
    pub pairs: Vec<[u32; 2]>,
    /// Vertices that an obstacle or a half-space may push.
    pub held: Vec<Held>,
}

/// A vertex that an obstacle or a half-space may push.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// The vertex.
    pub vertex: u32,
    /// The direction of the contact, a unit vector of either sign.
    pub normal: Vector,
    /// Whether there is friction. If not, momentum across the normal is conserved.
    pub rough: bool,
}

/// Rigid part of the motion of some nodes.
struct Rigid {
    center: Vector,
    velocity: Vector,
    /// Angular momentum about the center [kg m^2/s].
    angular: Vector,
    /// Pseudo-inverse of the tensor of inertia about the center.
    inverse: Matrix3<f64>,
}

impl Rigid {
    fn of(
        model: &DynamicsModel,
        nodes: impl Iterator<Item = usize> + Clone,
        x: &[Vector],
        v: &[Vector],
    ) -> Self {
        let (mut mass, mut center, mut velocity) = (0.0, Vector::zeros(), Vector::zeros());
        for n in nodes.clone() {
            let m = model.node_masses[n];
            mass += m;
            center += x[n] * m;
            velocity += v[n] * m;
        }
        center /= mass;
        velocity /= mass;
        let (mut angular, mut inertia) = (Vector::zeros(), Matrix3::zeros());
        for n in nodes {
            let (m, arm) = (model.node_masses[n], x[n] - center);
            angular += arm.cross(&(v[n] - velocity)) * m;
            inertia += (Matrix3::from_diagonal_element(arm.norm_squared()) - arm * arm.transpose()) * m;
        }
        Self { center, velocity, angular, inverse: pseudo_inverse(inertia) }
    }

    /// Angular velocity of a rigid motion with the angular momentum `angular`.
    fn spin(&self, angular: Vector) -> Vector {
        self.inverse * angular
    }
}

fn pseudo_inverse(inertia: Matrix3<f64>) -> Matrix3<f64> {
    let SymmetricEigen { eigenvectors, eigenvalues } = inertia.symmetric_eigen();
    let largest = eigenvalues.max();
    let inverse =
        eigenvalues.map(|moment| if moment > MIN_INERTIA_RATIO * largest { 1.0 / moment } else { 0.0 });
    eigenvectors * Matrix3::from_diagonal(&inverse) * eigenvectors.transpose()
}

/// The correction of the mean velocities of a time step, by node.
struct Correction<'a> {
    model: &'a DynamicsModel,
    dt: f64,
    x0: &'a [Vector],
    v0: &'a [Vector],
    x1: &'a [Vector],
    /// (x0 + x1) / 2.
    middle: Vec<Vector>,
    /// Velocities without the correction: the mean velocities of a step of implicit Euler.
    mean: Vec<Vector>,
    /// Gravity, external forces and those of the air, their means over the stages [N].
    forces: Vec<Vector>,
    /// Whether the time step is one of implicit Euler.
    is_euler: bool,
    /// Whether there are forces of the air.
    in_air: bool,
    /// Elastic energy at x0 minus that at x1, by component [J].
    released: Vec<f64>,
}

/// What the velocities at the end of a time step depend on, besides its end.
pub(super) struct EndOfStep<'a> {
    pub model: &'a DynamicsModel,
    pub environment: &'a Environment,
    /// By node [N].
    pub external_forces: &'a [Vector],
    pub repulsion: &'a Repulsion,
    pub step: &'a Step,
}

impl EndOfStep<'_> {
    /// Corrects velocities `v` [m/s] at the end of the time step, at positions `x` [m], see
    /// [`crate::Dynamics::end_velocities`].
    pub fn conserve(&self, x: &[Point], prescribed: &[bool], touching: &Touching, v: &mut [Vector]) {
        let Self { model, step, repulsion, .. } = self;
        let by_node = || model.node_vertex.iter().map(|&vertex| vertex as usize);
        let free: Vec<bool> = (model.components.iter())
            .map(|c| c.clone().all(|n| !prescribed[model.node_vertex[n as usize] as usize]))
            .collect();
        if !free.contains(&true) {
            return;
        }
        let x1: Vec<Vector> = by_node().map(|vertex| x[vertex].coords).collect();
        let mean: Vec<Vector> = by_node().map(|vertex| v[vertex]).collect();
        let mut forces = self.outer_forces(&mean);
        let (mut x0, mut v0) = (&step.start, &step.velocities);
        if let Some(earlier) = &step.earlier {
            (x0, v0) = (&earlier.start, &earlier.velocities);
            let last = step.dt / step.whole;
            forces
                .iter_mut()
                .zip(&earlier.forces)
                .for_each(|(f, before)| *f = *f * last + before * (1.0 - last));
        }
        let (before, after) = (model.elastic_by_component(x0), model.elastic_by_component(&x1));
        let correction = Correction {
            model,
            dt: step.whole,
            is_euler: step.earlier.is_none(),
            x0,
            v0,
            x1: &x1,
            middle: x0.iter().zip(&x1).map(|(x0, x1)| (x0 + x1) * 0.5).collect(),
            mean,
            forces,
            in_air: step.drag.is_some(),
            released: before.iter().zip(&after).map(|(before, after)| before - after).collect(),
        };
        for (node, velocity) in correction.corrected(&free, touching, repulsion).iter().enumerate() {
            v[model.node_vertex[node] as usize] = *velocity;
        }
    }

    /// Gravity, external forces and those of the air at velocities `v` [m/s], by node [N].
    pub fn outer_forces(&self, v: &[Vector]) -> Vec<Vector> {
        let Self { model, environment, step, .. } = self;
        let force = |node: usize| {
            let mass = model.node_masses[node];
            let gravity = model.gravity(model.node_vertex[node] as usize, environment.gravity);
            let air = step
                .drag
                .as_ref()
                .map_or_else(Vector::zeros, |drag| drag.push[node] - drag.matrix[node] * v[node]);
            (gravity - v[node] * environment.air_drag) * mass + self.external_forces[node] + air
        };
        (0..v.len()).map(force).collect()
    }
}

impl Correction<'_> {
    fn corrected(&self, free: &[bool], touching: &Touching, repulsion: &Repulsion) -> Vec<Vector> {
        let mut v = self.mean.clone();
        let components = &self.model.components;
        for (index, component) in components.iter().enumerate() {
            if self.is_euler && free[index] && component.len() > 1 {
                self.turn(component, self.released[index], &mut v);
            }
        }
        for group in self.free_groups(free, touching, repulsion) {
            self.conserve(&group, &mut v);
        }
        v
    }

    /// Groups of components that touch each other, and that nothing else holds in some direction.
    fn free_groups(&self, free: &[bool], touching: &Touching, repulsion: &Repulsion) -> Vec<Group> {
        let count = self.model.components.len();
        let component = |vertex: u32| self.model.component(self.model.vertex_node[vertex as usize]);
        let mut groups = Groups::new(count);
        let is_held = |c: &usize| !free[*c] || self.model.held_components[*c];
        (0..count).filter(is_held).for_each(|c| groups.hold(c, Hold::Fully));
        // Obstacles are in no component.
        let inside = |c: &usize| *c < count;
        for pair in &touching.pairs {
            groups.join_all(pair.map(component).into_iter().filter(inside), Hold::NONE);
        }
        for Held { vertex, normal, rough } in &touching.held {
            groups.join_all(Some(component(*vertex)).filter(inside), Hold::contact(normal, *rough));
        }
        repulsion.join(self.model, &mut groups, false);
        groups.free()
    }

    /// Replaces the rigid part of a component's velocities, as far as the bound of energy allows.
    fn turn(&self, component: &Range<u32>, released: f64, v: &mut [Vector]) {
        let nodes = component.start as usize..component.end as usize;
        let start = Rigid::of(self.model, nodes.clone(), self.x0, self.v0);
        let middle = Rigid::of(self.model, nodes.clone(), &self.middle, &self.mean);
        let end = Rigid::of(self.model, nodes.clone(), self.x1, &self.mean);
        let spin = middle.spin(middle.angular);
        let turning = |n: usize| spin.cross(&(self.middle[n] - middle.center));
        // The angular momentum of the new motion: that of the fitted motion at x1, plus the lost term.
        let mut angular = Vector::zeros();
        for n in nodes.clone() {
            let mass = self.model.node_masses[n];
            let lost = (self.v0[n] - start.velocity).cross(&(self.mean[n] - end.velocity)) * self.dt;
            angular += ((self.x1[n] - end.center).cross(&turning(n)) + lost) * mass;
        }
        let new_spin = end.spin(angular);
        let largest = start.spin(start.angular).norm().max(spin.norm()).max(new_spin.norm());
        if largest * self.dt > MAX_TURN {
            return;
        }
        let change = |n: usize| new_spin.cross(&(self.x1[n] - end.center)) - turning(n);
        // The kinetic energy at v + s change is a + 2 b s + c s^2; s is limited by the bound.
        let (mut a, mut b, mut c) = (0.0, 0.0, 0.0);
        for n in nodes.clone() {
            let (half, change) = (0.5 * self.model.node_masses[n], change(n));
            a += half * v[n].norm_squared();
            b += half * v[n].dot(&change);
            c += half * change.norm_squared();
        }
        let allowed = a.max(self.kinetic_allowed(nodes.clone(), released));
        let share = if a + 2.0 * b + c <= allowed {
            1.0
        } else {
            let root = (b * b + c * (allowed - a)).max(0.0).sqrt();
            // The larger root of c s^2 + 2 b s = allowed - a, without cancellation.
            if b > 0.0 { (allowed - a) / (b + root) } else { (root - b) / c }
        };
        nodes.for_each(|n| v[n] += change(n) * share);
    }

    /// Gives a group of components the momenta that outer forces leave it, by a rigid motion of the group:
    /// all of them if nothing holds it, else linear momentum in its free directions.
    fn conserve(&self, group: &Group, v: &mut [Vector]) {
        let components = &self.model.components;
        let nodes = nodes_of(self.model, group);
        let start = Rigid::of(self.model, nodes.clone(), self.x0, self.v0);
        let end = Rigid::of(self.model, nodes.clone(), self.x1, v);
        let (mut mass, mut impulse, mut torque) = (0.0, Vector::zeros(), Vector::zeros());
        for n in nodes.clone() {
            mass += self.model.node_masses[n];
            impulse += self.forces[n] * self.dt;
            torque += (self.x1[n] - end.center).cross(&self.forces[n]) * self.dt;
        }
        let is_free = group.free == Matrix3::identity();
        let velocity = start.velocity + impulse / mass;
        let velocity = if is_free { velocity } else { end.velocity + group.free * (velocity - end.velocity) };
        // Angular momentum is not prescribed in three cases. Contacts with obstacles change it; friction
        // takes some from the motion of grains, which have no spin that could take it up; and the forces of
        // the air depend on the velocities that are corrected here.
        let exact = end.spin(start.angular + torque);
        let turns = is_free
            && !self.in_air
            && group.members.iter().all(|&c| components[c].len() > 1)
            && exact.norm() * self.dt < MAX_TURN;
        let rotation = if turns { exact } else { end.spin(end.angular) };
        let before = |n: usize| end.velocity + end.spin(end.angular).cross(&(self.x1[n] - end.center));
        let after = |n: usize| velocity + rotation.cross(&(self.x1[n] - end.center));
        // If the energy exceeds its bound, the motion besides the rigid one is reduced.
        let (mut mean, mut rigid, mut beside) = (0.0, 0.0, 0.0);
        for n in nodes.clone() {
            let half = 0.5 * self.model.node_masses[n];
            mean += half * self.mean[n].norm_squared();
            rigid += half * after(n).norm_squared();
            beside += half * (v[n] - before(n)).norm_squared();
        }
        let released = group.members.iter().map(|&c| self.released[c]).sum();
        let bound = self.kinetic_allowed(nodes.clone(), released);
        let allowed = if self.is_euler { mean.max(bound) } else { bound };
        let share = if rigid + beside > allowed { ((allowed - rigid) / beside).max(0.0).sqrt() } else { 1.0 };
        for n in nodes {
            v[n] = after(n) + if beside > 0.0 { (v[n] - before(n)) * share } else { Vector::zeros() };
        }
    }

    /// Kinetic energy at the start, plus the elastic energy `released` and the work of outer forces since
    /// [J].
    fn kinetic_allowed(&self, nodes: impl Iterator<Item = usize>, released: f64) -> f64 {
        let of_node = |n: usize| {
            0.5 * self.model.node_masses[n] * self.v0[n].norm_squared()
                + self.forces[n].dot(&(self.x1[n] - self.x0[n]))
        };
        nodes.map(of_node).sum::<f64>() + released
    }
}
