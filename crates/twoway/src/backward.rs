//! The default backward stage: the inexact LCP (paper, Eq. 9-13) with a proximal term.
//!
//! Linearized at x, the problem is min 1/2 sum m^ |y - y0|^2 + 1/2 sum mu |y - x|^2 subject to the rows. The
//! proximal term with weights mu replaces curvature that linearization drops (`proximal.rs`). Without it y
//! does not come to rest in hard contact. At y = x the term vanishes, so it does not change the fixed point.
//! With w = 1/(m^ + mu):
//!
//! y = y' + W J^T lambda,   y' = w (m^ y0 + mu x).

use crate::coarse::is_sliding;
use crate::oscillation::OscillationDamping;
use crate::proximal;
use crate::row_solver::{ColoredSweeps, RowSolver, RowSystem};
use crate::scene::CollisionScene;
use crate::stages::BackwardStep;
use crate::state::ResolveState;
use crate::statistics::Statistics;
use crate::stop::Residuals;
use bowknot_constraints::{ContactRows, EdgeForm, EdgeLimits, predicted_gap};
use bowknot_geometry::{PairKind, Vector};
use bowknot_lcp::{self as lcp, ConstraintSet, Schedule, TangentVector};

/// Sine of the largest angle by which the normals of rows may leave their cones. Rows are rebuilt in each
/// step; a wide cone prevents that they come and go.
const CONE_TOLERANCE: f64 = 0.02;

/// Distance below which a pair has a row whatever its normal, in its desired distance: pressed vertices are
/// held from all sides.
const CLOSE: f64 = 1.001;

/// Share of its distance that the row of such a pair asks for if the pair is no contact.
///
/// With the desired distance instead, the row would block bodies that slide on a mesh, and push them from
/// behind: grains on an irregular mesh gain 17 % of their speed in a second. Without any row, the pair would
/// stop the forward step where the target does not know of it. With a share of a half and no smallest
/// distance, `funnel` at scale 0.2 reaches the limit of steps.
const NON_CONTACT_SHARE: f64 = 0.9;

/// Smallest distance that such a row asks for, in the desired distance of the pair. At the minimum separation
/// the forward step closes no pair further, whatever its row allows. Without this bound, two of three
/// variants of `funnel` reach the limit of steps.
const MIN_NON_CONTACT_DISTANCE: f64 = 0.5;

/// The default [`BackwardStep`]. `K` solves its rows, by default projected Gauss-Seidel.
#[derive(Debug, Default)]
pub struct LcpBackward<K = ColoredSweeps> {
    solver: K,
    edges: EdgeLimits,
    /// The distance that the row of each pair asks for [m].
    desired: Vec<f64>,
    /// Which pairs may have a row.
    has_row: Vec<bool>,
    /// The movable vertices and the stretch limits of bodies for which `edges` was made.
    movable: Vec<bool>,
    stretch_limits: Vec<f64>,
    /// Vector multipliers of the edges (ball form).
    forces: Vec<Vector>,
    /// Scalar multipliers of the edges (linear form).
    edge_multipliers: Vec<f64>,
    /// Contact rows, followed by the rows of the edges in the linear form.
    contacts: ContactRows,
    row_starts: Vec<u32>,
    lambda: Vec<f64>,
    /// Multipliers of the friction rows along their tangents.
    friction: Vec<TangentVector>,
    proximal: Vec<f64>,
    oscillation: OscillationDamping,
    weights: Vec<f64>,
    /// y' [m].
    free: Vec<Vector>,
    /// y [m].
    y: Vec<Vector>,
    /// Sum of residuals times mass, and mass, of each body.
    body_residuals: Vec<(Vector, f64)>,
}

impl<K: RowSolver> BackwardStep for LcpBackward<K> {
    fn begin(&mut self, scene: &CollisionScene, state: &ResolveState) {
        let limits: Vec<f64> =
            (0..scene.model().bodies().len() as u32).map(|body| scene.stretch_limit(body)).collect();
        let prescribed = state.call.prescribed();
        let changed = self.stretch_limits != limits
            || self.movable.len() != prescribed.len()
            || self.movable.iter().zip(prescribed).any(|(movable, prescribed)| movable == prescribed);
        let params = &scene.params().contact;
        if changed {
            self.movable = prescribed.iter().map(|p| !p).collect();
            self.edges = if params.edges {
                let limit = |edge: &[u32; 2]| limits[scene.model().vertex_body()[edge[0] as usize] as usize];
                EdgeLimits::new(scene.model().topology(), scene.rest(), &self.movable, limit)
            } else {
                EdgeLimits::default()
            };
            self.stretch_limits = limits;
        }
        self.edges.begin(&state.x, params.edge_reference);
        self.forces.clear();
        self.forces.resize(self.edges.balls.len(), Vector::zeros());
        self.edge_multipliers.clear();
        self.edge_multipliers.resize(self.edges.balls.len(), 0.0);
        self.oscillation.begin(scene);
        self.solver.begin();
    }

    fn project(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics) {
        self.set_weights(scene, state);
        self.fill_rows(scene, state, statistics);
        self.solve(scene, state, statistics);
        self.store(scene, state);
        self.oscillation.update(scene, state);
    }

