//! The pairs in order, with their contact geometry.

use crate::narrow::separate_all;
use crate::pairs::{Candidate, Pair};
use crate::traverse::{PartnerRange, TaskResult};
use bowknot_geometry::{CollisionModel, PairKind, Point, Separation};
use rayon::prelude::*;

/// Elements whose pairs one task writes.
const CHUNK: usize = 256;

/// Where the partners of each element of one kind of pair are stored.
#[derive(Debug, Default)]
pub struct PartnerTable {
    /// Task and range of partners of each element of side *a*; the count is 0 if it has none.
    entries: Vec<(u32, PartnerRange)>,
    /// Pairs of each chunk of elements.
    chunk_pairs: Vec<usize>,
}

impl PartnerTable {
    /// Enters the results of the tasks for elements `0..elements`; returns the number of pairs.
    pub fn fill(&mut self, elements: usize, tasks: &[TaskResult]) -> usize {
        let none = (0, PartnerRange { element: 0, start: 0, count: 0 });
        self.entries.clear();
        self.chunk_pairs.clear();
        if tasks.is_empty() {
            return 0;
        }
        self.entries.resize(elements, none);
        self.chunk_pairs.resize(elements.div_ceil(CHUNK), 0);
        for (found, task) in tasks.iter().zip(0..) {
            for run in &found.runs {
                self.entries[run.element as usize] = (task, *run);
                self.chunk_pairs[run.element as usize / CHUNK] += run.count as usize;
            }
        }
        self.chunk_pairs.iter().sum()
    }

    /// Number of elements of side *a*; 0 if there were no tasks.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// The partners of an element.
    #[inline]
    pub fn partners<'a>(&self, tasks: &'a [TaskResult], element: usize) -> &'a [Candidate] {
        let (task, run) = &self.entries[element];
        tasks.get(*task as usize).map_or(&[][..], |task| &task.partners[run.start..][..run.count as usize])
    }

    /// Writes the pairs of `kind` in order.
    pub fn write(
        &self,
        kind: PairKind,
        tasks: &[TaskResult],
        model: &CollisionModel,
        positions: &[Point],
        mut pairs: &mut [Pair],
        mut separations: &mut [Separation],
    ) {
        let mut jobs = Vec::with_capacity(self.chunk_pairs.len());
        for (entries, &count) in self.entries.chunks(CHUNK).zip(&self.chunk_pairs) {
            let (head, tail) = std::mem::take(&mut pairs).split_at_mut(count);
            pairs = tail;
            let (geometry, tail) = std::mem::take(&mut separations).split_at_mut(count);
            separations = tail;
            if count > 0 {
                jobs.push((entries, head, geometry));
            }
        }
        jobs.into_par_iter().for_each(|(entries, pairs, separations)| {
            let mut rest = &mut *pairs;
            for (task, run) in entries.iter().filter(|(_, run)| run.count > 0) {
                let (head, tail) = std::mem::take(&mut rest).split_at_mut(run.count as usize);
                rest = tail;
                let partners = &tasks[*task as usize].partners[run.start..][..head.len()];
                write_pairs(kind, model, run.element, partners, head);
            }
            separate_all(model, kind, pairs, positions, separations);
        });
    }
}

/// Writes the pairs of one element `a`.
fn write_pairs(kind: PairKind, model: &CollisionModel, a: u32, partners: &[Candidate], pairs: &mut [Pair]) {
    for (partner, pair) in partners.iter().zip(pairs) {
        *pair = Pair::of_elements(model.topology(), kind, [a, partner.element]);
    }
}
