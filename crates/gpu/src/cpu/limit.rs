//! Twin of `shader/limit.wgsl`, which states the bound of the rounding.

use super::dot;
use super::pair::pair_of;
use crate::bound::Bound;
use crate::layout::{Candidate, Control, NONE, Separation, Vertex};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub damping: f32,
}

const STEP: f32 = 8.0;
const PATH_ROUNDING: f32 = 3.814_697_3e-6;

pub fn bound(buffers: Bound<'_>) {
    limit(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &buffers.read(3),
        &buffers.read(4),
        &buffers.read(5),
        &mut buffers.write(6),
        &mut buffers.write::<Control>(7)[0],
    );
}

pub fn limit(
    params: Params,
    edges: &[[u32; 2]],
    triangles: &[[u32; 4]],
    vertices: &[Vertex],
    candidates: &[Candidate],
    separations: &[Separation],
    paths: &[[f32; 4]],
    alphas: &mut [u32],
    control: &mut Control,
) {
    for c in 0..control.candidates.min(params.capacity) as usize {
        let (candidate, separation) = (candidates[c], separations[c]);
        limit_pair(&params, candidate, &separation, edges, triangles, vertices, paths, alphas, control);
    }
}

fn lower(alpha: f32, stored: &mut u32) {
    let mut bits = alpha.to_bits();
    if bits >= 0x7f80_0000 {
        bits = 0;
    }
    *stored = (*stored).min(bits);
}

fn limit_pair(
    params: &Params,
    candidate: Candidate,
    separation: &Separation,
    edges: &[[u32; 2]],
    triangles: &[[u32; 4]],
    vertices: &[Vertex],
    paths: &[[f32; 4]],
    alphas: &mut [u32],
    control: &mut Control,
) {
    let pair = pair_of(candidate, edges, triangles);
    let at = pair.vertices.map(|v| v as usize);
    let path = at.map(|v| paths[v]);
    let mut longest = 0.0f32;
    for path in &path[..pair.count] {
        longest = longest.max(path[0].abs() + path[1].abs() + path[2].abs());
    }
    if longest == 0.0 {
        return;
    }
    let rounding = STEP + PATH_ROUNDING * longest;
    let is_certified = separation.width > 2.0 * rounding;
    if !is_certified {
        at[..pair.count].iter().for_each(|&v| lower(0.0, &mut alphas[v]));
        control.frozen += 1;
        return;
    }
    let allowed = (params.damping * (separation.width - separation.min_separation) - rounding).max(0.0);

    let (mut closing, mut speeds, mut extremes) = ([0.0f32; 4], [0.0f32; 2], [-3.0e38f32; 2]);
    let group = vertices[at[0]].group;
    let mut one_group = group != NONE;
    for k in 0..pair.count {
        let along = dot(separation.normal, [path[k][0], path[k][1], path[k][2]]);
        let side = usize::from(k >= pair.side_a);
        closing[k] = if side == 0 { -along } else { along };
        speeds[side] = speeds[side].max(closing[k]);
        extremes[side] = extremes[side].max(closing[k]);
        one_group &= vertices[at[k]].group == group;
    }
    if one_group {
        let total = extremes[0] + if pair.side_a == pair.count { 0.0 } else { extremes[1] };
        if total > allowed {
            for k in 0..pair.count {
                lower(allowed / total * path[k][3], &mut alphas[at[k]]);
            }
        }
        return;
    }
    let total = speeds[0] + speeds[1];
    if total <= allowed {
        return;
    }
    for k in 0..pair.count {
        if closing[k] > 0.0 {
            let share = speeds[usize::from(k >= pair.side_a)] / total;
            lower((allowed * share / closing[k]).min(1.0) * path[k][3], &mut alphas[at[k]]);
        }
    }
}
