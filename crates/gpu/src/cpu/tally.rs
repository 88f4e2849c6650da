//! Twin of `shader/tally.wgsl`.

use crate::bound::Bound;
use crate::layout::{Control, Row};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
}

pub fn bound(buffers: Bound<'_>) {
    tally(
        buffers.params(),
        &buffers.read(0),
        &mut buffers.write(1),
        &mut buffers.write(2),
        &buffers.read::<Control>(3)[0],
    );
}

pub fn tally(
    params: Params,
    displacements: &[[f32; 4]],
    rows: &mut [Row],
    tally: &mut [u32],
    control: &Control,
) {
    for row in &mut rows[..control.rows.min(params.capacity) as usize] {
        let mut diagonal = 0.0;
        for (v, weight) in row.vertices.into_iter().zip(row.weights) {
            diagonal += displacements[v as usize][3] * weight * weight;
        }
        row.inverse_diagonal = if diagonal > 0.0 { 1.0 / diagonal } else { 0.0 };
        tally[row.color as usize] += 1;
    }
}
