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
    pub parents: u32,
    /// A uniform buffer has whole vectors.
    pub padding: [u32; 3],
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

const LANES: usize = 32;

/// Threads that have parts of a group.
fn lanes_of(rise: usize) -> usize {
    if rise == 3 { LANES } else { (1 << (3 * rise)).min(CHILDREN) }
}

/// A force and a torque.
type Wrench = [[f32; 3]; 2];

/// The forces on the parts of the first of these levels, and how they add up.
struct Forces<'a> {
    params: &'a Params,
    links: &'a [[f32; 4]],
    forces: &'a [f32],
}

impl Forces<'_> {
    fn on(&self, part: usize) -> Wrench {
        let at = 6 * (self.params.firsts[0] as usize + part);
        let f = &self.forces[at..at + 6];
        [[f[0], f[1], f[2]], [f[3], f[4], f[5]]]
    }

    /// The torque on the parent of a group of that level.
    fn lifted(&self, [force, torque]: Wrench, level: usize, group: usize) -> [f32; 3] {
        let [x, y, z, ratio] = self.links[CHILDREN * self.params.first_domains[level] as usize + group];
        added(scaled(torque, ratio), crossed([x, y, z], force))
    }

    /// The share of thread `lane` in the force on a group `rise` levels above the first one.
    fn sum_of_lane(&self, group: usize, rise: usize, lane: usize) -> [f32; 6] {
        let parts = self.params.groups[0] as usize;
        let mut sum = Wrench::default();
        if rise < 2 {
            let part = (group << (3 * rise)) + lane;
            if lane < lanes_of(rise) && part < parts {
                sum = self.on(part);
                if rise == 1 {
                    sum[1] = self.lifted(sum, 0, part);
                }
            }
        } else {
            let shift = 3 * (rise - 1);
            let end = ((group + 1) << shift).min(parts.div_ceil(CHILDREN));
            for eight in ((group << shift) + lane..end).step_by(LANES) {
                let mut of_eight = Wrench::default();
                for part in CHILDREN * eight..(CHILDREN * (eight + 1)).min(parts) {
                    let own = self.on(part);
                    let torque = self.lifted(own, 0, part);
                    of_eight = [added(of_eight[0], own[0]), added(of_eight[1], torque)];
                }
                for level in 1..rise {
                    of_eight[1] = self.lifted(of_eight, level, eight >> (3 * (level - 1)));
                }
                sum = [added(sum[0], of_eight[0]), added(sum[1], of_eight[1])];
            }
        }
        let [[a, b, c], [d, e, f]] = sum;
        [a, b, c, d, e, f]
    }
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
            let rise = params.first_domains[1..4].iter().filter(|&&first| domain >= first as usize).count();
            let parent = domain - params.first_domains[rise] as usize;
            let lanes: [[f32; 6]; THREADS] = std::array::from_fn(|t| {
                let own = Forces { params: &params, links, forces };
                own.sum_of_lane(CHILDREN * parent + t / LANES, rise, t % LANES)
            });
            let on_groups: [f32; DOMAIN_UNKNOWNS] = std::array::from_fn(|t| {
                lanes[LANES * (t / 6)..][..lanes_of(rise)].iter().fold(0.0, |sum, lane| sum + lane[t % 6])
            });
            let used = 6 * CHILDREN.min(params.groups[rise] as usize - CHILDREN * parent);
            let moved = motions(&coarse[DOMAIN_WORDS * domain..], &on_groups);
            let place = 6 * (params.firsts[rise] as usize + CHILDREN * parent);
            group_motions[place..place + used].copy_from_slice(&moved[..used]);
            for t in 0..used {
                squares[t] += moved[t] * on_groups[t];
            }
            let of_children = std::array::from_fn(|m| links[CHILDREN * domain + m]);
            let first = params.firsts.get(rise + 1).unwrap_or(&params.parents);
            let place = 6 * (*first as usize + parent);
            forces[place..place + 6].copy_from_slice(&force_on_parent(&of_children, &on_groups));
        }
        sums[next + group] = sum_of_threads(squares);
    }
}
