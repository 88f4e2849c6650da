//! The Newton system: inertia and elements, solved by conjugate gradients with 3x3 blocks of the diagonal as preconditioner.
//!
//! The matrix is kept as sparse rows of 3x3 blocks: in contact there are several pairs a vertex, so that this is shorter than
//! their elements. Each row sums its elements in their order: the same bits for any number of threads.

use super::hessian::Element;
use bowknot_twoway::geometry::Vector;
use nalgebra::Matrix3;
use rayon::prelude::*;

/// Vertices that one parallel task handles at least.
const CHUNK: usize = 256;

/// A symmetric positive definite matrix: inertia [N/m] of each vertex and elements. Rows of vertices without inertia are
/// zero: those stay.
#[derive(Debug)]
pub struct System {
    /// Where the blocks of each row start, their columns, and what they are.
    starts: Vec<u32>,
    columns: Vec<u32>,
    blocks: Vec<Matrix3<f64>>,
    /// Inverses of the diagonal's blocks; 0 for vertices that stay.
    inverses: Vec<Matrix3<f64>>,
}

/// How a solve went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolveReport {
    /// Iterations made.
    pub iterations: usize,
    /// Residual relative to the right-hand side, both in the norm of the preconditioner.
    pub residual: f64,
}

impl System {
    /// The system of `elements` over vertices with this `inertia`, 0 for those that stay.
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
            // Stable: what is summed keeps its order.
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

    /// A x; 0 for vertices that stay, whose entries of `x` act on the others all the same.
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

    /// Solves A x = b to a residual of `tolerance` relative to b, from x = 0; `b` is 0 for vertices that stay.
    pub fn solve(
        &self,
        b: &[Vector],
        tolerance: f64,
        max_iterations: usize,
        x: &mut Vec<Vector>,
    ) -> SolveReport {
        let count = b.len();
        x.clear();
        x.resize(count, Vector::zeros());
        let precondition = |r: &[Vector], z: &mut [Vector]| {
            z.iter_mut().zip(r).zip(&self.inverses).for_each(|((z, r), inverse)| *z = inverse * r);
        };
        let mut r = b.to_vec();
        let mut z = vec![Vector::zeros(); count];
        precondition(&r, &mut z);
        let mut p = z.clone();
        let mut product = vec![Vector::zeros(); count];
        let first = dot(&r, &z);
        let mut rz = first;
        let mut report = SolveReport { iterations: 0, residual: 1.0 };
        while report.iterations < max_iterations && rz > tolerance * tolerance * first {
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
            precondition(&r, &mut z);
            let next = dot(&r, &z);
            let share = next / rz;
            rz = next;
            for v in 0..count {
                p[v] = z[v] + share * p[v];
            }
            report.iterations += 1;
        }
        report.residual = if first > 0.0 { (rz.max(0.0) / first).sqrt() } else { 0.0 };
        report
    }
}

fn dot(a: &[Vector], b: &[Vector]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::barrier::hessian::Block12;
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn a_solve_is_that_of_the_dense_matrix() {
        let inertia = [1.0, 2.0, 0.5, 0.0, 3.0, 1.0];
        let mut random = fastrand::Rng::with_seed(7);
        let mut draw = || 2.0 * random.f64() - 1.0;
        let elements: Vec<Element> = [[0, 1, 2, 3], [2, 4, 5, 0], [5, 3, 2, 1], [1, 4, 1, 1]]
            .into_iter()
            .map(|vertices| {
                let count = if vertices == [1, 4, 1, 1] { 2 } else { 4 };
                let factor = Block12::from_fn(|i, j| if i.max(j) < 3 * count { draw() } else { 0.0 });
                Element { vertices, count, matrix: 3.0 * factor * factor.transpose() }
            })
            .collect();
        let free = |v: usize| inertia[v] > 0.0;
        let mut dense = DMatrix::<f64>::zeros(18, 18);
        for v in 0..6 {
            for c in 0..3 {
                dense[(3 * v + c, 3 * v + c)] += if free(v) { inertia[v] } else { 1.0 };
            }
        }
        for element in &elements {
            for i in 0..3 * element.count {
                for j in 0..3 * element.count {
                    let [a, b] = [i, j].map(|i| element.vertices[i / 3] as usize);
                    if free(a) && free(b) {
                        dense[(3 * a + i % 3, 3 * b + j % 3)] += element.matrix[(i, j)];
                    }
                }
            }
        }
        let b: Vec<Vector> = (0..6)
            .map(|v| if free(v) { Vector::new(draw(), draw(), draw()) } else { Vector::zeros() })
            .collect();
        let flat = DVector::from_iterator(18, b.iter().flat_map(|b| b.iter().copied()));
        let expected = dense.lu().solve(&flat).expect("positive definite");
        let mut x = Vec::new();
        let report = System::new(&inertia, &elements).solve(&b, 1e-13, 200, &mut x);
        assert!(report.residual <= 1e-13 && report.iterations > 3, "{report:?}");
        for (i, expected) in expected.iter().enumerate() {
            assert!((x[i / 3][i % 3] - expected).abs() < 1e-9, "{i}: {x:?} {expected}");
        }
    }
}
