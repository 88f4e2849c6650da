//! Twin of `shader/rescale.wgsl`.

use super::{added, difference, scaled, subtracted};
use crate::bound::Bound;
use crate::layout::{Control, EdgeLimit, Row, Vertex};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub limits: u32,
    pub vertices: u32,
}

pub fn bound(buffers: Bound<'_>) {
    rescale(
        buffers.params(),
        &buffers.read(0),
        &mut buffers.write(1),
        &mut buffers.write(2),
        &buffers.read(3),
        &buffers.read(4),
        &buffers.read(5),
        &mut buffers.write(6),
        &buffers.write::<Control>(7)[0],
    );
}

pub fn rescale(
    params: Params,
    factor: &[f32],
    rows: &mut [Row],
    limits: &mut [EdgeLimit],
    positions: &[[i32; 4]],
    targets: &[[i32; 4]],
    vertices: &[Vertex],
    displacements: &mut [[f32; 4]],
    control: &Control,
) {
    let s = factor[0];
    for row in &mut rows[..control.rows.min(params.capacity) as usize] {
        row.multiplier *= s;
        row.friction = scaled(row.friction, s);
    }
    for edge in &mut limits[..params.limits as usize] {
        edge.multiplier = scaled(edge.multiplier, s);
    }
    for (v, place) in displacements[..params.vertices as usize].iter_mut().enumerate() {
        let [x, y, z, weight] = *place;
        if weight > 0.0 {
            let free = scaled(difference(targets[v], positions[v]), weight * vertices[v].mass);
            let [x, y, z] = added(free, scaled(subtracted([x, y, z], free), s));
            *place = [x, y, z, weight];
        }
    }
}
