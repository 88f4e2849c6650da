//! Twin of `shader/advance.wgsl`.

use super::{difference, dot, scaled, truncated};
use crate::bound::Bound;
use crate::layout::{Control, Late, NONE, Vertex};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub vertices: u32,
}

const LEAST_PROGRESS: f32 = 1e-3;

pub fn bound(buffers: Bound<'_>) {
    advance(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &buffers.read(3),
        &buffers.read(4),
        &mut buffers.write(5),
        &mut buffers.write::<Control>(6)[0],
        &mut buffers.write(7),
    );
}

fn note_progress(late: &mut Late, left: f32, edge: f32) {
    late.idle_steps += 1;
    if left < late.smallest - LEAST_PROGRESS * edge {
        *late = Late { smallest: left, idle_steps: 0 };
    }
    if left == 0.0 {
        late.idle_steps = 0;
    }
}

pub fn advance(
    params: Params,
    targets: &[[i32; 4]],
    vertices: &[Vertex],
    paths: &[[f32; 4]],
    alphas: &[u32],
    group_alphas: &[u32],
    positions: &mut [[i32; 4]],
    control: &mut Control,
    late: &mut [Late],
) {
    if control.overflow != 0 {
        return;
    }
    for v in 0..params.vertices as usize {
        let vertex = vertices[v];
        let mut alpha = f32::from_bits(alphas[v]);
        if vertex.group != NONE {
            alpha = f32::from_bits(group_alphas[vertex.group as usize]);
        }
        let position = positions[v];
        let displacement = difference(targets[v], position);
        let length = dot(displacement, displacement).sqrt();
        let left = (1.0 - alpha) * length;
        if vertex.flags & Vertex::PRESCRIBED != 0 {
            control.lag = control.lag.max(left.to_bits());
            note_progress(&mut late[v], left, vertex.edge);
        } else {
            control.free_remaining = control.free_remaining.max(left.to_bits());
            control.free_move = control.free_move.max((alpha * length).to_bits());
        }
        control.largest_move = control.largest_move.max((alpha * length).to_bits());
        if alpha >= paths[v][3] {
            control.unhindered = control.unhindered.max(left.to_bits());
            if vertex.flags & Vertex::PRESCRIBED != 0 {
                control.unhindered_lag = control.unhindered_lag.max(left.to_bits());
            }
        }
        if alpha == 1.0 {
            positions[v] = targets[v];
        } else {
            let step = truncated(scaled(displacement, alpha));
            positions[v] = [position[0] + step[0], position[1] + step[1], position[2] + step[2], 0];
        }
    }
}
