//! Twin of `shader/impose.wgsl`.

use crate::bound::Bound;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub quantum: f32,
}

pub fn bound(buffers: Bound<'_>) {
    impose(buffers.params(), &buffers.read(0), &mut buffers.write(1));
}

pub fn impose(params: Params, imposed: &[[i32; 4]], direction: &mut [[f32; 4]]) {
    for (q, way) in direction.iter_mut().zip(imposed).take(params.nodes as usize) {
        let [x, y, z, _] = way.map(|x| x as f32 * params.quantum);
        *q = [x, y, z, 0.0];
    }
}
