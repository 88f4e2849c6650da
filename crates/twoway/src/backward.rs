//! The default backward stage: the inexact LCP (paper, Eq. 9-13) with a proximal term.
//!
//! Linearized at x, the problem is min 1/2 sum m^ |y - y0|^2 + 1/2 sum mu |y - x|^2 subject to the rows. The
//! proximal term with weights mu replaces curvature that linearization drops (`proximal.rs`). Without it y
//! does not come to rest in hard contact. At y = x the term vanishes, so it does not change the fixed point.
//! With w = 1/(m^ + mu):
//!
//! y = y' + W J^T lambda,   y' = w (m^ y0 + mu x).
//!
//! Most vertices are in no contact and at no taut edge: mu = 0 and y = y' = y0. Their entries are written
//! once per call. A step writes those of the vertices that this step or the last one moves away from y0
//! (`live.rs`). It reads all pairs in range once, to select its rows (`selection.rs`), and copies y at the
//! end.

use crate::blocked::Blocked;
use crate::chunks::{self, Chunks};
use crate::coarse::is_sliding;
use crate::index_set::IndexSet;
use crate::live::{LiveEdges, LiveParts, LiveRows};
use crate::oscillation::OscillationDamping;
use crate::proximal::{MAX_PROXIMAL_MASS, ProximalWeights};
use crate::row_solver::{ColoredSweeps, RowSolver, RowSystem};
use crate::scene::CollisionScene;
use crate::selection::Selection;
use crate::stages::BackwardStep;
use crate::state::ResolveState;
use crate::statistics::Statistics;
use crate::stop::Residuals;
use bowknot_constraints::{ContactRows, EdgeForm, EdgeLimits, EdgeReference};
use bowknot_geometry::{Identity, Point, Vector};
use bowknot_lcp::{self as lcp, ConstraintSet, Schedule, TangentVector};

/// The default [`BackwardStep`]. `K` solves its rows, by default projected Gauss-Seidel.
#[derive(Debug)]
pub struct LcpBackward<K = ColoredSweeps> {
    solver: K,
    edges: EdgeLimits,
    /// The edges that act; of solvers that keep to them.
    live: LiveEdges,
    selection: Selection,
    /// The scene, the movable vertices and the stretch limits of bodies for which `edges` was made.
    scene: Identity,
    movable: Vec<bool>,
    stretch_limits: Vec<f64>,
    /// Multipliers of all edges (ball form); of solvers that do not keep to live edges.
    forces: Vec<Vector>,
    /// Scalar multipliers of the edges (linear form).
    edge_multipliers: Vec<f64>,
    /// Contact rows, followed by the rows of the edges in the linear form.
    contacts: ContactRows,
    /// Colors of all rows (linear form).
    colors: Vec<u32>,
    lambda: Vec<f64>,
    /// Multipliers of the friction rows along their tangents.
    friction: Vec<TangentVector>,
    /// Prescribed vertices whose rows take them to be where they are.
    blocked: Blocked,
    /// Where the rows take vertices to want to go [m], while some are blocked.
    reachable: Vec<Point>,
    proximal: ProximalWeights,
    oscillation: OscillationDamping,
    /// w; 1/m^ where mu is 0.
    weights: Vec<f64>,
    /// y' [m]; y0 where mu is 0.
    free: Vec<Vector>,
    /// y [m].
    y: Vec<Vector>,
    /// Vertices whose y may differ from y0, after this step and after the last one.
    touched: IndexSet,
    last_touched: IndexSet,
    /// Whether the vertices of each contact row are touched.
    spread: Vec<bool>,
    /// Residuals of the bodies, by parts of them and in all.
    residuals: Chunks<BodyResidual>,
    body_residuals: Vec<BodyResidual>,
}

/// Factor on the stretch limits of edges that the target keeps within their limits itself: their rows only
/// guard.
pub const GUARDED_STRETCH: f64 = 1.0125;

/// Sums over some vertices of a body.
#[derive(Clone, Copy, Debug, Default)]
struct BodyResidual {
    body: u32,
    mass: f64,
    /// Of mass times residual [m].
    sum: Vector,
    /// Of mass times length of the residual [m].
    lengths: f64,
    /// Largest length of a residual [m].
    largest: f64,
}

