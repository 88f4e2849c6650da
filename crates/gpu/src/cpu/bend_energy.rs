//! Twin of `shader/bend_energy.wgsl`.

use super::elements::length;
use super::energies::{States, write};
use super::normal::{factors_of, normal_of};
use super::parts::{Part, part};
use super::triangle::columns;
use super::{added, crossed, dot, scaled, subtracted};
use crate::assembly::Bend;
use crate::bound::Bound;
use crate::layout::NONE;

type V3 = [f32; 3];

pub fn bound(buffers: Bound<'_>) {
    write(buffers, energy);
}

fn energy(bend: &Bend, states: &States<'_>) -> Part {
    let from = |way: &dyn Fn(u32, u32) -> V3| {
        bend.nodes.map(|node| if node == NONE { [0.0; 3] } else { way(bend.nodes[0], node) })
    };
    let ways = from(&|a, b| states.way(a, b));
    let changes = from(&|a, b| states.change(a, b));
    let g = bend.gradients;
    let [f1, f2] = columns(g, ways[1], ways[2]);
    let [d1, d2] = columns(g, changes[1], changes[2]);
    let normal = normal_of(crossed(f1, f2), bend.crushed);
    let dm = added(crossed(d1, added(f2, d2)), crossed(f1, d2));
    let dm_size = length(d1) * length(added(f2, d2)) + length(f1) * length(d2);
    let trial = normal_of(added(normal.m, dm), bend.crushed);
    let (q, q_trial) = (normal.squared.sqrt(), trial.squared.sqrt());
    let dq = dot(dm, added(scaled(normal.m, 2.0), dm)) / (q + q_trial);
    let dn = subtracted(scaled(dm, trial.scale), scaled(normal.m, normal.scale * dq / q_trial));
    let n = scaled(normal.m, normal.scale);
    let factors = factors_of(bend);
    let (mut residuals, mut turns, mut means) = ([[0.0; 3]; 3], [[0.0; 3]; 3], [[0.0; 3]; 3]);
    let (mut sizes, mut turn_sizes) = ([0.0; 3], [0.0; 3]);
    for i in 0..3 {
        let c = bend.rest[3 * i + 2];
        let (mut r, mut dr) = (scaled(n, -c), scaled(dn, -c));
        let (mut r_size, mut dr_size) = (c.abs(), 2.0 * c.abs() * dm_size * trial.scale);
        for p in 1..6 {
            let factor = factors[6 * i + p];
            r = added(r, scaled(ways[p], factor));
            dr = added(dr, scaled(changes[p], factor));
            r_size += length(ways[p]) * factor.abs();
            dr_size += length(changes[p]) * factor.abs();
        }
        residuals[i] = r;
        turns[i] = dr;
        means[i] = added(r, scaled(dr, 0.5));
        sizes[i] = r_size + 0.5 * dr_size;
        turn_sizes[i] = dr_size;
    }
    let mut out = [0.0; 3];
    for i in 0..3 {
        for k in 0..3 {
            let value = bend.gram[3 * i + k];
            out[0] += 0.5 * value * dot(residuals[i], residuals[k]);
            out[1] += value * dot(turns[i], means[k]);
            out[2] += value.abs() * turn_sizes[i] * sizes[k];
        }
    }
    part(out)
}
