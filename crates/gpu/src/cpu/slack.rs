//! Twin of `shader/slack.wgsl`.

use super::{added, difference, dot, scaled, subtracted};
use crate::bound::Bound;
use crate::layout::{Control, EdgeLimit, Row, Vertex};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub blocks: u32,
    pub capacity: u32,
    pub limits: u32,
    pub vertices: u32,
}

/// Threads of a block, and most blocks.
pub const BLOCK: usize = 256;
pub const MOST_BLOCKS: usize = 256;

const SLIDES: f32 = 0.999_999;

pub fn bound(buffers: Bound<'_>) {
    slack(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &buffers.read(3),
        &buffers.read(4),
        &buffers.read(5),
        &buffers.write::<Control>(6)[0],
        &mut buffers.write(7),
    );
}

fn of_row(row: &Row, displacements: &[[f32; 4]]) -> f32 {
    if row.multiplier <= 0.0 {
        return 0.0;
    }
    let mut relative = [0.0; 3];
    for (v, weight) in row.vertices.into_iter().zip(row.weights) {
        let [x, y, z, _] = displacements[v as usize];
        relative = added(relative, scaled([x, y, z], weight));
    }
    let mut slack = row.multiplier * (row.value + dot(row.normal, relative));
    let friction = dot(row.friction, row.friction).sqrt();
    if friction > 0.0 && friction < SLIDES * row.coefficient * row.multiplier {
        slack += dot(row.friction, added(row.slip, relative));
    }
    slack
}

fn of_limit(edge: &EdgeLimit, positions: &[[i32; 4]], displacements: &[[f32; 4]]) -> f32 {
    let [a, b] = [edge.a, edge.b].map(|v| v as usize);
    let moved = |v: usize| [displacements[v][0], displacements[v][1], displacements[v][2]];
    let along = subtracted(added(difference(positions[a], positions[b]), moved(a)), moved(b));
    let f = edge.multiplier;
    edge.limit * dot(f, f).sqrt() - dot(f, along)
}

pub fn slack(
    params: Params,
    rows: &[Row],
    limits: &[EdgeLimit],
    positions: &[[i32; 4]],
    targets: &[[i32; 4]],
    vertices: &[Vertex],
    displacements: &[[f32; 4]],
    control: &Control,
    sums: &mut [[f32; 2]],
) {
    let of_vertex = |v: usize| {
        let [x, y, z, weight] = displacements[v];
        if weight == 0.0 {
            return 0.0;
        }
        let free = scaled(difference(targets[v], positions[v]), weight * vertices[v].mass);
        let moved = subtracted([x, y, z], free);
        dot(moved, moved) / weight
    };
    let row_count = control.rows.min(params.capacity) as usize;
    let stride = BLOCK * params.blocks as usize;
    for (block, place) in sums.iter_mut().take(params.blocks as usize).enumerate() {
        let mut shared = [[0.0f32; 2]; BLOCK];
        for (k, sum) in shared.iter_mut().enumerate() {
            let first = BLOCK * block + k;
            for r in (first..row_count).step_by(stride) {
                sum[0] += of_row(&rows[r], displacements);
            }
            for e in (first..params.limits as usize).step_by(stride) {
                sum[0] += of_limit(&limits[e], positions, displacements);
            }
            for v in (first..params.vertices as usize).step_by(stride) {
                sum[1] += of_vertex(v);
            }
        }
        let mut reach = BLOCK / 2;
        while reach > 0 {
            for k in 0..reach {
                let [slack, energy] = shared[k + reach];
                shared[k][0] += slack;
                shared[k][1] += energy;
            }
            reach /= 2;
        }
        *place = shared[0];
    }
}
