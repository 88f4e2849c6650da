//! The stages of a step, in their order.

use super::Collision;
use crate::engine::Engine;
use crate::kernels;
use crate::kernels::stop_rule::{AFTER_SEARCH, AFTER_STEP};
use crate::layout::Block;
use crate::recording::{Phase, Recording};

/// By how much a trust region is larger than half of the path, in local edge lengths times the
/// [factor](Collision) of the call.
const SLACK: f32 = 0.05;

impl<E: Engine> Collision<E> {
    /// The dispatches of a step, in order. `first`: it is the first one of its submission, of which so many
    /// dispatches can be left out.
    pub(super) fn record_step(&self, first: bool, dispatches: usize, recording: &mut Recording) {
        self.record_reset(first, recording);
        recording.begin_phase(Phase::Backward);
        // If the step is made again, the aims are known.
        if !self.again {
            self.record_rows(dispatches, recording);
            self.record_backward(recording);
        }
        self.record_paths(recording);
        self.record_search(recording);
        self.record_geometry(true, recording);
        self.record_forward(recording);
        self.record_stop_rule(AFTER_STEP, dispatches, recording);
    }

    /// The first search of a call, without a step: along the ways to the targets, so that the rows of the
    /// first step know what it meets. `dispatches` as for a step.
    pub(super) fn record_first_search(&self, dispatches: usize, recording: &mut Recording) {
        self.record_reset(true, recording);
        self.record_paths(recording);
        self.record_search(recording);
        self.carried.record(&self.buffers, recording);
        self.record_stop_rule(AFTER_SEARCH, dispatches, recording);
    }

    /// Whether the submission goes on. `after`: what has gone before.
    pub(super) fn record_stop_rule(&self, after: u32, dispatches: usize, recording: &mut Recording) {
        let (b, settings) = (&self.buffers, &self.settings);
        let polishing = (settings.polish_distance, settings.polish_stretch);
        recording.dispatch(
            &kernels::STOP_RULE,
            &[b.control, b.reports, b.arguments],
            kernels::stop_rule::Params {
                polishes: u32::from(self.polishes),
                after,
                dispatches: dispatches as u32,
                ..self.stop.params(&self.grid, settings.has_polishing().then_some(polishing))
            },
            1,
        );
    }

    /// Resets what the stages of a step add to.
    pub(super) fn record_reset(&self, first: bool, recording: &mut Recording) {
        let (b, groups) = (&self.buffers, self.sizes.groups);
        recording.dispatch(
            &kernels::RESET_STEP,
            &[b.group_caps, b.group_alphas, b.control],
            kernels::reset_step::Params {
                groups: groups as u32,
                again: u32::from(self.again),
                first: u32::from(first),
            },
            groups.max(1),
        );
    }

    /// How far each vertex wants to go, and which trust regions do not cover it.
    pub(super) fn record_paths(&self, recording: &mut Recording) {
        recording.begin_phase(Phase::Forward);
        let (b, vertices) = (&self.buffers, self.sizes.vertices as u32);
        recording.dispatch(
            &kernels::CAP_TRAVEL,
            &[b.positions, b.aims, b.vertices, b.paths, b.group_caps],
            kernels::cap_travel::Params {
                vertices,
                longest: self.travel * self.settings.longest_travel as f32,
            },
            self.sizes.vertices,
        );
        recording.dispatch(
            &kernels::CAP_GROUPS,
            &[b.vertices, b.group_caps, b.paths, b.alphas],
            kernels::cap_groups::Params { vertices },
            self.sizes.vertices,
        );
        self.record_trust_regions(recording);
    }

