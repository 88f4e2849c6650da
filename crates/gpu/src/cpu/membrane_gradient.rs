//! Twin of `shader/membrane_gradient.wgsl`.

use super::gradients::{Places, write};
use super::triangle::{columns, increment, stress_in, stretch_of};
use super::{added, negated, scaled};
use crate::assembly::Membrane;
use crate::bound::Bound;

type V3 = [f32; 3];

pub fn bound(buffers: Bound<'_>) {
    write(buffers, gradient);
}

fn gradient(m: &Membrane, places: &Places<'_>) -> [V3; 3] {
    let g = m.gradients;
    let f = columns(g, places.way(m.nodes[0], m.nodes[1]), places.way(m.nodes[0], m.nodes[2]));
    let x = stretch_of(f);
    let [t11, t22, t12] = stress_in(m.stiffness, x.strain(), x.c, x.s);
    let [r1, r2] = x.shares();
    let mut p = [t11, 2.0 * t12 * r1, 2.0 * t12 * r2, t22];
    if m.damping > 0.0 && places.params.rate > 0.0 {
        let moved = [1, 2].map(|k| places.moved(m.nodes[0], m.nodes[k]));
        let strain = increment(f, columns(g, moved[0], moved[1]));
        let [v11, v22, v12] =
            scaled(stress_in(m.stiffness, strain, x.c, x.s), m.damping * places.params.rate);
        let viscous = [x.s1 * v11, x.s1 * v12, x.s2 * v12, x.s2 * v22];
        p.iter_mut().zip(viscous).for_each(|(p, v)| *p += v);
    }
    let along = |g0: f32, g1: f32| [x.c * g0 + x.s * g1, x.c * g1 - x.s * g0];
    let force = |[a, b]: [f32; 2]| {
        let sum = added(scaled(x.u1, p[0] * a + p[1] * b), scaled(x.u2, p[2] * a + p[3] * b));
        scaled(sum, m.area)
    };
    let (first, second) = (force(along(g[0], g[1])), force(along(g[2], g[3])));
    [negated(added(first, second)), first, second]
}
