//! Twin of `shader/near_planes.wgsl`.

use super::{dot, largest, to_f32};
use crate::bound::Bound;
use crate::layout::{Ball, Candidate, Control, Kind, NONE, Plane, Slot, Vertex};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub queries: u32,
    pub planes: u32,
    pub first_row: u32,
    pub lists: u32,
    pub capacity: u32,
}

const POINT_ROUNDING: f32 = 1.0;

pub fn bound(buffers: Bound<'_>) {
    near_planes(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &buffers.read(3),
        &mut buffers.write(4),
        &mut buffers.write(5),
        &buffers.read::<Control>(6)[0],
    );
}

pub fn near_planes(
    params: Params,
    queries: &[Slot],
    planes: &[Plane],
    balls: &[Ball],
    vertices: &[Vertex],
    starts: &mut [u32],
    candidates: &mut [Candidate],
    control: &Control,
) {
    if control.changed == 0 {
        return;
    }
    for q in 0..params.queries as usize {
        let row = params.first_row as usize + q;
        let query = queries[q];
        let first = if params.lists != 0 { starts[row] } else { 0 };
        let v = query.vertices[0] as usize;
        let mut found = 0;
        if query.element != NONE && vertices[v].flags & Vertex::OBSTACLE == 0 {
            let ball = balls[v];
            let reach = ball.radius as f32 + 2.0 * vertices[v].margin;
            for (p, plane) in planes.iter().enumerate().take(params.planes as usize) {
                let offset = to_f32([0, 1, 2].map(|k| ball.center[k].wrapping_sub(plane.point[k])));
                let height = dot(plane.normal, offset);
                if height - plane.rounding * largest(offset) <= reach * 1.001 + POINT_ROUNDING {
                    if params.lists != 0 && first < params.capacity && found < params.capacity - first {
                        candidates[(first + found) as usize] =
                            Candidate::new(Kind::VertexHalfSpace, query.element, p as u32);
                    }
                    found += 1;
                }
            }
        }
        if params.lists == 0 {
            starts[row] = found;
        }
    }
}
