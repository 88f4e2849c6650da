//! Inverses of the matrices of domains.

use super::layout::DOMAIN_UNKNOWNS;

/// A pivot at most this share of its diagonal entry counts as zero: the motion moves nothing that others do not.
const ZERO_PIVOT: f64 = 1e-11;

/// The inverse of a symmetric positive semi-definite matrix; rows and columns of pivots that vanish are zero.
pub fn inverse(mut l: Vec<f64>) -> Vec<f64> {
    const N: usize = DOMAIN_UNKNOWNS;
    // Cholesky, row by row; a dropped unknown has a zero row in L and no pivot.
    let mut pivots = [0.0f64; N];
    for i in 0..N {
        let diagonal = l[N * i + i];
        for j in 0..=i {
            let (head, tail) = l.split_at_mut(N * i);
            let (mine, theirs) =
                if j < i { (&mut tail[..N], &head[N * j..N * j + N]) } else { (&mut tail[..N], &[][..]) };
            if j < i {
                let sum: f64 = (0..j).map(|k| mine[k] * theirs[k]).sum();
                mine[j] = if pivots[j] > 0.0 { (mine[j] - sum) / pivots[j] } else { 0.0 };
            } else {
                let rest = diagonal - (0..i).map(|k| mine[k] * mine[k]).sum::<f64>();
                if rest > ZERO_PIVOT * diagonal && rest.is_finite() {
                    pivots[i] = rest.sqrt();
                } else {
                    mine[..i].fill(0.0);
                }
            }
        }
    }
    // Column c of the inverse solves L L^T y = e_c.
    let mut inverse = vec![0.0; N * N];
    for c in (0..N).filter(|&c| pivots[c] > 0.0) {
        let mut y = [0.0f64; N];
        for i in c..N {
            if pivots[i] > 0.0 {
                let sum: f64 = (c..i).map(|k| l[N * i + k] * y[k]).sum();
                y[i] = (if i == c { 1.0 } else { 0.0 } - sum) / pivots[i];
            }
        }
        for i in (c..N).rev().filter(|&i| pivots[i] > 0.0) {
            y[i] /= pivots[i];
            for k in c..i {
                y[k] -= l[N * i + k] * y[i];
            }
        }
        for i in c..N {
            inverse[N * i + c] = y[i];
            inverse[N * c + i] = y[i];
        }
    }
    inverse
}
