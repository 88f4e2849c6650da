//! The default backward stage: the inexact LCP (paper, Eq. 9-13) with a proximal term.
//!
//! Linearised at x, the problem is min 1/2 sum m^ |y - y0|^2 + 1/2 sum mu |y - x|^2 subject to the rows. The
//! proximal term mu keeps a curvature that linearising anew drops (`proximal.rs`). Without it y wanders for ever in hard
//! contact; at y = x it vanishes, so the fixed point is unchanged. With w = 1/(m^ + mu):
//!
//! y = y' + W J^T lambda,   y' = w (m^ y0 + mu x).

use crate::coarse::is_sliding;
use crate::proximal;
use crate::row_solver::{ColouredSweeps, RowSolver, RowSystem};
use crate::{BackwardStep, Problem, State, Statistics};
use bowknot_constraints::{ContactRows, EdgeForm, EdgeLimits, predicted_gap};
use bowknot_geometry::{PairKind, Vector};
use bowknot_lcp::{self as lcp, ConstraintSet, Schedule, TangentVector};

/// Sine of the angle by which the normals of rows may leave their cones. Rows are made anew in each step: a wide cone keeps them
/// from coming and going.
const CONE_TOLERANCE: f64 = 0.02;

/// Distance below which a pair has a row whatever its normal, in its desired distance: what is pressed is held from all sides.
const NEAR: f64 = 1.001;

/// Share of its distance that such a pair keeps if it is no contact. Asked for its desired distance it would be a wall ahead of
/// what slides on a mesh, and push from behind; not asked for anything, it stops the forward step where the target has
/// not seen it. Grains on an irregular mesh gain 17 % of their speed in a second with the former; with a share of a half and no least, `funnel`
/// at scale 0.2 reaches the limit of steps.
const GUARDED: f64 = 0.9;

/// Share of its desired distance that it keeps in any case: at the gap floor the forward step closes no pair further, whatever
/// its row allows. Without it, two of three variants of `funnel` reached the limit of steps.
const LEAST_GUARDED: f64 = 0.5;

/// The default [`BackwardStep`]. Its rows are solved by `K`, projected Gauss-Seidel by default.
#[derive(Debug, Default)]
pub struct LcpBackward<K = ColouredSweeps> {
    solver: K,
    edges: EdgeLimits,
    /// Distances that the rows ask for, by pair, and which pairs have one.
    wanted: Vec<f64>,
    kept: Vec<bool>,
    /// Which vertices, and which stretch limits of bodies, `edges` was made for.
    movable: Vec<bool>,
    stretch_limits: Vec<f64>,
    /// Vector multipliers of the edges (ball form).
    forces: Vec<Vector>,
    /// Scalar multipliers of the edges (linear form).
    edge_multipliers: Vec<f64>,
    /// Contact rows, and in the linear form the edges' rows behind them.
    contacts: ContactRows,
    row_starts: Vec<u32>,
    lambda: Vec<f64>,
    /// Multipliers of the friction rows along their tangents.
    friction: Vec<TangentVector>,
    proximal: Vec<f64>,
    /// What the proximal term is multiplied by where y swings about x.
    caution: proximal::Caution,
    weights: Vec<f64>,
    /// y' [m].
    free: Vec<Vector>,
    /// y [m].
    y: Vec<Vector>,
    /// Residual and mass of each body.
    body_residuals: Vec<(Vector, f64)>,
}

impl<K: RowSolver> BackwardStep for LcpBackward<K> {
    fn begin(&mut self, problem: &Problem, state: &State) {
        let limits: Vec<f64> =
            (0..problem.model.bodies().len() as u32).map(|body| problem.stretch_limit(body)).collect();
        let changed = self.stretch_limits != limits
            || self.movable.len() != problem.prescribed.len()
            || self
                .movable
                .iter()
                .zip(&problem.prescribed)
                .any(|(movable, prescribed)| movable == prescribed);
        if changed {
            self.movable = problem.prescribed.iter().map(|p| !p).collect();
            let constraints = &problem.params.constraints;
            self.edges = if constraints.edges {
                let limit = |edge: &[u32; 2]| limits[problem.model.vertex_body()[edge[0] as usize] as usize];
                EdgeLimits::new(problem.model.topology(), &problem.rest, &self.movable, limit)
            } else {
                EdgeLimits::default()
            };
            self.stretch_limits = limits;
        }
        let constraints = &problem.params.constraints;
        self.edges.begin(&state.x, constraints.edge_reference);
        self.forces.clear();
        self.forces.resize(self.edges.balls.len(), Vector::zeros());
        self.edge_multipliers.clear();
        self.edge_multipliers.resize(self.edges.balls.len(), 0.0);
        self.caution.begin(problem);
        self.solver.begin();
    }

