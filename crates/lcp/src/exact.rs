//! An exact solver for small problems: the reference for tests of the iterative solvers.
//!
//! With the multipliers of distance limits and friction fixed, the rows' multipliers minimize the convex
//! quadratic lambda^T A lambda / 2 + q^T lambda over the box 0 <= lambda <= upper. Here A = J W J^T is the
//! Delassus matrix and q the row values at lambda = 0; the gradient A lambda + q is s. This is a primal
//! active-set method in the manner of Lawson and Hanson (1974, ch. 23), with upper bounds as in Stark and
//! Parker (1995), on given normal equations. They assume independent columns, but here redundant rows are
//! common: a vertex on a flat patch touches six triangles. So the set of free multipliers is kept
//! independent. A row that depends on this set enters along the direction that does not change J^T lambda and
//! has no curvature, until another multiplier reaches a bound and leaves the set. If none does, the rows
//! contradict each other (Farkas).

use crate::error::LcpError;
use crate::info::LcpInfo;
use crate::problem::LcpProblem;
use crate::rows::Row;
use crate::state::LcpState;
use nalgebra::DMatrix;

/// A pivot, which is what is left of a diagonal entry after eliminating the free rows, counts as rounding
/// below this share of the entry. With some hundred rows rounding is about 1e-13 of it.
const DEPENDENT: f64 = 1e-12;
/// Rounding of a row value, relative to the sum of the magnitudes of its terms.
const ROUNDING: f64 = 1e-13;

/// The Delassus matrix A = J W J^T of the rows, n x n for n rows; symmetric, positive semi-definite.
pub fn delassus(problem: &LcpProblem<'_>) -> DMatrix<f64> {
    let (rows, weights) = (problem.rows().rows, problem.weights());
    let entry = |a: &Row, b: &Row| {
        let mut sum = 0.0;
        for j in 0..4 {
            for k in 0..4 {
                if a.vertices[j] == b.vertices[k] {
                    sum += weights[a.vertices[j] as usize] * a.gradients[j].dot(&b.gradients[k]);
                }
            }
        }
        sum
    };
    DMatrix::from_fn(rows.len(), rows.len(), |i, j| entry(&rows[i], &rows[j]))
}

/// Solves the rows (all, whatever their schedule) to rounding, with the multipliers of distance limits and
/// friction fixed. For up to a few hundred rows: memory n^2, time about n^4 at worst.
///
/// # Errors
/// [`LcpError::Length`] if the state does not fit the problem; otherwise as [`solve_dense`], with the state
/// untouched.
pub fn solve_exact(problem: &LcpProblem<'_>, state: &mut LcpState<'_>) -> Result<LcpInfo, LcpError> {
    state.check(problem)?;
    let (rows, weights) = (problem.rows().rows, problem.weights());
    let matrix = delassus(problem);
    // s = A lambda + q
    let mut values: Vec<f64> = rows.iter().map(|row| row.value(state.y)).collect();
    for (i, value) in values.iter_mut().enumerate() {
        *value -= (0..rows.len()).map(|j| matrix[(i, j)] * state.lambda[j]).sum::<f64>();
    }
    let upper: Vec<f64> = rows.iter().map(|row| row.upper).collect();
    let (lambda, info) = solve_dense(&matrix, &values, &upper)?;
    for (i, row) in rows.iter().enumerate() {
        let change = lambda[i] - state.lambda[i];
        if change != 0.0 && row.inverse_diagonal != 0.0 {
            state.lambda[i] = lambda[i];
            for (&node, gradient) in row.vertices.iter().zip(&row.gradients) {
                state.y[node as usize] += gradient * (weights[node as usize] * change);
            }
        }
    }
    Ok(info)
}

