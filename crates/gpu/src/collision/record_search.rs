//! The stages that search for candidates.

use super::Collision;
use super::trees::DeviceTree;
use crate::engine::Engine;
use crate::kernels;
use crate::kernels::scan_counts::CANDIDATES;
use crate::layout::Kind;
use crate::recording::{BufferId, Recording};

/// A list whose entries get their places: counts by row, which become where each row begins, and sums by
/// block.
pub(super) struct ListPlaces {
    pub starts: BufferId,
    pub blocks: BufferId,
    pub rows: u32,
    /// Entries that the list holds.
    pub capacity: u32,
    pub list: u32,
}

impl<E: Engine> Collision<E> {
    /// The candidates, if trust regions have changed.
    pub(super) fn record_search(&self, recording: &mut Recording) {
        let b = &self.buffers;
        self.record_saved_candidates(recording);
        for tree in self.trees.targets() {
            tree.record_fit(b, recording);
        }
        self.record_finds(false, recording);
        let (rows, capacity) = (self.sizes.rows as u32, self.buffers.capacity as u32);
        let places = ListPlaces { starts: b.starts, blocks: b.blocks, rows, capacity, list: CANDIDATES };
        self.record_scan(&places, recording);
        self.record_finds(true, recording);
        recording.dispatch(
            &kernels::INHERIT_STATES,
            &[b.starts, b.candidates, b.old_rows, b.old_elements, b.old_states, b.states, b.control],
            kernels::inherit_states::Params { rows, capacity },
            self.sizes.rows,
        );
    }

    /// Turns counts into places in a list: first how many entries come before each in its block, then in all.
    pub(super) fn record_scan(&self, places: &ListPlaces, recording: &mut Recording) {
        let &ListPlaces { starts, blocks, rows, capacity, list } = places;
        let control = self.buffers.control;
        let params = kernels::scan_counts::Params { rows, list };
        recording.dispatch(&kernels::SCAN_COUNTS, &[starts, blocks, control], params, rows as usize);
        let block_count = rows.div_ceil(kernels::SCAN_COUNTS.workgroup as u32);
        let params = kernels::scan_blocks::Params { blocks: block_count, capacity, list };
        recording.dispatch(&kernels::SCAN_BLOCKS, &[blocks, control], params, 1);
        let params = kernels::scan_places::Params { rows, list };
        recording.dispatch(&kernels::SCAN_PLACES, &[blocks, starts, control], params, rows as usize);
    }

    /// Counts the partners of all elements, or lists them.
    fn record_finds(&self, lists: bool, recording: &mut Recording) {
        let b = &self.buffers;
        let mut row = 0;
        for (kind, queries, targets) in self.trees.searches() {
            self.record_traverse(kind, queries, targets, row, lists, recording);
            row += queries.tree.slots.len();
        }
        if self.sizes.planes > 0 {
            let queries = &self.trees.surface;
            let params = kernels::near_planes::Params {
                queries: queries.tree.slots.len() as u32,
                planes: self.sizes.planes as u32,
                first_row: row as u32,
                lists: u32::from(lists),
                capacity: b.capacity as u32,
            };
            let buffers = [queries.slots, b.planes, b.balls, b.vertices, b.starts, b.candidates, b.control];
            recording.dispatch(&kernels::NEAR_PLANES, &buffers, params, queries.tree.slots.len());
        }
    }

    /// Keeps the present candidates with their states. If the step is made again they have been kept already,
    /// and the present ones are not whole.
    pub(super) fn record_saved_candidates(&self, recording: &mut Recording) {
        if self.again {
            return;
        }
        let (b, rows) = (&self.buffers, self.sizes.rows);
        recording.dispatch(
            &kernels::SAVE_CANDIDATES,
            &[b.starts, b.candidates, b.states, b.old_rows, b.old_elements, b.old_states, b.control],
            kernels::save_candidates::Params { rows: rows as u32, capacity: self.buffers.capacity as u32 },
            rows,
        );
    }

    pub(super) fn record_traverse(
        &self,
        kind: Kind,
        queries: &DeviceTree,
        targets: &DeviceTree,
        row: usize,
        lists: bool,
        recording: &mut Recording,
    ) {
        let b = &self.buffers;
        let mut level_first = [[0; 4]; 3];
        for (k, level) in targets.tree.levels.iter().enumerate() {
            level_first[k / 4][k % 4] = level.first as u32;
        }
        let params = kernels::traverse_tree::Params {
            queries: queries.tree.slots.len() as u32,
            count: queries.tree.vertex_count as u32,
            kind: kind as u32,
            symmetric: u32::from(queries.slots == targets.slots),
            first_row: row as u32,
            lists: u32::from(lists),
            capacity: b.capacity as u32,
            levels: targets.tree.levels.len() as u32,
            level_first,
        };
        let buffers = [
            queries.slots,
            targets.slots,
            targets.boxes,
            b.balls,
            b.vertices,
            b.starts,
            b.candidates,
            b.control,
        ];
        recording.dispatch(&kernels::TRAVERSE_TREE, &buffers, params, queries.tree.slots.len());
    }
}