    fn project(&mut self, problem: &Problem, state: &mut State, statistics: &mut Statistics) {
        self.set_weights(problem, state);
        self.fill_rows(problem, state, statistics);
        self.solve(problem, state, statistics);
        self.store(problem, state);
        self.caution.learn(problem, state);
    }

    fn stretch_to_limit(&self, state: &State) -> f64 {
        self.edges.stretch(&state.x).to_limit
    }

    fn unrest(&mut self, problem: &Problem, state: &State) -> f64 {
        let mut bodies = vec![(0.0, 0.0); problem.model.bodies().len()];
        for v in (0..self.y.len()).filter(|&v| problem.movable(v)) {
            let mass = problem.relative_mass[v];
            let (sum, total) = &mut bodies[problem.model.vertex_body()[v] as usize];
            *sum += mass * self.residual(problem, state, v).norm();
            *total += mass;
        }
        bodies.iter().filter(|(_, mass)| *mass > 0.0).map(|(sum, mass)| sum / mass).fold(0.0, f64::max)
    }

    fn imbalance(&mut self, problem: &Problem, state: &State) -> f64 {
        self.body_residuals.clear();
        self.body_residuals.resize(problem.model.bodies().len(), (Vector::zeros(), 0.0));
        for v in (0..self.y.len()).filter(|&v| problem.movable(v)) {
            let mass = problem.relative_mass[v];
            let residual = self.residual(problem, state, v);
            let (sum, total) = &mut self.body_residuals[problem.model.vertex_body()[v] as usize];
            *sum += mass * residual;
            *total += mass;
        }
        self.body_residuals
            .iter()
            .filter(|(_, mass)| *mass > 0.0)
            .map(|(r, mass)| r.norm() / mass)
            .fold(0.0, f64::max)
    }

    fn finish(&mut self, problem: &Problem, state: &State, statistics: &mut Statistics) {
        statistics.imbalance_m = self.imbalance(problem, state);
        let stretch = self.edges.stretch(&state.x);
        statistics.max_step_stretch = stretch.to_start;
        statistics.max_stretch = stretch.to_rest;
        statistics.edge_colours = self.edges.colour_count();
        statistics.stationarity_m = (0..self.y.len())
            .filter(|&v| problem.movable(v))
            .map(|v| self.residual(problem, state, v).norm())
            .fold(0.0, f64::max);
        statistics.complementarity_m = self
            .contacts
            .rows
            .iter()
            .zip(&self.lambda)
            .map(|(row, lambda)| lambda.min(row.value(&self.y)).abs())
            .fold(0.0, f64::max);
        self.report_friction(state, statistics);
    }
}

impl<K: Default> LcpBackward<K> {
    /// A backward step whose rows another solver solves.
    pub fn with_solver(solver: K) -> Self {
        Self { solver, ..Self::default() }
    }
}

impl<K: RowSolver> LcpBackward<K> {
    /// How many contacts slide, and how far those that should stick have crept by `state.x`.
    fn report_friction(&self, state: &State, statistics: &mut Statistics) {
        if self.contacts.friction.is_empty() {
            return;
        }
        let x: Vec<Vector> = state.x.iter().map(|x| x.coords).collect();
        for (row, &multiplier) in self.contacts.friction.iter().zip(&self.friction) {
            let normal = self.lambda[row.normal as usize];
            if normal > 0.0 {
                if is_sliding(row, normal, multiplier) {
                    statistics.sliding_contacts += 1;
                } else {
                    statistics.sticking_contacts += 1;
                    statistics.creep_m = statistics.creep_m.max(row.slip(&x).norm());
                }
            }
        }
    }

