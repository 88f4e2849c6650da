//! The stages of the backward step: contact rows, their buckets and colors, the sweeps.

use super::Collision;
use super::record_search::ListPlaces;
use crate::engine::Engine;
use crate::kernels;
use crate::kernels::scan_counts::CONTACT_ROWS;
use crate::kernels::stop_rule::AFTER_ROWS;
use crate::recording::{Phase, Recording};

/// Largest number of coarse corrections in a backward step, as on the CPU.
const MAX_COARSE_CORRECTIONS: usize = 64;

impl<E: Engine> Collision<E> {
    /// The contact rows at the present positions: which candidates have one. `dispatches` as for a step.
    pub(super) fn record_rows(&self, dispatches: usize, recording: &mut Recording) {
        let (b, r) = (&self.buffers, &self.buffers.rows);
        let (vertices, capacity) = (self.sizes.vertices, self.buffers.capacity as u32);
        let row_capacity = self.buffers.row_capacity as u32;
        recording.dispatch(
            &kernels::PREVIOUS_DISPLACEMENTS,
            &[b.positions, b.aims, b.displacements, b.contacts],
            kernels::previous_displacements::Params {
                vertices: vertices as u32,
                table: b.contact_places as u32,
            },
            vertices.max(b.contact_places),
        );
        self.record_geometry(false, recording);
        recording.begin_phase(Phase::Backward);
        if self.settings.contacts_only {
            let [edges_first, triangles_first] = self.adjacency_starts;
            recording.dispatch(
                &kernels::CLASSIFY_CONTACTS,
                &[
                    b.positions,
                    b.edges,
                    b.triangles,
                    b.adjacency,
                    b.candidates,
                    b.states,
                    b.separations,
                    b.control,
                ],
                kernels::classify_contacts::Params { capacity, edges_first, triangles_first },
                self.buffers.capacity,
            );
        }
        recording.dispatch(
            &kernels::SELECT_ROWS,
            &[
                b.displacements,
                b.edges,
                b.triangles,
                b.candidates,
                b.separations,
                b.states,
                b.selection.starts,
                b.control,
            ],
            kernels::select_rows::Params { capacity, threshold: self.settings.active as f32 },
            self.buffers.capacity,
        );
        self.record_merging(recording);
        let places = ListPlaces {
            starts: b.selection.starts,
            blocks: b.selection.blocks,
            rows: capacity,
            capacity: row_capacity,
            list: CONTACT_ROWS,
        };
        self.record_scan(&places, recording);
        // Without room for all rows the step ends here, and is made again.
        self.record_stop_rule(AFTER_ROWS, dispatches, recording);
        recording.dispatch(
            &kernels::COMPACT_ROWS,
            &[b.edges, b.triangles, b.selection.starts, b.candidates, r.rows, r.pairs, b.control],
            kernels::compact_rows::Params { capacity },
            self.buffers.capacity,
        );
        recording.dispatch(
            &kernels::LINEARIZE_ROWS,
            &[b.vertices, b.candidates, b.separations, b.states, r.rows, b.proximal, b.control],
            kernels::linearize_rows::Params {
                capacity: row_capacity,
                strength: self.settings.contact_proximal as f32,
            },
            self.buffers.row_capacity,
        );
        if self.frictional {
            recording.dispatch(
                &kernels::FRICTION_ROWS,
                &[
                    b.positions,
                    b.slip_start,
                    b.vertices,
                    b.pair_frictions,
                    b.candidates,
                    b.states,
                    r.rows,
                    b.control,
                ],
                kernels::friction_rows::Params {
                    capacity: row_capacity,
                    pair_frictions: self.sizes.pair_frictions as u32,
                    first_half_space: vertices as u32,
                },
                self.buffers.row_capacity,
            );
        }
    }

