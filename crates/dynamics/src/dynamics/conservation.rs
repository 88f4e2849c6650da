//! Velocities at the end of a time step whose rigid part is that of the end, with momenta conserved.
//!
//! The mean velocity of a step, (x1 - x0) / dt, is that of its middle. Taken for that of its end, as implicit Euler does, it
//! slows rotation: with forces f that act at x1, about the centre of mass and relative to its motion,
//!
//! ```text
//! x1 = x0 + dt v1,  m (v1 - v0) = dt f
//! =>  sum m x1 x v1 = sum m x0 x v0 + dt sum x1 x f - dt sum m v0 x v1
//! ```
//!
//! The last term is what gets lost, whatever the forces are: a body that turns by 0.2 rad a step loses 2 % of its rotation each
//! time. And at x1 the chord of a turning point aims out of its circle. So each body's rigid motion, fitted to the mean
//! velocities at (x0 + x1) / 2, is replaced by one about x1 that has the loss back; what the body does beside, its vibrations,
//! stays. Bodies that nothing but each other touches get the linear and angular momentum that gravity and the air leave them,
//! exactly, by a rigid motion of all of them together: a loose linear solve and contacts that are resolved to a tolerance
//! change nothing then.
//!
//! Positions stay as they are, so that nothing can intersect by it. Energy is not gained: a body, or the bodies that touch, end
//! with no more kinetic energy than they had at the start, plus what gravity, the air and elasticity gave since, or than they
//! have without the correction.

use crate::drag::Drag;
use crate::groups::Groups;
use crate::repulsion::Repulsion;
use crate::{Dynamics, DynamicsModel};
use bowknot_geometry::{Point, Vector};
use nalgebra::{Matrix3, SymmetricEigen};
use std::ops::Range;

/// Moments of inertia below this share of the largest count as none: those of a straight strand about its axis.
const THIN: f64 = 1e-6;

/// Turn in a time step [rad] beyond which it does not resolve rotation: nothing is given back then.
const LARGEST_TURN: f64 = 0.7;

/// Which vertices touched each other in the course of a time step.
#[derive(Clone, Debug, Default)]
pub struct Touching {
    /// Vertices that some contact joins; one of an obstacle holds the other.
    pub pairs: Vec<[u32; 2]>,
    /// Vertices that something else held.
    pub held: Vec<u32>,
}

/// Rigid motion of some nodes at some positions.
struct Rigid {
    center: Vector,
    velocity: Vector,
    /// Angular momentum about the centre [kg m^2/s].
    angular: Vector,
    /// Pseudo-inverse of the tensor of inertia about the centre.
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
    let inverse = eigenvalues.map(|moment| if moment > THIN * largest { 1.0 / moment } else { 0.0 });
    eigenvectors * Matrix3::from_diagonal(&inverse) * eigenvectors.transpose()
}

/// What the correction of a time step works on, by node.
struct Correction<'a> {
    model: &'a DynamicsModel,
    dt: f64,
    x0: &'a [Vector],
    v0: &'a [Vector],
    x1: &'a [Vector],
    /// (x0 + x1) / 2.
    middle: Vec<Vector>,
    /// Mean velocities of the step.
    mean: Vec<Vector>,
    /// Gravity, external forces and the air's at the end [N].
    forces: Vec<Vector>,
    /// Whether the air pushes.
    in_air: bool,
    /// Elastic energy at x0 less that at x1, by component [J].
    released: Vec<f64>,
}

