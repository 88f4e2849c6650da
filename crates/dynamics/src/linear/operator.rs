//! The matrix of a linear solve in the numbers that the solve computes with, see [`super::solver`].

use super::lane::{Lane, PackedBlocks, Real, pack};
use super::parts::Parts;
use super::system::System;
use crate::nodes::{CHUNK, NO_NODE};
use nalgebra::Matrix3;
use rayon::prelude::*;

/// H as `(H x)_i = (sum_j H_ij) x_i + sum_j H_ij (x_j - x_i)`.
///
/// Sums of rows are inertia, drag and what holds nodes; they are formed in double precision. Rounding of H_ij
/// then acts on differences of neighbors alone. Otherwise it would act as forces on bodies that move without
/// deformation: in single precision, as large as the inertia of stiff ones.
#[derive(Clone, Debug, Default)]
pub(crate) struct Operator<T: Real> {
    /// Sums of rows, without springs; zero for nodes that are not free.
    sums: PackedBlocks<T>,
    /// Off-diagonal blocks in the order of the pattern.
    blocks: PackedBlocks<T>,
    /// Entries of the scalar form outside of the pattern.
    off_values: Vec<T>,
    springs: Vec<Spring<T>>,
    weights: Vec<T>,
    reactions: Vec<Lane<T>>,
    /// Partial sums of a dot product.
    partial: Vec<f64>,
}

#[derive(Clone, Debug)]
struct Spring<T: Real> {
    nodes: [u32; 4],
    weights: [T; 4],
    /// By columns.
    hessian: [Lane<T>; 3],
}

impl<T: Real> Operator<T> {
    /// Replaces the matrix by that of `system`.
    pub fn fill(&mut self, system: &System<'_>) {
        let pattern = system.pattern;
        self.sums.resize(system.node_count());
        self.blocks.resize(pattern.columns.len());
        self.sums.as_mut_slice().par_chunks_mut(9 * CHUNK).enumerate().for_each(|(chunk, sums)| {
            for (k, numbers) in sums.chunks_exact_mut(9).enumerate() {
                let node = chunk * CHUNK + k;
                pack(numbers, &row_sum(system, node));
            }
        });
        let blocks = self.blocks.as_mut_slice().par_chunks_mut(9 * CHUNK);
        blocks.zip(system.values.blocks.par_chunks(CHUNK)).for_each(|(packed, blocks)| {
            packed.chunks_exact_mut(9).zip(blocks).for_each(|(numbers, block)| pack(numbers, block));
        });
        self.off_values.clear();
        self.off_values.extend(system.scalar.off_values().iter().map(|value| T::from_f64(*value)));
        self.springs.clear();
        self.weights.clear();
        if let Some(springs) = system.springs {
            self.springs.extend(springs.all().iter().map(|spring| Spring {
                nodes: spring.nodes,
                weights: spring.weights.map(T::from_f64),
                hessian: [0, 1, 2].map(|c| Lane::new(&spring.hessian.column(c).into_owned(), 1.0)),
            }));
            self.weights.extend(springs.all_entries().iter().map(|(_, weight)| T::from_f64(*weight)));
        }
    }

    /// Sets y = H x on free rows and 0 on others, in the parts that are `active`; returns x . y by part. `system` is the one of
    /// [`Self::fill`]; x is zero at nodes that are not free.
    pub fn multiply(
        &mut self,
        system: &System<'_>,
        (parts, active): (&Parts, &[bool]),
        x: &[Lane<T>],
        y: &mut [Lane<T>],
    ) -> Vec<f64> {
        let reaction = |spring: &Spring<T>| {
            let mut sum = Lane::default();
            for (&node, &weight) in spring.nodes.iter().zip(&spring.weights) {
                if node != NO_NODE {
                    sum += x[node as usize] * weight;
                }
            }
            let [x, y, z, _] = sum.numbers();
            spring.hessian[0] * x + spring.hessian[1] * y + spring.hessian[2] * z
        };
        self.springs.par_iter().with_min_len(CHUNK).map(reaction).collect_into_vec(&mut self.reactions);
        let mut partial = std::mem::take(&mut self.partial);
        let this = &*self;
        let chunks = y.par_chunks_mut(CHUNK).zip(parts.room(&mut partial)).enumerate();
        chunks.for_each(|(chunk, (y, sums))| {
            let first = chunk * CHUNK;
            let pieces = parts.of_chunk(chunk).iter().zip(sums);
            for (piece, sum) in pieces.filter(|(piece, _)| active[piece.part]) {
                for node in piece.nodes.clone() {
                    let product = if system.free[node] { this.row(system, node, x) } else { Lane::default() };
                    *sum += x[node].dot(&product);
                    y[node - first] = product;
                }
            }
        });
        self.partial = partial;
        parts.sums(&self.partial)
    }

    #[inline(always)]
    fn row(&self, system: &System<'_>, row: usize, x: &[Lane<T>]) -> Lane<T> {
        let own = x[row];
        let mut sum = self.sums.product(row, own);
        for slot in system.pattern.row(row) {
            let other = x[system.pattern.columns[slot] as usize];
            sum += self.blocks.product(slot, other - own);
        }
        let range = system.scalar.off_range(row);
        for (&column, &value) in
            system.scalar.off_columns()[range.clone()].iter().zip(&self.off_values[range])
        {
            sum += (x[column as usize] - own) * value;
        }
        if let Some(springs) = system.springs {
            let range = springs.entry_range(row);
            let entries = springs.all_entries()[range.clone()].iter().zip(&self.weights[range]);
            for (&(spring, _), &weight) in entries {
                sum += self.reactions[spring as usize] * weight;
            }
        }
        sum.without_fourth()
    }
}

/// Sum of a row of H without springs: the diagonal block and all others.
fn row_sum(system: &System<'_>, row: usize) -> Matrix3<f64> {
    if !system.free[row] {
        return Matrix3::zeros();
    }
    let range = system.pattern.row(row);
    let own = system.values.diagonal[row];
    let sum = system.values.blocks[range].iter().fold(own, |sum, block| sum + block);
    sum + Matrix3::from_diagonal_element(system.scalar.off_pattern(row).1.iter().sum())
}
