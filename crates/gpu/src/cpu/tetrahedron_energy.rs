//! Twin of `shader/tetrahedron_energy.wgsl`.

use super::energies::{States, write};
use super::logarithm::log_1p;
use super::parts::{Part, part};
use super::solid::{columns, green_increment, green_strain, law_stress};
use super::{added, crossed, dot, scaled};
use crate::assembly::Tetrahedron;
use crate::bound::Bound;

type V3 = [f32; 3];

pub fn bound(buffers: Bound<'_>) {
    write(buffers, energy);
}

fn product(a: [V3; 3], b: [V3; 3]) -> f32 {
    dot(a[0], b[0]) + dot(a[1], b[1]) + dot(a[2], b[2])
}

/// Stable neo-Hookean energy density, accurate near rest.
fn density(tet: &Tetrahedron, strain: [V3; 3], j: f32) -> f32 {
    let trace = strain[0][0] + strain[1][1] + strain[2][2];
    let second = 0.5 * (trace * trace - product(strain, strain));
    let third = dot(strain[0], crossed(strain[1], strain[2]));
    let (grow, first_order) = if j > 0.5 {
        let grow = (2.0 * trace + 4.0 * second + 8.0 * third) / (j + 1.0);
        (grow, (2.0 * trace * grow - 8.0 * second - 16.0 * third) / (j + 1.0))
    } else {
        (j - 1.0, 2.0 * trace - 2.0 * (j - 1.0))
    };
    let half = 0.5 * trace;
    0.375 * tet.mu * first_order + 0.5 * tet.mu * (half - log_1p(half)) + 0.5 * tet.lambda * grow * grow
}

fn energy(tet: &Tetrahedron, states: &States<'_>) -> Part {
    let f = columns(tet, |a, b| states.way(a, b));
    let d = columns(tet, |a, b| states.change(a, b));
    let t = [0, 1, 2].map(|k| added(f[k], d[k]));
    let strain = green_strain(f);
    let turn = green_increment(t, d);
    let middle = |strain: [V3; 3]| [0, 1, 2].map(|k| added(strain[k], scaled(turn[k], 0.5)));
    let moves = product(d, d).sqrt();
    let large = product(f, f).sqrt() + moves;
    let turn_size = moves * large;
    let mut out = if tet.law == 0 {
        [
            0.5 * product(law_stress(strain, tet.lambda, tet.mu), strain),
            product(law_stress(middle(strain), tet.lambda, tet.mu), turn),
            (2.0 * tet.mu + 3.0 * tet.lambda) * 0.5 * (large * large + 3.0) * turn_size,
        ]
    } else {
        let across = crossed(f[1], f[2]);
        let across_change = added(crossed(d[1], t[2]), crossed(f[1], d[2]));
        let j = dot(f[0], across);
        let dj = dot(d[0], added(across, across_change)) + dot(f[0], across_change);
        let di = product(d, [0, 1, 2].map(|k| added(f[k], t[k])));
        let logarithm = log_1p(di / (product(f, f) + 1.0));
        let pressure = tet.lambda * (j + 0.5 * dj - 1.0) - 0.75 * tet.mu;
        let pressure_size = tet.lambda * (0.2 * large * large * large + 1.0) + 0.75 * tet.mu;
        [
            density(tet, strain, j),
            0.5 * tet.mu * (di - logarithm) + pressure * dj,
            2.0 * tet.mu * turn_size + pressure_size * 0.6 * large * turn_size,
        ]
    };
    if tet.viscous_mu > 0.0 && states.params.rate > 0.0 {
        let h = columns(tet, |a, b| states.moved(a, b));
        let [lambda, mu] = [tet.viscous_lambda, tet.viscous_mu].map(|v| v * states.params.rate);
        let before = green_increment(f, h);
        let way_since = product(h, h).sqrt();
        let viscous = [
            0.5 * product(law_stress(before, lambda, mu), before),
            product(law_stress(middle(before), lambda, mu), turn),
            (2.0 * mu + 3.0 * lambda) * (way_since * (large + way_since) + turn_size) * turn_size,
        ];
        out = added(out, viscous);
    }
    let [reference, change, size] = scaled(out, tet.volume);
    part([reference, change, size])
}
