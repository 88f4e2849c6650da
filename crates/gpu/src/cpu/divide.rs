//! Twin of `shader/divide.wgsl`.

use crate::bound::Bound;
use crate::bricks::LATTICES;
use crate::layout::{Control, Row};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub shift: u32,
    pub buckets: u32,
}

pub fn bound(buffers: Bound<'_>) {
    divide(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &mut buffers.write(2),
        &mut buffers.write(3),
        &buffers.read::<Control>(4)[0],
    );
}

fn hash(cell: [i32; 3]) -> u32 {
    let [x, y, z] = cell.map(|c| c as u32);
    x.wrapping_mul(73_856_093) ^ y.wrapping_mul(19_349_663) ^ z.wrapping_mul(83_492_791)
}

fn bucket_of(params: Params, positions: &[[i32; 4]], displacements: &[[f32; 4]], row: &Row) -> u32 {
    let (mut low, mut high) = ([i32::MAX; 3], [-i32::MAX; 3]);
    for v in row.vertices.map(|v| v as usize) {
        if displacements[v][3] > 0.0 {
            low = [0, 1, 2].map(|k| low[k].min(positions[v][k]));
            high = [0, 1, 2].map(|k| high[k].max(positions[v][k]));
        }
    }
    if low[0] > high[0] {
        return 0;
    }
    if params.buckets > 0 {
        for lattice in 0..LATTICES as u32 {
            let offset = (lattice << (params.shift - 2)) as i32;
            let [cell, other] = [low, high].map(|corner| corner.map(|x| (x + offset) >> params.shift));
            if cell == other {
                return lattice * params.buckets + (hash(cell) & (params.buckets - 1));
            }
        }
    }
    LATTICES as u32 * params.buckets
}

pub fn divide(
    params: Params,
    positions: &[[i32; 4]],
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
        let bucket = bucket_of(params, positions, displacements, row);
        row.inverse_diagonal = if diagonal > 0.0 { 1.0 / diagonal } else { 0.0 };
        row.bucket = bucket;
        tally[bucket as usize] += 1;
    }
}
