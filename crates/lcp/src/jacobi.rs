//! Projected Jacobi: all rows at once from the same positions. It needs no colors.
//!
//! If every row is solved by itself and the moves are added up, rows that share nodes overshoot without
//! bound. So each row takes its nodes to be lighter by the number n_v of rows that share them ("mass
//! splitting", Tonge, Benevolenski and Voroshilov 2012): its diagonal is D_r = sum over nodes of n_v
//! w_v |g_rv|^2. By Cauchy-Schwarz, for any multipliers x,
//!
//! ```text
//! x^T A x = sum_v w_v |sum_r g_rv x_r|^2 <= sum_v w_v n_v sum_r |g_rv|^2 |x_r|^2 = x^T D x,
//! ```
//!
//! so D - A is positive semi-definite and the step is a proximal gradient step in the metric D: the dual
//! decreases for relaxations in (0, 2), for rows and distance limits alike. (None of the solvers has such a
//! proof for friction, whose bound depends on the normal multiplier.) Moves are gathered by node, in the
//! order of the rows, so results do not depend on the number of threads.

use crate::error::LcpError;
use crate::info::LcpInfo;
use crate::kernels::{equation_multiplier, friction_multiplier, limit_multiplier, row_multiplier};
use crate::params::LcpParams;
use crate::problem::LcpProblem;
use crate::rows::{Constraint, invert};
use crate::schedule::ConstraintSet;
use crate::state::LcpState;
use crate::vector::{TangentVector, Vector};
use bowknot_errors::Parameters;
use rayon::prelude::*;

/// Fewest rows or nodes that a thread takes.
const MIN_SHARE: usize = 1024;

/// The projected Jacobi solver. It holds scratch memory only and may be dropped at any time.
#[derive(Clone, Debug, Default)]
pub struct Jacobi {
    /// Where the places of each node start in `places`, and the end.
    starts: Vec<u32>,
    /// The places at which each node that can move is named: 4r + k in rows, 2b + k in distance limits (after
    /// all rows), 4f + k in friction rows (after all distance limits).
    places: Vec<u32>,
    rows: Scratch<f64>,
    limits: Scratch<Vector>,
    friction: Scratch<TangentVector>,
}

#[derive(Clone, Debug)]
struct Scratch<T> {
    /// 1 / D_r of each row; 0 for those that are not swept or cannot move.
    inverse: Vec<f64>,
    /// Change of each multiplier in this sweep.
    change: Vec<T>,
    /// Multipliers before the last sweep; only the Chebyshev acceleration needs them.
    previous: Vec<T>,
}

impl<T> Default for Scratch<T> {
    fn default() -> Self {
        Self { inverse: Vec::new(), change: Vec::new(), previous: Vec::new() }
    }
}

impl Jacobi {
    /// A solver with empty scratch memory.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sweeps on the threads of the current rayon pool, with the same bits for any number of them.
    /// [`LcpParams::relaxation`] and [`LcpParams::spectral_radius`] apply.
    ///
    /// # Errors
    /// As [`crate::solve_serial`].
    pub fn solve(
        &mut self,
        problem: &LcpProblem<'_>,
        state: &mut LcpState<'_>,
        params: &LcpParams,
    ) -> Result<LcpInfo, LcpError> {
        params.validate()?;
        state.check(problem)?;
        self.prepare(problem);
        self.rows.previous.copy_from_slice(state.lambda);
        self.limits.previous.copy_from_slice(state.limit_multipliers);
        self.friction.previous.copy_from_slice(state.friction);
        let mut residual = 0.0;
        let mut omega = 1.0;
        let square = params.spectral_radius * params.spectral_radius;
        for sweep in 1..=params.max_sweeps {
            residual = self.sweep(problem, state, params, omega);
            if params.tolerance.is_some_and(|tolerance| residual <= tolerance) {
                return Ok(LcpInfo { sweeps: sweep, residual });
            }
            // Golub and Varga (1961): the weights of the Chebyshev semi-iterative method.
            omega = if sweep == 1 { 2.0 / (2.0 - square) } else { 4.0 / (4.0 - square * omega) };
        }
        match params.tolerance {
            None => Ok(LcpInfo { sweeps: params.max_sweeps, residual }),
            Some(_) => Err(LcpError::NotConverged { sweeps: params.max_sweeps, residual }),
        }
    }

