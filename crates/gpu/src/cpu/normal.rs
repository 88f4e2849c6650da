//! The normal of a triangle that may be crushed: twin of `shader/shared/normal.wgsl`.

use super::dot;
use crate::assembly::Bend;

type V3 = [f32; 3];

/// n = scale m with m = f1 x f2.
#[derive(Clone, Copy)]
pub struct Normal {
    pub m: V3,
    /// m^2 + crushed^2.
    pub squared: f32,
    pub scale: f32,
}

pub fn normal_of(m: V3, crushed: f32) -> Normal {
    let squared = dot(m, m) + crushed * crushed;
    Normal { m, squared, scale: ((1.0 + crushed * crushed) / squared).sqrt() }
}

/// The factors a_ep of the residuals r_e = sum_p a_ep x_p - c_e n.
pub fn factors_of(bend: &Bend) -> [f32; 18] {
    let g = bend.gradients;
    let mut factors = bend.jumps;
    for edge in 0..3 {
        let (along, beside) = (bend.rest[3 * edge], bend.rest[3 * edge + 1]);
        let first = along * g[0] + beside * g[1];
        let second = along * g[2] + beside * g[3];
        factors[6 * edge] += first + second;
        factors[6 * edge + 1] -= first;
        factors[6 * edge + 2] -= second;
    }
    factors
}
