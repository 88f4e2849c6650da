//! What all triangles of constant strain share: shape functions, deformation gradient, its singular values,
//! and the assembly of forces and Hessian from a state in the frames of the singular vectors.

use super::element::Linearization;
use super::filter::Filter;
use super::svd::any_normal;
use bowknot_geometry::Vector;
use nalgebra::{Matrix2, Matrix3, Matrix4, Vector2};
use wide::f64x4;

/// Divisors that are singular values, or sums of them, are at least this large. It limits the curvatures of
/// triangles crushed to less than a twentieth; forces do not depend on it.
pub(super) const MIN_SINGULAR_VALUE: f64 = 0.05;

/// Singular values up to this count as zero: their reciprocals, and the squares on the way, must be finite.
pub(super) const ZERO_SINGULAR_VALUE: f64 = 1e-150;

/// F = s1 u1 v1^T + s2 u2 v2^T, with v1 = (c, s) and v2 = (-s, c).
#[derive(Clone, Copy, Default)]
pub(crate) struct Decomposition {
    pub s: [f64; 2],
    pub u: [Vector; 2],
    pub v1: [f64; 2],
}

/// Gradients of the shape functions in the rest plane [1/m] and the area [m^2]; None if the triangle has no
/// area. The first axis of the plane is the projection of `axis` or, without one, points to vertex 1.
pub(super) fn rest_gradients(rest: &[Vector; 3], axis: Option<&Vector>) -> Option<([[f64; 2]; 3], f64)> {
    let (e1, e2) = (rest[1] - rest[0], rest[2] - rest[0]);
    let (g1, g2, determinant) = match axis {
        None => {
            let length = e1.norm();
            let (x1, x2) = (length, e1.dot(&e2) / length);
            let y2 = e1.cross(&e2).norm() / length;
            let determinant = x1 * y2;
            // The inverse of [[x1, x2], [0, y2]]: its rows are the gradients of vertices 1 and 2.
            ([1.0 / x1, -x2 / determinant], [0.0, 1.0 / y2], determinant)
        }
        Some(axis) => {
            let normal = e1.cross(&e2).try_normalize(0.0)?;
            let first = (axis - normal * normal.dot(axis)).try_normalize(0.0)?;
            let second = normal.cross(&first);
            let (x1, y1, x2, y2) = (e1.dot(&first), e1.dot(&second), e2.dot(&first), e2.dot(&second));
            let determinant = x1 * y2 - x2 * y1;
            ([y2 / determinant, -x2 / determinant], [-y1 / determinant, x1 / determinant], determinant)
        }
    };
    let g0 = [-g1[0] - g2[0], -g1[1] - g2[1]];
    let finite = [g0, g1, g2].iter().flatten().all(|g: &f64| g.is_finite());
    (finite && determinant > 0.0).then_some(([g0, g1, g2], 0.5 * determinant))
}

/// Columns of F.
#[inline]
pub(super) fn deformation(gradients: &[[f64; 2]; 3], x: &[Vector; 3]) -> [Vector; 2] {
    let [_, g1, g2] = gradients;
    // From differences, so that F does not depend on where the origin is.
    let (e1, e2) = (x[1] - x[0], x[2] - x[0]);
    [e1 * g1[0] + e2 * g2[0], e1 * g1[1] + e2 * g2[1]]
}

/// Increment of the Green strain from `f0` to `f`: components 00, 11, and twice 01.
#[inline]
pub(super) fn strain_increment(f: &[Vector; 2], f0: &[Vector; 2]) -> [f64; 3] {
    // a.a - b.b = (a - b).(a + b), without cancellation.
    let difference = |a: &Vector, b: &Vector| (a - b).dot(&(a + b));
    let shear = (f[0] - f0[0]).dot(&f[1]) + f0[0].dot(&(f[1] - f0[1]));
    [0.5 * difference(&f[0], &f0[0]), 0.5 * difference(&f[1], &f0[1]), shear]
}

/// The unit eigenvector (c, s) of the larger eigenvalue of [[a, b], [b, d]].
#[inline]
fn first_axis(a: f64, d: f64, b: f64) -> [f64; 2] {
    // A Jacobi rotation, without trigonometric functions, which differ between platforms.
    let (c, s) = if b == 0.0 {
        (1.0, 0.0)
    } else {
        let tau = (d - a) / (2.0 * b);
        let t = 1.0f64.copysign(tau) / (tau.abs() + (1.0 + tau * tau).sqrt());
        let c = 1.0 / (1.0 + t * t).sqrt();
        (c, -t * c)
    };
    // The eigenvalue of (c, s) is a - t b, that of (-s, c) is d + t b; take the larger one.
    let along = c * c * a + 2.0 * c * s * b + s * s * d;
    let across = s * s * a - 2.0 * c * s * b + c * c * d;
    if along >= across { [c, s] } else { [-s, c] }
}

