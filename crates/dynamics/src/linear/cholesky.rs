//! Sparse Cholesky factorisation of symmetric matrices of B x B blocks.
//!
//! Meant for small systems with the graph of a surface (coarse spaces). The order is nested
//! dissection by position: recursive bisection, the nodes of one half that touch the other last.
//! Semi-definite input is welcome: a pivot that vanishes drops its unknown.

use bowknot_geometry::Vector;
use nalgebra::{SMatrix, SVector};

/// A pivot below this share of its diagonal entry has vanished: what cancellation leaves of a sum of
/// a few dozen terms, with room.
const ZERO_PIVOT: f64 = 1e-11;

/// The least share of its diagonal entry that a pivot counts as where it must not vanish.
const LEAST_PIVOT: f64 = 1e-15;

/// What becomes of pivots that vanish.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Vanished {
    /// Their unknowns are dropped: for semi-definite systems.
    Dropped,
    /// They are raised to the rounding: for systems that are definite, however barely.
    Floored,
}

/// What depends on the graph alone.
#[derive(Clone, Debug, Default)]
pub(crate) struct Symbolic {
    /// Old index of each new one, and the inverse.
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
    /// Analyses the graph with `neighbours(i)` (any order, i itself allowed) at `positions`.
    pub fn new<'a>(positions: &[Vector], neighbours: impl Fn(usize) -> &'a [u32]) -> Self {
        let count = positions.len();
        let mut order: Vec<u32> = (0..count as u32).collect();
        let mut side = vec![0u8; count];
        dissect(&mut order, positions, &neighbours, &mut side);
        Self::in_order(order, neighbours)
    }

    /// Analyses the graph with `neighbours(i)` for elimination in the given order.
    pub fn in_order<'a>(order: Vec<u32>, neighbours: impl Fn(usize) -> &'a [u32]) -> Self {
        let count = order.len();
        let mut place = vec![0; count];
        order.iter().enumerate().for_each(|(new, &old)| place[old as usize] = new as u32);

        // Column structures: the matrix's own, and those of the children in the elimination tree.
        let mut structures: Vec<Vec<u32>> = vec![Vec::new(); count];
        let mut children: Vec<Vec<u32>> = vec![Vec::new(); count];
        let mut seen = vec![u32::MAX; count];
        for k in 0..count {
            let mut rows = Vec::new();
            seen[k] = k as u32;
            let own = neighbours(order[k] as usize).iter().map(|&n| place[n as usize]);
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

    /// Blocks of L below the diagonal.
    pub fn fill(&self) -> usize {
        self.rows.len()
    }
}

/// Orders `nodes` in place: the halves, then the separator.
fn dissect<'a>(
    nodes: &mut [u32],
    positions: &[Vector],
    neighbours: &impl Fn(usize) -> &'a [u32],
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
        .partition(|&&n| neighbours(n as usize).iter().all(|&other| side[other as usize] != 1));
    nodes[..middle].iter().for_each(|&n| side[n as usize] = 0);
    let split = middle + right.len();
    nodes[middle..split].copy_from_slice(&right);
    right.clear();
    nodes[split..].copy_from_slice(&separator);
    dissect(&mut nodes[..middle], positions, neighbours, side);
    dissect(&mut nodes[middle..split], positions, neighbours, side);
}

/// The factor L, by columns.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cholesky<const B: usize> {
    /// Inverses of the diagonal blocks of L.
    inverses: Vec<SMatrix<f64, B, B>>,
    /// Blocks below the diagonal, in the symbolic order.
    blocks: Vec<SMatrix<f64, B, B>>,
    /// Work: slot of each row in the column under way.
    slots: Vec<u32>,
}

impl<const B: usize> Cholesky<B> {
    /// Factorises the matrix whose blocks (i, j) of old indices `visit(i)` yields; those above the
    /// diagonal of the new order are skipped.
    pub fn factorise<'a>(
        &mut self,
        symbolic: &Symbolic,
        vanished: Vanished,
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
            // The matrix is symmetric: its row is its column.
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
            let inverse = inverse_factor(&diagonal, &scale, vanished);
            let transposed = inverse.transpose();
            for slot in column {
                self.blocks[slot] *= transposed;
            }
            self.inverses[k] = inverse;
        }
    }

    /// Solves in place; `x` in the new order.
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

