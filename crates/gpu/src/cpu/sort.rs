//! Twin of `shader/sort.wgsl`.

use crate::bound::Bound;
use crate::layout::{COLORS, Control, Row};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
}

pub fn bound(buffers: Bound<'_>) {
    sort(
        buffers.params(),
        &buffers.read(0),
        &mut buffers.write(1),
        &mut buffers.write(2),
        &buffers.read::<Control>(3)[0],
    );
}

pub fn sort(params: Params, rows: &[Row], ends: &mut [u32], order: &mut [u32], control: &Control) {
    let count = control.rows.min(params.capacity) as usize;
    for (r, row) in rows[..count].iter().enumerate() {
        if (row.color as usize) < COLORS {
            let end = &mut ends[row.color as usize];
            order[*end as usize] = r as u32;
            *end += 1;
        } else {
            let after = rows[r + 1..count].iter().filter(|other| other.color as usize == COLORS).count();
            order[count - 1 - after] = r as u32;
            ends[COLORS] += 1;
        }
    }
}
