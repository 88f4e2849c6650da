//! The problem as it is stated, apart from any method: the nearest point to the target in the metric of mass at
//! which all pairs keep their contact distances and all edges their limits.
//!
//! Lengths are data of the problem and come from its scene. What is near, distances, their gradients, and which
//! pairs share a vertex are the judge's (`bowknot::check`), whose code no method uses.
//!
//! - The contact distance of a pair is delta, for pairs of one connected component at most half of their distance
//!   at rest, and at most their distance at the start plus `growth`.
//! - The limit of an edge is its length at rest times sigma, or 0.97 of its length at the start if that is more. Edges
//!   between pins that are too far apart have limits of their own, which the case names.

use crate::case::CollisionCase;
use anyhow::Result;
use bowknot::check::{Judge, NearPair, PairClass};
use bowknot::geometry::{PairKind, Point, Vector};
use bowknot::proximity::Pair;
use bowknot::twoway::{CallInput, CollisionScene};
use std::cell::RefCell;
use std::collections::HashMap;

/// Smallest ratio of an edge's limit to its length at the start.
const START_SHARE: f64 = 0.97;

/// What a constraint is about: a pair of elements, or an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum About {
    Pair(PairClass, [u32; 2]),
    Edge(u32),
}

/// A constraint at a state: its value must not be negative.
#[derive(Clone, Copy, Debug)]
pub struct Constraint {
    pub about: About,
    /// Its vertices; unused places repeat the first one, with a gradient of 0.
    pub vertices: [u32; 4],
    /// Derivatives of the value by the positions.
    pub gradients: [Vector; 4],
    /// Distance less contact distance, or limit less length [m].
    pub value: f64,
    /// The contact distance, or the limit [m].
    pub length: f64,
}

/// A limited edge.
#[derive(Clone, Copy, Debug)]
struct LimitedEdge {
    vertices: [u32; 2],
    limit: f64,
    rest: f64,
    start: f64,
}

/// A problem.
#[derive(Debug)]
pub struct Statement<'a> {
    pub case: &'a CollisionCase,
    pub scene: CollisionScene,
    pub judge: Judge,
    /// Masses relative to their mean [1]; 0 for prescribed vertices.
    pub masses: Vec<f64>,
    edges: Vec<LimitedEdge>,
    growth: f64,
    /// The contact distances of pairs that have been near [m].
    contact_distances: RefCell<HashMap<(PairClass, [u32; 2]), f64>>,
}

impl<'a> Statement<'a> {
    /// # Errors
    /// If the case has unsound parameters.
    pub fn new(case: &'a CollisionCase) -> Result<Self> {
        let (scene, call) = case.reference()?;
        let masses = |v: usize| if call.is_movable(v) { scene.relative_mass(v) } else { 0.0 };
        Ok(Self {
            case,
            masses: (0..case.states.x.len()).map(masses).collect(),
            judge: Judge::from_model(&case.model),
            edges: limited_edges(case, &scene, &call),
            growth: case.states.time_step.map_or(f64::INFINITY, |dt| scene.lengths().separation_speed * dt),
            scene,
            contact_distances: RefCell::default(),
        })
    }

    /// Whether a vertex is not prescribed.
    pub fn is_movable(&self, vertex: usize) -> bool {
        self.masses[vertex] > 0.0
    }

    /// The constraints of all pairs at most `reach` apart at `x` [m], then those of all edges.
    ///
    /// # Errors
    /// If `x` does not fit the case.
    pub fn constraints(&self, x: &[Point], reach: f64) -> Result<Vec<Constraint>> {
        Ok(self.constraints_of(&self.judge.pairs_within(x, reach)?, x, reach))
    }

    /// The same of those pairs among `near`, which were found at another state.
    pub fn constraints_of(&self, near: &[NearPair], x: &[Point], reach: f64) -> Vec<Constraint> {
        let measured = |pair: &NearPair| {
            let (places, distance) = self.judge.measured(pair.class, pair.elements, x);
            (distance <= reach).then(|| self.pair(&NearPair { places, distance, ..*pair }, x))
        };
        let pairs = near.iter().filter_map(measured);
        pairs.chain((0..self.edges.len()).map(|e| self.edge(e, x))).collect()
    }

    /// The largest distance up to which pairs count as near [m].
    pub fn range(&self) -> f64 {
        let lengths = self.scene.lengths();
        lengths.contact_range / lengths.delta * self.scene.spacing().largest_delta()
    }

    /// Largest ratios of edge lengths to their limits, to those at the start and to those at rest.
    pub fn stretch(&self, x: &[Point]) -> [f64; 3] {
        if self.edges.is_empty() {
            return [1.0; 3];
        }
        let mut largest = [0.0f64; 3];
        for edge in &self.edges {
            let length = (x[edge.vertices[0] as usize] - x[edge.vertices[1] as usize]).norm();
            for (largest, of) in largest.iter_mut().zip([edge.limit, edge.start, edge.rest]) {
                *largest = largest.max(length / of);
            }
        }
        largest
    }