/// Solves 0 <= lambda <= upper, s = A lambda + q: s >= 0 where lambda = 0, s = 0 between the bounds, s <= 0
/// where lambda = upper. A is n x n, symmetric and positive semi-definite; rows with a zero diagonal are left
/// out (lambda = 0). `LcpInfo::sweeps` counts steps, `LcpInfo::residual` is the largest
/// |lambda - clamp(lambda - s, 0, upper)|.
///
/// # Errors
/// [`LcpError::Length`]; [`LcpError::NotFinite`]; [`LcpError::Infeasible`] if no finite lambda solves it;
/// [`LcpError::NotConverged`] if rounding makes the method cycle.
pub fn solve_dense(matrix: &DMatrix<f64>, q: &[f64], upper: &[f64]) -> Result<(Vec<f64>, LcpInfo), LcpError> {
    let n = q.len();
    for (what, given) in [
        ("the matrix's rows", matrix.nrows()),
        ("the matrix's columns", matrix.ncols()),
        ("upper", upper.len()),
    ] {
        if given != n {
            return Err(LcpError::Length { what, given, expected: n });
        }
    }
    for i in 0..n {
        if !q[i].is_finite() || upper[i].is_nan() || matrix.row(i).iter().any(|a| !a.is_finite()) {
            return Err(LcpError::NotFinite { what: "row", index: i });
        }
    }
    let upper = upper.iter().map(|u| u.max(0.0)).collect();
    let mut solver = ActiveSet {
        matrix,
        q,
        upper,
        lambda: vec![0.0; n],
        free: Factor::default(),
        within_rounding: vec![false; n],
    };
    let limit = 100 + 50 * n as u32;
    // How many rows entered in succession without any multiplier changing.
    let mut stalled = 0;
    for sweeps in 0..limit {
        let values = solver.values();
        // After many steps without a change the lowest index, rather than the worst row: this rule cannot
        // cycle (Bland).
        let Some(entering) = solver.violated(&values, stalled > 2 * n) else {
            let residual = (0..n)
                .filter(|&i| matrix[(i, i)] > 0.0)
                .map(|i| {
                    (solver.lambda[i] - (solver.lambda[i] - values[i]).max(0.0).min(solver.upper[i])).abs()
                })
                .fold(0.0, f64::max);
            return Ok((solver.lambda, LcpInfo { sweeps, residual }));
        };
        let before = solver.lambda.clone();
        if !solver.enter(entering, &values)? {
            solver.within_rounding[entering] = true;
            continue;
        }
        solver.minimize();
        if solver.lambda == before {
            stalled += 1;
        } else {
            stalled = 0;
            solver.within_rounding.fill(false);
        }
    }
    let values = solver.values();
    let residual = (0..n).map(|i| -values[i]).fold(0.0, f64::max);
    Err(LcpError::NotConverged { sweeps: limit, residual })
}

struct ActiveSet<'a> {
    matrix: &'a DMatrix<f64>,
    q: &'a [f64],
    upper: Vec<f64>,
    lambda: Vec<f64>,
    /// The multipliers that may lie between their bounds; the others are at one.
    free: Factor,
    /// Rows at a bound whose value has the wrong sign only by the rounding of the rows that they depend on.
    within_rounding: Vec<bool>,
}

