//! Potential, gradient and matrix of the bodies in double precision, beside which backends are checked.

use super::newton::backend::NewtonStep;
use super::newton::cpu::CpuBodies;
use super::newton::momentum::Inertia;
use super::newton::state::{Step, Workspace};
use crate::elements::filter::Filter;
use crate::elements::set::Motion;
use crate::linear::scalar::SplitForm;
use crate::model::DynamicsModel;
use crate::nodes::CHUNK;
use crate::params::DynamicsParams;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::sync::Arc;

/// Blocks of a matrix, each with its row and its column.
pub type MatrixBlocks = Vec<(u32, u32, Matrix3<f64>)>;

/// The blocks of the matrix of the bodies at `x`, by node. The iterate of the workspace stays.
pub(super) fn matrix_blocks(
    model: &DynamicsModel,
    params: &DynamicsParams,
    step: &Step,
    work: &mut Workspace,
    x: &[Vector],
    filter: Filter,
) -> MatrixBlocks {
    let iterate = std::mem::replace(&mut work.x, x.to_vec());
    CpuBodies::new(model, params, step, work, &[]).linearize_bodies(filter);
    work.x = iterate;
    let mut blocks = Vec::new();
    for row in 0..x.len() {
        let i = row as u32;
        blocks.push((i, i, work.values.diagonal[row]));
        let range = model.pattern.row(row);
        let columns = model.pattern.columns[range.clone()].iter();
        blocks.extend(columns.zip(&work.values.blocks[range]).map(|(j, block)| (i, *j, *block)));
        let (columns, values) = step.scalar.off_pattern(row);
        let scalars = columns.iter().zip(values);
        blocks.extend(scalars.map(|(j, value)| (i, *j, Matrix3::from_diagonal_element(*value))));
    }
    blocks
}

/// The terms of the potential that are fixed in a time step, see [`NewtonStep`].
#[derive(Clone, Debug)]
pub struct StepTerms {
    start: Vec<Vector>,
    inertial: Vec<Vector>,
    rate: f64,
    row_sums: Vec<Matrix3<f64>>,
    gradient: Vec<Vector>,
    bending: Arc<SplitForm>,
}

impl StepTerms {
    /// Those of a time step.
    pub(super) fn new(model: &DynamicsModel, params: &DynamicsParams, step: &Step) -> Self {
        let inertia = Inertia::new(params, step);
        let gradient = |node: usize| {
            inertia.gradient(model, step, node, &step.start[node]) + model.bending.product(node, &step.start)
        };
        let nodes = (0..step.start.len()).into_par_iter().with_min_len(CHUNK);
        Self {
            start: step.start.clone(),
            inertial: step.inertial.clone(),
            rate: inertia.rate,
            row_sums: nodes.clone().map(|node| inertia.of_nodes(model, node..node + 1)).collect(),
            gradient: nodes.map(gradient).collect(),
            bending: Arc::clone(&step.scalar),
        }
    }

    /// What a backend gets of them.
    pub fn as_step(&self) -> NewtonStep<'_> {
        NewtonStep {
            start: &self.start,
            inertial: &self.inertial,
            rate: self.rate,
            row_sums: &self.row_sums,
            gradient: &self.gradient,
            bending: &self.bending.in_pattern,
            scalars: self.bending.off_values(),
        }
    }
}

/// The potential of the bodies at a state, see [`NewtonStep`].
#[derive(Clone, Debug, Default)]
pub struct BodiesPotential {
    /// Energy of the quadratic terms, relative to the start of the time step [J].
    pub quadratic: f64,
    /// Energy of the elements [J].
    pub elements: f64,
    /// The gradient of the sum [N, N].
    pub gradient: Vec<Vector>,
}

impl BodiesPotential {
    /// That at positions `x` of nodes [m]. One thread computes it.
    pub(super) fn at(model: &DynamicsModel, terms: &StepTerms, x: &[Vector]) -> Self {
        let start = &terms.start;
        let moved: Vec<Vector> = x.iter().zip(start).map(|(x, start)| x - start).collect();
        let mut potential = Self::default();
        for (node, d) in moved.iter().enumerate() {
            let row = model.pattern.row(node);
            let columns = &model.pattern.columns[row.clone()];
            let in_pattern = columns.iter().zip(&terms.bending.in_pattern[row]);
            let (columns, values) = terms.bending.off_pattern(node);
            let pairs = in_pattern.chain(columns.iter().zip(values));
            let bent: Vector = pairs.map(|(&j, &value)| (moved[j as usize] - d) * value).sum();
            let force = terms.row_sums[node] * d + bent;
            potential.quadratic += d.dot(&(force * 0.5 + terms.gradient[node]));
            potential.gradient.push(force + terms.gradient[node]);
        }
        let motion = Motion { x, start, rate: terms.rate };
        for (chunk, gradient) in potential.gradient.chunks_mut(CHUNK).enumerate() {
            let nodes = chunk * CHUNK..chunk * CHUNK + gradient.len();
            for set in model.sets() {
                potential.elements += set.energy(chunk, motion);
                set.add_gradient(chunk, motion, nodes.clone(), gradient);
            }
        }
        potential
    }
}
