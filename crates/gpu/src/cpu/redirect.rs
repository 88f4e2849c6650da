//! Twin of `shader/redirect.wgsl`.

use super::descend::links_of;
use super::rigid::child;
use super::sum::sum_of_parts;
use super::{added, crossed, scaled};
use crate::bound::Bound;
use crate::layout::NONE;
use crate::linear::{CHILDREN, MOST_LEVELS, PATCH_SLOTS, PatchSlot, Progress};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub patches: u32,
    pub grouped: u32,
    pub start: u32,
    pub workgroups: u32,
    pub levels: u32,
    pub norms: u32,
    pub present: u32,
    pub next: u32,
    /// Place of the first group of each level; those after the first unused one do not count.
    pub firsts: [u32; MOST_LEVELS + 4],
}

pub fn bound(buffers: Bound<'_>) {
    redirect(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &buffers.read(3),
        &mut buffers.write(4),
        &buffers.read(5),
        &mut buffers.write::<Progress>(6)[0],
    );
}

/// Motion of group `g` of patch `k` with all groups above it.
fn find_motion(
    params: &Params,
    links: &[[[f32; 4]; CHILDREN]],
    patch: &[PatchSlot],
    group_motions: &[f32],
    k: usize,
    g: usize,
) -> ([f32; 3], [f32; 3]) {
    let (mut shift, mut spin) = ([0.0f32; 3], [0.0f32; 3]);
    for level in (1..=params.levels as usize).rev() {
        let index = k >> (3 * (level - 1));
        if level < params.levels as usize {
            let parent = (params.firsts[level] - params.firsts[1]) as usize + (index >> 3);
            (shift, spin) = linked(links[parent][index & 7], shift, spin);
        }
        let (more, turn) = child(group_motions, params.firsts[level - 1] as usize + index);
        (shift, spin) = (added(shift, more), added(spin, turn));
    }
    linked(links_of(patch)[g], shift, spin)
}

/// The motion of a child that moves with its parent.
fn linked([x, y, z, ratio]: [f32; 4], shift: [f32; 3], spin: [f32; 3]) -> ([f32; 3], [f32; 3]) {
    (added(shift, crossed(spin, [x, y, z])), scaled(spin, ratio))
}

#[expect(clippy::too_many_arguments, reason = "the bindings of the kernel")]
pub fn redirect(
    params: Params,
    slots: &[PatchSlot],
    links: &[[[f32; 4]; CHILDREN]],
    group_motions: &[f32],
    image: &[[f32; 4]],
    direction: &mut [[f32; 4]],
    sums: &[f32],
    progress: &mut Progress,
) {
    if progress.moving == 0 {
        return;
    }
    let parts = |first: u32| &sums[first as usize..][..params.norms as usize];
    let mut ratio = 0.0;
    if params.start == 0 {
        ratio = sum_of_parts(parts(params.next)) / sum_of_parts(parts(params.present));
        progress.iterations += 1;
    }
    for k in 0..params.patches as usize {
        let patch = &slots[PATCH_SLOTS * k..][..PATCH_SLOTS];
        for (t, slot) in patch.iter().enumerate().filter(|(_, slot)| slot.node != NONE) {
            let [x, y, z, _] = image[slot.node as usize];
            let mut z = [x, y, z];
            if k < params.grouped as usize && params.levels > 0 {
                let (shift, spin) = find_motion(&params, links, patch, group_motions, k, t / CHILDREN);
                z = added(z, added(shift, crossed(spin, slot.arm)));
            }
            let p = &mut direction[slot.node as usize];
            if params.start == 0 {
                z = added(z, scaled([p[0], p[1], p[2]], ratio));
            }
            *p = [z[0], z[1], z[2], 0.0];
        }
    }
}
