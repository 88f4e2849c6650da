//! Gradient and matrix of the incremental potential, on the CPU.

use super::cpu::CpuBodies;
use super::state::Step;
use crate::elements::filter::Filter;
use crate::elements::set::{Motion, Rows};
use crate::model::DynamicsModel;
use crate::nodes::CHUNK;
use crate::params::DynamicsParams;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use rayon::prelude::*;

impl CpuBodies<'_> {
    /// Computes the gradient and H at `work.x` without springs.
    pub fn linearize_bodies(&mut self, filter: Filter) {
        let Self { model, params, step, work, .. } = self;
        let motion = Motion { x: &work.x, start: &step.start, rate: 1.0 / step.dt };
        let cache = &mut work.cache;
        if cache.linearized_at == work.x && cache.filter == Some(filter) {
            work.gradient.copy_from_slice(&cache.gradient);
            return;
        }
        let inertia = 1.0 / (step.dt * step.dt);
        let drag = params.environment.air_drag / step.dt;

        // Each chunk gets the blocks of its own rows.
        let mut blocks = work.values.blocks.as_mut_slice();
        let mut rows = Vec::new();
        let chunks = work.gradient.chunks_mut(CHUNK).zip(work.values.diagonal.chunks_mut(CHUNK));
        for (chunk, (gradient, diagonal)) in chunks.enumerate() {
            let nodes = chunk * CHUNK..chunk * CHUNK + gradient.len();
            let first_block = model.pattern.starts[nodes.start] as usize;
            let end_block = model.pattern.starts[nodes.end] as usize;
            let (mine, rest) = blocks.split_at_mut(end_block - first_block);
            blocks = rest;
            rows.push(Rows { nodes, gradient, diagonal, blocks: mine, first_block });
        }
        rows.into_par_iter().enumerate().for_each(|(chunk, mut rows)| {
            let in_pattern = &step.scalar.in_pattern[rows.first_block..];
            for (block, &value) in rows.blocks.iter_mut().zip(in_pattern) {
                *block = Matrix3::from_diagonal_element(value);
            }
            for (row, node) in rows.nodes.clone().enumerate() {
                let mass = model.node_masses[node];
                rows.diagonal[row] =
                    Matrix3::from_diagonal_element(mass * (inertia + drag) + step.scalar.diagonal[node]);
                if let Some(drag) = &step.drag {
                    rows.diagonal[row] += drag.matrix[node] * motion.rate;
                }
                rows.gradient[row] = node_gradient(model, params, step, motion, node);
            }
            for set in model.sets() {
                set.linearize(chunk, motion, filter, &mut rows);
            }
        });
        cache.linearized_at.clone_from(&work.x);
        cache.filter = Some(filter);
        cache.gradient.clone_from(&work.gradient);
    }
}

/// The gradient of inertia, drag and flat bending by a node [N].
#[inline]
fn node_gradient(
    model: &DynamicsModel,
    params: &DynamicsParams,
    step: &Step,
    motion: Motion<'_>,
    node: usize,
) -> Vector {
    let inertia = 1.0 / (step.dt * step.dt);
    let drag = params.environment.air_drag / step.dt;
    let mass = model.node_masses[node];
    let (x, start) = (motion.x[node], motion.start[node]);
    let mut gradient = (x - step.inertial[node]) * (mass * inertia)
        + (x - start) * (mass * drag)
        + model.bending.product(node, motion.x);
    if let Some(damping) = &model.bending_damping {
        gradient += (damping.product(node, motion.x) - damping.product(node, motion.start)) * motion.rate;
    }
    if let Some(drag) = &step.drag {
        gradient += drag.matrix[node] * (x - start) * motion.rate - drag.push[node];
    }
    gradient
}
