//! Sparse Cholesky factorization of symmetric matrices of B x B blocks.
//!
//! It is made for small systems with the graph of a surface (coarse spaces) or of strands. Nodes are
//! eliminated in the order of nested dissection by position (recursive bisection; nodes of one half that
//! touch the other half come last), or in an order that the caller gives. Semi-definite matrices are allowed,
//! see [`PivotPolicy`].

use bowknot_geometry::Vector;
use nalgebra::{SMatrix, SVector};

/// A pivot at most this share of its diagonal entry counts as zero: the rounding error of a sum of a few
/// dozen terms that cancel, with a margin.
const ZERO_PIVOT: f64 = 1e-11;

/// Smallest pivot with [`PivotPolicy::Raise`], as a share of its diagonal entry.
const MIN_PIVOT: f64 = 1e-15;

/// What is done with pivots that vanish.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PivotPolicy {
    /// Drop their unknowns: for semi-definite systems.
    Drop,
    /// Raise them to the size of rounding errors: for systems that are definite, however barely.
    Raise,
}

/// The part of a factorization that depends on the graph alone.
#[derive(Clone, Debug, Default)]
pub(crate) struct Symbolic {
    /// Old index of each new index, and the inverse.
    pub order: Vec<u32>,
    pub place: Vec<u32>,
    /// Rows below the diagonal of each column of L, ascending: `rows[starts[k]..starts[k + 1]]`.
    starts: Vec<u32>,
    rows: Vec<u32>,
    /// For each row j: the columns k < j with L_jk, and the slot of L_jk.
    row_starts: Vec<u32>,
    row_entries: Vec<(u32, u32)>,
}

impl Symbolic {
    /// Analyses the graph in which node i has the `neighbors(i)` (in any order, i itself allowed), in the
    /// order of nested dissection by `positions`.
    pub fn new<'a>(positions: &[Vector], neighbors: impl Fn(usize) -> &'a [u32]) -> Self {
        let count = positions.len();
        let mut order: Vec<u32> = (0..count as u32).collect();
        let mut side = vec![0u8; count];
        dissect(&mut order, positions, &neighbors, &mut side);
        Self::in_order(order, neighbors)
    }

    /// Analyses the graph for elimination in the given order.
    pub fn in_order<'a>(order: Vec<u32>, neighbors: impl Fn(usize) -> &'a [u32]) -> Self {
        let count = order.len();
        let mut place = vec![0; count];
        order.iter().enumerate().for_each(|(new, &old)| place[old as usize] = new as u32);

        // The structure of a column is that of the matrix united with those of its children in the
        // elimination tree.
        let mut structures: Vec<Vec<u32>> = vec![Vec::new(); count];
        let mut children: Vec<Vec<u32>> = vec![Vec::new(); count];
        let mut seen = vec![u32::MAX; count];
        for k in 0..count {
            let mut rows = Vec::new();
            seen[k] = k as u32;
            let own = neighbors(order[k] as usize).iter().map(|&n| place[n as usize]);
            let inherited = children[k].iter().flat_map(|&c| structures[c as usize].iter().copied());
            for row in own.chain(inherited) {
                if row as usize > k && seen[row as usize] != k as u32 {
                    seen[row as usize] = k as u32;
                    rows.push(row);
                }
            }
            rows.sort_unstable();
            if let Some(&parent) = rows.first() {
                children[parent as usize].push(k as u32);
            }
            structures[k] = rows;
        }
        let mut symbolic = Self { order, place, starts: vec![0], ..Self::default() };
        let mut by_row: Vec<Vec<(u32, u32)>> = vec![Vec::new(); count];
        for (k, rows) in structures.iter().enumerate() {
            for &row in rows {
                by_row[row as usize].push((k as u32, symbolic.rows.len() as u32));
                symbolic.rows.push(row);
            }
            symbolic.starts.push(symbolic.rows.len() as u32);
        }
        symbolic.row_starts.push(0);
        for row in by_row {
            symbolic.row_entries.extend(row);
            symbolic.row_starts.push(symbolic.row_entries.len() as u32);
        }
        symbolic
    }

    fn column(&self, k: usize) -> std::ops::Range<usize> {
        self.starts[k] as usize..self.starts[k + 1] as usize
    }

    /// Number of products of blocks that a factorization subtracts below the diagonal.
    pub fn updates(&self) -> usize {
        let pairs = |entries: &[u32]| {
            let below = (entries[1] - entries[0]) as usize;
            below * below.saturating_sub(1) / 2
        };
        self.starts.windows(2).map(pairs).sum()
    }

    /// Number of blocks of L below the diagonal.
    pub fn fill(&self) -> usize {
        self.rows.len()
    }
}

/// Orders `nodes` in place: both halves, then the separator.
fn dissect<'a>(
    nodes: &mut [u32],
    positions: &[Vector],
    neighbors: &impl Fn(usize) -> &'a [u32],
    side: &mut [u8],
) {
    if nodes.len() <= 3 {
        nodes.sort_unstable();
        return;
    }
    let (mut low, mut high) = (Vector::repeat(f64::INFINITY), Vector::repeat(f64::NEG_INFINITY));
    for &n in nodes.iter() {
        low = low.inf(&positions[n as usize]);
        high = high.sup(&positions[n as usize]);
    }
    let axis = (high - low).imax();
    nodes.sort_unstable_by(|&a, &b| {
        positions[a as usize][axis].total_cmp(&positions[b as usize][axis]).then(a.cmp(&b))
    });
    let middle = nodes.len() / 2;
    nodes[..middle].iter().for_each(|&n| side[n as usize] = 1);
    let (mut right, separator): (Vec<u32>, Vec<u32>) = nodes[middle..]
        .iter()
        .partition(|&&n| neighbors(n as usize).iter().all(|&other| side[other as usize] != 1));
    nodes[..middle].iter().for_each(|&n| side[n as usize] = 0);
    let split = middle + right.len();
    nodes[middle..split].copy_from_slice(&right);
    right.clear();
    nodes[split..].copy_from_slice(&separator);
    dissect(&mut nodes[..middle], positions, neighbors, side);
    dissect(&mut nodes[middle..split], positions, neighbors, side);
}

