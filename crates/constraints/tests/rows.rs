//! Values and gradients of contact and edge rows against finite differences and closed forms.

use bowknot_constraints::{ContactForm, DeltaRule, EdgeLimits, EdgeReference, contact_row};
use bowknot_geometry::{PairKind, Point, Topology, Vector, distance, separation};
use bowknot_lcp::{DistanceLimit, Row};
use bowknot_proximity::{CollisionModel, Pair};

/// Seeded random numbers.
struct Random(fastrand::Rng);

impl Random {
    fn new(seed: u64) -> Self {
        Self(fastrand::Rng::with_seed(seed))
    }

    /// Uniform in [-1, 1).
    fn next(&mut self) -> f64 {
        2.0 * self.0.f64() - 1.0
    }

    fn vector(&mut self) -> Vector {
        Vector::new(self.next(), self.next(), self.next())
    }
}

fn row_at(form: ContactForm, kind: PairKind, x: &[Point; 4], delta: f64) -> Row {
    contact_row(form, kind, [0, 1, 2, 3], x, &separation::separate(kind, x), delta)
}

fn value(row: &Row, x: &[Point; 4]) -> f64 {
    row.value(&x.map(|p| p.coords))
}

/// Pairs whose closest points are interior, so that distance and volume agree to first order.
fn interior_pair(kind: PairKind, random: &mut Random) -> [Point; 4] {
    let jitter = |p: [f64; 3], r: &mut Random| Point::from(Vector::from(p) + 0.15 * r.vector());
    let flat = match kind {
        PairKind::VertexTriangle => [[0.3, 0.3, 0.6], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        PairKind::EdgeEdge => [[-1.0, 0.0, 0.6], [1.0, 0.0, 0.6], [0.0, -1.0, 0.0], [0.0, 1.0, 0.0]],
        PairKind::VertexEdge => [[0.0, 0.0, 0.6], [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [9.0, 9.0, 9.0]],
        _ => [[0.0, 0.0, 0.6], [0.1, 0.2, 0.0], [9.0, 9.0, 9.0], [9.0, 9.0, 9.0]],
    };
    flat.map(|p| jitter(p, random))
}

const KINDS: [PairKind; 4] =
    [PairKind::VertexVertex, PairKind::VertexEdge, PairKind::VertexTriangle, PairKind::EdgeEdge];

/// The quantity that the volume form linearizes: height over a base of constant size, minus a constant.
fn height(kind: PairKind, x: &[Point; 4], base: f64) -> f64 {
    match kind {
        PairKind::VertexTriangle => ((x[0] - x[1]).dot(&(x[2] - x[1]).cross(&(x[3] - x[1]))) / base).abs(),
        PairKind::EdgeEdge => ((x[0] - x[2]).dot(&(x[1] - x[0]).cross(&(x[3] - x[2]))) / base).abs(),
        PairKind::VertexEdge => (x[0] - x[1]).cross(&(x[2] - x[1])).norm() / base,
        _ => (x[0] - x[1]).norm(),
    }
}

fn base(kind: PairKind, x: &[Point; 4]) -> f64 {
    match kind {
        PairKind::VertexTriangle => (x[2] - x[1]).cross(&(x[3] - x[1])).norm(),
        PairKind::EdgeEdge => (x[1] - x[0]).cross(&(x[3] - x[2])).norm(),
        PairKind::VertexEdge => (x[2] - x[1]).norm(),
        _ => 1.0,
    }
}

#[test]
fn both_forms_have_the_value_and_gradient_of_what_they_linearize() {
    let mut random = Random::new(7);
    for kind in KINDS {
        for _ in 0..200 {
            let x = interior_pair(kind, &mut random);
            let d = distance::closest(kind, &x).distance;
            let delta = 0.1 + 0.05 * random.next();
            let base = base(kind, &x);
            for form in [ContactForm::Gap, ContactForm::Volume] {
                let row = row_at(form, kind, &x, delta);
                let quantity = |x: &[Point; 4]| match form {
                    ContactForm::Gap => distance::closest(kind, x).distance,
                    _ => height(kind, x, base),
                };
                // Gap form: c = d - delta; volume c = height (1 - delta/d), equal for interior points.
                let expected = quantity(&x) * (1.0 - delta / d);
                assert!(
                    (value(&row, &x) - expected).abs() < 1e-9,
                    "{kind:?} {form:?}: {} {expected}",
                    value(&row, &x)
                );
                for k in 0..kind.vertex_count() {
                    for axis in 0..3 {
                        let step = 1e-6;
                        let (mut plus, mut minus) = (x, x);
                        plus[k][axis] += step;
                        minus[k][axis] -= step;
                        let slope = (quantity(&plus) - quantity(&minus)) / (2.0 * step);
                        let given = row.gradients[k][axis];
                        assert!(
                            (slope - given).abs() < 1e-6,
                            "{kind:?} {form:?} vertex {k}: {slope} {given}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn the_face_form_is_the_gap_form_above_interiors_and_blocks_motion_beside_them() {
    let mut random = Random::new(5);
    let mut compared = 0;
    for kind in KINDS {
        for _ in 0..50 {
            let x = interior_pair(kind, &mut random);
            let weights = separation::separate(kind, &x).weights;
            if weights[..kind.vertex_count()].iter().any(|w| *w < 1e-3) {
                continue;
            }
            compared += 1;
            let (face, gap) =
                (row_at(ContactForm::Face, kind, &x, 0.1), row_at(ContactForm::Gap, kind, &x, 0.1));
            assert!((value(&face, &x) - value(&gap, &x)).abs() < 1e-12, "{kind:?}");
            for k in 0..4 {
                assert!((face.gradients[k] - gap.gradients[k]).norm() < 1e-9, "{kind:?}");
            }
        }
    }
    assert!(compared > 150, "{compared}");
    // A vertex beside a triangle, almost in its plane: half a meter away, but the row asks for more height.
    let x = [[1.5, 0.0, -0.01], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point::from);
    let row = row_at(ContactForm::Face, PairKind::VertexTriangle, &x, 0.1);
    assert!((value(&row, &x) - (0.01 - 0.1)).abs() < 1e-12, "{}", value(&row, &x));
    assert!((row.gradients[0] + Vector::z()).norm() < 1e-12, "{:?}", row.gradients);
    // Parallel edges have no common normal.
    let x = [[0.0, 0.0, 0.5], [1.0, 0.0, 0.5], [0.2, 0.0, 0.0], [1.2, 0.0, 0.0]].map(Point::from);
    let row = row_at(ContactForm::Face, PairKind::EdgeEdge, &x, 0.1);
    assert!((value(&row, &x) - 0.4).abs() < 1e-9);
}

#[test]
fn gradients_conserve_linear_momentum_and_unused_places_have_none() {
    let mut random = Random::new(11);
    for kind in KINDS {
        for form in [ContactForm::Gap, ContactForm::Volume, ContactForm::Face] {
            for _ in 0..100 {
                let x = [(); 4].map(|()| Point::from(random.vector()));
                let row = row_at(form, kind, &x, 0.1);
                let sum: Vector = row.gradients.iter().sum();
                assert!(sum.norm() < 1e-10, "{kind:?} {form:?}: {sum:?}");
                for k in kind.vertex_count()..4 {
                    assert_eq!(row.gradients[k], Vector::zeros());
                }
            }
        }
    }
}

#[test]
fn the_gap_form_replaces_the_volume_form_where_the_closest_feature_is_not_the_interior() {
    // A vertex beside a triangle, in its plane: its volume is 0 at any distance.
    let x = [[2.0, 0.2, 0.001], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point::from);
    let row = row_at(ContactForm::Volume, PairKind::VertexTriangle, &x, 0.1);
    let d = distance::closest(PairKind::VertexTriangle, &x).distance;
    assert!((value(&row, &x) - (d - 0.1)).abs() < 1e-9);
    // Parallel edges have no volume either.
    let x = [[0.0, 0.0, 0.5], [1.0, 0.0, 0.5], [0.2, 0.0, 0.0], [1.2, 0.0, 0.0]].map(Point::from);
    let row = row_at(ContactForm::Volume, PairKind::EdgeEdge, &x, 0.1);
    assert!((value(&row, &x) - 0.4).abs() < 1e-9);
}

#[test]
fn linearized_edges_have_the_value_and_slope_of_their_length() {
    let topology = Topology::builder(3).triangles([[0, 1, 2]]).build().unwrap();
    let rest = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point::from);
    let mut edges = EdgeLimits::new(&topology, &rest, &[true; 3], |_| 1.1);
    assert_eq!(edges.color_count(), 3);
    let x = [[0.0, 0.0, 0.0], [1.3, 0.2, 0.0], [0.1, 0.9, 0.4]].map(Point::from);
    edges.begin(&x, EdgeReference::Start);
    let mut rows = Vec::new();
    edges.linearize(&x, &mut rows);
    for (row, ball) in rows.iter().zip(&edges.balls) {
        let [a, b] = ball.vertices.map(|v| v as usize);
        let length = |x: &[Point; 3]| (x[a] - x[b]).norm();
        assert!((ball.limit - 1.1 * length(&x)).abs() < 1e-12);
        assert!((row.value(&x.map(|p| p.coords)) - 0.1 * length(&x)).abs() < 1e-12);
        for axis in 0..3 {
            let mut plus = x;
            plus[a][axis] += 1e-6;
            let slope = -(length(&plus) - length(&x)) / 1e-6;
            assert!((slope - row.gradients[0][axis]).abs() < 1e-5);
        }
    }
}

#[test]
fn limits_from_rest_shorten_a_stretched_edge_by_a_bounded_share_per_call() {
    let topology = Topology::builder(2).strand_edges([[0, 1]]).build().unwrap();
    let rest = [Point::origin(), Point::new(1.0, 0.0, 0.0)];
    let mut edges = EdgeLimits::new(&topology, &rest, &[true; 2], |_| 1.1);
    let mut at = |length: f64| {
        edges.begin(&[Point::origin(), Point::new(length, 0.0, 0.0)], EdgeReference::Rest);
        edges.balls[0].limit
    };
    assert_eq!(at(0.5), 1.1);
    assert_eq!(at(1.0), 1.1);
    assert!((at(2.0) - 0.97 * 2.0).abs() < 1e-15);
}

#[test]
fn limits_widen_where_they_are_known_and_until_the_next_call() {
    let topology = Topology::builder(3).strand_edges([[0, 1], [1, 2]]).build().unwrap();
    let rest = [0.0, 1.0, 2.0].map(|x| Point::new(x, 0.0, 0.0));
    let mut edges = EdgeLimits::new(&topology, &rest, &[true; 3], |_| 1.1);
    let limit = |edges: &EdgeLimits, edge: [u32; 2]| {
        edges.balls.iter().find(|ball| ball.vertices == edge).expect("an edge").limit
    };
    edges.begin(&rest, EdgeReference::Rest);
    edges.widen(1.5, |edge| edge.contains(&2));
    assert!((limit(&edges, [0, 1]) - 1.1).abs() < 1e-15 && (limit(&edges, [1, 2]) - 1.65).abs() < 1e-15);
    edges.begin(&rest, EdgeReference::Rest);
    assert!((limit(&edges, [1, 2]) - 1.1).abs() < 1e-15);
}

#[test]
fn the_contact_distance_is_lower_in_fine_meshes_and_for_pairs_that_start_close() {
    // Vertex 0 above a triangle, in the same component.
    let topology = Topology::builder(5).triangles([[1, 2, 3], [0, 4, 1]]).build().unwrap();
    let model = CollisionModel::single_body(topology);
    let pair = Pair { elements: [0, 0], vertices: [0, 1, 2, 3] };
    let rest = [[0.2, 0.2, 0.004], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]]
        .map(Point::from);
    let free = DeltaRule { delta: 0.01, growth: f64::INFINITY };
    let (delta, lowered) = free.of(&model, PairKind::VertexTriangle, &pair, &rest, 0.004);
    assert!(lowered && (delta - 0.002).abs() < 1e-15, "half of the rest distance: {delta}");
    let slow = DeltaRule { delta: 0.001, growth: 2e-4 };
    let (delta, lowered) = slow.of(&model, PairKind::VertexTriangle, &pair, &rest, 1e-5);
    assert!(!lowered && (delta - 2.1e-4).abs() < 1e-15, "present gap plus growth: {delta}");
    // Two parts of one body are no neighbors.
    let parts = Topology::builder(4).triangles([[1, 2, 3]]).particles([0]).build().unwrap();
    let parts = CollisionModel::single_body(parts);
    assert_eq!(free.of(&parts, PairKind::VertexTriangle, &pair, &rest[..4], 0.004), (0.01, false));
}

#[test]
fn edges_that_yield_may_be_longer_than_their_limits() {
    let rest = [0.0, 1.0, 2.0].map(|x| Point::new(x, 0.0, 0.0));
    let topology = Topology::builder(3).strand_edges([[0, 1], [1, 2]]).build().unwrap();
    let mut edges = EdgeLimits::new(&topology, &rest, &[false, true, false], |_| 1.1);
    edges.begin(&rest, EdgeReference::Rest);
    let longer = [([1, 0], 1.4), ([1, 2], 0.9), ([0, 2], 3.0), ([7, 8], 2.0)];
    edges.let_yield(&longer.map(|(vertices, limit)| DistanceLimit { vertices, limit }));
    for ball in &edges.balls {
        assert_eq!(ball.limit, if ball.vertices == [0, 1] { 1.4 } else { 1.1 });
    }
}
