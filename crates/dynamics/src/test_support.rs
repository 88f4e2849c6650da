//! Helpers that unit tests share.

use crate::elements::element::{Element, Start};
use crate::elements::filter::Filter;
use bowknot_geometry::Vector;
use nalgebra::{DMatrix, Matrix3, Rotation3};

/// Triangles of a grid of `columns` x `rows` cells. Vertex (i, j) has the index i + j * (columns + 1).
/// Diagonals are parallel or, with `alternate`, change direction from cell to cell.
pub(crate) fn grid_triangles(columns: usize, rows: usize, alternate: bool) -> Vec<[u32; 3]> {
    let index = |i: usize, j: usize| (i + j * (columns + 1)) as u32;
    let mut triangles = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let (a, b, c, d) = (index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1));
            if alternate && (i + j) % 2 == 1 {
                triangles.extend([[a, b, d], [b, c, d]]);
            } else {
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    triangles
}

/// Seeded random numbers.
pub(crate) struct Stream(fastrand::Rng);

impl Stream {
    pub fn new(seed: u64) -> Self {
        Self(fastrand::Rng::with_seed(seed))
    }

    /// Uniform in [-1, 1).
    pub fn next(&mut self) -> f64 {
        2.0 * self.0.f64() - 1.0
    }

    pub fn vector(&mut self) -> Vector {
        Vector::new(self.next(), self.next(), self.next())
    }

    /// `rest` with pseudo-random displacements of about `amount`, scaled, rotated and translated.
    pub fn deformed<const N: usize>(&mut self, rest: &[Vector; N], scale: f64, amount: f64) -> [Vector; N] {
        let turn = Rotation3::new(self.vector() * 3.0);
        rest.map(|x| turn * (x * scale + self.vector() * amount) + Vector::new(3.0, -2.0, 1.0))
    }
}

/// The full matrix of an element from its upper blocks.
pub(crate) fn dense<const N: usize>(hessian: &[[Matrix3<f64>; N]; N]) -> DMatrix<f64> {
    DMatrix::from_fn(3 * N, 3 * N, |i, j| {
        let (a, b) = (i / 3, j / 3);
        if a <= b { hessian[a][b][(i % 3, j % 3)] } else { hessian[b][a][(j % 3, i % 3)] }
    })
}

fn moved<const N: usize>(x: &[Vector; N], coordinate: usize, by: f64) -> [Vector; N] {
    let mut x = *x;
    x[coordinate / 3][coordinate % 3] += by;
    x
}

/// Compares the gradient with differences of the energy.
pub(crate) fn check_gradient<E: Element<N>, const N: usize>(
    element: &E,
    x: &[Vector; N],
    start: Option<Start<'_, N>>,
) {
    let h = 1e-5;
    let here = element.linearize(x, start, Filter::Exact);
    // Both functions compute the energy, with different formulas.
    let size = here.energy.abs().max(1.0);
    let energy = element.energy(x, start);
    assert!((here.energy - energy).abs() <= 1e-13 * size, "{} {energy}", here.energy);
    let scale = dense(&here.hessian).abs().max();
    // So do both that compute the gradient.
    let largest = here.gradient.iter().map(Vector::amax).fold(1.0, f64::max);
    for (one, other) in here.gradient.iter().zip(element.gradient(x, start)) {
        assert!((one - other).amax() <= 1e-13 * largest.max(scale), "{one} {other}");
    }
    for k in 0..3 * N {
        let (plus, minus) = (moved(x, k, h), moved(x, k, -h));
        let slope = (element.energy(&plus, start) - element.energy(&minus, start)) / (2.0 * h);
        let error = (slope - here.gradient[k / 3][k % 3]).abs();
        // Central differences err by about h^2 times third derivatives: a hundred times the stiffness.
        assert!(error < 1e-7 * scale, "gradient {k} off by {error:e} of {scale:e}");
    }
}

/// [`check_gradient`]; and compares the exact Hessian with differences of the gradient.
pub(crate) fn check_derivatives<E: Element<N>, const N: usize>(
    element: &E,
    x: &[Vector; N],
    start: Option<Start<'_, N>>,
) {
    check_gradient(element, x, start);
    let h = 1e-5;
    let hessian = dense(&element.linearize(x, start, Filter::Exact).hessian);
    let scale = hessian.abs().max();
    for k in 0..3 * N {
        let plus = element.linearize(&moved(x, k, h), start, Filter::Exact).gradient;
        let minus = element.linearize(&moved(x, k, -h), start, Filter::Exact).gradient;
        for l in 0..3 * N {
            let curvature = (plus[l / 3][l % 3] - minus[l / 3][l % 3]) / (2.0 * h);
            let error = (curvature - hessian[(l, k)]).abs();
            assert!(error < 1e-6 * scale, "Hessian ({l}, {k}) off by {error:e} of {scale:e}");
        }
    }
}

/// A Hessian must be positive semi-definite up to rounding.
pub(crate) fn check_positive<const N: usize>(hessian: &[[Matrix3<f64>; N]; N], what: &str) {
    let hessian = dense(hessian);
    assert!(hessian.iter().all(|h| h.is_finite()), "{what}");
    let (smallest, scale) = (hessian.clone().symmetric_eigenvalues().min(), hessian.abs().max());
    assert!(smallest >= -1e-10 * scale, "{what}: {smallest:e} of {scale:e}");
}

/// Forces must sum to zero and have no torque, up to rounding.
pub(crate) fn check_balance<const N: usize>(x: &[Vector; N], gradient: &[Vector; N]) {
    let size =
        gradient.iter().map(|g| g.norm()).sum::<f64>() * x.iter().map(|x| x.norm()).fold(1.0, f64::max);
    let force: Vector = gradient.iter().sum();
    let torque: Vector = x.iter().zip(gradient).map(|(x, g)| x.cross(g)).sum();
    assert!(force.norm() <= 1e-13 * size && torque.norm() <= 1e-13 * size, "{force} {torque} of {size:e}");
}
