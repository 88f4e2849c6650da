//! Filters negative eigenvalues of a symmetric matrix: twin of `shader/shared/eigen.wgsl`.

/// Entries beside the diagonal up to this share of the largest entry count as zero.
const NEGLIGIBLE: f32 = 1e-8;

const SWEEPS: usize = 6;

type Square<const ORDER: usize> = [[f32; ORDER]; ORDER];

/// Whether all pivots of a Cholesky factorization are positive.
pub fn is_definite<const ORDER: usize>(mut a: Square<ORDER>, largest: f32) -> bool {
    for k in 0..ORDER {
        let pivot = a[k][k];
        if pivot <= 1e-6 * largest {
            return false;
        }
        let row = a[k];
        for below in a.iter_mut().skip(k + 1) {
            let factor = below[k] / pivot;
            for j in k + 1..ORDER {
                below[j] -= factor * row[j];
            }
        }
    }
    true
}

pub fn filtered_matrix<const ORDER: usize>(
    matrix: Square<ORDER>,
    filtered: impl Fn(f32) -> f32,
) -> Square<ORDER> {
    let mut a = matrix;
    let largest = a.as_flattened().iter().fold(0.0f32, |largest, value| largest.max(value.abs()));
    if is_definite(a, largest) {
        return a;
    }
    let mut v = [[0.0; ORDER]; ORDER];
    (0..ORDER).for_each(|k| v[k][k] = 1.0);
    for _ in 0..SWEEPS {
        for p in 0..ORDER {
            for q in p + 1..ORDER {
                let pq = a[p][q];
                if pq.abs() > NEGLIGIBLE * largest {
                    let tau = (a[q][q] - a[p][p]) / (2.0 * pq);
                    let size = 1.0 / (tau.abs() + (1.0 + tau * tau).sqrt());
                    let t = if tau >= 0.0 { size } else { -size };
                    let c = 1.0 / (1.0 + t * t).sqrt();
                    let s = t * c;
                    for row in a.iter_mut().chain(&mut v) {
                        let (x, y) = (row[p], row[q]);
                        (row[p], row[q]) = (c * x - s * y, s * x + c * y);
                    }
                    for k in 0..ORDER {
                        let (x, y) = (a[p][k], a[q][k]);
                        (a[p][k], a[q][k]) = (c * x - s * y, s * x + c * y);
                    }
                }
            }
        }
    }
    let mut sum = [[0.0; ORDER]; ORDER];
    for k in 0..ORDER {
        let value = filtered(a[k][k]);
        for i in 0..ORDER {
            for j in 0..ORDER {
                sum[i][j] += value * v[i][k] * v[j][k];
            }
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::filtered_matrix;
    use nalgebra::Matrix4;

    #[test]
    fn eigenvalues_are_filtered_as_in_double_precision() {
        let mut random = fastrand::Rng::with_seed(4);
        for case in 0..200 {
            let b = Matrix4::from_fn(|_, _| 2.0 * random.f64() - 1.0);
            let shift = if case % 3 == 0 { 4.0 } else { 0.2 };
            let matrix = b + b.transpose() + Matrix4::from_diagonal_element(shift);
            for absolute in [false, true] {
                let filter = |value: f64| if absolute { value.abs() } else { value.max(0.0) };
                let mut eigen = matrix.symmetric_eigen();
                eigen.eigenvalues.apply(|value| *value = filter(*value));
                let expected = eigen.recompose();
                let single: [[f32; 4]; 4] =
                    std::array::from_fn(|i| std::array::from_fn(|j| matrix[(i, j)] as f32));
                let found = filtered_matrix(single, |value| filter(f64::from(value)) as f32);
                for i in 0..4 {
                    for j in 0..4 {
                        let error = (f64::from(found[i][j]) - expected[(i, j)]).abs();
                        assert!(error < 4e-6 * matrix.abs().max().max(1.0), "{case} {absolute}: {error:e}");
                    }
                }
            }
        }
    }
}