impl Dynamics {
    /// Velocities at the end of the step that was begun, at positions `x` [m], in `v`
    /// [m/s]. Bodies with a vertex that is `prescribed`, obstacles and single grains move at the mean velocities of the step. All slices
    /// have one entry per vertex; without a step that was begun, `v` stays.
    pub fn end_velocities(&self, x: &[Point], prescribed: &[bool], touching: &Touching, v: &mut [Vector]) {
        let Some(step) = &self.step else { return };
        let (model, dt) = (&self.model, step.dt);
        for ((v, x), x0) in v.iter_mut().zip(x).zip(&step.positions) {
            *v = (x - x0) / dt;
        }
        let by_node = || model.node_vertex.iter().map(|&vertex| vertex as usize);
        let free: Vec<bool> = (model.components.iter())
            .map(|c| c.clone().all(|n| !prescribed[model.node_vertex[n as usize] as usize]))
            .collect();
        if !free.contains(&true) {
            return;
        }
        let x1: Vec<Vector> = by_node().map(|vertex| x[vertex].coords).collect();
        let mean: Vec<Vector> = by_node().map(|vertex| v[vertex]).collect();
        let forces = self.outer_forces(&mean, step.drag.as_ref());
        let (before, after) = (model.elastic_by_component(&step.start), model.elastic_by_component(&x1));
        let correction = Correction {
            model,
            dt,
            x0: &step.start,
            v0: &step.velocities,
            x1: &x1,
            middle: step.start.iter().zip(&x1).map(|(x0, x1)| (x0 + x1) * 0.5).collect(),
            mean,
            forces,
            in_air: step.drag.is_some(),
            released: before.iter().zip(&after).map(|(before, after)| before - after).collect(),
        };
        for (node, velocity) in correction.corrected(&free, touching, &self.repulsion).iter().enumerate() {
            v[model.node_vertex[node] as usize] = *velocity;
        }
    }

    /// Gravity, external forces and those of the air at velocities `v` [m/s], by node [N].
    fn outer_forces(&self, v: &[Vector], drag: Option<&Drag>) -> Vec<Vector> {
        let force = |node: usize| {
            let mass = self.model.node_masses[node];
            let gravity = self.model.gravity(self.model.node_vertex[node] as usize, self.params.gravity);
            let air = drag.map_or_else(Vector::zeros, |drag| drag.push[node] - drag.matrix[node] * v[node]);
            (gravity - v[node] * self.params.air_drag) * mass + self.external_forces[node] + air
        };
        (0..v.len()).map(force).collect()
    }
}

