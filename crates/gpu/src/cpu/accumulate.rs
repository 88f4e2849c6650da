//! Twin of `shader/accumulate.wgsl`.

use super::newton::{padded, xyz};
use super::{added, scaled};
use crate::bound::Bound;
use crate::linear::Progress;
use crate::newton::Solve;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub last: u32,
}

pub fn bound(buffers: Bound<'_>) {
    accumulate(
        buffers.params(),
        &buffers.read(0),
        &buffers.write::<Progress>(1)[0],
        &mut buffers.write::<Progress>(2)[0],
        &mut buffers.write::<Solve>(3)[0],
        &mut buffers.write(4),
    );
}

pub fn accumulate(
    params: Params,
    solution: &[[f32; 4]],
    progress: &Progress,
    ended: &mut Progress,
    solve: &mut Solve,
    step: &mut [[f32; 4]],
) {
    let ends = params.last == 1 || progress.moving == 0;
    ended.moving = u32::from(ends);
    solve.ended = u32::from(ends);
    if !ends {
        return;
    }
    for (p, x) in step.iter_mut().zip(solution).take(params.nodes as usize) {
        *p = padded(added(xyz(*p), scaled(xyz(*x), solve.inverse)));
    }
}
