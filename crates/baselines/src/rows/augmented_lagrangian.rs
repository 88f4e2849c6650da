//! The augmented Lagrangian of Tang et al. 2018 in place of the complementarity problem.

use super::incidence::{Incidence, MIN_SHARE};
use super::zone_descent::ZoneDescent;
use bowknot_errors::{Checks, Parameters};
use bowknot_twoway::geometry::Vector;
use bowknot_twoway::lcp::{DistanceLimit, LcpError, LcpProblem, LcpState, TangentVector};
use bowknot_twoway::{RowSolver, RowSystem};
use rayon::prelude::*;

/// The augmented Lagrangian with gradient descent (Tang et al. 2018, "I-Cloth"; paper, section 4.3.2, Fig.
/// 15). It only evaluates constraints and gradients and solves no system. For rows s(y) >= 0 and m = 1/w
/// (Rockafellar 1973),
///
/// L(y, lambda) = 1/2 sum m |y - y'|^2 + 1/(2 rho) sum (max(0, lambda - rho s)^2 - lambda^2),
///
/// y moves along -grad L, and after each step, or every few, lambda <- max(0, lambda - rho s). How long the
/// steps are says [`Descent`]. Distance limits have the vector form: f <- rho (z - projection of z onto the
/// ball), z = y_a - y_b + f/rho. y starts at that of the last two-way step, as the paper says below Eq. 9.
/// Friction rows get no force.
#[derive(Clone, Debug)]
pub struct AugmentedLagrangian {
    /// Gradient steps per backward step: 20 or 100 in the paper. Default 20.
    pub iterations: usize,
    /// How long gradient steps are. Default as published.
    pub descent: Descent,
    /// Penalty rho, in units of the mean vertex mass [1]. With a larger penalty, constraints hold after fewer
    /// updates of the multipliers, but each update needs more gradient steps. Default 1000, as published.
    pub penalty: f64,
    /// Gradient steps between two updates of the multipliers. Default 1.
    pub gradient_steps: usize,
    incidence: Incidence,
    /// 1/(m_v + rho h_v); 0 for vertices that cannot move.
    steps: Vec<f64>,
    zones: ZoneDescent,
    /// Multipliers that the next update takes, of rows and of distance limits.
    trial: Vec<f64>,
    trial_forces: Vec<Vector>,
}

/// How long the gradient steps of [`AugmentedLagrangian`] are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Descent {
    /// One length per zone, the vertices that rows connect, by a backtracking line search, with multipliers
    /// that start at 0: as published.
    Zones,
    /// One length per vertex, the largest that is certain to descend: 1/(m_v + rho h_v), where h bounds J^T J.
    /// It is meant for a penalty of about 1, and multipliers start at those of the last update. Its steps
    /// need no evaluations.
    Vertices,
}

impl Default for AugmentedLagrangian {
    fn default() -> Self {
        Self {
            iterations: 20,
            descent: Descent::Zones,
            penalty: 1000.0,
            gradient_steps: 1,
            incidence: Incidence::default(),
            steps: Vec::new(),
            zones: ZoneDescent::default(),
            trial: Vec::new(),
            trial_forces: Vec::new(),
        }
    }
}

impl Parameters for AugmentedLagrangian {
    fn check(&self, checks: &mut Checks) {
        checks.count_at_least("iterations", self.iterations, 1);
        checks.positive("penalty", self.penalty);
        checks.count_at_least("gradient_steps", self.gradient_steps, 1);
    }
}

impl AugmentedLagrangian {
    /// As published, with so many gradient steps per backward step.
    pub fn new(iterations: usize) -> Self {
        Self { iterations, ..Self::default() }
    }

    /// With a step length per vertex.
    pub fn by_vertices(iterations: usize) -> Self {
        Self { iterations, descent: Descent::Vertices, penalty: 1.0, ..Self::default() }
    }

    /// Descends from any `state.y`; `free` is y'.
    ///
    /// # Panics
    /// If a slice does not fit the system.
    pub fn descend(&mut self, system: &LcpProblem<'_>, free: &[Vector], state: &mut LcpState<'_>) {
        self.incidence.fill(system);
        self.trial.clear();
        self.trial.resize(system.rows().rows.len(), 0.0);
        self.trial_forces.clear();
        self.trial_forces.resize(system.distance_limits().rows.len(), Vector::zeros());
        match self.descent {
            Descent::Zones => self.descend_by_zones(system, free, state),
            Descent::Vertices => self.descend_by_vertices(system, free, state),
        }
    }

