//! Linear momentum is conserved to rounding at any tolerance of the linear solve.

use super::state::Step;
use crate::drag::Drag;
use crate::groups::Groups;
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

/// The groups of freely flying components, each by its components: those of which no node is held by a keyframe or by a
/// spring. Components that springs join form one group.
pub(crate) fn flying_groups(model: &DynamicsModel, repulsion: &Repulsion, free: &[bool]) -> Vec<Vec<usize>> {
    let mut flying = if repulsion.is_empty() {
        (0..model.components.len()).map(|component| vec![component]).collect()
    } else {
        let mut groups = Groups::new(model.components.len());
        repulsion.linear().for_each_spring(|nodes, held| {
            groups.join_all(nodes.iter().map(|&node| model.component(node)), held);
        });
        groups.free()
    };
    flying.retain(|group| nodes_of(model, group).all(|n| free[n]));
    flying
}

/// Translates a group of freely flying components so that the `residual` of the linear solve sums to zero
/// over it. Inner forces then cancel, and the linear momentum of the group is conserved to rounding at any
/// tolerance. In a translation H sums to inertia and drag alone, so the translation is the sum of residuals
/// divided by these.
pub(crate) fn shift_group(
    model: &DynamicsModel,
    group: &[usize],
    inertia: &Inertia<'_>,
    residual: &[Vector],
    step: &mut [Vector],
) {
    let nodes = || nodes_of(model, group);
    let sum: Vector = nodes().map(|n| residual[n]).sum();
    let shift = match inertia.drag {
        None => sum / (nodes().map(|n| model.node_masses[n]).sum::<f64>() * inertia.per_mass),
        // The matrix is positive definite unless the state is not finite, which the caller reports.
        Some(_) => {
            inertia.of_nodes(model, nodes()).try_inverse().map_or_else(Vector::zeros, |inverse| inverse * sum)
        }
    };
    nodes().for_each(|n| step[n] += shift);
}

/// The nodes of a group of components.
pub(crate) fn nodes_of(model: &DynamicsModel, group: &[usize]) -> impl Iterator<Item = usize> + Clone {
    group.iter().flat_map(|&c| model.components[c].start as usize..model.components[c].end as usize)
}
