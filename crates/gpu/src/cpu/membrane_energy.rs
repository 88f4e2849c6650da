//! Twin of `shader/membrane_energy.wgsl`.

use super::elements::{TINY, length};
use super::energies::{States, write};
use super::parts::{Part, part};
use super::triangle::{columns, increment, stress_of};
use super::{added, crossed, divided, dot, scaled, subtracted};
use crate::assembly::Membrane;
use crate::bound::Bound;

type V3 = [f32; 3];

pub fn bound(buffers: Bound<'_>) {
    write(buffers, energy);
}

fn absolute(v: V3) -> V3 {
    v.map(f32::abs)
}

/// The sizes of the stresses of strains of these sizes.
fn stress_size(stiffness: [f32; 4], strain: V3) -> V3 {
    let [c11, c12, c22, shear] = stiffness.map(f32::abs);
    [c11 * strain[0] + c12 * strain[1], c12 * strain[0] + c22 * strain[1], 2.0 * shear * strain[2]]
}

/// The product of a stress and a strain, both by components 11, 22, 12.
fn work(stress: V3, strain: V3) -> f32 {
    stress[0] * strain[0] + stress[1] * strain[1] + 2.0 * stress[2] * strain[2]
}

fn energy(m: &Membrane, states: &States<'_>) -> Part {
    let ways = |way: &dyn Fn(u32, u32) -> V3| {
        columns(m.gradients, way(m.nodes[0], m.nodes[1]), way(m.nodes[0], m.nodes[2]))
    };
    let [f0, f1] = ways(&|a, b| states.way(a, b));
    let [d0, d1] = ways(&|a, b| states.change(a, b));
    let (t0, t1) = (added(f0, d0), added(f1, d1));

    let c = [dot(f0, f0), dot(f1, f1), dot(f0, f1)];
    let dc = [dot(d0, added(f0, t0)), dot(d1, added(f1, t1)), dot(d0, t1) + dot(f0, d1)];
    let normal = crossed(f0, f1);
    let turn = added(crossed(d0, t1), crossed(f0, d1));
    let j = length(normal);
    let j_trial = length(added(normal, turn));
    let both = j + j_trial;
    let dj = if both > TINY { dot(turn, added(scaled(normal, 2.0), turn)) / both } else { 0.0 };
    let r = (c[0] + c[1] + 2.0 * j).sqrt();
    let r_trial = (dot(t0, t0) + dot(t1, t1) + 2.0 * j_trial).max(0.0).sqrt();
    let u = if r > TINY { divided([c[0] + j, c[1] + j, c[2]], r) } else { [0.0; 3] };
    let across = length(d0) * length(t1) + length(f0) * length(d1);
    let sizes = [length(d0) * length(added(f0, t0)), length(d1) * length(added(f1, t1)), across];
    let (mut du, mut size) = (u.map(|u| -u), u);
    if r_trial > TINY {
        let dr = (dc[0] + dc[1] + 2.0 * dj) / (r + r_trial);
        du = divided(subtracted(added(dc, [dj, dj, 0.0]), scaled(u, dr)), r_trial);
        let dr_size = (sizes[0] + sizes[1] + 2.0 * across) / (r + r_trial);
        let sum = added(added(sizes, [across, across, 0.0]), scaled(absolute(u), dr_size));
        size = divided(sum, r_trial);
    }
    let strain = subtracted(u, [1.0, 1.0, 0.0]);
    let mean = added(strain, scaled(du, 0.5));
    let mut out = [
        0.5 * work(stress_of(m.stiffness, strain), strain),
        work(stress_of(m.stiffness, mean), du),
        work(stress_size(m.stiffness, added(absolute(mean), [1.0; 3])), absolute(size)),
    ];
    let params = states.params;
    if m.damping > 0.0 && params.rate > 0.0 {
        let factor = m.damping * params.rate;
        let [h0, h1] = ways(&|a, b| states.moved(a, b));
        let before = increment([f0, f1], [h0, h1]);
        let between = added(before, scaled(dc, 0.25));
        let before_size = scaled(
            [
                length(h0) * length(subtracted(scaled(f0, 2.0), h0)),
                length(h1) * length(subtracted(scaled(f1, 2.0), h1)),
                length(h0) * length(f1) + length(subtracted(f0, h0)) * length(h1),
            ],
            0.5,
        );
        let viscous = [
            0.5 * work(stress_of(m.stiffness, before), before),
            0.5 * work(stress_of(m.stiffness, between), dc),
            0.5 * work(stress_size(m.stiffness, added(before_size, scaled(sizes, 0.25))), sizes),
        ];
        out = added(out, scaled(viscous, factor));
    }
    let [reference, change, size] = scaled(out, m.area);
    part([reference, change, size])
}