    /// y0 + m^-1 J^T lambda - x of a movable vertex, by J^T lambda = (y - y')/w.
    fn residual(&self, problem: &Problem, state: &State, v: usize) -> Vector {
        let pull = (self.y[v] - self.free[v]) / (self.weights[v] * problem.relative_mass[v]);
        state.target[v] + pull - state.x[v]
    }

    /// mu from the last multipliers, then w and y'.
    fn set_weights(&mut self, problem: &Problem, state: &State) {
        self.proximal.clear();
        self.proximal.resize(state.x.len(), 0.0);
        let (forces, scalars) = (&self.forces, &self.edge_multipliers);
        proximal::add_edges(&mut self.proximal, problem, state, &self.edges.balls, forces, scalars);
        proximal::add_contacts(&mut self.proximal, problem, state);
        self.caution.apply(&mut self.proximal);
        self.weights.clear();
        self.free.clear();
        for v in 0..state.x.len() {
            let mass = problem.relative_mass[v];
            let mu = self.proximal[v].min(proximal::MOST_DRAG * mass);
            if problem.movable(v) {
                let weight = 1.0 / (mass + mu);
                self.weights.push(weight);
                self.free.push(weight * (mass * state.target[v].coords + mu * state.x[v].coords));
            } else {
                self.weights.push(0.0);
                self.free.push(state.target[v].coords);
            }
        }
    }

    /// Rows of the pairs in range, with the multipliers that they had.
    fn fill_rows(&mut self, problem: &Problem, state: &State, statistics: &mut Statistics) {
        let constraints = &problem.params.constraints;
        let contacts = &state.contacts;
        let active = constraints.active;
        let (uniform, range) = (problem.spacing.is_uniform(), problem.lengths.contact_range);
        let in_range = |p: usize| {
            let range = match uniform {
                true => range,
                false => {
                    let pair = &contacts.pairs.pairs()[p];
                    problem.spacing.contact_range(&problem.model, contacts.pairs.kind(p), pair)
                }
            };
            contacts.separations[p].distance <= range
        };
        self.wanted.clone_from(&contacts.desired);
        self.kept.clear();
        self.kept.resize(contacts.desired.len(), false);
        for kind in PairKind::ALL {
            for p in contacts.pairs.range(kind).filter(|&p| in_range(p)) {
                let (separation, desired) = (&contacts.separations[p], &mut self.wanted[p]);
                let contact = !constraints.contacts_only || {
                    let features = problem.features(kind, &contacts.pairs.pairs()[p], separation);
                    problem.is_contact(features, &separation.normal, &state.x, CONE_TOLERANCE)
                };
                let near = separation.distance < NEAR * *desired || contacts.multipliers[p] > 0.0;
                self.kept[p] = contact || near;
                if !contact {
                    *desired = (GUARDED * separation.distance).clamp(LEAST_GUARDED * *desired, *desired);
                }
            }
        }
        let (kept, wanted) = (&self.kept, &self.wanted);
        let only_active = problem.params.backward.active_rows;
        self.contacts.fill(
            constraints.form,
            &contacts.pairs,
            &contacts.separations,
            wanted,
            &state.x,
            &self.movable,
            |p, kind| {
                kept[p]
                    && (!only_active || contacts.multipliers[p] > 0.0 || {
                        let vertices = &contacts.pairs.pairs()[p].vertices;
                        let gap = predicted_gap(kind, vertices, &contacts.separations[p], &state.x, &state.y);
                        gap < active * wanted[p]
                    })
            },
        );
        self.row_starts.clear();
        self.row_starts.extend_from_slice(self.contacts.colour_starts());
        self.lambda.clear();
        self.lambda.extend(self.contacts.pair.iter().map(|&p| contacts.multipliers[p as usize]));
        self.contacts.fill_friction(
            &contacts.pairs,
            &contacts.separations,
            &state.slip_start,
            &contacts.frictions,
        );
        self.friction.clear();
        self.friction.extend(self.contacts.friction.iter().map(|row| {
            let kept = contacts.friction_multipliers[self.contacts.pair[row.normal as usize] as usize];
            TangentVector::new(row.tangents[0].dot(&kept), row.tangents[1].dot(&kept))
        }));
        let contact_rows = self.contacts.rows.len();
        if constraints.edge_form == EdgeForm::Linear {
            self.edges.linearise(&state.x, &mut self.contacts.rows);
            if !self.contacts.friction_of.is_empty() {
                self.contacts.friction_of.resize(self.contacts.rows.len(), lcp::LcpProblem::NO_FRICTION);
            }
            self.lambda.extend_from_slice(&self.edge_multipliers);
            let starts = self.edges.colour_starts().iter().skip(1);
            if self.row_starts.is_empty() {
                self.row_starts.push(0);
            }
            self.row_starts.extend(starts.map(|s| s + contact_rows as u32));
        }
        statistics.contact_rows = contact_rows;
        statistics.friction_rows = self.contacts.friction.len();
        statistics.contact_colours = self.contacts.colour_count();
        statistics.edge_rows = self.edges.balls.len();
        if only_active {
            statistics.skipped.rows +=
                (0..contacts.pairs.len()).filter(|&p| in_range(p)).count() - contact_rows;
        }
    }

