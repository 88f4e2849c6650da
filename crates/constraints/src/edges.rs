//! Edge-length limits (paper, Eq. 17): every edge with a movable vertex.

use crate::coloring::Coloring;
use crate::params::EdgeReference;
use bowknot_geometry::{Point, Topology, Vector};
use bowknot_lcp::{DistanceLimit, Row};
use rayon::prelude::*;

/// Smallest ratio of an edge's limit to its length at the start of the call. An edge that starts longer than
/// its limit is shortened a little in each call, because asking for all of it at once is infeasible and
/// diverges.
const START_SHARE: f64 = 0.97;

/// Fewest edges of a parallel task.
const CHUNK: usize = 4096;

/// Edge-length limits in color order.
#[derive(Clone, Debug, Default)]
pub struct EdgeLimits {
    /// Vertices of each edge and its largest length in this call, L [m].
    pub balls: Vec<DistanceLimit>,
    /// Rest length of each edge [m].
    pub rest_lengths: Vec<f64>,
    /// Length of each edge at the start of the call [m].
    pub start_lengths: Vec<f64>,
    /// Largest ratio of each edge's length to its reference length, sigma [1].
    pub stretch_limits: Vec<f64>,
    color_starts: Vec<u32>,
    /// The edges of each vertex: `incident[incident_starts[v]..incident_starts[v + 1]]`.
    incident: Vec<u32>,
    incident_starts: Vec<u32>,
}

impl EdgeLimits {
    /// Collects and colors the edges with at least one movable vertex and a finite `stretch_limit`, the
    /// largest ratio of an edge's length to its reference length. Other edges have no row.
    pub fn new(
        topology: &Topology,
        rest: &[Point],
        movable: &[bool],
        stretch_limit: impl Fn(&[u32; 2]) -> f64,
    ) -> Self {
        let limited =
            |e: &[u32; 2]| e.iter().any(|&v| movable[v as usize]) && stretch_limit(e) < f64::INFINITY;
        let edges: Vec<[u32; 2]> = topology.edges.iter().copied().filter(limited).collect();
        let mut coloring = Coloring::default();
        coloring
            .first_fit(movable.len(), edges.len(), |r| edges[r].into_iter().filter(|&v| movable[v as usize]));
        let vertices = coloring.order().iter().map(|&r| edges[r as usize]);
        let balls: Vec<DistanceLimit> =
            vertices.map(|e| DistanceLimit { vertices: e, limit: length(&e, rest) }).collect();
        let rest_lengths: Vec<f64> = balls.iter().map(|b| b.limit).collect();
        let (incident, incident_starts) = incident_edges(&balls, movable.len());
        Self {
            incident,
            incident_starts,
            stretch_limits: balls.iter().map(|b| stretch_limit(&b.vertices)).collect(),
            start_lengths: rest_lengths.clone(),
            rest_lengths,
            balls,
            color_starts: coloring.starts().to_vec(),
        }
    }

    /// Limit of an edge in a call [m]. Its length at the start is `start` [m]; `limit` is its rest length
    /// times sigma [m].
    pub fn of_rest(limit: f64, start: f64) -> f64 {
        limit.max(START_SHARE * start)
    }

    /// Sets the limits of a call that starts at `positions`.
    pub fn begin(&mut self, positions: &[Point], reference: EdgeReference) {
        let Self { balls, rest_lengths, start_lengths, stretch_limits, .. } = self;
        let edges = balls.par_iter_mut().zip(start_lengths.par_iter_mut());
        let fixed = rest_lengths.par_iter().zip(stretch_limits.par_iter());
        edges.zip(fixed).with_min_len(CHUNK).for_each(|((ball, start_length), (rest, stretch_limit))| {
            let start = length(&ball.vertices, positions);
            *start_length = start;
            ball.limit = match reference {
                EdgeReference::Start => stretch_limit * start,
                EdgeReference::Rest => Self::of_rest(stretch_limit * rest, start),
            };
        });
    }

    /// Lets edges be as long as the entries say [m] if that is more than they may be. Other entries change
    /// nothing.
    pub fn let_yield(&mut self, longer: &[DistanceLimit]) {
        for DistanceLimit { vertices: [a, b], limit } in longer {
            let edge =
                self.of_vertex(*a).iter().find(|&&e| self.balls[e as usize].vertices.contains(b)).copied();
            if let Some(edge) = edge {
                let ball = &mut self.balls[edge as usize];
                ball.limit = ball.limit.max(*limit);
            }
        }
    }

