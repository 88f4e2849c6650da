// Filters negative eigenvalues of a symmetric matrix of the order ORDER, stored row by row, by Jacobi's
// method: rotations of pairs of coordinates make it diagonal (G. H. Golub and C. F. Van Loan, "Matrix
// Computations", section 8.5).

// Entries beside the diagonal up to this share of the largest entry count as zero.
const NEGLIGIBLE: f32 = 1e-8;

const SWEEPS: u32 = 6u;

// Whether all pivots of a Cholesky factorization are positive: nothing must be filtered then.
fn is_definite(matrix: array<f32, ORDER * ORDER>, largest: f32) -> bool {
    var a = matrix;
    for (var k = 0u; k < ORDER; k += 1u) {
        let pivot = a[(ORDER + 1u) * k];
        if pivot <= 1e-6 * largest {
            return false;
        }
        for (var i = k + 1u; i < ORDER; i += 1u) {
            let factor = a[ORDER * i + k] / pivot;
            for (var j = k + 1u; j < ORDER; j += 1u) {
                a[ORDER * i + j] -= factor * a[ORDER * k + j];
            }
        }
    }
    return true;
}

fn filtered_matrix(matrix: array<f32, ORDER * ORDER>) -> array<f32, ORDER * ORDER> {
    var a = matrix;
    var largest = 0.0;
    for (var k = 0u; k < ORDER * ORDER; k += 1u) {
        largest = max(largest, abs(a[k]));
    }
    if is_definite(a, largest) {
        return a;
    }
    var v: array<f32, ORDER * ORDER>;
    for (var k = 0u; k < ORDER; k += 1u) {
        v[(ORDER + 1u) * k] = 1.0;
    }
    for (var sweep = 0u; sweep < SWEEPS; sweep += 1u) {
        for (var p = 0u; p < ORDER; p += 1u) {
            for (var q = p + 1u; q < ORDER; q += 1u) {
                let pq = a[ORDER * p + q];
                if abs(pq) > NEGLIGIBLE * largest {
                    let tau = (a[(ORDER + 1u) * q] - a[(ORDER + 1u) * p]) / (2.0 * pq);
                    let size = 1.0 / (abs(tau) + sqrt(1.0 + tau * tau));
                    let t = select(-size, size, tau >= 0.0);
                    let c = 1.0 / sqrt(1.0 + t * t);
                    let s = t * c;
                    for (var k = 0u; k < ORDER; k += 1u) {
                        let x = a[ORDER * k + p];
                        let y = a[ORDER * k + q];
                        a[ORDER * k + p] = c * x - s * y;
                        a[ORDER * k + q] = s * x + c * y;
                        let z = v[ORDER * k + p];
                        let w = v[ORDER * k + q];
                        v[ORDER * k + p] = c * z - s * w;
                        v[ORDER * k + q] = s * z + c * w;
                    }
                    for (var k = 0u; k < ORDER; k += 1u) {
                        let x = a[ORDER * p + k];
                        let y = a[ORDER * q + k];
                        a[ORDER * p + k] = c * x - s * y;
                        a[ORDER * q + k] = s * x + c * y;
                    }
                }
            }
        }
    }
    var sum: array<f32, ORDER * ORDER>;
    for (var k = 0u; k < ORDER; k += 1u) {
        let value = filtered(a[(ORDER + 1u) * k]);
        for (var i = 0u; i < ORDER; i += 1u) {
            for (var j = 0u; j < ORDER; j += 1u) {
                sum[ORDER * i + j] += value * v[ORDER * i + k] * v[ORDER * j + k];
            }
        }
    }
    return sum;
}