    /// Counts the constraints at each node, lists its places and computes the split diagonals.
    fn prepare(&mut self, problem: &LcpProblem<'_>) {
        let weights = problem.weights();
        let (rows, limits, friction) = (problem.rows(), problem.distance_limits(), problem.friction());
        self.rows.reset(rows.rows.len(), 0.0);
        self.limits.reset(limits.rows.len(), Vector::zeros());
        self.friction.reset(friction.rows.len(), TangentVector::zeros());

        let mut shares = vec![0_u32; weights.len()];
        self.starts.clear();
        self.starts.resize(weights.len() + 1, 0);
        let mut count = |node: u32, first: bool| {
            if weights[node as usize] != 0.0 {
                self.starts[node as usize + 1] += 1;
                shares[node as usize] += u32::from(first);
            }
        };
        for_places(rows, |_, _, node, first| count(node, first));
        for_places(limits, |_, _, node, first| count(node, first));
        for_places(friction, |_, _, node, first| count(node, first));

        for node in 0..weights.len() {
            self.starts[node + 1] += self.starts[node];
        }
        self.places.clear();
        self.places.resize(self.starts[weights.len()] as usize, 0);
        let mut next = self.starts.clone();
        let mut list = |place: usize, node: u32| {
            if weights[node as usize] != 0.0 {
                let slot = &mut next[node as usize];
                self.places[*slot as usize] = place as u32;
                *slot += 1;
            }
        };
        let after_rows = 4 * rows.rows.len();
        let after_limits = after_rows + 2 * limits.rows.len();
        for_places(rows, |r, k, node, _| list(4 * r + k, node));
        for_places(limits, |b, k, node, _| list(after_rows + 2 * b + k, node));
        for_places(friction, |f, k, node, _| list(after_limits + 4 * f + k, node));

        // Rows that are not swept keep 0.
        let split = |node: u32| weights[node as usize] * f64::from(shares[node as usize]);
        for_swept(rows, |r| self.rows.inverse[r] = invert(rows.rows[r].diagonal(split)));
        for_swept(limits, |b| {
            let [a, c] = limits.rows[b].vertices;
            self.limits.inverse[b] = if a == c { 0.0 } else { invert(split(a) + split(c)) };
        });
        for_swept(friction, |f| self.friction.inverse[f] = invert(friction.rows[f].diagonal(split)));
    }

    /// One sweep; `omega` is the Chebyshev weight, 1 for a plain one.
    fn sweep(
        &mut self,
        problem: &LcpProblem<'_>,
        state: &mut LcpState<'_>,
        params: &LcpParams,
        omega: f64,
    ) -> f64 {
        let relaxation = params.relaxation;
        let y = &*state.y;
        let rows = problem.rows().rows;
        let propose = |r: usize, old: f64, previous: f64, inverse: f64| {
            let (value, step) = (rows[r].value(y), relaxation * inverse);
            if params.equations {
                let new = equation_multiplier(value, old, step);
                return if omega == 1.0 { new } else { previous + omega * (new - previous) };
            }
            let new = row_multiplier(&rows[r], value, old, step);
            if omega == 1.0 { new } else { (previous + omega * (new - previous)).max(0.0).min(rows[r].upper) }
        };
        let of_rows = self.rows.update(state.lambda, propose, f64::abs);

        let limits = problem.distance_limits().rows;
        let propose = |b: usize, old: Vector, previous: Vector, inverse: f64| {
            let [a, c] = limits[b].vertices.map(|v| y[v as usize]);
            let new = old + relaxation * (limit_multiplier(&limits[b], a - c, old, 1.0 / inverse) - old);
            if omega == 1.0 { new } else { previous + omega * (new - previous) }
        };
        let of_limits = self.limits.update(state.limit_multipliers, propose, |c| c.norm());

        let (friction, lambda, bound) = (problem.friction().rows, &*state.lambda, params.friction_bound);
        let propose = |f: usize, old: TangentVector, previous: TangentVector, inverse: f64| {
            let row = &friction[f];
            let normal = lambda[row.normal as usize];
            let new = friction_multiplier(row, row.point(y), old, normal, relaxation * inverse, bound);
            if omega == 1.0 {
                new
            } else {
                bound.project(previous + omega * (new - previous), (row.friction * normal).max(0.0))
            }
        };
        let of_friction = self.friction.update(state.friction, propose, |c| c.norm());

        self.gather(problem, state.y);
        of_rows.max(of_limits).max(of_friction)
    }

