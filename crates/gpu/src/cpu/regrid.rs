//! Twin of `shader/regrid.wgsl`.

use crate::bound::Bound;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub shift: u32,
}

pub fn bound(buffers: Bound<'_>) {
    regrid(buffers.params(), &mut buffers.write(0));
}

pub fn regrid(params: Params, positions: &mut [[i32; 4]]) {
    let half = 1 << (params.shift - 1);
    for position in positions.iter_mut().take(params.nodes as usize) {
        let [x, y, z, _] = position.map(|x| (x + half) >> params.shift);
        *position = [x, y, z, 0];
    }
}
