//! Twin of `shader/resume_colors.wgsl`.

use crate::bound::Bound;
use crate::layout::{COLORS, Control, NONE, Row};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
}

pub fn bound(buffers: Bound<'_>) {
    resume_colors(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &mut buffers.write(2),
        &mut buffers.write(3),
        &mut buffers.write::<Control>(4)[0],
    );
}

pub fn resume_colors(
    params: Params,
    rows: &[Row],
    displacements: &[[f32; 4]],
    in_use: &mut [u32],
    waiting: &mut [u32],
    control: &mut Control,
) {
    for (r, row) in rows.iter().enumerate().take(control.rows.min(params.capacity) as usize) {
        let color = row.color as usize;
        if row.color == NONE {
            waiting[control.waiting as usize] = r as u32;
            control.waiting += 1;
        } else if color < COLORS {
            for v in row.vertices.map(|v| v as usize) {
                if displacements[v][3] > 0.0 {
                    in_use[4 * v + color / 32] |= 1 << (color % 32);
                }
            }
        }
    }
}
