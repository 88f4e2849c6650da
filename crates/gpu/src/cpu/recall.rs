//! Twin of `shader/recall.wgsl`.

use super::difference;
use crate::bound::Bound;
use crate::layout::NONE;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub vertices: u32,
    pub table: u32,
}

pub fn bound(buffers: Bound<'_>) {
    recall(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &mut buffers.write(2),
        &mut buffers.write(3),
    );
}

pub fn recall(
    params: Params,
    positions: &[[i32; 4]],
    aims: &[[i32; 4]],
    displacements: &mut [[f32; 4]],
    table: &mut [u32],
) {
    for v in 0..params.vertices as usize {
        let [x, y, z] = difference(aims[v], positions[v]);
        displacements[v] = [x, y, z, 0.0];
    }
    table[..params.table as usize].fill(NONE);
}
