//! Against a dense solve.

use super::*;
use crate::barrier::cholesky::Cholesky;
use crate::barrier::hessian::Block12;
use bowknot_twoway::geometry::Point;
use nalgebra::{DMatrix, DVector};

#[test]
fn a_solve_is_that_of_the_dense_matrix() {
    let inertia = [1.0, 2.0, 0.5, 0.0, 3.0, 1.0];
    let mut random = fastrand::Rng::with_seed(7);
    let mut draw = || 2.0 * random.f64() - 1.0;
    let elements: Vec<Element> = [[0, 1, 2, 3], [2, 4, 5, 0], [5, 3, 2, 1], [1, 4, 1, 1]]
        .into_iter()
        .map(|vertices| {
            let count = if vertices == [1, 4, 1, 1] { 2 } else { 4 };
            let factor = Block12::from_fn(|i, j| if i.max(j) < 3 * count { draw() } else { 0.0 });
            Element { vertices, count, matrix: 3.0 * factor * factor.transpose() }
        })
        .collect();
    let free = |v: usize| inertia[v] > 0.0;
    let mut dense = DMatrix::<f64>::zeros(18, 18);
    for v in 0..6 {
        for c in 0..3 {
            dense[(3 * v + c, 3 * v + c)] += if free(v) { inertia[v] } else { 1.0 };
        }
    }
    for element in &elements {
        for i in 0..3 * element.count {
            for j in 0..3 * element.count {
                let [a, b] = [i, j].map(|i| element.vertices[i / 3] as usize);
                if free(a) && free(b) {
                    dense[(3 * a + i % 3, 3 * b + j % 3)] += element.matrix[(i, j)];
                }
            }
        }
    }
    let b: Vec<Vector> =
        (0..6).map(|v| if free(v) { Vector::new(draw(), draw(), draw()) } else { Vector::zeros() }).collect();
    let flat = DVector::from_iterator(18, b.iter().flat_map(|b| b.iter().copied()));
    let expected = dense.lu().solve(&flat).expect("positive definite");
    let system = System::new(&inertia, &elements);
    let mut x = b.clone();
    assert!(system.iterate(&mut x) > 3);
    let mut exact = b;
    let positions: Vec<Point> = (0..6).map(|v| Point::new(f64::from(v), 0.0, 0.0)).collect();
    Cholesky::new(&system, 0.0, &positions).expect("positive definite").solve(&mut exact);
    for (i, expected) in expected.iter().enumerate() {
        assert!((exact[i / 3][i % 3] - expected).abs() < 1e-12, "{i}: {exact:?} {expected}");
        assert!((x[i / 3][i % 3] - expected).abs() < 1e-3, "{i}: {x:?} {expected}");
    }
}
