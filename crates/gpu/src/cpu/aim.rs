//! Twin of `shader/aim.wgsl`.

use super::dot;
use crate::bound::Bound;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub vertices: u32,
    pub growth: f32,
}

const GROWTH: f32 = 2.0;
const DECAY: f32 = 0.8;
const BORDER: i32 = 536_870_911;
const FARTHEST: f32 = 1_073_741_824.0;

pub fn bound(buffers: Bound<'_>) {
    aim(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &mut buffers.write(3),
        &mut buffers.write(4),
    );
}

pub fn aim(
    params: Params,
    positions: &[[i32; 4]],
    targets: &[[i32; 4]],
    displacements: &[[f32; 4]],
    aims: &mut [[i32; 4]],
    swings: &mut [[f32; 4]],
) {
    for v in 0..params.vertices as usize {
        let [x, y, z, weight] = displacements[v];
        let mut aim = positions[v];
        if weight == 0.0 {
            aim = targets[v];
        } else if [x, y, z].iter().all(|d| d.to_bits() & 0x7fff_ffff <= FARTHEST.to_bits()) {
            for (k, d) in [x, y, z].into_iter().enumerate() {
                let near = positions[v][k].clamp(-BORDER, BORDER);
                aim[k] = (near + d.round_ties_even() as i32).clamp(-BORDER, BORDER);
            }
        }
        aims[v] = aim;
        let [last_x, last_y, last_z, mut factor] = swings[v];
        let turn = dot([x, y, z], [last_x, last_y, last_z]);
        if turn < 0.0 {
            factor = (factor * GROWTH).min(params.growth);
        } else if turn > 0.0 {
            factor = (factor * DECAY).max(1.0);
        }
        swings[v] = [x, y, z, factor.max(1.0)];
    }
}
