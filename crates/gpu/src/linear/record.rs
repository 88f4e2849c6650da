//! The dispatches of linear solves.

use super::buffers::{Buffers, MOST_COARSE_WORKGROUPS, Sizes};
use super::layout::{CHILDREN, Progress};
use crate::kernels;
use crate::linear::THREADS;
use crate::recording::{BufferId, Recording};

/// Coarse levels of a dispatch: a group is the sum of at most 512 parts then, by 32 threads.
const LEVELS_PER_DISPATCH: usize = 4;

/// The dispatches of a system. With other buffers in place of those of the system they work on other vectors.
#[derive(Clone, Debug)]
pub struct Recorder {
    pub buffers: Buffers,
    pub sizes: Sizes,
    /// None where the blocks of the matrix are all there is.
    pub strands: Option<StrandHessian>,
}

/// The Hessian of strands, element by element, see `strand_product.wgsl`.
#[derive(Clone, Copy, Debug)]
pub struct StrandHessian {
    pub strands: BufferId,
    pub curvatures: BufferId,
    pub rows: BufferId,
    /// Nodes with strands.
    pub count: usize,
}

impl Recorder {
    /// Starts from x = 0 with the residual that lies where the search direction goes, as step `k` in the
    /// order of all steps: its partial sums are in [`Self::norms`] of `k`.
    pub fn record_residual(&self, k: usize, recording: &mut Recording) {
        self.record_step(true, 1 - k % 2, recording);
    }

    /// H x, which goes where the image of the search direction lies.
    pub fn record_product(&self, x: &[[f32; 4]], recording: &mut Recording) {
        recording.write(self.buffers.direction, x);
        recording.write(self.buffers.progress, &[Progress { moving: 1, iterations: 0, goal: 0.0 }]);
        self.record_image(recording);
    }

    /// Iteration `k` after the start: nothing is done if the squared norm is small enough already.
    pub fn record_iteration(&self, k: usize, recording: &mut Recording) {
        self.record_image(recording);
        self.record_step(false, k % 2, recording);
    }

    /// The image of the search direction.
    pub fn record_image(&self, recording: &mut Recording) {
        let (b, s) = (&self.buffers, &self.sizes);
        if let Some(strands) = self.strands {
            recording.dispatch(
                &kernels::STRAND_PRODUCT,
                &[strands.strands, strands.curvatures, strands.rows, b.direction, b.image, b.progress],
                kernels::strand_product::Params { rows: strands.count as u32 },
                strands.count,
            );
        }
        recording.dispatch(
            &kernels::MATRIX_PRODUCT,
            &[b.slices, b.words, b.spring_words, b.springs, b.direction, b.image, b.sums, b.progress],
            kernels::matrix_product::Params {
                nodes: s.nodes as u32,
                springs: s.springs as u32,
                workgroups: s.multiplying() as u32,
            },
            THREADS * s.multiplying(),
        );
    }

    /// Where the partial sums of squared norms are that the last of `iterations` since the start wrote, in
    /// words, and their number.
    pub fn norms(&self, iterations: usize) -> std::ops::Range<usize> {
        let first = self.norms_at(iterations % 2);
        first..first + self.norm_count()
    }

    /// Where the partial sums of squared norms of a half begin: after those of p . q.
    fn norms_at(&self, half: usize) -> usize {
        self.sizes.multiplying() + half * self.norm_count()
    }

    fn norm_count(&self) -> usize {
        self.sizes.stepping()
            + self.sizes.levels.chunks(LEVELS_PER_DISPATCH).map(coarse_workgroups).sum::<usize>()
    }

    /// The step, the preconditioner and the next direction. The present partial sums are those in half
    /// `present`.
    fn record_step(&self, is_start: bool, present: usize, recording: &mut Recording) {
        let (b, s) = (&self.buffers, &self.sizes);
        let start = u32::from(is_start);
        let (mut present, mut next) = (self.norms_at(present) as u32, self.norms_at(1 - present) as u32);
        let (patches, grouped) = (s.patches as u32, s.grouped as u32);
        let (workgroups, norms) = (s.stepping() as u32, self.norm_count() as u32);
        let (all_present, all_next) = (present, next);
        recording.dispatch(
            &kernels::CG_STEP,
            &[b.slots, b.domains, b.direction, b.image, b.solution, b.forces, b.sums, b.progress],
            kernels::cg_step::Params {
                nodes: s.nodes as u32,
                patches,
                grouped,
                start,
                workgroups,
                curvatures: s.multiplying() as u32,
                norms,
                present,
                next,
            },
            THREADS * s.stepping(),
        );
        (present, next) = (present + workgroups, next + workgroups);
        let firsts = s.first_groups();
        for (first_level, levels) in
            (0..).step_by(LEVELS_PER_DISPATCH).zip(s.levels.chunks(LEVELS_PER_DISPATCH))
        {
            let mut params = kernels::schwarz_levels::Params {
                groups: [0; 4],
                firsts: [0; 4],
                first_domains: [u32::MAX; 4],
                domains: domains_of(levels) as u32,
                workgroups: coarse_workgroups(levels) as u32,
                present,
                next,
                parents: firsts[first_level + 4],
                padding: [0; 3],
            };
            params.firsts.copy_from_slice(&firsts[first_level..first_level + 4]);
            for (rise, &groups) in levels.iter().enumerate() {
                params.groups[rise] = groups as u32;
                params.first_domains[rise] = firsts[first_level + rise + 1] - grouped;
            }
            recording.dispatch(
                &kernels::SCHWARZ_LEVELS,
                &[b.coarse, b.links, b.forces, b.motions, b.sums, b.progress],
                params,
                THREADS * params.workgroups as usize,
            );
            (present, next) = (present + params.workgroups, next + params.workgroups);
        }
        recording.dispatch(
            &kernels::CG_DIRECTION,
            &[b.slots, b.links, b.motions, b.image, b.direction, b.sums, b.progress],
            kernels::cg_direction::Params {
                patches,
                grouped,
                start,
                workgroups,
                levels: s.levels.len() as u32,
                norms,
                present: all_present,
                next: all_next,
                firsts: bytemuck::cast(firsts),
            },
            THREADS * s.stepping(),
        );
    }
}

/// Domains of some coarse levels.
fn domains_of(levels: &[usize]) -> usize {
    levels.iter().map(|groups| groups.div_ceil(CHILDREN)).sum()
}

/// Workgroups of a dispatch over some coarse levels.
fn coarse_workgroups(levels: &[usize]) -> usize {
    domains_of(levels).min(MOST_COARSE_WORKGROUPS)
}
