//! Twin of `shader/release.wgsl`.

use super::curve_edges::WEIGHT_UNITS;
use super::{difference, scaled};
use crate::bound::Bound;
use crate::layout::{Late, Vertex};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub vertices: u32,
}

const MOST_PROXIMAL: f32 = 100.0;
const MOST_IDLE_STEPS: u32 = 6;

pub fn bound(buffers: Bound<'_>) {
    release(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &mut buffers.write(3),
        &mut buffers.write(4),
        &buffers.read(5),
        &buffers.read(6),
    );
}

pub fn release(
    params: Params,
    positions: &[[i32; 4]],
    targets: &[[i32; 4]],
    vertices: &[Vertex],
    proximal: &mut [u32],
    displacements: &mut [[f32; 4]],
    swings: &[[f32; 4]],
    late: &[Late],
) {
    for v in 0..params.vertices as usize {
        let vertex = vertices[v];
        let wanted = difference(targets[v], positions[v]);
        if vertex.flags & Vertex::PRESCRIBED != 0 {
            let [x, y, z] = if late[v].idle_steps >= MOST_IDLE_STEPS { [0.0; 3] } else { wanted };
            displacements[v] = [x, y, z, 0.0];
        } else {
            let damping = (proximal[v] as f32 / WEIGHT_UNITS * swings[v][3]).min(MOST_PROXIMAL * vertex.mass);
            let weight = 1.0 / (vertex.mass + damping);
            let [x, y, z] = scaled(wanted, weight * vertex.mass);
            displacements[v] = [x, y, z, weight];
        }
        proximal[v] = 0;
    }
}
