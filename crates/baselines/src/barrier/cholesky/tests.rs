//! Against products with the matrix.

use super::*;
use crate::barrier::hessian::{Block12, Element};

/// Random elements between neighbors on a grid of n x n x 3 vertices; every seventh vertex does not move.
fn grid(n: usize, random: &mut fastrand::Rng) -> (Vec<f64>, Vec<Element>, Vec<Point>) {
    let at = |i: usize, j: usize, k: usize| (3 * (n * i + j) + k) as u32;
    let mut draw = || 2.0 * random.f64() - 1.0;
    let (mut elements, mut positions) = (Vec::new(), Vec::new());
    for i in 0..n {
        for j in 0..n {
            for k in 0..3 {
                positions.push(Point::new(i as f64, j as f64, 0.1 * k as f64 + 0.01 * draw()));
                let [i1, j1, k1] = [(i + 1) % n, (j + 1).min(n - 1), (k + 1) % 3];
                let vertices = if k < 2 {
                    [at(i, j, k), at(i1.max(i), j, k), at(i, j1, k), at(i, j, k1)]
                } else {
                    [at(i, j, k), at(i, j1, k), at(i, j, k), at(i, j, k)]
                };
                let count = if k < 2 { 4 } else { 2 };
                let factor = Block12::from_fn(|a, b| if a.max(b) < 3 * count { draw() } else { 0.0 });
                elements.push(Element { vertices, count, matrix: factor * factor.transpose() });
            }
        }
    }
    let inertia = (0..positions.len()).map(|v| if v % 7 == 3 { 0.0 } else { 0.5 + v as f64 % 3.0 }).collect();
    (inertia, elements, positions)
}

#[test]
fn a_solution_multiplied_by_the_matrix_is_the_right_hand_side() {
    let mut random = fastrand::Rng::with_seed(3);
    for n in [1, 2, 5, 12, 30] {
        let (inertia, elements, positions) = grid(n, &mut random);
        let system = System::new(&inertia, &elements);
        let b: Vec<Vector> = inertia
            .iter()
            .map(|&m| if m > 0.0 { Vector::from_fn(|_, _| random.f64() - 0.5) } else { Vector::zeros() })
            .collect();
        let mut x = b.clone();
        Cholesky::new(&system, 0.0, &positions).expect("positive definite").solve(&mut x);
        let mut product = vec![Vector::zeros(); b.len()];
        system.multiply(&x, &mut product);
        let residual = b.iter().zip(&product).map(|(b, p)| (b - p).norm()).fold(0.0, f64::max);
        assert!(residual < 1e-12, "{n}: {residual}");
        let still = (0..b.len()).filter(|&v| inertia[v] == 0.0).all(|v| x[v] == Vector::zeros());
        assert!(still && x.iter().any(|x| x.norm() > 0.0), "{n}");
    }
}

#[test]
fn fronts_stay_small_where_few_vertices_touch() {
    let (inertia, elements, positions) = grid(30, &mut fastrand::Rng::with_seed(3));
    let factor =
        Cholesky::new(&System::new(&inertia, &elements), 0.0, &positions).expect("positive definite");
    let largest = factor.fronts.iter().map(|front| front.vertices.len()).max();
    // Separators of a sheet of 30 x 30 x 3 vertices have about 90, and a few reach a front.
    assert!(largest < Some(400), "{largest:?} of {}", positions.len());
}

#[test]
fn an_indefinite_matrix_is_refused() {
    let element = Element { vertices: [0, 1, 0, 0], count: 2, matrix: -Block12::identity() };
    let system = System::new(&[0.5, 0.5], &[element]);
    assert!(Cholesky::new(&system, 0.0, &[Point::origin(), Point::new(1.0, 0.0, 0.0)]).is_none());
}
