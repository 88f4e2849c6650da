//! Takes negative curvature out of the Hessian of a custom element.
//!
//! Newton's method needs a matrix that is positive semidefinite. The eigenvalues of each element's Hessian
//! are filtered as those of the other elements are; eigenvectors come from a dense decomposition, since
//! nothing is known of the law.

use crate::elements::filter::Filter;
use nalgebra::{DMatrix, Matrix3, SymmetricEigen};

/// Iterations of the decomposition per row; it needs about two.
const MAX_ITERATIONS: usize = 100;

/// Filters the eigenvalues of a finite matrix of `count` x `count` blocks, row by row. The result is
/// symmetric. Returns whether it is finite.
pub(super) fn filter_matrix(count: usize, blocks: &mut [Matrix3<f64>], filter: Filter) -> bool {
    let size = 3 * count;
    let at = |blocks: &[Matrix3<f64>], i: usize, j: usize| blocks[i / 3 * count + j / 3][(i % 3, j % 3)];
    let matrix = DMatrix::from_fn(size, size, |i, j| 0.5 * (at(blocks, i, j) + at(blocks, j, i)));
    let Some(eigen) = SymmetricEigen::try_new(matrix, f64::EPSILON, MAX_ITERATIONS * size) else {
        return false;
    };
    let vectors = &eigen.eigenvectors;
    let mut scaled = vectors.clone();
    for (mut column, value) in scaled.column_iter_mut().zip(eigen.eigenvalues.iter()) {
        column *= filter.apply(*value);
    }
    let filtered = scaled * vectors.transpose();
    for (index, block) in blocks.iter_mut().enumerate() {
        let (a, b) = (index / count, index % count);
        *block = Matrix3::from_fn(|i, j| {
            0.5 * (filtered[(3 * a + i, 3 * b + j)] + filtered[(3 * b + j, 3 * a + i)])
        });
    }
    filtered.iter().all(|value| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::Stream;

    #[test]
    fn negative_eigenvalues_vanish_or_change_sign_and_others_stay() {
        let count = 3;
        let mut stream = Stream::new(4);
        let full = DMatrix::from_fn(9, 9, |_, _| stream.next());
        let full = &full + full.transpose();
        let blocks = |matrix: &DMatrix<f64>| -> Vec<Matrix3<f64>> {
            let block =
                |k: usize| Matrix3::from_fn(|i, j| matrix[(3 * (k / count) + i, 3 * (k % count) + j)]);
            (0..count * count).map(block).collect()
        };
        let eigenvalues = |blocks: &[Matrix3<f64>]| -> Vec<f64> {
            let dense = DMatrix::from_fn(9, 9, |i, j| blocks[i / 3 * count + j / 3][(i % 3, j % 3)]);
            let mut values: Vec<f64> = dense.symmetric_eigenvalues().iter().copied().collect();
            values.sort_by(f64::total_cmp);
            values
        };
        let before = eigenvalues(&blocks(&full));
        assert!(before[0] < -0.1 && before[8] > 0.1, "{before:?}");
        for filter in [Filter::Clamp, Filter::Absolute, Filter::Exact] {
            let mut filtered = blocks(&full);
            assert!(filter_matrix(count, &mut filtered, filter));
            let mut expected: Vec<f64> = before.iter().map(|&value| filter.apply(value)).collect();
            expected.sort_by(f64::total_cmp);
            for (value, expected) in eigenvalues(&filtered).iter().zip(expected) {
                assert!((value - expected).abs() < 1e-13, "{filter:?}: {value} {expected}");
            }
        }
        let mut huge = blocks(&(full * 1e308));
        assert!(!filter_matrix(count, &mut huge, Filter::Clamp));
    }
}
