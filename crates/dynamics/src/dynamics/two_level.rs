//! The linear solver of a model, with its two-level preconditioner.

use crate::linear::coarse::Coarse;
use crate::linear::direct::Direct;
use crate::linear::solver::LinearSolver;
use crate::model::DynamicsModel;
use bowknot_geometry::Vector;

/// Strands are solved exactly. Other components that elements join get a coarse correction. Single nodes need
/// neither.
pub(super) fn two_level(model: &DynamicsModel) -> LinearSolver {
    let single = |n: usize| model.pattern.row(n).is_empty();
    // A component consists of strands only or, if strands are attached to other bodies, is in the coarse
    // space.
    let mut leaves = Vec::new();
    let mut next = 0;
    for component in &model.components {
        let mut nodes = component.start as usize..component.end as usize;
        let coarse = nodes.any(|n| !model.strands[n] && !single(n));
        while next < model.leaves.len() && model.leaves[next].start < component.end {
            leaves.extend(coarse.then(|| model.leaves[next].clone()));
            next += 1;
        }
    }
    let rest_positions = model.rest_positions();
    let rest: Vec<Vector> = model.node_vertex.iter().map(|&v| rest_positions[v as usize].coords).collect();
    let coarse = (!leaves.is_empty()).then(|| {
        Coarse::new(&leaves, &rest, |row, visit| {
            model.pattern.columns[model.pattern.row(row)].iter().for_each(|&column| visit(column));
            model.bending.row(row).0.iter().for_each(|&column| visit(column));
        })
    });
    LinearSolver::new(Direct::new(&model.pattern, &model.strands), coarse)
}
