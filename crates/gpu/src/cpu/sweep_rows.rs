//! Twin of `shader/sweep_rows.wgsl`.

use super::{added, dot, largest, scaled, subtracted};
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
        &mut buffers.write(5),
    );
}

pub fn sweep_rows(
    params: Params,
    order: &[u32],
    buckets: &[Bucket],
    color_ends: &[u32],
    rows: &mut [Row],
    displacements: &mut [[f32; 4]],
    pushes: &mut [[i32; 4]],
) {
    // Colors are sorted, and only threads wait between them.
    for bucket in &buckets[params.first as usize..params.end as usize] {
        let own = &order[bucket.first as usize..bucket.end as usize];
        if !own.iter().any(|r| would_change(params, &rows[*r as usize], displacements)) {
            continue;
        }
        let last_color = (bucket.first + bucket.colors).checked_sub(1).filter(|_| bucket.colors > 0);
        let end = last_color.map_or(bucket.first, |place| color_ends[place as usize]);
        let (colored, uncolored) = own.split_at((end - bucket.first) as usize);
        for _ in 0..params.sweeps {
            for &r in colored {
                relax(params, &mut rows[r as usize], displacements);
            }
            relax_together(params, bucket, uncolored, rows, displacements, pushes);
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

/// Relaxes a row with all other vertices where they are, and returns what it pushes its vertices by.
fn relax_alone(params: Params, row: &mut Row, displacements: &[[f32; 4]]) -> [f32; 3] {
    if row.inverse_diagonal == 0.0 {
        return [0.0; 3];
    }
    if params.only_apply != 0 {
        return added(scaled(row.normal, row.multiplier), row.friction);
    }
    let multiplier = pressed(row, displacements);
    let friction = rubbed(row, multiplier, displacements);
    let change = added(scaled(row.normal, multiplier - row.multiplier), subtracted(friction, row.friction));
    (row.multiplier, row.friction) = (multiplier, friction);
    change
}

fn relax_together(
    params: Params,
    bucket: &Bucket,
    uncolored: &[u32],
    rows: &mut [Row],
    displacements: &mut [[f32; 4]],
    pushes: &mut [[i32; 4]],
) {
    let mut most = 0.0f32;
    for &r in uncolored {
        let mut row = rows[r as usize];
        let change = largest(relax_alone(params, &mut row, displacements));
        for (v, weight) in row.vertices.into_iter().zip(row.weights) {
            most = most.max((displacements[v as usize][3] * weight).abs() * change);
        }
    }
    let bits = (most * bucket.most as f32).to_bits();
    if bits == 0 || bits >= 0x7f00_0000 {
        return;
    }
    let exponent = ((bits >> 23) + 1).max(31) - 30;
    let [unit, inverse] = [exponent, 254 - exponent].map(|exponent| f32::from_bits(exponent << 23));
    for &r in uncolored {
        let row = &mut rows[r as usize];
        let change = scaled(relax_alone(params, row, displacements), inverse);
        for (v, weight) in row.vertices.map(|v| v as usize).into_iter().zip(row.weights) {
            let share = displacements[v][3] * weight;
            for k in 0..3 {
                pushes[v][k] = pushes[v][k].wrapping_add((share * change[k]).round_ties_even() as i32);
            }
        }
    }
    for v in uncolored.iter().flat_map(|r| rows[*r as usize].vertices).map(|v| v as usize) {
        let [x, y, z, weight] = displacements[v];
        let push = std::mem::take(&mut pushes[v]);
        let [x, y, z] = added([x, y, z], scaled([push[0], push[1], push[2]].map(|push| push as f32), unit));
        displacements[v] = [x, y, z, weight];
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