    fn residuals(&mut self, scene: &CollisionScene, state: &ResolveState) -> Residuals {
        Residuals {
            net_residual: self.net_residual(scene, state),
            mean_residual: self.mean_residual(scene, state),
            stretch_to_limit: self.edges.stretch(&state.x).to_limit,
        }
    }

    fn finish(&mut self, scene: &CollisionScene, state: &ResolveState, statistics: &mut Statistics) {
        statistics.net_residual_m = self.net_residual(scene, state);
        statistics.edge_colors = self.edges.color_count();
        statistics.stationarity_m = (0..self.y.len())
            .filter(|&v| state.is_movable(v))
            .map(|v| self.residual(scene, state, v).norm())
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
    /// A backward step with another solver for its rows.
    pub fn with_solver(solver: K) -> Self {
        Self { solver, ..Self::default() }
    }
}

impl<K: RowSolver> LcpBackward<K> {
    /// Counts the contacts that stick and slide, and finds the largest slip of a sticking one at `state.x`.
    fn report_friction(&self, state: &ResolveState, statistics: &mut Statistics) {
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
                    statistics.sticking_slip_m = statistics.sticking_slip_m.max(row.slip(&x).norm());
                }
            }
        }
    }

    /// Largest net residual of a body [m], see [`Residuals`].
    fn net_residual(&mut self, scene: &CollisionScene, state: &ResolveState) -> f64 {
        self.body_residuals.clear();
        self.body_residuals.resize(scene.model().bodies().len(), (Vector::zeros(), 0.0));
        for v in (0..self.y.len()).filter(|&v| state.is_movable(v)) {
            let mass = scene.relative_mass(v);
            let residual = self.residual(scene, state, v);
            let (sum, total) = &mut self.body_residuals[scene.model().vertex_body()[v] as usize];
            *sum += mass * residual;
            *total += mass;
        }
        self.body_residuals
            .iter()
            .filter(|(_, mass)| *mass > 0.0)
            .map(|(r, mass)| r.norm() / mass)
            .fold(0.0, f64::max)
    }

    /// Largest mean residual of a body [m], see [`Residuals`].
    fn mean_residual(&self, scene: &CollisionScene, state: &ResolveState) -> f64 {
        let mut bodies = vec![(0.0, 0.0); scene.model().bodies().len()];
        for v in (0..self.y.len()).filter(|&v| state.is_movable(v)) {
            let mass = scene.relative_mass(v);
            let (sum, total) = &mut bodies[scene.model().vertex_body()[v] as usize];
            *sum += mass * self.residual(scene, state, v).norm();
            *total += mass;
        }
        bodies.iter().filter(|(_, mass)| *mass > 0.0).map(|(sum, mass)| sum / mass).fold(0.0, f64::max)
    }

    /// Stationarity residual y0 + m^-1 J^T lambda - x of a movable vertex [m], by J^T lambda = (y - y')/w.
    fn residual(&self, scene: &CollisionScene, state: &ResolveState, v: usize) -> Vector {
        let pull = (self.y[v] - self.free[v]) / (self.weights[v] * scene.relative_mass(v));
        state.target[v] + pull - state.x[v]
    }

    /// Computes mu from the last multipliers, then w and y'.
    fn set_weights(&mut self, scene: &CollisionScene, state: &ResolveState) {
        self.proximal.clear();
        self.proximal.resize(state.x.len(), 0.0);
        let (forces, scalars) = (&self.forces, &self.edge_multipliers);
        proximal::add_edges(&mut self.proximal, scene, state, &self.edges.balls, forces, scalars);
        proximal::add_contacts(&mut self.proximal, scene, state);
        self.oscillation.apply(&mut self.proximal);
        self.weights.clear();
        self.free.clear();
        for v in 0..state.x.len() {
            let mass = scene.relative_mass(v);
            let mu = self.proximal[v].min(proximal::MAX_PROXIMAL_MASS * mass);
            if state.is_movable(v) {
                let weight = 1.0 / (mass + mu);
                self.weights.push(weight);
                self.free.push(weight * (mass * state.target[v].coords + mu * state.x[v].coords));
            } else {
                self.weights.push(0.0);
                self.free.push(state.target[v].coords);
            }
        }
    }

    /// Builds the rows of the pairs in range, with their multipliers of the last step.
    fn fill_rows(&mut self, scene: &CollisionScene, state: &ResolveState, statistics: &mut Statistics) {
        let params = &scene.params().contact;
        let contacts = &state.contacts;
        let active = params.active;
        let (uniform, range) = (scene.spacing().is_uniform(), scene.lengths().contact_range);
        let in_range = |p: usize| {
            let range = if uniform {
                range
            } else {
                let pair = &contacts.pairs.pairs()[p];
                scene.spacing().contact_range(scene.model(), contacts.pairs.kind(p), pair)
            };
            contacts.separations[p].distance <= range
        };
        self.desired.clone_from(&contacts.desired);
        self.has_row.clear();
        self.has_row.resize(contacts.desired.len(), false);
        for kind in PairKind::ALL {
            for p in contacts.pairs.range(kind).filter(|&p| in_range(p)) {
                let (separation, desired) = (&contacts.separations[p], &mut self.desired[p]);
                let contact = !params.contacts_only || {
                    let features = scene.features(kind, &contacts.pairs.pairs()[p], separation);
                    scene.is_contact(features, &separation.normal, &state.x, CONE_TOLERANCE)
                };
                let close = separation.distance < CLOSE * *desired || contacts.multipliers[p] > 0.0;
                self.has_row[p] = contact || close;
                if !contact {
                    *desired = (NON_CONTACT_SHARE * separation.distance)
                        .clamp(MIN_NON_CONTACT_DISTANCE * *desired, *desired);
                }
            }
        }
        let (has_row, desired) = (&self.has_row, &self.desired);
        let only_active = scene.params().solver.backward.active_rows;
        self.contacts.fill(
            params.form,
            &contacts.pairs,
            &contacts.separations,
            desired,
            &state.x,
            &self.movable,
            |p, kind| {
                has_row[p]
                    && (!only_active || contacts.multipliers[p] > 0.0 || {
                        let vertices = &contacts.pairs.pairs()[p].vertices;
                        let gap = predicted_gap(kind, vertices, &contacts.separations[p], &state.x, &state.y);
                        gap < active * desired[p]
                    })
            },
        );
        self.row_starts.clear();
        self.row_starts.extend_from_slice(self.contacts.color_starts());
        self.lambda.clear();
        self.lambda.extend(self.contacts.pair.iter().map(|&p| contacts.multipliers[p as usize]));
        self.contacts.fill_friction(
            &contacts.pairs,
            &contacts.separations,
            state.call.slip_start(),
            &contacts.frictions,
        );
        self.friction.clear();
        self.friction.extend(self.contacts.friction.iter().map(|row| {
            let kept = contacts.friction_multipliers[self.contacts.pair[row.normal as usize] as usize];
            TangentVector::new(row.tangents[0].dot(&kept), row.tangents[1].dot(&kept))
        }));
        let contact_rows = self.contacts.rows.len();
        if params.edge_form == EdgeForm::Linear {
            self.edges.linearize(&state.x, &mut self.contacts.rows);
            if !self.contacts.friction_of.is_empty() {
                self.contacts.friction_of.resize(self.contacts.rows.len(), lcp::LcpProblem::NO_FRICTION);
            }
            self.lambda.extend_from_slice(&self.edge_multipliers);
            let starts = self.edges.color_starts().iter().skip(1);
            if self.row_starts.is_empty() {
                self.row_starts.push(0);
            }
            self.row_starts.extend(starts.map(|s| s + contact_rows as u32));
        }
        statistics.contact_rows = contact_rows;
        statistics.friction_rows = self.contacts.friction.len();
        statistics.contact_colors = self.contacts.color_count();
        statistics.edge_rows = self.edges.balls.len();
        if only_active {
            statistics.skipped.rows +=
                (0..contacts.pairs.len()).filter(|&p| in_range(p)).count() - contact_rows;
        }
    }

    /// Improves the multipliers, and y with them.
    fn solve(&mut self, scene: &CollisionScene, state: &ResolveState, statistics: &mut Statistics) {
        let solved = self.solve_rows(scene, state);
        // Rows and schedules are built from checked parts. A refusal is an error of this crate.
        debug_assert!(solved.is_ok(), "{solved:?}");
        if let Err(error) = solved {
            tracing::error!(%error, "the backward step refused its own rows; the target is used as it is");
            self.y.clone_from(&self.free);
        }
        statistics.active_rows = self.lambda.iter().filter(|l| **l > 0.0).count()
            + self.forces.iter().filter(|f| **f != Vector::zeros()).count();
    }

    fn solve_rows(&mut self, scene: &CollisionScene, state: &ResolveState) -> Result<(), lcp::LcpError> {
        let balls: &[lcp::DistanceLimit] = match scene.params().contact.edge_form {
            EdgeForm::Ball => &self.edges.balls,
            EdgeForm::Linear => &[],
        };
        let ball_starts = if balls.is_empty() { &[][..] } else { self.edges.color_starts() };
        self.y.clone_from(&self.free);
        lcp::prepare_rows(&mut self.contacts.rows, &self.weights)?;
        lcp::prepare_friction(&mut self.contacts.friction, &self.weights)?;
        let mut system = lcp::LcpProblem::new(
            &self.weights,
            ConstraintSet::new(&self.contacts.rows, Schedule::colored(&self.row_starts)),
            ConstraintSet::new(balls, Schedule::colored(ball_starts)),
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
        let rows = RowSystem { system, free: &self.free, edges: &self.edges, scene, state };
        self.solver.solve(&rows, &mut multipliers)
    }

    /// Stores y and the multipliers in the state.
    fn store(&mut self, scene: &CollisionScene, state: &mut ResolveState) {
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
        if scene.params().contact.edge_form == EdgeForm::Linear {
            self.edge_multipliers.copy_from_slice(&self.lambda[contact_rows..]);
        }
    }
}
