//! Lists of pairs.

use bowknot_geometry::{PairKind, Topology};
use std::ops::Range;

/// A partner of an element in a [`CandidateList`](crate::CandidateList): 8 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Candidate {
    /// The element of side *b*, by index.
    pub element: u32,
    /// Certified lower bound of the distance at the positions of the search [m], at least 0.
    pub bound: f32,
}

/// A pair of primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Pair {
    /// The primitives' indices: vertices, edges or triangles of the topology by the pair's kind (for
    /// [`PairKind::VertexHalfSpace`] the vertex and the half-space). In edge-edge and vertex-vertex pairs the
    /// smaller index comes first.
    pub elements: [u32; 2],
    /// Vertices in [`PairKind`] order; unused places repeat the first vertex.
    pub vertices: [u32; 4],
}

impl Pair {
    /// The pair of two `elements`; for [`PairKind::VertexHalfSpace`] the second is the half-space.
    ///
    /// # Panics
    /// If the topology does not have them.
    #[inline(always)]
    pub fn of_elements(topology: &Topology, kind: PairKind, elements: [u32; 2]) -> Self {
        let [a, b] = elements;
        let vertices = match kind {
            PairKind::VertexVertex => [a, b, a, a],
            PairKind::VertexEdge => {
                let [b0, b1] = topology.edges[b as usize];
                [a, b0, b1, a]
            }
            PairKind::VertexTriangle => {
                let [b0, b1, b2] = topology.triangles[b as usize];
                [a, b0, b1, b2]
            }
            PairKind::EdgeEdge => {
                let [a0, a1] = topology.edges[a as usize];
                let [b0, b1] = topology.edges[b as usize];
                [a0, a1, b0, b1]
            }
            PairKind::VertexHalfSpace => [a; 4],
        };
        Self { elements, vertices }
    }
}

/// Pairs grouped by kind in the order of [`PairKind::ALL`], sorted by `elements` within a kind.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PairList {
    pairs: Vec<Pair>,
    /// Start of each kind in `pairs`, and the end.
    starts: [usize; 6],
}

impl PairList {
    /// A list from the pairs of each kind in the order of [`PairKind::ALL`]; each is sorted.
    pub fn from_kinds(kinds: [Vec<Pair>; 5]) -> Self {
        let mut list = Self::default();
        list.refill(&kinds.map(|pairs| [pairs]));
        list
    }

    /// Replaces the content and keeps the allocation. `kinds` has some lists of pairs of each kind, which are
    /// joined and sorted.
    pub fn refill(&mut self, kinds: &[impl AsRef<[Vec<Pair>]>; 5]) {
        self.pairs.clear();
        self.starts = [0; 6];
        for (k, lists) in kinds.iter().enumerate() {
            let start = self.pairs.len();
            lists.as_ref().iter().for_each(|list| self.pairs.extend_from_slice(list));
            // Takes linear time for lists that are sorted.
            self.pairs[start..].sort_unstable();
            self.starts[k + 1] = self.pairs.len();
        }
    }

    /// Resizes the list to the given number of pairs of each kind; the caller writes them in order.
    pub(crate) fn resize_kinds(&mut self, counts: [usize; 5]) -> &mut [Pair] {
        const BLANK: Pair = Pair { elements: [0; 2], vertices: [0; 4] };
        self.starts = [0; 6];
        for k in 0..5 {
            self.starts[k + 1] = self.starts[k] + counts[k];
        }
        self.pairs.resize(self.starts[5], BLANK);
        &mut self.pairs
    }

    /// Removes all pairs and keeps the allocation.
    pub fn clear(&mut self) {
        self.pairs.clear();
        self.starts = [0; 6];
    }

    /// Keeps the pairs that `keep` accepts; it is called with index, kind and pair, in order.
    pub fn retain(&mut self, mut keep: impl FnMut(usize, PairKind, &Pair) -> bool) {
        let mut end = 0;
        for kind in PairKind::ALL {
            let range = self.range(kind);
            self.starts[kind as usize] = end;
            for p in range {
                let pair = self.pairs[p];
                if keep(p, kind, &pair) {
                    self.pairs[end] = pair;
                    end += 1;
                }
            }
        }
        self.starts[PairKind::ALL.len()] = end;
        self.pairs.truncate(end);
    }

    /// For each pair, the index of the same pair in another list, or `u32::MAX` if that list does not have
    /// it. They replace the content of `matches`.
    ///
    /// One pass over both lists, which are sorted. It serves to carry data of pairs, such as multipliers,
    /// from an old list to a new one.
    pub fn match_with(&self, old: &PairList, matches: &mut Vec<u32>) {
        matches.clear();
        matches.reserve(self.len());
        for kind in PairKind::ALL {
            let range = old.range(kind);
            let mut next = range.start;
            for pair in &self.pairs[self.range(kind)] {
                while next < range.end && old.pairs[next].elements < pair.elements {
                    next += 1;
                }
                let same = next < range.end && old.pairs[next].elements == pair.elements;
                matches.push(if same { next as u32 } else { u32::MAX });
            }
        }
    }

    /// All pairs.
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    /// Where the pairs of a kind stand in [`Self::pairs`].
    pub fn range(&self, kind: PairKind) -> Range<usize> {
        self.starts[kind as usize]..self.starts[kind as usize + 1]
    }

    /// PairTest of the pair at `index` of [`Self::pairs`].
    #[inline]
    pub fn kind(&self, index: usize) -> PairKind {
        let k = self.starts[1..5].iter().filter(|&&start| start <= index).count();
        PairKind::ALL[k]
    }

    /// Number of pairs.
    pub fn len(&self) -> usize {
        self.pairs.len()
    }

    /// Whether there is no pair.
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }
}
