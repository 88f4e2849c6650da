//! The stages that search for candidates.

use super::Collision;
use super::buffers::ROW_HEADER;
use super::trees::DeviceTree;
use crate::cpu;
use crate::engine::Engine;
use crate::layout::Kind;
use crate::recording::Recording;
use crate::stages;

impl<E: Engine> Collision<E> {
    /// The candidates, if trust regions have changed.
    pub(super) fn record_search(&self, recording: &mut Recording) {
        let b = &self.buffers;
        self.record_keep(recording);
        for tree in self.trees.targets() {
            tree.record_fit(b, recording);
        }
        let mut row = 0;
        for (kind, queries, targets) in self.trees.searches() {
            self.record_traverse(kind, queries, targets, row, recording);
            row += queries.tree.slots.len();
        }
        if self.sizes.planes > 0 {
            let queries = &self.trees.surface;
            let params = cpu::near_planes::Params {
                queries: queries.tree.slots.len() as u32,
                planes: self.sizes.planes as u32,
                first_row: row as u32,
                stride: self.stride(),
                most: self.buffers.most_partners as u32,
            };
            let buffers = [queries.slots, b.planes, b.balls, b.vertices, b.partners, b.control];
            recording.dispatch(&stages::NEAR_PLANES, &buffers, params, queries.tree.slots.len());
            row += queries.tree.slots.len();
        }
        let (rows, most, capacity) =
            (row as u32, self.buffers.most_partners as u32, self.buffers.capacity as u32);
        let stride = self.stride();
        recording.dispatch(
            &stages::COUNT,
            &[b.partners, b.starts, b.blocks, b.control],
            cpu::count::Params { rows, stride, most },
            row,
        );
        recording.dispatch(
            &stages::TOTAL,
            &[b.blocks, b.control],
            cpu::total::Params { blocks: rows.div_ceil(cpu::count::BLOCK as u32), capacity, list: 0 },
            1,
        );
        recording.dispatch(
            &stages::GATHER,
            &[b.partners, b.starts, b.blocks, b.candidates, b.control],
            cpu::gather::Params { rows, stride, most, capacity },
            row,
        );
        recording.dispatch(
            &stages::INHERIT,
            &[b.partners, b.starts, b.blocks, b.old_rows, b.old_elements, b.old_states, b.states, b.control],
            cpu::inherit::Params { rows, stride, most, capacity },
            row,
        );
    }

    /// Keeps the present candidates with their states. If the step is made again they have been kept already, and the
    /// present ones are not whole.
    pub(super) fn record_keep(&self, recording: &mut Recording) {
        if self.again {
            return;
        }
        let (b, rows) = (&self.buffers, self.sizes.rows);
        recording.dispatch(
            &stages::KEEP,
            &[b.partners, b.starts, b.blocks, b.states, b.old_rows, b.old_elements, b.old_states, b.control],
            cpu::keep::Params {
                rows: rows as u32,
                stride: self.stride(),
                most: self.buffers.most_partners as u32,
                capacity: self.buffers.capacity as u32,
            },
            rows,
        );
    }

    pub(super) fn record_traverse(
        &self,
        kind: Kind,
        queries: &DeviceTree,
        targets: &DeviceTree,
        row: usize,
        recording: &mut Recording,
    ) {
        let b = &self.buffers;
        let mut level_first = [[0; 4]; 3];
        for (k, level) in targets.tree.levels.iter().enumerate() {
            level_first[k / 4][k % 4] = level.first as u32;
        }
        let params = cpu::traverse::Params {
            queries: queries.tree.slots.len() as u32,
            count: queries.tree.vertex_count as u32,
            kind: kind as u32,
            symmetric: u32::from(queries.slots == targets.slots),
            first_row: row as u32,
            stride: self.stride(),
            most: self.buffers.most_partners as u32,
            levels: targets.tree.levels.len() as u32,
            level_first,
        };
        let buffers =
            [queries.slots, targets.slots, targets.boxes, b.balls, b.vertices, b.partners, b.control];
        recording.dispatch(&stages::TRAVERSE, &buffers, params, queries.tree.slots.len());
    }

    /// Words of a row of partners.
    pub(super) fn stride(&self) -> u32 {
        (ROW_HEADER + self.buffers.most_partners) as u32
    }
}
