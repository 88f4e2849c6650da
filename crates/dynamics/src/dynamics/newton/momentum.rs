//! Linear momentum is conserved to rounding at any tolerance of the linear solve.

use crate::drag::Drag;
use crate::groups::Groups;
use crate::model::DynamicsModel;
use crate::repulsion::springs::Repulsion;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use std::ops::Range;

/// H over a translation: the forces that are not inner forces.
pub(crate) struct Inertia<'a> {
    /// Inertia and mass-proportional damping per mass [1/s^2].
    pub per_mass: f64,
    pub drag: Option<&'a Drag>,
    /// 1 / dt [1/s].
    pub rate: f64,
}

/// Translates every group of freely flying components so that the `residual` of the linear solve sums to zero
/// over it. Inner forces then cancel, and the linear momentum of the group is conserved to rounding at any
/// tolerance. In a translation H sums to inertia and drag alone, so the translation is the sum of residuals
/// divided by these. Components that springs join form one group.
pub(crate) fn restore_momentum(
    model: &DynamicsModel,
    repulsion: &Repulsion,
    inertia: &Inertia<'_>,
    free: &[bool],
    residual: &[Vector],
    step: &mut [Vector],
) {
    if repulsion.is_empty() {
        for component in &model.components {
            shift(model, std::slice::from_ref(component), inertia, free, residual, step);
        }
        return;
    }
    let mut groups = Groups::new(model.components.len());
    repulsion.linear().for_each_spring(|nodes, held| {
        groups.join_all(nodes.iter().map(|&node| model.component(node)), held);
    });
    for group in groups.free() {
        let group: Vec<Range<u32>> = group.into_iter().map(|c| model.components[c].clone()).collect();
        shift(model, &group, inertia, free, residual, step);
    }
}

/// Translates the components of a group, unless a node is not free.
fn shift(
    model: &DynamicsModel,
    group: &[Range<u32>],
    inertia: &Inertia<'_>,
    free: &[bool],
    residual: &[Vector],
    step: &mut [Vector],
) {
    let nodes = || group.iter().flat_map(|range| range.start as usize..range.end as usize);
    if !nodes().all(|n| free[n]) {
        return;
    }
    let sum: Vector = nodes().map(|n| residual[n]).sum();
    let mass: f64 = nodes().map(|n| model.node_masses[n]).sum();
    let shift = match inertia.drag {
        None => sum / (mass * inertia.per_mass),
        Some(drag) => {
            let drag: Matrix3<f64> = nodes().map(|n| drag.matrix[n]).sum();
            let total = Matrix3::from_diagonal_element(mass * inertia.per_mass) + drag * inertia.rate;
            // The matrix is positive definite unless the state is not finite, which the caller reports.
            total.try_inverse().map_or_else(Vector::zeros, |inverse| inverse * sum)
        }
    };
    nodes().for_each(|n| step[n] += shift);
}