    /// Leaves one row to all selected candidates with the same closest points.
    fn record_merging(&self, recording: &mut Recording) {
        // Grains alone have no closest points in common.
        if self.sizes.edges + self.sizes.triangles == 0 {
            return;
        }
        let (b, capacity) = (&self.buffers, self.buffers.capacity as u32);
        let mask = b.contact_places as u32 - 1;
        recording.dispatch(
            &kernels::HASH_CONTACTS,
            &[
                b.edges,
                b.triangles,
                b.candidates,
                b.separations,
                b.states,
                b.selection.starts,
                b.contacts,
                b.control,
            ],
            kernels::hash_contacts::Params { capacity, mask },
            self.buffers.capacity,
        );
        recording.dispatch(
            &kernels::MERGE_ROWS,
            &[
                b.edges,
                b.triangles,
                b.candidates,
                b.separations,
                b.contacts,
                b.states,
                b.selection.starts,
                b.control,
            ],
            kernels::merge_rows::Params { capacity, mask },
            self.buffers.capacity,
        );
    }

    /// Divides the rows into buckets, and those of each into colors: rows of one color share no vertex that
    /// moves.
    fn record_colors(&self, recording: &mut Recording) {
        let (b, r, capacity) = (&self.buffers, &self.buffers.rows, self.buffers.row_capacity as u32);
        recording.dispatch(
            &kernels::BIN_ROWS,
            &[b.positions, b.displacements, r.rows, r.tally, b.control],
            kernels::bin_rows::Params { capacity, shift: self.bricks.shift, buckets: self.bricks.buckets },
            self.buffers.row_capacity,
        );
        recording.dispatch(
            &kernels::SCAN_BUCKETS,
            &[r.tally, r.buckets],
            kernels::scan_buckets::Params { buckets: self.bricks.count() as u32 },
            1,
        );
        recording.dispatch(
            &kernels::SORT_ROWS,
            &[r.rows, r.buckets, r.tally, r.order, b.control],
            kernels::sort_rows::Params { capacity },
            self.buffers.row_capacity,
        );
        // One round after the other, for buckets of two rounds may share vertices.
        for round in self.bricks.rounds() {
            recording.dispatch(
                &kernels::COLOR_ROWS,
                &[
                    b.displacements,
                    r.rows,
                    r.buckets,
                    r.colors_in_use,
                    r.claims,
                    r.waiting,
                    r.order,
                    r.color_ends,
                ],
                kernels::color_rows::Params { first: round.start, end: round.end, capacity },
                kernels::COLOR_ROWS.workgroup * round.len(),
            );
        }
    }

    /// A sweep over all contact rows. If it is to `only_apply`, multipliers stay.
    fn record_row_sweep(&self, only_apply: bool, recording: &mut Recording) {
        let (b, r) = (&self.buffers, &self.buffers.rows);
        for round in self.bricks.rounds() {
            recording.dispatch(
                &kernels::SWEEP_ROWS,
                &[r.order, r.buckets, r.color_ends, r.rows, b.displacements, b.pushes],
                kernels::sweep_rows::Params {
                    first: round.start,
                    end: round.end,
                    only_apply: u32::from(only_apply),
                    sweeps: if only_apply { 1 } else { self.settings.bucket_sweeps as u32 },
                },
                kernels::SWEEP_ROWS.workgroup * round.len(),
            );
        }
    }

    /// A sweep over all limited edges, as for rows.
    fn record_edge_sweep(&self, only_apply: bool, recording: &mut Recording) {
        let b = &self.buffers;
        for round in self.edges.rounds() {
            recording.dispatch(
                &kernels::SWEEP_EDGES,
                &[b.positions, b.clusters, b.cluster_vertices, b.cluster_colors, b.limits, b.displacements],
                kernels::sweep_edges::Params {
                    first: round.start as u32,
                    end: round.end as u32,
                    only_apply: u32::from(only_apply),
                    sweeps: if only_apply { 1 } else { self.settings.cluster_sweeps as u32 },
                },
                kernels::SWEEP_EDGES.workgroup * round.len(),
            );
        }
    }

