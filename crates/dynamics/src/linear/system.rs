//! The operator of a Newton iteration: H = block matrix + far entries of a scalar form + repulsion,
//! over the free nodes.

use super::block::{BlockPattern, BlockValues};
use super::scalar::SplitForm;
use super::vectors::chunk_dot;
use crate::elements::CHUNK;
use crate::repulsion::Repulsion;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use rayon::prelude::*;

/// H, borrowed. Rows of nodes that are not free act as zero.
#[derive(Clone, Copy)]
pub(crate) struct System<'a> {
    pub pattern: &'a BlockPattern,
    pub values: &'a BlockValues,
    /// Its diagonal and near entries are part of `values`.
    pub scalar: &'a SplitForm,
    /// No part of `values`.
    pub repulsion: Option<&'a Repulsion>,
    pub free: &'a [bool],
}

impl System<'_> {
    pub fn node_count(&self) -> usize {
        self.free.len()
    }

    /// A diagonal block of H.
    pub fn diagonal(&self, row: usize) -> Matrix3<f64> {
        let own = self.values.diagonal[row];
        self.repulsion.map_or(own, |repulsion| own + repulsion.block(row))
    }

    /// y = H x on free rows, 0 elsewhere; x . y.
    pub fn multiply(&self, x: &[Vector], y: &mut [Vector]) -> f64 {
        let reactions = self.repulsion.map(|repulsion| repulsion.reactions(x)).unwrap_or_default();
        let partial: Vec<f64> = y
            .par_chunks_mut(CHUNK)
            .enumerate()
            .map(|(chunk, y)| {
                let first = chunk * CHUNK;
                for (k, y) in y.iter_mut().enumerate() {
                    *y = if self.free[first + k] {
                        self.row_product(first + k, x, &reactions)
                    } else {
                        Vector::zeros()
                    };
                }
                chunk_dot(&x[first..first + y.len()], y)
            })
            .collect();
        partial.iter().sum()
    }

    #[inline]
    fn row_product(&self, row: usize, x: &[Vector], reactions: &[Vector]) -> Vector {
        let range = self.pattern.row(row);
        let mut sum = self.values.diagonal[row] * x[row];
        for (block, &column) in self.values.blocks[range.clone()].iter().zip(&self.pattern.columns[range]) {
            sum += block * x[column as usize];
        }
        let (columns, values) = self.scalar.far(row);
        for (&column, &value) in columns.iter().zip(values) {
            sum += x[column as usize] * value;
        }
        if let Some(repulsion) = self.repulsion {
            sum += repulsion.row_product(row, reactions);
        }
        sum
    }
}
