//! The proximal term of the backward stage: how much of the curvature that linearising drops it puts back.
//!
//! Moving an edge of length |e| that carries a multiplier lambda sideways costs lambda/|e|. A contact's normal turns with
//! the local edge length h where a face or two crossing edges make it, but with the distance d itself where a vertex or
//! one of two parallel edges does: grains and hairs roll about each other. With h in place of d they never came to rest.

use crate::{Problem, State};
use bowknot_constraints::EdgeForm;
use bowknot_geometry::{PairKind, Point, Separation, Vector};
use bowknot_lcp::DistanceLimit;

/// Most of the term, in the mass of its vertex. It is made of multipliers, and the heavier a vertex, the larger the multipliers
/// that move it: without a bound both grow for ever where limits ask for more than a fraction of an edge, and x stays where
/// it is, short of them.
pub(crate) const MOST_DRAG: f64 = 100.0;

/// A closest point is at a vertex if the other weights of its side are below this.
const AT_VERTEX: f64 = 1e-6;

/// Adds the curvature of the edge limits to `proximal`, one entry a vertex [1]. Multipliers are `forces` in the ball form,
/// `scalars` in the linear one [m].
pub(crate) fn add_edges(
    proximal: &mut [f64],
    problem: &Problem,
    state: &State,
    balls: &[DistanceLimit],
    forces: &[Vector],
    scalars: &[f64],
) {
    let strength = problem.params.backward.edge_proximal;
    if strength == 0.0 {
        return;
    }
    for (k, ball) in balls.iter().enumerate() {
        let lambda = match problem.params.constraints.edge_form {
            EdgeForm::Ball => forces[k].norm(),
            EdgeForm::Linear => scalars[k],
        };
        if lambda > 0.0 {
            let [a, b] = ball.vertices.map(|v| v as usize);
            let length = (state.x[a] - state.x[b]).norm().max(f64::MIN_POSITIVE);
            let mu = strength * lambda / length;
            proximal[a] += mu;
            proximal[b] += mu;
        }
    }
}

/// Adds the curvature of the contacts.
pub(crate) fn add_contacts(proximal: &mut [f64], problem: &Problem, state: &State) {
    let strength = problem.params.backward.contact_proximal;
    if strength == 0.0 {
        return;
    }
    let contacts = &state.contacts;
    for kind in PairKind::ALL {
        for p in contacts.pairs.range(kind) {
            let lambda = contacts.multipliers[p];
            if lambda == 0.0 {
                continue;
            }
            let (vertices, separation) = (&contacts.pairs.pairs()[p].vertices, &contacts.separations[p]);
            let sharpness = sharpness(kind, separation, vertices, &state.x);
            let distance = separation.distance.max(contacts.desired[p]);
            for k in 0..kind.vertex_count() {
                let v = vertices[k] as usize;
                let radius = turning_radius(sharpness, distance, problem.local_edge[v]);
                proximal[v] += strength * lambda * separation.weights[k] / radius;
            }
        }
    }
}

/// Factor on a vertex's proximal weight each time that the way it wants turns back, and each time that it does not. Tried
/// on states of hard contact: 1.5 to 3 and 0.7 to 0.9 differ by less than the scenes do.
const GROWTH: f64 = 2.0;
const RELIEF: f64 = 0.8;

/// What makes a pair's normal.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Sharpness {
    /// A face.
    Face,
    /// Two edges that cross at an angle of this sine.
    Crossing(f64),
    /// A vertex and an edge.
    Edge,
    /// Two vertices.
    Point,
}

fn sharpness(kind: PairKind, separation: &Separation, vertices: &[u32; 4], x: &[Point]) -> Sharpness {
    let inside = |weights: &[f64]| weights.iter().filter(|w| **w > AT_VERTEX).count();
    let w = &separation.weights;
    let (a, b) = match kind {
        PairKind::VertexHalfSpace => return Sharpness::Face,
        PairKind::VertexVertex => (1, 1),
        PairKind::VertexEdge => (1, inside(&w[1..3])),
        PairKind::VertexTriangle => (1, inside(&w[1..4])),
        PairKind::EdgeEdge => (inside(&w[..2]), inside(&w[2..])),
    };
    match (a, b) {
        (2, 2) => {
            let edge = |k: usize| x[vertices[k] as usize] - x[vertices[k + 1] as usize];
            let (first, second) = (edge(0), edge(2));
            let area = first.cross(&second).norm();
            Sharpness::Crossing(area / (first.norm() * second.norm()).max(f64::MIN_POSITIVE))
        }
        (1, 3) => Sharpness::Face,
        (1, 2) | (2, 1) => Sharpness::Edge,
        _ => Sharpness::Point,
    }
}