    /// Derivatives of a pair's distance by its vertices; `places` are its closest points.
    fn gradients(
        &self,
        class: PairClass,
        elements: [u32; 2],
        places: &[Point; 2],
        x: &[Point],
    ) -> [Vector; 4] {
        let sides = self.judge.sides(class, elements);
        let direction = match class {
            PairClass::VertexHalfSpace => self.case.model.half_spaces()[elements[1] as usize].normal,
            _ => (places[0] - places[1]).try_normalize(0.0).unwrap_or_else(Vector::zeros),
        };
        let mut gradients = [Vector::zeros(); 4];
        for (side, sign) in [(0, 1.0), (1, -1.0)] {
            let first = side * sides[0].len();
            for (k, weight) in
                weights(sides[side], &places[side], x).into_iter().take(sides[side].len()).enumerate()
            {
                gradients[first + k] = direction * (sign * weight);
            }
        }
        gradients
    }

    fn pair(&self, near: &NearPair, x: &[Point]) -> Constraint {
        let NearPair { class, elements, places, distance } = *near;
        let vertices = flat(self.judge.sides(class, elements));
        let gradients = self.gradients(class, elements, &places, x);
        let mut known = self.contact_distances.borrow_mut();
        let delta = *known
            .entry((class, elements))
            .or_insert_with(|| self.contact_distance(class, elements, vertices));
        let about = About::Pair(class, elements);
        Constraint { about, vertices, gradients, value: distance - delta, length: delta }
    }

    fn contact_distance(&self, class: PairClass, elements: [u32; 2], vertices: [u32; 4]) -> f64 {
        let (model, kind) = (self.scene.model(), class.kind());
        let mut delta = self.scene.spacing().of(model, kind, &Pair { elements, vertices }).delta;
        let component = |place: usize| model.vertex_component()[vertices[place] as usize];
        if kind != PairKind::VertexHalfSpace && component(0) == component(kind.side_a()) {
            delta = delta.min(0.5 * self.judge.measured(class, elements, self.scene.rest()).1);
        }
        let start = self.judge.measured(class, elements, &self.case.states.x).1;
        delta.min(start.max(0.0) + self.growth)
    }

    fn edge(&self, e: usize, x: &[Point]) -> Constraint {
        let LimitedEdge { vertices: [a, b], limit, .. } = self.edges[e];
        let edge = x[a as usize] - x[b as usize];
        let length = edge.norm();
        let along = edge.try_normalize(0.0).unwrap_or_else(Vector::zeros);
        Constraint {
            about: About::Edge(e as u32),
            vertices: [a, b, a, a],
            gradients: [-along, along, Vector::zeros(), Vector::zeros()],
            value: limit - length,
            length: limit,
        }
    }
}

fn limited_edges(case: &CollisionCase, scene: &CollisionScene, call: &CallInput) -> Vec<LimitedEdge> {
    let topology = case.model.topology();
    let ascending = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
    let own: HashMap<[u32; 2], f64> =
        call.yielding().iter().map(|edge| (ascending(edge.vertices), edge.limit)).collect();
    let length = |[a, b]: [u32; 2], x: &[Point]| (x[a as usize] - x[b as usize]).norm();
    let limited = |&vertices: &[u32; 2]| -> Option<LimitedEdge> {
        let sigma = scene.stretch_limit(case.model.vertex_body()[vertices[0] as usize]);
        let moves = vertices.iter().any(|&v| call.is_movable(v as usize));
        let (rest, start) = (length(vertices, scene.rest()), length(vertices, &case.states.x));
        let own = own.get(&ascending(vertices)).copied().unwrap_or(0.0);
        let limit = (sigma * rest).max(START_SHARE * start).max(own);
        (moves && sigma < f64::INFINITY).then_some(LimitedEdge { vertices, limit, rest, start })
    };
    topology.edges.iter().filter_map(limited).collect()
}

/// The vertices of both sides; unused places repeat the first.
fn flat(sides: [&[u32]; 2]) -> [u32; 4] {
    let mut vertices = [sides[0][0]; 4];
    vertices.iter_mut().zip(sides.concat()).for_each(|(to, v)| *to = v);
    vertices
}

/// Barycentric coordinates of a point of a vertex, edge or triangle.
fn weights(vertices: &[u32], place: &Point, x: &[Point]) -> [f64; 3] {
    let at = |k: usize| x[vertices[k] as usize];
    match vertices.len() {
        2 => {
            let edge = at(1) - at(0);
            let share =
                (edge.dot(&(place - at(0))) / edge.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            [1.0 - share, share, 0.0]
        }
        3 => {
            let [a, b, c] = [at(0) - place, at(1) - place, at(2) - place];
            let normal = (at(1) - at(0)).cross(&(at(2) - at(0)));
            let parts = [b.cross(&c), c.cross(&a), a.cross(&b)].map(|area| area.dot(&normal).max(0.0));
            let sum = parts.iter().sum::<f64>().max(f64::MIN_POSITIVE);
            parts.map(|part| part / sum)
        }
        _ => [1.0, 0.0, 0.0],
    }
}