/// Inverse of the Cholesky factor of a block; rows and columns of vanished pivots are zero.
fn inverse_factor<const B: usize>(
    block: &SMatrix<f64, B, B>,
    scale: &SVector<f64, B>,
    vanished: Vanished,
) -> SMatrix<f64, B, B> {
    let mut factor = SMatrix::<f64, B, B>::zeros();
    let mut inverse = SMatrix::<f64, B, B>::zeros();
    for k in 0..B {
        let mut pivot = block[(k, k)];
        (0..k).for_each(|m| pivot -= factor[(k, m)] * factor[(k, m)]);
        if vanished == Vanished::Floored {
            pivot = pivot.max(LEAST_PIVOT * scale[k]);
        }
        let least = if vanished == Vanished::Dropped { ZERO_PIVOT * scale[k] } else { 0.0 };
        if pivot.is_nan() || pivot <= least {
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
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    type Block = SMatrix<f64, 2, 2>;

    struct Grid {
        positions: Vec<Vector>,
        rows: Vec<Vec<u32>>,
        blocks: Vec<Vec<Block>>,
        dense: DMatrix<f64>,
    }

    /// A grid graph with symmetric positive definite blocks.
    fn grid(n: usize) -> Grid {
        let count = n * n;
        let mut positions = Vec::new();
        let mut rows = vec![Vec::new(); count];
        for j in 0..n {
            for i in 0..n {
                positions.push(Vector::new(i as f64, j as f64, 0.0));
                let me = i + j * n;
                rows[me].push(me as u32);
                if i + 1 < n {
                    rows[me].push(me as u32 + 1);
                    rows[me + 1].push(me as u32);
                }
                if j + 1 < n {
                    rows[me].push((me + n) as u32);
                    rows[me + n].push(me as u32);
                }
            }
        }
        let mut dense = DMatrix::zeros(2 * count, 2 * count);
        for (i, row) in rows.iter().enumerate() {
            for &j in row.iter().filter(|&&j| j as usize >= i) {
                let j = j as usize;
                for a in 0..2 {
                    for b in 0..2 {
                        let value = if i == j {
                            if a == b { 9.0 } else { 1.0 }
                        } else {
                            ((i + 3 * j + 5 * a + 7 * b) as f64).sin()
                        };
                        dense[(2 * i + a, 2 * j + b)] = value;
                        dense[(2 * j + b, 2 * i + a)] = value;
                    }
                }
            }
        }
        let blocks = rows
            .iter()
            .enumerate()
            .map(|(i, row)| {
                row.iter().map(|&j| dense.fixed_view::<2, 2>(2 * i, 2 * j as usize).into_owned()).collect()
            })
            .collect();
        Grid { positions, rows, blocks, dense }
    }

    #[test]
    fn it_solves_what_a_dense_factorisation_solves() {
        let Grid { positions, rows, blocks, dense } = grid(9);
        let symbolic = Symbolic::new(&positions, |i| &rows[i]);
        let mut factor = Cholesky::<2>::default();
        factor.factorise(&symbolic, Vanished::Dropped, |i| (&rows[i], &blocks[i]));
        let right = DVector::from_fn(dense.nrows(), |i, _| (i as f64 * 0.7).cos());
        let exact = dense.cholesky().expect("diagonally dominant").solve(&right);
        let mut x: Vec<SVector<f64, 2>> =
            symbolic.order.iter().map(|&old| right.fixed_rows::<2>(2 * old as usize).into_owned()).collect();
        factor.solve(&symbolic, &mut x);
        for (new, &old) in symbolic.order.iter().enumerate() {
            assert!((x[new] - exact.fixed_rows::<2>(2 * old as usize)).norm() < 1e-12);
        }
    }

    #[test]
    fn nested_dissection_fills_less_than_a_band() {
        let Grid { positions, rows, .. } = grid(32);
        let symbolic = Symbolic::new(&positions, |i| &rows[i]);
        // A band of 32 would hold 32 * 1024.
        assert!(symbolic.fill() < 32 * 1024 / 2, "{}", symbolic.fill());
    }

    #[test]
    fn semi_definite_systems_give_a_solution() {
        // Two equal unknowns: the second is dropped, the equation still holds.
        let block = SMatrix::<f64, 2, 2>::new(4.0, 4.0, 4.0, 4.0);
        let rows = [0u32];
        let symbolic = Symbolic::new(&[Vector::zeros()], |_| &rows);
        let mut factor = Cholesky::<2>::default();
        let blocks = [block];
        factor.factorise(&symbolic, Vanished::Dropped, |_| (&rows, &blocks));
        let mut x = [SVector::<f64, 2>::new(8.0, 8.0)];
        factor.solve(&symbolic, &mut x);
        assert!((block * x[0] - SVector::<f64, 2>::new(8.0, 8.0)).norm() < 1e-14);
    }
}