    /// Lets some edges be longer by a factor: those that the target keeps within their limits itself.
    pub fn widen(&mut self, factor: f64, is_known: impl Fn(&[u32; 2]) -> bool + Sync) {
        let edges = self.balls.par_iter_mut().with_min_len(CHUNK);
        edges.filter(|ball| is_known(&ball.vertices)).for_each(|ball| ball.limit *= factor);
    }

    /// The edges of a vertex, ascending. Cost: constant.
    pub fn of_vertex(&self, vertex: u32) -> &[u32] {
        match self.incident_starts.get(vertex as usize..vertex as usize + 2) {
            Some(&[start, end]) => &self.incident[start as usize..end as usize],
            // Without any limits the vertices are not known.
            _ => &[],
        }
    }

    /// Appends the limits as rows linearized at `positions` (paper, Eq. 17, in units of length):
    /// s(y) = L - |e| - e/|e| . ((y_a - y_b) - (x_a - x_b)), e = x_a - x_b. Same order and colors.
    pub fn linearize(&self, positions: &[Point], rows: &mut Vec<Row>) {
        rows.extend(self.balls.iter().map(|ball| {
            let [a, b] = ball.vertices;
            let edge = positions[a as usize] - positions[b as usize];
            let length = edge.norm();
            let direction = if length > 0.0 { edge / length } else { Vector::zeros() };
            let gradients = [-direction, direction, Vector::zeros(), Vector::zeros()];
            // L - |e| + e/|e| . e: the linear part at x cancels the length.
            Row::new([a, b, a, a], gradients, ball.limit - length + direction.dot(&edge))
        }));
    }

    /// Largest ratios of an edge's length at `positions` to its limit, to its length at the start, and to its
    /// rest length. Each is 1 if there is no edge.
    pub fn stretch(&self, positions: &[Point]) -> Stretch {
        if self.balls.is_empty() {
            return Stretch { to_limit: 1.0, to_start: 1.0, to_rest: 1.0 };
        }
        let of_edge = |k: usize| {
            let now = length(&self.balls[k].vertices, positions);
            Stretch {
                to_limit: ratio(now, self.balls[k].limit),
                to_start: ratio(now, self.start_lengths[k]),
                to_rest: ratio(now, self.rest_lengths[k]),
            }
        };
        let none = || Stretch { to_limit: 0.0, to_start: 0.0, to_rest: 0.0 };
        (0..self.balls.len()).into_par_iter().with_min_len(CHUNK).map(of_edge).reduce(none, Stretch::larger)
    }

    /// Where each color starts, and the end.
    pub fn color_starts(&self) -> &[u32] {
        &self.color_starts
    }

    /// Number of colors.
    pub fn color_count(&self) -> usize {
        self.color_starts.len().saturating_sub(1)
    }
}

/// Largest ratios of edge lengths, see [`EdgeLimits::stretch`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// To the limit of the call.
    pub to_limit: f64,
    /// To the length at the start of the call.
    pub to_start: f64,
    /// To the rest length.
    pub to_rest: f64,
}

impl Stretch {
    /// The larger of each ratio.
    fn larger(self, other: Self) -> Self {
        Self {
            to_limit: self.to_limit.max(other.to_limit),
            to_start: self.to_start.max(other.to_start),
            to_rest: self.to_rest.max(other.to_rest),
        }
    }
}

/// The edges of each vertex, and where those of each vertex start.
fn incident_edges(balls: &[DistanceLimit], vertex_count: usize) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0; vertex_count + 1];
    for v in balls.iter().flat_map(|ball| ball.vertices) {
        starts[v as usize + 1] += 1;
    }
    (1..starts.len()).for_each(|v| starts[v] += starts[v - 1]);
    let mut next = starts.clone();
    let mut incident = vec![0; 2 * balls.len()];
    for (edge, ball) in balls.iter().enumerate() {
        for v in ball.vertices {
            incident[next[v as usize] as usize] = edge as u32;
            next[v as usize] += 1;
        }
    }
    (incident, starts)
}

fn length(edge: &[u32; 2], positions: &[Point]) -> f64 {
    (positions[edge[0] as usize] - positions[edge[1] as usize]).norm()
}

fn ratio(now: f64, reference: f64) -> f64 {
    if reference > 0.0 { now / reference } else { 1.0 }
}
