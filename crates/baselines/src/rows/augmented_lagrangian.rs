//! The augmented Lagrangian of Tang et al. 2018 in place of the complementarity problem.

use super::incidence::{Incidence, MIN_SHARE};
use bowknot_twoway::geometry::Vector;
use bowknot_twoway::lcp::{DistanceLimit, LcpError, LcpProblem, LcpState, TangentVector};
use bowknot_twoway::{RowSolver, RowSystem};
use rayon::prelude::*;

/// The augmented Lagrangian with gradient descent (Tang et al. 2018, "I-Cloth"; paper, section 4.3.2, Fig. 15): nothing is
/// solved, constraints and gradients are evaluated only. For rows s(y) >= 0 and m = 1/w (Rockafellar 1973),
///
/// L(y, lambda) = 1/2 sum m |y - y'|^2 + 1/(2 rho) sum (max(0, lambda - rho s)^2 - lambda^2),
///
/// y is moved along -grad L, and from time to time lambda <- max(0, lambda - rho s).
///
/// The step is the largest that is certain to descend, a vertex each: 1/(m_v + rho h_v), where h bounds J^T J (a gradient
/// descent with a diagonal preconditioner; one step for all vertices would be that of the most crowded one). Ball rows
/// have the vector form of the same: f <- rho (z - projection of z onto the ball), z = y_a - y_b + f/rho. y starts at that
/// of the last two-way step, as the paper says below Eq. 9. Friction rows are left without force.
#[derive(Clone, Debug)]
pub struct AugmentedLagrangian {
    /// Gradient steps a backward step: 20 or 100 in the paper. Default 20.
    pub iterations: usize,
    /// Penalty rho, in units of the mean vertex mass [1]. Larger: constraints hold after fewer updates of the multipliers,
    /// each of which takes more gradient steps. Default 1.
    pub penalty: f64,
    /// Gradient steps between two updates of the multipliers. Default 1.
    pub gradient_steps: usize,
    incidence: Incidence,
    /// 1/(m_v + rho h_v); 0 for vertices that cannot move.
    steps: Vec<f64>,
    /// lambda - rho s, projected: of rows and of ball rows.
    trial: Vec<f64>,
    trial_forces: Vec<Vector>,
}

impl Default for AugmentedLagrangian {
    fn default() -> Self {
        Self {
            iterations: 20,
            penalty: 1.0,
            gradient_steps: 1,
            incidence: Incidence::default(),
            steps: Vec::new(),
            trial: Vec::new(),
            trial_forces: Vec::new(),
        }
    }
}

impl AugmentedLagrangian {
    /// So many gradient steps a backward step.
    pub fn new(iterations: usize) -> Self {
        Self { iterations, ..Self::default() }
    }

    /// Descends from `state.y`, which may be anywhere; `free` is y'. The multipliers are those of the last update.
    ///
    /// # Panics
    /// If a slice does not fit the system.
    pub fn descend(&mut self, system: &LcpProblem<'_>, free: &[Vector], state: &mut LcpState<'_>) {
        let (weights, penalty) = (system.weights(), self.penalty);
        self.incidence.fill(system);
        self.incidence.curvatures(system, &mut self.steps);
        self.steps.iter_mut().zip(weights).for_each(|(step, &w)| {
            *step = if w == 0.0 { 0.0 } else { 1.0 / (1.0 / w + penalty * *step) };
        });
        self.trial.clear();
        self.trial.resize(system.rows().rows.len(), 0.0);
        self.trial_forces.clear();
        self.trial_forces.resize(system.distance_limits().rows.len(), Vector::zeros());
        for iteration in 0..self.iterations {
            self.evaluate(system, state);
            if iteration > 0 && iteration % self.gradient_steps.max(1) == 0 {
                self.update_multipliers(state);
                self.evaluate(system, state);
            }
            let steps = &self.steps;
            let descend = |v: usize, y: &mut Vector, pull: Vector| {
                if weights[v] != 0.0 {
                    *y -= ((*y - free[v]) / weights[v] - pull) * steps[v];
                }
            };
            self.incidence.gather(system, &self.trial, &self.trial_forces, state.y, descend);
        }
        self.evaluate(system, state);
        self.update_multipliers(state);
    }

    /// max(0, lambda - rho s) at `state.y`.
    fn evaluate(&mut self, system: &LcpProblem<'_>, state: &LcpState<'_>) {
        let (y, penalty) = (&*state.y, self.penalty);
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
