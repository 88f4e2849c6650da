//! Twin of `shader/gather.wgsl`.

use crate::bound::Bound;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub width: u32,
}

pub fn bound(buffers: Bound<'_>) {
    gather(buffers.params(), &buffers.read(0), &buffers.read(1), &mut buffers.write(2));
}

pub fn gather(params: Params, nodes: &[u32], source: &[u32], copy: &mut [u32]) {
    let width = params.width as usize;
    for (entry, node) in copy.chunks_exact_mut(width).zip(nodes).take(params.nodes as usize) {
        entry.copy_from_slice(&source[width * *node as usize..][..width]);
    }
}
