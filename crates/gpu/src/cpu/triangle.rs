//! Triangles of constant strain: twin of `shader/shared/triangle.wgsl`.

use super::elements::{TINY, any_normal, first_axis, length};
use super::{added, divided, dot, scaled, subtracted};

type V3 = [f32; 3];

/// F = s1 u1 v1^T + s2 u2 v2^T with v1 = (c, s) and v2 = (-s, c).
#[derive(Clone, Copy)]
pub struct Stretch {
    pub u1: V3,
    pub u2: V3,
    pub c: f32,
    pub s: f32,
    pub s1: f32,
    pub s2: f32,
}

/// Columns of F, or of a change of F, from the ways to nodes 1 and 2.
pub fn columns(g: [f32; 4], e1: V3, e2: V3) -> [V3; 2] {
    [added(scaled(e1, g[0]), scaled(e2, g[2])), added(scaled(e1, g[1]), scaled(e2, g[3]))]
}

pub fn stretch_of([f0, f1]: [V3; 2]) -> Stretch {
    let [c, s] = first_axis(dot(f0, f0), dot(f1, f1), dot(f0, f1));
    let w1 = added(scaled(f0, c), scaled(f1, s));
    let s1 = length(w1);
    let u1 = if s1 > TINY { divided(w1, s1) } else { [1.0, 0.0, 0.0] };
    let mut w2 = subtracted(scaled(f1, c), scaled(f0, s));
    w2 = subtracted(w2, scaled(u1, dot(u1, w2)));
    let s2 = length(w2);
    let u2 = if s2 > 1e-6 * s1 && s2 > TINY { divided(w2, s2) } else { any_normal(u1) };
    Stretch { u1, u2, c, s, s1, s2 }
}

impl Stretch {
    /// The strain U - I: components 11, 22, 12 in the axes of the weave.
    pub fn strain(&self) -> V3 {
        let Self { c, s, .. } = *self;
        let (d1, d2) = (self.s1 - 1.0, self.s2 - 1.0);
        [c * c * d1 + s * s * d2, s * s * d1 + c * c * d2, c * s * (d1 - d2)]
    }

    /// The singular values over their sum.
    pub fn shares(&self) -> [f32; 2] {
        let sum = self.s1 + self.s2;
        if sum > TINY { [self.s1 / sum, self.s2 / sum] } else { [0.5, 0.5] }
    }
}

/// The stress of a strain, both by components 11, 22, 12 in the axes of the weave.
pub fn stress_of(stiffness: [f32; 4], strain: V3) -> V3 {
    [
        stiffness[0] * strain[0] + stiffness[1] * strain[1],
        stiffness[1] * strain[0] + stiffness[2] * strain[1],
        2.0 * stiffness[3] * strain[2],
    ]
}

/// The same, turned into the frame v.
pub fn stress_in(stiffness: [f32; 4], strain: V3, c: f32, s: f32) -> V3 {
    let [t11, t22, t12] = stress_of(stiffness, strain);
    [
        c * c * t11 + 2.0 * c * s * t12 + s * s * t22,
        s * s * t11 - 2.0 * c * s * t12 + c * c * t22,
        c * s * (t22 - t11) + (c * c - s * s) * t12,
    ]
}

/// The increment of Green's strain (11, 22, 12) to F, which has changed by d.
pub fn increment([f0, f1]: [V3; 2], [d0, d1]: [V3; 2]) -> V3 {
    [
        0.5 * dot(d0, subtracted(scaled(f0, 2.0), d0)),
        0.5 * dot(d1, subtracted(scaled(f1, 2.0), d1)),
        0.5 * (dot(d0, f1) + dot(subtracted(f0, d0), d1)),
    ]
}
