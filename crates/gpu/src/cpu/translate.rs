//! Twin of `shader/translate.wgsl`.

use super::added;
use super::newton::{is_free, padded, xyz};
use crate::bound::Bound;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
}

pub fn bound(buffers: Bound<'_>) {
    translate(buffers.params(), &buffers.read(0), &buffers.read(1), &buffers.read(2), &mut buffers.write(3));
}

pub fn translate(
    params: Params,
    blocks: &[u32],
    translations: &[[f32; 4]],
    free: &[u32],
    step: &mut [[f32; 4]],
) {
    for i in (0..params.nodes as usize).filter(|i| is_free(free, *i)) {
        step[i] = padded(added(xyz(step[i]), xyz(translations[blocks[i] as usize])));
    }
}
