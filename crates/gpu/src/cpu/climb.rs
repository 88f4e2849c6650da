//! Twin of `shader/climb.wgsl`.

use super::rigid::{force_on_parent, motions};
use super::sum::{THREADS, sum_of_threads};
use super::{added, crossed, scaled};
use crate::bound::Bound;
use crate::linear::{CHILDREN, DOMAIN_UNKNOWNS, DOMAIN_WORDS, Progress};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub groups: [u32; 4],
    pub firsts: [u32; 4],
    pub first_domains: [u32; 4],
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

/// The share of thread `lane` in the force on a group `rise` levels above the first one.
fn sum_of_lane(
    params: &Params,
    links: &[[f32; 4]],
    forces: &[f32],
    group: usize,
    rise: usize,
    lane: usize,
) -> [f32; 6] {
    let (mut force, mut torque) = ([0.0f32; 3], [0.0f32; 3]);
    let end = ((group + 1) << (3 * rise)).min(params.groups[0] as usize);
    for part in ((group << (3 * rise)) + lane..end).step_by(CHILDREN) {
        let at = 6 * (params.firsts[0] as usize + part);
        let own = [forces[at], forces[at + 1], forces[at + 2]];
        let mut turn = [forces[at + 3], forces[at + 4], forces[at + 5]];
        for level in 0..rise {
            let [x, y, z, ratio] =
                links[CHILDREN * params.first_domains[level] as usize + (part >> (3 * level))];
            turn = added(scaled(turn, ratio), crossed([x, y, z], own));
        }
        (force, torque) = (added(force, own), added(torque, turn));
    }
    [force[0], force[1], force[2], torque[0], torque[1], torque[2]]
}

pub fn climb(
    params: Params,
    coarse: &[f32],
    links: &[[f32; 4]],
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
    let first = params.first_domains[0] as usize;
    for group in 0..workgroups {
        let mut squares = [0.0f32; THREADS];
        for domain in (first + group..first + params.domains as usize).step_by(workgroups) {
            let rise = params.first_domains[1..3].iter().filter(|&&first| domain >= first as usize).count();
            let parent = domain - params.first_domains[rise] as usize;
            let lanes: [[f32; 6]; THREADS] = std::array::from_fn(|t| {
                sum_of_lane(&params, links, forces, CHILDREN * parent + t / CHILDREN, rise, t % CHILDREN)
            });
            let on_groups: [f32; DOMAIN_UNKNOWNS] = std::array::from_fn(|t| {
                lanes[CHILDREN * (t / 6)..][..CHILDREN].iter().fold(0.0, |sum, lane| sum + lane[t % 6])
            });
            let used = 6 * CHILDREN.min(params.groups[rise] as usize - CHILDREN * parent);
            let moved = motions(&coarse[DOMAIN_WORDS * domain..], &on_groups);
            let place = 6 * (params.firsts[rise] as usize + CHILDREN * parent);
            group_motions[place..place + used].copy_from_slice(&moved[..used]);
            for t in 0..used {
                squares[t] += moved[t] * on_groups[t];
            }
            let of_children = std::array::from_fn(|m| links[CHILDREN * domain + m]);
            let place = 6 * (params.firsts[rise + 1] as usize + parent);
            forces[place..place + 6].copy_from_slice(&force_on_parent(&of_children, &on_groups));
        }
        sums[next + group] = sum_of_threads(squares);
    }
}
