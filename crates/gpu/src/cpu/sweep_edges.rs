//! Twin of `shader/sweep_edges.wgsl`.

use super::{added, difference, dot, scaled, subtracted};
use crate::bound::Bound;
use crate::layout::EdgeLimit;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub first: u32,
    pub end: u32,
    pub only_apply: u32,
}

pub fn bound(buffers: Bound<'_>) {
    sweep_edges(buffers.params(), &buffers.read(0), &mut buffers.write(1), &mut buffers.write(2));
}

pub fn sweep_edges(
    params: Params,
    positions: &[[i32; 4]],
    limits: &mut [EdgeLimit],
    displacements: &mut [[f32; 4]],
) {
    for e in params.first as usize..params.end as usize {
        let edge = limits[e];
        let old = edge.multiplier;
        let mut change = old;
        let [ax, ay, az, a_weight] = displacements[edge.a as usize];
        let [bx, by, bz, b_weight] = displacements[edge.b as usize];
        let (a, b) = ([ax, ay, az], [bx, by, bz]);
        let total = a_weight + b_weight;
        if total <= 0.0 {
            continue;
        }
        if params.only_apply == 0 {
            let between = difference(positions[edge.a as usize], positions[edge.b as usize]);
            let along = subtracted(added(between, a), b);
            let released = added(along, scaled(old, total));
            let length = dot(released, released).sqrt();
            let mut multiplier = [0.0; 3];
            if length > edge.limit {
                multiplier = scaled(released, (length - edge.limit) / (length * total));
            }
            change = subtracted(multiplier, old);
            limits[e].multiplier = multiplier;
        }
        if a_weight > 0.0 {
            let [x, y, z] = subtracted(a, scaled(change, a_weight));
            displacements[edge.a as usize] = [x, y, z, a_weight];
        }
        if b_weight > 0.0 {
            let [x, y, z] = added(b, scaled(change, b_weight));
            displacements[edge.b as usize] = [x, y, z, b_weight];
        }
    }
}
