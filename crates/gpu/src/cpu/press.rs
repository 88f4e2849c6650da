//! Twin of `shader/press.wgsl`.

use super::groups::{M3, V3, between, moments, place, times_spin};
use super::{divided, scaled};
use crate::assembly::Frame;
use crate::bound::Bound;
use crate::layout::NONE;
use crate::linear::{CHILDREN, DOMAIN_UNKNOWNS, DOMAIN_WORDS, Spring};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub chunks: u32,
    pub first: u32,
    pub quantum: f32,
}

/// Springs of a domain: their places in the list, the slots of a group of its level, its first group and the frame of that.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Chunk {
    pub begin: u32,
    pub end: u32,
    pub width: u32,
    pub group: u32,
    pub frame: u32,
}

pub fn bound(buffers: Bound<'_>) {
    let input = Input {
        params: buffers.params(),
        springs: &buffers.read(0),
        touching: &buffers.read(1),
        places: &buffers.read(2),
        positions: &buffers.read(3),
        frames: &buffers.read(4),
    };
    press(&input, &mut buffers.write(5));
}

pub struct Input<'a> {
    pub params: Params,
    pub springs: &'a [Spring],
    pub touching: &'a [u32],
    pub places: &'a [u32],
    pub positions: &'a [[i32; 4]],
    pub frames: &'a [Frame],
}

impl Input<'_> {
    /// The group in the domain that a node is in, and its arm there.
    fn group_of(&self, chunk: &Chunk, node: u32) -> Option<(usize, V3)> {
        let slot = self.places[node as usize];
        let group = (slot / chunk.width).wrapping_sub(chunk.group);
        if slot == NONE || group >= CHILDREN as u32 {
            return None;
        }
        let frame = &self.frames[(chunk.frame + group) as usize];
        let at = place(self.positions[node as usize]);
        Some((group as usize, divided(between(frame.center, at, self.params.quantum), frame.size)))
    }
}

pub fn press(input: &Input<'_>, pressed: &mut [f32]) {
    let Params { chunks, first, .. } = input.params;
    for (c, chunk) in input.touching[first as usize..].chunks_exact(5).take(chunks as usize).enumerate() {
        let chunk: &Chunk = bytemuck::from_bytes(bytemuck::cast_slice(chunk));
        let out = &mut pressed[DOMAIN_WORDS * c..][..DOMAIN_WORDS];
        out.fill(0.0);
        for &index in &input.touching[chunk.begin as usize..chunk.end as usize] {
            let spring = &input.springs[index as usize];
            let h: M3 = spring.hessian.map(|[x, y, z, _]| [x, y, z]);
            let nodes: [Option<(usize, V3)>; 4] = std::array::from_fn(|k| {
                (spring.weights[k] != 0.0).then(|| input.group_of(chunk, spring.nodes[k])).flatten()
            });
            for (m, own) in nodes.iter().enumerate() {
                let Some((a, arm)) = own else { continue };
                for (n, other) in nodes.iter().enumerate() {
                    let Some((b, other)) = other.filter(|(b, _)| b >= a) else { continue };
                    let weight = spring.weights[m] * spring.weights[n];
                    let shift = h.map(|column| scaled(column, weight));
                    let spin = times_spin(&shift, other);
                    let (turned_shift, turned_spin) = (moments(*arm, &shift), moments(*arm, &spin));
                    let parts = [[shift, spin], [turned_shift, turned_spin]];
                    for r in 0..6 {
                        for k in 0..6 {
                            out[DOMAIN_UNKNOWNS * (6 * a + r) + 6 * b + k] +=
                                parts[r / 3][k / 3][k % 3][r % 3];
                        }
                    }
                }
            }
        }
    }
}