impl ActiveSet<'_> {
    /// s = A lambda + q.
    fn values(&self) -> Vec<f64> {
        (0..self.q.len()).map(|i| self.terms(i).sum()).collect()
    }

    fn terms(&self, i: usize) -> impl Iterator<Item = f64> + '_ {
        let products = self.lambda.iter().enumerate().map(move |(j, l)| self.matrix[(i, j)] * l);
        std::iter::once(self.q[i]).chain(products)
    }

    fn rounding(&self, i: usize) -> f64 {
        ROUNDING * self.terms(i).map(f64::abs).sum::<f64>()
    }

    /// The row at a bound whose value has the wrong sign there by the most, or the first such.
    fn violated(&self, values: &[f64], first: bool) -> Option<usize> {
        let mut found = None;
        let mut worst = 0.0;
        for (i, &value) in values.iter().enumerate() {
            let diagonal = self.matrix[(i, i)];
            if diagonal <= 0.0 || self.within_rounding[i] || self.free.members.contains(&i) {
                continue;
            }
            let wrong = if self.lambda[i] > 0.0 { value } else { -value };
            let movable = self.upper[i] > 0.0;
            let rounding = self.rounding(i);
            // The gain of solving this row alone is wrong^2 / diagonal / 2.
            if movable && wrong > rounding && wrong / diagonal.sqrt() > worst {
                found = Some(i);
                if first {
                    return found;
                }
                worst = wrong / diagonal.sqrt();
            }
        }
        found
    }

    /// Frees a row at a bound. Returns false and does nothing if the row's value is wrong only by rounding.
    fn enter(&mut self, row: usize, values: &[f64]) -> Result<bool, LcpError> {
        let rising = values[row] < 0.0;
        let (line, pivot) = self.free.eliminate(self.matrix, row);
        if pivot > DEPENDENT * self.matrix[(row, row)] {
            self.free.push(row, line, pivot);
            return Ok(true);
        }
        // A change of the row's multiplier that the free multipliers balance: J^T lambda stays.
        let sign = if rising { 1.0 } else { -1.0 };
        let mut direction = self.free.back_substitute(line);
        direction.iter_mut().for_each(|d| *d *= -sign);
        // The slope along it: s of the entering row, plus what the remaining values of the free rows add.
        let (mut slope, mut rounding) = (sign * values[row], self.rounding(row));
        for (&member, d) in self.free.members.iter().zip(&direction) {
            slope += d * values[member];
            rounding += d.abs() * self.rounding(member);
        }
        if slope >= -rounding {
            return Ok(false);
        }
        let mut step = if rising { self.upper[row] - self.lambda[row] } else { self.lambda[row] };
        let mut blocking = None;
        for (place, &member) in self.free.members.iter().enumerate() {
            let member_step = self.max_step(member, direction[place]);
            if member_step < step {
                (step, blocking) = (member_step, Some(place));
            }
        }
        if step == f64::INFINITY {
            return Err(LcpError::Infeasible { row });
        }
        for (place, &member) in self.free.members.iter().enumerate() {
            self.lambda[member] =
                (self.lambda[member] + step * direction[place]).clamp(0.0, self.upper[member]);
        }
        let Some(place) = blocking else {
            self.lambda[row] = if rising { self.upper[row] } else { 0.0 };
            return Ok(true);
        };
        self.lambda[row] += sign * step;
        self.leave(place, direction[place] > 0.0);
        let (line, pivot) = self.free.eliminate(self.matrix, row);
        // It replaces a row that it depended on, so it is independent now; the lower bound only guards the
        // square root against rounding.
        self.free.push(row, line, pivot.max(DEPENDENT * self.matrix[(row, row)]));
        Ok(true)
    }

    /// The largest step along `direction` that keeps a multiplier within its bounds.
    fn max_step(&self, row: usize, direction: f64) -> f64 {
        if direction < 0.0 {
            self.lambda[row] / -direction
        } else if direction > 0.0 {
            (self.upper[row] - self.lambda[row]) / direction
        } else {
            f64::INFINITY
        }
    }

    /// Moves a free multiplier to a bound; it is no longer free.
    fn leave(&mut self, place: usize, at_upper: bool) {
        let member = self.free.members[place];
        self.lambda[member] = if at_upper { self.upper[member] } else { 0.0 };
        self.free.remove(self.matrix, place);
    }

    /// Minimizes over the free multipliers; those that reach a bound leave the free set.
    fn minimize(&mut self) {
        // Each blocked step removes a member. Two full steps end the loop; the second refines the first.
        let mut full = 0;
        while full < 2 && !self.free.members.is_empty() {
            let downhill: Vec<f64> = self.free.members.iter().map(|&i| -self.terms(i).sum::<f64>()).collect();
            let direction = self.free.solve(downhill);
            let mut step = 1.0;
            let mut blocking = None;
            for (place, &member) in self.free.members.iter().enumerate() {
                let member_step = self.max_step(member, direction[place]);
                if member_step < step {
                    (step, blocking) = (member_step, Some(place));
                }
            }
            for (place, &member) in self.free.members.iter().enumerate() {
                let moved = self.lambda[member] + step * direction[place];
                self.lambda[member] = moved.clamp(0.0, self.upper[member]);
            }
            match blocking {
                Some(place) => self.leave(place, direction[place] > 0.0),
                None => full += 1,
            }
        }
    }
}

/// Cholesky factor of the block of the free rows, extended row by row: A_FF = L L^T.
#[derive(Default)]
struct Factor {
    members: Vec<usize>,
    /// Row k of L, k + 1 entries.
    lines: Vec<Vec<f64>>,
}

impl Factor {
    /// The line of L that `row` would get, without its diagonal, and the pivot: the square of that diagonal.
    fn eliminate(&self, matrix: &DMatrix<f64>, row: usize) -> (Vec<f64>, f64) {
        let mut line: Vec<f64> = self.members.iter().map(|&member| matrix[(row, member)]).collect();
        self.forward_substitute(&mut line);
        let pivot = matrix[(row, row)] - line.iter().map(|l| l * l).sum::<f64>();
        (line, pivot)
    }

    fn push(&mut self, row: usize, mut line: Vec<f64>, pivot: f64) {
        line.push(pivot.sqrt());
        self.members.push(row);
        self.lines.push(line);
    }

    fn remove(&mut self, matrix: &DMatrix<f64>, place: usize) {
        let later = self.members.split_off(place);
        self.lines.truncate(place);
        for &row in &later[1..] {
            let (line, pivot) = self.eliminate(matrix, row);
            self.push(row, line, pivot.max(DEPENDENT * matrix[(row, row)]));
        }
    }

    /// x <- L^-1 x.
    fn forward_substitute(&self, x: &mut [f64]) {
        for (i, line) in self.lines.iter().enumerate() {
            let sum: f64 = (0..i).map(|j| line[j] * x[j]).sum();
            x[i] = (x[i] - sum) / line[i];
        }
    }

    /// L^-T x.
    fn back_substitute(&self, mut x: Vec<f64>) -> Vec<f64> {
        for i in (0..x.len()).rev() {
            x[i] /= self.lines[i][i];
            for j in 0..i {
                x[j] -= self.lines[i][j] * x[i];
            }
        }
        x
    }

    /// A_FF^-1 x.
    fn solve(&self, mut x: Vec<f64>) -> Vec<f64> {
        self.forward_substitute(&mut x);
        self.back_substitute(x)
    }
}
