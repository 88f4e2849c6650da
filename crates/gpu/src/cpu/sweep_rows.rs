//! Twin of `shader/sweep_rows.wgsl`.

use super::{added, dot, scaled};
use crate::bound::Bound;
use crate::layout::{COLORS, Row};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub only_apply: u32,
}

pub fn bound(buffers: Bound<'_>) {
    sweep_rows(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &mut buffers.write(2),
        &mut buffers.write(3),
    );
}

pub fn sweep_rows(
    params: Params,
    order: &[u32],
    ends: &[u32],
    rows: &mut [Row],
    displacements: &mut [[f32; 4]],
) {
    for &r in &order[..ends[COLORS] as usize] {
        relax(params, &mut rows[r as usize], displacements);
    }
}

fn relax(params: Params, row: &mut Row, displacements: &mut [[f32; 4]]) {
    if row.inverse_diagonal == 0.0 {
        return;
    }
    let mut change = row.multiplier;
    if params.only_apply == 0 {
        let mut value = row.value;
        for k in 0..4 {
            let [x, y, z, _] = displacements[row.vertices[k] as usize];
            value += row.weights[k] * dot(row.normal, [x, y, z]);
        }
        let multiplier = (row.multiplier - value * row.inverse_diagonal).max(0.0);
        change = multiplier - row.multiplier;
        row.multiplier = multiplier;
    }
    for k in 0..4 {
        let place = &mut displacements[row.vertices[k] as usize];
        let [x, y, z, weight] = *place;
        let step = weight * row.weights[k] * change;
        if step != 0.0 {
            let [x, y, z] = added([x, y, z], scaled(row.normal, step));
            *place = [x, y, z, weight];
        }
    }
}