/// The first axes of four matrices at once.
#[inline(always)]
fn first_axes(a: f64x4, d: f64x4, b: f64x4) -> [f64x4; 2] {
    let (zero, one, two) = (f64x4::splat(0.0), f64x4::splat(1.0), f64x4::splat(2.0));
    let tau = (d - a) / (two * b);
    let size = one / (tau.abs() + (one + tau * tau).sqrt());
    let t = tau.simd_ge(zero).bitselect(size, -size);
    // Without rotation, where b = 0: t = 0.
    let t = b.simd_eq(zero).bitselect(zero, t);
    let c = one / (one + t * t).sqrt();
    let s = -t * c;
    let along = c * c * a + two * c * s * b + s * s * d;
    let across = s * s * a - two * c * s * b + c * c * d;
    let first = along.simd_ge(across);
    [first.bitselect(c, -s), first.bitselect(s, c)]
}

/// A vector of each of four triangles.
type Wide = [f64x4; 3];

#[inline(always)]
fn dot(a: &Wide, b: &Wide) -> f64x4 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Singular values and vectors of four 3 x 2 matrices with columns `f`; they are finite for any rank. Divisions
/// and square roots of one would wait for each other; the result for each does not depend on the others.
#[inline]
pub(super) fn decompose(f: &[[Vector; 2]; 4]) -> [Decomposition; 4] {
    let column =
        |of: usize| -> Wide { std::array::from_fn(|row| f64x4::new(std::array::from_fn(|k| f[k][of][row]))) };
    let (f1, f2) = (column(0), column(1));
    let [c, s] = first_axes(dot(&f1, &f1), dot(&f2, &f2), dot(&f1, &f2));
    let w1: Wide = std::array::from_fn(|row| f1[row] * c + f2[row] * s);
    let w2: Wide = std::array::from_fn(|row| f2[row] * c - f1[row] * s);
    let s1 = dot(&w1, &w1).sqrt();
    let inverse = f64x4::splat(1.0) / s1;
    let u1 = w1.map(|x| x * inverse);
    // The component along w1 that rounding left in w2 is removed, so that u stays orthonormal near rank one.
    let rest = dot(&u1, &w2);
    let w: Wide = std::array::from_fn(|row| w2[row] - u1[row] * rest);
    let s2 = dot(&w, &w).sqrt();
    let inverse = f64x4::splat(1.0) / s2;
    let u2 = w.map(|x| x * inverse);
    let numbers = |wide: &Wide| wide.map(|number| number.to_array());
    let ([u1, u2, w2], [s1, s2, c, s]) =
        ([u1, u2, w2].map(|wide| numbers(&wide)), [s1, s2, c, s].map(|wide| wide.to_array()));
    std::array::from_fn(|k| {
        let pick = |of: &[[f64; 4]; 3]| Vector::new(of[0][k], of[1][k], of[2][k]);
        let v1 = [c[k], s[k]];
        if s1[k] > ZERO_SINGULAR_VALUE && s2[k] > 1e-14 * s1[k] && s2[k] > ZERO_SINGULAR_VALUE {
            Decomposition { s: [s1[k], s2[k]], u: [pick(&u1), pick(&u2)], v1 }
        } else {
            degenerate(s1[k], pick(&u1), pick(&w2), v1)
        }
    })
}

/// The decomposition of a matrix of rank zero or one, or nearly so: any orthonormal vectors.
#[cold]
fn degenerate(s1: f64, u1: Vector, w2: Vector, v1: [f64; 2]) -> Decomposition {
    let u1 = if s1 > ZERO_SINGULAR_VALUE { u1 } else { Vector::x() };
    let w2 = w2 - u1 * u1.dot(&w2);
    let s2 = w2.norm();
    let u2 = if s2 > 1e-14 * s1 && s2 > ZERO_SINGULAR_VALUE { w2 * (1.0 / s2) } else { any_normal(&u1) };
    Decomposition { s: [s1, s2], u: [u1, u2], v1 }
}

/// Filtered curvatures in the frames (u1, u2, n) and (v1, v2); increments of F are d_ij along u_i v_j^T.
pub(super) struct Curvatures {
    /// Over d11, d12, d21, d22.
    pub plane: Matrix4<f64>,
    /// Over n v1^T, n v2^T.
    pub normal: Matrix2<f64>,
}

