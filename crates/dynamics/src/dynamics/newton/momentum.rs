//! Linear momentum is conserved to rounding at any tolerance of the linear solve.

use super::state::Step;
use crate::drag::Drag;
use crate::groups::{Group, Groups, Hold};
use crate::model::DynamicsModel;
use crate::params::DynamicsParams;
use crate::repulsion::springs::Repulsion;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;

/// H over a translation: the forces that are not inner forces.
pub(crate) struct Inertia<'a> {
    /// Inertia and mass-proportional damping per mass [1/s^2].
    pub per_mass: f64,
    pub drag: Option<&'a Drag>,
    /// 1 / dt [1/s].
    pub rate: f64,
}

impl<'a> Inertia<'a> {
    /// That of a time step.
    pub fn new(params: &DynamicsParams, step: &'a Step) -> Self {
        Self {
            per_mass: 1.0 / (step.dt * step.dt) + params.environment.air_drag / step.dt,
            drag: step.drag.as_ref(),
            rate: 1.0 / step.dt,
        }
    }

    /// The sum of H over nodes that move alike [N/m].
    pub fn of_nodes(
        &self,
        model: &DynamicsModel,
        nodes: impl Iterator<Item = usize> + Clone,
    ) -> Matrix3<f64> {
        let mass: f64 = nodes.clone().map(|n| model.node_masses[n]).sum();
        let inertia = Matrix3::from_diagonal_element(mass * self.per_mass);
        self.drag.map_or(inertia, |drag| {
            let drag: Matrix3<f64> = nodes.map(|n| drag.matrix[n]).sum();
            inertia + drag * self.rate
        })
    }
}

impl Inertia<'_> {
    /// The gradient of inertia and air by a node at `x` [N].
    pub fn gradient(&self, model: &DynamicsModel, step: &Step, node: usize, x: &Vector) -> Vector {
        let moved = x - step.start[node];
        let mass = model.node_masses[node];
        let mut gradient = (step.start[node] - step.inertial[node]) * (mass * self.rate * self.rate)
            + moved * (mass * self.per_mass);
        if let Some(drag) = self.drag {
            gradient += drag.matrix[node] * moved * self.rate - drag.push[node];
        }
        gradient
    }
}

/// The groups of components that springs join, of which no node is held by a keyframe or a custom element,
/// and which can move freely in some direction.
pub(crate) fn free_groups(model: &DynamicsModel, repulsion: &Repulsion, free: &[bool]) -> Vec<Group> {
    let mut groups = Groups::new(model.components.len());
    repulsion.join(model, &mut groups, true);
    // Forces of elements that are not those of rigid motions have a sum.
    let held = model.held_components.iter().enumerate().filter(|(_, held)| **held);
    held.for_each(|(component, _)| groups.hold(component, Hold::Fully));
    let mut groups = groups.free();
    groups.retain(|group| nodes_of(model, group).all(|n| free[n]));
    groups
}

/// The translation of a group in its free directions that takes away the `force` on it [N], against the
/// `resistance` to translations [N/m]. Forces within the group have no sum.
pub(crate) fn translation(group: &Group, resistance: &Matrix3<f64>, force: &Vector) -> Vector {
    let held = (Matrix3::identity() - group.free) * resistance.trace();
    // The matrix is positive definite unless the state is not finite, which the caller reports.
    let inverse = (group.free * resistance * group.free + held).try_inverse();
    inverse.map_or_else(Vector::zeros, |inverse| group.free * (inverse * (group.free * force)))
}

/// Translates a group so that the `residual` of the linear solve sums to zero over it in its free directions.
/// Inner forces then cancel, and its linear momentum there is conserved to rounding at any tolerance. In such
/// a translation H sums to inertia and drag alone, so the translation is the sum of residuals divided by
/// these.
pub(crate) fn shift_group(
    model: &DynamicsModel,
    group: &Group,
    inertia: &Inertia<'_>,
    residual: &[Vector],
    step: &mut [Vector],
) {
    let nodes = || nodes_of(model, group);
    let sum: Vector = nodes().map(|n| residual[n]).sum();
    let shift = translation(group, &inertia.of_nodes(model, nodes()), &sum);
    nodes().for_each(|n| step[n] += shift);
}

/// The nodes of a group of components.
pub(crate) fn nodes_of(model: &DynamicsModel, group: &Group) -> impl Iterator<Item = usize> + Clone {
    group.members.iter().flat_map(|&c| model.components[c].start as usize..model.components[c].end as usize)
}
