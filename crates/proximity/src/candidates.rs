//! Candidate pairs in compact form: for each element of side *a* its partners of side *b*, each with a
//! certified lower bound of the distance.

use crate::assemble::PartnerTable;
use crate::pairs::Candidate;
use crate::traverse::TaskResult;
use bowknot_geometry::{Identity, PairKind, Topology};
use rayon::prelude::*;
use std::ops::Range;

/// Elements whose partners one task writes.
const CHUNK: usize = 512;

/// Candidate pairs of all kinds but [`PairKind::VertexHalfSpace`]. It is filled by
/// [`ProximitySearch::update`](crate::ProximitySearch::update).
#[derive(Clone, Debug, Default)]
pub struct CandidateList {
    kinds: [Candidates; 4],
    /// Tells this state of the list from all others, so that the search knows the one that it has left.
    pub(crate) identity: Identity,
}

/// Candidate pairs of one kind.
#[derive(Clone, Debug, Default)]
pub struct Candidates {
    /// Partners of element a: `partners[starts[a]..starts[a + 1]]`, ascending. Empty: there are none.
    starts: Vec<usize>,
    partners: Vec<Candidate>,
    /// The list that is being written.
    next: Vec<Candidate>,
    next_starts: Vec<usize>,
}

impl CandidateList {
    /// The candidates of a kind; none for half-spaces.
    pub fn of(&self, kind: PairKind) -> Option<&Candidates> {
        self.kinds.get(kind as usize)
    }

    /// Number of pairs.
    pub fn len(&self) -> usize {
        self.kinds.iter().map(|kind| kind.partners.len()).sum()
    }

    /// Whether there is no pair.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Removes all pairs.
    pub fn clear(&mut self) {
        for kind in &mut self.kinds {
            kind.starts.clear();
            kind.partners.clear();
        }
        self.identity = Identity::default();
    }

    /// Takes the pairs that a search has found. `changed`: it has searched only pairs of which a vertex has
    /// changed, and these are replaced.
    pub(crate) fn take(
        &mut self,
        topology: &Topology,
        tables: &[PartnerTable; 4],
        tasks: &[Vec<TaskResult>; 4],
        changed: Option<&[bool]>,
    ) {
        for (k, kind) in self.kinds.iter_mut().enumerate() {
            let replaces = |pair_side: usize, element: u32| {
                changed
                    .is_none_or(|changed| is_changed(topology, PairKind::ALL[k], pair_side, element, changed))
            };
            kind.take(&tables[k], &tasks[k], replaces);
        }
        self.identity = Identity::unique();
    }
}

impl Candidates {
    /// Elements of side *a* that may have partners.
    pub fn elements(&self) -> Range<usize> {
        0..self.starts.len().saturating_sub(1)
    }

    /// The partners of an element of side *a*, ascending.
    #[inline]
    pub fn of(&self, element: usize) -> &[Candidate] {
        &self.partners[self.starts[element]..self.starts[element + 1]]
    }

    /// Whether there is no pair.
    pub fn is_empty(&self) -> bool {
        self.partners.is_empty()
    }

    /// Number of partners of a range of elements.
    pub fn count(&self, elements: Range<usize>) -> usize {
        self.starts[elements.end] - self.starts[elements.start]
    }

    /// Replaces the pairs of which an element is `replaced` (by side and index) by those of the tasks.
    fn take(
        &mut self,
        table: &PartnerTable,
        tasks: &[TaskResult],
        replaced: impl Fn(usize, u32) -> bool + Sync,
    ) {
        let elements = table.len();
        let Self { starts, partners, next, next_starts } = self;
        if elements == 0 || starts.len() != elements + 1 {
            starts.clear();
            partners.clear();
            if elements == 0 {
                return;
            }
            starts.resize(elements + 1, 0);
        }
        let kept = |a: usize| {
            let old = &partners[starts[a]..starts[a + 1]];
            let none = old.is_empty() || replaced(0, a as u32);
            let old = if none { &[][..] } else { old };
            old.iter().copied().filter(|candidate| !replaced(1, candidate.element))
        };
        next_starts.clear();
        next_starts.resize(elements + 1, 0);
        next_starts[1..].par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, counts)| {
            for (count, a) in counts.iter_mut().zip(chunk * CHUNK..) {
                *count = kept(a).count() + table.partners(tasks, a).len();
            }
        });
        for a in 0..elements {
            next_starts[a + 1] += next_starts[a];
        }
        next.resize(next_starts[elements], Candidate::default());
        let write = |elements: Range<usize>, out: &mut [Candidate]| {
            let mut end = 0;
            for a in elements {
                let mut found = table.partners(tasks, a).iter().copied().peekable();
                for old in kept(a) {
                    while let Some(new) = found.next_if(|new| new.element < old.element) {
                        out[end] = new;
                        end += 1;
                    }
                    out[end] = old;
                    end += 1;
                }
                for new in found {
                    out[end] = new;
                    end += 1;
                }
            }
        };
        for_each_chunk(0..elements, next_starts, next, &write);
        std::mem::swap(partners, next);
        std::mem::swap(starts, next_starts);
    }
}

/// Calls `write` for chunks of `elements` with their parts of `out`, which begins with that of the first.
fn for_each_chunk(
    elements: Range<usize>,
    starts: &[usize],
    out: &mut [Candidate],
    write: &(impl Fn(Range<usize>, &mut [Candidate]) + Sync),
) {
    let chunks = elements.len().div_ceil(CHUNK);
    if out.is_empty() {
        return;
    }
    if chunks == 1 {
        return write(elements, out);
    }
    let middle = elements.start + chunks / 2 * CHUNK;
    let (left, right) = out.split_at_mut(starts[middle] - starts[elements.start]);
    rayon::join(
        || for_each_chunk(elements.start..middle, starts, left, write),
        || for_each_chunk(middle..elements.end, starts, right, write),
    );
}

/// Whether a vertex of an element has changed. The sides of a pair kind are numbered 0 and 1.
#[inline]
fn is_changed(topology: &Topology, kind: PairKind, side: usize, element: u32, changed: &[bool]) -> bool {
    let e = element as usize;
    match (kind, side) {
        (PairKind::EdgeEdge, _) | (PairKind::VertexEdge, 1) => {
            topology.edges[e].iter().any(|&v| changed[v as usize])
        }
        (PairKind::VertexTriangle, 1) => topology.triangles[e].iter().any(|&v| changed[v as usize]),
        _ => changed[e],
    }
}
