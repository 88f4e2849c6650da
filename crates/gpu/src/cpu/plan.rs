//! Twin of `shader/plan.wgsl`.

use super::{dot, scaled, to_f32};
use crate::bound::Bound;
use crate::layout::{NONE, Vertex};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub vertices: u32,
    pub longest: f32,
}

pub fn bound(buffers: Bound<'_>) {
    plan(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &mut buffers.write(3),
        &mut buffers.write(4),
    );
}

pub fn plan(
    params: Params,
    positions: &[[i32; 4]],
    targets: &[[i32; 4]],
    vertices: &[Vertex],
    paths: &mut [[f32; 4]],
    group_caps: &mut [u32],
) {
    for v in 0..params.vertices as usize {
        let vertex = vertices[v];
        let displacement = to_f32([0, 1, 2].map(|k| targets[v][k].wrapping_sub(positions[v][k])));
        let length = dot(displacement, displacement).sqrt();
        let longest = params.longest * vertex.edge;
        let mut cap = 1.0;
        if length > longest {
            cap = longest / length;
        }
        let [x, y, z] = scaled(displacement, cap);
        paths[v] = [x, y, z, cap];
        if vertex.group != NONE {
            let group = &mut group_caps[vertex.group as usize];
            *group = (*group).min(cap.to_bits());
        }
    }
}