    /// y += W J^T change.
    fn gather(&self, problem: &LcpProblem<'_>, y: &mut [Vector]) {
        let (rows, limits, friction) =
            (problem.rows().rows, problem.distance_limits().rows, problem.friction().rows);
        let after_rows = 4 * rows.len();
        let after_limits = after_rows + 2 * limits.len();
        y.par_iter_mut().with_min_len(MIN_SHARE).enumerate().for_each(|(node, y)| {
            let mut force = Vector::zeros();
            for &place in &self.places[self.starts[node] as usize..self.starts[node + 1] as usize] {
                let place = place as usize;
                if place < after_rows {
                    let (r, k) = (place / 4, place % 4);
                    force += rows[r].gradients[k] * self.rows.change[r];
                } else if place < after_limits {
                    let (b, k) = ((place - after_rows) / 2, (place - after_rows) % 2);
                    if k == 0 { force -= self.limits.change[b] } else { force += self.limits.change[b] }
                } else {
                    let (f, k) = ((place - after_limits) / 4, (place - after_limits) % 4);
                    force += friction[f].direction(self.friction.change[f]) * friction[f].coefficients[k];
                }
            }
            *y += force * problem.weights()[node];
        });
    }
}

impl<T: Copy + Send + Sync + std::ops::Sub<Output = T>> Scratch<T> {
    fn reset(&mut self, count: usize, zero: T) {
        self.inverse.clear();
        self.inverse.resize(count, 0.0);
        self.change.clear();
        self.change.resize(count, zero);
        self.previous.clear();
        self.previous.resize(count, zero);
    }

    /// Replaces each multiplier by `propose(row, multiplier, multiplier before the last sweep, inverse)`;
    /// returns the largest correction of a row value.
    fn update(
        &mut self,
        multipliers: &mut [T],
        propose: impl Fn(usize, T, T, f64) -> T + Sync,
        size: impl Fn(T) -> f64 + Sync,
    ) -> f64 {
        multipliers
            .par_iter_mut()
            .zip(&mut self.change)
            .zip(&mut self.previous)
            .zip(&self.inverse)
            .enumerate()
            .with_min_len(MIN_SHARE)
            .map(|(row, (((multiplier, change), previous), &inverse))| {
                if inverse == 0.0 {
                    return 0.0;
                }
                let old = *multiplier;
                *multiplier = propose(row, old, *previous, inverse);
                *previous = old;
                *change = *multiplier - old;
                size(*change) / inverse
            })
            .reduce(|| 0.0, f64::max)
    }
}

/// Calls `visit(row)` for each row that is swept.
fn for_swept<T: Copy>(set: ConstraintSet<'_, T>, visit: impl FnMut(usize)) {
    (0..set.swept()).map(|place| set.schedule.row(place)).for_each(visit);
}

/// Calls `visit(row, place, node, whether the row has no earlier place with this node)`.
fn for_places<T: Constraint>(set: ConstraintSet<'_, T>, mut visit: impl FnMut(usize, usize, u32, bool)) {
    for_swept(set, |row| {
        let nodes = set.rows[row].nodes();
        for (k, node) in nodes.iter().enumerate() {
            visit(row, k, *node, !nodes[..k].contains(node));
        }
    });
}
