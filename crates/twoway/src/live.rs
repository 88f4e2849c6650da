//! The rows of a backward step, with those edges only that act or could come to act.
//!
//! Few edges ever reach their limit. Without multipliers y is y'. So an edge is left out as long as both of
//! its vertices have y = y0 and it is within its limit there, which is looked up once per call. A vertex is
//! *touched* if anything may move it away from y0: a proximal weight, or a row or an edge with a multiplier.
//! After each sweep the vertices of rows and edges that got a multiplier are touched in turn. The edges of
//! touched vertices are *watched*: after each sweep those that are violated at y join those that are swept,
//! with the edges next to them, and stay until the end of the step. If the last sweep leaves new ones, some
//! more sweeps follow. So sweeps do what sweeps over all edges would do, but for the order.

use crate::chunks::Chunks;
use crate::index_set::IndexSet;
use crate::scene::CollisionScene;
use crate::state::ResolveState;
use bowknot_constraints::{ContactRows, EdgeLimits};
use bowknot_geometry::{Point, Vector};
use bowknot_lcp::{
    self as lcp, ConstraintSet, DistanceLimit, LcpError, LcpProblem, LcpState, Schedule, TangentVector,
};

/// With more than this share of all edges, all are swept, in color order and by several threads.
const MOST: f64 = 0.25;

/// Where an edge is that is not swept: nowhere, or among those that are watched.
const NONE: u32 = u32::MAX;
const WATCHED: u32 = u32::MAX - 1;

/// Number of sweeps that follow where the last one leaves new violated edges.
const MORE_SWEEPS: usize = 2;

/// The edges that are swept, with their multipliers.
#[derive(Debug, Default)]
pub(crate) struct LiveEdges {
    /// Edges that are longer than their limit at the target of the call.
    violated: Chunks<u32>,
    /// Place of each edge in `list`, or [`NONE`], or [`WATCHED`].
    places: Vec<u32>,
    /// Edges of touched vertices that are not swept.
    watched: Vec<u32>,
    /// The edges that are swept, by index.
    list: Vec<u32>,
    limits: Vec<DistanceLimit>,
    multipliers: Vec<Vector>,
    /// Whether the vertices of each of them are touched.
    spread: Vec<bool>,
    /// Whether `list` has all edges in color order.
    all: bool,
    /// Edges with a multiplier after the last step.
    acting: Vec<(u32, Vector)>,
}

impl LiveEdges {
    /// Starts a call in which vertices want to go to `target`, and those that are not movable do.
    pub fn begin(&mut self, edges: &EdgeLimits, target: &[Point]) {
        self.look_up_violated(edges, target);
        self.acting.clear();
        self.clear();
        self.places.clear();
        self.places.resize(edges.balls.len(), NONE);
    }

    /// Notes which edges are violated at `target`, where vertices are that nothing moves away from there.
    pub fn look_up_violated(&mut self, edges: &EdgeLimits, target: &[Point]) {
        self.violated.run(edges.balls.len(), |range, violated| {
            violated.extend(
                range.filter(|&e| is_violated(&edges.balls[e], |v| target[v].coords)).map(|e| e as u32),
            );
        });
    }

    /// The edges with a multiplier after the last step, and their multipliers [m].
    pub fn acting(&self) -> &[(u32, Vector)] {
        &self.acting
    }

    fn clear(&mut self) {
        let edges = self.list.drain(..).chain(self.watched.drain(..));
        edges.for_each(|edge| self.places[edge as usize] = NONE);
        self.limits.clear();
        self.multipliers.clear();
        self.spread.clear();
        self.all = false;
    }

    /// Starts a step: lists the edges that are violated at the target and those with a multiplier.
    fn start(&mut self, edges: &EdgeLimits) {
        let violated = std::mem::take(&mut self.violated);
        violated.results().for_each(|&edge| self.add(edges, edge, Vector::zeros()));
        self.violated = violated;
        let acting = std::mem::take(&mut self.acting);
        for &(edge, multiplier) in &acting {
            match self.places[edge as usize] {
                NONE => self.add(edges, edge, multiplier),
                // None is watched yet.
                place => self.multipliers[place as usize] = multiplier,
            }
        }
        self.acting = acting;
    }

