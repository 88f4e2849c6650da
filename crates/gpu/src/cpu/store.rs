//! Twin of `shader/store.wgsl`.

use crate::bound::Bound;
use crate::layout::{Control, PairState, Row};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
}

pub fn bound(buffers: Bound<'_>) {
    store(buffers.params(), &buffers.read(0), &mut buffers.write(1), &mut buffers.write::<Control>(2)[0]);
}

pub fn store(params: Params, rows: &[Row], states: &mut [PairState], control: &mut Control) {
    for row in &rows[..control.rows.min(params.capacity) as usize] {
        control.pressing += u32::from(row.multiplier > 0.0);
        let state = &mut states[row.candidate as usize];
        (state.multiplier, state.friction) = (row.multiplier, row.friction);
    }
}
