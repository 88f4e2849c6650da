//! Against differences of gradients, feature by feature.

use super::*;
use crate::barrier::barrier;
use crate::geometry;

const STRENGTH: f64 = 20.0;
const RANGE: f64 = 0.5;

fn contact(kind: PairKind, x: &[Point; 4]) -> Contact {
    let separation = geometry::separation(kind, &[0, 1, 2, 3], 0, x, &[]);
    let jet = barrier(STRENGTH, separation.distance, RANGE);
    Contact { kind, vertices: [0, 1, 2, 3], separation, jet, mollifier: Mollifier::NONE }
}

fn gradient(kind: PairKind, x: &[Point; 4]) -> SMatrix<f64, 12, 1> {
    let contact = contact(kind, x);
    let sigma = contact.separation.signed_weights(kind);
    let mut gradient = SMatrix::<f64, 12, 1>::zeros();
    for k in 0..kind.vertex_count() {
        let row = contact.jet.slope * sigma[k] * contact.separation.normal;
        gradient.fixed_rows_mut::<3>(3 * k).copy_from(&row);
    }
    gradient
}

fn pair_hessian(contact: &Contact, x: &[Point; 4]) -> Block12 {
    Factors::of(contact, x).matrix()
}

/// One pair for each set of closest features.
fn pairs() -> Vec<(PairKind, [Point; 4], usize)> {
    let p = Point::new;
    let o = Point::origin();
    let triangle = [p(0.1, 0.0, 0.05), p(1.0, 0.1, 0.0), p(-0.1, 1.0, -0.02)];
    let above = |q: Point| [q, triangle[0], triangle[1], triangle[2]];
    let edges = |a: Point, b: Point| [a, b, p(0.0, -1.0, 0.0), p(0.1, 1.0, 0.03)];
    vec![
        (PairKind::VertexVertex, [p(0.1, 0.2, 0.15), o, o, o], 0),
        (PairKind::VertexEdge, [p(0.5, 0.2, 0.15), o, p(1.0, 0.1, 0.0), o], 1),
        (PairKind::VertexEdge, [p(-0.1, 0.2, 0.15), o, p(1.0, 0.1, 0.0), o], 0),
        (PairKind::VertexTriangle, above(p(0.3, 0.3, 0.2)), 2),
        (PairKind::VertexTriangle, above(p(0.6, 0.7, 0.2)), 1),
        (PairKind::VertexTriangle, above(p(0.0, -0.2, 0.2)), 0),
        (PairKind::EdgeEdge, edges(p(-1.0, 0.1, 0.2), p(1.0, -0.1, 0.3)), 2),
        (PairKind::EdgeEdge, edges(p(0.2, 0.1, 0.2), p(1.0, -0.1, 0.3)), 1),
        (PairKind::EdgeEdge, edges(p(0.2, 1.2, 0.2), p(1.0, 1.4, 0.3)), 0),
    ]
}

#[test]
fn hessians_are_those_of_differences_for_every_set_of_closest_features() {
    for (kind, x, free) in pairs() {
        let contact = contact(kind, &x);
        assert!(contact.separation.distance < RANGE, "{kind:?} {free}");
        assert_eq!(places(kind, &contact.separation.weights).1, free, "{kind:?} {:?}", contact.separation);
        let hessian = pair_hessian(&contact, &x);
        let h = 1e-6;
        let scale = hessian.amax();
        for column in 0..3 * kind.vertex_count() {
            let moved = |sign: f64| {
                let mut moved = x;
                moved[column / 3][column % 3] += sign * h;
                gradient(kind, &moved)
            };
            let expected = (moved(1.0) - moved(-1.0)) / (2.0 * h);
            let error = (hessian.column(column) - expected).amax();
            assert!(error < 1e-6 * scale, "{kind:?} {free} free, column {column}: {error} of {scale}");
        }
    }
}

#[test]
fn the_positive_part_is_that_of_the_whole_matrix() {
    for (kind, x, _) in pairs() {
        let contact = contact(kind, &x);
        let hessian = pair_hessian(&contact, &x);
        let eigen = hessian.symmetric_eigen();
        let scale = hessian.amax();
        assert!(eigen.eigenvalues.min() < -1e-3 * scale, "{kind:?} {}", eigen.eigenvalues);
        let kept = Block12::from_diagonal(&eigen.eigenvalues.map(|e| e.max(0.0)));
        let expected = eigen.eigenvectors * kept * eigen.eigenvectors.transpose();
        let part = Factors::of(&contact, &x).positive_part();
        assert!((part - expected).amax() < 1e-10 * scale, "{kind:?}");
        assert!(part.symmetric_eigenvalues().min() > -1e-12 * scale, "{kind:?}");
    }
}

#[test]
fn parallel_edges_give_a_finite_positive_part() {
    let p = Point::new;
    let x = [p(0.0, 0.0, 0.1), p(1.0, 0.0, 0.1), p(0.2, 0.0, 0.0), p(1.2, 0.0, 0.0)];
    let part = Factors::of(&contact(PairKind::EdgeEdge, &x), &x).positive_part();
    assert!(part.iter().all(|e| e.is_finite()) && part.amax() > 0.0);
}

#[test]
fn the_hessian_of_edges_that_are_nearly_parallel_is_that_of_differences() {
    let p = Point::new;
    let x = [p(0.0, -0.02, 0.2), p(1.0, 0.02, 0.2), p(-0.1, 0.0, 0.0), p(1.2, 0.001, 0.0)];
    let of = |x: &[Point; 4]| Contact {
        mollifier: Mollifier::of_edges(x, &x.map(|p| 1.4 * p)),
        ..contact(PairKind::EdgeEdge, x)
    };
    let force = |moved: &[Point; 4]| {
        let contact = Contact { mollifier: Mollifier::of_edges(moved, &x.map(|p| 1.4 * p)), ..of(moved) };
        contact.mollifier.value * gradient(PairKind::EdgeEdge, moved)
            + contact.mollifier.slope * contact.jet.value * mollifier::gradient(moved)
    };
    assert!(of(&x).mollifier.fades() && places(PairKind::EdgeEdge, &of(&x).separation.weights).1 == 2);
    let h = 1e-6;
    let mut whole = Block12::zeros();
    for column in 0..12 {
        let moved = |sign: f64| {
            let mut moved = x;
            moved[column / 3][column % 3] += sign * h;
            force(&moved)
        };
        whole.set_column(column, &((moved(1.0) - moved(-1.0)) / (2.0 * h)));
    }
    let eigen = (0.5 * (whole + whole.transpose())).symmetric_eigen();
    let kept = Block12::from_diagonal(&eigen.eigenvalues.map(|e| e.max(0.0)));
    let expected = eigen.eigenvectors * kept * eigen.eigenvectors.transpose();
    let error = (of_contact(&of(&x), &x) - expected).amax();
    assert!(error < 1e-5 * expected.amax(), "{error} of {}", expected.amax());
}
