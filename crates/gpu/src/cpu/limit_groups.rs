//! Twin of `shader/limit_groups.wgsl`.

use crate::bound::Bound;
use crate::layout::{NONE, Vertex};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub vertices: u32,
}

pub fn bound(buffers: Bound<'_>) {
    limit_groups(buffers.params(), &buffers.read(0), &buffers.read(1), &mut buffers.write(2));
}

pub fn limit_groups(params: Params, vertices: &[Vertex], alphas: &[u32], group_alphas: &mut [u32]) {
    for v in 0..params.vertices as usize {
        let group = vertices[v].group;
        if group != NONE {
            let alpha = &mut group_alphas[group as usize];
            *alpha = (*alpha).min(alphas[v]);
        }
    }
}