    /// Lists the watched edges that are violated at `y`; returns whether there are any. The edges next to
    /// them are listed as well: they are swept after them, so the front of a pull moves on by two edges in a
    /// sweep.
    fn look(&mut self, edges: &EdgeLimits, y: &[Vector]) -> bool {
        let before = self.list.len();
        let mut watched = std::mem::take(&mut self.watched);
        watched.retain(|&edge| {
            if self.places[edge as usize] != WATCHED {
                return false;
            }
            let ball = &edges.balls[edge as usize];
            let violated = is_violated(ball, |v| y[v]);
            if violated {
                self.add(edges, edge, Vector::zeros());
                for &next in ball.vertices.iter().flat_map(|&v| edges.of_vertex(v)) {
                    if self.places[next as usize] >= WATCHED {
                        self.add(edges, next, Vector::zeros());
                    }
                }
            }
            !violated
        });
        self.watched = watched;
        self.list.len() > before
    }

    /// Lists an edge that is not listed.
    fn add(&mut self, edges: &EdgeLimits, edge: u32, multiplier: Vector) {
        self.places[edge as usize] = self.list.len() as u32;
        self.list.push(edge);
        self.limits.push(edges.balls[edge as usize]);
        self.multipliers.push(multiplier);
        self.spread.push(false);
    }

    /// Lists all edges if most are listed anyway.
    fn list_all_if_most(&mut self, edges: &EdgeLimits) {
        let count = edges.balls.len();
        if self.all || (self.list.len() as f64) < MOST * count as f64 {
            return;
        }
        self.keep_acting();
        self.clear();
        (0..count as u32).for_each(|edge| self.add(edges, edge, Vector::zeros()));
        for &(edge, multiplier) in &self.acting {
            self.multipliers[edge as usize] = multiplier;
        }
        self.all = true;
    }

    fn keep_acting(&mut self) {
        let listed = self.list.iter().zip(&self.multipliers);
        self.acting.clear();
        self.acting.extend(listed.filter(|(_, f)| **f != Vector::zeros()).map(|(edge, f)| (*edge, *f)));
    }

    /// Ends a step: forgets the list, but not the multipliers.
    fn finish(&mut self) {
        self.keep_acting();
        self.clear();
    }
}

#[inline]
fn is_violated(ball: &DistanceLimit, y: impl Fn(usize) -> Vector) -> bool {
    let [a, b] = ball.vertices.map(|v| y(v as usize));
    let squared = (a - b).norm_squared();
    squared > ball.limit * ball.limit || squared.is_nan()
}

/// The rows of one backward step, linearized at x^(l), with the edges that act or could come to act. For
/// solvers that keep to them, see [`crate::RowSolver::solve_live`].
#[derive(Debug)]
pub struct LiveRows<'a> {
    /// The scene and its parameters.
    pub scene: &'a CollisionScene,
    /// The moving state; its `y` is still y^(l), that of the last step.
    pub state: &'a ResolveState,
    parts: LiveParts<'a>,
    /// The contact rows and their friction.
    contacts: LcpProblem<'a>,
    y: &'a mut [Vector],
    lambda: &'a mut [f64],
    friction: &'a mut [TangentVector],
}

/// What [`LiveRows`] is made of, beside what every solver gets.
#[derive(Debug)]
pub(crate) struct LiveParts<'a> {
    /// Inverse weights of the vertices [1].
    pub weights: &'a [f64],
    pub edges: &'a EdgeLimits,
    pub live: &'a mut LiveEdges,
    /// Vertices whose y may differ from the target.
    pub touched: &'a mut IndexSet,
    /// Whether the vertices of each contact row are touched.
    pub spread: &'a mut Vec<bool>,
    /// Vertices with a proximal weight.
    pub damped: &'a [u32],
    /// y' [m].
    pub free: &'a [Vector],
}

/// One sweep's view of the rows: see [`LiveRows::sweep`].
#[derive(Clone, Copy, Debug)]
pub struct LiveSystem<'a> {
    /// The contact rows, their friction, and the edges that are swept.
    pub system: LcpProblem<'a>,
    /// y', the value of y without multipliers [m].
    pub free: &'a [Vector],
    /// The vertices whose y may differ from y'. All others have y = y'.
    pub touched: &'a [u32],
}