/// How far a vertex moves while the normal turns by about one radian [m], for a pair of vertices `distance` apart and edges
/// of length `edge`.
fn turning_radius(sharpness: Sharpness, distance: f64, edge: f64) -> f64 {
    match sharpness {
        Sharpness::Face => edge,
        Sharpness::Crossing(sine) => (edge * sine).max(distance).min(edge),
        Sharpness::Edge => distance.min(edge),
        Sharpness::Point => distance,
    }
}

/// A factor on the proximal weight of each vertex. Where the way that a vertex wants turns back from one step to the next, y
/// swings about its place: the term is too small there.
#[derive(Debug, Default)]
pub(crate) struct Caution {
    factors: Vec<f64>,
    wanted: Vec<Vector>,
}

impl Caution {
    /// Starts a call.
    pub fn begin(&mut self, problem: &Problem) {
        let vertices = if problem.params.backward.proximal_growth > 1.0 { problem.rest.len() } else { 0 };
        self.factors.clear();
        self.factors.resize(vertices, 1.0);
        self.wanted.clear();
        self.wanted.resize(vertices, Vector::zeros());
    }

    pub fn apply(&self, proximal: &mut [f64]) {
        proximal.iter_mut().zip(&self.factors).for_each(|(mu, factor)| *mu *= factor);
    }

    /// Looks at what y has become.
    pub fn learn(&mut self, problem: &Problem, state: &State) {
        let largest = problem.params.backward.proximal_growth;
        for v in 0..self.factors.len() {
            let wanted = state.y[v] - state.x[v];
            let before = std::mem::replace(&mut self.wanted[v], wanted);
            let factor = &mut self.factors[v];
            let turn = wanted.dot(&before);
            if turn < 0.0 {
                *factor = (*factor * GROWTH).min(largest);
            } else if turn > 0.0 {
                *factor = (*factor * RELIEF).max(1.0);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Params, Resolver};
    use bowknot_geometry::{Topology, separation};
    use bowknot_proximity::CollisionModel;

    const H: f64 = 0.01;
    const D: f64 = 0.001;

    fn radius(kind: PairKind, points: [[f64; 3]; 4]) -> f64 {
        let x = points.map(Point::from);
        let sharpness = sharpness(kind, &separation::separate(kind, &x), &[0, 1, 2, 3], &x);
        turning_radius(sharpness, D, H)
    }

    #[test]
    fn a_normal_turns_with_edges_above_a_face_and_with_the_distance_at_vertices() {
        let triangle = [[0.0, 0.0, 0.0], [H, 0.0, 0.0], [0.0, H, 0.0]];
        let over = |x: f64, y: f64| {
            radius(PairKind::VertexTriangle, [[x, y, D], triangle[0], triangle[1], triangle[2]])
        };
        assert_eq!(over(0.2 * H, 0.2 * H), H);
        assert_eq!(over(0.4 * H, -D), D, "beside an edge");
        assert_eq!(over(-D, -D), D, "beside a corner");
    }

    #[test]
    fn the_more_parallel_two_edges_are_the_faster_their_normal_turns() {
        let crossed = |angle: f64| {
            let (s, c) = angle.sin_cos();
            let along = [0.5 * H * c, 0.5 * H * s];
            let second = [[-along[0], -along[1], 0.0], [along[0], along[1], 0.0]];
            radius(PairKind::EdgeEdge, [[-0.5 * H, 0.0, D], [0.5 * H, 0.0, D], second[0], second[1]])
        };
        assert!((crossed(std::f64::consts::FRAC_PI_2) - H).abs() < 1e-12);
        assert!((crossed(0.5) - H * 0.5f64.sin()).abs() < 1e-12);
        assert!((crossed(0.05) - D).abs() < 1e-12, "nearly parallel");
    }

    #[test]
    fn caution_grows_where_the_target_swings_and_falls_where_it_does_not() {
        let x = vec![Point::origin(), Point::new(1.0, 0.0, 0.0)];
        let topology = Topology::builder(2).particles([0, 1]).build().unwrap();
        let model = CollisionModel::single_body(topology);
        let resolver = Resolver::new(model, &x, &[1.0; 2], Params::fast()).unwrap();
        let problem = resolver.problem();
        let mut state = State { x: x.clone(), y: x.clone(), ..State::default() };
        let mut caution = Caution::default();
        caution.begin(problem);
        let mut weights = |way: f64| {
            state.y = vec![x[0] + way * Vector::x(), x[1] + Vector::x()];
            caution.learn(problem, &state);
            let mut proximal = [1.0; 2];
            caution.apply(&mut proximal);
            proximal
        };
        assert_eq!(weights(1.0), [1.0, 1.0]);
        assert_eq!(weights(-1.0), [2.0, 1.0]);
        assert_eq!(weights(1.0), [4.0, 1.0]);
        assert_eq!(weights(1.0), [3.2, 1.0]);
        for k in 0..20 {
            weights(if k % 2 == 0 { -1.0 } else { 1.0 });
        }
        assert_eq!(weights(-1.0), [32.0, 1.0], "bounded");
    }
}
