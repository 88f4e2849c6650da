//! Twin of `shader/copy.wgsl`.

use crate::bound::Bound;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub words: u32,
}

pub fn bound(buffers: Bound<'_>) {
    copy(buffers.params(), &buffers.read(0), &mut buffers.write(1));
}

pub fn copy(params: Params, source: &[u32], copy: &mut [u32]) {
    let words = params.words as usize;
    copy[..words].copy_from_slice(&source[..words]);
}