/// Gradient of a triangle from its `stress`, whose entry [i][j] is the component along u_i v_j^T.
#[inline]
pub(super) fn forces(
    gradients: &[[f64; 2]; 3],
    area: f64,
    decomposition: &Decomposition,
    stress: [[f64; 2]; 2],
) -> [Vector; 3] {
    let Decomposition { u: [u1, u2], v1: [cosine, sine], .. } = *decomposition;
    let [[p11, p12], [p21, p22]] = stress;
    let force = |[g0, g1]: [f64; 2]| {
        let g = Vector2::new(cosine * g0 + sine * g1, cosine * g1 - sine * g0);
        (u1 * (p11 * g.x + p12 * g.y) + u2 * (p21 * g.x + p22 * g.y)) * area
    };
    let [_, f1, f2] = gradients.map(force);
    [-(f1 + f2), f1, f2]
}

/// Energy, gradient and Hessian of a triangle from an energy density, the `stress` (entry [i][j] is the
/// component along u_i v_j^T) and the curvatures.
#[inline]
pub(super) fn assemble(
    gradients: &[[f64; 2]; 3],
    area: f64,
    decomposition: &Decomposition,
    energy: f64,
    stress: [[f64; 2]; 2],
    curvatures: &Curvatures,
) -> Linearization<3> {
    let Decomposition { u: [u1, u2], v1: [cosine, sine], .. } = *decomposition;
    // Shape function gradients along v1 and v2.
    let shape = gradients.map(|[g0, g1]| Vector2::new(cosine * g0 + sine * g1, cosine * g1 - sine * g0));
    let corner = |i: usize, j: usize| curvatures.plane.fixed_view::<2, 2>(2 * i, 2 * j).into_owned();
    let (k11, k12, k22) = (corner(0, 0), corner(0, 1), corner(1, 1));
    let basis = Matrix3::from_columns(&[u1, u2, u1.cross(&u2)]);
    let [[p11, p12], [p21, p22]] = stress;
    let force = |k: usize| {
        let g = shape[k];
        (u1 * (p11 * g.x + p12 * g.y) + u2 * (p21 * g.x + p22 * g.y)) * area
    };
    let hessian = |k: usize, l: usize| {
        let (g, h) = (shape[k], shape[l]);
        let (g11, g12, g21, g22) = (k11 * g, k12.transpose() * g, k12 * g, k22 * g);
        let gn = curvatures.normal * g;
        let block =
            Matrix3::new(g11.dot(&h), g12.dot(&h), 0.0, g21.dot(&h), g22.dot(&h), 0.0, 0.0, 0.0, gn.dot(&h));
        basis * (block * area) * basis.transpose()
    };
    Linearization::of_translations(
        area * energy,
        [force(1), force(2)],
        [hessian(1, 1), hessian(1, 2), hessian(2, 2)],
    )
}

/// Filters the eigenvalues of a symmetric matrix.
pub(super) fn filter_2(matrix: Matrix2<f64>, filter: Filter) -> Matrix2<f64> {
    let [c, s] = first_axis(matrix[(0, 0)], matrix[(1, 1)], matrix[(0, 1)]);
    let turn = Matrix2::new(c, -s, s, c);
    let diagonal = turn.transpose() * matrix * turn;
    let (along, across) = (filter.apply(diagonal[(0, 0)]), filter.apply(diagonal[(1, 1)]));
    turn * Matrix2::new(along, 0.0, 0.0, across) * turn.transpose()
}

/// Whether a symmetric matrix is positive definite: all pivots of an elimination are above 0.
fn is_positive(matrix: &Matrix4<f64>) -> bool {
    let mut left = *matrix;
    for k in 0..4 {
        let pivot = left[(k, k)];
        if pivot <= 0.0 || pivot.is_nan() {
            return false;
        }
        let inverse = 1.0 / pivot;
        for column in k + 1..4 {
            let factor = left[(column, k)] * inverse;
            for row in column..4 {
                left[(row, column)] -= factor * left[(row, k)];
            }
        }
    }
    true
}

/// Filters the eigenvalues of a symmetric matrix.
pub(super) fn filter_4(matrix: Matrix4<f64>, filter: Filter) -> Matrix4<f64> {
    if is_positive(&matrix) {
        return matrix;
    }
    let mut eigen = matrix.symmetric_eigen();
    eigen.eigenvalues.apply(|value| *value = filter.apply(*value));
    eigen.recompose()
}
