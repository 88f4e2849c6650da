//! Linear momentum, kept to rounding however loosely the linear system is solved.

use crate::DynamicsModel;
use crate::drag::Drag;
use crate::groups::Groups;
use crate::repulsion::Repulsion;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use std::ops::Range;

/// What holds nodes beside inner forces: H summed over a translation.
pub(crate) struct Inertia<'a> {
    /// Per mass [1/s^2].
    pub per_mass: f64,
    pub drag: Option<&'a Drag>,
    /// 1 / dt [1/s].
    pub rate: f64,
}

/// Moves everything that flies freely together as a whole, so that the `residual` of the linear solve sums to
/// zero over it: inner forces then cancel, and its linear momentum is conserved to rounding however loose the
/// tolerance. H sums to inertia (and drag) alone in translations, so the move solves that with the sum of
/// residuals. Components that repulsion joins fly together.
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
    repulsion.for_each_bond(|nodes, holds| {
        groups.join_all(nodes.iter().map(|&node| model.component(node)), holds);
    });
    for group in groups.free() {
        let group: Vec<Range<u32>> = group.into_iter().map(|c| model.components[c].clone()).collect();
        shift(model, &group, inertia, free, residual, step);
    }
}

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
            // Positive definite; it is not only where the state is not finite, which is reported elsewhere.
            total.try_inverse().map_or_else(Vector::zeros, |inverse| inverse * sum)
        }
    };
    nodes().for_each(|n| step[n] += shift);
}
