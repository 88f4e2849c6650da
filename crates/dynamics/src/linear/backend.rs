//! Linear solves elsewhere than on the CPU: what a backend gets and does.

use super::failure::LinearBackendError;
use super::springs::LinearSpring;
use super::system::System;
use crate::device_work::DeviceWork;
use crate::dynamics::NewtonBackend;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use std::fmt::Debug;
use std::ops::Range;

/// Preconditioned conjugate gradients in single precision, for the linear systems of Newton iterations.
///
/// The caller refines: it computes the residual of a solution in double precision and lets the backend solve for
/// a correction. All norms are those of the backend's preconditioner M, an approximation of H^-1: the squared
/// norm of r is r . M r.
pub trait LinearBackend: Debug + Send {
    /// What it is called where runs are described.
    fn name(&self) -> String;

    /// What its device was asked for since it was opened.
    fn work(&self) -> DeviceWork {
        DeviceWork::default()
    }

    /// Takes over a matrix and prepares its preconditioner. Both stay until the next call.
    ///
    /// # Errors
    /// What the backend fails of, such as a lack of memory.
    fn prepare(&mut self, system: &LinearSystem<'_>) -> Result<(), LinearBackendError>;

    /// Starts from x = 0 with the residual `r` [N] times `factor`, which makes its numbers fit into single
    /// precision; it is zero at nodes that are not free. Returns its squared norm.
    ///
    /// # Errors
    /// What the backend fails of.
    fn begin(&mut self, r: &[Vector], factor: f64) -> Result<f64, LinearBackendError>;

    /// Iterates until the squared norm of the residual is at most `goal`, `max_iterations` are made or rounding
    /// allows no further progress. Adds the solution times `factor` to `x` [m]. Returns the number of iterations.
    ///
    /// # Errors
    /// What the backend fails of; `x` is then unchanged.
    fn iterate(
        &mut self,
        goal: f64,
        max_iterations: usize,
        factor: f64,
        x: &mut [Vector],
    ) -> Result<usize, LinearBackendError>;

    /// The backend as one that does the whole of Newton iterations; None if it gets each matrix from the CPU by
    /// [`Self::prepare`].
    fn newton(&mut self) -> Option<&mut dyn NewtonBackend> {
        None
    }
}

/// The matrix H of a Newton iteration over N nodes: symmetric, positive definite over the free nodes. Rows and
/// columns of the other nodes count as zero.
///
/// ```text
/// (H x)_i = D_i x_i + sum_j B_ij x_j + sum_j q_ij x_j + sum_s w_si K_s (sum_k w_sk x_k)
/// ```
///
/// with diagonal blocks D, other blocks B, entries q that multiply the identity, and springs s over up to four
/// nodes with weights w and Hessians K.
#[derive(Clone, Copy, Debug)]
pub struct LinearSystem<'a> {
    /// Which nodes are free [N].
    pub free: &'a [bool],
    /// Where the nodes are [N, m].
    pub positions: &'a [Vector],
    /// The blocks D [N, N/m].
    pub diagonal: &'a [Matrix3<f64>],
    /// The blocks B [N/m].
    pub blocks: SparseRows<'a, Matrix3<f64>>,
    /// The entries q [N/m]; a pair of nodes has a block or an entry, not both.
    pub scalars: SparseRows<'a, f64>,
    /// The springs.
    pub springs: &'a [LinearSpring],
    /// Springs of each node with its weights: `spring_entries[spring_starts[i]..spring_starts[i + 1]]`. Both are
    /// empty if there are no springs.
    pub spring_starts: &'a [u32],
    /// See [`Self::spring_starts`].
    pub spring_entries: &'a [(u32, f64)],
    /// Ranges of nodes that are compact patches of one body each, in the order of a recursive bisection; empty if
    /// block-Jacobi was asked for.
    pub patches: &'a [Range<u32>],
}

/// A sparse matrix without its diagonal, row by row.
#[derive(Clone, Copy, Debug)]
pub struct SparseRows<'a, T> {
    /// Row i has the columns `columns[starts[i]..starts[i + 1]]` [N + 1].
    pub starts: &'a [u32],
    /// Columns, ascending within a row.
    pub columns: &'a [u32],
    /// One value per column.
    pub values: &'a [T],
}

impl<T> SparseRows<'_, T> {
    /// Columns and values of row `i`.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, &T)> {
        let range = self.starts[i] as usize..self.starts[i + 1] as usize;
        self.columns[range.clone()].iter().map(|&column| column as usize).zip(&self.values[range])
    }
}

impl LinearSystem<'_> {
    /// Springs of node `i` with its weights.
    pub fn springs_of(&self, i: usize) -> &[(u32, f64)] {
        match (self.spring_starts.get(i), self.spring_starts.get(i + 1)) {
            (Some(&start), Some(&end)) => &self.spring_entries[start as usize..end as usize],
            _ => &[],
        }
    }

    /// Diagonal block of node `i`, springs included [N/m].
    pub fn diagonal_with_springs(&self, i: usize) -> Matrix3<f64> {
        self.springs_of(i).iter().fold(self.diagonal[i], |sum, &(spring, weight)| {
            sum + self.springs[spring as usize].hessian * (weight * weight)
        })
    }

    /// Sum of the blocks and entries of row `i` without springs [N/m]: inertia, drag and what holds nodes.
    pub fn row_sum(&self, i: usize) -> Matrix3<f64> {
        let blocks = self.blocks.row(i).fold(self.diagonal[i], |sum, (_, block)| sum + block);
        blocks + Matrix3::from_diagonal_element(self.scalars.row(i).map(|(_, value)| value).sum())
    }
}

impl<'a> System<'a> {
    /// The matrix for a backend, with nodes at `positions`.
    pub fn for_backend(&self, positions: &'a [Vector], patches: &'a [Range<u32>]) -> LinearSystem<'a> {
        let pattern = self.pattern;
        let (starts, columns, values) = self.scalar.off_rows();
        LinearSystem {
            free: self.free,
            positions,
            diagonal: &self.values.diagonal,
            blocks: SparseRows {
                starts: &pattern.starts,
                columns: &pattern.columns,
                values: &self.values.blocks,
            },
            scalars: SparseRows { starts, columns, values },
            springs: self.springs.map_or(&[], |springs| springs.all()),
            spring_starts: self.springs.map_or(&[], |springs| springs.starts()),
            spring_entries: self.springs.map_or(&[], |springs| springs.all_entries()),
            patches,
        }
    }
}
