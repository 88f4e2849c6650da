//! Translation-invariant quadratic forms `E(x) = 1/2 sum q_ij x_i.x_j` with one number per pair of nodes: the
//! matrix is the same for every coordinate.
//!
//! Rows sum to zero. The diagonal is implied, `q_ii = - sum q_ij`, and products use differences x_j - x_i:
//! they are exactly invariant under translation, however far the origin is.

use super::block::BlockPattern;
use crate::elements::set::Displaced;
use crate::nodes::CHUNK;
use bowknot_geometry::Vector;
use rayon::prelude::*;
use std::ops::Range;

/// Collects the entries of a form.
pub(crate) struct ScalarBuilder {
    rows: Vec<Vec<(u32, f64)>>,
}

impl ScalarBuilder {
    pub fn new(node_count: usize) -> Self {
        Self { rows: vec![Vec::new(); node_count] }
    }

    /// Adds `value` to entries (i, j) and (j, i) and subtracts it from both diagonal entries. Does nothing if
    /// i = j.
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

    /// Splits the form for a matrix with `pattern` into the entries that its off-diagonal blocks have a place
    /// for, and the others.
    pub fn split(&self, pattern: &BlockPattern) -> SplitForm {
        let mut split = SplitForm {
            diagonal: self.diagonal.clone(),
            in_pattern: vec![0.0; pattern.columns.len()],
            off_starts: vec![0],
            ..SplitForm::default()
        };
        for row in 0..self.diagonal.len() {
            let slots = pattern.row(row);
            let (columns, values) = self.row(row);
            for (&column, &value) in columns.iter().zip(values) {
                match pattern.columns[slots.clone()].binary_search(&column) {
                    Ok(k) => split.in_pattern[slots.start + k] = value,
                    Err(_) => {
                        split.off_columns.push(column);
                        split.off_values.push(value);
                    }
                }
            }
            split.off_starts.push(split.off_columns.len() as u32);
        }
        split
    }

    /// `E(x) = -1/4 sum q_ij |x_i - x_j|^2`.
    pub fn energy(&self, x: &[Vector]) -> f64 {
        let chunks = x.len().div_ceil(CHUNK);
        let partial: Vec<f64> = (0..chunks).into_par_iter().map(|c| self.chunk_energy(c, x)).collect();
        partial.iter().sum()
    }

    /// Energy of the rows of one chunk.
    pub fn chunk_energy(&self, chunk: usize, x: &[Vector]) -> f64 {
        self.rows_energy(chunk * CHUNK..((chunk + 1) * CHUNK).min(x.len()), x)
    }

    /// Change of the energy of the rows of one chunk.
    pub fn energy_change(&self, chunk: usize, change: &Displaced<'_>) -> f64 {
        let Displaced { from, x, moved } = change;
        let mut sum = 0.0;
        for row in chunk * CHUNK..((chunk + 1) * CHUNK).min(x.len()) {
            let (columns, values) = self.row(row);
            for (&column, &value) in columns.iter().zip(values) {
                let column = column as usize;
                if moved[row] || moved[column] {
                    let (before, after) = (from[column] - from[row], x[column] - x[row]);
                    // |after|^2 - |before|^2.
                    sum -= value * (after - before).dot(&(after + before));
                }
            }
        }
        0.25 * sum
    }

    /// Energy of a range of rows.
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

/// A form split by a block pattern. The block matrix takes the entries in the pattern, so that products read
/// fewer numbers.
#[derive(Clone, Debug, Default)]
pub(crate) struct SplitForm {
    pub diagonal: Vec<f64>,
    /// Entries in the pattern, in its order.
    pub in_pattern: Vec<f64>,
    /// Entries outside of the pattern: compressed rows.
    off_starts: Vec<u32>,
    off_columns: Vec<u32>,
    off_values: Vec<f64>,
}

impl SplitForm {
    /// Columns and values of a row that are not in the block pattern.
    #[inline]
    pub fn off_pattern(&self, row: usize) -> (&[u32], &[f64]) {
        let range = self.off_range(row);
        (&self.off_columns[range.clone()], &self.off_values[range])
    }

    /// Where the entries of a row outside of the pattern stand in [`Self::off_columns`] and
    /// [`Self::off_values`].
    #[inline]
    pub fn off_range(&self, row: usize) -> Range<usize> {
        self.off_starts[row] as usize..self.off_starts[row + 1] as usize
    }

    /// Columns of all entries outside of the pattern.
    #[inline]
    pub fn off_columns(&self) -> &[u32] {
        &self.off_columns
    }

    /// Values of all entries outside of the pattern.
    pub fn off_values(&self) -> &[f64] {
        &self.off_values
    }

    /// Starts of rows, columns and values of the entries outside of the pattern.
    pub fn off_rows(&self) -> (&[u32], &[u32], &[f64]) {
        (&self.off_starts, &self.off_columns, &self.off_values)
    }

    /// Adds `factor` times another form with the same entries.
    pub fn add_scaled(&mut self, factor: f64, other: &SplitForm) {
        let add = |to: &mut [f64], from: &[f64]| to.iter_mut().zip(from).for_each(|(t, f)| *t += factor * f);
        add(&mut self.diagonal, &other.diagonal);
        add(&mut self.in_pattern, &other.in_pattern);
        add(&mut self.off_values, &other.off_values);
    }
}
