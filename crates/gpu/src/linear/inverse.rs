//! Inverses of the matrices of domains.

use super::layout::DOMAIN_UNKNOWNS;

/// A pivot at most this share of its diagonal entry counts as zero: the motion moves nothing that others do not.
const ZERO_PIVOT: f64 = 1e-11;

const N: usize = DOMAIN_UNKNOWNS;

/// The inverse of a symmetric positive semi-definite matrix, whose upper triangle is read; rows and columns of pivots that
/// vanish are zero. A = U^T U and W = U^-T give A^-1 = W^T W.
pub fn inverse(mut a: Vec<f64>) -> Vec<f64> {
    let diagonal: [f64; N] = std::array::from_fn(|j| a[N * j + j]);
    let mut pivots = [0.0f64; N];
    for j in 0..N {
        let (row, below) = a[N * j..].split_at_mut(N);
        let pivot = row[j];
        if pivot <= ZERO_PIVOT * diagonal[j] || !pivot.is_finite() {
            row[j..].fill(0.0);
            continue;
        }
        pivots[j] = pivot.sqrt();
        row[j..].iter_mut().for_each(|entry| *entry /= pivots[j]);
        for (i, other) in (j + 1..N).zip(below.chunks_exact_mut(N)) {
            add_scaled(&mut other[i..], -row[i], &row[i..]);
        }
    }
    let mut w = vec![0.0; N * N];
    let mut inverse = vec![0.0; N * N];
    for i in (0..N).filter(|&i| pivots[i] > 0.0) {
        let (above, rest) = w.split_at_mut(N * i);
        let row = &mut rest[..=i];
        row[i] = 1.0;
        for k in 0..i {
            add_scaled(&mut row[..=k], -a[N * k + i], &above[N * k..=N * k + k]);
        }
        row.iter_mut().for_each(|entry| *entry /= pivots[i]);
        for k in 0..=i {
            add_scaled(&mut inverse[N * k..=N * k + k], row[k], &row[..=k]);
        }
    }
    for i in 0..N {
        (0..i).for_each(|j| inverse[N * j + i] = inverse[N * i + j]);
    }
    inverse
}

fn add_scaled(to: &mut [f64], factor: f64, from: &[f64]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to += factor * from);
}

#[cfg(test)]
mod tests {
    use super::{N, inverse};
    use nalgebra::DMatrix;

    #[test]
    fn semi_definite_matrices_are_inverted_where_they_are_definite() {
        let mut random = fastrand::Rng::with_seed(3);
        let factor = DMatrix::from_fn(N, N, |_, _| random.f64() - 0.5);
        let mut matrix = &factor * factor.transpose() + DMatrix::identity(N, N) * 0.1;
        // Unknown 7 moves nothing, unknown 11 as unknown 4 does.
        for k in 0..N {
            let row = matrix[(4, k)];
            for (unknown, value) in [(7, 0.0), (11, row)] {
                matrix[(unknown, k)] = value;
                matrix[(k, unknown)] = value;
            }
        }
        matrix[(11, 11)] = matrix[(4, 4)];
        let found = DMatrix::from_row_slice(N, N, &inverse(matrix.as_slice().to_vec()));
        let kept: Vec<usize> = (0..N).filter(|k| ![7, 11].contains(k)).collect();
        let expected = matrix.select_rows(&kept).select_columns(&kept).try_inverse().expect("definite");
        let error = (found.select_rows(&kept).select_columns(&kept) - &expected).abs().max();
        assert!(error < 1e-10 * expected.abs().max(), "{error:e}");
        assert!((0..N).all(|k| found[(7, k)] == 0.0 && found[(k, 11)] == 0.0));
    }
}