/// The factor L, by columns.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cholesky<const B: usize> {
    /// Inverses of the diagonal blocks of L.
    inverses: Vec<SMatrix<f64, B, B>>,
    /// Blocks below the diagonal, in the symbolic order.
    blocks: Vec<SMatrix<f64, B, B>>,
    /// Buffer: slot of each row in the current column.
    slots: Vec<u32>,
}

impl<const B: usize> Cholesky<B> {
    /// Factorizes a matrix. `row(i)` gives the columns and blocks of row i, in old indices; blocks above the
    /// diagonal of the new order are skipped.
    pub fn factorize<'a>(
        &mut self,
        symbolic: &Symbolic,
        policy: PivotPolicy,
        row: impl Fn(usize) -> (&'a [u32], &'a [SMatrix<f64, B, B>]),
    ) {
        let count = symbolic.order.len();
        self.inverses.clear();
        self.inverses.resize(count, SMatrix::zeros());
        self.blocks.clear();
        self.blocks.resize(symbolic.fill(), SMatrix::zeros());
        self.slots.resize(count, 0);
        for k in 0..count {
            let column = symbolic.column(k);
            for slot in column.clone() {
                self.slots[symbolic.rows[slot] as usize] = slot as u32;
            }
            let mut diagonal = SMatrix::zeros();
            // The matrix is symmetric: row k is the transpose of column k.
            let (columns, blocks) = row(symbolic.order[k] as usize);
            for (&other, block) in columns.iter().zip(blocks) {
                let place = symbolic.place[other as usize] as usize;
                if place == k {
                    diagonal = *block;
                } else if place > k {
                    self.blocks[self.slots[place] as usize] = block.transpose();
                }
            }
            let scale: SVector<f64, B> = diagonal.diagonal();
            for e in symbolic.row_starts[k] as usize..symbolic.row_starts[k + 1] as usize {
                let (j, slot) = symbolic.row_entries[e];
                let left = self.blocks[slot as usize];
                let transposed = left.transpose();
                diagonal -= left * transposed;
                for below in slot as usize + 1..symbolic.column(j as usize).end {
                    let target = self.slots[symbolic.rows[below] as usize] as usize;
                    let update = self.blocks[below] * transposed;
                    self.blocks[target] -= update;
                }
            }
            let inverse = inverse_factor(&diagonal, &scale, policy);
            let transposed = inverse.transpose();
            for slot in column {
                self.blocks[slot] *= transposed;
            }
            self.inverses[k] = inverse;
        }
    }

    /// Solves in place; `x` is in the new order.
    pub fn solve(&self, symbolic: &Symbolic, x: &mut [SVector<f64, B>]) {
        for k in 0..x.len() {
            let value = self.inverses[k] * x[k];
            x[k] = value;
            for slot in symbolic.column(k) {
                x[symbolic.rows[slot] as usize] -= self.blocks[slot] * value;
            }
        }
        for k in (0..x.len()).rev() {
            let mut value = x[k];
            for slot in symbolic.column(k) {
                value -= self.blocks[slot].tr_mul(&x[symbolic.rows[slot] as usize]);
            }
            x[k] = self.inverses[k].tr_mul(&value);
        }
    }
}

/// Inverse of the Cholesky factor of a block; rows and columns of dropped pivots are zero.
fn inverse_factor<const B: usize>(
    block: &SMatrix<f64, B, B>,
    scale: &SVector<f64, B>,
    policy: PivotPolicy,
) -> SMatrix<f64, B, B> {
    let mut factor = SMatrix::<f64, B, B>::zeros();
    let mut inverse = SMatrix::<f64, B, B>::zeros();
    for k in 0..B {
        let mut pivot = block[(k, k)];
        (0..k).for_each(|m| pivot -= factor[(k, m)] * factor[(k, m)]);
        if policy == PivotPolicy::Raise {
            pivot = pivot.max(MIN_PIVOT * scale[k]);
        }
        let zero = if policy == PivotPolicy::Drop { ZERO_PIVOT * scale[k] } else { 0.0 };
        if pivot.is_nan() || pivot <= zero {
            continue;
        }
        let reciprocal = 1.0 / pivot.sqrt();
        factor[(k, k)] = pivot.sqrt();
        for i in k + 1..B {
            let mut value = block[(i, k)];
            (0..k).for_each(|m| value -= factor[(i, m)] * factor[(k, m)]);
            factor[(i, k)] = value * reciprocal;
        }
        // Row k of the inverse: (e_k - sum_m L_km inverse_m) / L_kk.
        for j in 0..=k {
            let mut value = if j == k { 1.0 } else { 0.0 };
            (j..k).for_each(|m| value -= factor[(k, m)] * inverse[(m, j)]);
            inverse[(k, j)] = value * reciprocal;
        }
    }
    inverse
}

#[cfg(test)]
mod tests;
