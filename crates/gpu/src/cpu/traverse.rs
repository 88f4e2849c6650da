//! Twin of `shader/traverse.wgsl`.

use super::may_collide;
use crate::bound::Bound;
use crate::layout::{BRANCHING, Ball, Candidate, Control, NONE, NodeBox, Slot, Vertex};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub queries: u32,
    pub count: u32,
    pub kind: u32,
    pub symmetric: u32,
    pub first_row: u32,
    pub lists: u32,
    pub capacity: u32,
    pub levels: u32,
    pub level_first: [[u32; 4]; 3],
}

pub fn bound(buffers: Bound<'_>) {
    traverse(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &buffers.read(3),
        &buffers.read(4),
        &mut buffers.write(5),
        &mut buffers.write(6),
        &buffers.read::<Control>(7)[0],
    );
}

fn shares_vertex(a: &Slot, b: &Slot) -> bool {
    a.vertices.iter().any(|v| b.vertices.contains(v))
}

pub fn traverse(
    params: Params,
    queries: &[Slot],
    slots: &[Slot],
    boxes: &[NodeBox],
    balls: &[Ball],
    vertices: &[Vertex],
    starts: &mut [u32],
    candidates: &mut [Candidate],
    control: &Control,
) {
    if control.changed == 0 {
        return;
    }
    let first_of = |level: usize| params.level_first[level / 4][level % 4] as usize;
    let mut stack = Vec::new();
    for q in 0..params.queries as usize {
        let row = params.first_row as usize + q;
        let query = queries[q];
        if query.element == NONE {
            if params.lists == 0 {
                starts[row] = 0;
            }
            continue;
        }
        let first = if params.lists != 0 { starts[row] } else { 0 };
        let (mut low, mut high) = ([i32::MAX; 3], [-i32::MAX; 3]);
        let own = vertices[query.vertices[0] as usize];
        for v in query.vertices.into_iter().take(params.count as usize) {
            let ball = balls[v as usize];
            let reach = ball.radius + vertices[v as usize].margin.ceil() as i32;
            for k in 0..3 {
                low[k] = low[k].min(ball.center[k] - reach);
                high[k] = high[k].max(ball.center[k] + reach);
            }
        }
        let any_side = own.flags & Vertex::OBSTACLE == 0;
        let mut found = 0;
        stack.push((params.levels as usize - 1, 0));
        while let Some((level, group)) = stack.pop() {
            for node in BRANCHING * group..BRANCHING * (group + 1) {
                let area = boxes[first_of(level) + node];
                let overlaps = (0..3).all(|k| area.low[k] <= high[k] && low[k] <= area.high[k]);
                if !overlaps || !(any_side || area.deformable != 0) {
                    continue;
                }
                if level > 0 {
                    stack.push((level - 1, node));
                    continue;
                }
                let other = slots[node];
                if params.symmetric != 0 && other.element <= query.element {
                    continue;
                }
                if shares_vertex(&query, &other) || !may_collide(&own, &vertices[other.vertices[0] as usize])
                {
                    continue;
                }
                if params.lists != 0 && first < params.capacity && found < params.capacity - first {
                    let kind_and_a = params.kind << Candidate::ELEMENT_BITS | query.element;
                    candidates[(first + found) as usize] = Candidate { kind_and_a, b: other.element };
                }
                found += 1;
            }
        }
        if params.lists == 0 {
            starts[row] = found;
        }
    }
}