    fn descend_by_zones(&mut self, system: &LcpProblem<'_>, free: &[Vector], state: &mut LcpState<'_>) {
        state.lambda.fill(0.0);
        state.limit_multipliers.fill(Vector::zeros());
        self.zones.begin(system, free, state.y);
        for iteration in 1..=self.iterations {
            self.evaluate(system, state.y, state);
            let (incidence, trial, forces) = (&self.incidence, &self.trial, &self.trial_forces);
            self.zones.set_gradient(system, free, state.y, |values, each| {
                incidence.gather(system, trial, forces, values, each);
            });
            let before = self.value(system, free, state.y);
            self.zones.begin_search(before);
            while self.zones.shorten(state.y) {
                let y = std::mem::take(&mut self.zones.y);
                self.evaluate(system, &y, state);
                let after = self.value(system, free, &y);
                self.zones.y = y;
                self.zones.judge(after);
            }
            if self.zones.take_step(state.y) == 0 {
                break;
            }
            if iteration % self.gradient_steps.max(1) == 0 {
                self.evaluate(system, state.y, state);
                self.update_multipliers(state);
            }
        }
    }

    /// L of each zone at `y`, but for a constant, given the multipliers evaluated there.
    fn value(&self, system: &LcpProblem<'_>, free: &[Vector], y: &[Vector]) -> Vec<f64> {
        let scale = 0.5 / self.penalty;
        let mut values = self.zones.inertia(system, free, y);
        for (row, trial) in system.rows().rows.iter().zip(&self.trial) {
            self.zones.add(&mut values, &row.vertices, scale * trial * trial);
        }
        for (ball, force) in system.distance_limits().rows.iter().zip(&self.trial_forces) {
            self.zones.add(&mut values, &ball.vertices, scale * force.norm_squared());
        }
        values
    }

    fn descend_by_vertices(&mut self, system: &LcpProblem<'_>, free: &[Vector], state: &mut LcpState<'_>) {
        let (weights, penalty) = (system.weights(), self.penalty);
        self.incidence.curvatures(system, &mut self.steps);
        self.steps.iter_mut().zip(weights).for_each(|(step, &w)| {
            *step = if w == 0.0 { 0.0 } else { 1.0 / (1.0 / w + penalty * *step) };
        });
        for iteration in 0..self.iterations {
            self.evaluate(system, state.y, state);
            if iteration > 0 && iteration % self.gradient_steps.max(1) == 0 {
                self.update_multipliers(state);
                self.evaluate(system, state.y, state);
            }
            let steps = &self.steps;
            let descend = |v: usize, y: &mut Vector, pull: Vector| {
                if weights[v] != 0.0 {
                    *y -= ((*y - free[v]) / weights[v] - pull) * steps[v];
                }
            };
            self.incidence.gather(system, &self.trial, &self.trial_forces, state.y, descend);
        }
        self.evaluate(system, state.y, state);
        self.update_multipliers(state);
    }

    /// max(0, lambda - rho s) at `y`.
    fn evaluate(&mut self, system: &LcpProblem<'_>, y: &[Vector], state: &LcpState<'_>) {
        let penalty = self.penalty;
        let rows = system.rows().rows;
        self.trial.par_iter_mut().zip(rows).zip(&*state.lambda).with_min_len(MIN_SHARE).for_each(
            |((trial, row), &lambda)| {
                let new = (lambda - penalty * row.value(y)).max(0.0).min(row.upper);
                *trial = if row.inverse_diagonal == 0.0 { 0.0 } else { new };
            },
        );
        let balls = system.distance_limits().rows;
        self.trial_forces
            .par_iter_mut()
            .zip(balls)
            .zip(&*state.limit_multipliers)
            .with_min_len(MIN_SHARE)
            .for_each(|((trial, ball), &force)| *trial = ball_force(ball, y, force, penalty));
    }

    fn update_multipliers(&self, state: &mut LcpState<'_>) {
        state.lambda.copy_from_slice(&self.trial);
        state.limit_multipliers.copy_from_slice(&self.trial_forces);
    }
}

/// rho (z - projection of z onto the ball), z = y_a - y_b + f/rho.
fn ball_force(ball: &DistanceLimit, y: &[Vector], force: Vector, penalty: f64) -> Vector {
    let [a, b] = ball.vertices.map(|v| v as usize);
    let z = y[a] - y[b] + force / penalty;
    let norm = z.norm();
    if norm > ball.limit { z * (penalty * (1.0 - ball.limit / norm)) } else { Vector::zeros() }
}

impl RowSolver for AugmentedLagrangian {
    fn solve(&mut self, rows: &RowSystem<'_>, state: &mut LcpState<'_>) -> Result<(), LcpError> {
        let weights = rows.system.weights();
        for (v, (y, last)) in state.y.iter_mut().zip(&rows.state.y).enumerate() {
            *y = if weights[v] == 0.0 { rows.free[v] } else { last.coords };
        }
        state.friction.fill(TangentVector::zeros());
        self.descend(&rows.system, rows.free, state);
        Ok(())
    }
}