impl Correction<'_> {
    fn corrected(&self, free: &[bool], touching: &Touching, repulsion: &Repulsion) -> Vec<Vector> {
        let mut v = self.mean.clone();
        let components = &self.model.components;
        for (index, component) in components.iter().enumerate() {
            if free[index] && component.len() > 1 {
                self.turn(component, self.released[index], &mut v);
            }
        }
        for group in self.free_groups(free, touching, repulsion) {
            self.conserve(&group, &mut v);
        }
        v
    }

    /// Groups of components that touch each other, and nothing else.
    fn free_groups(&self, free: &[bool], touching: &Touching, repulsion: &Repulsion) -> Vec<Vec<usize>> {
        let count = self.model.components.len();
        let component = |vertex: u32| self.model.component(self.model.vertex_node[vertex as usize]);
        let mut groups = Groups::new(count);
        (0..count).filter(|&c| !free[c]).for_each(|c| groups.hold(c));
        // Obstacles are no component.
        let inside = |c: &usize| *c < count;
        for pair in &touching.pairs {
            let both = pair.map(component);
            groups.join_all(both.into_iter().filter(inside), !both.iter().all(inside));
        }
        for vertex in &touching.held {
            groups.join_all(Some(component(*vertex)).filter(inside), true);
        }
        repulsion.for_each_link(|nodes, holds| {
            groups.join_all(nodes.iter().map(|&node| self.model.component(node)), holds);
        });
        groups.free()
    }

    /// Replaces the rigid part of a component's velocities, as far as energy allows.
    fn turn(&self, component: &Range<u32>, released: f64, v: &mut [Vector]) {
        let nodes = component.start as usize..component.end as usize;
        let start = Rigid::of(self.model, nodes.clone(), self.x0, self.v0);
        let middle = Rigid::of(self.model, nodes.clone(), &self.middle, &self.mean);
        let end = Rigid::of(self.model, nodes.clone(), self.x1, &self.mean);
        let spin = middle.spin(middle.angular);
        let turning = |n: usize| spin.cross(&(self.middle[n] - middle.center));
        // The angular momentum at x1 of the fitted motion and what was lost: that of the new one.
        let mut angular = Vector::zeros();
        for n in nodes.clone() {
            let mass = self.model.node_masses[n];
            let lost = (self.v0[n] - start.velocity).cross(&(self.mean[n] - end.velocity)) * self.dt;
            angular += ((self.x1[n] - end.center).cross(&turning(n)) + lost) * mass;
        }
        let new_spin = end.spin(angular);
        let largest = start.spin(start.angular).norm().max(spin.norm()).max(new_spin.norm());
        if largest * self.dt > LARGEST_TURN {
            return;
        }
        let change = |n: usize| new_spin.cross(&(self.x1[n] - end.center)) - turning(n);
        // Kinetic energy along v + s change: a + 2 b s + c s^2, bounded.
        let (mut a, mut b, mut c) = (0.0, 0.0, 0.0);
        for n in nodes.clone() {
            let (half, change) = (0.5 * self.model.node_masses[n], change(n));
            a += half * v[n].norm_squared();
            b += half * v[n].dot(&change);
            c += half * change.norm_squared();
        }
        let most = a.max(self.kinetic_allowed(nodes.clone(), released));
        let share = if a + 2.0 * b + c <= most {
            1.0
        } else {
            let root = (b * b + c * (most - a)).max(0.0).sqrt();
            // The larger root of c s^2 + 2 b s = most - a, without cancellation.
            if b > 0.0 { (most - a) / (b + root) } else { (root - b) / c }
        };
        nodes.for_each(|n| v[n] += change(n) * share);
    }

    /// Gives components the momenta that the step leaves them, by a rigid motion of all.
    fn conserve(&self, group: &[usize], v: &mut [Vector]) {
        let components = &self.model.components;
        let nodes = group.iter().flat_map(|&c| components[c].start as usize..components[c].end as usize);
        let start = Rigid::of(self.model, nodes.clone(), self.x0, self.v0);
        let end = Rigid::of(self.model, nodes.clone(), self.x1, v);
        let (mut mass, mut impulse, mut torque) = (0.0, Vector::zeros(), Vector::zeros());
        for n in nodes.clone() {
            mass += self.model.node_masses[n];
            impulse += self.forces[n] * self.dt;
            torque += (self.x1[n] - end.center).cross(&self.forces[n]) * self.dt;
        }
        let velocity = start.velocity + impulse / mass;
        // Grains have no spin that could take the angular momentum which rubbing takes from their motion; the air takes its share
        // at velocities that the correction changes.
        let exact = end.spin(start.angular + torque);
        let turns = !self.in_air
            && group.iter().all(|&c| components[c].len() > 1)
            && exact.norm() * self.dt < LARGEST_TURN;
        let rotation = if turns { exact } else { end.spin(end.angular) };
        let before = |n: usize| end.velocity + end.spin(end.angular).cross(&(self.x1[n] - end.center));
        let after = |n: usize| velocity + rotation.cross(&(self.x1[n] - end.center));
        // What moves beside the rigid motion gives way if there is too much energy.
        let (mut mean, mut rigid, mut beside) = (0.0, 0.0, 0.0);
        for n in nodes.clone() {
            let half = 0.5 * self.model.node_masses[n];
            mean += half * self.mean[n].norm_squared();
            rigid += half * after(n).norm_squared();
            beside += half * (v[n] - before(n)).norm_squared();
        }
        let released = group.iter().map(|&c| self.released[c]).sum();
        let most = mean.max(self.kinetic_allowed(nodes.clone(), released));
        let share = if rigid + beside > most { ((most - rigid) / beside).max(0.0).sqrt() } else { 1.0 };
        for n in nodes {
            v[n] = after(n) + if beside > 0.0 { (v[n] - before(n)) * share } else { Vector::zeros() };
        }
    }

    /// Kinetic energy at the start, with what elasticity has `released` and outer forces have given since [J].
    fn kinetic_allowed(&self, nodes: impl Iterator<Item = usize>, released: f64) -> f64 {
        let of_node = |n: usize| {
            0.5 * self.model.node_masses[n] * self.v0[n].norm_squared()
                + self.forces[n].dot(&(self.x1[n] - self.x0[n]))
        };
        nodes.map(of_node).sum::<f64>() + released
    }
}
