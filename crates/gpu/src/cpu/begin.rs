//! Twin of `shader/begin.wgsl`.

use super::{difference, dot};
use crate::bound::Bound;
use crate::layout::{EdgeLimit, Late, Vertex};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub vertices: u32,
    pub limits: u32,
    pub slips_from_here: u32,
    pub guarded_stretch: f32,
}

const START_SHARE: f32 = 0.97;

pub fn bound(buffers: Bound<'_>) {
    begin(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &mut buffers.write(2),
        &mut buffers.write(3),
        &mut buffers.write(4),
        &mut buffers.write(5),
        &mut buffers.write(6),
        &buffers.read(7),
    );
}

#[expect(clippy::too_many_arguments, reason = "the bindings of the kernel")]
pub fn begin(
    params: Params,
    positions: &[[i32; 4]],
    targets: &[[i32; 4]],
    limits: &mut [EdgeLimit],
    aims: &mut [[i32; 4]],
    slip_start: &mut [[i32; 4]],
    swings: &mut [[f32; 4]],
    late: &mut [Late],
    all: &[Vertex],
) {
    let vertices = params.vertices as usize;
    aims[..vertices].copy_from_slice(&targets[..vertices]);
    if params.slips_from_here != 0 {
        slip_start[..vertices].copy_from_slice(&positions[..vertices]);
    }
    swings[..vertices].fill([0.0; 4]);
    late[..vertices].fill(Late::NEW);
    for edge in &mut limits[..params.limits as usize] {
        let along = difference(positions[edge.a as usize], positions[edge.b as usize]);
        let is_known = (all[edge.a as usize].flags | all[edge.b as usize].flags) & Vertex::KNOWN != 0;
        let factor = if is_known { params.guarded_stretch } else { 1.0 };
        edge.limit = factor * edge.longest.max(START_SHARE * dot(along, along).sqrt());
        edge.multiplier = [0.0; 3];
    }
}
