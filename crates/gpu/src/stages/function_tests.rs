//! Functions of the shaders beside double precision, by their twins.

use crate::kernels::{group_frames, tetrahedron_energy};
use nalgebra::Matrix3;

#[test]
fn the_logarithm_has_a_small_relative_error_everywhere() {
    let worst = (1..2_000_000).map(|k| {
        let size = (f64::from(k) / 1e5 - 12.0).exp();
        [size, -size].map(|x| x as f32).into_iter().filter(|x| *x > -0.999).fold(0.0, |worst: f64, x| {
            let expected = f64::from(x).ln_1p();
            worst.max((f64::from(tetrahedron_energy::twin::log_1p(x)) / expected - 1.0).abs())
        })
    });
    let worst = worst.fold(0.0, f64::max);
    // 1 + x is rounded below the root of 1/2, where the logarithm has a size of at least 0.34.
    assert!(worst < 6e-7, "{worst:e}");
    assert!(tetrahedron_energy::twin::log_1p(0.0) == 0.0 && tetrahedron_energy::twin::log_1p(1e-20) == 1e-20);
}

#[test]
fn eigenvalues_are_filtered_as_in_double_precision() {
    let mut random = fastrand::Rng::with_seed(4);
    for case in 0..400 {
        let b = Matrix3::from_fn(|_, _| 2.0 * random.f64() - 1.0);
        let matrix = b + b.transpose();
        let mut eigen = matrix.symmetric_eigen();
        if eigen.eigenvalues.min() > -1e-3 {
            // What is definite stays as it is, and near that rounding decides.
            continue;
        }
        eigen.eigenvalues.apply(|value| *value = f64::from(group_frames::twin::filtered(*value as f32)));
        let expected = eigen.recompose();
        let found =
            group_frames::twin::filtered_matrix(std::array::from_fn(|k| matrix[(k / 3, k % 3)] as f32));
        for (k, found) in found.into_iter().enumerate() {
            let error = (f64::from(found) - expected[(k / 3, k % 3)]).abs();
            assert!(error < 4e-6 * matrix.abs().max().max(1.0), "{case}: {error:e}");
        }
    }
}
