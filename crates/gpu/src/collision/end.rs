//! The end of a call: what the host reads, and the pairs that are within contact range there.
//!
//! **No pair within range is missing.** The boxes of the last search hold the trust regions of the vertices
//! and, around them, their margins; a pair that it did not list has boxes apart along an axis. All vertices
//! are still in their regions: a step moves none out of its region, or searches first
//! ([`crate::kernels::update_trust_regions`]); safety rests on the same. Both elements lie within the boxes
//! of their regions, so their distance exceeds both margins, which is the largest range of any of their
//! pairs. In the same way a half-space that was not listed is farther from the whole region of a vertex than
//! twice its margin, the rounding of the plane included. So all pairs within range are candidates, also after
//! the last move. Of the candidates, `mark_near_pairs` drops those alone that a certified slab holds farther
//! apart than both margins: a lower bound of the distance, rounding included. The host computes the distances
//! of the others in double precision and drops what is out of range.

use super::buffers::words;
use super::record_search::ListPlaces;
use super::{Collision, CollisionError, ContactRow, End};
use crate::engine::Engine;
use crate::error::GpuError;
use crate::kernels;
use crate::kernels::scan_counts::CONTACT_ROWS;
use crate::layout::{Candidate, Control, Row};
use crate::recording::{BufferId, Recording};
use bowknot_geometry::Vector;
use rayon::prelude::*;

/// Pairs that one thread sorts.
const SORTED_ALONE: usize = 1 << 16;

impl<E: Engine> Collision<E> {
    /// How the call ends after the steps so far.
    ///
    /// # Errors
    /// The device failed.
    pub fn end(&mut self) -> Result<End, CollisionError> {
        let mut all = match self.ended.take() {
            Some(all) => all,
            None => {
                let mut recording = std::mem::take(&mut self.pending);
                if self.listed {
                    // The candidates may have grown in the last step.
                    self.buffers.make_room_for_step(&mut self.engine)?;
                    self.record_end(&mut recording);
                }
                self.engine.run(&recording, &self.end_reads(self.row_count))?
            }
        };
        let near = self.listed.then(|| self.near_pairs([4, 5].map(|k| std::mem::take(&mut all[k]))));
        let [positions, aims] = [0, 1].map(|k| self.points_of(&all[k]));
        let (rows, pairs): (&[Row], &[Candidate]) =
            (bytemuck::cast_slice(&all[2]), bytemuck::cast_slice(&all[3]));
        let quantum = self.grid.quantum();
        let vector = |v: [f32; 3]| Vector::from(v.map(f64::from)) * quantum;
        let row = |(row, pair): (&Row, &Candidate)| ContactRow {
            candidate: *pair,
            multiplier: f64::from(row.multiplier) * quantum,
            friction: vector(row.friction),
            slip: vector(row.slip),
            coefficient: f64::from(row.coefficient),
        };
        let rows = rows.iter().zip(pairs).take(self.row_count).map(row).collect();
        Ok(End { positions, aims, rows, near: near.transpose()? })
    }

    /// What is read at the end of a call with so many contact rows.
    pub(super) fn end_reads(&self, rows: usize) -> [(BufferId, usize); 6] {
        let vertices = 4 * self.sizes.vertices;
        [
            (self.buffers.positions, vertices),
            (self.buffers.aims, vertices),
            (self.buffers.rows.rows, words::<Row>(rows)),
            (self.buffers.rows.pairs, words::<Candidate>(rows)),
            (self.end_control, words::<Control>(1)),
            (self.near.buffer, words::<Candidate>(self.near.capacity)),
        ]
    }

    /// Lists the pairs that may be within range at the present positions. The call may go on after it: the
    /// next step computes all of what it writes anew.
    pub(super) fn record_end(&mut self, recording: &mut Recording) {
        let control = words::<Control>(1);
        let params = kernels::copy_words::Params { words: control as u32 };
        recording.dispatch(&kernels::COPY_WORDS, &[self.buffers.control, self.end_control], params, control);
        std::mem::swap(&mut self.buffers.control, &mut self.end_control);
        self.record_separations(false, recording);
        let (b, capacity) = (&self.buffers, self.buffers.capacity as u32);
        recording.dispatch(
            &kernels::MARK_NEAR_PAIRS,
            &[b.edges, b.triangles, b.vertices, b.candidates, b.separations, b.selection.starts, b.control],
            kernels::mark_near_pairs::Params { capacity },
            self.buffers.capacity,
        );
        // Their number takes the place of that of the contact rows in the copy.
        let places = ListPlaces {
            starts: b.selection.starts,
            blocks: b.selection.blocks,
            rows: capacity,
            capacity: self.near.capacity as u32,
            list: CONTACT_ROWS,
        };
        self.record_scan(&places, recording);
        self.record_near_list(recording);
        std::mem::swap(&mut self.buffers.control, &mut self.end_control);
    }

    fn record_near_list(&self, recording: &mut Recording) {
        let b = &self.buffers;
        recording.dispatch(
            &kernels::LIST_NEAR_PAIRS,
            &[b.selection.starts, b.candidates, self.near.buffer, b.control],
            kernels::list_near_pairs::Params {
                capacity: self.buffers.capacity as u32,
                near_capacity: self.near.capacity as u32,
            },
            self.buffers.capacity,
        );
    }

    /// The pairs of a list that was read with [`Control`], sorted. If there was no room for all of them, they
    /// are gathered once more.
    fn near_pairs(&mut self, [control, list]: [Vec<u32>; 2]) -> Result<Vec<Candidate>, GpuError> {
        let count = bytemuck::cast_slice::<u32, Control>(&control)[0].rows as usize;
        let list = if count <= self.near.capacity {
            list
        } else {
            self.near.grow(&mut self.engine, count)?;
            let mut recording = Recording::default();
            std::mem::swap(&mut self.buffers.control, &mut self.end_control);
            self.record_near_list(&mut recording);
            std::mem::swap(&mut self.buffers.control, &mut self.end_control);
            self.engine.run(&recording, &[(self.near.buffer, words::<Candidate>(count))])?.swap_remove(0)
        };
        let mut near = bytemuck::cast_slice::<u32, Candidate>(&list)[..count].to_vec();
        match near.len() {
            // Sorting in parallel would pay for the way to its threads.
            ..=SORTED_ALONE => near.sort_unstable(),
            _ => near.par_sort_unstable(),
        }
        Ok(near)
    }
}
