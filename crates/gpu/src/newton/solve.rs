//! What a linear solve records.
//!
//! Positions, steps and forces are in SI units; conjugate gradients work on forces times [`Solve::factor`],
//! and on displacements times the same.

use super::layout::{FIRST_SUM, Solve};
use super::places::Newton;
use crate::kernels;
use crate::kernels::cg_tolerance;
use crate::linear::THREADS;
use crate::linear::{Buffers, Progress, Recorder};
use crate::recording::{BufferId, Recording};
use bowknot_dynamics::SolveLimits;

/// Forces that a right-hand side opposes.
#[derive(Clone, Copy, Debug)]
pub struct Opposed {
    /// The gradient of the bodies.
    pub gradient: BufferId,
    /// A bit for each node that counts.
    pub counted: BufferId,
    /// Number of springs.
    pub springs: usize,
    /// Whether the image is that of displacements of nodes that are not free.
    pub imposes: bool,
}

impl Newton {
    /// Records what stands before a solve.
    pub fn record_before(&self, recording: &mut Recording) {
        recording.write(self.vectors.solve, &[Solve::BEFORE]);
        recording.write(self.vectors.ended, &[Progress { moving: 1, iterations: 0, goal: 0.0 }]);
    }

    /// A recorder whose stages run outside of the iterations of a round.
    pub fn outside(&self, recorder: &Recorder) -> Recorder {
        let mut outside = recorder.clone();
        outside.buffers.progress = self.vectors.ended;
        outside
    }

    /// Records the image of the displacements of nodes that are not free.
    pub fn record_imposed(&self, recorder: &Recorder, recording: &mut Recording) {
        let b = &recorder.buffers;
        recording.dispatch(
            &kernels::IMPOSED_DISPLACEMENTS,
            &[self.vectors.imposed, b.direction],
            kernels::imposed_displacements::Params {
                nodes: self.nodes as u32,
                quantum: self.grid.quantum as f32,
            },
            self.nodes,
        );
        self.outside(recorder).record_image(recording);
    }

    /// Records the right-hand side, and that its factor makes conjugate gradients start from it.
    pub fn record_right_side(&self, b: &Buffers, opposed: &Opposed, recording: &mut Recording) {
        let (v, workgroups) = (&self.vectors, self.workgroups());
        recording.dispatch(
            &kernels::RIGHT_HAND_SIDE,
            &[opposed.gradient, b.image, b.springs, b.spring_words, opposed.counted, v.right_side, v.sums],
            kernels::right_hand_side::Params {
                nodes: self.nodes as u32,
                springs: opposed.springs as u32,
                imposed: u32::from(opposed.imposes),
                workgroups: workgroups as u32,
            },
            THREADS * workgroups,
        );
        let params = cg_tolerance::Params {
            mode: cg_tolerance::FACTOR,
            count: workgroups as u32,
            ..cg_tolerance::Params::default()
        };
        self.record_tolerance(v.sums, b, params, recording);
        self.record_cg_residual(b, false, recording);
    }

    /// Records that conjugate gradients start from b, or from b less the image.
    pub fn record_cg_residual(&self, b: &Buffers, subtract: bool, recording: &mut Recording) {
        let v = &self.vectors;
        recording.dispatch(
            &kernels::CG_RESIDUAL,
            &[v.right_side, b.image, v.solve, b.direction],
            kernels::cg_residual::Params { nodes: self.nodes as u32, subtract: u32::from(subtract) },
            self.nodes,
        );
    }

    fn record_tolerance(
        &self,
        sums: BufferId,
        b: &Buffers,
        params: cg_tolerance::Params,
        recording: &mut Recording,
    ) {
        let v = &self.vectors;
        recording.dispatch(&kernels::CG_TOLERANCE, &[sums, v.solve, b.progress, v.ended], params, 1);
    }

    /// Records that the norms of step `k` of the solve become those of the mode.
    pub fn record_norm(
        &self,
        recorder: &Recorder,
        mode: u32,
        k: usize,
        limits: &SolveLimits,
        recording: &mut Recording,
    ) {
        let norms = recorder.norms(k);
        let params = cg_tolerance::Params {
            mode,
            first: norms.start as u32,
            count: norms.len() as u32,
            tolerance: (limits.tolerance * limits.tolerance) as f32,
            own_tolerance: (limits.own_tolerance * limits.own_tolerance) as f32,
            min_scale: limits.min_scale as f32,
        };
        self.record_tolerance(recorder.buffers.sums, &recorder.buffers, params, recording);
    }

    /// Records the combination of guesses with the least energy, where the step starts, and its residual.
    pub fn record_guesses(&self, recorder: &Recorder, recording: &mut Recording) {
        let (v, b) = (&self.vectors, &recorder.buffers);
        let (nodes, workgroups) = (self.nodes as u32, self.workgroups() as u32);
        let count = 1 + u32::from(self.has_last);
        recording.dispatch(
            &kernels::INITIAL_GUESSES,
            &[v.iterate, v.inertial, v.last, v.free, b.direction, v.second],
            kernels::initial_guesses::Params { nodes, count, quantum: self.grid.quantum as f32 },
            self.nodes,
        );
        let mut images = self.outside(recorder);
        images.record_image(recording);
        if count == 2 {
            images.buffers.direction = v.second;
            images.buffers.image = v.second_image;
            images.record_image(recording);
        }
        let first = FIRST_SUM as u32;
        recording.dispatch(
            &kernels::GUESS_PRODUCTS,
            &[b.direction, b.image, v.second, v.second_image, v.right_side, v.sums],
            kernels::guess_products::Params { nodes, count, workgroups, first },
            THREADS * self.workgroups(),
        );
        recording.dispatch(
            &kernels::COMBINE_GUESSES,
            &[b.image, v.second, v.second_image, v.right_side, v.sums, v.solve, b.direction, v.step],
            kernels::combine_guesses::Params { nodes, count, workgroups, first },
            self.nodes,
        );
    }

    /// Records the end of a round, after step `k` of the solve, which does nothing if the round goes on: the
    /// solution is added to the step, and conjugate gradients start from its residual.
    pub fn record_end(
        &self,
        recorder: &Recorder,
        k: usize,
        is_last: bool,
        limits: &SolveLimits,
        recording: &mut Recording,
    ) {
        let (v, b) = (&self.vectors, &recorder.buffers);
        recording.dispatch(
            &kernels::ADD_SOLUTION,
            &[b.solution, b.progress, v.ended, v.solve, v.step],
            kernels::add_solution::Params { nodes: self.nodes as u32, last: u32::from(is_last) },
            self.nodes,
        );
        let outside = self.outside(recorder);
        let mut image = outside.clone();
        image.buffers.direction = v.step;
        image.record_image(recording);
        self.record_cg_residual(b, true, recording);
        outside.record_residual(k + 1, recording);
        self.record_norm(recorder, cg_tolerance::ROUND, k + 1, limits, recording);
    }
}