    /// Improves the kept multipliers, and y with them.
    fn solve(&mut self, problem: &Problem, state: &State, statistics: &mut Statistics) {
        let balls: &[lcp::DistanceLimit] = match problem.params.constraints.edge_form {
            EdgeForm::Ball => &self.edges.balls,
            EdgeForm::Linear => &[],
        };
        let ball_starts = if balls.is_empty() { &[][..] } else { self.edges.colour_starts() };
        self.y.clone_from(&self.free);
        let solve = || -> Result<(), lcp::LcpError> {
            lcp::prepare_rows(&mut self.contacts.rows, &self.weights)?;
            lcp::prepare_friction(&mut self.contacts.friction, &self.weights)?;
            let mut system = lcp::LcpProblem::new(
                &self.weights,
                ConstraintSet::new(&self.contacts.rows, Schedule::coloured(&self.row_starts)),
                ConstraintSet::new(balls, Schedule::coloured(ball_starts)),
                ConstraintSet::serial(&self.contacts.friction),
            )?;
            if !self.contacts.friction.is_empty() {
                system = system.attach_friction(&self.contacts.friction_of)?;
            }
            let forces = if balls.is_empty() { &mut [][..] } else { &mut self.forces[..] };
            let mut multipliers = lcp::LcpState {
                y: &mut self.y,
                lambda: &mut self.lambda,
                limit_multipliers: forces,
                friction: &mut self.friction,
            };
            lcp::apply_multipliers(&system, &mut multipliers)?;
            let rows = RowSystem { system, free: &self.free, edges: &self.edges, problem, state };
            self.solver.solve(&rows, &mut multipliers)
        };
        let solved = { solve }();
        // Rows and schedules are built just above from checked parts; a refusal here is our own error.
        debug_assert!(solved.is_ok(), "{solved:?}");
        if let Err(error) = solved {
            tracing::error!(%error, "the backward step refused its own rows; the target is used as it is");
            self.y.clone_from(&self.free);
        }
        statistics.active_rows = self.lambda.iter().filter(|l| **l > 0.0).count()
            + self.forces.iter().filter(|f| **f != Vector::zeros()).count();
    }

    fn store(&mut self, problem: &Problem, state: &mut State) {
        for (target, y) in state.y.iter_mut().zip(&self.y) {
            target.coords = *y;
        }
        state.contacts.multipliers.iter_mut().for_each(|m| *m = 0.0);
        let contact_rows = self.contacts.pair.len();
        for (&p, &lambda) in self.contacts.pair.iter().zip(&self.lambda) {
            state.contacts.multipliers[p as usize] = lambda;
        }
        if !state.contacts.friction_multipliers.is_empty() {
            state.contacts.friction_multipliers.iter_mut().for_each(|m| *m = Vector::zeros());
            for (row, &multiplier) in self.contacts.friction.iter().zip(&self.friction) {
                let pair = self.contacts.pair[row.normal as usize] as usize;
                state.contacts.friction_multipliers[pair] = row.direction(multiplier);
            }
        }
        if problem.params.constraints.edge_form == EdgeForm::Linear {
            self.edge_multipliers.copy_from_slice(&self.lambda[contact_rows..]);
        }
    }
}
