//! Sparse Cholesky factorization of a [`System`]: multifrontal, over 3x3 blocks, ordered by nested dissection.
//!
//! Vertices are split in two halves along the longest axis of their bounding box, again and again (George
//! 1973). Those of one half with a neighbor in the other one are the separator, which is eliminated after
//! both. Each separator and each small rest is one dense front (Duff and Reid 1983): its rows are factored,
//! and what remains of the rows that are eliminated later is added to the front above. Almost all operations
//! are products of dense matrices. It runs on one thread, and results do not depend on the number of threads.

use super::system::System;
use bowknot_twoway::geometry::{Point, Vector};
use nalgebra::{DMatrix, DVector, Matrix3};

/// A set with fewer vertices is not split further.
const LEAF: usize = 24;
/// Columns that are factored before the rest of a front is updated by them.
const PANEL: usize = 48;
/// Columns of one product of that update, which computes little more than the lower triangle.
const BLOCK: usize = 192;

/// The factor L of a system A = L L^T.
#[derive(Debug, Default)]
pub struct Cholesky {
    /// In the order of elimination.
    fronts: Vec<Front>,
    /// Vertices without neighbors, and the inverses of their blocks.
    lone: Vec<(u32, Matrix3<f64>)>,
}

/// Vertices that are eliminated together.
#[derive(Debug)]
struct Front {
    /// These, then those that are eliminated later and share a row with them.
    vertices: Vec<u32>,
    /// Number of the former.
    own: usize,
    /// Columns of L of the former, over all vertices.
    columns: DMatrix<f64>,
}

/// What a front leaves for the rows that are eliminated later: vertices, and the lower triangle of a matrix.
struct Update {
    vertices: Vec<u32>,
    matrix: DMatrix<f64>,
}

impl Cholesky {
    /// Factors `system` with more `inertia` [N/m] of each vertex; `positions` only choose the order. None if
    /// it is not positive definite up to rounding.
    pub fn new(system: &System, inertia: f64, positions: &[Point]) -> Option<Self> {
        let mut factorization = Factorization {
            system,
            inertia,
            positions,
            side: vec![Side::None; positions.len()],
            is_done: vec![false; positions.len()],
            place: vec![usize::MAX; positions.len()],
            fronts: Vec::new(),
        };
        let (mut lone, mut coupled) = (Vec::new(), Vec::new());
        for v in (0..positions.len() as u32).filter(|&v| system.is_free(v)) {
            let mut row = system.row(v);
            match (row.next(), row.next()) {
                (Some((_, block)), None) => {
                    let block = block + Matrix3::from_diagonal_element(inertia);
                    lone.push((v, block.cholesky()?.inverse()));
                }
                _ => coupled.push(v),
            }
        }
        factorization.eliminate(coupled)?;
        Some(Self { fronts: factorization.fronts, lone })
    }

    /// Solves A x = b in place.
    pub fn solve(&self, b: &mut [Vector]) {
        let gather = |front: &Front, b: &[Vector]| {
            DVector::from_iterator(
                3 * front.vertices.len(),
                front.vertices.iter().flat_map(|&v| b[v as usize].iter().copied().collect::<Vec<_>>()),
            )
        };
        self.lone.iter().for_each(|(v, inverse)| b[*v as usize] = inverse * b[*v as usize]);
        for front in &self.fronts {
            let mut x = gather(front, b);
            let m = 3 * front.own;
            let (mut own, mut rest) = x.rows_range_pair_mut(..m, m..);
            front.columns.rows(0, m).solve_lower_triangular_unchecked_mut(&mut own);
            rest.gemv(-1.0, &front.columns.rows(m, rest.len()), &own, 1.0);
            front.scatter(&x, front.vertices.len(), b);
        }
        for front in self.fronts.iter().rev() {
            let mut x = gather(front, b);
            let m = 3 * front.own;
            let (mut own, rest) = x.rows_range_pair_mut(..m, m..);
            own.gemv_tr(-1.0, &front.columns.rows(m, rest.len()), &rest, 1.0);
            front.columns.rows(0, m).tr_solve_lower_triangular_unchecked_mut(&mut own);
            front.scatter(&x, front.own, b);
        }
    }
}

impl Front {
    /// Writes the first `count` vertices back.
    fn scatter(&self, x: &DVector<f64>, count: usize, b: &mut [Vector]) {
        for (k, &v) in self.vertices[..count].iter().enumerate() {
            b[v as usize] = x.fixed_rows::<3>(3 * k).into_owned();
        }
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Side {
    None,
    Low,
    High,
}

struct Factorization<'a> {
    system: &'a System,
    inertia: f64,
    positions: &'a [Point],
    /// Half of each vertex in the present split.
    side: Vec<Side>,
    is_done: Vec<bool>,
    /// Place of each vertex in the present front.
    place: Vec<usize>,
    fronts: Vec<Front>,
}

impl Factorization<'_> {
    /// Eliminates `vertices`.
    fn eliminate(&mut self, vertices: Vec<u32>) -> Option<Vec<Update>> {
        if vertices.is_empty() {
            return Some(Vec::new());
        }
        let (own, mut updates) = if vertices.len() <= LEAF {
            (vertices, Vec::new())
        } else {
            let [low, high, separator] = self.split(vertices);
            let mut updates = self.eliminate(low)?;
            updates.append(&mut self.eliminate(high)?);
            (separator, updates)
        };
        if own.is_empty() {
            // Nothing connects both halves. What they leave belongs to fronts above.
            return Some(updates);
        }
        let update = self.front(own, std::mem::take(&mut updates))?;
        Some(if update.vertices.is_empty() { Vec::new() } else { vec![update] })
    }

