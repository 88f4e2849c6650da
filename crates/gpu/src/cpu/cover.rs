//! Twin of `shader/cover.wgsl`.

use super::{added, dot, scaled, to_f32, truncated};
use crate::bound::Bound;
use crate::layout::{Ball, Control, Vertex};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub vertices: u32,
    pub all: u32,
    pub slack: f32,
    pub smallest: f32,
}

const COVERED: f32 = 0.998;
const ROOM: f32 = 4096.0;

pub fn bound(buffers: Bound<'_>) {
    cover(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &mut buffers.write(3),
        &mut buffers.write::<Control>(4)[0],
    );
}

pub fn cover(
    params: Params,
    positions: &[[i32; 4]],
    paths: &[[f32; 4]],
    vertices: &[Vertex],
    balls: &mut [Ball],
    control: &mut Control,
) {
    for v in 0..params.vertices as usize {
        let path = [paths[v][0], paths[v][1], paths[v][2]];
        let position = [positions[v][0], positions[v][1], positions[v][2]];
        let ball = balls[v];
        let start = to_f32([0, 1, 2].map(|k| position[k].wrapping_sub(ball.center[k])));
        let end = added(start, path);
        let limit = COVERED * ball.radius as f32;
        if params.all == 0 && dot(start, start) <= limit * limit && dot(end, end) <= limit * limit {
            continue;
        }
        let vertex = vertices[v];
        let length = dot(path, path).sqrt();
        let mut radius = 0.0;
        if length > 0.0 || vertex.flags & Vertex::PRESCRIBED == 0 {
            radius = (0.5 * length / (COVERED * COVERED) + params.slack * vertex.edge)
                .max(params.smallest * vertex.edge);
            radius += ROOM;
        }
        let half = truncated(scaled(path, 0.5));
        balls[v] = Ball { center: [0, 1, 2].map(|k| position[k] + half[k]), radius: radius as i32 };
        control.changed = 1;
    }
}