    /// Scales all multipliers, and the displacements with them.
    fn record_coarse_correction(&self, recording: &mut Recording) {
        let (b, r) = (&self.buffers, &self.buffers.rows);
        let [vertices, limits] = [self.sizes.vertices, self.edges.len()].map(|count| count as u32);
        let capacity = self.buffers.row_capacity as u32;
        let threads = self.buffers.row_capacity.max(self.sizes.vertices).max(self.edges.len());
        let blocks = threads.div_ceil(kernels::COARSE_SUMS.workgroup).min(kernels::COARSE_FACTOR.workgroup);
        recording.dispatch(
            &kernels::COARSE_SUMS,
            &[
                r.rows,
                b.limits,
                b.positions,
                b.targets,
                b.vertices,
                b.displacements,
                b.control,
                b.coarse_sums,
            ],
            kernels::coarse_sums::Params { blocks: blocks as u32, capacity, limits, vertices },
            blocks * kernels::COARSE_SUMS.workgroup,
        );
        recording.dispatch(
            &kernels::COARSE_FACTOR,
            &[b.coarse_sums, b.coarse_factor],
            kernels::coarse_factor::Params { blocks: blocks as u32 },
            1,
        );
        recording.dispatch(
            &kernels::COARSE_RESCALE,
            &[
                b.coarse_factor,
                r.rows,
                b.limits,
                b.positions,
                b.targets,
                b.vertices,
                b.displacements,
                b.control,
            ],
            kernels::coarse_rescale::Params { capacity, limits, vertices },
            threads,
        );
    }

    /// Where the vertices should go so that no edge is too long and no gap too small.
    pub(super) fn record_backward(&self, recording: &mut Recording) {
        let (b, r) = (&self.buffers, &self.buffers.rows);
        let vertices = self.sizes.vertices as u32;
        recording.dispatch(
            &kernels::ADD_EDGE_CURVATURE,
            &[b.positions, b.limits, b.proximal],
            kernels::add_edge_curvature::Params {
                edges: self.edges.len() as u32,
                strength: self.settings.edge_proximal as f32,
            },
            self.edges.len(),
        );
        recording.dispatch(
            &kernels::UNCONSTRAINED_MINIMUM,
            &[b.positions, b.targets, b.vertices, b.proximal, b.displacements, b.swings, b.late],
            kernels::unconstrained_minimum::Params { vertices },
            self.sizes.vertices,
        );
        if self.has_pins {
            let capacity = self.buffers.row_capacity as u32;
            recording.dispatch(
                &kernels::ATTAINABLE_DISTANCES,
                &[b.positions, b.displacements, b.candidates, b.separations, r.rows, b.control],
                kernels::attainable_distances::Params { capacity },
                self.buffers.row_capacity,
            );
        }
        self.record_colors(recording);
        // First the multipliers of the last step are applied.
        let sweeps =
            if self.polishes { self.settings.sweeps_to_polish(self.polished) } else { self.settings.sweeps };
        for sweep in 0..=sweeps {
            if (1..=MAX_COARSE_CORRECTIONS).contains(&sweep) && self.settings.coarse_correction {
                self.record_coarse_correction(recording);
            }
            self.record_row_sweep(sweep == 0, recording);
            self.record_edge_sweep(sweep == 0, recording);
        }
        recording.dispatch(
            &kernels::STORE_MULTIPLIERS,
            &[r.rows, b.states, b.control],
            kernels::store_multipliers::Params { capacity: self.buffers.row_capacity as u32 },
            self.buffers.row_capacity,
        );
        recording.dispatch(
            &kernels::SET_AIMS,
            &[b.positions, b.targets, b.displacements, b.aims, b.swings],
            kernels::set_aims::Params { vertices, growth: self.settings.proximal_growth as f32 },
            self.sizes.vertices,
        );
    }
}
