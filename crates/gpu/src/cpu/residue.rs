//! Twin of `shader/residue.wgsl`.

use super::newton::{padded, xyz};
use super::{scaled, subtracted};
use crate::bound::Bound;
use crate::newton::Solve;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub subtract: u32,
}

pub fn bound(buffers: Bound<'_>) {
    residue(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read::<Solve>(2)[0],
        &mut buffers.write(3),
    );
}

pub fn residue(
    params: Params,
    right_side: &[[f32; 4]],
    image: &[[f32; 4]],
    solve: &Solve,
    direction: &mut [[f32; 4]],
) {
    if solve.ended == 0 {
        return;
    }
    for i in 0..params.nodes as usize {
        let b = right_side[i];
        let mut r = [0.0; 3];
        if b[3] == 1.0 {
            r = xyz(b);
            if params.subtract == 1 {
                r = subtracted(r, xyz(image[i]));
            }
            r = scaled(r, solve.factor);
        }
        direction[i] = padded(r);
    }
}
