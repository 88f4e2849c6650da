//! Twin of `shader/descend.wgsl`.

use super::rigid::{child, force_on_parent, motions};
use super::sum::{THREADS, sum_of_parts, sum_of_threads};
use super::{added, crossed, dot, scaled, subtracted};
use crate::bound::Bound;
use crate::layout::NONE;
use crate::linear::{CHILDREN, DOMAIN_UNKNOWNS, DOMAIN_WORDS, PATCH_SLOTS, PatchSlot, Progress};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub patches: u32,
    pub grouped: u32,
    pub start: u32,
    pub workgroups: u32,
    pub curvatures: u32,
    pub norms: u32,
    pub present: u32,
    pub next: u32,
}

/// Patches that a workgroup steps at once.
const STEPPED: usize = THREADS / PATCH_SLOTS;

pub fn bound(buffers: Bound<'_>) {
    descend(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &mut buffers.write(3),
        &mut buffers.write(4),
        &mut buffers.write(5),
        &mut buffers.write(6),
        &mut buffers.write::<Progress>(7)[0],
    );
}

fn is_positive(number: f32) -> bool {
    number > 0.0 && number.is_finite()
}

fn solve(f: [f32; 6], r: [f32; 3]) -> [f32; 3] {
    let y = r[1] - f[0] * r[0];
    let z = f[5] * (r[2] - f[1] * r[0] - f[2] * y);
    let y_solved = f[4] * y - f[2] * z;
    [f[3] * r[0] - f[0] * y_solved - f[1] * z, y_solved, z]
}

fn first_three([x, y, z, _]: [f32; 4]) -> [f32; 3] {
    [x, y, z]
}

fn padded([x, y, z]: [f32; 3]) -> [f32; 4] {
    [x, y, z, 0.0]
}

#[expect(clippy::too_many_arguments, reason = "the bindings of the kernel")]
pub fn descend(
    params: Params,
    slots: &[PatchSlot],
    domains: &[f32],
    direction: &[[f32; 4]],
    image: &mut [[f32; 4]],
    solution: &mut [[f32; 4]],
    forces: &mut [f32],
    sums: &mut [f32],
    progress: &mut Progress,
) {
    let (nodes, workgroups) = (params.nodes as usize, params.workgroups as usize);
    let (present, next) = (params.present as usize, params.next as usize);
    let mut step = 0.0;
    let mut goes_on = progress.moving == 1;
    if params.start == 0 {
        let norm = sum_of_parts(&sums[present..present + params.norms as usize]);
        let curvature = sum_of_parts(&sums[..params.curvatures as usize]);
        goes_on &= norm > progress.goal && is_positive(norm) && is_positive(curvature);
        step = norm / curvature;
    }
    if !goes_on {
        sums.copy_within(present..present + workgroups, next);
        progress.moving = 0;
        return;
    }
    for group in 0..workgroups {
        let mut squares = [0.0f32; THREADS];
        let turns = (STEPPED * group..params.patches as usize).step_by(STEPPED * workgroups);
        for k in turns.flat_map(|first| first..(first + STEPPED).min(params.patches as usize)) {
            // The threads of the patch.
            let squares = &mut squares[PATCH_SLOTS * (k % STEPPED)..][..PATCH_SLOTS];
            let patch = &slots[PATCH_SLOTS * k..][..PATCH_SLOTS];
            let (mut r, mut z) = ([[0.0f32; 3]; PATCH_SLOTS], [[0.0f32; 3]; PATCH_SLOTS]);
            for (t, slot) in patch.iter().enumerate() {
                if slot.node != NONE {
                    let i = slot.node as usize;
                    let p = first_three(direction[i]);
                    if params.start == 1 {
                        r[t] = p;
                        solution[i] = [0.0; 4];
                    } else {
                        r[t] =
                            subtracted(first_three(solution[nodes + i]), scaled(first_three(image[i]), step));
                        solution[i] = padded(added(first_three(solution[i]), scaled(p, step)));
                    }
                    solution[nodes + i] = padded(r[t]);
                }
                z[t] = solve(slot.factors, r[t]);
                squares[t] += dot(r[t], z[t]);
            }
            if k < params.grouped as usize {
                let on_groups = forces_on_groups(patch, &r);
                let moved = motions(&domains[DOMAIN_WORDS * k..], &on_groups);
                for t in 0..DOMAIN_UNKNOWNS {
                    squares[t] += moved[t] * on_groups[t];
                }
                forces[6 * k..6 * k + 6].copy_from_slice(&force_on_parent(&links_of(patch), &on_groups));
                for (t, slot) in patch.iter().enumerate() {
                    let (shift, spin) = child(&moved, t / CHILDREN);
                    z[t] = added(z[t], added(shift, crossed(spin, slot.arm)));
                }
            }
            for (slot, z) in patch.iter().zip(z).filter(|(slot, _)| slot.node != NONE) {
                image[slot.node as usize] = padded(z);
            }
        }
        sums[next + group] = sum_of_threads(squares);
    }
}

/// The links of the groups of a patch.
pub fn links_of(patch: &[PatchSlot]) -> [[f32; 4]; CHILDREN] {
    std::array::from_fn(|g| {
        let ([x, y], [z, ratio]) = (patch[CHILDREN * g].link, patch[CHILDREN * g + 1].link);
        [x, y, z, ratio]
    })
}

/// Forces on the rigid motions of the groups of a patch.
fn forces_on_groups(patch: &[PatchSlot], r: &[[f32; 3]; PATCH_SLOTS]) -> [f32; DOMAIN_UNKNOWNS] {
    std::array::from_fn(|t| {
        let (group, component) = (t / 6, t % 6);
        (CHILDREN * group..CHILDREN * (group + 1)).fold(0.0, |sum, slot| {
            let moment = crossed(patch[slot].arm, r[slot]);
            sum + if component < 3 { r[slot][component] } else { moment[component - 3] }
        })
    })
}
