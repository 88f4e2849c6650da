//! Twin of `shader/strand_energy.wgsl`.

use super::elements::length;
use super::energies::{States, write};
use super::parts::{Part, part};
use super::{added, dot, scaled, subtracted};
use crate::assembly::Strand;
use crate::bound::Bound;

type V3 = [f32; 3];

pub fn bound(buffers: Bound<'_>) {
    write(buffers, energy);
}

/// The sum of the lengths of what w, or a change of it, is the difference of.
fn sizes(strand: &Strand, way: impl Fn(u32, u32) -> V3) -> f32 {
    let [n0, n1, n2] = strand.nodes;
    let [a, c] = strand.inverse_lengths;
    c * length(way(n1, n2)) + a * length(way(n0, n1))
}

fn energy(strand: &Strand, states: &States<'_>) -> Part {
    let w = strand.jump(|a, b| states.way(a, b));
    let dw = strand.jump(|a, b| states.change(a, b));
    let size = length(w);
    let both = size + length(added(w, dw));
    let dq = if both > 0.0 { dot(dw, added(scaled(w, 2.0), dw)) / both } else { 0.0 };
    let moves = sizes(strand, |a, b| states.change(a, b));
    let reach = sizes(strand, |a, b| states.way(a, b)) + moves;
    let strain = size - strand.rest;
    let changed = if strand.is_edge() { dq.abs() } else { moves };
    let error = changed * (reach + strand.rest) + moves * (strain.abs() + dq.abs());
    let mut out = [0.5 * strain * strain, dq * (strain + 0.5 * dq), error];
    let params = states.params;
    if strand.damping > 0.0 && params.rate > 0.0 {
        let turned = strand.jump(|a, b| states.moved(a, b));
        let viscous = if strand.is_edge() {
            let before = 0.5 * dot(turned, subtracted(scaled(w, 2.0), turned));
            let de = 0.5 * dot(dw, added(scaled(w, 2.0), dw));
            let de_size = moves * reach;
            let before_size = length(turned) * (reach + 0.5 * length(turned));
            [0.5 * before * before, de * (before + 0.5 * de), de_size * (before_size + de_size)]
        } else {
            let moved = sizes(strand, |a, b| states.moved(a, b));
            [0.5 * dot(turned, turned), dot(dw, added(turned, scaled(dw, 0.5))), moves * (moved + moves)]
        };
        out = added(out, scaled(viscous, strand.damping * params.rate));
    }
    part(scaled(out, strand.stiffness))
}
