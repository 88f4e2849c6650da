//! The rows of a state: contacts within range and edge limits, linearized there.
//!
//! Contacts are in gap form. The contact distance of a pair follows from its gap at the start of the call; a
//! pair that started out of range is asked for all of delta.

use super::nonnegative;
use bowknot::constraints::{ContactForm, DeltaRule, EdgeLimits, EdgeReference, contact_row};
use bowknot::geometry::{PairKind, Point, Vector, separation};
use bowknot::lcp::Row;
use bowknot::proximity::{Pair, PairList, ProximitySearch};
use bowknot::recording::States;
use bowknot::twoway::{CallInput, CollisionScene};

/// Slack below which a row counts as active: of contacts in contact distances, of edges in limits. Methods
/// stop that far from their active rows.
const ACTIVE: [f64; 2] = [0.1, 0.02];

/// Rows at a state.
#[derive(Debug)]
pub struct RowSet {
    rows: Vec<Row>,
    /// Value of each row at the state [m].
    values: Vec<f64>,
    /// Slack below which each row is active [m].
    active: Vec<f64>,
    /// Number of contact rows; edge rows follow.
    contacts: usize,
    pub min_gap: Option<f64>,
    pub stretch: Stretch,
}

/// Largest ratios of edge lengths.
#[derive(Clone, Copy, Debug)]
pub struct Stretch {
    pub to_limit: f64,
    pub to_start: f64,
    pub to_rest: f64,
}

impl RowSet {
    /// The rows of `scene` at `x`, for a call from `states.x`.
    pub fn new(
        scene: &CollisionScene,
        call: &CallInput,
        states: &States,
        x: &[Point],
        search: &mut ProximitySearch,
    ) -> Self {
        let (mut pairs, mut separations) = (PairList::default(), Vec::new());
        let bodies = scene.model().vertex_body();
        // A vertex and a half-space have only the vertex's radius, which must then be the whole range.
        let planes = !scene.model().half_spaces().is_empty();
        let share = if planes { 2.0 } else { 1.0 };
        let radii: Vec<f64> = bodies.iter().map(|&b| share * scene.spacing().margin(b)).collect();
        search.search(scene.model(), x, &radii, &mut pairs, &mut separations);
        let growth = states.time_step.map_or(f64::INFINITY, |dt| scene.lengths().separation_speed * dt);
        let mut set = Self {
            rows: Vec::new(),
            values: Vec::new(),
            active: Vec::new(),
            contacts: 0,
            min_gap: None,
            stretch: Stretch { to_limit: 1.0, to_start: 1.0, to_rest: 1.0 },
        };
        let points: Vec<Vector> = x.iter().map(|p| p.coords).collect();
        for kind in PairKind::ALL {
            for index in pairs.range(kind) {
                let (pair, separation) = (&pairs.pairs()[index], &separations[index]);
                if separation.distance > scene.contact_range(kind, pair) {
                    continue;
                }
                let gap = set.min_gap.map_or(separation.distance, |gap| gap.min(separation.distance));
                set.min_gap = Some(gap);
                let delta = scene.spacing().of(scene.model(), kind, pair).delta;
                let start = start_gap(scene, kind, pair, &states.x);
                let rule = DeltaRule { delta, growth };
                let delta = rule.of(scene.model(), kind, pair, scene.rest(), start).0;
                let row = contact_row(ContactForm::Gap, kind, pair.vertices, x, separation, delta);
                set.push(row, ACTIVE[0] * delta, &points);
            }
        }
        set.contacts = set.rows.len();
        set.add_edges(scene, call, states, x, &points);
        set
    }

    fn push(&mut self, row: Row, active: f64, points: &[Vector]) {
        self.values.push(row.value(points));
        self.active.push(active);
        self.rows.push(row);
    }

    fn add_edges(
        &mut self,
        scene: &CollisionScene,
        call: &CallInput,
        states: &States,
        x: &[Point],
        points: &[Vector],
    ) {
        let movable: Vec<bool> = (0..x.len()).map(|v| call.is_movable(v)).collect();
        let limit = |e: &[u32; 2]| scene.stretch_limit(scene.model().vertex_body()[e[0] as usize]);
        let mut limits = EdgeLimits::new(scene.model().topology(), scene.rest(), &movable, limit);
        limits.begin(&states.x, EdgeReference::Rest);
        let mut rows = Vec::new();
        limits.linearize(x, &mut rows);
        for (row, ball) in rows.into_iter().zip(&limits.balls) {
            self.push(row, ACTIVE[1] * ball.limit, points);
        }
        let stretch = limits.stretch(x);
        self.stretch =
            Stretch { to_limit: stretch.to_limit, to_start: stretch.to_start, to_rest: stretch.to_rest };
    }

    /// Largest violation of a contact row [m].
    pub fn contact_violation(&self) -> f64 {
        self.values[..self.contacts].iter().map(|v| -v).fold(0.0, f64::max)
    }

    /// Rows that are active at the state.
    pub fn active_rows(&self) -> Vec<Row> {
        let rows = self.rows.iter().zip(&self.values).zip(&self.active);
        rows.filter(|((_, value), active)| *value <= *active).map(|((row, _), _)| *row).collect()
    }

    /// The projection of y0 - x onto the motions that no active row forbids, in the metric of mass: 0 if x
    /// solves the scene. By Moreau's decomposition it is y0 - x + M^-1 J^T lambda with the non-negative
    /// multipliers that minimize it. If at most `iterations` do not suffice, the result is an upper bound.
    pub fn stationarity(
        &self,
        scene: &CollisionScene,
        call: &CallInput,
        x: &[Point],
        target: &[Point],
        iterations: usize,
    ) -> Vec<Vector> {
        let weights: Vec<f64> = (0..x.len())
            .map(|v| if call.is_movable(v) { 1.0 / scene.relative_mass(v) } else { 0.0 })
            .collect();
        let wanted: Vec<Vector> = (0..x.len())
            .map(|v| if call.is_movable(v) { target[v] - x[v] } else { Vector::zeros() })
            .collect();
        nonnegative::residual(&self.active_rows(), &weights, wanted, iterations)
    }
}

/// Distance of a pair at the start of the call [m].
fn start_gap(scene: &CollisionScene, kind: PairKind, pair: &Pair, start: &[Point]) -> f64 {
    match kind {
        PairKind::VertexHalfSpace => {
            let plane = &scene.model().half_spaces()[pair.elements[1] as usize];
            separation::separate_half_space(&start[pair.vertices[0] as usize], plane).distance
        }
        _ => separation::separate(kind, &pair.vertices.map(|v| start[v as usize])).distance,
    }
}
