//! Twin of `shader/subtract_known.wgsl`.

use super::newton::{padded, xyz};
use super::subtracted;
use crate::bound::Bound;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub count: u32,
}

pub fn bound(buffers: Bound<'_>) {
    subtract_known(buffers.params(), &buffers.read(0), &buffers.read(1), &mut buffers.write(2));
}

pub fn subtract_known(params: Params, nodes: &[u32], forces: &[[f32; 4]], gradient: &mut [[f32; 4]]) {
    for (node, force) in nodes.iter().zip(forces).take(params.count as usize) {
        let gradient = &mut gradient[*node as usize];
        *gradient = padded(subtracted(xyz(*gradient), xyz(*force)));
    }
}
