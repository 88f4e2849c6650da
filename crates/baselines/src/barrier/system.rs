//! The Newton system: inertia and elements. Conjugate gradients solve it with 3x3 blocks of the diagonal as
//! preconditioner, [`super::cholesky`] directly.
//!
//! The matrix is stored as sparse rows of 3x3 blocks, which are fewer than the blocks of the elements,
//! because a vertex in contact has several pairs. Each row sums its elements in their order: the same bits
//! for any number of threads.

use super::hessian::Element;
use bowknot_twoway::geometry::Vector;
use nalgebra::Matrix3;
use rayon::prelude::*;

/// Smallest number of vertices of a parallel task.
const CHUNK: usize = 256;
/// Residual at which conjugate gradients end, relative to the right-hand side, both in the norm of the
/// preconditioner.
const TOLERANCE: f64 = 1e-4;
/// Largest number of their iterations.
const MAX_ITERATIONS: usize = 2000;

/// A symmetric positive definite matrix: inertia [N/m] of each vertex, and elements. Rows of vertices without
/// inertia are zero: these vertices do not move.
#[derive(Debug)]
pub struct System {
    /// Starts of the rows, columns of their blocks, and the blocks.
    starts: Vec<u32>,
    columns: Vec<u32>,
    blocks: Vec<Matrix3<f64>>,
    /// Inverses of the diagonal blocks; 0 for vertices that do not move.
    inverses: Vec<Matrix3<f64>>,
}

impl System {
    /// The system of `elements` over vertices with this `inertia`, 0 for vertices that do not move.
    pub fn new(inertia: &[f64], elements: &[Element]) -> Self {
        let mut incidence = vec![Vec::new(); inertia.len()];
        for element in elements {
            for (place, v) in element.vertices[..element.count].iter().enumerate() {
                incidence[*v as usize].push((element, place));
            }
        }
        let row = |v: usize| -> Vec<(u32, Matrix3<f64>)> {
            if inertia[v] <= 0.0 {
                return Vec::new();
            }
            let mut row = vec![(v as u32, Matrix3::from_diagonal_element(inertia[v]))];
            for (element, place) in &incidence[v] {
                for k in 0..element.count {
                    let block = element.matrix.fixed_view::<3, 3>(3 * place, 3 * k);
                    row.push((element.vertices[k], block.into_owned()));
                }
            }
            // A stable sort keeps the order of the sums.
            row.sort_by_key(|(column, _)| *column);
            row.dedup_by(|next, sum| {
                let same = next.0 == sum.0;
                if same {
                    sum.1 += next.1;
                }
                same
            });
            row
        };
        let rows: Vec<_> = (0..inertia.len()).into_par_iter().with_min_len(CHUNK).map(row).collect();
        let mut starts = vec![0];
        let (mut columns, mut blocks) = (Vec::new(), Vec::new());
        let mut inverses = Vec::with_capacity(rows.len());
        for (v, row) in rows.iter().enumerate() {
            columns.extend(row.iter().map(|(column, _)| *column));
            blocks.extend(row.iter().map(|(_, block)| *block));
            starts.push(columns.len() as u32);
            let diagonal = row.iter().find(|(column, _)| *column == v as u32).map(|(_, block)| *block);
            inverses.push(diagonal.map_or_else(Matrix3::zeros, |block| match block.cholesky() {
                Some(factor) => factor.inverse(),
                None => Matrix3::from_diagonal_element(1.0 / block.trace()),
            }));
        }
        Self { starts, columns, blocks, inverses }
    }

    /// Whether a vertex moves.
    pub fn is_free(&self, v: u32) -> bool {
        !self.columns(v).is_empty()
    }

    /// Largest entry of a diagonal block [N/m].
    pub fn largest(&self) -> f64 {
        self.blocks.iter().map(Matrix3::amax).fold(0.0, f64::max)
    }

    /// The columns of a row, ascending.
    pub fn columns(&self, v: u32) -> &[u32] {
        &self.columns[self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize]
    }

    /// The columns of a row and their blocks.
    pub fn row(&self, v: u32) -> impl Iterator<Item = (u32, &Matrix3<f64>)> {
        let entries = self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize;
        self.columns(v).iter().copied().zip(&self.blocks[entries])
    }

    /// A x; 0 for vertices that do not move. Their entries of `x` still act on the others.
    pub fn multiply(&self, x: &[Vector], product: &mut [Vector]) {
        product.par_iter_mut().enumerate().with_min_len(CHUNK).for_each(|(v, row)| {
            let entries = self.starts[v] as usize..self.starts[v + 1] as usize;
            let columns = &self.columns[entries.clone()];
            let mut sum = Vector::zeros();
            for (block, &column) in self.blocks[entries].iter().zip(columns) {
                sum += block * x[column as usize];
            }
            *row = sum;
        });
    }

    /// Solves A x = b in place by conjugate gradients from x = 0; `b` is 0 for vertices that do not move.
    /// Returns the number of iterations.
    pub fn iterate(&self, b: &mut [Vector]) -> usize {
        let count = b.len();
        let mut x = vec![Vector::zeros(); count];
        let precondition = |r: &[Vector], z: &mut [Vector]| {
            z.iter_mut().zip(r).zip(&self.inverses).for_each(|((z, r), inverse)| *z = inverse * r);
        };
        let r = b;
        let mut z = vec![Vector::zeros(); count];
        precondition(r, &mut z);
        let mut p = z.clone();
        let mut product = vec![Vector::zeros(); count];
        let first = dot(r, &z);
        let mut rz = first;
        let mut iterations = 0;
        while iterations < MAX_ITERATIONS && rz > TOLERANCE * TOLERANCE * first {
            self.multiply(&p, &mut product);
            let curvature = dot(&p, &product);
            if curvature.is_nan() || curvature <= 0.0 {
                break;
            }
            let step = rz / curvature;
            for v in 0..count {
                x[v] += step * p[v];
                r[v] -= step * product[v];
            }
            precondition(r, &mut z);
            let next = dot(r, &z);
            let share = next / rz;
            rz = next;
            for v in 0..count {
                p[v] = z[v] + share * p[v];
            }
            iterations += 1;
        }
        r.copy_from_slice(&x);
        iterations
    }
}

fn dot(a: &[Vector], b: &[Vector]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}

#[cfg(test)]
mod tests;
