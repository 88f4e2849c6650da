//! Solutions by a Cholesky factor.

use super::symbolic::{Part, Symbolic};
use super::{Block, Cholesky, add_scaled};
use crate::linear::lane::Real;
use std::ops::Range;

/// What is known already of a solution: values of columns from `first` on, and those of later ones.
struct Known<'a, const W: usize> {
    first: usize,
    values: &'a [[f64; W]],
    later: Option<&'a Known<'a, W>>,
}

impl<T: Real, const B: usize, const W: usize> Cholesky<T, B, W> {
    /// Solves in place; `x` is in the new order, and its numbers from the B-th on are zero.
    pub fn solve(&self, symbolic: &Symbolic, x: &mut [[f64; W]]) {
        self.forward(symbolic, &symbolic.whole, x);
        self.backward(symbolic, &symbolic.whole, x, None);
    }

    /// Solves L y = x in the columns of a part; `x` is theirs.
    fn forward(&self, symbolic: &Symbolic, part: &Part, x: &mut [[f64; W]]) {
        let first = part.columns.start;
        if let Some(halves) = &part.halves {
            let [left, right] = &**halves;
            let (before, after) = x[..right.columns.end - first].split_at_mut(right.columns.start - first);
            rayon::join(|| self.forward(symbolic, left, before), || self.forward(symbolic, right, after));
        }
        forward_columns(symbolic, &self.inverses, &self.blocks, part.separator(), first, x);
    }

    /// Solves L^T y = x in the columns of a part, after those that depend on them; `x` is theirs.
    fn backward(&self, symbolic: &Symbolic, part: &Part, x: &mut [[f64; W]], later: Option<&Known<'_, W>>) {
        let first = part.columns.start;
        backward_columns(symbolic, &self.inverses, &self.blocks, part.separator(), x, first, later);
        let Some(halves) = &part.halves else { return };
        let [left, right] = &**halves;
        let (own, separator) = x.split_at_mut(right.columns.end - first);
        let known = Known { first: right.columns.end, values: separator, later };
        let (before, after) = own.split_at_mut(right.columns.start - first);
        rayon::join(
            || self.backward(symbolic, left, before, Some(&known)),
            || self.backward(symbolic, right, after, Some(&known)),
        );
    }
}

/// Solves L y = x in `columns`; `x` begins with column `first`.
#[multiversion::multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+avx2+bmi1+bmi2+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+lzcnt+popcnt",
))]
fn forward_columns<T: Real, const B: usize, const W: usize>(
    symbolic: &Symbolic,
    inverses: &[Block<f64, B, W>],
    blocks: &[Block<T, B, W>],
    columns: Range<usize>,
    first: usize,
    x: &mut [[f64; W]],
) {
    for k in columns {
        let mut value = x[k - first];
        for &(j, slot) in symbolic.row(k) {
            let (block, known) = (&blocks[slot as usize], &x[j as usize - first]);
            for m in 0..B {
                for r in 0..W {
                    value[r] -= block[m][r].to_f64() * known[m];
                }
            }
        }
        // Whole registers: the numbers after the B-th are zero.
        let value = std::hint::black_box(value);
        let mut solved = [0.0; W];
        for m in 0..B {
            add_scaled(&mut solved, &inverses[k][m], value[m]);
        }
        x[k - first] = solved;
    }
}

/// Solves L^T y = x in `columns`; `x` begins with column `first`.
#[multiversion::multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+avx2+bmi1+bmi2+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+lzcnt+popcnt",
))]
fn backward_columns<T: Real, const B: usize, const W: usize>(
    symbolic: &Symbolic,
    inverses: &[Block<f64, B, W>],
    blocks: &[Block<T, B, W>],
    columns: Range<usize>,
    x: &mut [[f64; W]],
    first: usize,
    later: Option<&Known<'_, W>>,
) {
    for k in columns.rev() {
        let mut sums = [[0.0; W]; B];
        // Rows ascend, as what is known does.
        let mut known = Known { first, values: &*x, later };
        for slot in symbolic.column(k) {
            let row = symbolic.rows[slot] as usize;
            while let (true, Some(later)) = (row >= known.first + known.values.len(), known.later) {
                known = Known { ..*later };
            }
            let value = &known.values[row - known.first];
            for (sum, column) in sums.iter_mut().zip(&blocks[slot]) {
                // As in products of blocks, rows are to be the lanes.
                let column = std::hint::black_box(column);
                for r in 0..W {
                    sum[r] += column[r].to_f64() * value[r];
                }
            }
        }
        let sums = std::hint::black_box(sums);
        let mut value = x[k - first];
        for m in 0..B {
            for r in 0..B {
                value[m] -= sums[m][r];
            }
        }
        let mut solved = [0.0; W];
        for m in 0..B {
            for r in 0..B {
                solved[m] += inverses[k][m][r] * value[r];
            }
        }
        x[k - first] = solved;
    }
}
