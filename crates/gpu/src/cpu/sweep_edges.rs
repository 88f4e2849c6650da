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
        let last = cluster
            .colors
            .checked_sub(1)
            .map_or(cluster.first_edge, |color| color_ends[(cluster.first_color + color) as usize]);
        let edges = cluster.first_edge as usize..last as usize;
        if !limits[edges].iter().any(|edge| would_change(&params, positions, edge, displacements, &moved)) {
            continue;
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

/// Displacements of both ends of an edge, the fourth number their weight.
fn displacements_of(edge: &EdgeLimit, displacements: &[[f32; 4]], moved: &[[f32; 4]]) -> [[f32; 4]; 2] {
    [(edge.places & 0xffff, edge.a), (edge.places >> 16, edge.b)].map(|(place, v)| {
        if place == EdgeLimit::FIXED { displacements[v as usize] } else { moved[place as usize] }
    })
}

/// The multiplier of an edge once it is projected.
fn projected(
    positions: &[[i32; 4]],
    edge: &EdgeLimit,
    [[ax, ay, az, a_weight], [bx, by, bz, b_weight]]: [[f32; 4]; 2],
) -> [f32; 3] {
    let total = a_weight + b_weight;
    let between = difference(positions[edge.a as usize], positions[edge.b as usize]);
    let along = subtracted(added(between, [ax, ay, az]), [bx, by, bz]);
    let released = added(along, scaled(edge.multiplier, total));
    let length = dot(released, released).sqrt();
    if length > edge.limit {
        return scaled(released, (length - edge.limit) / (length * total));
    }
    [0.0; 3]
}

/// Whether an edge would change if it were projected, or moves something if its multiplier is applied.
fn would_change(
    params: &Params,
    positions: &[[i32; 4]],
    edge: &EdgeLimit,
    displacements: &[[f32; 4]],
    moved: &[[f32; 4]],
) -> bool {
    let ends = displacements_of(edge, displacements, moved);
    if ends[0][3] + ends[1][3] <= 0.0 {
        return false;
    }
    if params.only_apply != 0 {
        return edge.multiplier != [0.0; 3];
    }
    projected(positions, edge, ends) != edge.multiplier
}

fn relax(
    params: &Params,
    positions: &[[i32; 4]],
    edge: &mut EdgeLimit,
    displacements: &[[f32; 4]],
    moved: &mut [[f32; 4]],
) {
    let ends = displacements_of(edge, displacements, moved);
    let [[ax, ay, az, a_weight], [bx, by, bz, b_weight]] = ends;
    if a_weight + b_weight <= 0.0 {
        return;
    }
    let mut change = edge.multiplier;
    if params.only_apply == 0 {
        let multiplier = projected(positions, edge, ends);
        change = subtracted(multiplier, edge.multiplier);
        edge.multiplier = multiplier;
    }
    let [a_place, b_place] = [edge.places & 0xffff, edge.places >> 16];
    if a_place != EdgeLimit::FIXED {
        let [x, y, z] = subtracted([ax, ay, az], scaled(change, a_weight));
        moved[a_place as usize] = [x, y, z, a_weight];
    }
    if b_place != EdgeLimit::FIXED {
        let [x, y, z] = added([bx, by, bz], scaled(change, b_weight));
        moved[b_place as usize] = [x, y, z, b_weight];
    }
}
