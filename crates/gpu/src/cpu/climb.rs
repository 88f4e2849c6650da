//! Twin of `shader/climb.wgsl`.

use super::rigid::{force_on_parent, motions};
use super::sum::{THREADS, sum_of_threads};
use crate::bound::Bound;
use crate::linear::{CHILDREN, DOMAIN_WORDS, Progress};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub groups: u32,
    pub first: u32,
    pub first_parent: u32,
    pub first_domain: u32,
    pub domains: u32,
    pub workgroups: u32,
    pub present: u32,
    pub next: u32,
}

pub fn bound(buffers: Bound<'_>) {
    climb(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &mut buffers.write(2),
        &mut buffers.write(3),
        &mut buffers.write(4),
        &buffers.write::<Progress>(5)[0],
    );
}

pub fn climb(
    params: Params,
    coarse: &[f32],
    links: &[[[f32; 4]; CHILDREN]],
    forces: &mut [f32],
    group_motions: &mut [f32],
    sums: &mut [f32],
    progress: &Progress,
) {
    let workgroups = params.workgroups as usize;
    let (present, next) = (params.present as usize, params.next as usize);
    if progress.moving == 0 {
        sums.copy_within(present..present + workgroups, next);
        return;
    }
    for group in 0..workgroups {
        let mut squares = [0.0f32; THREADS];
        for k in (group..params.domains as usize).step_by(workgroups) {
            let parent = params.first_parent as usize + k;
            let place = 6 * (params.first as usize + CHILDREN * k);
            let used = 6 * CHILDREN.min(params.groups as usize - CHILDREN * k);
            let on_groups = std::array::from_fn(|t| if t < used { forces[place + t] } else { 0.0 });
            let domain = params.first_domain as usize + k;
            let moved = motions(&coarse[DOMAIN_WORDS * domain..], &on_groups);
            group_motions[place..place + used].copy_from_slice(&moved[..used]);
            for t in 0..used {
                squares[t] += moved[t] * on_groups[t];
            }
            forces[6 * parent..6 * parent + 6].copy_from_slice(&force_on_parent(&links[domain], &on_groups));
        }
        sums[next + group] = sum_of_threads(squares);
    }
}
