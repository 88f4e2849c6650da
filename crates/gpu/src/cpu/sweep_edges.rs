//! Twin of `shader/sweep_edges.wgsl`.

use super::{added, difference, dot, scaled, subtracted};
use crate::bound::Bound;
use crate::edges::MOST_VERTICES;
use crate::layout::{EdgeCluster, EdgeLimit};
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
    sweep_edges(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &buffers.read(3),
        &mut buffers.write(4),
        &mut buffers.write(5),
    );
}

pub fn sweep_edges(
    params: Params,
    positions: &[[i32; 4]],
    clusters: &[EdgeCluster],
    cluster_vertices: &[u32],
    color_ends: &[u32],
    limits: &mut [EdgeLimit],
    displacements: &mut [[f32; 4]],
) {
    let mut moved = [[0.0; 4]; MOST_VERTICES];
    for cluster in &clusters[params.first as usize..params.end as usize] {
        let vertices = &cluster_vertices[cluster.first_vertex as usize..][..cluster.vertices as usize];
        for (place, &v) in moved.iter_mut().zip(vertices) {
            *place = displacements[v as usize];
        }
        for _ in 0..params.sweeps {
            let mut first = cluster.first_edge as usize;
            for &end in &color_ends[cluster.first_color as usize..][..cluster.colors as usize] {
                for edge in &mut limits[first..end as usize] {
                    relax(&params, positions, edge, displacements, &mut moved);
                }
                first = end as usize;
            }
        }
        for (place, &v) in moved.iter().zip(vertices) {
            displacements[v as usize] = *place;
        }
    }
}

fn relax(
    params: &Params,
    positions: &[[i32; 4]],
    edge: &mut EdgeLimit,
    displacements: &[[f32; 4]],
    moved: &mut [[f32; 4]],
) {
    let old = edge.multiplier;
    let mut change = old;
    let [a_place, b_place] = [edge.places & 0xffff, edge.places >> 16];
    let displacement = |place: u32, v: u32| {
        if place == EdgeLimit::FIXED { displacements[v as usize] } else { moved[place as usize] }
    };
    let [ax, ay, az, a_weight] = displacement(a_place, edge.a);
    let [bx, by, bz, b_weight] = displacement(b_place, edge.b);
    let (a, b) = ([ax, ay, az], [bx, by, bz]);
    let total = a_weight + b_weight;
    if total <= 0.0 {
        return;
    }
    if params.only_apply == 0 {
        let between = difference(positions[edge.a as usize], positions[edge.b as usize]);
        let along = subtracted(added(between, a), b);
        let released = added(along, scaled(old, total));
        let length = dot(released, released).sqrt();
        let mut multiplier = [0.0; 3];
        if length > edge.limit {
            multiplier = scaled(released, (length - edge.limit) / (length * total));
        }
        change = subtracted(multiplier, old);
        edge.multiplier = multiplier;
    }
    if a_place != EdgeLimit::FIXED {
        let [x, y, z] = subtracted(a, scaled(change, a_weight));
        moved[a_place as usize] = [x, y, z, a_weight];
    }
    if b_place != EdgeLimit::FIXED {
        let [x, y, z] = added(b, scaled(change, b_weight));
        moved[b_place as usize] = [x, y, z, b_weight];
    }
}
