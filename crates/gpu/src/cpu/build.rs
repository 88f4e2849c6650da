//! Twin of `shader/build.wgsl`.

use super::curve_edges::weight_units;
use super::pair::{Pair, pair_with, signed_weights};
use crate::bound::Bound;
use crate::layout::{Candidate, Control, Kind, PairState, Row, Separation, Vertex};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub strength: f32,
}

const AT_VERTEX: f32 = 1e-5;

pub fn bound(buffers: Bound<'_>) {
    build(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &buffers.read(3),
        &mut buffers.write(4),
        &mut buffers.write(5),
        &buffers.read::<Control>(6)[0],
    );
}

fn radius_of(pair: &Pair, weights: &[f32; 4], gap: f32, sine: f32, edge: f32) -> f32 {
    let inside = |weights: &[f32]| weights.iter().filter(|w| w.abs() > AT_VERTEX).count();
    let kind = pair.kind;
    let (inside_a, inside_b) = if kind == Kind::VertexHalfSpace as u32 {
        return edge;
    } else if kind == Kind::EdgeEdge as u32 {
        (inside(&weights[..2]), inside(&weights[2..]))
    } else if kind == Kind::VertexVertex as u32 {
        (1, 1)
    } else {
        (1, inside(&weights[1..]))
    };
    match (inside_a, inside_b) {
        (2, 2) => (edge * sine).max(gap).min(edge),
        (_, 3) => edge,
        (2, _) | (_, 2) => gap.min(edge),
        _ => gap,
    }
}

pub fn build(
    params: Params,
    vertices: &[Vertex],
    candidates: &[Candidate],
    separations: &[Separation],
    states: &[PairState],
    rows: &mut [Row],
    proximal: &mut [u32],
    control: &Control,
) {
    for row in &mut rows[..control.rows.min(params.capacity) as usize] {
        let c = row.candidate;
        let (separation, state) = (separations[c as usize], states[c as usize]);
        let pair = pair_with(candidates[c as usize].kind(), row.vertices);
        let weights = signed_weights(&pair, &separation);
        if state.multiplier > 0.0 {
            let gap = separation.distance.max(state.desired).max(1.0);
            for k in 0..pair.count {
                let v = pair.vertices[k] as usize;
                let radius = radius_of(&pair, &weights, gap, separation.sine, vertices[v].edge);
                let units = weight_units(params.strength * state.multiplier * weights[k].abs() / radius);
                proximal[v] = proximal[v].wrapping_add(units);
            }
        }
        *row = Row {
            vertices: pair.vertices,
            weights,
            normal: separation.normal,
            value: separation.distance - separation.wanted,
            inverse_diagonal: 0.0,
            multiplier: state.multiplier,
            candidate: c,
            color: 0,
            slip: [0.0; 3],
            coefficient: 0.0,
            friction: [0.0; 3],
            bucket: 0,
        };
    }
}