    /// Two halves without a common row, and the separator.
    fn split(&mut self, mut vertices: Vec<u32>) -> [Vec<u32>; 3] {
        let at = |v: &u32| self.positions[*v as usize].coords;
        let first = at(&vertices[0]);
        let (low, high) = vertices.iter().map(at).fold((first, first), |(l, h), p| (l.inf(&p), h.sup(&p)));
        let axis = (high - low).imax();
        vertices.sort_unstable_by(|a, b| at(a)[axis].total_cmp(&at(b)[axis]).then(a.cmp(b)));
        let high = vertices.split_off(vertices.len() / 2);
        vertices.iter().for_each(|&v| self.side[v as usize] = Side::Low);
        high.iter().for_each(|&v| self.side[v as usize] = Side::High);
        let meets =
            |v: u32, side: Side| self.system.columns(v).iter().any(|&c| self.side[c as usize] == side);
        let of_low: Vec<u32> = vertices.iter().copied().filter(|&v| meets(v, Side::High)).collect();
        let of_high: Vec<u32> = high.iter().copied().filter(|&v| meets(v, Side::Low)).collect();
        let separator = if of_low.len() <= of_high.len() { of_low } else { of_high };
        for v in vertices.iter().chain(&high) {
            self.side[*v as usize] = Side::None;
        }
        separator.iter().for_each(|&v| self.side[v as usize] = Side::Low);
        let mut halves = [vertices, high];
        halves.iter_mut().for_each(|half| half.retain(|&v| self.side[v as usize] == Side::None));
        separator.iter().for_each(|&v| self.side[v as usize] = Side::None);
        let [low, high] = halves;
        [low, high, separator]
    }

    /// Factors the rows of `own`, given the updates of all fronts below that reach them.
    fn front(&mut self, own: Vec<u32>, updates: Vec<Update>) -> Option<Update> {
        let count = own.len();
        let mut vertices = own;
        vertices.iter().enumerate().for_each(|(k, &v)| self.place[v as usize] = k);
        let mut later: Vec<u32> = updates.iter().flat_map(|update| update.vertices.iter().copied()).collect();
        for &v in &vertices {
            later.extend(self.system.columns(v).iter().filter(|&&c| self.system.is_free(c)));
        }
        later.retain(|&v| !self.is_done[v as usize] && self.place[v as usize] == usize::MAX);
        later.sort_unstable();
        later.dedup();
        vertices.extend(later);
        vertices.iter().enumerate().for_each(|(k, &v)| self.place[v as usize] = k);

        let mut matrix = DMatrix::zeros(3 * vertices.len(), 3 * vertices.len());
        for (k, &v) in vertices[..count].iter().enumerate() {
            matrix.fixed_view_mut::<3, 3>(3 * k, 3 * k).fill_diagonal(self.inertia);
            for (c, block) in self.system.row(v) {
                // Columns that are done were in a front below.
                let row = self.place[c as usize];
                if row != usize::MAX && row >= k {
                    let mut sum = matrix.fixed_view_mut::<3, 3>(3 * row, 3 * k);
                    sum += block.transpose();
                }
            }
        }
        for update in updates {
            for (j, &b) in update.vertices.iter().enumerate() {
                for (i, &a) in update.vertices.iter().enumerate().skip(j) {
                    let block = update.matrix.fixed_view::<3, 3>(3 * i, 3 * j);
                    let [row, column] = [a, b].map(|v| self.place[v as usize]);
                    if row >= column {
                        let mut sum = matrix.fixed_view_mut::<3, 3>(3 * row, 3 * column);
                        sum += block;
                    } else {
                        let mut sum = matrix.fixed_view_mut::<3, 3>(3 * column, 3 * row);
                        sum += block.transpose();
                    }
                }
            }
        }
        factor_columns(&mut matrix, 3 * count)?;
        for &v in &vertices {
            self.place[v as usize] = usize::MAX;
        }
        vertices[..count].iter().for_each(|&v| self.is_done[v as usize] = true);
        let rest = matrix.nrows() - 3 * count;
        let update = Update {
            vertices: vertices[count..].to_vec(),
            matrix: matrix.view((3 * count, 3 * count), (rest, rest)).into_owned(),
        };
        let columns = matrix.columns(0, 3 * count).into_owned();
        self.fronts.push(Front { vertices, own: count, columns });
        Some(update)
    }
}

/// Replaces the first columns of the lower triangle by those of its factor, and the rest by what remains. The
/// diagonal blocks of the update are symmetric as a whole.
fn factor_columns(matrix: &mut DMatrix<f64>, count: usize) -> Option<()> {
    let size = matrix.nrows();
    let mut first = 0;
    while first < count {
        let width = PANEL.min(count - first);
        let (next, below) = (first + width, size - first - width);
        let diagonal = matrix.view((first, first), (width, width)).into_owned().cholesky()?.unpack();
        matrix.view_mut((first, first), (width, width)).copy_from(&diagonal);
        let mut inverse = DMatrix::identity(width, width);
        diagonal.solve_lower_triangular_mut(&mut inverse);
        let rows = matrix.view((next, first), (below, width)) * inverse.transpose();
        matrix.view_mut((next, first), (below, width)).copy_from(&rows);
        let transposed = rows.transpose();
        for column in (0..below).step_by(BLOCK) {
            let columns = BLOCK.min(below - column);
            matrix.view_mut((next + column, next + column), (below - column, columns)).gemm(
                -1.0,
                &rows.rows(column, below - column),
                &transposed.columns(column, columns),
                1.0,
            );
        }
        first = next;
    }
    Some(())
}

#[cfg(test)]
mod tests;