    /// New trust regions where the paths need them.
    pub(super) fn record_trust_regions(&self, recording: &mut Recording) {
        recording.begin_phase(Phase::Search);
        let (b, vertices) = (&self.buffers, self.sizes.vertices as u32);
        recording.dispatch(
            &kernels::UPDATE_TRUST_REGIONS,
            &[b.positions, b.paths, b.vertices, b.balls, b.control],
            kernels::update_trust_regions::Params {
                vertices,
                all: u32::from(self.fresh || self.shrunk),
                slack: self.travel * SLACK,
                smallest: self.travel * self.settings.smallest_radius as f32,
            },
            self.sizes.vertices,
        );
    }

    /// Contact geometry of all candidates at the present positions; after a search only if there was one, for
    /// nothing has moved since the geometry of the backward step.
    pub(super) fn record_geometry(&self, after_search: bool, recording: &mut Recording) {
        self.record_separations(after_search, recording);
        let (b, capacity) = (&self.buffers, self.buffers.capacity as u32);
        recording.dispatch(
            &kernels::DESIRED_DISTANCES,
            &[b.rest, b.edges, b.triangles, b.vertices, b.candidates, b.separations, b.states, b.control],
            kernels::desired_distances::Params {
                capacity,
                after_search: u32::from(after_search),
                min_separation: self.lengths.min_separation,
                growth: self.lengths.growth,
                range: self.settings.range as f32,
                first_half_space: self.sizes.vertices as u32,
                known: self.settings.known as f32,
                guarded: self.settings.guarded as f32,
                guarded_floor: self.settings.guarded_floor as f32,
            },
            self.buffers.capacity,
        );
    }

    /// The part of it that the positions alone decide.
    pub(super) fn record_separations(&self, after_search: bool, recording: &mut Recording) {
        recording.begin_phase(Phase::Evaluate);
        let (b, capacity) = (&self.buffers, self.buffers.capacity as u32);
        recording.dispatch(
            &kernels::SEPARATE,
            &[b.positions, b.edges, b.triangles, b.planes, b.candidates, b.separations, b.control],
            kernels::separate::Params { capacity, after_search: u32::from(after_search) },
            self.buffers.capacity,
        );
    }

    /// Step sizes, the move, and how far its end is from a solution.
    pub(super) fn record_forward(&self, recording: &mut Recording) {
        recording.begin_phase(Phase::Forward);
        let (b, vertices, capacity) =
            (&self.buffers, self.sizes.vertices as u32, self.buffers.capacity as u32);
        recording.dispatch(
            &kernels::LIMIT_STEP_SIZES,
            &[b.edges, b.triangles, b.vertices, b.candidates, b.separations, b.paths, b.alphas, b.control],
            kernels::limit_step_sizes::Params { capacity, damping: self.lengths.damping },
            self.buffers.capacity,
        );
        recording.dispatch(
            &kernels::LIMIT_GROUPS,
            &[b.vertices, b.alphas, b.group_alphas],
            kernels::limit_groups::Params { vertices },
            self.sizes.vertices,
        );
        recording.dispatch(
            &kernels::ADVANCE_VERTICES,
            &[b.aims, b.vertices, b.paths, b.alphas, b.group_alphas, b.positions, b.control, b.late],
            kernels::advance_vertices::Params { vertices, progress: self.lengths.progress },
            self.sizes.vertices,
        );
        recording.dispatch(
            &kernels::MAX_STRETCH,
            &[b.positions, b.limits, b.control],
            kernels::max_stretch::Params { edges: self.edges.len() as u32 },
            self.edges.len(),
        );
        let blocks = self.sizes.blocks as u32;
        recording.dispatch(
            &kernels::BLOCK_RESIDUALS,
            &[b.vertex_blocks, b.positions, b.aims, b.displacements, b.vertices, b.block_sums],
            kernels::block_residuals::Params { blocks },
            Block::MOST * self.sizes.blocks,
        );
        recording.dispatch(
            &kernels::BODY_RESIDUALS,
            &[b.vertex_blocks, b.block_sums, b.control],
            kernels::body_residuals::Params { blocks },
            kernels::BODY_RESIDUALS.workgroup * self.sizes.blocks,
        );
    }
}
