//! Twin of `shader/pick.wgsl`.

use super::dot;
use super::pair::{pair_of, signed_weights};
use crate::bound::Bound;
use crate::layout::{Candidate, Control, PairState, Separation};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub threshold: f32,
}

pub fn bound(buffers: Bound<'_>) {
    pick(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &buffers.read(3),
        &buffers.read(4),
        &mut buffers.write(5),
        &mut buffers.write(6),
        &buffers.read::<Control>(7)[0],
    );
}

pub fn pick(
    params: Params,
    displacements: &[[f32; 4]],
    edges: &[[u32; 2]],
    triangles: &[[u32; 4]],
    candidates: &[Candidate],
    separations: &[Separation],
    states: &mut [PairState],
    starts: &mut [u32],
    control: &Control,
) {
    let count = control.candidates.min(params.capacity) as usize;
    let is_picked = |state: &PairState, candidate: Candidate, separation: &Separation| {
        if separation.distance > state.range || separation.wanted == 0.0 {
            return false;
        }
        if state.multiplier > 0.0 {
            return true;
        }
        let pair = pair_of(candidate, edges, triangles);
        let weights = signed_weights(&pair, separation);
        let mut gap = separation.distance;
        for k in 0..pair.count {
            let [x, y, z, _] = displacements[pair.vertices[k] as usize];
            gap += weights[k] * dot(separation.normal, [x, y, z]);
        }
        gap < params.threshold * separation.wanted
    };
    for c in 0..count {
        let picked = is_picked(&states[c], candidates[c], &separations[c]);
        if !picked {
            states[c].multiplier = 0.0;
            states[c].friction = [0.0; 3];
        }
        starts[c] = u32::from(picked);
    }
}
