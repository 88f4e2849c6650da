//! Twin of `shader/sweep_rows.wgsl`.

use super::{added, dot, scaled, subtracted};
use crate::bound::Bound;
use crate::layout::{Bucket, Row};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub first: u32,
    pub end: u32,
    pub only_apply: u32,
    pub sweeps: u32,
}

pub fn bound(buffers: Bound<'_>) {
    sweep_rows(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &mut buffers.write(3),
        &mut buffers.write(4),
    );
}

pub fn sweep_rows(
    params: Params,
    order: &[u32],
    buckets: &[Bucket],
    _color_ends: &[u32],
    rows: &mut [Row],
    displacements: &mut [[f32; 4]],
) {
    // Colors are sorted, and only threads wait between them.
    for bucket in &buckets[params.first as usize..params.end as usize] {
        let own = &order[bucket.first as usize..bucket.end as usize];
        if !own.iter().any(|r| would_change(params, &rows[*r as usize], displacements)) {
            continue;
        }
        for _ in 0..params.sweeps {
            for &r in own {
                relax(params, &mut rows[r as usize], displacements);
            }
        }
    }
}

/// The multiplier of the row once it is relaxed.
fn pressed(row: &Row, displacements: &[[f32; 4]]) -> f32 {
    let value = row.value + dot(row.normal, relative_displacement(row, displacements));
    (row.multiplier - value * row.inverse_diagonal).max(0.0)
}

/// The multiplier of its friction then, where the multiplier of the row is that.
fn rubbed(row: &Row, multiplier: f32, displacements: &[[f32; 4]]) -> [f32; 3] {
    if row.coefficient <= 0.0 || (multiplier <= 0.0 && row.friction == [0.0; 3]) {
        return row.friction;
    }
    let slipped = added(row.slip, relative_displacement(row, displacements));
    let slip = subtracted(slipped, scaled(row.normal, dot(row.normal, slipped)));
    let wanted = subtracted(row.friction, scaled(slip, row.inverse_diagonal));
    let (size, largest) = (dot(wanted, wanted).sqrt(), row.coefficient * multiplier);
    if size > largest { scaled(wanted, largest / size) } else { wanted }
}

/// Whether the row would change if it were relaxed, or moves something if its multipliers are applied.
fn would_change(params: Params, row: &Row, displacements: &[[f32; 4]]) -> bool {
    if row.inverse_diagonal == 0.0 {
        return false;
    }
    if params.only_apply != 0 {
        return row.multiplier != 0.0 || row.friction != [0.0; 3];
    }
    let multiplier = pressed(row, displacements);
    multiplier != row.multiplier || rubbed(row, multiplier, displacements) != row.friction
}

fn relax(params: Params, row: &mut Row, displacements: &mut [[f32; 4]]) {
    if row.inverse_diagonal == 0.0 {
        return;
    }
    if params.only_apply != 0 {
        push(row, added(scaled(row.normal, row.multiplier), row.friction), displacements);
        return;
    }
    let multiplier = pressed(row, displacements);
    push(row, scaled(row.normal, multiplier - row.multiplier), displacements);
    row.multiplier = multiplier;
    let friction = rubbed(row, multiplier, displacements);
    if friction != row.friction {
        push(row, subtracted(friction, row.friction), displacements);
        row.friction = friction;
    }
}

fn relative_displacement(row: &Row, displacements: &[[f32; 4]]) -> [f32; 3] {
    row.vertices.into_iter().zip(row.weights).fold([0.0; 3], |sum, (v, weight)| {
        let [x, y, z, _] = displacements[v as usize];
        added(sum, scaled([x, y, z], weight))
    })
}

fn push(row: &Row, change: [f32; 3], displacements: &mut [[f32; 4]]) {
    for (v, beta) in row.vertices.into_iter().zip(row.weights) {
        let place = &mut displacements[v as usize];
        let [x, y, z, weight] = *place;
        let step = weight * beta;
        if step != 0.0 {
            let [x, y, z] = added([x, y, z], scaled(change, step));
            *place = [x, y, z, weight];
        }
    }
}
