//! Twin of `shader/restart.wgsl`.

use crate::bound::Bound;
use crate::layout::Control;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub groups: u32,
    pub again: u32,
    pub first: u32,
}

pub fn bound(buffers: Bound<'_>) {
    restart(
        buffers.params(),
        &mut buffers.write(0),
        &mut buffers.write(1),
        &mut buffers.write::<Control>(2)[0],
    );
}

pub fn restart(params: Params, group_caps: &mut [f32], group_alphas: &mut [f32], control: &mut Control) {
    group_caps[..params.groups as usize].fill(1.0);
    group_alphas[..params.groups as usize].fill(1.0);
    let again = params.again as usize;
    let reset = again..Control::RESET_WORDS - again;
    bytemuck::cast_slice_mut::<Control, u32>(std::slice::from_mut(control))[reset].fill(0);
    if params.first != 0 {
        (control.halted, control.steps) = (0, 0);
    }
}
