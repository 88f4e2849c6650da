//! Twin of `shader/stretch.wgsl`.

use super::{difference, dot};
use crate::bound::Bound;
use crate::layout::{Control, EdgeLimit};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub edges: u32,
}

pub fn bound(buffers: Bound<'_>) {
    stretch(buffers.params(), &buffers.read(0), &buffers.read(1), &mut buffers.write::<Control>(2)[0]);
}

pub fn stretch(params: Params, positions: &[[i32; 4]], limits: &[EdgeLimit], control: &mut Control) {
    for limit in &limits[..params.edges as usize] {
        let edge = difference(positions[limit.b as usize], positions[limit.a as usize]);
        let ratio = dot(edge, edge).sqrt() / limit.limit;
        control.stretch_to_limit = control.stretch_to_limit.max(ratio.to_bits());
    }
}
