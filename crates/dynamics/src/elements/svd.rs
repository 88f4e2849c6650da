//! Signed singular values of 3 x 3 matrices.

use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use wide::f64x4;

/// Columns whose angle has a smaller cosine count as orthogonal: a few ulp.
const ORTHOGONALITY_TOLERANCE: f64 = 1e-15;

/// Singular values up to this count as zero: their squares and reciprocals must be finite. Columns shorter
/// than 1e-77 are not made orthogonal, as their products vanish.
const ZERO_SINGULAR_VALUE: f64 = 1e-150;

/// Largest number of sweeps; random matrices need four.
const MAX_SWEEPS: usize = 12;

/// F = u diag(s) v^T with rotations u and v (no reflections) and s1 >= s2 >= |s3|; s3 is negative if F is
/// inverted.
#[derive(Default)]
pub(crate) struct Svd {
    pub u: Matrix3<f64>,
    pub s: Vector,
    pub v: Matrix3<f64>,
}

/// Decomposes four matrices.
///
/// One-sided Jacobi rotations make the columns of F V orthogonal; small singular values have full relative
/// accuracy (Demmel and Veselic 1992). No trigonometric functions are used, which differ between platforms.
/// The result is finite for any rank. Four matrices are rotated at once, as divisions and square roots of one
/// would wait for each other; the result for each does not depend on the others.
pub(crate) fn signed_svds(f: &[Matrix3<f64>; 4]) -> [Svd; 4] {
    let mut b: [Wide; 3] = std::array::from_fn(|c| {
        std::array::from_fn(|row| f64x4::new(std::array::from_fn(|k| f[k][(row, c)])))
    });
    let (zero, one) = (f64x4::splat(0.0), f64x4::splat(1.0));
    let mut v: [Wide; 3] = [[one, zero, zero], [zero, one, zero], [zero, zero, one]];
    let tolerance = f64x4::splat(ORTHOGONALITY_TOLERANCE * ORTHOGONALITY_TOLERANCE);
    for _ in 0..MAX_SWEEPS {
        let mut rotated = false;
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let (pp, qq, pq) = (dot(&b[p], &b[p]), dot(&b[q], &b[q]), dot(&b[p], &b[q]));
            // Comparisons with numbers that are not finite are false, so such columns are not rotated.
            let rotates = (pq * pq).simd_gt(tolerance * pp * qq);
            if !rotates.any() {
                continue;
            }
            rotated = true;
            let tau = (qq - pp) / (f64x4::splat(2.0) * pq);
            let size = one / (tau.abs() + (one + tau * tau).sqrt());
            let t = tau.simd_ge(zero).bitselect(size, -size);
            // No rotation: t = 0.
            let t = rotates.bitselect(t, zero);
            let c = one / (one + t * t).sqrt();
            let s = t * c;
            rotate(&mut b, p, q, c, s);
            rotate(&mut v, p, q, c, s);
        }
        if !rotated {
            break;
        }
    }
    let columns = |wide: &[Wide; 3]| wide.map(|column| column.map(|number| number.to_array()));
    let (b, v) = (columns(&b), columns(&v));
    let pick = |of: &[[[f64; 4]; 3]; 3], k: usize| of.map(|[x, y, z]| Vector::new(x[k], y[k], z[k]));
    std::array::from_fn(|k| sorted(pick(&b, k), pick(&v, k)))
}

/// A vector of each of four matrices.
type Wide = [f64x4; 3];

#[inline(always)]
fn dot(a: &Wide, b: &Wide) -> f64x4 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn rotate(columns: &mut [Wide; 3], p: usize, q: usize, c: f64x4, s: f64x4) {
    for row in 0..3 {
        let (a, b) = (columns[p][row], columns[q][row]);
        (columns[p][row], columns[q][row]) = (a * c - b * s, a * s + b * c);
    }
}

/// The decomposition of F from the orthogonal columns `b` of F V and the columns of V.
#[inline]
fn sorted(mut b: [Vector; 3], mut v: [Vector; 3]) -> Svd {
    // Sort in descending order; a swap changes one sign, so that v stays a rotation.
    for (p, q) in [(0, 1), (1, 2), (0, 1)] {
        if b[p].norm_squared() < b[q].norm_squared() {
            (b[p], b[q]) = (b[q], -b[p]);
            (v[p], v[q]) = (v[q], -v[p]);
        }
    }
    let s1 = b[0].norm();
    let u1 = if s1 > ZERO_SINGULAR_VALUE { b[0] * (1.0 / s1) } else { Vector::x() };
    // The component along u1 that rounding left is removed, so that u stays orthonormal near rank one.
    let w = b[1] - u1 * u1.dot(&b[1]);
    let s2 = w.norm();
    let u2 = if s2 > 1e-14 * s1 && s2 > ZERO_SINGULAR_VALUE { w * (1.0 / s2) } else { any_normal(&u1) };
    let u3 = u1.cross(&u2);
    Svd {
        u: Matrix3::from_columns(&[u1, u2, u3]),
        s: Vector::new(s1, u2.dot(&b[1]), u3.dot(&b[2])),
        v: Matrix3::from_columns(&v),
    }
}

/// A unit vector orthogonal to the unit vector `u`.
pub(super) fn any_normal(u: &Vector) -> Vector {
    let axis = if u.x.abs() < 0.6 { Vector::x() } else { Vector::y() };
    u.cross(&axis).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::Stream;

    fn check(f: &Matrix3<f64>) {
        // Beside others that need more sweeps and fewer.
        let [svd, ..] = signed_svds(&[*f, Matrix3::identity(), f * 3.0, f.transpose()]);
        let [same, ..] = signed_svds(&[*f; 4]);
        assert_eq!((svd.u, svd.s, svd.v), (same.u, same.s, same.v));
        let Svd { u, s, v } = svd;
        let back = u * Matrix3::from_diagonal(&s) * v.transpose();
        let size = f.abs().max();
        assert!((back - f).abs().max() <= 4e-15 * size, "{f} {back}");
        for turn in [u, v] {
            assert!((turn.transpose() * turn - Matrix3::identity()).abs().max() < 4e-15);
            assert!((turn.determinant() - 1.0).abs() < 1e-14);
        }
        assert!(s[0] >= s[1] - 1e-15 * size && s[1] >= s[2].abs() - 1e-15 * size, "{s}");
    }

    #[test]
    fn any_matrix_is_decomposed_into_rotations_and_singular_values() {
        let mut stream = Stream::new(1);
        for k in 0..1000 {
            let mut f = Matrix3::from_fn(|_, _| stream.next());
            match k % 8 {
                0 => f.set_column(2, &(f.column(0) * 2.0 - f.column(1))),
                1 => f = f.column(0) * f.row(1),
                2 => f = Matrix3::identity() + f * 1e-9,
                3 => f *= 1e-60,
                4 => f.set_column(1, &(f.column(1) * 1e-9)),
                _ => {}
            }
            check(&f);
        }
        check(&Matrix3::zeros());
        check(&-Matrix3::identity());
        check(&Matrix3::identity());
    }
}
