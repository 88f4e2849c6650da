//! Potential, gradient and matrix of the bodies in double precision, beside which backends are checked.

use super::Dynamics;
use super::newton::backend::NewtonStep;
use super::newton::cpu::CpuBodies;
use super::newton::momentum::Inertia;
use super::newton::state::Step;
use crate::elements::filter::Filter;
use crate::elements::set::Motion;
use crate::error::StepError;
use crate::linear::assembly::ElementModel;
use crate::linear::scalar::SplitForm;
use crate::model::DynamicsModel;
use crate::nodes::CHUNK;
use crate::params::DynamicsParams;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::sync::Arc;

impl Dynamics {
    /// The elements as backends get them, without patches and without quadratic elements.
    pub fn element_model(&self) -> ElementModel {
        self.model.describe(Vec::new())
    }

    /// The terms of the potential in the time step that was begun.
    ///
    /// # Errors
    /// No step was begun.
    pub fn step_terms(&self) -> Result<StepTerms, StepError> {
        let Some(step) = &self.step else { return Err(StepError::NotBegun) };
        Ok(StepTerms::new(&self.model, &self.params, step))
    }

    /// The potential of the bodies at positions `x` of nodes [m] in the time step that was begun. One thread computes
    /// it.
    ///
    /// # Errors
    /// No step was begun, or the length is wrong.
    pub fn bodies_potential(&self, x: &[Vector]) -> Result<BodiesPotential, StepError> {
        let terms = self.step_terms()?;
        let nodes = self.model.node_vertex.len();
        if x.len() != nodes {
            return Err(StepError::Length { array: "x", given: x.len(), vertices: nodes });
        }
        Ok(BodiesPotential::at(&self.model, &terms, x))
    }

    /// The matrix of the bodies at positions `x` of nodes [m] in the time step that was begun: the blocks that are not zero,
    /// with row and column, as if all nodes were free. `absolute` is that of [`super::NewtonBackend::linearize`].
    ///
    /// # Errors
    /// No step was begun, or the length is wrong.
    pub fn bodies_matrix(
        &mut self,
        x: &[Vector],
        absolute: bool,
    ) -> Result<Vec<(u32, u32, Matrix3<f64>)>, StepError> {
        let Self { model, params, step, work, .. } = self;
        let Some(step) = step else { return Err(StepError::NotBegun) };
        if x.len() != work.x.len() {
            return Err(StepError::Length { array: "x", given: x.len(), vertices: work.x.len() });
        }
        work.x.copy_from_slice(x);
        let filter = if absolute { Filter::Absolute } else { Filter::Clamp };
        CpuBodies::new(model, params, step, work, &[]).linearize_bodies(filter);
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
        Ok(blocks)
    }
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
            for set in &model.element_sets {
                potential.elements += set.energy(chunk, motion);
                set.add_gradient(chunk, motion, nodes.clone(), gradient);
            }
        }
        potential
    }
}
