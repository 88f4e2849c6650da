//! The matrix of a Newton iteration over the free nodes: H = block matrix + entries of a scalar form outside
//! of the block pattern + active springs.

use super::block::{BlockPattern, BlockValues};
use super::scalar::SplitForm;
use super::springs::LinearSprings;
use super::vectors::chunk_dot;
use crate::nodes::CHUNK;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use rayon::prelude::*;

/// H, borrowed. Rows of nodes that are not free count as zero.
#[derive(Clone, Copy)]
pub(crate) struct System<'a> {
    pub pattern: &'a BlockPattern,
    pub values: &'a BlockValues,
    /// Its diagonal and its entries in the pattern are part of `values`.
    pub scalar: &'a SplitForm,
    /// Not part of `values`.
    pub springs: Option<&'a LinearSprings>,
    pub free: &'a [bool],
}

impl System<'_> {
    pub fn node_count(&self) -> usize {
        self.free.len()
    }

    /// A diagonal block of H.
    pub fn diagonal(&self, row: usize) -> Matrix3<f64> {
        let own = self.values.diagonal[row];
        self.springs.map_or(own, |springs| own + springs.block(row))
    }

    /// Sets y = H x on free rows and 0 elsewhere; returns x . y.
    pub fn multiply(&self, x: &[Vector], y: &mut [Vector]) -> f64 {
        let reactions = self.springs.map(|springs| springs.reactions(x)).unwrap_or_default();
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
        let (columns, values) = self.scalar.off_pattern(row);
        for (&column, &value) in columns.iter().zip(values) {
            sum += x[column as usize] * value;
        }
        if let Some(springs) = self.springs {
            sum += springs.row_product(row, reactions);
        }
        sum
    }
}
