//! Twin of `shader/curve_edges.wgsl` and of `shader/shared/fixed.wgsl`.

use super::{difference, dot};
use crate::bound::Bound;
use crate::layout::EdgeLimit;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub edges: u32,
    pub strength: f32,
}

pub const WEIGHT_UNITS: f32 = 262_144.0;
const MOST: f32 = 128.0;

pub fn weight_units(weight: f32) -> u32 {
    (weight.clamp(0.0, MOST) * WEIGHT_UNITS) as u32
}

pub fn bound(buffers: Bound<'_>) {
    curve_edges(buffers.params(), &buffers.read(0), &buffers.read(1), &mut buffers.write(2));
}

pub fn curve_edges(params: Params, positions: &[[i32; 4]], limits: &[EdgeLimit], proximal: &mut [u32]) {
    for edge in &limits[..params.edges as usize] {
        let pull = dot(edge.multiplier, edge.multiplier).sqrt();
        if pull > 0.0 {
            let along = difference(positions[edge.a as usize], positions[edge.b as usize]);
            let length = dot(along, along).sqrt().max(1.0);
            let units = weight_units(params.strength * pull / length);
            for v in [edge.a, edge.b] {
                proximal[v as usize] = proximal[v as usize].wrapping_add(units);
            }
        }
    }
}
