//! Twin of `shader/relieve.wgsl`, which says why rows ask for less by their rounding.

use super::{added, difference, dot, largest, negated, scaled, subtracted};
use crate::bound::Bound;
use crate::layout::{Candidate, Control, Kind, Row, Separation};
use bytemuck::{Pod, Zeroable};
use std::ops::Range;

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
}

const ROUNDING: f32 = 9.536_743e-7;
const ON_GRID: f32 = 4.0;

pub fn bound(buffers: Bound<'_>) {
    relieve(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &buffers.read(3),
        &mut buffers.write(4),
        &buffers.read::<Control>(5)[0],
    );
}

fn lacking_of(
    side: Range<usize>,
    opposite: [f32; 3],
    outward: [f32; 3],
    wanted: f32,
    rounding: f32,
    places: &[[f32; 4]; 4],
    weights: &[f32; 4],
) -> f32 {
    let (mut lacking, mut any_free, mut any_prescribed) = (rounding, false, false);
    for k in side {
        let [x, y, z, weight] = places[k];
        if weight != 0.0 {
            any_free = true;
            continue;
        }
        any_prescribed = true;
        let gap = dot(outward, subtracted([x, y, z], opposite));
        lacking += weights[k].abs() * (wanted - gap).max(0.0);
    }
    if any_free && any_prescribed { lacking } else { 0.0 }
}

pub fn relieve(
    params: Params,
    positions: &[[i32; 4]],
    displacements: &[[f32; 4]],
    candidates: &[Candidate],
    separations: &[Separation],
    rows: &mut [Row],
    control: &Control,
) {
    for row in &mut rows[..control.rows.min(params.capacity) as usize] {
        let kind = candidates[row.candidate as usize].kind();
        if kind == Kind::VertexVertex as u32 || kind == Kind::VertexHalfSpace as u32 {
            continue;
        }
        let count = if kind == Kind::VertexEdge as u32 { 3 } else { 4 };
        let side_a = if kind == Kind::EdgeEdge as u32 { 2 } else { 1 };
        let wanted = separations[row.candidate as usize].wanted;
        let origin = positions[row.vertices[0] as usize];
        let (mut places, mut means, mut longest) = ([[0.0; 4]; 4], [[0.0; 3]; 2], 0.0f32);
        for k in 0..count {
            let v = row.vertices[k] as usize;
            let [x, y, z, weight] = displacements[v];
            let mut place = difference(positions[v], origin);
            longest = longest.max(largest(place)).max(largest([x, y, z]));
            if weight == 0.0 {
                place = added(place, [x, y, z]);
            }
            places[k] = [place[0], place[1], place[2], weight];
            let mean = &mut means[usize::from(k >= side_a)];
            *mean = added(*mean, scaled(place, row.weights[k].abs()));
        }
        let rounding = ON_GRID + ROUNDING * longest;
        let of_side = |side: Range<usize>, opposite: usize, outward: [f32; 3]| {
            lacking_of(side, means[opposite], outward, wanted, rounding, &places, &row.weights)
        };
        let of_a = of_side(0..side_a, 1, row.normal);
        let of_b = of_side(side_a..count, 0, negated(row.normal));
        row.value += of_a + of_b;
    }
}
