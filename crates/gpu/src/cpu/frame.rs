//! Twin of `shader/frame.wgsl`.

use super::eigen::{filtered_matrix, is_definite};
use super::elements::length;
use super::groups::{V3, between, place};
use super::{added, divided};
use crate::assembly::Frame;
use crate::bound::Bound;
use crate::layout::NONE;
use crate::linear::{CHILDREN, PATCH_SLOTS, PatchSlot};
use bytemuck::{Pod, Zeroable};

/// Spins about axes with at most about this share of the largest moment of inertia are held.
const SMALLEST_MOMENT: f32 = 1e-4;

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub count: u32,
    pub first: u32,
    pub first_part: u32,
    pub parts: u32,
    pub width: u32,
    pub first_domain: u32,
    pub quantum: f32,
}

pub fn bound(buffers: Bound<'_>) {
    frame(
        buffers.params(),
        &buffers.read(0),
        &mut buffers.write(1),
        &mut buffers.write(2),
        &mut buffers.write(3),
    );
}

fn moment_of([x, y, z]: V3) -> [f32; 6] {
    [x * x, x * y, x * z, y * y, y * z, z * z]
}

/// The axes about which spins are held: the moments of inertia tr(m) I - m about them are small.
fn held_by(m: [f32; 6]) -> [f32; 6] {
    let trace = m[0] + m[3] + m[5];
    let shift = (1.0 - SMALLEST_MOMENT) * trace;
    let matrix = [[shift - m[0], -m[1], -m[2]], [-m[1], shift - m[3], -m[4]], [-m[2], -m[4], shift - m[5]]];
    if is_definite(matrix, trace) {
        return [0.0; 6];
    }
    let sum = filtered_matrix(matrix, |value| if value <= 0.0 { 1.0 } else { 0.0 });
    [sum[0][0], sum[0][1], sum[0][2], sum[1][1], sum[1][2], sum[2][2]]
}

/// The mean of places, from their differences to the first.
fn mean(places: &[[i32; 3]]) -> [i32; 3] {
    let origin = places[0];
    let sum: V3 = places.iter().fold([0.0; 3], |sum, place| added(sum, between(origin, *place, 1.0)));
    let way = divided(sum, places.len() as f32);
    [0, 1, 2].map(|k| origin[k].wrapping_add(way[k] as i32))
}

fn of_nodes(params: &Params, positions: &[[i32; 4]], slots: &mut [PatchSlot]) -> Frame {
    let at = |slot: &PatchSlot| place(positions[slot.node as usize]);
    let places: Vec<[i32; 3]> = slots.iter().filter(|slot| slot.node != NONE).map(at).collect();
    if slots[0].node == NONE {
        return Frame::default();
    }
    let center = mean(&places);
    let reach = |place: &[i32; 3]| length(between(center, *place, params.quantum));
    let mut size = places.iter().map(reach).fold(0.0, f32::max);
    if size <= params.quantum {
        size = 1.0;
    }
    let mut moment = [0.0; 6];
    for slot in slots.iter_mut().filter(|slot| slot.node != NONE) {
        let arm = divided(between(center, at(slot), params.quantum), size);
        let own = moment_of(arm);
        moment.iter_mut().zip(own).for_each(|(sum, own)| *sum += own / places.len() as f32);
        if params.width == 8 {
            slot.arm = arm;
        }
    }
    Frame { center, size, moment, held: held_by(moment) }
}

fn of_groups(params: &Params, parts: &[Frame]) -> Frame {
    let places: Vec<[i32; 3]> = parts.iter().map(|part| part.center).collect();
    let center = mean(&places);
    let reach = |part: &Frame| length(between(center, part.center, params.quantum)) + part.size;
    let size = parts.iter().map(reach).fold(0.0, f32::max);
    let mut moment = [0.0; 6];
    for part in parts {
        let own = moment_of(divided(between(center, part.center, params.quantum), size));
        let ratio = part.size / size;
        for k in 0..6 {
            moment[k] += (own[k] + ratio * ratio * part.moment[k]) / parts.len() as f32;
        }
    }
    Frame { center, size, moment, held: held_by(moment) }
}

/// The link of a part of a group; zero for one that is empty or missing.
fn link_of(params: &Params, part: Option<&Frame>, whole: &Frame) -> [f32; 4] {
    part.filter(|part| part.size > 0.0).map_or([0.0; 4], |part| {
        let [x, y, z] = divided(between(whole.center, part.center, params.quantum), whole.size);
        [x, y, z, part.size / whole.size]
    })
}

pub fn frame(
    params: Params,
    positions: &[[i32; 4]],
    slots: &mut [PatchSlot],
    frames: &mut [Frame],
    links: &mut [[[f32; 4]; CHILDREN]],
) {
    let (first, width) = (params.first as usize, params.width as usize);
    for g in 0..params.count as usize {
        let parts = CHILDREN * g..(CHILDREN * (g + 1)).min(params.parts as usize);
        let frame = if width > 0 {
            of_nodes(&params, positions, &mut slots[width * g..width * (g + 1)])
        } else {
            of_groups(&params, &frames[params.first_part as usize..][parts.clone()])
        };
        frames[first + g] = frame;
        if params.parts > 0 {
            let parts = &frames[params.first_part as usize..][parts];
            let of_parts = std::array::from_fn(|m| link_of(&params, parts.get(m), &frame));
            if width > 0 {
                for (group, [x, y, z, ratio]) in slots[PATCH_SLOTS * g..].chunks_mut(CHILDREN).zip(of_parts) {
                    (group[0].link, group[1].link) = ([x, y], [z, ratio]);
                }
            } else {
                links[params.first_domain as usize + g] = of_parts;
            }
        }
    }
}
