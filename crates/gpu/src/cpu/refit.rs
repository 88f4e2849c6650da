//! Twin of `shader/refit.wgsl`.

use crate::bound::Bound;
use crate::layout::{BRANCHING, Control, NodeBox};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub first: u32,
    pub nodes: u32,
    pub first_child: u32,
    pub children: u32,
}

pub fn bound(buffers: Bound<'_>) {
    refit(buffers.params(), &mut buffers.write(0), &buffers.read::<Control>(1)[0]);
}

pub fn refit(params: Params, boxes: &mut [NodeBox], control: &Control) {
    if control.changed == 0 {
        return;
    }
    for n in 0..params.nodes as usize {
        let (first, end) = (BRANCHING * n, (BRANCHING * n + BRANCHING).min(params.children as usize));
        let mut node = boxes[params.first_child as usize + first];
        for child in first + 1..end {
            let other = boxes[params.first_child as usize + child];
            for k in 0..3 {
                node.low[k] = node.low[k].min(other.low[k]);
                node.high[k] = node.high[k].max(other.high[k]);
            }
            node.deformable |= other.deformable;
        }
        boxes[params.first as usize + n] = node;
    }
}