impl<K: RowSolver> BackwardStep for LcpBackward<K> {
    fn begin(&mut self, scene: &CollisionScene, state: &ResolveState) {
        let params = &scene.params().contact;
        if self.edges_changed(scene, state) {
            let limits = &self.stretch_limits;
            self.edges = if params.edges {
                let limit = |edge: &[u32; 2]| limits[scene.model().vertex_body()[edge[0] as usize] as usize];
                EdgeLimits::new(scene.model().topology(), scene.rest(), &self.movable, limit)
            } else {
                EdgeLimits::default()
            };
        }
        self.edges.begin(&state.x, params.edge_reference);
        if params.edge_reference == EdgeReference::Rest {
            self.edges.let_yield(state.call.yielding());
            let is_known = |edge: &[u32; 2]| edge.iter().any(|&v| state.call.is_known(v as usize));
            self.edges.widen(GUARDED_STRETCH, is_known);
        }
        if !self.keeps_to_live_edges(scene) {
            self.forces.clear();
            self.forces.resize(self.edges.balls.len(), Vector::zeros());
            self.edge_multipliers.clear();
            self.edge_multipliers.resize(self.edges.balls.len(), 0.0);
        }
        self.blocked.begin(state.x.len());
        self.proximal.begin(state.x.len());
        self.touched.reset(state.x.len());
        self.last_touched.reset(state.x.len());
        self.oscillation.begin(scene);
        self.solver.begin();
    }

    fn project(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics) {
        let changed = self.blocked.update(scene, state);
        self.selection.select(scene, state, &self.blocked);
        self.set_weights(scene, state);
        self.place_blocked(scene, state, changed);
        self.fill_rows(scene, state, statistics);
        self.solve(scene, state, statistics);
        self.update_oscillation(scene, state);
        self.store(scene, state);
    }

    fn residuals(&mut self, scene: &CollisionScene, state: &ResolveState) -> Residuals {
        let [net_residual, mean_residual, _] = self.body_residuals(scene, state);
        Residuals { net_residual, mean_residual, stretch_to_limit: self.edges.stretch(&state.x).to_limit }
    }

