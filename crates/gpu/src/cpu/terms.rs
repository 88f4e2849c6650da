//! The quadratic terms of the potential: twin of `shader/shared/terms.wgsl`.

use crate::potential::Terms;

type V3 = [f32; 3];

impl Terms {
    pub fn row_sum_times(&self, x: V3) -> V3 {
        let r = self.row_sum;
        [
            r[0] * x[0] + r[1] * x[1] + r[2] * x[2],
            r[1] * x[0] + r[3] * x[1] + r[4] * x[2],
            r[2] * x[0] + r[4] * x[1] + r[5] * x[2],
        ]
    }
}

/// The difference of two positions in quanta.
pub fn between(from: [i32; 4], to: [i32; 4]) -> [i32; 3] {
    [0, 1, 2].map(|k| to[k].wrapping_sub(from[k]))
}

/// The difference of two differences.
pub fn less(a: [i32; 3], b: [i32; 3]) -> [i32; 3] {
    [0, 1, 2].map(|k| a[k].wrapping_sub(b[k]))
}
