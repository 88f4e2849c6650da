//! Twin of `shader/join.wgsl`.

use super::scaled;
use crate::bound::Bound;
use crate::layout::{NONE, Vertex};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub vertices: u32,
}

pub fn bound(buffers: Bound<'_>) {
    join(buffers.params(), &buffers.read(0), &buffers.read(1), &mut buffers.write(2), &mut buffers.write(3));
}

pub fn join(
    params: Params,
    vertices: &[Vertex],
    group_caps: &[u32],
    paths: &mut [[f32; 4]],
    alphas: &mut [u32],
) {
    for v in 0..params.vertices as usize {
        let group = vertices[v].group;
        let mut path = paths[v];
        if group != NONE {
            let cap = f32::from_bits(group_caps[group as usize]);
            if cap < path[3] {
                let [x, y, z] = scaled([path[0], path[1], path[2]], cap / path[3]);
                path = [x, y, z, cap];
                paths[v] = path;
            }
        }
        alphas[v] = path[3].to_bits();
    }
}