impl<'a> LiveRows<'a> {
    /// Collects the rows, with y = y' on entry, and applies the multipliers of the last step.
    pub(crate) fn new(
        scene: &'a CollisionScene,
        state: &'a ResolveState,
        contacts: &'a ContactRows,
        parts: LiveParts<'a>,
        y: &'a mut [Vector],
        lambda: &'a mut [f64],
        friction: &'a mut [TangentVector],
    ) -> Result<Self, LcpError> {
        let mut system = LcpProblem::new(
            parts.weights,
            ConstraintSet::new(&contacts.rows, contacts.schedule()),
            ConstraintSet::default(),
            ConstraintSet::serial(&contacts.friction),
        )?;
        if !contacts.friction.is_empty() {
            system = system.attach_friction(&contacts.friction_of)?;
        }
        parts.spread.clear();
        parts.spread.resize(contacts.rows.len(), false);
        parts.live.clear();
        parts.live.start(parts.edges);
        let mut rows = Self { scene, state, parts, contacts: system, y, lambda, friction };
        for &v in rows.parts.damped {
            rows.touch(v);
        }
        rows.spread();
        rows.with_system(|rows, state| lcp::apply_multipliers(&rows.system, state))?;
        rows.look();
        Ok(rows)
    }

    /// Makes `sweeps` calls of `sweep`, which may change multipliers, and y with them; a few more if edges
    /// were found violated in the end that were not swept before.
    ///
    /// # Errors
    /// The first error of `sweep`.
    pub fn sweep(
        &mut self,
        sweeps: usize,
        mut sweep: impl FnMut(&LiveSystem<'_>, &mut LcpState<'_>) -> Result<(), LcpError>,
    ) -> Result<(), LcpError> {
        let mut done = 0;
        let mut end = sweeps;
        while done < end {
            self.with_system(&mut sweep)?;
            done += 1;
            self.spread();
            if self.look() && done == sweeps {
                end += MORE_SWEEPS;
            }
        }
        Ok(())
    }

    /// Lists the watched edges that are violated at y; returns whether there are any.
    fn look(&mut self) -> bool {
        let LiveParts { edges, live, .. } = &mut self.parts;
        let found = live.look(edges, self.y);
        live.list_all_if_most(edges);
        found
    }

    /// Largest ratio of the length of an edge at y to its limit, at least 1.
    pub fn stretch(&self) -> f64 {
        let length = |[a, b]: [u32; 2]| (self.y[a as usize] - self.y[b as usize]).norm();
        let limits = self.parts.live.limits.iter();
        limits.map(|limit| length(limit.vertices) / limit.limit).fold(1.0, f64::max)
    }

    /// Ends the step: keeps the multipliers of the edges.
    pub(crate) fn finish(self) {
        self.parts.live.finish();
    }

    fn with_system<T>(
        &mut self,
        run: impl FnOnce(&LiveSystem<'_>, &mut LcpState<'_>) -> Result<T, LcpError>,
    ) -> Result<T, LcpError> {
        let Self { parts: LiveParts { edges, live, touched, free, .. }, contacts, .. } = self;
        let schedule = if live.all { Schedule::colored(edges.color_starts()) } else { Schedule::SERIAL };
        let system = contacts.with_distance_limits(ConstraintSet::new(&live.limits, schedule))?;
        let mut state = LcpState {
            y: self.y,
            lambda: self.lambda,
            limit_multipliers: &mut live.multipliers,
            friction: self.friction,
        };
        run(&LiveSystem { system, free, touched: touched.members() }, &mut state)
    }

    /// Touches the vertices of all rows and edges with a multiplier.
    fn spread(&mut self) {
        let rows = self.contacts.rows().rows;
        for k in 0..rows.len() {
            if self.lambda[k] != 0.0 && !self.parts.spread[k] {
                self.parts.spread[k] = true;
                rows[k].vertices.iter().for_each(|&v| self.touch(v));
            }
        }
        for k in 0..self.parts.live.list.len() {
            if !self.parts.live.spread[k] && self.parts.live.multipliers[k] != Vector::zeros() {
                self.parts.live.spread[k] = true;
                let vertices = self.parts.live.limits[k].vertices;
                vertices.iter().for_each(|&v| self.touch(v));
            }
        }
    }

    /// Touches a vertex: its edges are watched.
    fn touch(&mut self, vertex: u32) {
        let LiveParts { edges, live, touched, .. } = &mut self.parts;
        if self.contacts.weights()[vertex as usize] > 0.0 && touched.insert(vertex) {
            for &edge in edges.of_vertex(vertex) {
                if live.places[edge as usize] == NONE {
                    live.places[edge as usize] = WATCHED;
                    live.watched.push(edge);
                }
            }
        }
    }
}
