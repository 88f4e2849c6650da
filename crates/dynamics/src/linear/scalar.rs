//! Translation-invariant quadratic forms `E(x) = 1/2 sum q_ij x_i.x_j` with one number a pair of
//! nodes: every coordinate sees the same matrix.
//!
//! Rows sum to zero, so the diagonal is implied, `q_ii = - sum q_ij`, and products run over
//! differences x_j - x_i: exact invariance under translation however far the origin.

use super::block::BlockPattern;
use crate::elements::CHUNK;
use bowknot_geometry::Vector;
use rayon::prelude::*;
use std::ops::Range;

/// Collects entries.
pub(crate) struct ScalarBuilder {
    rows: Vec<Vec<(u32, f64)>>,
}

impl ScalarBuilder {
    pub fn new(node_count: usize) -> Self {
        Self { rows: vec![Vec::new(); node_count] }
    }

    /// Adds `value` to entries (i, j) and (j, i), and takes it from both diagonals. Nothing if i = j.
    pub fn add(&mut self, i: u32, j: u32, value: f64) {
        if i == j {
            return;
        }
        for (row, column) in [(i, j), (j, i)] {
            let row = &mut self.rows[row as usize];
            match row.iter_mut().find(|(c, _)| *c == column) {
                Some((_, sum)) => *sum += value,
                None => row.push((column, value)),
            }
        }
    }

    pub fn build(mut self) -> ScalarForm {
        let mut form =
            ScalarForm { starts: vec![0], columns: Vec::new(), values: Vec::new(), diagonal: Vec::new() };
        for row in &mut self.rows {
            row.sort_unstable_by_key(|&(column, _)| column);
            form.columns.extend(row.iter().map(|&(column, _)| column));
            form.values.extend(row.iter().map(|&(_, value)| value));
            form.starts.push(form.columns.len() as u32);
            form.diagonal.push(-row.iter().map(|&(_, value)| value).sum::<f64>());
        }
        form
    }
}

/// A finished form: off-diagonal entries in compressed rows, columns ascending.
#[derive(Clone, Debug, Default)]
pub(crate) struct ScalarForm {
    pub starts: Vec<u32>,
    pub columns: Vec<u32>,
    pub values: Vec<f64>,
    /// The implied diagonal.
    pub diagonal: Vec<f64>,
}

impl ScalarForm {
    #[inline]
    pub fn row(&self, row: usize) -> (&[u32], &[f64]) {
        let range = self.starts[row] as usize..self.starts[row + 1] as usize;
        (&self.columns[range.clone()], &self.values[range])
    }

    /// (Q x)_i.
    #[inline]
    pub fn product(&self, row: usize, x: &[Vector]) -> Vector {
        let (columns, values) = self.row(row);
        let mut sum = Vector::zeros();
        for (&column, &value) in columns.iter().zip(values) {
            sum += (x[column as usize] - x[row]) * value;
        }
        sum
    }

    /// Takes the form apart for a matrix with `pattern`: what falls on its off-diagonal blocks, by
    /// slot, and the far entries. The diagonal stays here.
    pub fn split(&self, pattern: &BlockPattern) -> SplitForm {
        let mut split = SplitForm {
            diagonal: self.diagonal.clone(),
            near: vec![0.0; pattern.columns.len()],
            far_starts: vec![0],
            ..SplitForm::default()
        };
        for row in 0..self.diagonal.len() {
            let slots = pattern.row(row);
            let (columns, values) = self.row(row);
            for (&column, &value) in columns.iter().zip(values) {
                match pattern.columns[slots.clone()].binary_search(&column) {
                    Ok(k) => split.near[slots.start + k] = value,
                    Err(_) => {
                        split.far_columns.push(column);
                        split.far_values.push(value);
                    }
                }
            }
            split.far_starts.push(split.far_columns.len() as u32);
        }
        split
    }

    /// `E(x) = -1/4 sum q_ij |x_i - x_j|^2`.
    pub fn energy(&self, x: &[Vector]) -> f64 {
        let chunks = x.len().div_ceil(CHUNK);
        let partial: Vec<f64> = (0..chunks).into_par_iter().map(|c| self.chunk_energy(c, x)).collect();
        partial.iter().sum()
    }

    /// The share of one chunk's rows.
    pub fn chunk_energy(&self, chunk: usize, x: &[Vector]) -> f64 {
        self.rows_energy(chunk * CHUNK..((chunk + 1) * CHUNK).min(x.len()), x)
    }

    /// The share of some rows.
    pub fn rows_energy(&self, rows: Range<usize>, x: &[Vector]) -> f64 {
        let mut sum = 0.0;
        for row in rows {
            let (columns, values) = self.row(row);
            for (&column, &value) in columns.iter().zip(values) {
                sum -= value * (x[column as usize] - x[row]).norm_squared();
            }
        }
        0.25 * sum
    }
}

/// A form as a matrix beside a block pattern: fewer entries to read in products.
#[derive(Clone, Debug, Default)]
pub(crate) struct SplitForm {
    pub diagonal: Vec<f64>,
    /// By slot of the pattern.
    pub near: Vec<f64>,
    far_starts: Vec<u32>,
    far_columns: Vec<u32>,
    far_values: Vec<f64>,
}

impl SplitForm {
    /// Columns and values of a row that are not in the block pattern.
    #[inline]
    pub fn far(&self, row: usize) -> (&[u32], &[f64]) {
        let range = self.far_starts[row] as usize..self.far_starts[row + 1] as usize;
        (&self.far_columns[range.clone()], &self.far_values[range])
    }

    /// Adds `factor` times another form, of the same pattern.
    pub fn add_scaled(&mut self, factor: f64, other: &SplitForm) {
        let add = |to: &mut [f64], from: &[f64]| to.iter_mut().zip(from).for_each(|(t, f)| *t += factor * f);
        add(&mut self.diagonal, &other.diagonal);
        add(&mut self.near, &other.near);
        add(&mut self.far_values, &other.far_values);
    }
}