    fn finish(&mut self, scene: &CollisionScene, state: &ResolveState, statistics: &mut Statistics) {
        [statistics.net_residual_m, _, statistics.stationarity_m] = self.body_residuals(scene, state);
        statistics.edge_colors = self.edges.color_count();
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

impl LcpBackward {
    /// The backward step with its default solver.
    pub fn new() -> Self {
        Self::default()
    }
}

impl<K: Default> Default for LcpBackward<K> {
    fn default() -> Self {
        Self::with_solver(K::default())
    }
}

impl<K> LcpBackward<K> {
    /// A backward step with another solver for its rows.
    pub fn with_solver(solver: K) -> Self {
        Self {
            solver,
            edges: EdgeLimits::default(),
            live: LiveEdges::default(),
            selection: Selection::default(),
            scene: Identity::default(),
            movable: Vec::new(),
            stretch_limits: Vec::new(),
            forces: Vec::new(),
            edge_multipliers: Vec::new(),
            contacts: ContactRows::default(),
            colors: Vec::new(),
            lambda: Vec::new(),
            friction: Vec::new(),
            blocked: Blocked::default(),
            reachable: Vec::new(),
            proximal: ProximalWeights::default(),
            oscillation: OscillationDamping::default(),
            weights: Vec::new(),
            free: Vec::new(),
            y: Vec::new(),
            touched: IndexSet::default(),
            last_touched: IndexSet::default(),
            spread: Vec::new(),
            residuals: Chunks::default(),
            body_residuals: Vec::new(),
        }
    }
}

impl<K: RowSolver> LcpBackward<K> {
    /// Whether the solver gets those edges only that act or could come to act.
    fn keeps_to_live_edges(&self, scene: &CollisionScene) -> bool {
        scene.params().contact.edge_form == EdgeForm::Ball && self.solver.keeps_to_live_edges()
    }

    /// Notes the scene, which vertices are movable, and the stretch limits; returns whether they differ from
    /// those of the last call.
    fn edges_changed(&mut self, scene: &CollisionScene, state: &ResolveState) -> bool {
        let bodies = 0..scene.model().bodies().len() as u32;
        let limits = || bodies.clone().map(|body| scene.stretch_limit(body));
        let prescribed = state.call.prescribed();
        let changed = self.scene != scene.identity()
            || !limits().eq(self.stretch_limits.iter().copied())
            || self.movable.len() != prescribed.len()
            || self.movable.iter().zip(prescribed).any(|(movable, prescribed)| movable == prescribed);
        if changed {
            self.scene = scene.identity();
            self.stretch_limits = limits().collect();
            self.movable = prescribed.iter().map(|p| !p).collect();
        }
        changed
    }

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

    /// Largest net and mean residual of a body [m], see [`Residuals`], and largest residual of a vertex [m].
    fn body_residuals(&mut self, scene: &CollisionScene, state: &ResolveState) -> [f64; 3] {
        let Self { y, free, weights, residuals, body_residuals, .. } = self;
        // The stationarity residual is y0 + m^-1 J^T lambda - x, and J^T lambda = (y - y')/w. Successive
        // vertices of one body make one entry.
        residuals.run(y.len(), |range, entries| {
            for v in range.filter(|&v| state.is_movable(v)) {
                let (body, mass) = (scene.model().vertex_body()[v], scene.relative_mass(v));
                let pull = (y[v] - free[v]) / (weights[v] * mass);
                let residual = state.target[v] + pull - state.x[v];
                let length = residual.norm();
                if entries.last().is_none_or(|last| last.body != body) {
                    entries.push(BodyResidual { body, ..BodyResidual::default() });
                }
                if let Some(entry) = entries.last_mut() {
                    entry.mass += mass;
                    entry.sum += mass * residual;
                    entry.lengths += mass * length;
                    entry.largest = entry.largest.max(length);
                }
            }
        });
        body_residuals.clear();
        body_residuals.resize(scene.model().bodies().len(), BodyResidual::default());
        let mut largest = 0.0f64;
        for entry in residuals.results() {
            let body = &mut body_residuals[entry.body as usize];
            body.sum += entry.sum;
            body.lengths += entry.lengths;
            body.mass += entry.mass;
            largest = largest.max(entry.largest);
        }
        let (mut net, mut mean) = (0.0f64, 0.0f64);
        for body in body_residuals.iter().filter(|body| body.mass > 0.0) {
            net = net.max(body.sum.norm() / body.mass);
            mean = mean.max(body.lengths / body.mass);
        }
        [net, mean, largest]
    }

    /// Computes mu from the last multipliers, then w and y', and sets y = y'.
    fn set_weights(&mut self, scene: &CollisionScene, state: &ResolveState) {
        std::mem::swap(&mut self.touched, &mut self.last_touched);
        self.touched.clear();
        if state.step == 0 {
            self.set_all_weights(scene, state);
        } else {
            let changed = self.last_touched.members().iter().chain(self.proximal.damped());
            for v in changed.map(|&v| v as usize) {
                self.weights[v] = if state.is_movable(v) { 1.0 / scene.relative_mass(v) } else { 0.0 };
                self.free[v] = state.target[v].coords;
                self.y[v] = self.free[v];
            }
        }
        self.add_proximal_weights(scene, state);
        for &v in self.proximal.damped() {
            let mu = self.proximal.of(v);
            let v = v as usize;
            let mass = scene.relative_mass(v);
            let mu = (mu * self.oscillation.factor(v)).min(MAX_PROXIMAL_MASS * mass);
            if mu > 0.0 && state.is_movable(v) {
                let weight = 1.0 / (mass + mu);
                self.weights[v] = weight;
                self.free[v] = weight * (mass * state.target[v].coords + mu * state.x[v].coords);
                self.y[v] = self.free[v];
            }
        }
    }

    /// Puts blocked vertices where they are, and those that are no longer blocked at their targets.
    fn place_blocked(&mut self, scene: &CollisionScene, state: &ResolveState, changed: bool) {
        let Self { blocked, free, y, .. } = self;
        let (now, before) = (blocked.vertices(), if changed { blocked.before() } else { &[] });
        for &vertex in before.iter().chain(now) {
            let v = vertex as usize;
            free[v] = blocked.aim(state, vertex).coords;
            y[v] = free[v];
        }
        if changed && self.keeps_to_live_edges(scene) {
            self.reachable.clone_from(&state.target);
            self.blocked.vertices().iter().for_each(|&v| self.reachable[v as usize] = state.x[v as usize]);
            self.live.look_up_violated(&self.edges, &self.reachable);
        }
    }

    /// Sets w and y' of all vertices, without a proximal weight, in the first step of a call.
    fn set_all_weights(&mut self, scene: &CollisionScene, state: &ResolveState) {
        let count = state.x.len();
        self.weights.resize(count, 0.0);
        self.free.resize(count, Vector::zeros());
        chunks::for_each(&mut self.weights, |v, weight| {
            *weight = if state.is_movable(v) { 1.0 / scene.relative_mass(v) } else { 0.0 };
        });
        chunks::for_each(&mut self.free, |v, free| *free = state.target[v].coords);
        self.y.clone_from(&self.free);
        if self.keeps_to_live_edges(scene) {
            self.live.begin(&self.edges, &state.target);
        }
    }

    fn add_proximal_weights(&mut self, scene: &CollisionScene, state: &ResolveState) {
        self.proximal.clear();
        let balls = &self.edges.balls;
        if self.keeps_to_live_edges(scene) {
            let acting = self.live.acting().iter();
            let edges = acting.map(|(edge, force)| (&balls[*edge as usize], force.norm()));
            self.proximal.add_edges(scene, state, edges);
        } else if scene.params().contact.edge_form == EdgeForm::Ball {
            let edges = balls.iter().zip(&self.forces).map(|(ball, force)| (ball, force.norm()));
            self.proximal.add_edges(scene, state, edges);
        } else {
            let edges = balls.iter().zip(self.edge_multipliers.iter().copied());
            self.proximal.add_edges(scene, state, edges);
        }
        // What pairs carry at the start of a call damps nothing: it would hold what has moved on since.
        if state.step > 0 {
            self.proximal.add_contacts(scene, state, &self.selection.pressing);
        }
    }

    /// Builds the rows of the selected pairs, with their multipliers of the last step.
    fn fill_rows(&mut self, scene: &CollisionScene, state: &ResolveState, statistics: &mut Statistics) {
        let params = &scene.params().contact;
        let contacts = &state.contacts;
        self.contacts.fill(
            params.form,
            &contacts.pairs,
            &contacts.separations,
            &state.x,
            &self.movable,
            &self.selection.selected,
        );
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
        statistics.contact_rows = contact_rows;
        statistics.friction_rows = self.contacts.friction.len();
        statistics.contact_colors = self.contacts.color_count();
        statistics.edge_rows = self.edges.balls.len();
        if scene.params().solver.backward.active_rows {
            statistics.skipped.rows += self.selection.in_range - contact_rows;
        }
        if params.edge_form == EdgeForm::Linear {
            self.append_linear_edges(state);
        }
    }

    /// Appends the linearized rows of all edges, in color order, and lists the colors of all rows.
    fn append_linear_edges(&mut self, state: &ResolveState) {
        let contact_rows = self.contacts.rows.len() as u32;
        self.colors.clear();
        self.colors.extend_from_slice(self.contacts.schedule().starts);
        if self.colors.is_empty() {
            self.colors.push(0);
        }
        self.colors.extend(self.edges.color_starts().iter().skip(1).map(|start| start + contact_rows));
        self.edges.linearize(&state.x, &mut self.contacts.rows);
        if !self.contacts.friction_of.is_empty() {
            self.contacts.friction_of.resize(self.contacts.rows.len(), lcp::LcpProblem::NO_FRICTION);
        }
        self.lambda.extend_from_slice(&self.edge_multipliers);
    }

    /// Improves the multipliers, and y with them.
    fn solve(&mut self, scene: &CollisionScene, state: &ResolveState, statistics: &mut Statistics) {
        let solved = lcp::prepare_rows(&mut self.contacts.rows, &self.weights)
            .and_then(|()| lcp::prepare_friction(&mut self.contacts.friction, &self.weights))
            .and_then(|()| match self.keeps_to_live_edges(scene) {
                true => self.solve_live(scene, state),
                false => self.solve_all(scene, state),
            });
        // Rows and schedules are built from checked parts. A refusal is an error of this crate.
        debug_assert!(solved.is_ok(), "{solved:?}");
        if let Err(error) = solved {
            tracing::error!(%error, "the backward step refused its own rows; the target is used as it is");
            self.y.clone_from(&self.free);
        }
        statistics.active_rows = self.lambda.iter().filter(|l| **l > 0.0).count()
            + self.live.acting().len()
            + self.forces.iter().filter(|f| **f != Vector::zeros()).count();
    }

    /// Solves for the contacts and for those edges that act or could come to act.
    fn solve_live(&mut self, scene: &CollisionScene, state: &ResolveState) -> Result<(), lcp::LcpError> {
        let parts = LiveParts {
            weights: &self.weights,
            edges: &self.edges,
            live: &mut self.live,
            touched: &mut self.touched,
            spread: &mut self.spread,
            damped: self.proximal.damped(),
            free: &self.free,
        };
        let (y, lambda, friction) = (&mut self.y, &mut self.lambda, &mut self.friction);
        let mut rows = LiveRows::new(scene, state, &self.contacts, parts, y, lambda, friction)?;
        let solved = self.solver.solve_live(&mut rows);
        rows.finish();
        solved
    }

    /// Solves for all rows and edges. All vertices are touched then.
    fn solve_all(&mut self, scene: &CollisionScene, state: &ResolveState) -> Result<(), lcp::LcpError> {
        let is_linear = scene.params().contact.edge_form == EdgeForm::Linear;
        let (balls, ball_starts): (&[lcp::DistanceLimit], &[u32]) =
            if is_linear { (&[], &[]) } else { (&self.edges.balls, self.edges.color_starts()) };
        let schedule = if is_linear { Schedule::colored(&self.colors) } else { self.contacts.schedule() };
        let mut system = lcp::LcpProblem::new(
            &self.weights,
            ConstraintSet::new(&self.contacts.rows, schedule),
            ConstraintSet::new(balls, Schedule::colored(ball_starts)),
            ConstraintSet::serial(&self.contacts.friction),
        )?;
        if !self.contacts.friction.is_empty() {
            system = system.attach_friction(&self.contacts.friction_of)?;
        }
        (0..self.y.len() as u32).for_each(|v| {
            self.touched.insert(v);
        });
        let mut multipliers = lcp::LcpState {
            y: &mut self.y,
            lambda: &mut self.lambda,
            limit_multipliers: if is_linear { &mut [] } else { &mut self.forces },
            friction: &mut self.friction,
        };
        lcp::apply_multipliers(&system, &mut multipliers)?;
        let rows = RowSystem { system, free: &self.free, edges: &self.edges, scene, state };
        self.solver.solve(&rows, &mut multipliers)
    }

    fn update_oscillation(&mut self, scene: &CollisionScene, state: &ResolveState) {
        let (touched, last) = (&self.touched, &self.last_touched);
        let only_last = last.members().iter().filter(|&&v| !touched.contains(v));
        let changed = touched.members().iter().chain(only_last).copied();
        let is_changed = |v| touched.contains(v) || last.contains(v);
        self.oscillation.update(scene, state, &self.y, changed, is_changed);
    }

    /// Stores y and the multipliers in the state.
    fn store(&mut self, scene: &CollisionScene, state: &mut ResolveState) {
        // All of y, in case that something changed `state.y` since the last step.
        let y = &self.y;
        chunks::for_each(&mut state.y, |v, stored| stored.coords = y[v]);
        for v in self.blocked.vertices().iter().map(|&v| v as usize) {
            state.y[v] = state.target[v];
        }
        let contacts = &mut state.contacts;
        for &p in &self.selection.pressing {
            contacts.multipliers[p as usize] = 0.0;
        }
        for (&p, &lambda) in self.contacts.pair.iter().zip(&self.lambda) {
            contacts.multipliers[p as usize] = lambda;
        }
        if !contacts.friction_multipliers.is_empty() {
            // A pair without a multiplier has no friction, so only these can have had some.
            for &p in &self.selection.pressing {
                contacts.friction_multipliers[p as usize] = Vector::zeros();
            }
            for (row, &multiplier) in self.contacts.friction.iter().zip(&self.friction) {
                let pair = self.contacts.pair[row.normal as usize] as usize;
                contacts.friction_multipliers[pair] = row.direction(multiplier);
            }
        }
        if scene.params().contact.edge_form == EdgeForm::Linear {
            self.edge_multipliers.copy_from_slice(&self.lambda[self.contacts.pair.len()..]);
        }
    }
}
