//! Twin of `shader/membrane.wgsl`.

use super::elements::{Elements, MIN_RATIO, first_axis};
use super::triangle::{Stretch, columns, increment, stress_in, stretch_of};
use super::{added, crossed, dot, scaled};
use crate::assembly::Membrane;
use crate::bound::Bound;

type V3 = [f32; 3];

pub fn bound(buffers: Bound<'_>) {
    let elements = Elements {
        params: buffers.params(),
        positions: &buffers.read(1),
        start: &buffers.read(2),
        blocks: &mut buffers.write(3),
    };
    membrane(&buffers.read(0), elements);
}

/// Curvature over the strain components (11, 12, 22) in the frame v1 = (c, s), v2 = (-s, c).
fn turned(stiffness: [f32; 4], c: f32, s: f32) -> [V3; 3] {
    let a = [c * c, s * s, c * s];
    let b = [-2.0 * c * s, 2.0 * c * s, c * c - s * s];
    let d = [s * s, c * c, -c * s];
    [a, b, d].map(|x| {
        let image = [
            stiffness[0] * x[0] + stiffness[1] * x[1],
            stiffness[1] * x[0] + stiffness[2] * x[1],
            4.0 * stiffness[3] * x[2],
        ];
        [dot(a, image), dot(b, image), dot(d, image)]
    })
}

/// A symmetric matrix (11, 22, 12) with its eigenvalues filtered.
fn filtered_2(elements: &Elements<'_>, m: V3) -> V3 {
    let [c, s] = first_axis(m[0], m[1], m[2]);
    let along = elements.filtered(c * c * m[0] + 2.0 * c * s * m[2] + s * s * m[1]);
    let across = elements.filtered(s * s * m[0] - 2.0 * c * s * m[2] + c * c * m[1]);
    [c * c * along + s * s * across, s * s * along + c * c * across, c * s * (along - across)]
}

pub fn membrane(membranes: &[Membrane], mut elements: Elements<'_>) {
    let params = elements.params;
    for (e, m) in membranes.iter().enumerate().take(params.elements as usize) {
        let g = m.gradients;
        let f = columns(g, elements.way(m.nodes[0], m.nodes[1]), elements.way(m.nodes[0], m.nodes[2]));
        let x = stretch_of(f);
        let Stretch { u1, u2, c, s, s1, s2 } = x;
        let n = crossed(u1, u2);

        let t = stress_in(m.stiffness, x.strain(), c, s);
        let [r1, r2] = x.shares();
        let sum = s1 + s2;
        let divisor = sum.max(MIN_RATIO);
        let stiffness = turned(m.stiffness, c, s);
        let weights = [1.0, r1, r2, 1.0];
        let (mut rates, mut viscous) = ([0.0; 4], [0.0; 3]);
        if m.damping > 0.0 && params.rate > 0.0 {
            let factor = m.damping * params.rate;
            let moved = [1, 2].map(|k| elements.moved(m.nodes[0], m.nodes[k]));
            let strain = increment(f, columns(g, moved[0], moved[1]));
            viscous = scaled(stress_in(m.stiffness, strain, c, s), factor);
            rates = [s1, 0.5 * s1, 0.5 * s2, s2].map(|rate| rate * factor.sqrt());
        }
        let mut plane: [[f32; 4]; 4] = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let k = stiffness[j.div_ceil(2)][i.div_ceil(2)];
                (weights[i] * weights[j] + rates[i] * rates[j]) * k
            })
        });
        let over = 1.0 / (divisor * divisor);
        let t12 = 2.0 * t[2] / divisor;
        let (q1, q2) = (s1 / divisor, s2 / divisor);
        plane[0][1] += t12 * q2;
        plane[0][2] -= t12 * q2;
        plane[1][0] += t12 * q2;
        plane[1][1] += (t[1] * (s2 + 2.0 * s1) - t[0] * s1) * over;
        plane[1][2] -= (t[0] * s2 + t[1] * s1) * over;
        plane[1][3] -= t12 * q1;
        plane[2][0] -= t12 * q2;
        plane[2][1] -= (t[0] * s2 + t[1] * s1) * over;
        plane[2][2] += (t[0] * (s1 + 2.0 * s2) - t[1] * s2) * over;
        plane[2][3] += t12 * q1;
        plane[3][1] -= t12 * q1;
        plane[3][2] += t12 * q1;
        for k in [0, 2] {
            plane[k][k] += viscous[0];
            plane[k][k + 1] += viscous[2];
            plane[k + 1][k] += viscous[2];
            plane[k + 1][k + 1] += viscous[1];
        }
        let normal = [t[0] / s1.max(MIN_RATIO), t[1] / s2.max(MIN_RATIO), 2.0 * t[2] / divisor];
        let normal = filtered_2(&elements, added(normal, viscous));
        let plane = elements.filtered_matrix(plane);

        let along = |g0: f32, g1: f32| [c * g0 + s * g1, c * g1 - s * g0];
        let (g1, g2) = (along(g[0], g[1]), along(g[2], g[3]));
        let shape = [[-(g1[0] + g2[0]), -(g1[1] + g2[1])], g1, g2];
        for (pair, (a, b)) in [(0, 1), (0, 2), (1, 2)].into_iter().enumerate() {
            let (a, b) = (shape[a], shape[b]);
            let local = |i: usize, j: usize| {
                let row = |r: usize| plane[r][2 * j] * b[0] + plane[r][2 * j + 1] * b[1];
                m.area * (a[0] * row(2 * i) + a[1] * row(2 * i + 1))
            };
            let local = [local(0, 0), local(0, 1), local(1, 0), local(1, 1)];
            let across = m.area
                * (a[0] * (normal[0] * b[0] + normal[2] * b[1])
                    + a[1] * (normal[2] * b[0] + normal[1] * b[1]));
            let columns = [0, 1, 2].map(|k| {
                added(
                    added(
                        scaled(u1, local[0] * u1[k] + local[1] * u2[k]),
                        scaled(u2, local[2] * u1[k] + local[3] * u2[k]),
                    ),
                    scaled(n, across * n[k]),
                )
            });
            elements.put(3 * e + pair, columns);
        }
    }
}
