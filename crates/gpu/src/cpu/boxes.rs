//! Twin of `shader/boxes.wgsl`.

use crate::bound::Bound;
use crate::layout::{Ball, Control, NONE, NodeBox, Slot, Vertex};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub slots: u32,
    pub count: u32,
}

pub fn bound(buffers: Bound<'_>) {
    boxes(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &mut buffers.write(3),
        &buffers.read::<Control>(4)[0],
    );
}

fn grown(node: NodeBox, ball: Ball, vertex: Vertex) -> NodeBox {
    let reach = ball.radius + vertex.margin.ceil() as i32;
    let mut node = NodeBox { deformable: node.deformable | (1 - (vertex.flags & Vertex::OBSTACLE)), ..node };
    for k in 0..3 {
        node.low[k] = node.low[k].min(ball.center[k] - reach);
        node.high[k] = node.high[k].max(ball.center[k] + reach);
    }
    node
}

pub fn boxes(
    params: Params,
    slots: &[Slot],
    balls: &[Ball],
    vertices: &[Vertex],
    boxes: &mut [NodeBox],
    control: &Control,
) {
    if control.changed == 0 {
        return;
    }
    for s in 0..params.slots as usize {
        let slot = slots[s];
        let mut node = NodeBox::EMPTY;
        if slot.element != NONE {
            for v in slot.vertices.into_iter().take(params.count as usize) {
                node = grown(node, balls[v as usize], vertices[v as usize]);
            }
        }
        boxes[s] = node;
    }
}
